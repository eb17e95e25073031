// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPReslice
 * @brief   vtkImageReslice with exact maxima and minima of slabs
 *
 * vtkSplattingMIPReslice replaces a vtkImageReslice that makes slabs of maxima or minima.
 * vtkImageReslice takes SlabNumberOfSlices samples along the z axis of the output. It misses maxima
 * between them. This class computes the largest (or least) value of the trilinearly interpolated
 * input on the whole line from the first to the last sample. The time does not depend on the number
 * of samples. All properties have the meaning, the default and the range of vtkImageReslice's.
 *
 * The line of an output pixel is parallel to the z axis of the output. It extends to both sides of
 * the pixel, by (SlabNumberOfSlices - 1) / 2 * SlabSliceSpacingFraction times the output spacing.
 * SlabTrapezoidIntegration has no effect. Every slice of the output has a slab of its own. Only the
 * part of the line inside the input contributes. The input ends BorderThickness voxels beyond the
 * outermost voxel centres, with Border off 2^-17 voxels beyond them, and along axes with one voxel
 * at least half a voxel beyond it. (2^-19 voxels are added, so that lines along its sides cross
 * it.) There the outermost voxels are repeated. Pixels whose lines do not cross the input have the
 * background colour.
 *
 * Slabs are exact if all of this holds: SlabMode is MAX or MIN; SlabNumberOfSlices is at least 2
 * and the slab has a thickness; the interpolator is a vtkImageInterpolator, and InterpolationMode
 * is linear; Wrap and Mirror are off; ResliceTransform, if any, is an affine vtkLinearTransform or
 * vtkHomogeneousTransform; BorderThickness is less than 1; the scalars are not bits. Otherwise
 * vtkImageReslice computes the output. GetSlabIsExact() reports which of both did. Exact slabs
 * differ from vtkImageReslice's in these points:
 *
 * - They are centred on the output slice. With Optimization on, a SlabSliceSpacingFraction of 1 and
 *   output axes along those of the input, vtkImageReslice takes its samples half a slice lower.
 * - Voxels that are NaN are not interpolated, and are no samples; see contract.md.
 * - 64-bit integers are supported.
 * - If AbortExecute is set during execution, the output is empty. AbortExecuteOff() and Update()
 *   compute it again.
 *
 * Values have an error of at most a millionth of the input's range (10^-12 for double and for 32-
 * and 64-bit integers) before ScalarShift, ScalarScale and rounding are applied. They have the same
 * bits for any number of threads. The input is not copied, except for interleaved components. An
 * index of it (about 1/57 of its memory) is kept until the scalars change. The whole extent of the
 * input is requested. As in vtkImageReslice, voxels that ghost arrays hide are used like others.
 *
 * @sa vtkImageReslice vtkSplattingMIPProjection
 */
#ifndef vtkSplattingMIPReslice_h
#define vtkSplattingMIPReslice_h

#include "vtkImageReslice.h"
#include "vtkImagingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPNamespace.h"

#include <memory> // for the hidden implementation

VTK_ABI_NAMESPACE_BEGIN
class VTKIMAGINGSPLATTINGMIP_EXPORT vtkSplattingMIPReslice : public vtkImageReslice
{
public:
  static vtkSplattingMIPReslice* New();
  vtkTypeMacro(vtkSplattingMIPReslice, vtkImageReslice);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Get whether the slabs of the last Update() are exact. They are not if vtkImageReslice computed
   * the output.
   */
  vtkGetMacro(SlabIsExact, bool);

protected:
  vtkSplattingMIPReslice();
  ~vtkSplattingMIPReslice() override;

  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  bool SlabIsExact = false;

  class Internals;
  const std::unique_ptr<Internals> Internal;

  vtkSplattingMIPReslice(const vtkSplattingMIPReslice&) = delete;
  void operator=(const vtkSplattingMIPReslice&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
