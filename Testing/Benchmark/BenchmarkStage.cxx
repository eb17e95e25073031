// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkStage.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkSMPTools.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkTransform.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace
{
vtkSmartPointer<vtkVolumeMapper> MakeSplatting(const BenchmarkMapper& kind)
{
  auto mapper = vtkSmartPointer<vtkSplattingMIPVolumeMapper>::New();
  mapper->SetQualityMode(kind.QualityMode);
  return mapper;
}

vtkSmartPointer<vtkVolumeMapper> MakeCPURayCasting(double distance)
{
  auto mapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetSampleDistance(static_cast<float>(distance));
  mapper->SetNumberOfThreads(vtkSMPTools::GetEstimatedNumberOfThreads());
  return mapper;
}

vtkSmartPointer<vtkVolumeMapper> MakeGPURayCasting(double distance)
{
  auto mapper = vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->UseJitteringOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetSampleDistance(static_cast<float>(distance));
  return mapper;
}

vtkSmartPointer<vtkVolumeMapper> MakeMapper(const BenchmarkMapper& kind, vtkImageData* image)
{
  const double* spacing = image->GetSpacing();
  const double distance = *std::min_element(spacing, spacing + 3);
  vtkSmartPointer<vtkVolumeMapper> mapper;
  switch (kind.Kind)
  {
    case BenchmarkMapper::SPLATTING:
      mapper = MakeSplatting(kind);
      break;
    case BenchmarkMapper::CPU_RAY_CASTING:
      mapper = MakeCPURayCasting(distance);
      break;
    case BenchmarkMapper::GPU_RAY_CASTING:
      mapper = MakeGPURayCasting(distance);
      break;
  }
  mapper->SetInputData(image);
  mapper->SetBlendModeToMaximumIntensity();
  return mapper;
}

/// X would end the program in the middle of VTK, with a message that does not say what to do.
void RequireDisplay(vtkRenderWindow* window)
{
  const char* display = std::getenv("DISPLAY");
  if (window->IsA("vtkXOpenGLRenderWindow") && (!display || !*display))
  {
    std::cerr << "There is no display (DISPLAY is not set): run this on a desktop, or as xvfb-run "
                 "-a splatmip-benchmark.\n";
    std::exit(EXIT_FAILURE);
  }
}
}

//------------------------------------------------------------------------------
const std::vector<BenchmarkMapper>& GetBenchmarkMappers()
{
  using Mapper = BenchmarkMapper;
  using Splatting = vtkSplattingMIPVolumeMapper;
  constexpr int nearest = VTK_NEAREST_INTERPOLATION, linear = VTK_LINEAR_INTERPOLATION;
  static const std::vector<Mapper> mappers = {
    { "preview", Mapper::SPLATTING, Splatting::PREVIEW, linear },
    { "standard", Mapper::SPLATTING, Splatting::STANDARD, linear },
    { "high", Mapper::SPLATTING, Splatting::HIGH, linear },
    { "exact", Mapper::SPLATTING, Splatting::EXACT, linear },
    { "raycast-nearest", Mapper::CPU_RAY_CASTING, 0, nearest },
    { "raycast-linear", Mapper::CPU_RAY_CASTING, 0, linear },
    { "gpu", Mapper::GPU_RAY_CASTING, 0, linear },
  };
  return mappers;
}

//------------------------------------------------------------------------------
const int BenchmarkStage::ViewsOfAxes[3] = { 4, 22, 9 };

//------------------------------------------------------------------------------
BenchmarkStage& BenchmarkStage::GetInstance()
{
  static BenchmarkStage stage;
  return stage;
}

//------------------------------------------------------------------------------
BenchmarkStage::BenchmarkStage()
{
  RequireDisplay(this->Window);
  this->Window->SetOffScreenRendering(1);
  this->Window->SetMultiSamples(0);
  this->Window->AddRenderer(this->Renderer);
  this->SetSize(64);
}

//------------------------------------------------------------------------------
std::string BenchmarkStage::GetDeviceName()
{
  const std::string key = "OpenGL renderer string:";
  std::istringstream lines(this->Window->ReportCapabilities());
  std::string line;
  while (std::getline(lines, line))
  {
    if (line.compare(0, key.size(), key) == 0)
    {
      const std::size_t begin = line.find_first_not_of(' ', key.size());
      return begin == std::string::npos ? "unknown" : line.substr(begin);
    }
  }
  return "unknown";
}

