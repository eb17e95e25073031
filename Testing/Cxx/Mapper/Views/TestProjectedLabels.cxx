// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// LabelMode PROJECTED: the label of each pixel against a walk along its ray, in all modes and
// views, with cuts; and what changes the labels.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
constexpr int Width = 130;
constexpr int Height = 110;
using Color = std::array<double, 3>;

/// Boxes of labels from -1 to 7 without 0, at least three voxels from the border.
vtkSmartPointer<vtkImageData> innerBoxes(vtkImageData* like, reference::Random& random)
{
  auto labels = vtkSmartPointer<vtkImageData>::New();
  labels->SetDimensions(like->GetDimensions());
  labels->AllocateScalars(VTK_SHORT, 1);
  labels->GetPointData()->GetScalars()->Fill(0.0);
  const int* const size = labels->GetDimensions();
  for (int label : { 7, 3, -1, 4 })
  {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a)
    {
      const int edge = random.uniform(9, 15);
      low[a] = random.uniform(3, size[a] - 3 - edge);
      high[a] = low[a] + edge;
    }
    for (int k = low[2]; k < high[2]; ++k)
    {
      for (int j = low[1]; j < high[1]; ++j)
      {
        for (int i = low[0]; i < high[0]; ++i)
        {
          labels->SetScalarComponentFromDouble(i, j, k, 0, label);
        }
      }
    }
  }
  return labels;
}

/// Shows nothing but labels and, if it is visible, a sphere.
struct Scene : stage::Stage
{
  explicit Scene(reference::Random& random) : Stage(::Width, ::Height)
  {
    this->image = stage::toImageData(stage::blobsAndTubes({ 36, 40, 34 }, 14, random));
    coretesting::placeAtRandom(this->image, random, false);
    this->labels = innerBoxes(this->image, random);
    this->mapper = stage::splatting(this->image);
    this->mapper->AutoAdjustSampleDistancesOff();
    this->mapper->SetLabelInput(this->labels);
    this->mapper->SetLabelModeToProjected();
    vtkNew<vtkLookupTable> colors;
    colors->SetTableRange(-1.0, 7.0);
    colors->SetNumberOfTableValues(9);
    for (int n = 0; n < 9; ++n)
    {
      colors->SetTableValue(n, n / 8.0, 0.0, 1.0);
    }
    this->mapper->SetLabelColors(colors);
    this->show(this->mapper);
    vtkNew<vtkPiecewiseFunction> transparent;
    transparent->AddPoint(0.0, 0.0);
    this->property->SetScalarOpacity(transparent);
    vtkNew<vtkPolyDataMapper> poly;
    this->sphere->SetMapper(poly);
    this->renderer->AddActor(this->sphere);
    this->sphere->VisibilityOff();
  }

  vtkSmartPointer<vtkImageData> image, labels;
  vtkSmartPointer<Mapper> mapper;
  vtkNew<vtkActor> sphere;
};

/// A distance in world units, positive where a cut leaves the volume visible, and where a ray has
/// not met the geometry.
using Distance = std::function<double(const double world[3])>;

/**
 * The definition of LabelMode PROJECTED. A pixel shows the ray of the shear image that is nearest
 * to its own ray, at most `reach` voxels away within a slice, in overviews one in its area. So it
 * walks a beam of this half width, slice by slice. A label of the beam may be shown until a slice
 * has labels all over the beam.
 */
