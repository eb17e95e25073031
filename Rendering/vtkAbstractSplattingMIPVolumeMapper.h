// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAbstractSplattingMIPVolumeMapper
 * @brief   the properties of vtkSplattingMIPVolumeMapper
 *
 * What can be set of a mapper that projects by splatting, but for what vtkVolumeMapper has already:
 * input and scalars, BlendMode (maximum intensity is the default here), AverageIPScalarRange,
 * ClippingPlanes and Cropping. Its subclass renders.
 *
 * [CS98] is W. Cai and G. Sakas, "Maximum Intensity Projection Using Splatting in Sheared Object
 * Space", Computer Graphics Forum 17(3), 1998.
 *
 * @sa vtkSplattingMIPVolumeMapper
 */
#ifndef vtkAbstractSplattingMIPVolumeMapper_h
#define vtkAbstractSplattingMIPVolumeMapper_h

#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkVolumeMapper.h"

#include <memory> // for the hidden properties

namespace splatting
{
struct MapperProperties;
}
class vtkImageData;
class vtkPolyData;
class vtkScalarsToColors;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkAbstractSplattingMIPVolumeMapper : public vtkVolumeMapper
{
public:
  vtkAbstractTypeMacro(vtkAbstractSplattingMIPVolumeMapper, vtkVolumeMapper);
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
   * DISABLED: all of them (see vtkSplattingMIPVolumeMapper). MAGNITUDE: the Euclidean length, in
   * float (double for 32- and 64-bit integers and double), so that it neither overflows nor is
   * rounded to an integer; one component is taken as it is. COMPONENT: the one that VectorComponent
   * names. Both take the first transfer functions of the property, which they leave alone; they
   * cost a copy, unless the component is stored by itself.
   */
  virtual void SetVectorMode(int);
  virtual int GetVectorMode();
  virtual int GetVectorModeMinValue();
  virtual int GetVectorModeMaxValue();
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
  virtual void SetVectorComponent(int);
  virtual int GetVectorComponent();
  virtual int GetVectorComponentMinValue();
  virtual int GetVectorComponentMaxValue();
  ///@}

  ///@{
  /**
   * A binary mask, as vtkGPUVolumeRayCastMapper's: voxels where it is 0 are hidden, all others are
   * shown. Scalars of type unsigned char with one component (of the mask's points, or of its cells
   * if its points have none), one for each voxel of the input; spacing and origin do not matter.
   * Default none. Costs the copy that hidden voxels cost.
   */
  virtual void SetMaskInput(vtkImageData* mask);
  virtual vtkImageData* GetMaskInput();
  ///@}

  ///@{
  /**
   * What a slice contributes to a pixel of the shear image [CS98, section 2 and 3], or EXACT.
   *
   * PREVIEW: the largest of the voxels that the pixel's ray crosses in the slice (up to three), so
   * that the shear image equals an exact voxel traversal bit for bit. Fastest.
   * STANDARD: the average of the piecewise constant volume over the pixel's area and the slice's
   * thickness (3x3 weights).
   * HIGH: the average of the volume, interpolated with Kernel, over the same region (5x5 weights
   * from each of three slices).
   * EXACT (default): the extremum of the trilinearly interpolated volume on the ray of each pixel
   * of the screen, in closed form, cell by cell [Sakas et al. 1995]. Nothing is averaged, and no
   * sample distance can miss a voxel. There is no shear image. Averages and dependent components
   * are those of HIGH.
   *
   * In an overview, where pixels are wider than voxels in some direction, a pixel shows the
   * extremum (of averages the average) over its area instead of the value at its centre. EXACT then
   * shows voxels, as PREVIEW does. GetQualityModeUsed() returns the mode that is shown.
   *
   * In perspective a pixel's area is as wide as rays are apart: nearly a voxel where the volume is
   * farthest from the eye, and less in nearer slices.
   */
  virtual void SetQualityMode(int);
  virtual int GetQualityMode();
  virtual int GetQualityModeMinValue();
  virtual int GetQualityModeMaxValue();
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
   * renderer and volume, by frames that project, without the first one and without what is made
   * once per data set. EXACT gives way to HIGH, HIGH to STANDARD, STANDARD to PREVIEW, and back
   * once a better mode is expected to take no more than 80 % of the time. A mode that was not
   * measured yet is taken to fit. So the first frame is in QualityMode, and so is a still one,
   * which is allowed hours. A shear image in a better mode (up to QualityMode) that shows the view
   * already is kept. The picture's resolution is never reduced. GetQualityModeUsed() tells. Off:
   * always QualityMode. Views that are ray cast ignore it. Default on.
   */
  virtual void SetAutoAdjustSampleDistances(vtkTypeBool);
  virtual vtkTypeBool GetAutoAdjustSampleDistances();
  virtual vtkTypeBool GetAutoAdjustSampleDistancesMinValue();
  virtual vtkTypeBool GetAutoAdjustSampleDistancesMaxValue();
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  ///@}

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
  virtual void SetFinalColorWindow(float);
  virtual float GetFinalColorWindow();
  virtual void SetFinalColorLevel(float);
  virtual float GetFinalColorLevel();
  ///@}

