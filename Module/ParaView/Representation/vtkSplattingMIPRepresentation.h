// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPRepresentation
 * @brief   shows image data in ParaView as a projection made by vtkSplattingMIPVolumeMapper
 *
 * vtkImageVolumeRepresentation with another mapper. Array, transfer functions, vector component,
 * separate opacity array, cropping and the actor's transform come from there; what the properties
 * below mean is said in vtkSplattingMIPVolumeMapper. What differs:
 *
 * Without an array to colour by ("Solid Color") the active scalars, or the first array that there
 * is, are shown in opaque gray, black at their least and white at their largest value.
 *
 * Input is vtkImageData, vtkRectilinearGrid, or composite data that hold exactly one of either; a
 * projection of several is not the projections of each, blended. Anything else gives one error that
 * says so, and an empty picture, until the input changes.
 *
 * As with all volumes in ParaView, the process that has the data renders it: with a server the
 * picture is made there, whatever the threshold for remote rendering.
 *
 * The ranks of a server project their pieces of the image with the ghost layers that this asks the
 * pipeline for, and the first of them shows the picture of the whole (see
 * vtkSplattingMIPVolumeMapper::SetController), which ParaView's compositor then finds on that rank
 * alone. Opaque geometry, which is on other ranks as well, does not cut rays there.
 */
#ifndef vtkSplattingMIPRepresentation_h
#define vtkSplattingMIPRepresentation_h

#include "vtkImageVolumeRepresentation.h"
#include "vtkNew.h"                               // for members
#include "vtkSplattingMIPRepresentationsModule.h" // for the export macro

#include <string> // for members

class vtkDataArray;
class vtkMultiProcessController;
class vtkSplattingMIPVolumeMapper;

class VTKSPLATTINGMIPREPRESENTATIONS_EXPORT vtkSplattingMIPRepresentation
  : public vtkImageVolumeRepresentation
{
public:
  static vtkSplattingMIPRepresentation* New();
  vtkTypeMacro(vtkSplattingMIPRepresentation, vtkImageVolumeRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Projections
  {
    MAXIMUM = 0,
    MINIMUM = 1,
    AVERAGE = 2,
    DEPTH_SHADED = 3,
    LOCAL = 4
  };

  enum InteractiveQualities
  {
    AUTOMATIC = -1
  };

  /**
   * Which of a ray's samples is shown: the mapper's BlendMode and MaximumType in one. Default
   * MAXIMUM.
   */
  void SetProjection(int projection);

  ///@{
  /**
   * The mapper's QualityMode in still and in interactive renders. Defaults EXACT and AUTOMATIC. In
   * interactive renders AUTOMATIC is the best mode up to the still one that is expected to fit into
   * the time that ParaView allows for a frame.
   */
  vtkSetClampMacro(QualityMode, int, 0, 3);
  vtkGetMacro(QualityMode, int);
  vtkSetClampMacro(InteractiveQualityMode, int, AUTOMATIC, 3);
  vtkGetMacro(InteractiveQualityMode, int);
  ///@}

  ///@{
  /**
   * Passed on to the mapper.
   */
  void SetKernel(int kernel);
  void SetKernelRadius(double radius);
  void SetDepthShadingAmbient(double ambient);
  void SetDepthShadingChangeRate(double rate);
  void SetLocalMaximumThreshold(double threshold);
  void SetSlab(bool slab);
  void SetSlabThickness(double thickness);
  void SetSlabCenter(double x, double y, double z);
  void SetAcceleration(int acceleration);
  void SetLineTolerance(double tolerance);
  void SetCullBelowWindow(bool cull);
  ///@}

  /**
   * The mapper's IndexMemoryBudget in MiB; default 4096.
   */
  void SetIndexMemoryBudget(int mebibytes);

  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;

protected:
  vtkSplattingMIPRepresentation();
  ~vtkSplattingMIPRepresentation() override;

  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void UpdateMapperParameters() override;

  vtkSplattingMIPVolumeMapper* GetSplattingMapper();
  std::string CheckOpacityArray(vtkDataSet* volume);
  vtkDataArray* FindScalars(vtkDataSet* volume, bool isColored);
  void ShowInGray(const double range[2], int components);
  void ShowWithOthers(vtkDataSet* volume, vtkDataArray* scalars, bool isColored, bool isWrong);
  std::string SelectComponents(vtkDataArray* scalars);
  void Complain(std::string& last, const std::string& problem);

  vtkMultiProcessController* GetSeveralRanks();

  int QualityMode;
  int InteractiveQualityMode;
  bool InteractiveRender = false;
  bool OpacityArrayIsUsable = false;
  vtkNew<vtkVolumeProperty> GrayProperty;

  // What has been told, so that it is told once.
  std::string InputProblem;
  std::string ArrayProblem;

private:
  vtkSplattingMIPRepresentation(const vtkSplattingMIPRepresentation&) = delete;
  void operator=(const vtkSplattingMIPRepresentation&) = delete;
};

#endif
