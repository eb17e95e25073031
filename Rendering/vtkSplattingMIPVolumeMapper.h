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
 * centres. They get a copy of the volume's property, in which gray functions are RGB functions of
 * the same values: VTK's GPU mapper knows no others, and would put one into the property for good.
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
 * A slice counts for a ray if the ray crosses it (voxels being boxes) and, where the ray is cut, if
 * the point where it crosses the middle of the slice is left. Where a cut leaves less than a slice,
 * the nearest one counts. Footprints that stick out of the volume repeat its outermost voxels;
 * those beside a plane read beyond it.
 *
 * The picture ends where VTK's ray casters end it, at the outermost points (GetBounds()): voxel
 * centres for point scalars, the sides of voxels for cell scalars. An axis with one voxel is as
 * thick as that voxel.
 *
 * The interpolation type of the vtkVolumeProperty has no meaning here, and a change costs nothing:
 * the quality mode says how voxels are reconstructed, and the shear image is always interpolated
 * between its pixels. (The default of the property is nearest, so that all volumes would look like
 * the preview if it had a meaning.)
 *
 * Selection by vtkHardwareSelector, and all that uses it (vtkRenderer::PickProp, vtkPropPicker),
 * finds the volume where its picture is not transparent. A volume is one thing there: composite
 * index 1, point and cell 0. A pass costs a frame with the last shear image, or a ray cast frame
 * where rays are cast. For the voxel that a pixel shows see SetRecordLocations().
 *
 * Aborting. While it projects, and while it makes chains, the mapper asks the render window's
 * CheckAbortStatus() between bands of image rows, on the thread that renders. An aborted render
 * draws nothing and leaves no shear image; the next one projects anew. Events:
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
 * rounded likewise, for all types; that x and y grow together along a ray within a part is left
 * out, a covariance of no more than 0.01 square voxels. Exact maxima have up to 24 roundings of
 * max|v| (of (max-min) for integers of up to 32 bits), in perspective up to 80. No step depends on
 * the number of threads or on the instruction set: the same input gives the same bits.
 *
 * NaN voxels are no samples: they never win and, in a worksheet, the average is taken over the
 * other voxels. Infinities are ordinary values. A ray without a sample is transparent.
 *
 * For integers of up to 32 bits the lowest voxel is subtracted before voxels are
 * weighed and added again in the end: a flat background of that value is exact.
 *
 * Memory. The mapper holds the largest voxel of every brick of 8x4x4 for each axis (3/128 of the
 * volume), a transposed copy of the volume once its first (fastest) image axis was the principal
 * one, chains of voxels where SetAcceleration asks for them, all of this for each component, and a
 * copy of scalars that are not stored voxel after voxel, hidden or resampled; GetIndexMemorySize()
 * counts all, SetIndexMemoryBudget() limits all but the last (components have equal shares). Work
 * space comes on top: per component the shear image; the picture (two with several components);
 * footprints (about 3 kB a slice); for each thread some rows of voxels and the bounds of a band of
 * tiles; per pixel of the shear image up to 9 bytes where rays are cut, 12 for averages, 5 for
 * depth shading and local maxima, 4 for dependent components, 16 for a bounding surface; per pixel
 * of the screen 4 for depths. Where all this does not fit into the machine's memory, an error says
 * so, nothing is drawn, and what the mapper holds is given back; the next frame tries again. (With
 * several ranks std::bad_alloc goes on to the caller as well, for the others wait.)
 *
 * An axis has at most 16384 voxels: walks number the slices along a ray in 16 bits.
 *
 * Objects are made through VTK's object factory; the class that New() returns draws with OpenGL.
 *
 * @sa vtkFixedPointVolumeRayCastMapper vtkGPUVolumeRayCastMapper vtkVolumeProperty
 */
#ifndef vtkSplattingMIPVolumeMapper_h
#define vtkSplattingMIPVolumeMapper_h

#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkVolumeMapper.h"

#include <memory> // for the hidden implementation