  ///@{
  /**
   * The reconstruction kernel h of mode HIGH along each axis, t in voxels [CS98, section 3].
   * TRILINEAR (default): h(t) = 1-|t| for |t| < 1. COSINE_BELL: h(t) = (1 + cos(pi t / r)) / 2 for
   * |t| < r = KernelRadius. The other modes ignore it.
   */
  virtual void SetKernel(int);
  virtual int GetKernel();
  virtual int GetKernelMinValue();
  virtual int GetKernelMaxValue();
  void SetKernelToTrilinear() { this->SetKernel(TRILINEAR); }
  void SetKernelToCosineBell() { this->SetKernel(COSINE_BELL); }
  const char* GetKernelAsString();
  ///@}

  ///@{
  /**
   * The radius r of the cosine bell in voxels, default 1, clamped to [0.5, 1.5] (a wider bell would
   * need more than 5x5 weights). r = 1 sums to one by itself, other radii are normalised. Below
   * 0.501, FootprintSampling 1 is as 2: the bell would end before a lone sub-pixel's centre.
   */
  virtual void SetKernelRadius(double);
  virtual double GetKernelRadius();
  virtual double GetKernelRadiusMinValue();
  virtual double GetKernelRadiusMaxValue();
  ///@}

  ///@{
  /**
   * Which maximum along a ray is shown in blend mode MAXIMUM_INTENSITY. Default GLOBAL. A ray's
   * samples are, in mode PREVIEW, the voxels that it crosses, and in the other modes the averages
   * of its slices.
   *
   * GLOBAL: the largest of all.
   * DEPTH_SHADED: each sample is dimmed by its depth before the maximum is taken (DMIP) [Bruckner,
   * "Performing Maximum Intensity Projection with the Visualization Toolkit", Program 4.3]: a
   * sample in the n-th of the N slices that the ray crosses inside planes and slab (n = 0 is the
   * nearest to the viewer) is multiplied by ambient + (1 - n / N) changeRate. Samples count from
   * the lowest scalar of the volume here, so that Hounsfield units are dimmed like bytes. The shear
   * image is float (double for 32- and 64-bit integers and double) in all modes. LOCAL: the first
   * local maximum, seen from the viewer, that is no less than LocalMaximumThreshold, and where
   * there is none the largest of all [Sato et al. 1998].
   *
   * DEPTH_SHADED and LOCAL depend on the side that the viewer is on. They, and the blend modes
   * MINIMUM_INTENSITY and AVERAGE_INTENSITY, look at every sample: Acceleration has no effect.
   */
  virtual void SetMaximumType(int);
  virtual int GetMaximumType();
  virtual int GetMaximumTypeMinValue();
  virtual int GetMaximumTypeMaxValue();
  void SetMaximumTypeToGlobal() { this->SetMaximumType(GLOBAL); }
  void SetMaximumTypeToDepthShaded() { this->SetMaximumType(DEPTH_SHADED); }
  void SetMaximumTypeToLocal() { this->SetMaximumType(LOCAL); }
  const char* GetMaximumTypeAsString();
  ///@}