class Walk
{
public:
  Walk(Scene& scene, double reach, Distance visible, Distance unmet)
    : Reach(reach),
      Visible(std::move(visible)),
      Unmet(std::move(unmet)),
      Renderer(scene.renderer)
  {
    vtkImageData* const image = scene.image;
    image->GetDimensions(this->Size);
    const int* const extent = image->GetExtent();
    for (int column = 0; column < 4; ++column)
    {
      double index[3], world[3];
      for (int a = 0; a < 3; ++a)
      {
        index[a] = extent[2 * a] + (column == a ? 1.0 : 0.0);
      }
      image->TransformContinuousIndexToPhysicalPoint(index, world);
      for (int a = 0; a < 3; ++a)
      {
        this->ToWorld->SetElement(a, column, world[a]);
      }
    }
    for (int a = 0; a < 9; ++a)
    {
      this->ToWorld->SetElement(a / 3, a % 3,
        this->ToWorld->GetElement(a / 3, a % 3) - this->ToWorld->GetElement(a / 3, 3));
    }
    vtkMatrix4x4::Invert(this->ToWorld, this->ToIndex);
    for (vtkIdType n = 0; n < vtkIdType(this->Size[0]) * this->Size[1] * this->Size[2]; ++n)
    {
      this->Labels.push_back(
        static_cast<int>(scene.labels->GetPointData()->GetScalars()->GetComponent(n, 0)));
    }
  }

  /// The label on the pixel's own ray.
  int own(int x, int y)
  {
    this->aim(x, y);
    const int axis = this->mainAxis();
    constexpr int parts = 32;
    for (int n = 0; n < parts * this->Size[axis]; ++n)
    {
      const double from = (n + 0.5) / parts - 0.5;
      const Vector p = this->at(axis, this->Way[axis] > 0.0 ? from : this->Size[axis] - 1 - from);
      const int label = this->label(
        int(std::floor(p[0] + 0.5)), int(std::floor(p[1] + 0.5)), int(std::floor(p[2] + 0.5)));
      if (label != 0)
      {
        return label;
      }
    }
    return 0;
  }

  /// All labels that the pixel may have.
  std::set<int> possible(int x, int y)
  {
    for (int n = 0; n < 3; ++n)
    {
      this->aim(x + (n == 1), y + (n == 2));
      this->Rays[n] = { this->Start, this->Way };
    }
    this->aim(x, y);
    std::set<int> labels;
    const int main = this->mainAxis();
    for (int axis = 0; axis < 3; ++axis)
    {
      // In perspective views another image may show rays at an angle of about 45 degrees.
      if (std::abs(this->Way[axis]) > 0.9 * std::abs(this->Way[main]))
      {
        this->addLabels(axis, labels);
      }
    }
    return labels;
  }

private:
  using Vector = std::array<double, 3>;

  void aim(double x, double y)
  {
    Vector ends[2];
    for (int n = 0; n < 2; ++n)
    {
      double world[4];
      this->Renderer->SetDisplayPoint(x + 0.5, y + 0.5, n);
      this->Renderer->DisplayToWorld();
      this->Renderer->GetWorldPoint(world);
      for (double& number : world)
      {
        number /= world[3];
      }
      world[3] = 1.0;
      this->ToIndex->MultiplyPoint(world, world);
      std::copy_n(world, 3, ends[n].begin());
    }
    this->Start = ends[0];
    for (int a = 0; a < 3; ++a)
    {
      this->Way[a] = ends[1][a] - ends[0][a];
    }
  }

  int mainAxis() const
  {
    int axis = 0;
    for (int a = 1; a < 3; ++a)
    {
      axis = std::abs(this->Way[a]) > std::abs(this->Way[axis]) ? a : axis;
    }
    return axis;
  }

  Vector at(int axis, double depth) const { return at({ this->Start, this->Way }, axis, depth); }

  struct Ray
  {
    Vector start, way;
  };
  static Vector at(const Ray& ray, int axis, double depth)
  {
    const double t = (depth - ray.start[axis]) / ray.way[axis];
    Vector p;
    for (int a = 0; a < 3; ++a)
    {
      p[a] = ray.start[a] + t * ray.way[a];
    }
    return p;
  }

  int label(int i, int j, int k) const
  {
    return i < 0 || j < 0 || k < 0 || i >= this->Size[0] || j >= this->Size[1] || k >= this->Size[2]
      ? 0
      : this->Labels[(std::size_t(k) * this->Size[1] + j) * this->Size[0] + i];
  }

