// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a random walk changes besides the mapper's own settings: data, views, windows, colours, and
 * what else is in the scene. A mapper that has seen all of the walk and a fresh one are shown in
 * it.
 */
#ifndef WalkWorld_h
#define WalkWorld_h

#include "Stage.h"
#include "WalkInputs.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkLookupTable.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolumeProperty.h"

#include <array>
#include <cmath>
#include <string>

namespace walktesting
{
class World
{
public:
  /// The filter takes images, and learns from the pipeline what has changed.
  World(std::array<stage::Stage, 2>& stages, bool forFilter, reference::Random& random)
    : Stages(stages),
      ForFilter(forFilter)
  {
    this->depthColors->SetHueRange(0.3, 0.6);
    this->depthColors->Build();
    this->OpaqueMapper->SetInputConnection(this->Ball->GetOutputPort());
    this->Opaque->SetMapper(this->OpaqueMapper);
    this->Opaque->SetVisibility(false);
    this->Opaque->GetProperty()->SetColor(0.2, 0.9, 0.4);
    for (stage::Stage& stage : this->Stages)
    {
      stage.renderer->SetActiveCamera(this->camera);
      stage.renderer->AddActor(this->Opaque);
      stage.renderer->SetViewport(0.0, 0.0, 1.0, 1.0);
      stage.window->SetSize(40, 30);
    }
    this->property->SetInterpolationTypeToLinear();
    for (int c = 0; c < 4; ++c)
    {
      this->changeColors(c, random);
    }
    this->changeInput(random);
  }
  ~World()
  {
    for (stage::Stage& stage : this->Stages)
    {
      stage.renderer->RemoveActor(this->Opaque);
    }
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Input input;
  vtkNew<vtkVolumeProperty> property;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkPolyData> surface;
  std::array<vtkNew<vtkPlane>, 3> planes;
  vtkNew<vtkLookupTable> depthColors;

  /// Whether the first component cannot be seen.
  bool isTransparent() const
  {
    vtkPiecewiseFunction* const opacity = this->property->GetScalarOpacity(0);
    double node[4] = {};
    for (int n = 0; n < opacity->GetSize() && node[1] == 0.0; ++n)
    {
      opacity->GetNodeValue(n, node);
    }
    return node[1] == 0.0;
  }
  stage::Stage& shown() { return this->Stages[this->Window]; }

  /// A point in the data set's bounds or a little outside, or the length of their diagonal.
  std::array<double, 3> anyPlace(reference::Random& random) const
  {
    double bounds[6];
    this->input.data->GetBounds(bounds);
    std::array<double, 3> place;
    for (int a = 0; a < 3; ++a)
    {
      const double share = random.uniform(-0.1, 1.1);
      place[a] = bounds[2 * a] + share * (bounds[2 * a + 1] - bounds[2 * a]);
    }
    return place;
  }
  double diagonal() const { return std::max(this->input.data->GetLength(), 1.0); }

  /// Another data set, planes and a surface about it, and a view of it.
  void changeInput(reference::Random& random)
  {
    this->input = anyInput(!this->ForFilter, random);
    this->changeSurface(random);
    for (vtkPlane* plane : this->planes)
    {
      this->changePlane(plane, random);
    }
    this->look(random);
  }

  /// One of all other changes. Returns what was done.
  std::string change(reference::Random& random)
  {
    switch (random.uniform(0, 11))
    {
      case 0:
      case 1:
      case 2:
        return this->changeView(random);
      case 3:
        this->look(random);
        return "another view";
      case 4:
      case 5:
        return changeInPlace(this->input, !this->ForFilter && random.oneIn(2), random);
      case 6:
        this->changePlane(this->planes[random.uniform(0, 2)], random);
        return "a plane";
      case 7:
        this->changeSurface(random);
        return "the surface";
      case 8:
        return this->changeWindow(random);
      case 9:
        return this->changeGeometry(random);
      default:
        return this->changeProperty(random);
    }
  }

private:
  void changeSurface(reference::Random& random)
  {
    vtkNew<vtkSphereSource> source;
    const auto place = this->anyPlace(random);
    source->SetCenter(place.data());
    source->SetRadius(this->diagonal() * random.uniform(0.2, 0.6));
    source->Update();
    this->surface->ShallowCopy(source->GetOutput());
  }

  void changePlane(vtkPlane* plane, reference::Random& random)
  {
    const auto place = this->anyPlace(random), normal = anyPoint(random, -1.0, 1.0);
    plane->SetOrigin(place.data());
    plane->SetNormal(0.0, 0.0, 1.0);
    if (!random.oneIn(3))
    {
      plane->SetNormal(normal[0], normal[1], normal[2]);
    }
    double middle[3];
    this->input.data->GetCenter(middle);
    if (plane->EvaluateFunction(middle) < 0.0 && !random.oneIn(4))
    {
      plane->Push(2.0 * plane->EvaluateFunction(middle)); // leaves the middle
    }
  }

  std::string changeGeometry(reference::Random& random)
  {
    const auto place = this->anyPlace(random);
    this->Ball->SetCenter(place.data());
    this->Ball->SetRadius(this->diagonal() * random.uniform(0.05, 0.4));
    this->Opaque->SetVisibility(random.uniform(0, 1));
    return "the ball";
  }

  /// Along an axis, a diagonal, or anywhere.
  static stage::Vector anyDirection(reference::Random& random)
  {
    stage::Vector direction{};
    for (double& x : direction)
    {
      x = random.uniform(-1, 1);
    }
    const bool isZero = direction == stage::Vector{};
    const bool isSpecial = random.oneIn(3);
    const auto other = anyPoint(random, -1.0, 1.0);
    return isZero || !isSpecial ? other : direction;
  }

  void look(reference::Random& random)
  {
    const stage::Vector direction = anyDirection(random);
    const auto place = this->anyPlace(random);
    const bool isFar = random.oneIn(8);
    const double distance = this->diagonal() *
      (isFar                ? std::pow(10.0, random.uniform(5.0, 11.0))
          : random.oneIn(6) ? random.uniform(0.0, 0.3)
                            : random.uniform(0.8, 3.0));
    const double norm = vtkMath::Norm(direction.data());
    double middle[3];
    this->input.data->GetCenter(middle);
    const bool isOff = random.oneIn(4);
    stage::Vector focus, position;
    for (int a = 0; a < 3; ++a)
    {
      focus[a] = isOff ? place[a] : middle[a];
      position[a] = focus[a] - std::max(distance, 0.01) * direction[a] / norm;
    }
    this->camera->SetParallelProjection(random.uniform(0, 1));
    this->camera->SetFocalPoint(focus.data());
    this->camera->SetPosition(position.data());
    const auto up = anyPoint(random, 0.1, 1.0);
    this->camera->SetViewUp(up.data());
    const double share = random.uniform(0.5, 2.0); // of the window that the volume fills, from afar
    this->camera->SetViewAngle(isFar
        ? vtkMath::DegreesFromRadians(this->diagonal() / share / distance)
        : random.oneIn(4) ? random.uniform(2.0, 120.0)
                          : 30.0);
    this->camera->SetParallelScale(this->diagonal() * random.uniform(0.2, 0.7));
    this->camera->SetWindowCenter(0.0, 0.0);
    this->setRange(random);
  }

  /// The clipping range as VTK finds it, sometimes less. Not by vtkRenderer, which would look at
  /// what is visible.
  void setRange(reference::Random& random)
  {
    double middle[3], position[3], direction[3];
    this->input.data->GetCenter(middle);
    this->camera->GetPosition(position);
    this->camera->GetDirectionOfProjection(direction);
    double depth = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      depth += (middle[a] - position[a]) * direction[a];
    }
    const double reach = this->diagonal() * (random.oneIn(5) ? random.uniform(0.1, 0.5) : 3.0);
    const double far = std::max(depth + reach, 0.02 * this->diagonal());
    this->camera->SetClippingRange(std::max(depth - reach, 0.001 * far), far);
  }