  ///@{
  /**
   * Factors of DEPTH_SHADED: the ambient is what is left of a sample at the far end of the ray, the
   * change rate is what is added to that at the near end. Defaults 0.3 and 0.7: from 30 % to
   * everything. 1 and 0 give the plain maximum. Their magnitudes must not sum to more than a
   * million.
   */
  virtual void SetDepthShadingAmbient(double);
  virtual double GetDepthShadingAmbient();
  virtual void SetDepthShadingChangeRate(double);
  virtual double GetDepthShadingChangeRate();
  ///@}

  ///@{
  /**
   * Of local maxima: the scalar from which on they count. Default 0.
   */
  virtual void SetLocalMaximumThreshold(double);
  virtual double GetLocalMaximumThreshold();
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
  virtual void SetSlab(bool);
  virtual bool GetSlab();
  vtkBooleanMacro(Slab, bool);
  ///@}

  ///@{
  /**
   * The thickness of the slab in world units, above 0; default 10, the usual slab of clinical
   * volumes in millimetres.
   */
  virtual void SetSlabThickness(double);
  virtual double GetSlabThickness();
  ///@}

  ///@{
  /**
   * A point of the world in the middle of the slab, by default (0, 0, 0).
   */
  virtual void SetSlabCenter(double x, double y, double z);
  virtual void SetSlabCenter(const double values[3]);
  virtual double* GetSlabCenter() VTK_SIZEHINT(3);
  virtual void GetSlabCenter(double& x, double& y, double& z);
  virtual void GetSlabCenter(double values[3]);
  ///@}

  ///@{
  /**
   * A closed surface in world coordinates that the volume is shown in, whatever its shape (the
   * successor of vtkProjectedPolyDataRayBounder); nullptr, the default, for none. Each ray is cut
   * to the part between its first and its last crossing with the surface, to which hollows and
   * holes on the ray's way belong; rays that miss it show nothing. Polygons and strips count, in
   * any orientation. If the surface is not closed, rays that cross it only once show nothing; a
   * warning says that it is open.
   *
   * The surface is drawn in software once for each view direction, about a millisecond for ten
   * thousand triangles, and only triangulated again when it is modified.
   */
  virtual void SetBoundingSurface(vtkPolyData* surface);
  virtual vtkPolyData* GetBoundingSurface();
  ///@}

  ///@{
  /**
   * Whether opaque geometry that was rendered before hides what lies behind it; default on. The
   * depth buffer is read where the volume is seen, if the renderer has rendered other props. What
   * lies before the volume hides it, pixel by pixel of the screen; what lies inside ends the rays
   * of the shear image, so that its edges are as soft as the shear image's pixels are large; what
   * lies behind the volume does not matter, and the shear image is used again. Geometry between a
   * part that Cropping or BoundingSurface takes away and what is left counts as inside. With
   * geometry inside, panning and zooming project anew. In EXACT the rays of the screen's pixels end
   * at the geometry.
   */
  virtual void SetIntermixIntersectingGeometry(vtkTypeBool);
  virtual vtkTypeBool GetIntermixIntersectingGeometry();
  vtkBooleanMacro(IntermixIntersectingGeometry, vtkTypeBool);
  ///@}

  ///@{
  /**
   * How the footprint weights are obtained. 0 (default): closed form. N in [1, 64]: from the
   * paper's general table, digitised at N x N sub-pixels per pixel [CS98, section 3], whose weights
   * tend to the closed form as N grows. Perspective views always have the closed form. A view makes
   * its table once, for all slices, in time and memory proportional to N^2.
   */
  virtual void SetFootprintSampling(int);
  virtual int GetFootprintSampling();
  virtual int GetFootprintSamplingMinValue();
  virtual int GetFootprintSamplingMaxValue();
  ///@}

