// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPProjection
 * @brief   maximum intensity projection of image data to image data, without OpenGL
 *
 * Projects a vtkImageData as vtkSplattingMIPVolumeMapper does [W. Cai and G. Sakas, "Maximum
 * Intensity Projection Using Splatting in Sheared Object Space", Computer Graphics Forum 17(3),
 * 1998], with the same code below it, but gives the maxima themselves, in the input's unit
 * (Hounsfield units stay Hounsfield units), and needs no display, no render window and no OpenGL.
 * One view, or in one call all views of a turn, which share what is made once per data set.
 *
 * Input: points or cells, 1 to 4 components, any numeric type but bits, any extent, spacing, origin
 * and direction matrix; the array of SetInputArrayToProcess(), by default the scalars. NaN and
 * voxels that ghost arrays hide are no samples.
 *
 * Output: a vtkImageData of OutputSize[0] x OutputSize[1] x NumberOfViews points, one slice per
 * view, with as many components as are projected, each projected for itself. Scalars are float, for
 * 32- and 64-bit integers and double double: pictures are interpolated between the pixels of shear
 * images, so that even a preview's pixels lie between voxels, and EXACT interpolates voxels. Pixels
 * that no sample is seen at have BackgroundValue. Rows are the picture's from the bottom to the
 * top.
 *
 * The output lies where its picture lies in the world: origin, spacing and direction matrix are
 * those of the plane through the focal point across the view, in which perspective views, too, have
 * their scale; of a parallel view with a Slab, of the plane in the slab's middle. x goes right, y
 * up and z to the viewer; a slice is as thick as the Slab, else 1. So a slab can be laid over the
 * volume, measured in and written. VTK's XML keeps all of it. vtkNIFTIImageWriter needs it as a
 * matrix (SetQFormMatrix()): the direction matrix D, and in the last column origin - D * origin;
 * the rows of x and y negated where the world is DICOM's. VTK 9.1's vtkMetaImageWriter and image
 * filters drop directions. Of a turn the first view lies right; the array "ViewAngle" of the field
 * data has the degrees by which each slice's view is turned.
 *
 * Rays are parallel, or those of a perspective Camera. They end with the volume: a camera's
 * clipping range means nothing here. Slab and Cropping leave out parts of the volume.
 *
 * Progress goes from 0 to 1 over all views. AbortExecute is looked at between bands of image rows,
 * with VTK 9.3 and newer that of the filters upstream, too (vtkAlgorithm::CheckAbort()); the output
 * is empty then, and AbortExecuteOff() makes the next Update() project again. What cannot be
 * projected gives one error, a sentence that says what to do, and an empty output.
 *
 * The same input gives the same bits, whatever the number of threads or the instruction set; each
 * slice of a turn has those of the single view by the camera of GetViewCamera(). Opposite views of
 * a whole turn with an even number of views share a projection, but not in EXACT, nor if
 * MaximumType depends on the viewer's side.
 *
 * Memory besides input and output: see GetIndexMemorySize() and vtkSplattingMIPVolumeMapper. It is
 * kept for the next Update(). Where there is not enough of it, an error says so, the output is
 * empty, and all of it is given back.
 *
 * @sa vtkSplattingMIPVolumeMapper vtkImageSlabReslice
 */
#ifndef vtkSplattingMIPProjection_h
#define vtkSplattingMIPProjection_h

#include "vtkImageAlgorithm.h"
#include "vtkImagingSplattingMIPModule.h" // for the export macro

#include <memory> // for the hidden properties and implementation

namespace splatting
{
struct ProjectionProperties;
}
class vtkCamera;

class VTKIMAGINGSPLATTINGMIP_EXPORT vtkSplattingMIPProjection : public vtkImageAlgorithm
{
public:
  static vtkSplattingMIPProjection* New();
  vtkTypeMacro(vtkSplattingMIPProjection, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The values of vtkVolumeMapper's BlendMode.
   */
  enum BlendModes
  {
    MAXIMUM_INTENSITY_BLEND = 1,
    MINIMUM_INTENSITY_BLEND = 2,
    AVERAGE_INTENSITY_BLEND = 3
  };

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
   * Looks through a camera of the world, parallel or perspective, in place of ViewDirection, ViewUp
   * and FocalPoint. Default none. The camera's clipping range means nothing; its scale (or view
   * angle) does unless OutputSpacing is set. A camera with an explicit projection matrix is
   * refused.
   */
  virtual void SetCamera(vtkCamera* camera);
  vtkGetObjectMacro(Camera, vtkCamera);
  ///@}

