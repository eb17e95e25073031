// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPVolumeMapper
 * @brief   maximum intensity projection by splatting in sheared object space
 *
 * A vtkVolumeMapper that renders maximum intensity projections (MIP) of image data on the CPU. It
 * implements W. Cai and G. Sakas, "Maximum Intensity Projection Using Splatting in Sheared Object
 * Space", Computer Graphics Forum 17(3), 1998 ([CS98] below): the volume is sheared so that all
 * rays run along its principal axis, the image axis that the view direction follows most. Every
 * voxel of a slice then has the same footprint, a slice is splatted into a worksheet with a few
 * constant weights, the maximum over the worksheets is the shear image, and an affine warp brings
 * the shear image to the viewport, where the interpolated scalar is looked up in the transfer
 * functions of the vtkVolumeProperty. Averages are taken within a slice, maxima between slices.
 *
 * Perspective views have up to six shear images, one for each direction of an axis that some of
 * their rays follow most; rays are those of the eye, slices are scaled as they are sheared, each
 * pixel has weights of its own, and warps are projective. The eye may be anywhere, in the volume,
 * too: slices count whose middle lies before it.
 *
 * What is splatted: vtkImageData and vtkRectilinearGrid with point or cell scalars of any numeric
 * type, any extent, spacing, origin and direction matrix, any invertible prop matrix, any parallel
 * or perspective view, in the blend modes MAXIMUM_INTENSITY (the default here), MINIMUM_INTENSITY
 * and AVERAGE_INTENSITY. Rays are cut by the camera's clipping range, ClippingPlanes, Cropping, the
 * slab, the bounding surface, and opaque geometry in the scene.
 *
 * Other blend modes are passed, with the same settings but slab and bounding surface, to an
 * internal vtkFixedPointVolumeRayCastMapper (COMPOSITE) or vtkGPUVolumeRayCastMapper (the others);
 * a warning says so once. Hidden voxels and NaN have the lowest value there, and cells end at their
 * centres. The ray casters get a copy of the volume's property, in which gray functions are RGB
 * functions of the same values: VTK's GPU mapper knows no others, and would put one into the
 * property for good.
 *
 * Which scalars: those that ScalarMode, SelectScalarArray and VectorMode choose. Of 1 to 4
 * independent components (vtkVolumeProperty::IndependentComponents) each has a maximum of its own;
 * a pixel is the sum of weight * opacity * colour over components, each with its own transfer
 * functions and ComponentWeight, clamped. Each component's colour is rounded to 1/255 before the
 * sum. Of 2 or 4 dependent components the last one, the opacity, is projected, and the first ones,
 * a colour index or (unsigned char) red, green and blue, go with the sample that wins, the first
 * from the viewer of several; averages are taken of each. That looks at every sample: Acceleration
 * and CullBelowWindow have no effect. Components that are interleaved in memory are copied, those
 * of vtkSOADataArrayTemplate are not.
 *
 * Averages [AverageIPScalarRange]: the mean of a ray's samples (see SetMaximumType) in the range,
 * which is then coloured; VTK's GPU ray caster shows it as a gray. A sample counts for itself, not
 * by the length of the ray in it. A ray without any is transparent. VTK's default range is that of
 * float.
 *
 * Cells are voxels about the cells' centres, one less than points along each axis; an axis with one
 * point has one layer of cells about that point.
 *
 * Hidden voxels are no samples, like NaN: points with HIDDENPOINT and points all of whose cells
 * have HIDDENCELL, cells with HIDDENCELL and cells with a point that has HIDDENPOINT (the ghost
 * arrays of vtkUniformGrid::BlankPoint and BlankCell; call Modified() after these), and what
 * MaskInput hides. Duplicates are not hidden. This costs a copy in float (double for 32- and 64-bit
 * integers and double, so that integers beyond 2^53 are rounded) and projections without
 * acceleration.
 *
 * Rectilinear grids whose points lie within 1/1000 of a step of equal distances are splatted as
 * they are. Others are resampled once to the least step of each axis: points trilinearly, in float
 * (double for the wide types), cells piecewise constant. The copy has up to 2^26 voxels (or as many
 * as the grid, if these are more); beyond that, steps are enlarged by one factor. Peaks between the
 * points of the copy are lowered by the interpolation.
 *
 * In EXACT all cuts lie where they are. In the other modes, and in overviews, a slice counts for a
 * ray if the ray crosses it (voxels being boxes) and, where the ray is cut, if
 * the point where it crosses the middle of the slice is not cut away. If the cuts leave less than a
 * slice, the nearest one counts. Footprints that stick out of the volume repeat its outermost
 * voxels; those beside a clipping plane also read the voxels behind it.
 *
 * The picture ends where VTK's ray casters end it, at the outermost points (GetBounds()): voxel
 * centres for point scalars, the sides of voxels for cell scalars. An axis with one voxel is as
 * thick as that voxel.
 *
 * The interpolation type of the vtkVolumeProperty has no meaning here, and a change costs nothing:
 * the quality mode says how voxels are reconstructed, and shear images are always interpolated
 * between their pixels. (The default of the property is nearest, so that all volumes would look
 * like the preview if it had a meaning.)
 *
 * Selection by vtkHardwareSelector, and all that uses it (vtkRenderer::PickProp, vtkPropPicker),
 * finds the volume where its picture is not transparent. A volume is one thing there: composite
 * index 1, point and cell 0. A pass costs a frame with the last shear image, or a ray cast frame
 * where rays are cast. For the voxel that a pixel shows see SetRecordLocations().
 *
 * Aborting. While it projects, and while it makes chains, the mapper asks the render window's
 * CheckAbortStatus() between bands of image rows, on the thread that renders; in overviews, where
 * pixels are wider than voxels, also between rows of the picture. An aborted render draws nothing.
 * An aborted projection leaves no shear image; the next one projects anew. Events:
 * VolumeMapperRenderStartEvent, VolumeMapperRenderProgressEvent (only when projecting; call data:
 * pointer to double, from 0 to 1), VolumeMapperRenderEndEvent; ProgressEvent while chains are made.
 * Observers must not render with this mapper.
 *
 * Arithmetic. The preview compares voxels in their own type. Standard and high add weight times
 * voxel in float for 8- and 16-bit voxels and for float, in double for the other types; weights
 * are rounded to multiples of 2^-16 for 8-bit voxels (all sums are then exact), 2^-24 and 2^-48
 * else, and always sum to exactly 1. For n weights (9 standard, 75 high) the error is at most
 * n 2^-17 (max-min) for 8 bits, n 2^-24 (max-min) + (n+1) 2^-24 max|v| for 16 bits and float, and
 * the same with 2^-48 and 2^-53 for double. In perspective slices are cut into up to three parts,
 * whose weights are products of one for the column, one for the row and one for the slice and are
 * rounded likewise, for all types. Within a part they do not know that x and y grow together along
 * a ray: a covariance of at most 0.021 square voxels is lost. Exact extrema are computed in float,
 * for 32- and 64-bit integers and double in double, to 1e-6 and 1e-12 of (max-min). No step depends
 * on the number of threads or on the instruction set: the same input gives the same bits.
 *
 * NaN voxels are no samples: they never win and, in a worksheet, the average is taken over the
 * other voxels. Infinities are ordinary values. In EXACT a cell with a corner that is NaN, hidden
 * or infinite is not interpolated: each of its eight octants has the value of its nearest voxel, or
 * none if that voxel is hidden or NaN. Finite magnitudes must be at most 1e37 (of double 1e303), in
 * EXACT beside infinities 1e18 (1e150), so that nothing overflows. A ray without a sample is
 * transparent.
 *
 * For integers of up to 32 bits the lowest voxel is subtracted before voxels are
 * weighed and added again in the end: a flat background of that value is exact.
 *
 * Memory. For EXACT the mapper holds the largest voxel of every 4x4x4 and 8x8x8 cells (1/56 of the
 * volume, and as much for minima), else the largest voxel of every brick of 8x4x4 for each axis
 * (3/128 of the volume), a transposed copy of the volume once its first (fastest) image axis was
 * the principal one, chains of voxels where SetAcceleration asks for them, all of this for each
 * component, and a copy of the scalars if they are not stored voxel after voxel, if some are
 * hidden, or if they are resampled. GetIndexMemorySize() counts all, SetIndexMemoryBudget() limits
 * all but that copy and what EXACT holds (components have equal shares). Work space comes on top:
 * per component the shear image; the picture (two with several components); footprints (about 3 kB
 * a slice); for each thread some rows of voxels and the bounds of a band of tiles; per pixel of the
 * shear image up to 9 bytes where rays are cut, 12 for averages, 5 for depth shading and local
 * maxima, 4 for dependent components, 16 for a bounding surface; per pixel of the screen 4 for
 * depths; for each further renderer a copy of one component's shear image, for picks. Where all
 * this does not fit into the machine's memory, an error says so, nothing is drawn, and what the
 * mapper holds is given back; the next frame tries again. (With several ranks std::bad_alloc goes
 * on to the caller as well, for the others wait.)
 *
 * An axis has at most 16384 voxels: walks number the slices along a ray in 16 bits.
 *
 * Objects are made through VTK's object factory; the class that New() returns draws with OpenGL.
 *
 * @sa vtkFixedPointVolumeRayCastMapper vtkGPUVolumeRayCastMapper vtkVolumeProperty
 */