  ///@{
  /**
   * What the projection leaves out and in which order it meets the rest. All give the same picture,
   * bit for bit (but for LineTolerance, CullBelowWindow and the sign of zeros). Default AUTO. Is
   * ignored in EXACT, which always uses bricks of 8x8x8 cells.
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
   * AUTO takes BRICKS, unless their last frame along this principal axis, in this mode and with or
   * without cuts as now, still had to splat more than a limit of the tiles: 30 % in PREVIEW, 40 %
   * in STANDARD (50 % in perspective), 60 % in HIGH. With AVX-512 the limit is 30 % in
   * STANDARD of parallel views, and 50 % in HIGH. Above the limit AUTO takes DENSE for 32
   * frames, then tries BRICKS again. In HIGH it waits fewer frames the nearer the share
   * was to the limit: from 0 there to 32 if all tiles were splatted. It never takes chains, which
   * are slower on all data that we measured (splatmip-paper reports it), but need less memory than
   * the volume.
   *
   * Where rays are cut, in perspective and where voxels are NaN or hidden, BRICKS take the place of
   * chains. Volumes with infinity are walked densely, as are all when IndexMemoryBudget has no room
   * for the index, and those with NaN or hidden voxels with RecordLocations; GetAccelerationUsed()
   * tells.
   */
  virtual void SetAcceleration(int);
  virtual int GetAcceleration();
  virtual int GetAccelerationMinValue();
  virtual int GetAccelerationMaxValue();
  void SetAccelerationToAuto() { this->SetAcceleration(AUTO); }
  void SetAccelerationToDense() { this->SetAcceleration(DENSE); }
  void SetAccelerationToBricks() { this->SetAcceleration(BRICKS); }
  void SetAccelerationToLines() { this->SetAcceleration(LINES); }
  void SetAccelerationToSortedLines() { this->SetAcceleration(SORTED_LINES); }
  void SetAccelerationToSortedVolume() { this->SetAcceleration(SORTED_VOLUME); }
  const char* GetAccelerationAsString();
  ///@}

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
  virtual void SetLineTolerance(double);
  virtual double GetLineTolerance();
  virtual double GetLineToleranceMinValue();
  virtual double GetLineToleranceMaxValue();
  ///@}

  ///@{
  /**
   * Leave voxels out of the chains that no ray can see, because a higher voxel lies before or
   * behind on each [Mroz, Hauser, Groeller 2000]. The picture stays the same, bit for bit. Mode
   * PREVIEW only; the other modes are encoded with all voxels. Default off: it pays where chains
   * are used for a turn of a smooth volume.
   */
  virtual void SetEliminateInvisible(bool);
  virtual bool GetEliminateInvisible();
  vtkBooleanMacro(EliminateInvisible, bool);
  ///@}

  ///@{
  /**
   * Do not tell apart scalars below the window, that is those, from the lowest one up, that all
   * have its colour and opacity. What cannot rise above them is left out. No pixel of the shear
   * image is then below the window's lower end; since the picture interpolates between its pixels,
   * edges against the background become brighter by up to half a pixel. In EXACT the picture stays
   * the same. MaximumType GLOBAL only. Default off.
   */
  virtual void SetCullBelowWindow(bool);
  virtual bool GetCullBelowWindow();
  vtkBooleanMacro(CullBelowWindow, bool);
  ///@}

  ///@{
  /**
   * Bytes that the index may hold besides the input: bricks (3/128 of the volume), chains, and the
   * copy (as large as the volume) for views along the first axis, in which rows of memory are rays.
   * What would exceed them is not made, with one warning: the projection is DENSE, and without the
   * copy 32 slices at a time are transposed in every frame. The bounds that EXACT holds are always
   * made. Default 4 GiB. 0: none.
   */
  virtual void SetIndexMemoryBudget(vtkTypeInt64);
  virtual vtkTypeInt64 GetIndexMemoryBudget();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMinValue();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMaxValue();
  ///@}

