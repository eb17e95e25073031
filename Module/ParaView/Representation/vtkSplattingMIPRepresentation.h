// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPRepresentation
 * @brief   ParaView representation of image data that uses vtkSplattingMIPVolumeMapper
 *
 * vtkSplattingMIPRepresentation is a vtkImageVolumeRepresentation with another mapper. Array,
 * transfer functions, vector component, separate opacity array, cropping and the actor's transform
 * are those of the superclass. The properties below are documented in vtkSplattingMIPVolumeMapper.
 *
 * Without an array to colour by ("Solid Color") the active scalars, or else the first array, are
 * shown in opaque gray, from black at their least to white at their largest value.
 *
 * The input is vtkImageData, vtkRectilinearGrid, or composite data with exactly one of them. Other
 * input is reported by one error, and nothing is shown until the input changes.
 *
 * The process that has the data renders it, as for all volumes in ParaView, whatever the threshold
 * for remote rendering.
 *
 * The ranks of a server project their pieces of the image, for which the representation requests
 * ghost layers from the pipeline. The first rank shows the picture of the whole (see
 * vtkSplattingMIPVolumeMapper::SetController). ParaView's compositor therefore finds it on that
 * rank alone. Opaque geometry, which is also on other ranks, does not cut rays then.
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
    LOCAL = 4,
    SIGNED = 5
  };

  enum InteractiveQualities
  {
    AUTOMATIC = -1
  };

  /**
   * Set the projection: the mapper's BlendMode and MaximumType in one. Default MAXIMUM.
   */
  void SetProjection(int projection);

  ///@{
  /**
   * Set/Get the mapper's QualityMode in still and in interactive renders. Defaults EXACT and
   * AUTOMATIC. In interactive renders AUTOMATIC is the best mode, up to that of still renders, that
   * is expected to fit into ParaView's time for a frame.
   */
  vtkSetClampMacro(QualityMode, int, 0, 3);
  vtkGetMacro(QualityMode, int);
  vtkSetClampMacro(InteractiveQualityMode, int, AUTOMATIC, 3);
  vtkGetMacro(InteractiveQualityMode, int);
  ///@}

  ///@{
  /**
   * Set properties of the mapper.
   */
  void SetKernel(int kernel);
  void SetKernelRadius(double radius);
  void SetDepthShadingAmbient(double ambient);
  void SetDepthShadingChangeRate(double rate);
  void SetLocalMaximumThreshold(double threshold);
  void SetSignedOrigin(double origin);
  void SetSlab(bool slab);
  void SetSlabThickness(double thickness);
  void SetSlabCenter(double x, double y, double z);
  void SetAcceleration(int acceleration);
  void SetLineTolerance(double tolerance);
  void SetCullBelowWindow(bool cull);
  ///@}

  /**
   * Set the mapper's IndexMemoryBudget in MiB. Default 4096.
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

  // the last reported error
  std::string InputProblem;
  std::string ArrayProblem;

private:
  vtkSplattingMIPRepresentation(const vtkSplattingMIPRepresentation&) = delete;
  void operator=(const vtkSplattingMIPRepresentation&) = delete;
};

#endif
