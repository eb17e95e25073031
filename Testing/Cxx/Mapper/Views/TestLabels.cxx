// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Edges of labels: each pixel of the picture against the definition, by the voxels of
// GetLocations(), in all modes and views, with geometry and cuts; and labels that do not fit.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkHardwareSelector.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
constexpr int Width = 130;
constexpr int Height = 110;
using Color = std::array<double, 3>;

/// Boxes of labels from -1 to 7, among them 0.
vtkSmartPointer<vtkImageData> boxes(vtkImageData* like, int type, reference::Random& random)
{
  auto labels = vtkSmartPointer<vtkImageData>::New();
  labels->SetDimensions(like->GetDimensions());
  labels->AllocateScalars(type, 1);
  const int* const size = labels->GetDimensions();
  labels->GetPointData()->GetScalars()->Fill(0.0);
  for (int box = 0; box < 9; ++box)
  {
    int low[3];
    for (int a = 0; a < 3; ++a)
    {
      low[a] = random.uniform(0, size[a] - 16);
    }
    for (int n = 0; n < 15 * 15 * 15; ++n)
    {
      labels->SetScalarComponentFromDouble(
        low[0] + n % 15, low[1] + n / 15 % 15, low[2] + n / 225, 0, box - 1);
    }
  }
  return labels;
}

struct Scene : stage::Stage
{
  explicit Scene(reference::Random& random) : Stage(::Width, ::Height)
  {
    this->image = stage::toImageData(stage::blobsAndTubes({ 36, 40, 34 }, 14, random));
    stage::placeAtRandom(this->image, random);
    const int types[] = { VTK_SHORT, VTK_INT, VTK_SIGNED_CHAR, VTK_LONG_LONG };
    this->labels = boxes(this->image, types[random.uniform(0, 3)], random);
    this->mapper = stage::splatting(this->image);
    this->mapper->RecordLocationsOn();
    this->mapper->AutoAdjustSampleDistancesOff();
    this->show(this->mapper);
    this->renderer->SetBackground(0.3, 0.5, 0.2);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.0, 0.0);
    opacity->AddPoint(255.0, 0.9);
    this->property->SetScalarOpacity(opacity);
    vtkNew<vtkSphereSource> source;
    source->SetCenter(this->image->GetCenter());
    source->SetRadius(11.0);
    vtkNew<vtkPolyDataMapper> poly;
    poly->SetInputConnection(source->GetOutputPort());
    this->sphere->SetMapper(poly);
    this->renderer->AddActor(this->sphere);
    this->sphere->VisibilityOff();
  }

  /// The label at each pixel, row by row from the bottom.
  std::vector<int> shownLabels()
  {
    vtkDataArray* const voxels = this->mapper->GetLocations()->GetPointData()->GetArray("Voxel");
    std::vector<int> result(std::size_t(::Width) * ::Height, 0);
    for (std::size_t n = 0; n < result.size(); ++n)
    {
      const double* const p = voxels->GetTuple(static_cast<vtkIdType>(n));
      if (p[0] >= 0.0)
      {
        result[n] = static_cast<int>(
          this->labels->GetScalarComponentAsDouble(int(p[0]), int(p[1]), int(p[2]), 0));
      }
    }
    return result;
  }

  vtkSmartPointer<vtkImageData> image, labels;
  vtkSmartPointer<Mapper> mapper;
  vtkNew<vtkActor> sphere;
};

bool isEdge(const std::vector<int>& labels, int x, int y)
{
  const auto at = [&](int column, int row)
  {
    return column < 0 || row < 0 || column >= Width || row >= Height
      ? 0
      : labels[std::size_t(row) * Width + column];
  };
  const int label = at(x, y);
  return label != 0 &&
    (at(x - 1, y) != label || at(x + 1, y) != label || at(x, y - 1) != label ||
      at(x, y + 1) != label);
}

/// Compares each pixel with the definition. Returns the number of edge pixels.
template <class ColorOf>
int compare(Scene& scene, const std::string& what, ColorOf&& colorOf, stage::Checks& check)
{
  scene.mapper->SetLabelInput(nullptr);
  const stage::Pixels plain = scene.pixels();
  const std::vector<int> labels = scene.shownLabels();
  scene.mapper->SetLabelInput(scene.labels);
  const stage::Pixels pixels = scene.pixels();
  int wrong = 0, edges = 0;
  for (int n = 0; n < Width * Height; ++n)
  {
    const bool edge = isEdge(labels, n % Width, n / Width);
    const Color color = edge ? colorOf(labels[n]) : Color{};
    edges += edge;
    for (int c = 0; c < 3; ++c)
    {
      const int expected = edge ? int(std::lround(255.0 * color[c])) : plain[3 * n + c];
      wrong += pixels[3 * n + c] != expected;
    }
  }
  check(wrong == 0, what + ": " + std::to_string(wrong) + " bytes differ.");
  return edges;
}

