// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPProjection
 * @brief   maximum intensity projection of image data to image data, without OpenGL
 *
 * vtkSplattingMIPProjection projects a vtkImageData by the algorithms and properties of
 * vtkSplattingMIPVolumeMapper. The output has the projected values in the unit of the input, such
 * as Hounsfield units. It needs no display, no render window and no OpenGL. One Update() computes
 * one view or all views of a turn.
 *
 * The input has point or cell scalars with 1 to 4 components, of any numeric type except bits. The
 * array is that of SetInputArrayToProcess(), by default the scalars. NaN and voxels that ghost
 * arrays hide are no samples.
 *
 * The output is a vtkImageData of OutputSize[0] x OutputSize[1] x NumberOfViews points, one slice
 * per view. Its scalars are float (double for 32- and 64-bit integers and double), with as many
 * components as are projected. Pixels without a sample have BackgroundValue.
 *
 * Origin, spacing and direction matrix place the output in the world, on the plane through the
 * focal point across the view. Parallel views with a Slab lie on the slab's middle plane. x is
 * right, y is up, z points to the viewer. The spacing along z is SlabThickness if Slab is on, else
 * 1. The first view of a turn defines the matrix. The field data array "ViewAngle" has the angle of
 * each view in degrees. VTK's XML writers keep the placement; vtkNIFTIImageWriter needs it as a
 * matrix, see contract.md.
 *
 * Rays are parallel, or those of a perspective Camera. They end at the border of the volume. Slab
 * and Cropping cut them.
 *
 * Progress runs from 0 to 1 over all views. While a view is projected, AbortExecute is checked
 * (with VTK 9.3 and newer also that of filters upstream). If it is set, the output is empty. After
 * AbortExecuteOff() the next Update() projects again. Errors, also lack of memory, are reported
 * once and leave the output empty.
 *
 * The same input gives the same bits for any number of threads and any instruction set. Each slice
 * has the same bits as a single view with the camera of GetViewCamera(). In modes other than EXACT,
 * opposite views of a whole turn with an even number of views share a projection if MaximumType
 * does not depend on the viewer's side and RecordLocations is off.
 *
 * @sa vtkSplattingMIPVolumeMapper vtkImageSlabReslice
 */
#ifndef vtkSplattingMIPProjection_h
#define vtkSplattingMIPProjection_h

#include "vtkImageAlgorithm.h"
#include "vtkImagingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPChoices.h"       // for the enumerations
#include "vtkSplattingMIPNamespace.h"

#include <memory> // for the hidden implementation

VTK_ABI_NAMESPACE_BEGIN
class vtkCamera;