  void addLabels(int axis, std::set<int>& labels)
  {
    constexpr int margin = 60; // of geometry in front of the volume
    bool mayBeHidden = false;
    for (int n = -margin; n < this->Size[axis]; ++n)
    {
      const int k = this->Way[axis] > 0.0 ? n : this->Size[axis] - 1 - n;
      if ((k - this->Start[axis]) / this->Way[axis] < 0.0)
      {
        continue; // behind the viewer
      }
      const Vector middle = this->at(axis, k), front = this->at(axis, k - 0.5),
                   back = this->at(axis, k + 0.5);
      // In overviews a pixel shows its area.
      Vector across = this->at(this->Rays[1], axis, k), up = this->at(this->Rays[2], axis, k);
      for (int a = 0; a < 3; ++a)
      {
        across[a] -= middle[a];
        up[a] -= middle[a];
      }
      double world[4] = { middle[0], middle[1], middle[2], 1.0 }, radius = 0.05; // of the polygons
      this->ToWorld->MultiplyPoint(world, world);
      int low[3], high[3];
      for (int a = 0; a < 3; ++a)
      {
        const double reach =
          a == axis ? 0.0 : this->Reach + 0.5 * std::abs(across[a]) + 0.5 * std::abs(up[a]) + 1e-6;
        low[a] = a == axis ? k : int(std::floor(std::min(front[a], back[a]) - reach + 0.5));
        high[a] = a == axis ? k : int(std::floor(std::max(front[a], back[a]) + reach + 0.5));
        // Cuts remove whole slices, so they may be moved by a slice.
        const double half = a == axis ? 1.0 : std::abs(back[a] - front[a]) + reach;
        double squares = 0.0;
        for (int r = 0; r < 3; ++r)
        {
          squares += std::pow(half * this->ToWorld->GetElement(r, a), 2);
        }
        radius += std::sqrt(squares);
      }
      const double unmet = this->Unmet ? this->Unmet(world) : 1e9;
      const double visible = this->Visible ? this->Visible(world) : 1e9;
      if (unmet < -radius)
      {
        break;
      }
      mayBeHidden = mayBeHidden || unmet < radius;
      bool covers = visible > radius && !mayBeHidden;
      for (int i = low[0]; i <= high[0] && visible > -radius; ++i)
      {
        for (int j = low[1]; j <= high[1]; ++j)
        {
          for (int slice = low[2]; slice <= high[2]; ++slice)
          {
            const int found = this->label(i, j, slice);
            covers = covers && found != 0;
            if (found != 0)
            {
              labels.insert(found);
            }
          }
        }
      }
      if (covers)
      {
        return;
      }
    }
    labels.insert(0);
  }

  double Reach;
  Distance Visible, Unmet;
  vtkRenderer* Renderer;
  int Size[3];
  std::vector<int> Labels;
  vtkNew<vtkMatrix4x4> ToWorld, ToIndex;
  Vector Start{}, Way{};
  std::array<Ray, 3> Rays{}; // of the pixel and its neighbours, right and above
};

/**
 * The label of each pixel of a picture that shows only edges. Within the edges of a label it has
 * the same pixels for this label and for 0: then it is the one that more pixels may have.
 */
std::vector<int> labelsOfEdges(
  const stage::Pixels& pixels, const std::vector<std::set<int>>& possible)
{
  constexpr int unknown = 99;
  std::vector<int> labels(std::size_t(Width) * Height, unknown);
  for (std::size_t n = 0; n < labels.size(); ++n)
  {
    if (pixels[3 * n + 1] == 0 && pixels[3 * n + 2] == 255)
    {
      labels[n] = int(std::lround(pixels[3 * n] * 8 / 255.0)) - 1;
    }
  }
  for (std::size_t seed = 0; seed < labels.size(); ++seed)
  {
    if (labels[seed] != unknown)
    {
      continue;
    }
    std::set<int> around;
    std::vector<std::size_t> area{ seed };
    labels[seed] = 0;
    for (std::size_t n = 0; n < area.size(); ++n)
    {
      const int x = int(area[n] % Width), y = int(area[n] / Width);
      const int near[4][2] = { { x - 1, y }, { x + 1, y }, { x, y - 1 }, { x, y + 1 } };
      for (const auto& p : near)
      {
        if (p[0] < 0 || p[1] < 0 || p[0] >= Width || p[1] >= Height)
        {
          around.insert(0);
          continue;
        }
        const std::size_t next = std::size_t(p[1]) * Width + p[0];
        if (labels[next] == unknown)
        {
          labels[next] = 0;
          area.push_back(next);
        }
        else if (labels[next] != 0)
        {
          around.insert(labels[next]);
        }
      }
    }
    const int label = around.size() == 1 ? *around.begin() : 0;
    const auto mayHave = [&](int some)
    {
      return std::count_if(
        area.begin(), area.end(), [&](std::size_t n) { return possible[n].count(some) != 0; });
    };
    if (mayHave(label) > mayHave(0))
    {
      for (std::size_t n : area)
      {
        labels[n] = label;
      }
    }
  }
  return labels;
}

