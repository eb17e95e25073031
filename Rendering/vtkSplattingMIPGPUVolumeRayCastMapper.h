// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPGPUVolumeRayCastMapper
 * @brief   a vtkGPUVolumeRayCastMapper that splats maximum and minimum intensity projections
 *
 * For programs that know nothing of vtkSplattingMIPVolumeMapper: after
 *
 *   vtkSplattingMIPGPUVolumeRayCastMapper::GlobalOverrideOn();
 *
 * VTK's object factory gives this class wherever vtkGPUVolumeRayCastMapper is asked for, as
 * vtkSmartVolumeMapper and, through it, vtkMultiBlockVolumeMapper and vtkAMRVolumeMapper do.
 * (Programs that cannot be changed get it by VTK_AUTOLOAD_PATH; see Module/Autoload.) It hands the
 * blend modes MAXIMUM_INTENSITY and MINIMUM_INTENSITY to a vtkSplattingMIPVolumeMapper and leaves
 * everything else to its superclass:
 *
 * - all other blend modes;
 * - volumes with several inputs (vtkMultiVolume);
 * - two-dimensional transfer functions;
 * - shader code of the volume's vtkShaderProperty, and render passes that put code of theirs into
 *   the shader, such as vtkDualDepthPeelingPass;
 * - RenderToImage.
 *
 * Gray functions are left to the superclass as RGB functions of the same values, in a copy of the
 * property: it knows no others, and would put one into the property for good. Of a vtkMultiVolume
 * it gets the properties themselves.
 *
 * The splatting mapper gets this mapper's input and, before each render, its BlendMode, Cropping,
 * CroppingRegionPlanes, CroppingRegionFlags, ClippingPlanes, ScalarMode, the selected array,
 * FinalColorWindow, FinalColorLevel, AutoAdjustSampleDistances and a binary MaskInput. What does
 * not change keeps its index and its shear image. The picture is that of a
 * vtkSplattingMIPVolumeMapper with these properties, bit for bit.
 *
 * These have no meaning for a splatted projection, which has no samples along rays and no memory of
 * the GPU: SampleDistance, LockSampleDistanceToInputSpacing, UseJittering, ImageSampleDistance and
 * its minimum and maximum, MaxMemoryInBytes, MaxMemoryFraction, UseDepthPass, partitions, a shared
 * depth texture, and the range types of the transfer functions. Nor has a mask of type label map,
 * which has none for VTK's projections either. AutoAdjustSampleDistances lets the quality mode step
 * down where frames take too long, instead of the resolution.
 *
 * Selections find the volume where its picture is not transparent, as one thing and not voxel by
 * voxel.
 *
 * Events are those of vtkGPUVolumeRayCastMapper, VolumeMapperRenderStartEvent and
 * VolumeMapperRenderEndEvent, and VolumeMapperRenderProgressEvent (call data: pointer to double,
 * from 0 to 1) if ReportProgress is on. Errors and warnings of the splatting mapper go to observers
 * of this one. Which mapper renders, and why, is logged with vtkLogger::VERBOSITY_1 whenever it
 * changes.
 *
 * vtkMultiBlockVolumeMapper loads its blocks into the GPU's memory all the same, and blends their
 * projections over each other from back to front, as it does without.
 *
 * The index of the splatting mapper is kept while other blend modes are rendered, for the way back.
 *
 * @sa vtkSplattingMIPVolumeMapper vtkSmartVolumeMapper vtkObjectFactory
 */
#ifndef vtkSplattingMIPGPUVolumeRayCastMapper_h
#define vtkSplattingMIPGPUVolumeRayCastMapper_h

#include "vtkNew.h" // for the splatting mapper
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkRenderingSplattingMIPModule.h" // for the export macro

#include <memory> // for the stand-in

namespace splatting
{
class VolumeStandIn;
}
class vtkOpenGLSplattingMIPVolumeMapper;
class vtkSplattingMIPVolumeMapper;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkSplattingMIPGPUVolumeRayCastMapper
  : public vtkOpenGLGPUVolumeRayCastMapper
{
public:
  static vtkSplattingMIPGPUVolumeRayCastMapper* New();
  vtkTypeMacro(vtkSplattingMIPGPUVolumeRayCastMapper, vtkOpenGLGPUVolumeRayCastMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether vtkGPUVolumeRayCastMapper::New() gives objects of this class, in the whole program.
   * Default off. On puts an object factory before all others. Mappers that exist already stay what
   * they are: call it before a vtkSmartVolumeMapper is made.
   */
  static void SetGlobalOverride(bool on);
  static bool GetGlobalOverride();
  static void GlobalOverrideOn() { SetGlobalOverride(true); }
  static void GlobalOverrideOff() { SetGlobalOverride(false); }
  ///@}

  ///@{
  /**
   * The QualityMode of vtkSplattingMIPVolumeMapper that new objects of this class start with, as
   * vtkSmartVolumeMapper does not show what it has made. Default EXACT, clamped to [PREVIEW,
   * EXACT].
   */
  static void SetGlobalQualityMode(int mode);
  static int GetGlobalQualityMode();
  ///@}

  /**
   * What splats. For the properties that vtkGPUVolumeRayCastMapper does not have, such as
   * QualityMode, Slab and MaximumType; those that it has are copied over them before each render.
   */
  vtkSplattingMIPVolumeMapper* GetSplattingMapper();

  /**
   * Whether the last render was handed to the splatting mapper; false before the first one.
   */
  vtkGetMacro(LastRenderUsedSplatting, bool);

  /**
   * WARNING: INTERNAL METHOD - NOT INTENDED FOR GENERAL USE
   */
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkSplattingMIPGPUVolumeRayCastMapper();
  ~vtkSplattingMIPGPUVolumeRayCastMapper() override;

  void GPURender(vtkRenderer* ren, vtkVolume* vol) override;

  /**
   * Why a volume is not splatted, as the end of a sentence, or nullptr.
   */
  const char* ReasonNotToSplat(vtkVolume* vol);

  void CopySettings();
  bool HasGrays(vtkVolume* vol);
  void ForwardMessage(vtkObject* caller, unsigned long event, void* text);
  void ForwardProgress(vtkObject* caller, unsigned long event, void* done);

  bool LastRenderUsedSplatting;

private:
  vtkSplattingMIPGPUVolumeRayCastMapper(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;
  void operator=(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;

  vtkNew<vtkOpenGLSplattingMIPVolumeMapper> SplattingMapper;
  const char* LoggedReason; // what the log says last; "" before
  std::unique_ptr<splatting::VolumeStandIn> StandIn;
};

#endif
