// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MIPScene.h"

#include "ProgressLine.h"

#include "vtkCamera.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkTextProperty.h"
#include "vtkTransform.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace
{
void SetColors(vtkVolumeProperty* property, const LookSettings& look)
{
  vtkNew<vtkPiecewiseFunction> opaque;
  opaque->AddPoint(look.Level - 0.5 * look.Window, 1.0);
  property->SetColor(MakeColors(look));
  property->SetScalarOpacity(opaque);
}
}

void CheckDisplay()
{
  // Newer versions of VTK would print a warning of their own.
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<vtkRenderWindow> window;
  vtkObject::GlobalWarningDisplayOn();
  const char* display = std::getenv("DISPLAY");
  if (window->IsA("vtkXOpenGLRenderWindow") && (!display || !*display))
  {
    throw std::runtime_error(
      "there is no display (DISPLAY is not set); run splatmip on a desktop, or "
      "by xvfb-run -a.");
  }
}

MIPScene::MIPScene(const Volume& volume, const ProjectionSettings& settings,
  const LookSettings& look, const ViewSettings& view, bool isOffScreen)
  : View(view),
    Image(volume.Image)
{
  // vtkFixedPointVolumeRayCastMapper ignores direction matrices.
  vtkNew<vtkImageData> straight;
  straight->ShallowCopy(volume.Image);
  straight->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  for (vtkVolumeMapper* mapper : { static_cast<vtkVolumeMapper*>(this->Splatting),
         static_cast<vtkVolumeMapper*>(this->RayCasting) })
  {
    mapper->SetInputData(straight);
    mapper->SetBlendModeToMaximumIntensity();
  }
  const double* spacing = volume.Image->GetSpacing();
  this->RayCasting->AutoAdjustSampleDistancesOff();
  this->RayCasting->SetImageSampleDistance(1.0f);
  this->RayCasting->SetSampleDistance(static_cast<float>(*std::min_element(spacing, spacing + 3)));
  SetColors(this->Property, look);
  this->Prop->SetProperty(this->Property);
  vtkNew<vtkMatrix4x4> orientation;
  for (int n = 0; n < 9; ++n)
  {
    orientation->SetElement(n / 3, n % 3, volume.Image->GetDirectionMatrix()->GetData()[n]);
  }
  this->Prop->SetUserMatrix(orientation);
  this->UseSplatting(vtkSplattingMIPVolumeMapper::EXACT);

  const double paper = look.Colormap == "inverted" ? 1.0 : 0.0;
  this->Label->GetTextProperty()->SetColor(1.0 - paper, 1.0 - paper, 1.0 - paper);
  this->Label->GetTextProperty()->SetFontSize(std::max(8, view.Size[1] / 32));
  this->Label->GetTextProperty()->SetVerticalJustificationToTop();
  this->Label->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  this->Label->SetPosition(0.02, 0.99);
  this->Renderer->SetBackground(paper, paper, paper);
  this->Renderer->AddVolume(this->Prop);
  this->Renderer->AddViewProp(this->Label);
  this->Window->SetOffScreenRendering(isOffScreen);
  this->Window->SetMultiSamples(0);
  this->Window->SetSize(view.Size[0], view.Size[1]);
  this->Window->AddRenderer(this->Renderer);
  this->FitCamera(view.Azimuth);
  std::array<double, 3> center;
  this->Renderer->GetActiveCamera()->GetFocalPoint(center.data());
  Apply(settings, center, this->Splatting.Get());
}

void MIPScene::UseSplatting(int qualityMode)
{
  this->Splatting->SetQualityMode(qualityMode);
  this->Property->SetInterpolationTypeToLinear();
  this->Prop->SetMapper(this->Splatting);
}

void MIPScene::UseRayCasting(int interpolation)
{
  this->Property->SetInterpolationType(interpolation);
  this->Prop->SetMapper(this->RayCasting);
}

void MIPScene::FitCamera(double azimuth)
{
  const auto turn = MakeViewTurn(this->View, azimuth);
  const double* bounds = this->Prop->GetBounds();
  const double center[3] = { 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]),
    0.5 * (bounds[4] + bounds[5]) };
  const double* away = turn->TransformDoubleVector(0.0, 1.0, 0.0);
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(center);
  camera->SetPosition(center[0] - away[0], center[1] - away[1], center[2] - away[2]);
  camera->SetViewUp(turn->TransformDoubleVector(0.0, 0.0, 1.0));
  this->Renderer->ResetCamera(bounds); // for the distance
  camera->SetParallelScale(GetFittingScale(this->Image, this->View, turn) / this->View.Zoom);
  if (this->View.Perspective > 0.0)
  {
    const auto fit = FitPerspective(this->Image, this->View);
    camera->ParallelProjectionOff();
    camera->SetViewAngle(vtkMath::DegreesFromRadians(
      2.0 * std::atan(fit.HalfHeight / this->View.Zoom / fit.Distance)));
    camera->Dolly(camera->GetDistance() / fit.Distance);
  }
  this->Renderer->ResetCameraClippingRange(bounds);
}

double MIPScene::MeasureFrame(const std::string& what)
{
  using Clock = std::chrono::steady_clock;
  ProgressLine line("timing " + what);
  const int middle = NumberOfTimedFrames / 2;
  std::vector<double> times;
  for (int frame = -1; frame < NumberOfTimedFrames; ++frame)
  {
    line.Show((frame + 1.0) / (NumberOfTimedFrames + 1.0));
    this->FitCamera(this->View.Azimuth + frame - middle);
    const auto start = Clock::now();
    this->Window->Render();
    this->Window->WaitForCompletion();
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  this->FitCamera(this->View.Azimuth);
  times.erase(times.begin());
  std::nth_element(times.begin(), times.begin() + middle, times.end());
  return times[middle];
}

void MIPScene::SetLabel(const std::string& label)
{
  this->Label->SetInput(label.c_str());
}

std::string FormatTime(double milliseconds)
{
  char text[32];
  std::snprintf(text, sizeof(text), milliseconds < 100 ? "%.1f ms" : "%.0f ms", milliseconds);
  return text;
}
