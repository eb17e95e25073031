// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkAbstractSplattingMIPVolumeMapper
 * @brief   properties of vtkSplattingMIPVolumeMapper
 *
 * vtkAbstractSplattingMIPVolumeMapper has the properties of a mapper that projects by splatting.
 * Its subclass renders. Input, scalars, BlendMode (default here: MAXIMUM_INTENSITY),
 * AverageIPScalarRange, ClippingPlanes and Cropping are those of vtkVolumeMapper.
 *
 * [CS98] is W. Cai and G. Sakas, "Maximum Intensity Projection Using Splatting in Sheared Object
 * Space", Computer Graphics Forum 17(3), 1998. Rendering/Documentation/limits.md in the source tree
 * lists memory, costs and restrictions.
 *
 * @sa vtkSplattingMIPVolumeMapper
 */
#ifndef vtkAbstractSplattingMIPVolumeMapper_h
#define vtkAbstractSplattingMIPVolumeMapper_h

#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPChoices.h"         // for the enumerations
#include "vtkSplattingMIPNamespace.h"
#include "vtkVolumeMapper.h"

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
class vtkPolyData;
class vtkScalarsToColors;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkAbstractSplattingMIPVolumeMapper : public vtkVolumeMapper
{
public:
  vtkAbstractTypeMacro(vtkAbstractSplattingMIPVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The values of VectorMode, QualityMode, Kernel, MaximumType and Acceleration; see
   * vtkSplattingMIPChoices.h.
   */
  vtkSplattingMIPChoicesMacro();

  /**
   * The values of PictureBlending.
   */
  enum PictureBlendings
  {
    OVER = 0,
    ADD = 1,
    MAXIMUM = 2
  };

  /**
   * The values of LabelMode.
   */
  enum LabelModes
  {
    SAMPLE = 0,
    PROJECTED = 1
  };

  ///@{
  /**
   * Set/Get which components of multi-component scalars are projected, as in vtkSmartVolumeMapper.
   * Default DISABLED. MAGNITUDE and COMPONENT use the first transfer functions of the property.
   * Magnitudes are float (double for 32- and 64-bit integers and double). Magnitudes and
   * interleaved components are copied.
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
   * Set/Get the component that VectorMode COMPONENT projects. Default 0, clamped to [0, 3]. Scalars
   * without this component are reported as an error.
   */
  vtkSetClampMacro(VectorComponent, int, 0, 3);
  vtkGetMacro(VectorComponent, int);
  ///@}

  ///@{
  /**
   * Set/Get a binary mask, as in vtkGPUVolumeRayCastMapper. Voxels where it is 0 are hidden. The
   * mask needs scalars of type unsigned char with one component, and one value for each voxel of
   * the input. Point scalars are used if there are any, else cell scalars. Spacing and origin are
   * ignored. Default nullptr: no mask. With a mask the volume is copied to floating point.
   */
  virtual void SetMaskInput(vtkImageData*);
  vtkGetObjectMacro(MaskInput, vtkImageData);
  ///@}

  ///@{
  /**
   * Set/Get the quality mode. Default EXACT, clamped to [PREVIEW, EXACT]. EXACT misses no maximum
   * between samples. It computes averages and dependent components as HIGH does. In overviews
   * pixels are wider than voxels in some direction. They show the extremum (or the average) over
   * their area, and EXACT shows voxels like PREVIEW. GetQualityModeUsed() returns the mode that is
   * shown.
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
   * Set/Get whether a faster quality mode is used if frames take longer than the allocated render
   * time of the volume, as during interaction. Measured times decide: EXACT is replaced by HIGH,
   * HIGH by STANDARD, STANDARD by PREVIEW. The resolution stays. GetQualityModeUsed() returns the
   * mode. Default on. Is ignored if one of VTK's ray casters renders.
   */
  vtkSetClampMacro(AutoAdjustSampleDistances, vtkTypeBool, 0, 1);
  vtkGetMacro(AutoAdjustSampleDistances, vtkTypeBool);
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the window and the level of the colours, for brightness and contrast. A colour c, from
   * 0 to 1, becomes (c - FinalColorLevel) / FinalColorWindow + 1/2. The opacity stays. Defaults 1
   * and 0.5: no change. A negative window inverts the picture. A window of 0, and values that are
   * not finite, are reported as an error.
   */
  vtkSetMacro(FinalColorWindow, float);
  vtkGetMacro(FinalColorWindow, float);
  vtkSetMacro(FinalColorLevel, float);
  vtkGetMacro(FinalColorLevel, float);
  ///@}

  ///@{
  /**
   * Set/Get the reconstruction kernel of HIGH [CS98, section 3]. h(t) is its factor along one axis,
   * at a distance of t voxels. TRILINEAR (default): h(t) = 1-|t| for |t| < 1. COSINE_BELL: h(t) =
   * (1 + cos(pi t / r)) / 2 for |t| < r = KernelRadius. Is ignored in the other modes.
   */
  vtkSetClampMacro(Kernel, int, TRILINEAR, COSINE_BELL);
  vtkGetMacro(Kernel, int);
  void SetKernelToTrilinear() { this->SetKernel(TRILINEAR); }
  void SetKernelToCosineBell() { this->SetKernel(COSINE_BELL); }
  const char* GetKernelAsString();
  ///@}

  ///@{
  /**
   * Set/Get the radius of the cosine bell in voxels. Default 1, clamped to [0.5, 1.5]. Weights are
   * normalised to a sum of 1. If the radius is below 0.501, FootprintSampling 1 is treated as 2.
   * Otherwise the bell would not contain the centre of the only sub-pixel.
   */
  vtkSetClampMacro(KernelRadius, double, 0.5, 1.5);
  vtkGetMacro(KernelRadius, double);
  ///@}

  ///@{
  /**
   * Set/Get the maximum along a ray that blend mode MAXIMUM_INTENSITY shows. Default GLOBAL,
   * clamped to [GLOBAL, SIGNED]. Samples of a ray are the voxels that it crosses in PREVIEW, the
   * averages of its slices in STANDARD and HIGH, and the interpolated field in EXACT. DEPTH_SHADED
   * and LOCAL depend on the side of the viewer. DEPTH_SHADED gives shear images of floating point.
   */
  vtkSetClampMacro(MaximumType, int, GLOBAL, SIGNED);
  vtkGetMacro(MaximumType, int);
  void SetMaximumTypeToGlobal() { this->SetMaximumType(GLOBAL); }
  void SetMaximumTypeToDepthShaded() { this->SetMaximumType(DEPTH_SHADED); }
  void SetMaximumTypeToLocal() { this->SetMaximumType(LOCAL); }
  void SetMaximumTypeToSigned() { this->SetMaximumType(SIGNED); }
  const char* GetMaximumTypeAsString();
  ///@}

  ///@{
  /**
   * Set/Get the factors of DEPTH_SHADED. The height of a sample above the lowest scalar is
   * multiplied by ambient + (1 - d) changeRate, where d grows from 0 at the near end of the visible
   * ray to 1 at its far end [Bruckner, "Performing Maximum Intensity Projection with the
   * Visualization Toolkit", Program 4.3]. Defaults 0.3 and 0.7. Magnitudes that sum to more than
   * 1e6 are reported as an error.
   */
  vtkSetMacro(DepthShadingAmbient, double);
  vtkGetMacro(DepthShadingAmbient, double);
  vtkSetMacro(DepthShadingChangeRate, double);
  vtkGetMacro(DepthShadingChangeRate, double);
  ///@}

  ///@{
  /**
   * Set/Get the least scalar that LOCAL accepts as a local maximum [Sato et al. 1998]. Rays without
   * one show their largest sample. Default 0. NaN is reported as an error.
   */
  vtkSetMacro(LocalMaximumThreshold, double);
  vtkGetMacro(LocalMaximumThreshold, double);
  ///@}

  ///@{
  /**
   * Set/Get the scalar that SIGNED measures distances from: a pixel shows its maximum or its
   * minimum, whichever is farther from this scalar. If both are equally far, it shows the maximum.
   * Default 0. NaN and infinities are reported as an error, and so are dependent components.
   */
  vtkSetMacro(SignedOrigin, double);
  vtkGetMacro(SignedOrigin, double);
  ///@}

  ///@{
  /**
   * Set/Get whether only a slab across the view is shown (thin-slab MIP): the part of the volume
   * within SlabThickness / 2 of the plane through SlabCenter. The plane is orthogonal to the rays,
   * in perspective parallel to the image plane. Default off. In modes other than EXACT a slab
   * thinner than a slice shows one slice.
   */
  vtkSetMacro(Slab, vtkTypeBool);
  vtkGetMacro(Slab, vtkTypeBool);
  vtkBooleanMacro(Slab, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the thickness of the slab in world units. Default 10. A thickness that is not above 0
   * is reported as an error if Slab is on.
   */
  vtkSetMacro(SlabThickness, double);
  vtkGetMacro(SlabThickness, double);
  ///@}

  ///@{
  /**
   * Set/Get the centre of the slab in world coordinates. Default (0, 0, 0). Must be finite.
   */
  vtkSetVector3Macro(SlabCenter, double);
  vtkGetVector3Macro(SlabCenter, double);
  ///@}

  ///@{
  /**
   * Set/Get a closed surface, in world coordinates, that bounds the visible part of the volume.
   * Default nullptr: no surface. Rays are cut to the part between their first and last crossing of
   * the surface; rays that miss it are transparent. Polygons and strips of any orientation are
   * used. If the surface is open, rays that cross it once are transparent, and a warning is
   * reported.
   */
  virtual void SetBoundingSurface(vtkPolyData*);
  vtkGetObjectMacro(BoundingSurface, vtkPolyData);
  ///@}

  ///@{
  /**
   * Set/Get whether opaque geometry that was rendered before hides the volume behind it. Default
   * on. Geometry inside the volume ends the rays of the shear image. In EXACT it ends the rays of
   * screen pixels. In modes other than EXACT its edges are blurred by about one pixel of the shear
   * image.
   */
  vtkSetMacro(IntermixIntersectingGeometry, vtkTypeBool);
  vtkGetMacro(IntermixIntersectingGeometry, vtkTypeBool);
  vtkBooleanMacro(IntermixIntersectingGeometry, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get how footprint weights are computed in STANDARD and HIGH. 0 (default): in closed form. N
   * in [1, 64]: from the paper's general table, digitised at N x N sub-pixels per pixel [CS98,
   * section 3]. Clamped to [0, 64]. A table takes time and memory proportional to N^2 for each
   * view. Is ignored in perspective views.
   */
  vtkSetClampMacro(FootprintSampling, int, 0, 64);
  vtkGetMacro(FootprintSampling, int);
  ///@}

  ///@{
  /**
   * Set/Get the acceleration of global maxima in PREVIEW, STANDARD and HIGH. Default AUTO, clamped
   * to [AUTO, SORTED_VOLUME]. All values give the same picture, bit for bit, if LineTolerance is 0
   * and CullBelowWindow is off. Only the sign of zeros may differ. Where an acceleration is not
   * supported, BRICKS or DENSE is used; see GetAccelerationUsed() and limits.md. Is ignored in
   * EXACT, except in overviews.
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

  ///@{
  /**
   * Set/Get the tolerance N of delta encoding [CS98, section 4], in units of 1/255 of the scalar
   * range. A voxel v may join a chain whose value differs by up to N (high - v) / 255, where high
   * is the largest scalar. Pixels of the shear image change by at most the same amount. Default 0:
   * no delta encoding. Clamped to [0, 64]. Is ignored by accelerations without chains.
   */
  vtkSetClampMacro(LineTolerance, double, 0.0, 64.0);
  vtkGetMacro(LineTolerance, double);
  ///@}

  ///@{
  /**
   * Set/Get whether low scalars are clamped. The limit is the largest scalar up to which all
   * scalars have the same colour and opacity. Voxels that cannot exceed it are skipped. In modes
   * other than EXACT edges move outwards by up to half a pixel. Default off. Is ignored with
   * dependent components, MaximumType other than GLOBAL, RecordLocations, DepthCoding, WriteDepth.
   */
  vtkSetMacro(CullBelowWindow, vtkTypeBool);
  vtkGetMacro(CullBelowWindow, vtkTypeBool);
  vtkBooleanMacro(CullBelowWindow, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get how many bytes the index may hold besides the input: bricks, chains, and the transposed
   * copy for views along the first axis. Default 4 GiB, at least 0. What would exceed the budget is
   * not made, and a warning is reported. Projections are then slower and have the same result. The
   * budget does not limit copies of scalars and the bounds of EXACT.
   */
  vtkSetClampMacro(IndexMemoryBudget, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(IndexMemoryBudget, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Set/Get whether projections record sample positions for GetLocations(). Default off;
   * DepthCoding, WriteDepth and LabelInput (in LabelMode SAMPLE) record them in any case. The
   * position of a pixel is that of the sample whose value it shows. Of equal samples the nearest to
   * the viewer is recorded. The position is that of the first independent component, or of the last
   * dependent component. Averages have no positions and report a warning.
   */
  vtkSetMacro(RecordLocations, vtkTypeBool);
  vtkGetMacro(RecordLocations, vtkTypeBool);
  vtkBooleanMacro(RecordLocations, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get whether the picture is coloured by depth. The hue encodes the sample's distance from
   * the viewer. The brightness is the largest of the red, green and blue that the picture would
   * have otherwise. The opacity stays. Default off.
   */
  vtkSetMacro(DepthCoding, vtkTypeBool);
  vtkGetMacro(DepthCoding, vtkTypeBool);
  vtkBooleanMacro(DepthCoding, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the colours of DepthCoding. The range of this look-up table or transfer function is
   * mapped to DepthCodingRange. Default nullptr: from red, the nearest, over green to blue.
   */
  virtual void SetDepthCodingColors(vtkScalarsToColors*);
  vtkGetObjectMacro(DepthCodingColors, vtkScalarsToColors);
  ///@}

  ///@{
  /**
   * Set/Get the depths of the first and the last colour, in the units of GetLocations(). Default
   * (0, 0). If the first value is not less than the second, the depths of the nearest and the
   * farthest voxel of the volume are used.
   */
  vtkSetVector2Macro(DepthCodingRange, double);
  vtkGetVector2Macro(DepthCodingRange, double);
  ///@}

  ///@{
  /**
   * Set/Get whether sample depths are written to the depth buffer, so that the volume hides what is
   * rendered later. A depth is written where the opacity is at least WriteDepthOpacity and the
   * depth is less than the one in the buffer. Default off.
   */
  vtkSetMacro(WriteDepth, vtkTypeBool);
  vtkGetMacro(WriteDepth, vtkTypeBool);
  vtkBooleanMacro(WriteDepth, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the least opacity of pixels whose depth is written. Default 0.5, clamped to [0, 1].
   * Transparent pixels are never written.
   */
  vtkSetClampMacro(WriteDepthOpacity, double, 0.0, 1.0);
  vtkGetMacro(WriteDepthOpacity, double);
  ///@}

  ///@{
  /**
   * Set/Get integer labels, one for each voxel of the input, in the order of MaskInput. Edges of
   * labels are drawn over the picture: pixels whose label (see LabelMode) is not 0 and differs from
   * that of one of the four neighbours. Default nullptr: no labels. Is ignored by ray casters, and
   * for averages if LabelMode is SAMPLE; reported as an error with several ranks.
   */
  virtual void SetLabelInput(vtkImageData*);
  vtkGetObjectMacro(LabelInput, vtkImageData);
  ///@}

  ///@{
  /**
   * Set/Get the label that a pixel has. SAMPLE (default): that of the voxel of its sample.
   * PROJECTED: that of the first voxel with a label that is not 0 on its ray, from the viewer,
   * whatever is brighter. It copies LabelInput to one byte for each voxel. Voxels are boxes, and
   * cuts hide them as in PREVIEW, in all quality modes. MaskInput does not hide labels. Clamped to
   * [SAMPLE, PROJECTED].
   */
  vtkSetClampMacro(LabelMode, int, SAMPLE, PROJECTED);
  vtkGetMacro(LabelMode, int);
  void SetLabelModeToSample() { this->SetLabelMode(SAMPLE); }
  void SetLabelModeToProjected() { this->SetLabelMode(PROJECTED); }
  const char* GetLabelModeAsString();
  ///@}

  ///@{
  /**
   * Set/Get the colours of labels: a look-up table or transfer function of the labels themselves.
   * Default nullptr: six colours in turn.
   */
  virtual void SetLabelColors(vtkScalarsToColors*);
  vtkGetObjectMacro(LabelColors, vtkScalarsToColors);
  ///@}

  ///@{
  /**
   * Set/Get how the picture is combined with what has been drawn. OVER (default): blended over it.
   * ADD: the premultiplied colours and opacities are added and clamped, as light of several
   * colours. MAXIMUM: the larger of both, in each channel. With ADD and MAXIMUM the order of
   * volumes does not matter. Clamped to [OVER, MAXIMUM]. Is ignored by ray casters.
   */
  vtkSetClampMacro(PictureBlending, int, OVER, MAXIMUM);
  vtkGetMacro(PictureBlending, int);
  void SetPictureBlendingToOver() { this->SetPictureBlending(OVER); }
  void SetPictureBlendingToAdd() { this->SetPictureBlending(ADD); }
  void SetPictureBlendingToMaximum() { this->SetPictureBlending(MAXIMUM); }
  const char* GetPictureBlendingAsString();
  ///@}

#ifndef __VTK_WRAP__
  /**
   * Print the settings of this class that change pictures, one per line. Ranks compare the text.
   */
  void PrintPictureSettings(ostream& os, vtkIndent indent);
#endif

protected:
  vtkAbstractSplattingMIPVolumeMapper();
  ~vtkAbstractSplattingMIPVolumeMapper() override;

private:
  int VectorMode = DISABLED;
  int VectorComponent = 0;
  vtkImageData* MaskInput = nullptr;
  int QualityMode = EXACT;
  vtkTypeBool AutoAdjustSampleDistances = 1;
  float FinalColorWindow = 1.0f;
  float FinalColorLevel = 0.5f;
  int Kernel = TRILINEAR;
  double KernelRadius = 1.0;
  int MaximumType = GLOBAL;
  double DepthShadingAmbient = 0.3;
  double DepthShadingChangeRate = 0.7;
  double LocalMaximumThreshold = 0.0;
  double SignedOrigin = 0.0;
  vtkTypeBool Slab = 0;
  double SlabThickness = 10.0;
  double SlabCenter[3] = { 0.0, 0.0, 0.0 };
  vtkPolyData* BoundingSurface = nullptr;
  vtkTypeBool IntermixIntersectingGeometry = 1;
  int FootprintSampling = 0;
  int Acceleration = AUTO;
  double LineTolerance = 0.0;
  vtkTypeBool CullBelowWindow = 0;
  vtkTypeInt64 IndexMemoryBudget = vtkTypeInt64(1) << 32;
  vtkTypeBool RecordLocations = 0;
  vtkTypeBool DepthCoding = 0;
  vtkScalarsToColors* DepthCodingColors = nullptr;
  double DepthCodingRange[2] = { 0.0, 0.0 };
  vtkTypeBool WriteDepth = 0;
  double WriteDepthOpacity = 0.5;
  vtkImageData* LabelInput = nullptr;
  vtkScalarsToColors* LabelColors = nullptr;
  int LabelMode = SAMPLE;
  int PictureBlending = OVER;

  vtkAbstractSplattingMIPVolumeMapper(const vtkAbstractSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkAbstractSplattingMIPVolumeMapper&) = delete;
};
VTK_ABI_NAMESPACE_END

#endif