class VTKIMAGINGSPLATTINGMIP_EXPORT vtkSplattingMIPProjection : public vtkImageAlgorithm
{
public:
  static vtkSplattingMIPProjection* New();
  vtkTypeMacro(vtkSplattingMIPProjection, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The values of BlendMode; the same as vtkVolumeMapper's.
   */
  enum BlendModes
  {
    MAXIMUM_INTENSITY_BLEND = 1,
    MINIMUM_INTENSITY_BLEND = 2,
    AVERAGE_INTENSITY_BLEND = 3
  };

  /**
   * The values of VectorMode, QualityMode, Kernel, MaximumType and Acceleration; see
   * vtkSplattingMIPChoices.h.
   */
  vtkSplattingMIPChoicesMacro();

  ///@{
  /**
   * Set/Get a camera that defines the view, parallel or perspective, in place of ViewDirection,
   * ViewUp and FocalPoint. Default nullptr: no camera. Its clipping range is ignored; its parallel
   * scale or view angle is ignored if OutputSpacing is set. A camera with an explicit projection
   * matrix is reported as an error.
   */
  virtual void SetCamera(vtkCamera* camera);
  vtkGetObjectMacro(Camera, vtkCamera);
  ///@}

  ///@{
  /**
   * Set/Get the direction from the viewer into the world, and the direction that is up in the
   * picture. Any length above 0; ViewUp must not be parallel to ViewDirection. Defaults (0, 1, 0)
   * and (0, 0, 1): in DICOM's coordinates the patient's front, head up. Are ignored with a Camera.
   * Views are parallel.
   */
  vtkSetVector3Macro(ViewDirection, double);
  vtkGetVector3Macro(ViewDirection, double);
  vtkSetVector3Macro(ViewUp, double);
  vtkGetVector3Macro(ViewUp, double);
  ///@}

  ///@{
  /**
   * Set/Get whether the centre of the picture, about which views are turned, is the centre of the
   * volume's bounds instead of FocalPoint. Default on. Is ignored with a Camera.
   */
  vtkSetMacro(CenterOnVolume, vtkTypeBool);
  vtkGetMacro(CenterOnVolume, vtkTypeBool);
  vtkBooleanMacro(CenterOnVolume, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get the world point at the centre of the picture. Default (0, 0, 0). Is ignored with a
   * Camera, and if CenterOnVolume is on.
   */
  vtkSetVector3Macro(FocalPoint, double);
  vtkGetVector3Macro(FocalPoint, double);
  ///@}

  ///@{
  /**
   * Set/Get the width and height of a view in pixels. Default 256 x 256, each from 1 to 16384;
   * other sizes are reported as an error.
   */
  vtkSetVector2Macro(OutputSize, int);
  vtkGetVector2Macro(OutputSize, int);
  ///@}

  ///@{
  /**
   * Set/Get the distance between pixels in world units, in perspective at the focal point. Default
   * (0, 0): automatic. Then the Camera's parallel scale or view angle defines it. Without a Camera
   * it is the diagonal of the volume's bounds divided by the lesser of OutputSize, so that the
   * volume fits into the picture from all directions.
   */
  vtkSetVector2Macro(OutputSpacing, double);
  vtkGetVector2Macro(OutputSpacing, double);
  ///@}

  ///@{
  /**
   * Set/Get the number of views. Default 1, clamped to [1, 36000]. View n is turned by n *
   * TotalAngle / NumberOfViews.
   */
  vtkSetClampMacro(NumberOfViews, int, 1, 36000);
  vtkGetMacro(NumberOfViews, int);
  ///@}

  ///@{
  /**
   * Set/Get the direction of the rotation axis in world coordinates. The axis passes through the
   * focal point. The viewer turns counterclockwise as seen from the tip of the axis, as in
   * vtkCamera::Azimuth(). Default (0, 0, 0): the view-up.
   */
  vtkSetVector3Macro(RotationAxis, double);
  vtkGetVector3Macro(RotationAxis, double);
  ///@}

  ///@{
  /**
   * Set/Get the angle in degrees over which the views are spread, any number but 0. Default 360.
   * The last view is one step before this angle, so that a whole turn can be shown in a loop.
   */
  vtkSetMacro(TotalAngle, double);
  vtkGetMacro(TotalAngle, double);
  ///@}

  ///@{
  /**
   * Set/Get the value of pixels without a sample, which may be NaN. Default 0.
   */
  vtkSetMacro(BackgroundValue, double);
  vtkGetMacro(BackgroundValue, double);
  ///@}

  ///@{
  /**
   * Set/Get the blend mode: maximum, minimum or average intensity, as in vtkVolumeMapper. Default
   * MAXIMUM_INTENSITY_BLEND. Averages count only samples within AverageIPScalarRange, limits
   * included. Default range: that of float.
   */
  vtkSetClampMacro(BlendMode, int, MAXIMUM_INTENSITY_BLEND, AVERAGE_INTENSITY_BLEND);
  vtkGetMacro(BlendMode, int);
  void SetBlendModeToMaximumIntensity() { this->SetBlendMode(MAXIMUM_INTENSITY_BLEND); }
  void SetBlendModeToMinimumIntensity() { this->SetBlendMode(MINIMUM_INTENSITY_BLEND); }
  void SetBlendModeToAverageIntensity() { this->SetBlendMode(AVERAGE_INTENSITY_BLEND); }
  vtkSetVector2Macro(AverageIPScalarRange, double);
  vtkGetVector2Macro(AverageIPScalarRange, double);
  ///@}

  ///@{
  /**
   * Set/Get the quality mode; see vtkSplattingMIPVolumeMapper::SetQualityMode(). Default EXACT,
   * clamped to [PREVIEW, EXACT].
   */
  vtkSetClampMacro(QualityMode, int, PREVIEW, EXACT);
  vtkGetMacro(QualityMode, int);
  void SetQualityModeToPreview() { this->SetQualityMode(PREVIEW); }
  void SetQualityModeToStandard() { this->SetQualityMode(STANDARD); }
  void SetQualityModeToHigh() { this->SetQualityMode(HIGH); }
  void SetQualityModeToExact() { this->SetQualityMode(EXACT); }
  ///@}

  ///@{
  /**
   * Set/Get the reconstruction kernel of HIGH, the radius of the cosine bell in voxels and the
   * sampling of footprints; see vtkSplattingMIPVolumeMapper. Defaults TRILINEAR, 1 (clamped to
   * [0.5, 1.5]) and 0: closed form (clamped to [0, 64]).
   */
  vtkSetClampMacro(Kernel, int, TRILINEAR, COSINE_BELL);
  vtkGetMacro(Kernel, int);
  void SetKernelToTrilinear() { this->SetKernel(TRILINEAR); }
  void SetKernelToCosineBell() { this->SetKernel(COSINE_BELL); }
  vtkSetClampMacro(KernelRadius, double, 0.5, 1.5);
  vtkGetMacro(KernelRadius, double);
  vtkSetClampMacro(FootprintSampling, int, 0, 64);
  vtkGetMacro(FootprintSampling, int);
  ///@}

  ///@{
  /**
   * Set/Get the maximum along a ray and its parameters; see
   * vtkSplattingMIPVolumeMapper::SetMaximumType(). Defaults: GLOBAL, DepthShadingAmbient 0.3,
   * DepthShadingChangeRate 0.7, LocalMaximumThreshold 0, SignedOrigin 0.
   */
  vtkSetClampMacro(MaximumType, int, GLOBAL, SIGNED);
  vtkGetMacro(MaximumType, int);
  void SetMaximumTypeToGlobal() { this->SetMaximumType(GLOBAL); }
  void SetMaximumTypeToDepthShaded() { this->SetMaximumType(DEPTH_SHADED); }
  void SetMaximumTypeToLocal() { this->SetMaximumType(LOCAL); }
  void SetMaximumTypeToSigned() { this->SetMaximumType(SIGNED); }
  vtkSetMacro(DepthShadingAmbient, double);
  vtkGetMacro(DepthShadingAmbient, double);
  vtkSetMacro(DepthShadingChangeRate, double);
  vtkGetMacro(DepthShadingChangeRate, double);
  vtkSetMacro(LocalMaximumThreshold, double);
  vtkGetMacro(LocalMaximumThreshold, double);
  vtkSetMacro(SignedOrigin, double);
  vtkGetMacro(SignedOrigin, double);
  ///@}

  ///@{
  /**
   * Set/Get which components of multi-component scalars are projected; see
   * vtkSplattingMIPVolumeMapper::SetVectorMode(). Default DISABLED: each component by itself.
   * VectorComponent is 0 by default, clamped to [0, 3].
   */
  vtkSetClampMacro(VectorMode, int, DISABLED, COMPONENT);
  vtkGetMacro(VectorMode, int);
  void SetVectorModeToDisabled() { this->SetVectorMode(DISABLED); }
  void SetVectorModeToMagnitude() { this->SetVectorMode(MAGNITUDE); }
  void SetVectorModeToComponent() { this->SetVectorMode(COMPONENT); }
  vtkSetClampMacro(VectorComponent, int, 0, 3);
  vtkGetMacro(VectorComponent, int);
  ///@}

  ///@{
  /**
   * Set/Get whether only a slab across the view is projected, its thickness in world units and its
   * centre; see vtkSplattingMIPVolumeMapper::SetSlab(). Defaults: off, 10 and (0, 0, 0). The slab
   * turns with the view.
   */
  vtkSetMacro(Slab, vtkTypeBool);
  vtkGetMacro(Slab, vtkTypeBool);
  vtkBooleanMacro(Slab, vtkTypeBool);
  vtkSetMacro(SlabThickness, double);
  vtkGetMacro(SlabThickness, double);
  vtkSetVector3Macro(SlabCenter, double);
  vtkGetVector3Macro(SlabCenter, double);
  ///@}

  ///@{
  /**
   * Set/Get cropping as in vtkVolumeMapper. Six planes, two across each axis of the input and in
   * its coordinates, bound 27 regions. The flags select the regions that are projected. Defaults:
   * off, planes 0 and 1, flags VTK_CROP_SUBVOLUME (the middle region), clamped to [0, 0x7ffffff].
   */
  vtkSetMacro(Cropping, vtkTypeBool);
  vtkGetMacro(Cropping, vtkTypeBool);
  vtkBooleanMacro(Cropping, vtkTypeBool);
  vtkSetVector6Macro(CroppingRegionPlanes, double);
  vtkGetVector6Macro(CroppingRegionPlanes, double);
  vtkSetClampMacro(CroppingRegionFlags, int, 0, 0x7ffffff);
  vtkGetMacro(CroppingRegionFlags, int);
  ///@}

  ///@{
  /**
   * Set/Get the acceleration of global maxima in PREVIEW, STANDARD and HIGH; see
   * vtkSplattingMIPVolumeMapper::SetAcceleration(). Defaults: AUTO, LineTolerance 0 (clamped to [0,
   * 64]).
   */
  vtkSetClampMacro(Acceleration, int, AUTO, SORTED_VOLUME);
  vtkGetMacro(Acceleration, int);
  void SetAccelerationToAuto() { this->SetAcceleration(AUTO); }
  void SetAccelerationToDense() { this->SetAcceleration(DENSE); }
  void SetAccelerationToBricks() { this->SetAcceleration(BRICKS); }
  void SetAccelerationToLines() { this->SetAcceleration(LINES); }
  void SetAccelerationToSortedLines() { this->SetAcceleration(SORTED_LINES); }
  void SetAccelerationToSortedVolume() { this->SetAcceleration(SORTED_VOLUME); }
  vtkSetClampMacro(LineTolerance, double, 0.0, 64.0);
  vtkGetMacro(LineTolerance, double);
  ///@}

  ///@{
  /**
   * Set/Get whether the output has sample positions as the point arrays "Voxel", "Depth" and
   * "Position"; see vtkSplattingMIPVolumeMapper::GetLocations(). Default off. Without a Camera,
   * depths are distances from a plane in front of the focal point. The plane's distance from the
   * focal point is the diagonal of the volume's bounds. Averages have no positions and report a
   * warning.
   */
  vtkSetMacro(RecordLocations, vtkTypeBool);
  vtkGetMacro(RecordLocations, vtkTypeBool);
  vtkBooleanMacro(RecordLocations, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Set/Get how many bytes the index may hold besides the input; see
   * vtkSplattingMIPVolumeMapper::SetIndexMemoryBudget(). Default 4 GiB, at least 0.
   */
  vtkSetClampMacro(IndexMemoryBudget, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(IndexMemoryBudget, vtkTypeInt64);
  ///@}

  /**
   * Get how many bytes are held for the last input: bricks, chains, copies and the bounds of EXACT.
   */
  vtkIdType GetIndexMemorySize();

  /**
   * Get how often the last Update() projected the volume: NumberOfViews, or fewer if views share
   * projections with opposite or equal ones, or with the last Update().
   */
  vtkGetMacro(NumberOfProjections, vtkIdType);

  /**
   * Get the instruction set of the loops in use: "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI".
   */
  const char* GetInstructionSet();

  /**
   * Set `camera` to the camera of a view, 0 to NumberOfViews - 1, of the last Update(). It serves
   * to draw over the slice of this view. Its parallel scale or view angle corresponds to the height
   * of the slice. Returns false and leaves the camera unchanged if there is no such view.
   */
  bool GetViewCamera(int view, vtkCamera* camera);

  /**
   * Get the last shear image of the last view; see vtkSplattingMIPVolumeMapper::GetShearImage().
   * Returns nullptr before the first Update() and in EXACT, except in overviews and for averages.
   */
  vtkImageData* GetShearImage();

  vtkMTimeType GetMTime() override;

protected:
  vtkSplattingMIPProjection();
  ~vtkSplattingMIPProjection() override;

  int RequestInformation(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestUpdateExtent(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;

private:
  vtkCamera* Camera = nullptr;
  double ViewDirection[3] = { 0.0, 1.0, 0.0 };
  double ViewUp[3] = { 0.0, 0.0, 1.0 };
  vtkTypeBool CenterOnVolume = 1;
  double FocalPoint[3] = { 0.0, 0.0, 0.0 };
  int OutputSize[2] = { 256, 256 };
  double OutputSpacing[2] = { 0.0, 0.0 };
  int NumberOfViews = 1;
  double RotationAxis[3] = { 0.0, 0.0, 0.0 };
  double TotalAngle = 360.0;
  double BackgroundValue = 0.0;
  int BlendMode = MAXIMUM_INTENSITY_BLEND;
  double AverageIPScalarRange[2] = { VTK_FLOAT_MIN, VTK_FLOAT_MAX };
  int QualityMode = EXACT;
  int Kernel = TRILINEAR;
  double KernelRadius = 1.0;
  int FootprintSampling = 0;
  int MaximumType = GLOBAL;
  double DepthShadingAmbient = 0.3;
  double DepthShadingChangeRate = 0.7;
  double LocalMaximumThreshold = 0.0;
  double SignedOrigin = 0.0;
  int VectorMode = DISABLED;
  int VectorComponent = 0;
  vtkTypeBool Slab = 0;
  double SlabThickness = 10.0;
  double SlabCenter[3] = { 0.0, 0.0, 0.0 };
  vtkTypeBool Cropping = 0;
  double CroppingRegionPlanes[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  int CroppingRegionFlags = 1 << 13; // VTK_CROP_SUBVOLUME
  int Acceleration = AUTO;
  double LineTolerance = 0.0;
  vtkTypeBool RecordLocations = 0;
  vtkTypeInt64 IndexMemoryBudget = vtkTypeInt64(1) << 32;
  vtkIdType NumberOfProjections = 0;

  vtkSplattingMIPProjection(const vtkSplattingMIPProjection&) = delete;
  void operator=(const vtkSplattingMIPProjection&) = delete;

  class Internals;
  std::unique_ptr<Internals> Internal;
};
VTK_ABI_NAMESPACE_END

#endif