#ifndef vtkSplattingMIPVolumeMapper_h
#define vtkSplattingMIPVolumeMapper_h

#include "vtkAbstractSplattingMIPVolumeMapper.h"
#include "vtkRenderingSplattingMIPModule.h" // for the export macro

#include <memory> // for the hidden implementation

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
   * AutoAdjustSampleDistances). PREVIEW for EXACT in overviews, HIGH for averages and dependent
   * components in EXACT. EXACT before the first projection.
   */
  int GetQualityModeUsed();

  /**
   * The acceleration of the last projection: never AUTO; DENSE before the first one.
   */
  int GetAccelerationUsed();

  /**
   * Where the samples of the last render lie, as point arrays with one point for each pixel of the
   * renderer's viewport. Extent and coordinates (origin 0, spacing 1) are pixels of the window; of
   * a tiled window, those of the last tile.
   * - "Voxel", three ints: the image's i, j, k relative to its first voxel. In PREVIEW the voxel
   *   that wins; in STANDARD and HIGH the voxel of the slice that adds most to the average: largest
   *   weight times its height above the lowest scalar (for minima below the highest).
   * - "Depth", float: the distance in world units, from the plane through the camera's position
   *   across the direction of projection, in perspective from the eye.
   * - "Position", three doubles: the point of the world. It lies on the ray of the pixel, where
   *   this crosses the middle of the slice that the sample is of; in EXACT where the interpolated
   *   volume has its extremum, the nearest to the viewer of several. "Voxel" is the nearest to it.
   *
   * Pixels without a sample, or hidden by other things, have voxel -1 and NaN. nullptr, with an
   * error message, unless RecordLocations is on; nullptr if nothing has been splatted, and as for
   * picks if the volume is no longer shown or its scalars are gone. Computed when first asked for
   * after a render, in some milliseconds.
   */
  vtkImageData* GetLocations();

  ///@{
  /**
   * What a pixel of the window shows, in any of the viewports that this mapper has rendered in; of
   * several windows, in the one that it has rendered in last. It is the sample of the shear pixel
   * nearest to it, in EXACT that of its own ray; the same as GetLocations() returns.
   * RecordLocations need not be on: without it one pixel is projected, in about a millisecond. (x,
   * y) are display coordinates, as vtkRenderWindowInteractor::GetEventPosition() gives them.
   *
   * - PickWorldPosition(): the point of the world to measure from. It lies on the pixel's ray,
   *   where this crosses the middle of the slice that the sample is of (in EXACT, where the field
   *   has the value): "Position" of GetLocations().
   * - PickVoxel(): i, j and k, relative to the image's first voxel, of the voxel that the sample
   *   comes from: "Voxel" of GetLocations().
   * - PickValue(): the sample's value, in units of the scalars: in PREVIEW the voxel's, in the
   * other modes an average or, in EXACT, the extremum. Pictures interpolate between samples, but
   * not EXACT's maxima.
   *
   * Return false (PickValue: NaN) and leave the output unchanged
   * - if the last frames of the renderers have no sample of this mapper there; whether the sample
   * is opaque does not matter;
   * - if the volume is invisible or removed, or the last frame of its renderer has not rendered it;
   * - if the scalars of that frame have been deleted, reallocated or modified since;
   * - for averages;
   * - for several ranks without RecordLocations.
   */
  bool PickWorldPosition(int x, int y, double position[3]);
  bool PickVoxel(int x, int y, int ijk[3]);
  double PickValue(int x, int y);
  ///@}

  /**
   * Get the last shear image, or nullptr before the first render and in EXACT, which has none. Its
   * spacing is 1.
   * Scalars: as many components as are projected, in the input's type in mode PREVIEW (that of the
   * copy, if voxels are hidden or resampled, or a magnitude), else, and for averages and depth
   * shading, float (double for 32- and 64-bit integers and double). The image's physical
   * coordinates are voxel indices, relative to the volume's first voxel, on the volume's middle
   * slice along the principal axis: the ray of pixel (u, v) at origin + spacing * (u, v) crosses
   * slice k there at that point minus GetShear() * (k - (slices-1)/2). In perspective it is the
   * largest of the view's shear images. Coordinates are then voxel indices where the volume is
   * farthest from the eye, half a slice beyond the farthest slice; the spacing is a little less
   * than 1, and the last columns may belong to no ray of the view. Pixels
   * whose ray meets no sample of any component are marked hidden in the ghost array. Axes: for
   * principal axis 2 the image's x and y are the volume's first and second axis, for 1 first and
   * third, for 0 second and third. Costs a copy of the shear image; the caller must not change it.
   */
  vtkImageData* GetShearImage();

  /**
   * The image axis (0, 1 or 2) along which the last render projected, in perspective that of
   * GetShearImage(); -1 before the first render and in EXACT.
   */
  int GetPrincipalAxis();

  ///@{
  /**
   * The shears of the last render, in pixels per slice: slice k is moved by shear * k along the
   * shear image's x and y. At most 1 in magnitude; rounded to multiples of 2^-24 so that equal
   * views have equal bits. In perspective, where rays differ: the slopes of the middle
   * pixel's ray, in voxels per slice.
   */
  void GetShear(double shear[2]);
  double* GetShear() VTK_SIZEHINT(2);
  ///@}

  /**
   * Bytes held for the data set last rendered, besides the input and work space: bricks, chains,
   * copies.
   */
  vtkIdType GetIndexMemorySize();

  /**
   * Seconds that it took to make what is held for the data set last rendered.
   */
  double GetIndexTime();

  /**
   * How often this mapper has projected the volume. A render that changes only colours, opacity,
   * the window, or the camera's position and zoom, or looks from the other side, re-uses the last
   * shear image and leaves the number as it is; unless what cuts the volume has moved with the
   * camera (its clipping range, geometry in the scene), CullBelowWindow finds another window, or
   * depth shading and local maxima are seen from the other side. In perspective the eye must stay
   * where it is, and the whole volume in the window: it may then turn, roll and zoom.
   */
  vtkIdType GetNumberOfProjections();

  /**
   * Seconds that the last projection (volume to shear image) took.
   */
  double GetProjectionTime();

  /**
   * The instruction set of the loops in use: "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI", the
   * best that both the processor and the build have.
   */
  const char* GetInstructionSet();

  /**
   * Whether the last render was passed to one of VTK's ray casters.
   */
  vtkGetMacro(LastRenderUsedRayCasting, bool);

  ///@{
  /**
   * The ranks among which the image is distributed. nullptr (the default), or a controller with one
   * rank: the input is the whole volume.
   *
   * With several ranks each one has a mapper with the same settings, a renderer with the same
   * camera and size, and as input its piece of one vtkImageData: the extent says where, origin,
   * spacing, direction and type of scalars are common. Pieces may be of any size and overlap. Next
   * to others they need ghost layers: none in preview, 1 voxel in standard, 2 in high and exact
   * mode, in all directions. A rank that has nothing has an empty vtkImageData. Each rank projects
   * its piece onto the shear image of the whole, the images are reduced with MAX (MIN) over the
   * controller, and each rank colours and shows the result: the picture has the same bits as one
   * rank's, for any pieces.
   *
   * Rendering is collective then: all ranks must render as often, also while the volume is
   * invisible, or wait for each other for ever. Set nullptr to end that. GetBounds() are those of
   * the whole, so that a frustum culls on all ranks or on none. What is wrong on one rank is told
   * by all, and all skip the frame. So they do where ranks differ in a setting that changes the
   * picture, or, from the second frame on, in whether they render the volume.
   *
   * Projected are global and depth-shaded maxima and minima of independent components; anything
   * else is refused with a sentence, as are rectilinear grids. Chains are walked as bricks, without
   * LineTolerance. Geometry that hides the volume must be the same on all ranks, or
   * IntermixIntersectingGeometry be off. Of locations, voxels in STANDARD and HIGH are those that
   * rays pass in the middle of the slice.
   *
   * A frame costs three or four reductions of 4 bytes and a gathering of about 500 bytes from each
   * rank. If it projects, each shear image, in exact mode the picture's scalars, is reduced as
   * well: 1 to 8 bytes a pixel in preview, 4 (8 for 32- and 64-bit integers and double) in the
   * other modes, 4 more for locations, and the memory of one more image.
   */
  virtual void SetController(vtkMultiProcessController*);
  virtual vtkMultiProcessController* GetController();
  ///@}

  ///@{
  /**
   * Whether only the first of several ranks shows the picture, as where a compositor such as IceT
   * blends the ranks' pictures over each other. Off by default: all ranks show the same.
   */
  virtual void SetDisplayOnRootOnly(bool);
  virtual bool GetDisplayOnRootOnly();
  vtkBooleanMacro(DisplayOnRootOnly, bool);
  ///@}

  /**
   * Updates the input, and with several ranks finds the bounds of the whole, which cameras can then
   * be set by. Collective. Call it before the first frame and when the input moves; Render() does
   * the same once it is under way, but a volume whose old bounds are out of sight is culled before.
   * False, with an error, if the pieces are not of one image.
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
   * The bounds of the input; with several ranks those of the whole of all pieces, as of the last
   * Render() or UpdateWhole(), and nullptr before the first of these.
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
   * Draw a premultiplied RGBA picture of size[0] x size[1] pixels, bottom row first, with its lower
   * left pixel at origin in the renderer's viewport. The rendering backend's subclass does it.
   */
  virtual void DisplayImage(
    vtkRenderer* ren, const int origin[2], const int size[2], const unsigned char* rgba);

  /**
   * Write depths, from 0 (near) to 1 (far), where they are less than what the depth buffer has.
   * Values above 1 are not written. The same order as in DisplayImage(). The rendering backend's
   * subclass does it.
   */
  virtual void DisplayDepths(
    vtkRenderer* ren, const int origin[2], const int size[2], const float* depths);

  /**
   * The depths, from 0 to 1, that have been rendered so far at pixels of the renderer's viewport.
   * The same order as in DisplayImage. False if they cannot be read.
   */
  virtual bool ReadDepth(vtkRenderer* ren, const int origin[2], const int size[2], float* depths);

  bool LastRenderUsedRayCasting;

private:
  vtkSplattingMIPVolumeMapper(const vtkSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkSplattingMIPVolumeMapper&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