void testEdges(stage::Checks& check, reference::Random& random)
{
  Scene scene(random);
  vtkNew<vtkColorTransferFunction> function;
  function->AddRGBPoint(-1.0, 0.1, 0.9, 0.3);
  function->AddRGBPoint(7.0, 0.8, 0.2, 1.0);
  vtkNew<vtkLookupTable> table;
  table->SetTableRange(-1.0, 7.0);
  table->SetNumberOfTableValues(9);
  for (int n = 0; n < 9; ++n)
  {
    table->SetTableValue(n, random.uniform(0, 1), n / 8.0, random.uniform(0, 1));
  }
  const auto ofFunction = [&](int label)
  {
    Color color;
    function->GetColor(label, color.data());
    return color;
  };
  const auto ofTable = [&](int label)
  {
    Color color;
    std::copy_n(table->GetTableValue(label + 1), 3, color.begin());
    return color;
  };
  const auto byDefault = [](int label)
  {
    static const Color colors[] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0.4, 1 }, { 1, 1, 0 },
      { 1, 0, 1 }, { 0, 1, 1 } };
    return colors[(std::abs(label) - 1) % 6];
  };
  int edges = 0;
  for (int mode = Mapper::PREVIEW; mode <= Mapper::EXACT; ++mode)
  {
    scene.mapper->SetQualityMode(mode);
    for (double scale : { 0.15, 0.5, 0.9, 3.0 }) // the last is an overview
    {
      const std::string what = "mode " + std::to_string(mode) + ", scale " + std::to_string(scale);
      scene.viewAngle = random.uniform(0, 1) * 40.0;
      const auto direction = stage::anyDirection(random);
      scene.look(direction, { direction[1], direction[2], -direction[0] }, scale);
      scene.sphere->SetVisibility(random.uniform(0, 1));
      scene.mapper->SetBlendMode(random.uniform(1, 2));
      stage::chooseSamples(scene.mapper, scene.image, random);
      scene.mapper->SetLabelColors(function);
      edges += compare(scene, what + ", function", ofFunction, check);
      scene.mapper->SetLabelColors(table);
      compare(scene, what + ", table", ofTable, check);
      scene.mapper->SetLabelColors(nullptr);
      compare(scene, what + ", default", byDefault, check);
    }
  }
  check(edges > 500, "There are only " + std::to_string(edges) + " pixels of edges.");
  // Locations are found without RecordLocations, and labels that change are shown.
  const stage::Pixels before = scene.pixels();
  scene.mapper->RecordLocationsOff();
  check(scene.pixels() == before, "Labels without RecordLocations.");
  scene.labels->GetPointData()->GetScalars()->Fill(0.0);
  scene.labels->Modified();
  const stage::Pixels after = scene.pixels();
  scene.mapper->SetLabelInput(nullptr);
  check(scene.pixels() == after, "Labels of 0 have no edges.");
}

