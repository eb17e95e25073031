// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "MIPScene.h"

#include "ProgressLine.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkTextProperty.h"
#include "vtkTransform.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace
{
struct ColorPoint
{
  double Position, Red, Green, Blue;
};

struct NamedColormap
{
  std::string Name;
  std::vector<ColorPoint> Points;
};

const std::vector<NamedColormap>& GetColormaps()
{
  static const std::vector<NamedColormap> maps = {
    { "gray", { { 0, 0, 0, 0 }, { 1, 1, 1, 1 } } },
    { "inverted", { { 0, 1, 1, 1 }, { 1, 0, 0, 0 } } },
    { "hot", { { 0, 0, 0, 0 }, { 0.375, 1, 0, 0 }, { 0.75, 1, 1, 0 }, { 1, 1, 1, 1 } } },
    { "bone",
      { { 0, 0, 0, 0 }, { 0.375, 0.33, 0.33, 0.45 }, { 0.75, 0.66, 0.78, 0.78 }, { 1, 1, 1, 1 } } },
  };
  return maps;
}

const NamedColormap& FindColormap(const std::string& name)
{
  for (const NamedColormap& map : GetColormaps())
  {
    if (map.Name == name)
    {
      return map;
    }
  }
  throw std::runtime_error("there is no colormap " + name + "; see splatmip --help.");
}

void SetColors(vtkVolumeProperty* property, const LookSettings& look)
{
  vtkNew<vtkPiecewiseFunction> opaque;
  opaque->AddPoint(look.Level - 0.5 * look.Window, 1.0);
  property->SetColor(MakeColors(look));
  property->SetScalarOpacity(opaque);
}

/// Voxels that tell what a volume looks like.
constexpr vtkIdType FewVoxels = 1000000;

/**
 * The finite ones of so many values, or somewhat more, evenly spread over the volume.
 */
std::vector<double> SampleValues(vtkDataArray* scalars, vtkIdType voxels)
{
  const vtkIdType count = scalars->GetNumberOfTuples();
  const vtkIdType step = std::max<vtkIdType>(1, count / voxels);
  std::vector<double> values;
  for (vtkIdType i = 0; i < count; i += step)
  {
    const double value = scalars->GetComponent(i, 0);
    if (std::isfinite(value))
    {
      values.push_back(value);
    }
  }
  return values;
}

double GetQuantile(std::vector<double>& values, double fraction)
{
  const auto place =
    values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/**
 * X ends the program if no server answers; say what to do instead.
 */
void CheckDisplay(vtkRenderWindow* window)
{
  const char* display = std::getenv("DISPLAY");
  if (window->IsA("vtkXOpenGLRenderWindow") && (!display || !*display))
  {
    throw std::runtime_error(
      "there is no display (DISPLAY is not set); run it on a desktop, or as xvfb-run -a splatmip.");
  }
}
}

vtkSmartPointer<vtkColorTransferFunction> MakeColors(const LookSettings& look)
{
  const double low = look.Level - 0.5 * look.Window;
  auto colors = vtkSmartPointer<vtkColorTransferFunction>::New();
  for (const ColorPoint& point : FindColormap(look.Colormap).Points)
  {
    colors->AddRGBPoint(low + point.Position * look.Window, point.Red, point.Green, point.Blue);
  }
  return colors;
}

std::vector<std::string> GetColormapNames()
{
  std::vector<std::string> names;
  for (const NamedColormap& map : GetColormaps())
  {
    names.push_back(map.Name);
  }
  return names;
}

void ChooseWindowLevel(vtkImageData* image, double& window, double& level)
{
  window = 1.0;
  level = 0.5;
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  std::vector<double> values = SampleValues(scalars, FewVoxels);
  if (values.empty())
  {
    values = SampleValues(scalars, scalars->GetNumberOfTuples()); // few are numbers
  }
  if (values.empty())
  {
    throw std::runtime_error(
      "the volume has no finite value, so that there is nothing to show; see what wrote it.");
  }
  double low = GetQuantile(values, 0.5);
  double high = GetQuantile(values, 0.9995);
  if (!(low < high))
  {
    low = *std::min_element(values.begin(), values.end());
    high = *std::max_element(values.begin(), values.end());
  }
  window = low < high ? high - low : 1.0;
  level = low < high ? 0.5 * (low + high) : low;
}

MIPScene::MIPScene(
  const Volume& volume, const LookSettings& look, const ViewSettings& view, bool isOffScreen)
  : View(view)
{
  CheckDisplay(this->Window);
  for (vtkVolumeMapper* mapper : { static_cast<vtkVolumeMapper*>(this->Splatting),
         static_cast<vtkVolumeMapper*>(this->RayCasting) })
  {
    mapper->SetInputData(volume.Image);
    mapper->SetBlendModeToMaximumIntensity();
  }
  const double* spacing = volume.Image->GetSpacing();
  this->RayCasting->AutoAdjustSampleDistancesOff();
  this->RayCasting->SetImageSampleDistance(1.0f);
  this->RayCasting->SetSampleDistance(static_cast<float>(*std::min_element(spacing, spacing + 3)));
  SetColors(this->Property, look);
  this->Prop->SetProperty(this->Property);
  this->Prop->SetUserMatrix(volume.Orientation);
  this->UseSplatting(vtkSplattingMIPVolumeMapper::HIGH);

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

vtkSmartPointer<vtkTransform> MakeViewTurn(const ViewSettings& view, double azimuth)
{
  auto turn = vtkSmartPointer<vtkTransform>::New();
  turn->RotateZ(azimuth);
  turn->RotateX(-view.Elevation);
  turn->RotateY(view.Roll);
  return turn;
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
  double box[6];
  this->Prop->GetMapper()->GetBounds(box);
  camera->SetParallelScale(
    GetFittingScale(box, this->Prop->GetUserMatrix(), this->View, turn) / this->View.Zoom);
  this->Renderer->ResetCameraClippingRange(bounds);
}

double GetFittingScale(
  const double box[6], vtkMatrix4x4* orientation, const ViewSettings& view, vtkTransform* turn)
{
  const double aspect = double(view.Size[0]) / view.Size[1];
  double scale = 0.0;
  for (int edge = 0; edge < 4; ++edge)
  {
    // Half the diagonals of the box; the other four mirror these.
    double diagonal[4] = { 0.5 * (box[1] - box[0]), 0.5 * (box[3] - box[2]),
      0.5 * (box[5] - box[4]), 0.0 };
    diagonal[1] *= edge & 1 ? -1.0 : 1.0;
    diagonal[2] *= edge & 2 ? -1.0 : 1.0;
    orientation->MultiplyPoint(diagonal, diagonal);
    const double* seen = turn->GetLinearInverse()->TransformDoubleVector(diagonal);
    scale = std::max({ scale, std::fabs(seen[2]), std::fabs(seen[0]) / aspect });
  }
  return scale > 0.0 ? 1.1 * scale : 1.0; // a rim for the label
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

vtkSmartPointer<vtkImageData> MIPScene::TakePicture(const std::string& label)
{
  this->SetLabel(label);
  this->Window->Render();
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(this->Window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  grab->Update();
  this->SetLabel("");
  return grab->GetOutput();
}

void MIPScene::SetLabel(const std::string& label)
{
  this->Label->SetInput(label.c_str());
}