/// Compares each pixel with the definition. Returns the share of pixels that have the label on
/// their own ray.
double compareProjected(Scene& scene, Walk walk, const std::string& what, reference::Checks& check)
{
  std::vector<std::set<int>> possible;
  for (int n = 0; n < Width * Height; ++n)
  {
    possible.push_back(walk.possible(n % Width, n / Width));
  }
  const std::vector<int> shown = labelsOfEdges(scene.pixels(), possible);
  int wrong = 0, same = 0;
  for (int n = 0; n < Width * Height; ++n)
  {
    wrong += possible[n].count(shown[n]) == 0;
    same += shown[n] == walk.own(n % Width, n / Width);
  }
  check(wrong == 0, what, ": ", wrong, " pixels have a wrong label.");
  return double(same) / (Width * Height);
}

/// The same with cuts. Pixels next to the end of a ray may have the ray of a neighbour.
void testCuts(Scene& scene, reference::Checks& check, reference::Random& random)
{
  constexpr double radius = 11.0, thickness = 8.0;
  constexpr int margin = 9; // cropped voxels
  vtkImageData* const image = scene.image;
  Color middle;
  std::copy_n(image->GetCenter(), 3, middle.begin());
  vtkNew<vtkSphereSource> source;
  source->SetCenter(middle.data());
  source->SetRadius(radius);
  source->SetPhiResolution(60);
  source->SetThetaResolution(60);
  source->Update();
  scene.sphere->GetMapper()->SetInputConnection(source->GetOutputPort());
  const auto outsideSphere = [=](const double p[3])
  { return std::sqrt(vtkMath::Distance2BetweenPoints(p, middle.data())) - radius; };
  const auto abovePlane = [=](const Color& normal, const double p[3])
  {
    const double way[3] = { p[0] - middle[0], p[1] - middle[1], p[2] - middle[2] };
    return vtkMath::Dot(way, normal.data());
  };
  double planes[6];
  for (int a = 0; a < 6; ++a)
  {
    const int index = image->GetExtent()[a] + (a % 2 == 0 ? margin : -margin);
    planes[a] = image->GetOrigin()[a / 2] + index * image->GetSpacing()[a / 2];
  }
  scene.mapper->SetCroppingRegionPlanes(planes);
  scene.mapper->SetCroppingRegionFlagsToSubVolume();
  scene.mapper->SetSlabCenter(middle.data());
  scene.mapper->SetSlabThickness(thickness);
  enum Cut
  {
    Plane,
    Slab,
    Crop,
    Surface,
    Geometry,
    Count
  };
  for (int view = 0; view < 2 * Count; ++view)
  {
    const int cut = view % Count;
    scene.mapper->SetQualityMode(random.uniform(0, 3));
    scene.viewAngle = view / Count * 30.0;
    const auto direction = stage::anyDirection(random);
    scene.look(direction, { direction[1], direction[2], -direction[0] }, 0.5);
    scene.pixels(); // with the cut before, in the same view
    Color normal = stage::anyDirection(random), across;
    scene.renderer->GetActiveCamera()->GetDirectionOfProjection(across.data());
    vtkNew<vtkPlane> plane;
    plane->SetNormal(normal.data());
    plane->SetOrigin(middle.data());
    scene.mapper->RemoveAllClippingPlanes();
    if (cut == Plane)
    {
      scene.mapper->AddClippingPlane(plane);
    }
    scene.mapper->SetSlab(cut == Slab);
    scene.mapper->SetCropping(cut == Crop);
    scene.mapper->SetBoundingSurface(cut == Surface ? source->GetOutput() : nullptr);
    scene.sphere->SetVisibility(cut == Geometry);
    const Distance visible[Count] = { [=](const double p[3]) { return abovePlane(normal, p); },
      [=](const double p[3]) { return 0.5 * thickness - std::abs(abovePlane(across, p)); },
      [=](const double p[3])
      {
        double index[3], least = 1e9;
        image->TransformPhysicalPointToContinuousIndex(p, index);
        for (int a = 0; a < 6; ++a)
        {
          const double along =
            image->GetOrigin()[a / 2] + index[a / 2] * image->GetSpacing()[a / 2];
          least = std::min(least, a % 2 == 0 ? along - planes[a] : planes[a] - along);
        }
        return least;
      },
      [=](const double p[3]) { return -outsideSphere(p); }, {} };
    const Distance unmet = cut == Geometry ? Distance(outsideSphere) : Distance();
    compareProjected(scene, Walk(scene, 1.0, visible[cut], unmet),
      "cut " + std::to_string(cut) + ", view " + std::to_string(view), check);
  }
}