/// Boxes of labels from -1 to 7 without 0, at least three voxels from the border.
vtkSmartPointer<vtkImageData> innerBoxes(vtkImageData* like, reference::Random& random)
{
  auto labels = vtkSmartPointer<vtkImageData>::New();
  labels->SetDimensions(like->GetDimensions());
  labels->AllocateScalars(VTK_SHORT, 1);
  labels->GetPointData()->GetScalars()->Fill(0.0);
  const int* const size = labels->GetDimensions();
  for (int label : { 7, 3, -1, 4, 1, 6, 2 })
  {
    int low[3], high[3];
    for (int a = 0; a < 3; ++a)
    {
      const int edge = random.uniform(8, 14);
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

/// A distance in world units, positive where a cut leaves the volume visible, and where a ray has
/// not met the geometry.
using Distance = std::function<double(const double world[3])>;

/**
 * The definition of LabelMode PROJECTED. A pixel shows the ray of the shear image that is nearest
 * to its own ray, at most `reach` voxels away within a slice. So it walks a beam of this half
 * width, slice by slice. A label of the beam may be shown until a slice has labels all over the
 * beam.
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

  void aim(int x, int y)
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

  Vector at(int axis, double depth) const
  {
    const double t = (depth - this->Start[axis]) / this->Way[axis];
    Vector p;
    for (int a = 0; a < 3; ++a)
    {
      p[a] = this->Start[a] + t * this->Way[a];
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
      double world[4] = { middle[0], middle[1], middle[2], 1.0 }, radius = 0.0;
      this->ToWorld->MultiplyPoint(world, world);
      int low[3], high[3];
      for (int a = 0; a < 3; ++a)
      {
        const double reach = a == axis ? 0.0 : this->Reach + 1e-6;
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
};

/**
 * The label of each pixel of a picture that shows only edges. Within the edges of a label a picture
 * shows either this label or 0, with the same pixels; then it is what most of `guess` is.
 */
std::vector<int> labelsOfEdges(const stage::Pixels& pixels, const std::vector<int>& guess)
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
    const auto agrees = [&](std::size_t n) { return guess[n] == label; };
    if (label != 0 && 2 * std::count_if(area.begin(), area.end(), agrees) > int(area.size()))
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
double compareProjected(Scene& scene, Walk walk, const std::string& what, stage::Checks& check)
{
  std::vector<int> own;
  for (int n = 0; n < Width * Height; ++n)
  {
    own.push_back(walk.own(n % Width, n / Width));
  }
  const std::vector<int> shown = labelsOfEdges(scene.pixels(), own);
  int wrong = 0, same = 0;
  for (int n = 0; n < Width * Height; ++n)
  {
    wrong += walk.possible(n % Width, n / Width).count(shown[n]) == 0;
    same += shown[n] == own[n];
  }
  check(wrong == 0, what + ": " + std::to_string(wrong) + " pixels have a wrong label.");
  return double(same) / (Width * Height);
}

void testProjected(stage::Checks& check, reference::Random& random)
{
  Scene scene(random);
  scene.labels = innerBoxes(scene.image, random);
  vtkNew<vtkPiecewiseFunction> transparent;
  transparent->AddPoint(0.0, 0.0);
  scene.property->SetScalarOpacity(transparent);
  vtkNew<vtkLookupTable> table;
  table->SetTableRange(-1.0, 7.0);
  table->SetNumberOfTableValues(9);
  for (int n = 0; n < 9; ++n)
  {
    table->SetTableValue(n, n / 8.0, 0.0, 1.0);
  }
  scene.mapper->SetLabelColors(table);
  scene.mapper->SetLabelInput(scene.labels);
  scene.mapper->SetLabelModeToProjected();
  scene.mapper->RecordLocationsOff();
  for (int view = 0; view < 8; ++view)
  {
    scene.mapper->SetQualityMode(view % 4);
    scene.mapper->SetBlendMode(random.uniform(1, 3)); // maximum, minimum, average
    scene.mapper->SetMaximumType(random.uniform(0, 4));
    scene.viewAngle = view % 2 * 40.0;
    const auto direction = stage::anyDirection(random);
    scene.look(direction, { direction[1], direction[2], -direction[0] }, 0.3 + 0.1 * view);
    const std::string what = "projected, view " + std::to_string(view);
    const double share = compareProjected(scene, Walk(scene, 0.5, {}, {}), what, check);
    check(share > 0.95, what + ": only " + std::to_string(share) + " of the pixels.");
  }
}

/// What a selector finds at each pixel.
std::vector<vtkProp*> found(Scene& scene)
{
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.renderer);
  selector->SetArea(0, 0, Width - 1, Height - 1);
  std::vector<vtkProp*> props;
  if (selector->CaptureBuffers())
  {
    for (unsigned int n = 0; n < Width * Height; ++n)
    {
      const unsigned int place[2] = { n % Width, n / Width };
      props.push_back(selector->GetPixelInformation(place).Prop);
    }
  }
  return props;
}

void testRest(stage::Checks& check, reference::Random& random)
{
  Scene scene(random);
  scene.look(stage::anyDirection(random), { 0.1, 0.2, 0.9 }, 0.8);
  const stage::Pixels plain = scene.pixels();
  const std::vector<vtkProp*> props = found(scene);
  scene.mapper->SetLabelInput(scene.labels);
  const stage::Pixels labelled = scene.pixels();
  check(labelled != plain, "Labels are shown.");
  check(found(scene) == props, "A selection depends on labels.");
  scene.mapper->SetBlendModeToAverageIntensity();
  {
    const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
    const stage::Pixels average = scene.pixels();
    check(warnings.texts.size() == 1, "Averages have no labels, with one warning.");
    scene.mapper->SetLabelInput(nullptr);
    check(scene.pixels() == average, "Averages have no labels.");
  }
  scene.mapper->SetBlendModeToMaximumIntensity();
  vtkNew<vtkImageData> small, real, several;
  small->SetDimensions(36, 40, 33);
  small->AllocateScalars(VTK_INT, 1);
  real->SetDimensions(36, 40, 34);
  real->AllocateScalars(VTK_FLOAT, 1);
  several->SetDimensions(36, 40, 34);
  several->AllocateScalars(VTK_INT, 2);
  vtkNew<vtkImageData> none, turned, incomplete;
  none->SetDimensions(36, 40, 34);
  turned->SetDimensions(40, 36, 34);
  turned->AllocateScalars(VTK_INT, 1);
  incomplete->SetDimensions(36, 40, 34);
  incomplete->GetPointData()->SetScalars(small->GetPointData()->GetScalars());
  for (vtkImageData* bad :
    { small.Get(), real.Get(), several.Get(), none.Get(), turned.Get(), incomplete.Get() })
  {
    const stage::Messages errors(scene.mapper, vtkCommand::ErrorEvent);
    scene.mapper->SetLabelInput(bad);
    scene.pixels();
    scene.pixels();
    check(errors.texts.size() == 1 && errors.texts[0].find("LabelInput must") != std::string::npos,
      std::to_string(errors.texts.size()) + " errors for labels that do not fit.");
    scene.mapper->SetLabelInput(scene.labels);
    check(scene.pixels() == labelled, "Labels that fit are shown again.");
  }
}
}

//------------------------------------------------------------------------------
int TestLabels(int, char*[])
{
  stage::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  reference::forScenes("labels", 3,
    [&](int, reference::Random& random)
    {
      testEdges(check, random);
      testProjected(check, random);
      testRest(check, random);
    });
  return check.exitCode();
}