  ///@{
  /**
   * Find out where the samples lie that the picture shows, for GetLocations(). Default off;
   * DepthCoding and WriteDepth need it and do it by themselves. Projections take two to three times
   * as long, previews four to six times. Each pixel of the shear image takes 4 bytes more, and its
   * own size once again.
   *
   * The sample of a ray is the one that its value comes from; of equal ones the nearest to the
   * viewer, whatever the acceleration and the number of threads. In mode PREVIEW it is a voxel, in
   * the other modes the average of a slice. A pixel of the picture has the sample of the shear
   * pixel nearest to it, of those that its value is interpolated between. Averages have none: a
   * warning says so, once. Of independent components the first one is located, of dependent ones
   * the last. Blend modes that are ray cast have no locations.
   */
  virtual void SetRecordLocations(bool);
  virtual bool GetRecordLocations();
  vtkBooleanMacro(RecordLocations, bool);
  ///@}

  ///@{
  /**
   * Colour by depth: the hue says how far the sample is from the viewer, the brightness is that of
   * the picture as it would be otherwise: the largest of its red, green and blue. Opacity stays.
   * With a white ramp from black, that is the depth coding of microscopy. Default off. Costs some
   * milliseconds more per frame than RecordLocations.
   */
  virtual void SetDepthCoding(bool);
  virtual bool GetDepthCoding();
  vtkBooleanMacro(DepthCoding, bool);
  ///@}

  ///@{
  /**
   * The colours of DepthCoding: the range of this look-up table or transfer function is stretched
   * over DepthCodingRange. Default nullptr: from red, the nearest, over green to blue.
   */
  virtual void SetDepthCodingColors(vtkScalarsToColors* colors);
  virtual vtkScalarsToColors* GetDepthCodingColors();
  ///@}

  ///@{
  /**
   * The depths, as in GetLocations(), that have the first and the last colour. Default (0, 0): as
   * for all ranges whose first value is not below the second, those of the nearest and the farthest
   * voxel of the whole volume, which change with the view.
   */
  virtual void SetDepthCodingRange(double x, double y);
  virtual void SetDepthCodingRange(const double values[2]);
  virtual double* GetDepthCodingRange() VTK_SIZEHINT(2);
  virtual void GetDepthCodingRange(double& x, double& y);
  virtual void GetDepthCodingRange(double values[2]);
  ///@}

  ///@{
  /**
   * Write the depth of samples to the depth buffer, so that what is rendered later (other volumes,
   * overlays, renderers that preserve the depth buffer) is hidden by what is seen of this volume:
   * pixels whose opacity is WriteDepthOpacity or more. Where the buffer has less depth already it
   * stays. Default off.
   */
  virtual void SetWriteDepth(bool);
  virtual bool GetWriteDepth();
  vtkBooleanMacro(WriteDepth, bool);
  ///@}

  ///@{
  /**
   * The least opacity of a pixel whose depth is written. Default 0.5, clamped to [0, 1]; fully
   * transparent pixels have none.
   */
  virtual void SetWriteDepthOpacity(double);
  virtual double GetWriteDepthOpacity();
  virtual double GetWriteDepthOpacityMinValue();
  virtual double GetWriteDepthOpacityMaxValue();
  ///@}

#ifndef __VTK_WRAP__
  /**
   * All properties, also those of vtkVolumeMapper, for classes of this module.
   */
  const splatting::MapperProperties& ReadProperties();
#endif

protected:
  vtkAbstractSplattingMIPVolumeMapper();
  ~vtkAbstractSplattingMIPVolumeMapper() override;

  std::unique_ptr<splatting::MapperProperties> Properties;

private:
  vtkAbstractSplattingMIPVolumeMapper(const vtkAbstractSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkAbstractSplattingMIPVolumeMapper&) = delete;
};

#endif
