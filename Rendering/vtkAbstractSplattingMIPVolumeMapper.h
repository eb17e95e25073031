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
   * The values of VectorMode; the same as vtkSmartVolumeMapper's.
   */
  enum VectorModes
  {
    DISABLED = -1, ///< all components
    MAGNITUDE = 0, ///< their Euclidean length; a single component itself
    COMPONENT = 1  ///< the component that VectorComponent names
  };

  /**
   * What a pixel shows [CS98, sections 2 and 3]. Modes from PREVIEW to HIGH compute the pixels of a
   * shear image. EXACT computes the pixels of the screen, cell by cell.
   */
  enum QualityModes
  {
    PREVIEW = 0,  ///< the largest voxel that the ray crosses: an exact voxel traversal
    STANDARD = 1, ///< the largest average of a slice of boxes over the pixel's area (3x3 weights)
    HIGH = 2,     ///< the same of the volume interpolated with Kernel (5x5 weights, three slices)
    EXACT = 3     ///< the extremum of the trilinear volume on the ray [Sakas et al. 1995]
  };

  /**
   * Reconstruction kernels of HIGH; see SetKernel().
   */
  enum Kernels
  {
    TRILINEAR = 0,
    COSINE_BELL = 1
  };

  /**
   * Maxima along a ray.
   */
  enum MaximumTypes
  {
    GLOBAL = 0,       ///< the largest sample
    DEPTH_SHADED = 1, ///< the largest sample after dimming by depth (DMIP)
    LOCAL = 2         ///< the first local maximum, from the viewer, that reaches a threshold
  };

  /**
   * Which voxels a projection skips, and in which order it processes the others. Chains are equal
   * voxels along rows [CS98, section 4]. Sorted chains are used in PREVIEW, LINES in other modes.
   */
  enum Accelerations
  {
    AUTO = 0,         ///< BRICKS where they skip enough tiles, else DENSE
    DENSE = 1,        ///< all voxels, in memory order
    BRICKS = 2,       ///< skips tiles of 8x4 pixels that no brick of 8x4x4 voxels can raise
    LINES = 3,        ///< chains in the order of slices and rows
    SORTED_LINES = 4, ///< the chains of each slice in descending order
    SORTED_VOLUME = 5 ///< the chains of all slices in descending order
  };

  ///@{
  /**
   * Set/Get the projected components of scalars that have several, as in vtkSmartVolumeMapper.
   * Default DISABLED. MAGNITUDE and COMPONENT use the first transfer functions of the property.
   * Magnitudes are float (double for 32- and 64-bit integers and double). Magnitudes and
   * interleaved components are copied.
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
   * Set/Get the component that VectorMode COMPONENT projects. Default 0, clamped to [0, 3]. Scalars
   * without this component are reported as an error.
   */
  virtual void SetVectorComponent(int);
  virtual int GetVectorComponent();
  virtual int GetVectorComponentMinValue();
  virtual int GetVectorComponentMaxValue();
  ///@}

  ///@{
  /**
   * Set/Get a binary mask, as in vtkGPUVolumeRayCastMapper. Voxels where it is 0 are hidden. The
   * mask needs scalars of type unsigned char with one component, and one value for each voxel of
   * the input. Point scalars are used if there are any, else cell scalars. Spacing and origin are
   * ignored. Default nullptr: no mask. With a mask the volume is copied to floating point.
   */
  virtual void SetMaskInput(vtkImageData* mask);
  virtual vtkImageData* GetMaskInput();
  ///@}

  ///@{
  /**
   * Set/Get the quality mode. Default EXACT, clamped to [PREVIEW, EXACT]. In EXACT no maximum lies
   * between samples; averages and dependent components are those of HIGH. In an overview, where
   * pixels are wider than voxels in some direction, a pixel shows the extremum over its area (of
   * averages the average), and EXACT shows voxels like PREVIEW. GetQualityModeUsed() returns the
   * mode that is shown.
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
   * Set/Get whether a faster quality mode is used if frames take longer than the allocated render
   * time of the volume, as during interaction. Measured times decide: EXACT is replaced by HIGH,
   * HIGH by STANDARD, STANDARD by PREVIEW. The resolution stays. GetQualityModeUsed() returns the
   * mode. Default on. Is ignored where rays are cast.
   */
  virtual void SetAutoAdjustSampleDistances(vtkTypeBool);
  virtual vtkTypeBool GetAutoAdjustSampleDistances();
  virtual vtkTypeBool GetAutoAdjustSampleDistancesMinValue();
  virtual vtkTypeBool GetAutoAdjustSampleDistancesMaxValue();
  vtkBooleanMacro(AutoAdjustSampleDistances, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the window and the level of the colours, for brightness and contrast. A colour c, from
   * 0 to 1, becomes (c - FinalColorLevel) / FinalColorWindow + 1/2. The opacity stays. Defaults 1
   * and 0.5: no change. A negative window inverts the picture. A window of 0, and values that are
   * not finite, are reported as an error.
   */
  virtual void SetFinalColorWindow(float);
  virtual float GetFinalColorWindow();
  virtual void SetFinalColorLevel(float);
  virtual float GetFinalColorLevel();
  ///@}

  ///@{
  /**
   * Set/Get the reconstruction kernel h of HIGH along each axis, t in voxels [CS98, section 3].
   * TRILINEAR (default): h(t) = 1-|t| for |t| < 1. COSINE_BELL: h(t) = (1 + cos(pi t / r)) / 2 for
   * |t| < r = KernelRadius. Is ignored in the other modes.
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
   * Set/Get the radius of the cosine bell in voxels. Default 1, clamped to [0.5, 1.5]. Weights are
   * normalised to a sum of 1. Below 0.501 FootprintSampling 1 is treated as 2, because the bell
   * would not contain the centre of the only sub-pixel.
   */
  virtual void SetKernelRadius(double);
  virtual double GetKernelRadius();
  virtual double GetKernelRadiusMinValue();
  virtual double GetKernelRadiusMaxValue();
  ///@}

  ///@{
  /**
   * Set/Get the maximum along a ray that blend mode MAXIMUM_INTENSITY shows. Default GLOBAL,
   * clamped to [GLOBAL, LOCAL]. Samples of a ray are the voxels that it crosses in PREVIEW, the
   * averages of its slices in STANDARD and HIGH, and the interpolated field in EXACT. DEPTH_SHADED
   * and LOCAL depend on the side of the viewer. DEPTH_SHADED gives shear images of floating point.
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
   * Set/Get the factors of DEPTH_SHADED. The height of a sample above the lowest scalar is
   * multiplied by ambient + (1 - d) changeRate, where d grows from 0 at the near end of the visible
   * ray to 1 at its far end [Bruckner, "Performing Maximum Intensity Projection with the
   * Visualization Toolkit", Program 4.3]. Defaults 0.3 and 0.7. Magnitudes that sum to more than
   * 1e6 are reported as an error.
   */
  virtual void SetDepthShadingAmbient(double);
  virtual double GetDepthShadingAmbient();
  virtual void SetDepthShadingChangeRate(double);
  virtual double GetDepthShadingChangeRate();
  ///@}

  ///@{
  /**
   * Set/Get the least scalar that LOCAL accepts as a local maximum [Sato et al. 1998]. Rays without
   * one show their largest sample. Default 0. NaN is reported as an error.
   */
  virtual void SetLocalMaximumThreshold(double);
  virtual double GetLocalMaximumThreshold();
  ///@}

  ///@{
  /**
   * Set/Get whether only a slab across the view is shown (thin-slab MIP): the part of the volume
   * within SlabThickness / 2 of the plane through SlabCenter. The plane is orthogonal to the rays,
   * in perspective parallel to the image plane. Default off. In modes other than EXACT a slab
   * thinner than a slice shows one slice.
   */
  virtual void SetSlab(bool);
  virtual bool GetSlab();
  vtkBooleanMacro(Slab, bool);
  ///@}

  ///@{
  /**
   * Set/Get the thickness of the slab in world units. Default 10. A thickness that is not above 0
   * is reported as an error if Slab is on.
   */
  virtual void SetSlabThickness(double);
  virtual double GetSlabThickness();
  ///@}

  ///@{
  /**
   * Set/Get the centre of the slab in world coordinates. Default (0, 0, 0). Must be finite.
   */
  virtual void SetSlabCenter(double x, double y, double z);
  virtual void SetSlabCenter(const double values[3]);
  virtual double* GetSlabCenter() VTK_SIZEHINT(3);
  virtual void GetSlabCenter(double& x, double& y, double& z);
  virtual void GetSlabCenter(double values[3]);
  ///@}

  ///@{
  /**
   * Set/Get a closed surface, in world coordinates, that bounds the visible part of the volume.
   * Default nullptr: no surface. Rays are cut to the part between their first and last crossing of
   * the surface; rays that miss it are transparent. Polygons and strips of any orientation are
   * used. If the surface is open, rays that cross it once are transparent, and a warning is
   * reported.
   */
  virtual void SetBoundingSurface(vtkPolyData* surface);
  virtual vtkPolyData* GetBoundingSurface();
  ///@}

  ///@{
  /**
   * Set/Get whether opaque geometry that was rendered before hides the volume behind it. Default
   * on. Geometry inside the volume ends the rays of the shear image, in EXACT those of the screen's
   * pixels. In modes other than EXACT its edges are as soft as the pixels of the shear image are
   * large.
   */
  virtual void SetIntermixIntersectingGeometry(vtkTypeBool);
  virtual vtkTypeBool GetIntermixIntersectingGeometry();
  vtkBooleanMacro(IntermixIntersectingGeometry, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get how footprint weights are computed in STANDARD and HIGH. 0 (default): in closed form. N
   * in [1, 64]: from the paper's general table, digitised at N x N sub-pixels per pixel [CS98,
   * section 3]. Clamped to [0, 64]. A table takes time and memory proportional to N^2 for each
   * view. Is ignored in perspective views.
   */
  virtual void SetFootprintSampling(int);
  virtual int GetFootprintSampling();
  virtual int GetFootprintSamplingMinValue();
  virtual int GetFootprintSamplingMaxValue();
  ///@}

  ///@{
  /**
   * Set/Get the acceleration of global maxima in PREVIEW, STANDARD and HIGH. Default AUTO, clamped
   * to [AUTO, SORTED_VOLUME]. The picture has the same bits with all of them, except for
   * LineTolerance, CullBelowWindow and the sign of zeros. Where an acceleration is not supported,
   * BRICKS or DENSE is used; see GetAccelerationUsed() and limits.md. Is ignored in EXACT, except
   * in overviews.
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
   * Set/Get the tolerance N of delta encoding [CS98, section 4], in grey levels of 255. A voxel v
   * may join a chain whose value differs by up to N (high - v) / 255, where high is the largest
   * scalar. Pixels of the shear image differ by no more. Default 0: no delta encoding. Clamped to
   * [0, 64]. Is ignored by accelerations without chains.
   */
  virtual void SetLineTolerance(double);
  virtual double GetLineTolerance();
  virtual double GetLineToleranceMinValue();
  virtual double GetLineToleranceMaxValue();
  ///@}

  ///@{
  /**
   * Set/Get whether chains omit voxels that no ray can show, because each ray crosses a higher
   * voxel beside them [Mroz, Hauser, Groeller 2000]. The picture has the same bits. Default off. Is
   * ignored in modes other than PREVIEW.
   */
  virtual void SetEliminateInvisible(bool);
  virtual bool GetEliminateInvisible();
  vtkBooleanMacro(EliminateInvisible, bool);
  ///@}

  ///@{
  /**
   * Set/Get whether scalars below the window are clamped: those, from the lowest one up, that all
   * have its colour and opacity. What cannot exceed them is skipped. In modes other than EXACT
   * edges against the background become brighter by up to half a pixel. Default off. Applies to
   * MaximumType GLOBAL without recorded locations and dependent components.
   */
  virtual void SetCullBelowWindow(bool);
  virtual bool GetCullBelowWindow();
  vtkBooleanMacro(CullBelowWindow, bool);
  ///@}

  ///@{
  /**
   * Set/Get how many bytes the index may hold besides the input: bricks, chains, and the transposed
   * copy for views along the first axis. Default 4 GiB, at least 0. What would exceed the budget is
   * not made, and a warning is reported. Projections are then slower and have the same result. The
   * budget does not limit copies of scalars and the bounds of EXACT.
   */
  virtual void SetIndexMemoryBudget(vtkTypeInt64);
  virtual vtkTypeInt64 GetIndexMemoryBudget();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMinValue();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMaxValue();
  ///@}

  ///@{
  /**
   * Set/Get whether projections record sample positions for GetLocations(). Default off;
   * DepthCoding and WriteDepth record them in any case. A ray's sample is the one whose value it
   * shows, the nearest to the viewer of equal ones. Of independent components the first is
   * recorded, of dependent ones the last. Averages have no positions and report a warning.
   */
  virtual void SetRecordLocations(bool);
  virtual bool GetRecordLocations();
  vtkBooleanMacro(RecordLocations, bool);
  ///@}

  ///@{
  /**
   * Set/Get whether the picture is coloured by depth. The hue encodes the sample's distance from
   * the viewer. The brightness is the largest of the red, green and blue that the picture would
   * have otherwise. The opacity stays. Default off.
   */
  virtual void SetDepthCoding(bool);
  virtual bool GetDepthCoding();
  vtkBooleanMacro(DepthCoding, bool);
  ///@}

  ///@{
  /**
   * Set/Get the colours of DepthCoding. The range of this look-up table or transfer function is
   * mapped to DepthCodingRange. Default nullptr: from red, the nearest, over green to blue.
   */
  virtual void SetDepthCodingColors(vtkScalarsToColors* colors);
  virtual vtkScalarsToColors* GetDepthCodingColors();
  ///@}

  ///@{
  /**
   * Set/Get the depths of the first and the last colour, in the units of GetLocations(). Default
   * (0, 0). If the first value is not less than the second, the depths of the nearest and the
   * farthest voxel of the volume are used.
   */
  virtual void SetDepthCodingRange(double x, double y);
  virtual void SetDepthCodingRange(const double values[2]);
  virtual double* GetDepthCodingRange() VTK_SIZEHINT(2);
  virtual void GetDepthCodingRange(double& x, double& y);
  virtual void GetDepthCodingRange(double values[2]);
  ///@}

  ///@{
  /**
   * Set/Get whether sample depths are written to the depth buffer, so that the volume hides what is
   * rendered later. A depth is written where the opacity is at least WriteDepthOpacity and the
   * depth is less than the one in the buffer. Default off.
   */
  virtual void SetWriteDepth(bool);
  virtual bool GetWriteDepth();
  vtkBooleanMacro(WriteDepth, bool);
  ///@}

  ///@{
  /**
   * Set/Get the least opacity of pixels whose depth is written. Default 0.5, clamped to [0, 1].
   * Transparent pixels are never written.
   */
  virtual void SetWriteDepthOpacity(double);
  virtual double GetWriteDepthOpacity();
  virtual double GetWriteDepthOpacityMinValue();
  virtual double GetWriteDepthOpacityMaxValue();
  ///@}

#ifndef __VTK_WRAP__
  /**
   * Get all properties, also those of vtkVolumeMapper. For classes of this module.
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