  ///@{
  /**
   * Without a Camera: the direction from the viewer into the world, of any length above 0, and what
   * is up in the picture, not along the direction. Defaults (0, 1, 0) and (0, 0, 1): in DICOM's
   * coordinates the patient's front, head up. Views are parallel.
   */
  vtkSetVector3Macro(ViewDirection, double);
  vtkGetVector3Macro(ViewDirection, double);
  vtkSetVector3Macro(ViewUp, double);
  vtkGetVector3Macro(ViewUp, double);
  ///@}

  ///@{
  /**
   * Without a Camera: whether the middle of the picture, about which turns go, is the middle of the
   * volume's bounds, whatever FocalPoint is. Default on.
   */
  vtkSetMacro(CenterOnVolume, bool);
  vtkGetMacro(CenterOnVolume, bool);
  vtkBooleanMacro(CenterOnVolume, bool);
  ///@}

  ///@{
  /**
   * Without a Camera and with CenterOnVolume off: the point of the world in the middle of the
   * picture. Default (0, 0, 0).
   */
  vtkSetVector3Macro(FocalPoint, double);
  vtkGetVector3Macro(FocalPoint, double);
  ///@}

  ///@{
  /**
   * Pixels of a view, to the right and up. Default 256 x 256; each from 1 to 16384.
   */
  vtkSetVector2Macro(OutputSize, int);
  vtkGetVector2Macro(OutputSize, int);
  ///@}

  ///@{
  /**
   * World units from pixel to pixel, in perspective at the focal point, above 0; by default 0 and
   * 0, which means automatic: as the Camera's parallel scale (or view angle) has it, without a
   * Camera so that the volume fits into the picture from all directions: the diagonal of its bounds
   * over the lesser of OutputSize. The output tells what it is.
   */
  vtkSetVector2Macro(OutputSpacing, double);
  vtkGetVector2Macro(OutputSpacing, double);
  ///@}

  ///@{
  /**
   * How many views a turn has, by default 1, clamped to [1, 36000]. View n is turned by n *
   * TotalAngle / NumberOfViews.
   */
  vtkSetClampMacro(NumberOfViews, int, 1, 36000);
  vtkGetMacro(NumberOfViews, int);
  ///@}

  ///@{
  /**
   * The direction of the line through the focal point that the viewer goes round, in the world;
   * (0, 0, 0), the default, for view-up. The sense is that of vtkCamera::Azimuth():
   * counterclockwise where the axis points to the eye.
   */
  vtkSetVector3Macro(RotationAxis, double);
  vtkGetVector3Macro(RotationAxis, double);
  ///@}

  ///@{
  /**
   * How far all views go round in degrees, any number but 0. Default 360. The last view is one step
   * before that, so that a whole turn can be repeated.
   */
  vtkSetMacro(TotalAngle, double);
  vtkGetMacro(TotalAngle, double);
  ///@}

  ///@{
  /**
   * The value of pixels that no sample is seen at; NaN is possible. Default 0.
   */
  vtkSetMacro(BackgroundValue, double);
  vtkGetMacro(BackgroundValue, double);
  ///@}

  ///@{
  /**
   * Maximum (the default), minimum or average along rays, as in
   * vtkSplattingMIPVolumeMapper::SetBlendMode. Of averages, samples outside AverageIPScalarRange
   * (default: that of float) do not count; both limits do.
   */
  virtual void SetBlendMode(int);
  virtual int GetBlendMode();
  virtual int GetBlendModeMinValue();
  virtual int GetBlendModeMaxValue();
  void SetBlendModeToMaximumIntensity() { this->SetBlendMode(MAXIMUM_INTENSITY_BLEND); }
  void SetBlendModeToMinimumIntensity() { this->SetBlendMode(MINIMUM_INTENSITY_BLEND); }
  void SetBlendModeToAverageIntensity() { this->SetBlendMode(AVERAGE_INTENSITY_BLEND); }
  virtual void SetAverageIPScalarRange(double low, double high);
  virtual void SetAverageIPScalarRange(const double values[2]);
  virtual double* GetAverageIPScalarRange() VTK_SIZEHINT(2);
  virtual void GetAverageIPScalarRange(double& low, double& high);
  virtual void GetAverageIPScalarRange(double values[2]);
  ///@}