//------------------------------------------------------------------------------
void BenchmarkStage::SetSize(int pixels)
{
  this->Window->SetSize(pixels, pixels);
  this->Pixels->SetNumberOfComponents(4);
  this->Pixels->SetNumberOfTuples(static_cast<vtkIdType>(pixels) * pixels);
  this->MeasureFrame(); // the buffers of the new size belong to nobody's first frame
}

//------------------------------------------------------------------------------
void BenchmarkStage::SetMapper(const BenchmarkMapper& kind, vtkImageData* image)
{
  this->Clear();
  image->GetScalarRange(this->Range);
  this->SetWhite(1.0);
  vtkNew<vtkPiecewiseFunction> opaque;
  opaque->AddPoint(this->Range[0], 1.0);
  this->Property->SetScalarOpacity(opaque);
  this->Property->SetInterpolationType(kind.Interpolation);
  image->GetPointData()->GetScalars()->Modified();

  this->Mapper = MakeMapper(kind, image);
  this->Prop->SetProperty(this->Property);
  this->Prop->SetMapper(this->Mapper);
  this->Renderer->AddVolume(this->Prop);
}

//------------------------------------------------------------------------------
void BenchmarkStage::Clear()
{
  this->Renderer->RemoveVolume(this->Prop); // releases the graphics resources, too
  this->Prop->SetMapper(nullptr);
  this->Mapper = nullptr;
  this->MeasureFrame();
}

//------------------------------------------------------------------------------
void BenchmarkStage::LookFrom(int view)
{
  const int steps = NumberOfViews / 2;
  const double angle = 360.0 / steps * (view % steps);
  vtkNew<vtkTransform> turn;
  if (view < steps)
  {
    turn->RotateY(angle);
    turn->RotateX(-7.0);
  }
  else
  {
    turn->RotateX(-angle);
    turn->RotateY(7.0);
  }
  double bounds[6];
  this->Mapper->GetBounds(bounds);
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  camera->SetParallelProjection(this->ViewAngle <= 0.0);
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetPosition(turn->TransformDoubleVector(0.0, 0.0, 1.0));
  camera->SetViewUp(turn->TransformDoubleVector(0.0, 1.0, 0.0));
  camera->SetViewAngle(this->ViewAngle > 0.0 ? this->ViewAngle : 30.0);
  this->Renderer->ResetCamera(bounds); // a sphere around the volume fits ...
  if (this->ViewAngle > 0.0)           // ... and now the volume fills the window
  {
    camera->Dolly(1.5);
    this->Renderer->ResetCameraClippingRange(bounds);
  }
  else
  {
    camera->Zoom(1.5);
  }
}

//------------------------------------------------------------------------------
void BenchmarkStage::SetWhite(double share)
{
  vtkNew<vtkColorTransferFunction> gray;
  gray->AddRGBPoint(this->Range[0], 0.0, 0.0, 0.0);
  gray->AddRGBPoint(this->Range[0] + share * (this->Range[1] - this->Range[0]), 1.0, 1.0, 1.0);
  this->Property->SetColor(gray);
}

//------------------------------------------------------------------------------
double BenchmarkStage::MeasureFrame()
{
  const auto start = std::chrono::steady_clock::now();
  this->Window->Render();
  const int* size = this->Window->GetSize();
  this->Window->GetRGBACharPixelData(0, 0, size[0] - 1, size[1] - 1, 0, this->Pixels);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

//------------------------------------------------------------------------------
bool BenchmarkStage::IsFrameEmpty()
{
  const unsigned char* pixels = this->Pixels->GetPointer(0);
  for (vtkIdType i = 0; i < this->Pixels->GetNumberOfTuples(); ++i)
  {
    if (pixels[4 * i] != 0)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool BenchmarkStage::IsSupported(const BenchmarkMapper& kind)
{
  if (kind.Kind != BenchmarkMapper::GPU_RAY_CASTING)
  {
    return true;
  }
  vtkSmartPointer<vtkGPUVolumeRayCastMapper> mapper =
    vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
  return mapper->IsRenderSupported(this->Window, this->Property) != 0;
}