  std::string changeView(reference::Random& random)
  {
    const double angle = random.oneIn(2) ? 180.0 : random.uniform(-40.0, 40.0);
    const double factor = random.uniform(0.6, 1.6), x = random.uniform(-0.4, 0.4),
                 y = random.uniform(-0.4, 0.4);
    switch (random.uniform(0, 6))
    {
      case 0:
        this->camera->Azimuth(angle);
        this->setRange(random);
        return "azimuth";
      case 1:
        this->camera->Roll(angle);
        return "roll";
      case 2:
        this->camera->Zoom(factor);
        return "zoom";
      case 3:
        this->camera->SetWindowCenter(x, y);
        return "pan";
      case 4:
        this->camera->Yaw(0.3 * angle);
        this->setRange(random);
        return "yaw";
      case 5:
        this->camera->Dolly(factor);
        this->setRange(random);
        return "dolly";
      default:
        this->setRange(random);
        return "clipping range";
    }
  }

  std::string changeWindow(reference::Random& random)
  {
    if (random.oneIn(3))
    {
      this->Window = 1 - this->Window;
      return "the window";
    }
    if (random.oneIn(2))
    {
      const double x = random.uniform(0.0, 0.4), y = random.uniform(0.0, 0.4);
      const bool isPart = random.uniform(0, 1);
      this->shown().renderer->SetViewport(isPart ? x : 0.0, isPart ? y : 0.0, 1.0, 1.0);
      return "the viewport";
    }
    const int width = random.uniform(5, 60), height = random.uniform(5, 60);
    this->shown().window->SetSize(width, height);
    return "the window's size";
  }

