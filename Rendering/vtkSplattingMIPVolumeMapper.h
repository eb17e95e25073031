// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPVolumeMapper
 * @brief   maximum intensity projection of volumes on the CPU, by splatting
 *
 * vtkSplattingMIPVolumeMapper renders maximum intensity projections (MIP) of image data on the CPU.
 * The quality modes PREVIEW, STANDARD and HIGH implement W. Cai and G. Sakas, "Maximum Intensity
 * Projection Using Splatting in Sheared Object Space", Computer Graphics Forum 17(3), 1998. They
 * shear the volume so that all rays run along its principal axis, the image axis nearest to the
 * view direction. They splat each slice with a few constant weights, keep the maximum in the shear
 * image, and warp this image to the viewport. Perspective views have up to six shear images. The
 * default mode EXACT has no shear image. It splats cells onto the screen and computes the maximum
 * of the trilinear volume on the ray of each pixel. In all modes the vtkVolumeProperty colours the
 * projected scalars. Its interpolation type is ignored, because QualityMode defines it.
 *
 * The input is a vtkImageData or a vtkRectilinearGrid with point or cell scalars of any numeric
 * type. ScalarMode, SelectScalarArray() and VectorMode choose the scalars. NaN, voxels hidden by
 * ghost arrays and voxels hidden by MaskInput are no samples. A ray without samples is transparent.
 * Views may be parallel or perspective, with the eye also inside the volume. Up to four independent
 * components are projected separately; their colours are added. If components are dependent, the
 * last one is projected. The values of the others are taken at the position of its sample.
 *
 * The blend modes MAXIMUM_INTENSITY (default), MINIMUM_INTENSITY and AVERAGE_INTENSITY are
 * splatted. An average is the mean of a ray's samples within AverageIPScalarRange. Other blend
 * modes are rendered by vtkFixedPointVolumeRayCastMapper or vtkGPUVolumeRayCastMapper, without slab
 * and bounding surface, and a warning is reported.
 *
 * ClippingPlanes, Cropping, the clipping range of the camera, Slab, BoundingSurface and opaque
 * geometry cut the rays. EXACT cuts them at the exact positions. The other modes, and overviews
 * (pixels wider than voxels), cut them by whole slices.
 *
 * vtkHardwareSelector and vtkPropPicker select the whole volume where its picture is not
 * transparent. The selection has composite index 1, point 0 and cell 0. For voxels see PickVoxel().
 *
 * The mapper invokes VolumeMapperRenderStartEvent, VolumeMapperRenderProgressEvent (call data:
 * pointer to a double from 0 to 1; only if it projects) and VolumeMapperRenderEndEvent, and
 * ProgressEvent while it encodes chains. Observers must not render with this mapper. While it
 * projects, it calls CheckAbortStatus() of the render window; an aborted render draws nothing.
 *
 * The same input gives the same bits for any number of threads and any instruction set. Input and
 * settings that cannot be rendered are reported by one error, and nothing is drawn. Axes have at
 * most 16384 voxels. Definitions, error bounds, limits and memory are documented in
 * Rendering/Documentation of the source tree: contract.md and limits.md.
 *
 * @sa vtkFixedPointVolumeRayCastMapper vtkGPUVolumeRayCastMapper vtkVolumeProperty
 */
#ifndef vtkSplattingMIPVolumeMapper_h
#define vtkSplattingMIPVolumeMapper_h

#include "vtkAbstractSplattingMIPVolumeMapper.h"
#include "vtkRenderingSplattingMIPModule.h" // for the export macro