void testUncut(reference::Checks& check, reference::Random& random)
{
  Scene scene(random);
  const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
  constexpr int views = 8;
  double share = 0.0;
  for (int view = 0; view <= views; ++view)
  {
    scene.mapper->SetQualityMode(view % 4);
    scene.mapper->SetBlendMode(random.uniform(1, 3)); // maximum, minimum, average
    scene.mapper->SetMaximumType(random.uniform(0, 4));
    scene.viewAngle = view % 2 * 40.0;
    const auto direction = stage::anyDirection(random);
    const double scale = view < views ? 0.3 + 0.02 * view : 3.0; // the last is an overview
    scene.look(direction, { direction[1], direction[2], -direction[0] }, scale);
    const double same =
      compareProjected(scene, Walk(scene, 0.5, {}, {}), "view " + std::to_string(view), check);
    share += view < views ? same / views : 0.0;
  }
  check(share > 0.95, "Only ", share, " of the pixels show their own ray.");
  check(warnings.texts.empty(), "There is a warning.");
  // In the same view: the other side, other labels, none.
  scene.viewAngle = 0.0;
  const auto direction = stage::anyDirection(random);
  scene.look(direction, { direction[1], direction[2], -direction[0] }, 0.4);
  scene.pixels();
  scene.look({ -direction[0], -direction[1], -direction[2] },
    { direction[1], direction[2], -direction[0] }, 0.4);
  compareProjected(scene, Walk(scene, 0.5, {}, {}), "other side", check);
  scene.labels->DeepCopy(innerBoxes(scene.image, random));
  compareProjected(scene, Walk(scene, 0.5, {}, {}), "other labels", check);
  scene.labels = innerBoxes(scene.image, random);
  scene.mapper->SetLabelInput(scene.labels);
  compareProjected(scene, Walk(scene, 0.5, {}, {}), "other input", check);
  const stage::Pixels shown = scene.pixels();
  const vtkIdType memory = scene.mapper->GetIndexMemorySize();
  scene.mapper->SetLabelInput(nullptr);
  check(scene.pixels() != shown, "Labels are shown.");
  check(memory - scene.mapper->GetIndexMemorySize() >= scene.labels->GetNumberOfPoints(),
    "The copy of the labels is not counted, or is kept without labels.");
  scene.mapper->SetLabelInput(scene.labels);
  testCuts(scene, check, random);
}
}

//------------------------------------------------------------------------------
int TestProjectedLabels(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  reference::forScenes(
    "projected labels", 3, [&](int, reference::Random& random) { testUncut(check, random); });
  return check.exitCode();
}