  ///@{
  /**
   * What a slice contributes to a pixel. PREVIEW, STANDARD, HIGH: see
   * vtkSplattingMIPVolumeMapper::SetQualityMode. EXACT (default): the extremum of the trilinearly
   * interpolated volume on the ray of each pixel; averages are those of HIGH. Pixels that are wider
   * than voxels show the extremum over their area (of averages the average), in EXACT that of
   * voxels.
   */
  virtual void SetQualityMode(int);
  virtual int GetQualityMode();
  virtual int GetQualityModeMinValue();
  virtual int GetQualityModeMaxValue();
  void SetQualityModeToPreview() { this->SetQualityMode(PREVIEW); }
  void SetQualityModeToStandard() { this->SetQualityMode(STANDARD); }
  void SetQualityModeToHigh() { this->SetQualityMode(HIGH); }
  void SetQualityModeToExact() { this->SetQualityMode(EXACT); }
  ///@}

  ///@{
  /**
   * As of the mapper: the reconstruction kernel of mode HIGH, default TRILINEAR; the radius of the
   * cosine bell in voxels, default 1, clamped to [0.5, 1.5]; how footprints are sampled, default 0
   * (closed form), clamped to [0, 64].
   */
  virtual void SetKernel(int);
  virtual int GetKernel();
  virtual int GetKernelMinValue();
  virtual int GetKernelMaxValue();
  void SetKernelToTrilinear() { this->SetKernel(TRILINEAR); }
  void SetKernelToCosineBell() { this->SetKernel(COSINE_BELL); }
  virtual void SetKernelRadius(double);
  virtual double GetKernelRadius();
  virtual double GetKernelRadiusMinValue();
  virtual double GetKernelRadiusMaxValue();
  virtual void SetFootprintSampling(int);
  virtual int GetFootprintSampling();
  virtual int GetFootprintSamplingMinValue();
  virtual int GetFootprintSamplingMaxValue();
  ///@}

  ///@{
  /**
   * Which maximum along a ray, as of the mapper: the largest (GLOBAL, the default), the largest
   * after dimming by depth (DEPTH_SHADED, with DepthShadingAmbient 0.3 and DepthShadingChangeRate
   * 0.7 by default), or the first local one from LocalMaximumThreshold on (LOCAL, default 0).
   */
  virtual void SetMaximumType(int);
  virtual int GetMaximumType();
  virtual int GetMaximumTypeMinValue();
  virtual int GetMaximumTypeMaxValue();
  void SetMaximumTypeToGlobal() { this->SetMaximumType(GLOBAL); }
  void SetMaximumTypeToDepthShaded() { this->SetMaximumType(DEPTH_SHADED); }
  void SetMaximumTypeToLocal() { this->SetMaximumType(LOCAL); }
  virtual void SetDepthShadingAmbient(double);
  virtual double GetDepthShadingAmbient();
  virtual void SetDepthShadingChangeRate(double);
  virtual double GetDepthShadingChangeRate();
  virtual void SetLocalMaximumThreshold(double);
  virtual double GetLocalMaximumThreshold();
  ///@}

  ///@{
  /**
   * What is projected of several components, as of the mapper: all (DISABLED, the default), their
   * Euclidean length, or the one that VectorComponent names (default 0, clamped to [0, 3]).
   */
  virtual void SetVectorMode(int);
  virtual int GetVectorMode();
  virtual int GetVectorModeMinValue();
  virtual int GetVectorModeMaxValue();
  void SetVectorModeToDisabled() { this->SetVectorMode(DISABLED); }
  void SetVectorModeToMagnitude() { this->SetVectorMode(MAGNITUDE); }
  void SetVectorModeToComponent() { this->SetVectorMode(COMPONENT); }
  virtual void SetVectorComponent(int);
  virtual int GetVectorComponent();
  virtual int GetVectorComponentMinValue();
  virtual int GetVectorComponentMaxValue();
  ///@}

  ///@{
  /**
   * Project only a slab across the view, as of the mapper: what lies within SlabThickness / 2
   * (default 10, in world units, above 0) of the plane through SlabCenter, a point of the world, by
   * default (0, 0, 0). Default off. In a turn the slab turns with the view.
   */
  virtual void SetSlab(bool);
  virtual bool GetSlab();
  vtkBooleanMacro(Slab, bool);
  virtual void SetSlabThickness(double);
  virtual double GetSlabThickness();
  virtual void SetSlabCenter(double x, double y, double z);
  virtual void SetSlabCenter(const double values[3]);
  virtual double* GetSlabCenter() VTK_SIZEHINT(3);
  virtual void GetSlabCenter(double& x, double& y, double& z);
  virtual void GetSlabCenter(double values[3]);
  ///@}