#include <memory> // for the hidden implementation

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
class vtkMultiProcessController;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkSplattingMIPVolumeMapper
  : public vtkAbstractSplattingMIPVolumeMapper
{
public:
  static vtkSplattingMIPVolumeMapper* New();
  vtkTypeMacro(vtkSplattingMIPVolumeMapper, vtkAbstractSplattingMIPVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Get the quality mode that the last projection shows: QualityMode, or a faster one (see
   * AutoAdjustSampleDistances). If QualityMode is EXACT, returns PREVIEW in overviews, and HIGH for
   * averages and dependent components. EXACT before the first projection.
   */
  int GetQualityModeUsed();

  /**
   * Get the acceleration of the last projection, which is never AUTO. BRICKS in EXACT. DENSE before
   * the first projection.
   */
  int GetAccelerationUsed();

  /**
   * Get the sample positions of the last render as point arrays, with one point for each pixel of
   * the viewport. Extent and coordinates are pixels of the window. "Voxel", three ints: i, j, k
   * relative to the first voxel of the image. "Depth", float: the distance from the camera in world
   * units. "Position", three doubles: the world point. Pixels without a visible sample have -1 in
   * "Voxel", and NaN in "Depth" and "Position". Returns nullptr if RecordLocations is off (with an
   * error), or if the volume is not shown or its scalars have changed. Definitions: contract.md.
   */
  vtkImageData* GetLocations();

  ///@{
  /**
   * Get the world position, the voxel (i, j, k relative to the first voxel of the image) or the
   * value of the sample that a pixel of the window shows; see GetLocations(). (x, y) are display
   * coordinates, as returned by vtkRenderWindowInteractor::GetEventPosition(). If RecordLocations
   * is off, this pixel is projected again. Return false (PickValue(): NaN) and leave the output
   * unchanged if there is no sample, the volume is no longer shown, or its scalars have changed;
   * see contract.md.
   */
  bool PickWorldPosition(int x, int y, double position[3]);
  bool PickVoxel(int x, int y, int ijk[3]);
  double PickValue(int x, int y);
  ///@}

  /**
   * Get the last shear image, in perspective the largest. Returns nullptr before the first render
   * and if GetQualityModeUsed() is EXACT. The caller must not change it. Coordinates are voxel
   * indices on the middle slice along the principal axis: the ray of pixel (u, v) crosses slice k
   * at origin + spacing * (u, v) - GetShear() * (k - (slices - 1) / 2). Pixels without a sample are
   * hidden in the ghost array. See contract.md for axes, scalars and perspective views.
   */
  vtkImageData* GetShearImage();

  /**
   * Get the image axis (0, 1 or 2) along which the last render projected, in perspective that of
   * GetShearImage(). Returns -1 if there is no shear image.
   */
  int GetPrincipalAxis();

  ///@{
  /**
   * Get the shears of the last render along x and y of the shear image, in pixels per slice. Slice
   * k is moved by shear * k. Magnitudes are at most 1, in multiples of 2^-24. In perspective they
   * are the slopes of the middle pixel's ray, in voxels per slice. Returns 0 if there is no shear
   * image.
   */
  void GetShear(double shear[2]);
  double* GetShear() VTK_SIZEHINT(2);
  ///@}

  /**
   * Get how many bytes are held for the last data set besides the input and work space: bricks,
   * chains, copies and the bounds of EXACT.
   */
  vtkIdType GetIndexMemorySize();

  /**
   * Get how many seconds it took to make what GetIndexMemorySize() counts.
   */
  double GetIndexTime();

  /**
   * Get how often this mapper has projected the volume. A render that changes only colours or
   * opacity reuses the last projection. In modes other than EXACT, changes of zoom, pan and roll
   * reuse it, too, and so does the view from the opposite side. See contract.md for all conditions.
   */
  vtkIdType GetNumberOfProjections();

  /**
   * Get the time of the last projection in seconds. It covers the steps from the volume to the
   * shear image, or in EXACT to the values of the screen's pixels.
   */
  double GetProjectionTime();

  /**
   * Get the instruction set of the loops in use: "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI".
   * It is the best that both the processor and the build have.
   */
  const char* GetInstructionSet();

  /**
   * Get whether the last render used one of VTK's ray casters.
   */
  vtkGetMacro(LastRenderUsedRayCasting, bool);

  ///@{
  /**
   * Set/Get the controller of the ranks among which the image is distributed. Default nullptr: the
   * input is the whole volume. With several ranks rendering is collective, and the input is a piece
   * of one vtkImageData with 0 (PREVIEW), 1 (STANDARD, EXACT) or 2 ghost layers (HIGH, and EXACT
   * with AutoAdjustSampleDistances). Settings, camera and window must be the same on all ranks. The
   * picture has the same bits as that of one rank. See ranks.md for restrictions.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  ///@{
  /**
   * Set/Get whether only the first of several ranks shows the picture, for compositors such as IceT
   * that blend the pictures of ranks. Default off: all ranks show the same picture.
   */
  vtkSetMacro(DisplayOnRootOnly, vtkTypeBool);
  vtkGetMacro(DisplayOnRootOnly, vtkTypeBool);
  vtkBooleanMacro(DisplayOnRootOnly, vtkTypeBool);
  ///@}

  /**
   * Update the input. With several ranks this call is collective. It also finds the bounds of all
   * pieces, which cameras need. Call it before the first frame and after the input moves, because a
   * volume is culled by its old bounds. Returns false, with an error, if the pieces do not belong
   * to one image.
   */
  bool UpdateWhole();

  /**
   * WARNING: INTERNAL METHOD - NOT INTENDED FOR GENERAL USE
   */
  void Render(vtkRenderer* ren, vtkVolume* vol) override;

  /**
   * WARNING: INTERNAL METHOD - NOT INTENDED FOR GENERAL USE
   */
  void ReleaseGraphicsResources(vtkWindow* window) override;

  /**
   * Get the bounds of the input. With several ranks they are the bounds of all pieces as of the
   * last Render() or UpdateWhole(), and nullptr before.
   */
  double* GetBounds() override;
  using Superclass::GetBounds;

protected:
  vtkSplattingMIPVolumeMapper();
  ~vtkSplattingMIPVolumeMapper() override;

  const char* RenderBySplatting(vtkRenderer* ren, vtkVolume* vol);
  void RenderByRayCasting(vtkRenderer* ren, vtkVolume* vol);
  void DisplayLocated(vtkRenderer* ren);
  void DisplayPicture(vtkRenderer* ren);

  /**
   * Draw a premultiplied RGBA picture of size[0] x size[1] pixels, bottom row first. Its lower left
   * pixel lies at origin in the viewport. Implemented by the subclass of the rendering backend.
   */
  virtual void DisplayImage(
    vtkRenderer* ren, const int origin[2], const int size[2], const unsigned char* rgba);

  /**
   * Write depths, from 0 (near) to 1 (far), where they are less than those of the depth buffer.
   * Values above 1 are skipped. The order is that of DisplayImage(). Implemented by the subclass of
   * the rendering backend.
   */
  virtual void DisplayDepths(
    vtkRenderer* ren, const int origin[2], const int size[2], const float* depths);

  /**
   * Read the depths, from 0 to 1, that have been rendered at pixels of the viewport. The order is
   * that of DisplayImage(). Returns false if they cannot be read.
   */
  virtual bool ReadDepth(vtkRenderer* ren, const int origin[2], const int size[2], float* depths);

private:
  bool LastRenderUsedRayCasting = false;
  vtkMultiProcessController* Controller = nullptr;
  vtkTypeBool DisplayOnRootOnly = 0;

  vtkSplattingMIPVolumeMapper(const vtkSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkSplattingMIPVolumeMapper&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};
VTK_ABI_NAMESPACE_END

#endif
