// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of colours against VTK's functions, entry by entry: premultiplied, with window and level.
#include "Components/TransferFunctions.h"
#include "ProjectionTesting.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

/// Nodes at any places; some of them far beyond the data.
std::vector<double> anyNodes(reference::Random& random)
{
  std::vector<double> nodes;
  for (int n = random.uniform(1, 5); n > 0; --n)
  {
    nodes.push_back(random.uniform(-150.0, 150.0));
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

struct Scene
{
  vtkNew<vtkVolumeProperty> property;
  vtkNew<vtkPiecewiseFunction> opacity, gray;
  vtkNew<vtkColorTransferFunction> color;
  std::vector<double> nodes; ///< of all functions
  bool isGray;
  ScalarRange range;
  FinalColor finalColor;
  double weight;

  explicit Scene(reference::Random& random) : isGray(random.uniform(0, 1))
  {
    for (double node : anyNodes(random))
    {
      const double value = random.uniform(0.0, 1.0);
      this->opacity->AddPoint(node, value);
      this->nodes.push_back(node);
    }
    for (double node : anyNodes(random))
    {
      const glm::dvec3 rgb = coretesting::anyVector(random, 0.0, 1.0);
      this->color->AddRGBPoint(node, rgb.x, rgb.y, rgb.z);
      this->gray->AddPoint(node, rgb.x);
      this->nodes.push_back(node);
    }
    this->opacity->SetClamping(random.uniform(0, 2) > 0);
    this->color->SetClamping(random.uniform(0, 2) > 0);
    this->gray->SetClamping(this->color->GetClamping());
    this->isGray ? this->property->SetColor(1, this->gray)
                 : this->property->SetColor(1, this->color);
    this->property->SetScalarOpacity(1, this->opacity);
    this->range.integers = random.uniform(0, 1);
    this->range.low = std::floor(random.uniform(-100.0, 0.0));
    this->range.high = this->range.low + std::floor(random.uniform(0.0, 200.0));
    this->finalColor.window = float(random.uniform(0.3, 3.0)) * (!random.oneIn(4) ? 1 : -1);
    this->finalColor.level = float(random.uniform(0.0, 1.0));
    this->weight = random.uniform(0.1, 1.0);
  }

  double opacityAt(double scalar) { return this->opacity->GetValue(scalar); }
  double colorAt(double scalar, int c)
  {
    return this->isGray ? this->gray->GetValue(scalar) : this->color->GetColor(scalar)[c];
  }
  /// Where functions jump, or end, rounding decides.
  bool isNextToNode(double scalar) const
  {
    return std::any_of(this->nodes.begin(), this->nodes.end(),
      [=](double node) { return std::abs(node - scalar) < 1e-4; });
  }
};

void compare(Checks& check, const unsigned char* bytes, const glm::dvec4& expected, double scalar)
{
  for (int c = 0; c < 4; ++c)
  {
    // Bytes are rounded, after roundings of float that slopes and 1 / window magnify.
    check(std::abs(bytes[c] - std::clamp(expected[c], 0.0, 255.0)) <= 0.51, "channel ", c, " of ",
      scalar, " is ", int(bytes[c]), ", not ", expected[c]);
  }
}

enum Kind
{
  Colors,
  Opaque,
  Opacity
};

glm::dvec4 expectedAt(Scene& scene, double scalar, Kind kind)
{
  const double alpha =
    kind == Opaque ? 1.0 : scene.opacityAt(scalar) * (kind == Colors ? scene.weight : 1.0);
  glm::dvec4 expected(255.0 * alpha);
  for (int c = 0; c < 3 && kind != Opacity; ++c)
  {
    const double straight =
      (scene.colorAt(scalar, c) - scene.finalColor.level) / scene.finalColor.window + 0.5;
    expected[c] = 255.0 * alpha * straight;
  }
  return expected;
}

/// Entries are as many as are promised, and what is beyond them is as the first or the last.
void testTable(Checks& check, Scene& scene, const splatting::ColorTable& table, Kind kind,
  reference::Random& random)
{
  const std::size_t count = table.colors.size();
  const double wanted =
    scene.range.integers ? std::min(16.0 * (table.high - table.low) + 1.0, 65536.0) : 65536.0;
  check(table.low >= scene.range.low && table.high <= scene.range.high && table.low <= table.high,
    "a table from ", table.low, " to ", table.high);
  check(table.high > table.low ? count + 1.0 > wanted && double(count) <= std::max(wanted, 2.0)
                               : count == 1,
    count, " entries");
  for (int n = 0; n < 30; ++n)
  {
    const std::size_t e = random.uniform<std::size_t>(0, count - 1);
    const double share = count > 1 ? double(e) / double(count - 1) : 0.0;
    const double scalar = table.low + (table.high - table.low) * share;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&table.colors[e]);
    if (!scene.isNextToNode(scalar))
    {
      compare(check, bytes, expectedAt(scene, scalar, kind), scalar);
    }
    const double other = random.uniform(scene.range.low, scene.range.high);
    if ((other < table.low || other > table.high) && !scene.isNextToNode(other))
    {
      const glm::dvec4 beyond = expectedAt(scene, other, kind);
      compare(check,
        reinterpret_cast<const unsigned char*>(
          other < table.low ? &table.colors.front() : &table.colors.back()),
        beyond, other);
    }
  }
}

void testPrimaries(Checks& check)
{
  for (int primary = 0; primary < 3; ++primary)
  {
    for (const FinalColor& finalColor : { FinalColor{}, FinalColor{ 2.0f, 0.25f } })
    {
      const splatting::ColorTable table = tabulatePrimary(primary, finalColor);
      for (std::size_t e = 0; e < table.colors.size(); ++e)
      {
        const double share = double(e) / (double(table.colors.size()) - 1.0);
        glm::dvec4 expected(0.0, 0.0, 0.0, 255.0);
        expected[primary] =
          255.0 * std::clamp((share - finalColor.level) / finalColor.window + 0.5, 0.0, 1.0);
        compare(
          check, reinterpret_cast<const unsigned char*>(&table.colors[e]), expected, 255.0 * share);
      }
    }
  }
}
}

int TestTransferFunctions(int, char*[])
{
  Checks check;
  testPrimaries(check);
  reference::forScenes("functions", 400,
    [&](int, reference::Random& random)
    {
      Scene scene(random);
      testTable(check, scene,
        tabulateColors(scene.property, 1, scene.weight, scene.range, scene.finalColor), Colors,
        random);
      scene.isGray ? scene.property->SetColor(0, scene.gray)
                   : scene.property->SetColor(0, scene.color);
      scene.property->SetScalarOpacity(0, scene.opacity);
      testTable(check, scene, tabulateOpaque(scene.property, scene.range, scene.finalColor), Opaque,
        random);
      testTable(check, scene, tabulateOpacity(scene.property, scene.range), Opacity, random);
      check(scene.finalColor.isValid() && !FinalColor{ 0.0f, 0.5f }.isValid() &&
          !FinalColor{ 1.0f, NAN }.isValid(),
        "windows and levels are judged wrongly");
    });
  return check.exitCode();
}