  void changeColors(int component, reference::Random& random)
  {
    const double black = random.uniform(-20.0, 40.0), white = black + random.uniform(1.0, 120.0);
    vtkNew<vtkPiecewiseFunction> gray;
    vtkNew<vtkColorTransferFunction> color;
    gray->AddPoint(black, 0.0);
    gray->AddPoint(white, 1.0);
    const auto low = anyPoint(random, 0.0, 0.5), high = anyPoint(random, 0.5, 1.0);
    color->AddRGBPoint(black, low[0], low[1], low[2]);
    color->AddRGBPoint(white, high[0], high[1], high[2]);
    random.oneIn(4) ? this->property->SetColor(component, gray)
                    : this->property->SetColor(component, color);
    vtkNew<vtkPiecewiseFunction> opacity;
    const bool isTransparent = random.oneIn(20), isRamp = random.oneIn(2);
    opacity->AddPoint(black, isTransparent || isRamp ? 0.0 : 1.0);
    opacity->AddPoint(white, isTransparent ? 0.0 : 1.0);
    this->property->SetScalarOpacity(component, opacity);
  }

  std::string changeProperty(reference::Random& random)
  {
    const int component = random.uniform(0, 3);
    switch (random.uniform(0, 3))
    {
      case 0:
        this->changeColors(component, random);
        return "colours";
      case 1:
        this->property->SetComponentWeight(component, random.uniform(0.1, 1.0));
        return "a weight";
      case 2:
        this->property->SetIndependentComponents(random.uniform(0, 2) > 0);
        return "dependence";
      default:
      {
        const double value = random.uniform(0.0, 100.0), opacity = random.uniform(0.0, 1.0);
        this->property->GetScalarOpacity(component)->AddPoint(value, opacity); // in place
        return "an opacity";
      }
    }
  }

  std::array<stage::Stage, 2>& Stages;
  bool ForFilter;
  int Window = 0;
  vtkNew<vtkSphereSource> Ball;
  vtkNew<vtkPolyDataMapper> OpaqueMapper;
  vtkNew<vtkActor> Opaque;
};
}

#endif