class vtkImageData;
class vtkMultiProcessController;
class vtkPolyData;
class vtkScalarsToColors;
class vtkVolumeProperty;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkSplattingMIPVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkSplattingMIPVolumeMapper* New();
  vtkTypeMacro(vtkSplattingMIPVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The values of vtkSmartVolumeMapper's VectorMode.
   */
  enum VectorModes
  {
    DISABLED = -1,
    MAGNITUDE = 0,
    COMPONENT = 1
  };

  enum QualityModes
  {
    PREVIEW = 0,
    STANDARD = 1,
    HIGH = 2,
    EXACT = 3
  };

  static constexpr int SAMPLING_OF_MODE = -1;
  static constexpr int AUTOMATIC_SAMPLING = 0;

  enum Kernels
  {
    TRILINEAR = 0,
    COSINE_BELL = 1
  };

  enum MaximumTypes
  {
    GLOBAL = 0,
    DEPTH_SHADED = 1,
    LOCAL = 2
  };

  enum Accelerations
  {
    AUTO = 0,
    DENSE = 1,
    BRICKS = 2,
    LINES = 3,
    SORTED_LINES = 4,
    SORTED_VOLUME = 5
  };

  ///@{
  /**
   * What is projected of scalars with several components, as in vtkSmartVolumeMapper. Default
   * DISABLED: all of them (see above). MAGNITUDE: the Euclidean length, in float (double for 32-
   * and 64-bit integers and double), so that it neither overflows nor is rounded to an integer; one
   * component is taken as it is. COMPONENT: the one that VectorComponent names. Both take the first
   * transfer functions of the property, which they leave alone; they cost a copy, unless the
   * component is stored by itself.
   */
  vtkSetClampMacro(VectorMode, int, DISABLED, COMPONENT);
  vtkGetMacro(VectorMode, int);
  void SetVectorModeToDisabled() { this->SetVectorMode(DISABLED); }
  void SetVectorModeToMagnitude() { this->SetVectorMode(MAGNITUDE); }
  void SetVectorModeToComponent() { this->SetVectorMode(COMPONENT); }
  const char* GetVectorModeAsString();
  ///@}

  ///@{
  /**
   * The component that VectorMode COMPONENT projects. Default 0, clamped to [0, 3]; scalars with
   * fewer components give an error.
   */
  vtkSetClampMacro(VectorComponent, int, 0, 3);
  vtkGetMacro(VectorComponent, int);
  ///@}

  ///@{
  /**
   * A binary mask, as vtkGPUVolumeRayCastMapper's: voxels where it is 0 are hidden, all others are
   * shown. Scalars of type unsigned char with one component (of the mask's points, or of its cells
   * if its points have none), one for each voxel of the input; spacing and origin do not matter.
   * Default none. Costs the copy that hidden voxels cost.
   */
  virtual void SetMaskInput(vtkImageData* mask);
  vtkGetObjectMacro(MaskInput, vtkImageData);
  ///@}

  ///@{
  /**
   * What a slice contributes to a pixel of the shear image [CS98, section 2 and 3]. Default EXACT.
   *
   * PREVIEW: the largest of the voxels that the pixel's ray crosses in the slice (up to three), so
   * that the shear image equals an exact voxel traversal bit for bit. Fastest.
   * STANDARD: the average of the piecewise constant volume over the pixel's area and the slice's
   * thickness (3x3 weights).
   * HIGH: the average of the volume, interpolated with Kernel, over the same region (5x5 weights
   * from each of three slices).
   * EXACT: the largest value that the trilinearly interpolated volume takes along the pixel's ray,
   * found analytically, cell by cell [Sakas et al. 1995]: no sample distance can miss it, and
   * nothing is averaged. The interpolated volume ends at the centres of the outermost voxels (at
   * the ends of their boxes for cell data); a cell with a NaN voxel is left out. For maxima of all
   * MaximumTypes; minima, averages and dependent components are those of HIGH. A shear image costs
   * about twice HIGH's in parallel views, and by default EXACT makes sixteen of them, see
   * ShearImageSampling. Where all of the volume is seen in pixels that are wider than voxels, it
   * takes of each slice the voxel that a ray passes nearest to: the field is nowhere larger than at
   * voxels, so that no maximum is lost, and that is the fastest of all.
   *
   * In an overview, where pixels are wider than voxels in some direction, a pixel shows the largest
   * value over its area (of minima the least, of averages the average), in all modes. Else it shows
   * the value at its centre.
   *
   * In perspective a pixel's area is as wide as rays are apart: nearly a voxel where the volume is
   * farthest from the eye, and less in nearer slices.
   */
  vtkSetClampMacro(QualityMode, int, PREVIEW, EXACT);
  vtkGetMacro(QualityMode, int);
  void SetQualityModeToPreview() { this->SetQualityMode(PREVIEW); }
  void SetQualityModeToStandard() { this->SetQualityMode(STANDARD); }
  void SetQualityModeToHigh() { this->SetQualityMode(HIGH); }
  void SetQualityModeToExact() { this->SetQualityMode(EXACT); }
  const char* GetQualityModeAsString();
  ///@}

  ///@{
  /**
   * Whether a faster quality mode takes the place of QualityMode where frames were measured to take
   * longer than the volume's allocated render time, which follows from the render window's desired
   * update rate; interactor styles change that during interaction. Each mode is timed, for each
   * renderer and volume, by frames that project (but the first one, and less what is made once per
   * data set): EXACT gives way to HIGH, HIGH to STANDARD, STANDARD to PREVIEW, and back once a
   * better mode is expected to take no more than 80 % of the time. A mode that was not measured yet
   * is taken to fit. So the first frame, and a still one with its hours to spare, is in
   * QualityMode. A shear image in a better mode (up to QualityMode) that shows the view already is
   * kept. The picture's resolution is never reduced. GetQualityModeUsed() tells. Off: always
   * QualityMode. Views that are ray cast ignore it. Default on.
   */
  vtkSetClampMacro(AutoAdjustSampleDistances, vtkTypeBool, 0, 1);
  vtkGetMacro(AutoAdjustSampleDistances, vtkTypeBool);
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  ///@}

  /**
   * The quality mode of the last projection: QualityMode, or a faster one, see
   * AutoAdjustSampleDistances. HIGH before the first one.
   */
  int GetQualityModeUsed();

  ///@{
  /**
   * Window and level applied to the picture's colours, for brightness and contrast: a colour c,
   * from 0 to 1, becomes (c - FinalColorLevel) / FinalColorWindow + 1/2. The opacity A stays, so
   * that premultiplied colours C become C / FinalColorWindow + A (1/2 - FinalColorLevel /
   * FinalColorWindow), cut off at 0 and 1, as in VTK's ray casters: bright colours of translucent
   * pixels may exceed their opacity. Both must be finite; the window may be negative (the picture
   * is then inverted), but not 0. Default 1 and 0.5, which change nothing. A change costs a new
   * table of colours; the shear image is used again (unless CullBelowWindow finds another window).
   */
  vtkSetMacro(FinalColorWindow, float);
  vtkGetMacro(FinalColorWindow, float);
  vtkSetMacro(FinalColorLevel, float);
  vtkGetMacro(FinalColorLevel, float);
  ///@}

  ///@{
  /**
   * The reconstruction kernel h of mode HIGH along each axis, t in voxels [CS98, section 3].
   * TRILINEAR (default): h(t) = 1-|t| for |t| < 1. COSINE_BELL: h(t) = (1 + cos(pi t / r)) / 2 for
   * |t| < r = KernelRadius. The other modes ignore it.
   */
  vtkSetClampMacro(Kernel, int, TRILINEAR, COSINE_BELL);
  vtkGetMacro(Kernel, int);
  void SetKernelToTrilinear() { this->SetKernel(TRILINEAR); }
  void SetKernelToCosineBell() { this->SetKernel(COSINE_BELL); }
  const char* GetKernelAsString();
  ///@}

  ///@{
  /**
   * The radius r of the cosine bell in voxels, default 1, clamped to [0.5, 1.5] (a wider bell would
   * leave the 5x5 weights). r = 1 sums to one by itself, other radii are normalised. Below 0.501,
   * FootprintSampling 1 is as 2: the bell would end before a lone sub-pixel's centre.
   */
  vtkSetClampMacro(KernelRadius, double, 0.5, 1.5);
  vtkGetMacro(KernelRadius, double);
  ///@}

  ///@{
  /**
   * Which maximum along a ray is shown in blend mode MAXIMUM_INTENSITY. Default GLOBAL. A ray's
   * samples are, in mode PREVIEW, the voxels that it crosses, and in the other modes the averages
   * of its slices.
   *
   * GLOBAL: the largest of all.
   * DEPTH_SHADED: each sample is dimmed by its depth before the maximum is taken (DMIP) [Bruckner,
   * "Performing Maximum Intensity Projection with the Visualization Toolkit", Program 4.3]: the
   * n-th slice of the N that the ray crosses inside planes and slab, n = 0 being the nearest to the
   * viewer, by ambient + (1 - n / N) changeRate. Samples count from the lowest scalar of the volume
   * here, so that Hounsfield units are dimmed like bytes. The shear image is float (double for 32-
   * and 64-bit integers and double) in all modes.
   * LOCAL: the first local maximum, seen from the viewer, that is no less than
   * LocalMaximumThreshold, and where there is none the largest of all [Sato et al. 1998].
   *
   * DEPTH_SHADED and LOCAL depend on the side that the viewer is on. They, and the blend modes
   * MINIMUM_INTENSITY and AVERAGE_INTENSITY, look at every sample: Acceleration has no effect.
   */
  vtkSetClampMacro(MaximumType, int, GLOBAL, LOCAL);
  vtkGetMacro(MaximumType, int);
  void SetMaximumTypeToGlobal() { this->SetMaximumType(GLOBAL); }
  void SetMaximumTypeToDepthShaded() { this->SetMaximumType(DEPTH_SHADED); }
  void SetMaximumTypeToLocal() { this->SetMaximumType(LOCAL); }
  const char* GetMaximumTypeAsString();
  ///@}

  ///@{
  /**
   * Of depth shading: what is left of a sample at the far end of the ray, and what is added to that
   * at the near end. Defaults 0.3 and 0.7: from everything to 30 %. Ambient 1 and change rate 0
   * give the plain maximum. Magnitudes that sum to no more than a million.
   */
  vtkSetMacro(DepthShadingAmbient, double);
  vtkGetMacro(DepthShadingAmbient, double);
  vtkSetMacro(DepthShadingChangeRate, double);
  vtkGetMacro(DepthShadingChangeRate, double);
  ///@}

  ///@{
  /**
   * Of local maxima: the scalar from which on they count. Default 0.
   */
  vtkSetMacro(LocalMaximumThreshold, double);
  vtkGetMacro(LocalMaximumThreshold, double);
  ///@}

  ///@{
  /**
   * Show only a slab across the view (thin-slab or sliding MIP): what lies within SlabThickness / 2
   * of the plane through SlabCenter, a point of the world, that is orthogonal to the rays, in
   * perspective parallel to the plane of the picture. Default off. Each new place of the slab is
   * one projection of the slices in it; nothing is indexed anew. It cuts as ClippingPlanes do: a
   * ray that has the middle of no slice inside shows the nearest one, so that a thin slab shows one
   * slice.
   */
  vtkSetMacro(Slab, bool);
  vtkGetMacro(Slab, bool);
  vtkBooleanMacro(Slab, bool);
  ///@}

  ///@{
  /**
   * The thickness of the slab in world units, above 0; default 10, the usual slab of clinical
   * volumes in millimetres.
   */
  vtkSetMacro(SlabThickness, double);
  vtkGetMacro(SlabThickness, double);
  ///@}

  ///@{
  /**
   * A point of the world in the middle of the slab, by default (0, 0, 0).
   */
  vtkSetVector3Macro(SlabCenter, double);
  vtkGetVector3Macro(SlabCenter, double);
  ///@}

  ///@{
  /**
   * A closed surface in world coordinates that the volume is shown in, whatever its shape (the
   * successor of vtkProjectedPolyDataRayBounder); nullptr, the default, for none. Each ray is cut
   * to the part between its first and its last crossing with the surface, to which hollows and
   * holes on the ray's way belong; rays that miss it show nothing. Polygons and strips count, in
   * any orientation. Rays that cross a surface that is not closed once show nothing; a warning says
   * that it is open.
   *
   * The surface is drawn in software once for each view direction, about a millisecond for ten
   * thousand triangles, and only triangulated again when it is modified.
   */
  virtual void SetBoundingSurface(vtkPolyData* surface);
  vtkGetObjectMacro(BoundingSurface, vtkPolyData);
  ///@}

  ///@{
  /**
   * Whether opaque geometry that was rendered before hides what lies behind it; default on. The
   * depth buffer is read where the volume is seen, if the renderer has rendered other props. What
   * lies before the volume hides it, pixel by pixel of the screen; what lies inside ends the rays
   * of the shear image, so that its edges are as soft as the shear image's pixels are large; what
   * lies behind the volume does not matter, and the shear image is used again. Geometry between a
   * part that Cropping or BoundingSurface takes away and what is left counts as inside. With
   * geometry inside, panning and zooming project anew.
   */
  vtkSetMacro(IntermixIntersectingGeometry, vtkTypeBool);
  vtkGetMacro(IntermixIntersectingGeometry, vtkTypeBool);
  vtkBooleanMacro(IntermixIntersectingGeometry, vtkTypeBool);
  ///@}

  ///@{
  /**
   * How the footprint weights are obtained. 0 (default): closed form. N in [1, 64]: from the
   * paper's general table, digitised at N x N sub-pixels per pixel [CS98, section 3], whose weights
   * tend to the closed form as N grows. Perspective views always have the closed form. A view makes
   * its table once, for all slices and phases of a finer shear image. That takes time and memory in
   * proportion to (N ShearImageSampling)^2: at most two seconds of one core and 60 MB, for N = 64,
   * a sampling of 4 and the widest bell; 10 ms for N = 16 and a sampling of 1. A projection then
   * takes at most 1 ms of one core for each slice and phase more.
   */
  vtkSetClampMacro(FootprintSampling, int, 0, 64);
  vtkGetMacro(FootprintSampling, int);
  ///@}

  ///@{
  /**
   * How many pixels the shear image has along the side of a voxel (in perspective, where the volume
   * is farthest from the eye): 1, 2 or 4; 3 is taken as 2. What STANDARD and HIGH average over
   * shrinks with the pixels. The time of a projection grows with their number. AUTOMATIC_SAMPLING
   * (0): the least of the three with which a pixel of the shear image is no wider than one of the
   * screen, or 4. SAMPLING_OF_MODE (-1, the default): in EXACT as AUTOMATIC_SAMPLING; in the other
   * modes 1, as in [CS98]. These place what is small up to half a voxel off where it is magnified;
   * with AUTOMATIC_SAMPLING they do not. In EXACT the picture between pixels is interpolated: with
   * 4 it is at least 45 dB from the field's maxima, with fewer at least 36.
   */
  vtkSetClampMacro(ShearImageSampling, int, SAMPLING_OF_MODE, 4);
  vtkGetMacro(ShearImageSampling, int);
  ///@}

  ///@{
  /**
   * What the projection leaves out and in which order it meets the rest. All give the same picture,
   * bit for bit (but for LineTolerance, CullBelowWindow and the sign of zeros). Default AUTO.
   *
   * DENSE: every voxel, in the order of memory.
   * BRICKS: the volume is divided into bricks of 8x4x4 voxels. Where no brick behind a tile of 8x4
   * pixels can exceed the tile's least pixel so far, nothing is splatted; slices with high bricks
   * come first.
   * LINES: chains of equal voxels along rows take the place of voxels [CS98, section 4], encoded
   * once for each principal axis on first need (with ProgressEvents). In modes STANDARD and HIGH
   * each pixel has a footprint of its own at the chains' ends only.
   * SORTED_LINES: in mode PREVIEW, the chains of each slice from high to low values. The other
   * modes use LINES. SORTED_VOLUME: in mode PREVIEW, the chains of all slices from high to low
   * values; a pixel that has a value is done [CS98, footnote 2]. The other modes use LINES.
   *
   * AUTO takes BRICKS, unless the last frame that used them along this principal axis in this
   * mode, with cut rays or without, still had to splat more than a share of the tiles: 30 % in
   * PREVIEW, 40 % in STANDARD (in perspective 50 %), 60 % in HIGH and EXACT, and ten less where
   * AVX-512 computes faster (30 % in STANDARD of parallel views, 50 % in HIGH and EXACT). Then it
   * takes DENSE for 32 frames, but in HIGH and EXACT for fewer, in proportion, the nearer the share
   * was to the limit (from there, 0 frames, to all tiles, as in noise everywhere), and tries BRICKS
   * again. It never takes chains, which are slower on all data that we measured
   * (splatmip-paper reports it), but need less memory than the volume.
   *
   * Where rays are cut and in perspective, BRICKS take the place of chains. Volumes with NaN or
   * infinity are walked densely, as are all when IndexMemoryBudget has no room for the index;
   * GetAccelerationUsed() tells.
   */
  vtkSetClampMacro(Acceleration, int, AUTO, SORTED_VOLUME);
  vtkGetMacro(Acceleration, int);
  void SetAccelerationToAuto() { this->SetAcceleration(AUTO); }
  void SetAccelerationToDense() { this->SetAcceleration(DENSE); }
  void SetAccelerationToBricks() { this->SetAcceleration(BRICKS); }
  void SetAccelerationToLines() { this->SetAcceleration(LINES); }
  void SetAccelerationToSortedLines() { this->SetAcceleration(SORTED_LINES); }
  void SetAccelerationToSortedVolume() { this->SetAcceleration(SORTED_VOLUME); }
  const char* GetAccelerationAsString();
  ///@}

  /**
   * The acceleration of the last projection: never AUTO; DENSE before the first one.
   */
  int GetAccelerationUsed();

  ///@{
  /**
   * Delta encoding of the chains [CS98, section 4]: a voxel v may join a chain whose value differs
   * by up to N (high - v) / 255, where N is LineTolerance and high the largest scalar: N grey
   * levels of 255 at the lowest scalar, none at the largest, for every scalar type. In the same way
   * a pixel p of the shear image differs by no more than N (high - p) / 255, in all modes. Fewer
   * chains, less memory, faster: it pays where neighbours differ by noise, as in nearly all 16-bit
   * and float data, whose chains have one voxel without it. Default 0 (none), clamped to [0, 64].
   * Only the accelerations with chains use it; a change encodes anew.
   */
  vtkSetClampMacro(LineTolerance, double, 0.0, 64.0);
  vtkGetMacro(LineTolerance, double);
  ///@}

  ///@{
  /**
   * Leave voxels out of the chains that no ray can see, because a higher voxel lies before or
   * behind on each [Mroz, Hauser, Groeller 2000]. The picture stays the same, bit for bit. Mode
   * PREVIEW only; the other modes are encoded with all voxels. Default off: it pays where chains
   * are used for a turn of a smooth volume.
   */
  vtkSetMacro(EliminateInvisible, bool);
  vtkGetMacro(EliminateInvisible, bool);
  vtkBooleanMacro(EliminateInvisible, bool);
  ///@}

  ///@{
  /**
   * Do not tell values apart below the window: scalars, from the lowest one up, that all have the
   * colour and opacity of the lowest one. What cannot rise above them is left out. The shear image
   * is the larger of the window's lower end and what it would be otherwise; since the picture
   * interpolates between its pixels, edges against the background become brighter by up to half a
   * pixel. MaximumType GLOBAL only. Default off.
   */
  vtkSetMacro(CullBelowWindow, bool);
  vtkGetMacro(CullBelowWindow, bool);
  vtkBooleanMacro(CullBelowWindow, bool);
  ///@}

  ///@{
  /**
   * Bytes that the index may hold besides the input: bricks (3/128 of the volume), chains, and the
   * copy (as large as the volume) for views along the first axis, in which rows of memory are rays.
   * What would exceed them is not made, with one warning: the projection is DENSE, and without the
   * copy 32 slices at a time are transposed in every frame. Default 4 GiB. 0: none.
   */
  vtkSetClampMacro(IndexMemoryBudget, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(IndexMemoryBudget, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Find out where the samples lie that the picture shows, for GetLocations(). Default off;
   * DepthCoding and WriteDepth need it and do it by themselves. Projections take two to three times
   * as long, previews four to six times, and 4 bytes for each pixel of the shear image, and as
   * many again as the pixel has.
   *
   * The sample of a ray is the one that its value comes from; of equal ones the nearest to the
   * viewer, whatever the acceleration and the number of threads. In mode PREVIEW it is a voxel, in
   * the other modes the average of a slice. A pixel of the picture has the sample of the shear
   * pixel nearest to it, of those that its value is interpolated between. Averages have none: a
   * warning says so, once. Of independent components the first one is located, of dependent ones
   * the last. Blend modes that are ray cast have no locations.
   */
  vtkSetMacro(RecordLocations, bool);
  vtkGetMacro(RecordLocations, bool);
  vtkBooleanMacro(RecordLocations, bool);
  ///@}

  /**
   * Where the samples of the last render lie: point arrays for the pixels of the renderer's part of
   * the window, whose pixels the image's extent (and, with origin 0 and spacing 1, its coordinates)
   * count; of a tiled window that of the last tile.
   * - "Voxel", three ints: the image's i, j, k relative to its first voxel. In PREVIEW the voxel
   *   that wins; in STANDARD and HIGH the voxel of the slice that adds most to the average: largest
   *   weight times its height above the lowest scalar (for minima below the highest).
   * - "Depth", float: the distance in world units, from the plane through the camera's position
   *   across the direction of projection, in perspective from the eye.
   * - "Position", three doubles: the point of the world. It lies on the ray of the pixel, where
   *   this crosses the middle of the slice that the sample is of.
   *
   * Pixels without a sample, or hidden by other things, have voxel -1 and NaN. nullptr, with an
   * error message, unless RecordLocations is on; nullptr where nothing has been splatted. Computed
   * when first asked for after a render, in some milliseconds; the input must not have changed by
   * then.
   */
  vtkImageData* GetLocations();

  ///@{
  /**
   * What a pixel of the window shows: the sample of the shear pixel nearest to it, as
   * RecordLocations finds it, which need not be on: one ray is looked along, in about a
   * millisecond. (x, y) are display coordinates, as vtkRenderWindowInteractor::GetEventPosition()
   * gives them.
   *
   * - PickWorldPosition(): the point of the world to measure from. It lies on the pixel's ray,
   * where this crosses the middle of the slice that the sample is of (in EXACT, at the depth of the
   *   field's extremum): "Position" of GetLocations().
   * - PickVoxel(): i, j and k, relative to the image's first voxel, of the voxel that the sample
   *   comes from: "Voxel" of GetLocations().
   * - PickValue(): the sample's value, in units of the scalars: in PREVIEW the voxel's, in the
   * other modes an average or, in EXACT, the extremum. Pictures interpolate between samples.
   *
   * False (PickValue: NaN), and the output stays as it is, where the last render of this mapper has
   * no sample, for averages, and, without RecordLocations, where several ranks render. Whether the
   * sample is opaque does not matter. The input must not have changed since the render.
   */
  bool PickWorldPosition(int x, int y, double position[3]);
  bool PickVoxel(int x, int y, int ijk[3]);
  double PickValue(int x, int y);
  ///@}

  ///@{
  /**
   * Colour by depth: the hue says how far the sample is from the viewer, the brightness is that of
   * the picture as it would be otherwise: the largest of its red, green and blue. Opacity stays.
   * With a white ramp from black, that is the depth coding of microscopy. Default off. Costs some
   * milliseconds more per frame than RecordLocations.
   */
  vtkSetMacro(DepthCoding, bool);
  vtkGetMacro(DepthCoding, bool);
  vtkBooleanMacro(DepthCoding, bool);
  ///@}

  ///@{
  /**
   * The colours of DepthCoding: the range of this look-up table or transfer function is stretched
   * over DepthCodingRange. Default nullptr: from red, the nearest, over green to blue.
   */
  virtual void SetDepthCodingColors(vtkScalarsToColors* colors);
  vtkGetObjectMacro(DepthCodingColors, vtkScalarsToColors);
  ///@}

  ///@{
  /**
   * The depths, as in GetLocations(), that have the first and the last colour. Default (0, 0): as
   * for all ranges whose first value is not below the second, those of the nearest and the farthest
   * voxel of the whole volume, which change with the view.
   */
  vtkSetVector2Macro(DepthCodingRange, double);
  vtkGetVector2Macro(DepthCodingRange, double);
  ///@}

  ///@{
  /**
   * Write the depth of samples to the depth buffer, so that what is rendered later (other volumes,
   * overlays, renderers that preserve the depth buffer) is hidden by what is seen of this volume:
   * pixels whose opacity is WriteDepthOpacity or more. Where the buffer has less depth already it
   * stays. Default off.
   */
  vtkSetMacro(WriteDepth, bool);
  vtkGetMacro(WriteDepth, bool);
  vtkBooleanMacro(WriteDepth, bool);
  ///@}

  ///@{
  /**
   * The least opacity of a pixel whose depth is written. Default 0.5, clamped to [0, 1]; fully
   * transparent pixels have none.
   */
  vtkSetClampMacro(WriteDepthOpacity, double, 0.0, 1.0);
  vtkGetMacro(WriteDepthOpacity, double);
  ///@}

  /**
   * The last shear image, its spacing 1 / ShearImageSampling, or nullptr before the first render.
   * Scalars: as many components as are projected, in the input's type in mode PREVIEW (that of the
   * copy, if voxels are hidden or resampled, or a magnitude), else, and for averages and depth
   * shading, float (double for 32- and 64-bit integers and double). The image's physical
   * coordinates are voxel indices, relative to the volume's first voxel, on the volume's middle
   * slice along the principal axis: the ray of pixel (u, v) at origin + spacing * (u, v) crosses
   * slice k there at that point minus GetShear() * (k - (slices-1)/2). In perspective it is the
   * largest of the shear images, and the coordinates are voxel indices half a slice beyond the
   * slice that is farthest from the eye; pixels are a little less than that apart, and the last
   * columns of a row may be none of the view's rays. Pixels whose ray meets no sample of any
   * component are marked hidden in the ghost array. Axes: for principal axis 2 the image's x and y
   * are the volume's first and second axis, for 1 first and third, for 0 second and third. Costs a
   * copy of the shear image; the caller must not change it.
   */
  vtkImageData* GetShearImage();

  /**
   * The image axis (0, 1 or 2) along which the last render projected, in perspective for
   * GetShearImage(); -1 before.
   */
  int GetPrincipalAxis();

  ///@{
  /**
   * The shears of the last render, in pixels per slice: slice k is moved by shear * k along the
   * shear image's x and y. At most 1 in magnitude; rounded to multiples of 2^-24 so that equal
   * views have equal bits. In perspective rays differ; those of the image's middle pixel, in
   * voxels.
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
   * rank: the input is all of it.
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
   * Render() is collective then: all ranks must render as often, or wait for each other for ever.
   * GetBounds() are those of the whole, so that a frustum culls on all ranks or on none. What is
   * wrong on one rank is told by all, and all skip the frame, as they do where ranks differ in a
   * setting that changes the picture.
   *
   * Projected are global and depth-shaded maxima and minima of independent components; anything
   * else is refused with a sentence, as are rectilinear grids. Chains are walked as bricks, without
   * LineTolerance. Geometry that hides the volume must be the same on all ranks, or
   * IntermixIntersectingGeometry be off. Of locations, voxels in modes other than PREVIEW are those
   * that rays pass in the middle of the slice, as are points in EXACT.
   *
   * A frame costs three reductions of a few bytes and a gathering of some 700 from each rank; if it
   * projects, a reduction of each shear image as well, with 1 to 8 bytes a pixel in preview, 4 (8
   * for 32- and 64-bit integers and double) in the other modes, 4 more where locations
   * are wanted, and the memory of one more shear image.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  /**
   * Updates the input, and with several ranks finds the bounds of the whole, which cameras can then
   * be set by. Collective. Call it before the first frame and when the input moves; Render() does
   * the same once it is under way, but a volume whose old bounds are out of sight is culled before.
   * False, with an error, if the pieces are not of one image.
   */
  bool UpdateWhole();

  ///@{
  /**
   * Whether only the first of several ranks shows the picture, as where a compositor such as IceT
   * blends the ranks' pictures over each other. Off by default: all ranks show the same.
   */
  vtkSetMacro(DisplayOnRootOnly, bool);
  vtkGetMacro(DisplayOnRootOnly, bool);
  vtkBooleanMacro(DisplayOnRootOnly, bool);
  ///@}

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
   * Write depths, from 0 to 1, where they are less than what is there; above 1 there is none. The
   * same order as in DisplayImage. The rendering backend's subclass does it.
   */
  virtual void DisplayDepths(
    vtkRenderer* ren, const int origin[2], const int size[2], const float* depths);

  /**
   * The depths, from 0 to 1, that have been rendered so far at pixels of the renderer's viewport.
   * The same order as in DisplayImage. False if they cannot be read.
   */
  virtual bool ReadDepth(vtkRenderer* ren, const int origin[2], const int size[2], float* depths);

  int VectorMode;
  int VectorComponent;
  vtkImageData* MaskInput;
  vtkMultiProcessController* Controller;
  bool DisplayOnRootOnly;
  int QualityMode;
  int Kernel;
  double KernelRadius;
  int MaximumType;
  double DepthShadingAmbient;
  double DepthShadingChangeRate;
  double LocalMaximumThreshold;
  bool Slab;
  double SlabThickness;
  double SlabCenter[3];
  vtkPolyData* BoundingSurface;
  vtkTypeBool IntermixIntersectingGeometry;
  int FootprintSampling;
  int ShearImageSampling;
  int Acceleration;
  double LineTolerance;
  bool EliminateInvisible;
  bool CullBelowWindow;
  vtkTypeInt64 IndexMemoryBudget;
  vtkTypeBool AutoAdjustSampleDistances;
  float FinalColorWindow;
  float FinalColorLevel;
  bool LastRenderUsedRayCasting;
  bool RecordLocations;
  bool DepthCoding;
  vtkScalarsToColors* DepthCodingColors;
  double DepthCodingRange[2];
  bool WriteDepth;
  double WriteDepthOpacity;

private:
  vtkSplattingMIPVolumeMapper(const vtkSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkSplattingMIPVolumeMapper&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
