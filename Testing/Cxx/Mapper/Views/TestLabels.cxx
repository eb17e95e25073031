// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Edges of labels: each pixel of the picture against the definition, by the voxels of
// GetLocations(), in both label modes, all quality modes and views, with geometry and cuts; and
// labels that do not fit.
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
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <cmath>

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
    coretesting::placeAtRandom(this->image, random, false);
    const int types[] = { VTK_SHORT, VTK_INT, VTK_SIGNED_CHAR, VTK_LONG_LONG };
    this->labels = boxes(this->image, types[random.uniform(0, 3)], random);
    this->mapper = stage::splatting(this->image);
    this->first = stage::splatting(nullptr);
    for (Mapper* each : { this->mapper.Get(), this->first.Get() })
    {
      each->RecordLocationsOn();
      each->AutoAdjustSampleDistancesOff();
    }
    this->first->SetQualityModeToPreview();
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

  /// Cuts of the volume, for both mappers.
  void chooseCuts(reference::Random& random)
  {
    stage::chooseSamples(this->mapper, this->image, random);
    this->sphere->SetVisibility(random.oneIn(2));
    vtkNew<vtkPlane> plane;
    const auto normal = stage::anyDirection(random);
    plane->SetOrigin(this->image->GetCenter());
    plane->SetNormal(normal.data());
    this->mapper->RemoveAllClippingPlanes();
    if (random.oneIn(3))
    {
      this->mapper->AddClippingPlane(plane);
    }
    vtkNew<vtkSphereSource> source;
    source->SetCenter(
      this->image->GetBounds()[0], this->image->GetCenter()[1], this->image->GetCenter()[2]);
    source->SetRadius(30.0);
    source->Update();
    this->mapper->SetBoundingSurface(random.oneIn(3) ? source->GetOutput() : nullptr);
    this->first->SetSlab(this->mapper->GetSlab());
    this->first->SetSlabCenter(this->mapper->GetSlabCenter());
    this->first->SetSlabThickness(this->mapper->GetSlabThickness());
    this->first->SetCropping(this->mapper->GetCropping());
    this->first->SetCroppingRegionFlags(this->mapper->GetCroppingRegionFlags());
    this->first->SetCroppingRegionPlanes(this->mapper->GetCroppingRegionPlanes());
    this->first->SetClippingPlanes(this->mapper->GetClippingPlanes());
    this->first->SetBoundingSurface(this->mapper->GetBoundingSurface());
  }

  /**
   * The label at each pixel, row by row from the bottom: that of the voxel that the last frame
   * shows. In LabelMode PROJECTED, of the first voxel with a label on its ray: the nearest of the
   * largest in a preview of bytes that are 1 where there is a label.
   */
  std::vector<int> shownLabels()
  {
    const bool isProjected = this->mapper->GetLabelMode() == Mapper::PROJECTED;
    if (isProjected)
    {
      vtkNew<vtkImageData> hasLabel;
      hasLabel->CopyStructure(this->image);
      hasLabel->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
      vtkDataArray* const from = this->labels->GetPointData()->GetScalars();
      for (vtkIdType n = 0; n < from->GetNumberOfTuples(); ++n)
      {
        hasLabel->GetPointData()->GetScalars()->SetComponent(n, 0, from->GetComponent(n, 0) != 0.0);
      }
      this->first->SetInputData(hasLabel);
      this->show(this->first);
      this->window->Render();
      this->show(this->mapper);
    }
    Mapper* const shown = isProjected ? this->first : this->mapper;
    vtkDataArray* const voxels = shown->GetLocations()->GetPointData()->GetArray("Voxel");
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
  vtkSmartPointer<Mapper> mapper, first;
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
int compare(Scene& scene, const std::string& what, ColorOf&& colorOf, reference::Checks& check)
{
  scene.mapper->SetLabelInput(scene.labels);
  const stage::Pixels pixels = scene.pixels(); // reuses the last projection
  scene.mapper->SetLabelInput(nullptr);
  const stage::Pixels plain = scene.pixels();
  const std::vector<int> labels = scene.shownLabels();
  scene.mapper->SetLabelInput(scene.labels);
  check(scene.pixels() == pixels, what, ": labels that are removed and set again look different.");
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
  check(wrong == 0, what, ": ", wrong, " bytes differ.");
  return edges;
}

void testEdges(int labelMode, reference::Checks& check, reference::Random& random)
{
  Scene scene(random);
  scene.mapper->SetLabelMode(labelMode);
  scene.mapper->SetRecordLocations(labelMode == Mapper::SAMPLE); // averages have no locations
  const stage::Messages warnings(scene.mapper, vtkCommand::WarningEvent);
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
      const std::string what = "label mode " + std::to_string(labelMode) + ", mode " +
        std::to_string(mode) + ", scale " + std::to_string(scale);
      scene.viewAngle = random.uniform(0, 1) * 40.0;
      const auto direction = stage::anyDirection(random);
      scene.look(direction, { direction[1], direction[2], -direction[0] }, scale);
      // Only PROJECTED has labels of averages.
      scene.mapper->SetBlendMode(random.uniform(1, labelMode == Mapper::PROJECTED ? 3 : 2));
      scene.chooseCuts(random);
      scene.mapper->SetLabelColors(function);
      edges += compare(scene, what + ", function", ofFunction, check);
      scene.mapper->SetLabelColors(table);
      compare(scene, what + ", table", ofTable, check);
      scene.chooseCuts(random); // in the same view
      scene.mapper->SetLabelColors(nullptr);
      compare(scene, what + ", default", byDefault, check);
      scene.look({ -direction[0], -direction[1], -direction[2] },
        { direction[1], direction[2], -direction[0] }, scale);
      compare(scene, what + ", other side", byDefault, check);
    }
  }
  check(edges > 500, "There are only ", edges, " pixels of edges.");
  check(warnings.texts.empty(), "There is a warning.");
  // Locations are found without RecordLocations, and labels that change are shown.
  const stage::Pixels before = scene.pixels();
  scene.mapper->RecordLocationsOff();
  check(scene.pixels() == before, "Labels without RecordLocations.");
  scene.mapper->SetRecordLocations(labelMode == Mapper::SAMPLE);
  scene.labels->DeepCopy(boxes(scene.image, VTK_SHORT, random));
  compare(scene, "other labels", byDefault, check);
  scene.labels->GetPointData()->GetScalars()->Fill(0.0);
  scene.labels->Modified();
  const stage::Pixels after = scene.pixels();
  const vtkIdType memory = scene.mapper->GetIndexMemorySize();
  scene.mapper->SetLabelInput(nullptr);
  check(scene.pixels() == after, "Labels of 0 have no edges.");
  check(labelMode == Mapper::SAMPLE ||
      memory - scene.mapper->GetIndexMemorySize() >= scene.labels->GetNumberOfPoints(),
    "The copy of the labels is not counted, or is kept without labels.");
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

void testRest(reference::Checks& check, reference::Random& random)
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
      errors.texts.size(), " errors for labels that do not fit.");
    scene.mapper->SetLabelInput(scene.labels);
    check(scene.pixels() == labelled, "Labels that fit are shown again.");
  }
}
}

//------------------------------------------------------------------------------
int TestLabels(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  reference::forScenes("labels", 3,
    [&](int, reference::Random& random)
    {
      testEdges(Mapper::SAMPLE, check, random);
      testEdges(Mapper::PROJECTED, check, random);
      testRest(check, random);
    });
  return check.exitCode();
}