  ///@{
  /**
   * VTK's cropping, as of vtkVolumeMapper: which of the 27 regions between six planes, in the
   * coordinates of the input along its axes, are projected. Default off, all planes 0 and 1, flags
   * VTK_CROP_SUBVOLUME (the middle region), clamped to [0, 0x7ffffff].
   */
  virtual void SetCropping(vtkTypeBool);
  virtual vtkTypeBool GetCropping();
  vtkBooleanMacro(Cropping, vtkTypeBool);
  virtual void SetCroppingRegionPlanes(
    double xMin, double xMax, double yMin, double yMax, double zMin, double zMax);
  virtual void SetCroppingRegionPlanes(const double values[6]);
  virtual double* GetCroppingRegionPlanes() VTK_SIZEHINT(6);
  virtual void GetCroppingRegionPlanes(
    double& xMin, double& xMax, double& yMin, double& yMax, double& zMin, double& zMax);
  virtual void GetCroppingRegionPlanes(double values[6]);
  virtual void SetCroppingRegionFlags(int);
  virtual int GetCroppingRegionFlags();
  virtual int GetCroppingRegionFlagsMinValue();
  virtual int GetCroppingRegionFlagsMaxValue();
  ///@}

  ///@{
  /**
   * What the projection leaves out and in which order it meets the rest, as of the mapper. The
   * picture is the same but for LineTolerance (default 0, clamped to [0, 64]), the difference that
   * the chains of LINES and its kin may neglect. Default AUTO; EliminateInvisible default off.
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
  virtual void SetLineTolerance(double);
  virtual double GetLineTolerance();
  virtual double GetLineToleranceMinValue();
  virtual double GetLineToleranceMaxValue();
  virtual void SetEliminateInvisible(bool);
  virtual bool GetEliminateInvisible();
  vtkBooleanMacro(EliminateInvisible, bool);
  ///@}

  ///@{
  /**
   * Whether the output also tells where the samples lie that it shows, as point arrays: "Voxel",
   * three ints, the input's i, j, k relative to its first voxel, -1 without a sample; "Depth",
   * float, the distance in world units from the camera's plane, in perspective from the eye;
   * "Position", three doubles, the point of the world; NaN without a sample. All as of
   * vtkSplattingMIPVolumeMapper::GetLocations(). Averages have none, which a warning says. Without
   * a Camera the plane lies the diagonal of the volume's bounds before the focal point. Default
   * off.
   */
  virtual void SetRecordLocations(bool);
  virtual bool GetRecordLocations();
  vtkBooleanMacro(RecordLocations, bool);
  ///@}

  ///@{
  /**
   * Bytes that the index may hold besides the input. Default 4 GiB. What would exceed them is not
   * made: projections are slower then, and the same.
   */
  virtual void SetIndexMemoryBudget(vtkTypeInt64);
  virtual vtkTypeInt64 GetIndexMemoryBudget();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMinValue();
  virtual vtkTypeInt64 GetIndexMemoryBudgetMaxValue();
  ///@}

  /**
   * Bytes held for the input of the last Update(): bricks, chains, copies.
   */
  vtkIdType GetIndexMemorySize();

  /**
   * How often the last Update() has projected the volume: NumberOfViews or, where opposite views
   * share projections, half of it.
   */
  vtkGetMacro(NumberOfProjections, vtkIdType);

  /**
   * The instruction set of the loops in use: "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI".
   */
  const char* GetInstructionSet();

  /**
   * Sets a camera to that of a view of the last Update(), 0 to NumberOfViews - 1, for what is to be
   * drawn over its slice; its parallel scale or view angle is that of the slice's height. False,
   * and the camera stays as it is, if there is no such view.
   */
  bool GetViewCamera(int view, vtkCamera* camera);

  /**
   * The last shear image of the last Update(), as vtkSplattingMIPVolumeMapper::GetShearImage() has
   * it, or nullptr; EXACT has none. The last view is the last slice, in whole turns with an even
   * number of views, too. Costs a copy of the shear image.
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

  vtkCamera* Camera;
  double ViewDirection[3];
  double ViewUp[3];
  bool CenterOnVolume;
  double FocalPoint[3];
  int OutputSize[2];
  double OutputSpacing[2];
  int NumberOfViews;
  double RotationAxis[3];
  double TotalAngle;
  double BackgroundValue;
  vtkIdType NumberOfProjections;

private:
  vtkSplattingMIPProjection(const vtkSplattingMIPProjection&) = delete;
  void operator=(const vtkSplattingMIPProjection&) = delete;

  std::unique_ptr<splatting::ProjectionProperties> Properties;
  class Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
