// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projector.h"

#include "ProgressLine.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkTransform.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace
{
/// Find the parallel scale in which the frame fits into all views.
double LargestScale(vtkImageData* frame, const ViewSettings& view, int views)
{
  double scale = 0.0;
  for (int n = 0; n < views; ++n)
  {
    const auto turn = MakeViewTurn(view, view.Azimuth + 360.0 * n / views);
    scale = std::max(scale, GetFittingScale(frame, view, turn));
  }
  return scale / view.Zoom;
}
}

vtkSmartPointer<vtkImageData> MakeFrame(const std::vector<vtkImageData*>& images)
{
  // Equal grids give the grid itself, in spite of rounding.
  constexpr double Tolerance = 1e-3, Most = 1e6; // voxels
  auto frame = vtkSmartPointer<vtkImageData>::New();
  frame->CopyStructure(images.front());
  int extent[6];
  frame->GetExtent(extent);
  for (vtkImageData* const image : images)
  {
    const int* const size = image->GetDimensions();
    for (int corner = 0; corner < 8; ++corner)
    {
      double place[3];
      image->TransformIndexToPhysicalPoint(corner & 1 ? size[0] - 1 : 0,
        corner & 2 ? size[1] - 1 : 0, corner & 4 ? size[2] - 1 : 0, place);
      images.front()->TransformPhysicalPointToContinuousIndex(place, place);
      for (int axis = 0; axis < 3; ++axis)
      {
        if (!(std::fabs(place[axis]) < Most))
        {
          throw std::runtime_error(
            "the volumes are too far apart for one picture; check their positions.");
        }
        int* const range = extent + 2 * axis;
        range[0] = std::min(range[0], static_cast<int>(std::floor(place[axis] + Tolerance)));
        range[1] = std::max(range[1], static_cast<int>(std::ceil(place[axis] - Tolerance)));
      }
    }
  }
  frame->SetExtent(extent);
  return frame;
}

Projector::Projector(const Volume& volume, vtkImageData* frame, const ProjectionSettings& settings,
  const LookSettings& look, const ViewSettings& view, int views)
  : Look(look)
{
  this->Projection->SetInputData(volume.Image);
  std::array<double, 3> center;
  frame->GetCenter(center.data());
  const auto turn = MakeViewTurn(view, view.Azimuth);
  const double* const away = turn->TransformDoubleVector(0.0, 1.0, 0.0);
  const auto fit = FitPerspective(frame, view);
  const double distance = view.Perspective > 0.0 ? fit.Distance : 1.0;
  vtkNew<vtkCamera> camera;
  camera->SetParallelProjection(view.Perspective <= 0.0);
  camera->SetFocalPoint(center.data());
  camera->SetPosition(
    center[0] - distance * away[0], center[1] - distance * away[1], center[2] - distance * away[2]);
  for (int axis = 0; axis < 3; ++axis)
  {
    center[axis] -= settings.SlabOffset * away[axis];
  }
  camera->SetViewUp(turn->TransformDoubleVector(0.0, 0.0, 1.0));
  this->Projection->SetCamera(camera);
  this->Projection->SetRotationAxis(0.0, 0.0, 1.0);
  this->Projection->SetNumberOfViews(views);
  this->Projection->SetOutputSize(view.Size[0], view.Size[1]);
  const double halfHeight =
    view.Perspective > 0.0 ? fit.HalfHeight / view.Zoom : LargestScale(frame, view, views);
  const double spacing = 2.0 * halfHeight / view.Size[1];
  this->Projection->SetOutputSpacing(spacing, spacing);
  this->Projection->SetBackgroundValue(std::numeric_limits<double>::quiet_NaN());
  Apply(settings, center, this->Projection.Get());
}

vtkSmartPointer<vtkImageData> Projector::Project(const std::string& what)
{
  using Clock = std::chrono::steady_clock;
  ProgressLine line(what, this->Projection);
  const auto start = Clock::now();
  this->Projection->Update();
  this->Seconds = std::chrono::duration<double>(Clock::now() - start).count();
  vtkImageData* const found = this->Projection->GetOutput();
  if (found->GetNumberOfPoints() == 0)
  {
    throw std::runtime_error("the volume cannot be projected; see Limits in the documentation.");
  }
  auto bytes = vtkSmartPointer<vtkImageData>::New();
  bytes->CopyStructure(found);
  bytes->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  auto* const to = static_cast<unsigned char*>(bytes->GetScalarPointer());
  vtkDataArray* const scalars = found->GetPointData()->GetScalars();
  const double low = this->Look.Level - 0.5 * this->Look.Window;
  const auto indexOf = [&](double value)
  {
    const double place = 255.0 * (value - low) / this->Look.Window;
    return static_cast<unsigned char>(place > 0.0 ? std::lround(std::min(place, 255.0)) : 0);
  };
  const bool isSigned = this->Projection->GetMaximumType() == vtkSplattingMIPProjection::SIGNED;
  const unsigned char background = isSigned ? indexOf(this->Projection->GetSignedOrigin()) : 0;
  bool isEmpty = true;
  for (vtkIdType p = 0; p < found->GetNumberOfPoints(); ++p)
  {
    const double value = scalars->GetComponent(p, 0);
    to[p] = std::isnan(value) ? background : indexOf(value);
    isEmpty = isEmpty && std::isnan(value);
  }
  if (isEmpty)
  {
    throw std::runtime_error(
      "no part of the volume is in the picture; change --crop, --slab-offset, --mask or --zoom.");
  }
  return bytes;
}
