// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of vtkSplattingMIPProjection against the definition: where a pixel's ray meets the shear
// image, between the four rays beside it, each reduced sample by sample. In a process without a
// display, which never loads OpenGL.
#include "AverageTesting.h"
#include "ProjectionTesting.h"

#include "FieldMaximum.h"
#include "Reductions.h"

#include "vtkMatrix4x4.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>

namespace
{
using coretesting::Checks;
using Filter = vtkSplattingMIPProjection;

/// What pixels of the shear image are, by brute force.
struct Oracle
{
  reference::ShearGrid grid;
  reference::ShearView view;
  std::vector<unsigned char> meets, hit, known;
  std::vector<double> values;
  // Of exact mode:
  reference::Volume<double> volume;
  std::vector<double> ways; ///< of rays through the field
  std::vector<int> winners; ///< the slices of their maxima
};

/// Where it is not clear which slice wins.
constexpr int NoWinner = std::numeric_limits<int>::min();

/// A parallel view in index space: a ray through `corner + x across + y up` runs along `direction`.
struct Rays
{
  glm::dvec3 corner, across, up, direction;
};

glm::dmat4 indexToWorld(vtkImageData* image)
{
  glm::dmat4 m;
  for (int r = 0; r < 4; ++r)
  {
    for (int c = 0; c < 4; ++c)
    {
      m[c][r] = image->GetIndexToPhysicalMatrix()->GetElement(r, c);
    }
  }
  const int* const extent = image->GetExtent();
  return glm::translate(m, glm::dvec3(extent[0], extent[2], extent[4]));
}

Rays raysOf(Filter* filter, vtkImageData* image, const glm::dvec3& focus)
{
  const double *d = filter->GetViewDirection(), *u = filter->GetViewUp();
  const glm::dvec3 direction = glm::normalize(glm::dvec3(d[0], d[1], d[2]));
  const glm::dvec3 right = glm::normalize(glm::cross(direction, glm::dvec3(u[0], u[1], u[2])));
  const glm::dvec3 up = glm::cross(right, direction);
  const int* const size = filter->GetOutputSize();
  const double* const spacing = filter->GetOutputSpacing();
  const glm::dvec3 corner =
    focus - 0.5 * (size[0] - 1) * spacing[0] * right - 0.5 * (size[1] - 1) * spacing[1] * up;
  const glm::dmat4 toIndex = glm::inverse(indexToWorld(image));
  return { glm::dvec3(toIndex * glm::dvec4(corner, 1.0)),
    glm::dvec3(toIndex * glm::dvec4(spacing[0] * right, 0.0)),
    glm::dvec3(toIndex * glm::dvec4(spacing[1] * up, 0.0)),
    glm::dvec3(toIndex * glm::dvec4(direction, 0.0)) };
}

/// False if two axes are nearly as near to the direction.
bool findView(const Rays& rays, reference::ShearView& view)
{
  const glm::dvec3 d = glm::abs(rays.direction);
  view.axis = d.z >= d.x && d.z >= d.y ? 2 : d.y >= d.x ? 1 : 0;
  const int i = view.axis == 0 ? 1 : 0, j = view.axis == 2 ? 1 : 2;
  for (int a = 0; a < 2; ++a)
  {
    const double shear = -rays.direction[a ? j : i] / rays.direction[view.axis];
    view.shear[a] = std::ldexp(std::round(std::ldexp(shear, 24)), -24);
  }
  return std::max(std::abs(view.shear[0]), std::abs(view.shear[1])) < 0.999;
}

reference::Kernel kernelOf(Filter* filter)
{
  return filter->GetQualityMode() == Filter::STANDARD
    ? reference::Kernel{ reference::Kernel::Nearest, 1.0 }
    : filter->GetKernel() == Filter::COSINE_BELL
    ? reference::Kernel{ reference::Kernel::CosineBell, filter->GetKernelRadius() }
    : reference::Kernel{ reference::Kernel::Trilinear, 1.0 };
}

reference::Outcome<double> reduced(
  const reference::CutRay<double>& ray, double lowest, Filter* filter)
{
  switch (filter->GetBlendMode())
  {
    case Filter::MINIMUM_INTENSITY_BLEND:
      return reference::smallest(ray)[0];
    case Filter::AVERAGE_INTENSITY_BLEND:
      return reference::mean(ray, -HUGE_VAL, HUGE_VAL, 0.0)[0];
  }
  switch (filter->GetMaximumType())
  {
    case Filter::DEPTH_SHADED:
      return reference::depthShaded(
        ray, lowest, filter->GetDepthShadingAmbient(), filter->GetDepthShadingChangeRate())[0];
    case Filter::LOCAL:
      return reference::firstLocalMaximum(ray, filter->GetLocalMaximumThreshold(), 0.0)[0];
    default:
      return reference::largest(ray)[0];
  }
}

/// Whether a half-space leaves out some of a voxel. One that does not cuts nothing: slices count of
/// which a ray crosses voxels, although it may cross their middle outside the volume.
bool cutsVoxels(const glm::dvec4& h, vtkImageData* image)
{
  double least = h.w;
  for (int a = 0; a < 3; ++a)
  {
    least += std::min(-0.5 * h[a], (image->GetDimensions()[a] - 0.5) * h[a]);
  }
  return least < 0.0;
}

/// The filter's slab and cropping in index space.
reference::RayCuts cutsOf(Filter* filter, vtkImageData* image)
{
  reference::RayCuts cuts;
  if (filter->GetSlab())
  {
    const double *d = filter->GetViewDirection(), *c = filter->GetSlabCenter();
    const glm::dvec3 normal = glm::normalize(glm::dvec3(d[0], d[1], d[2]));
    const double place = glm::dot(normal, glm::dvec3(c[0], c[1], c[2]));
    for (const double side : { 1.0, -1.0 })
    {
      const glm::dvec4 h =
        glm::dvec4(side * normal, 0.5 * filter->GetSlabThickness() - side * place) *
        indexToWorld(image);
      if (cutsVoxels(h, image))
      {
        cuts.halfSpaces.push_back({ h.x, h.y, h.z, h.w });
      }
    }
  }
  if (filter->GetCropping())
  {
    cuts.regions = static_cast<unsigned>(filter->GetCroppingRegionFlags());
    for (int plane = 0; plane < 6; ++plane)
    {
      const int a = plane / 2;
      cuts.planes[a][plane % 2] =
        (filter->GetCroppingRegionPlanes()[plane] - image->GetOrigin()[a]) /
          image->GetSpacing()[a] -
        image->GetExtent()[2 * a];
    }
  }
  return cuts;
}

/// The slice in which a ray has its maximum, and that. NoWinner if it is nearly that in others.
int findWinner(const reference::Volume<double>& field, const reference::FieldRay& ray,
  const std::array<double, 2>& depths, double& value)
{
  std::vector<double> maxima;
  const int first = static_cast<int>(std::floor(depths[0] + 0.5));
  for (int k = first; k - 0.5 < depths[1]; ++k)
  {
    const double from = std::max(depths[0], k - 0.5), to = std::min(depths[1], k + 0.5);
    maxima.push_back(from < to ? reference::fieldMaximum(field, ray, from, to) : -HUGE_VAL);
  }
  const auto largest = std::max_element(maxima.begin(), maxima.end());
  value = *largest;
  // Rounding must not choose. Between two slices the maximum may be in both.
  constexpr double near = 1e-4;
  const auto count = std::count_if(maxima.begin(), maxima.end(),
    [&](double other) { return other > value - near * (1.0 + std::abs(value)); });
  return count == 1 ? first + static_cast<int>(largest - maxima.begin()) : NoWinner;
}

template <class T>
Oracle oracleOf(
  const reference::Volume<T>& volume, Filter* filter, vtkImageData* image, const Rays& rays)
{
  Oracle oracle;
  findView(rays, oracle.view);
  oracle.view.sampling =
    static_cast<int>(std::lround(1.0 / filter->GetShearImage()->GetSpacing()[0]));
  oracle.grid = reference::makeShearGrid(volume.size, oracle.view);
  const reference::Volume<double> exact = reference::toDouble(volume);
  const bool isExact = filter->GetQualityMode() == Filter::EXACT;
  const auto samples = filter->GetQualityMode() == Filter::PREVIEW || isExact
    ? reference::voxelSamples(exact, oracle.view)
    : reference::slabSamples(exact, oracle.view, kernelOf(filter));
  const reference::RayCutter cutter(oracle.grid, oracle.view, cutsOf(filter, image));
  oracle.volume = isExact ? exact : reference::Volume<double>();
  const double lowest = reference::lowestVoxel(volume);
  const bool reversed = rays.direction[oracle.view.axis] < 0.0;
  for (int v = 0; v < oracle.grid.height; ++v)
  {
    for (int u = 0; u < oracle.grid.width; ++u)
    {
      const auto& own = samples[std::size_t(v) * oracle.grid.width + u];
      reference::Outcome<double> outcome =
        reduced(reference::cutRay(own, cutter, u, v, reversed), lowest, filter);
      bool known = true;
      if (isExact)
      {
        const auto ray = reference::fieldRay(volume.size, oracle.view, u, v);
        const double end = oracle.grid.size[2] - 0.5;
        const auto depths =
          reference::depthsInField(volume.size, ray, reference::FieldDomain::Centres, -0.5, end);
        known = own.empty() || depths[1] - depths[0] > 1e-6;
        oracle.ways.push_back(depths[1] - depths[0]);
        oracle.winners.push_back(
          known && !own.empty() ? findWinner(exact, ray, depths, outcome.value) : NoWinner);
      }
      oracle.meets.push_back(!own.empty());
      oracle.hit.push_back(outcome.hit);
      oracle.known.push_back(known);
      oracle.values.push_back(outcome.value);
    }
  }
  return oracle;
}

/// How much of a ray lies in the box of the outermost voxel centres, the picture's outline;
/// negative if it misses it.
double lengthInside(const std::array<int, 3>& size, const glm::dvec3& at, const glm::dvec3& along)
{
  double begin = -HUGE_VAL, end = HUGE_VAL;
  for (int a = 0; a < 3; ++a)
  {
    const double thin = size[a] == 1 ? 0.5 : 0.0;
    const double low = (-thin - at[a]) / along[a], high = (size[a] - 1 + thin - at[a]) / along[a];
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return end - begin;
}

/// What a pixel must be: nothing if it must have the background. False if that is open.
struct Expected
{
  bool certain = true;
  bool hit = false;
  double value = 0.0;
  double slack = 0.0; ///< what it may differ by, beside rounding
};

/// How exact mode's rays about a pixel run through the field.
struct Ways
{
  double shortest = HUGE_VAL, longest = 0.0;
  bool certain = true;

  void add(double way, double weight)
  {
    this->certain = this->certain && (weight > 1e-9 || weight == 0.0) && std::abs(way) > 1e-6;
    this->shortest = weight > 0.0 ? std::min(this->shortest, way) : this->shortest;
    this->longest = weight > 0.0 ? std::max(this->longest, way) : this->longest;
  }
};

/// What a ray finds: at the rim of the field all along it, else from the slice before to the slice
/// behind each of the winners. False if that is open.
bool findOnRay(const Oracle& oracle, const reference::FieldRay& ray, const Ways& ways,
  const std::vector<int>& winners, double& value)
{
  const auto depths = reference::depthsInField(
    oracle.volume.size, ray, reference::FieldDomain::Centres, -0.5, oracle.grid.size[2] - 0.5);
  const double own = depths[1] - depths[0];
  const double share = ways.shortest / ways.longest;
  if (!ways.certain || (ways.shortest >= 0.0 && std::abs(share - 0.5) <= 1e-5))
  {
    return false;
  }
  if (ways.shortest < 0.0 || share < 0.5)
  {
    value = own > 1e-5 ? reference::fieldMaximum(oracle.volume, ray, depths[0], depths[1]) : 0.0;
    return own > 1e-5;
  }
  value = -HUGE_VAL;
  for (const int winner : winners)
  {
    const double from = std::max(depths[0], winner - 1.0), to = std::min(depths[1], winner + 1.0);
    if (winner == NoWinner || std::abs(winner - depths[0]) <= 1e-5 ||
      std::abs(winner - depths[1]) <= 1e-5)
    {
      return false;
    }
    // Where the ray does not meet the middle of a winner's slice, it looks at all of it.
    value = std::max(value,
      winner >= depths[0] && winner <= depths[1]
        ? reference::fieldMaximum(oracle.volume, ray, from, to)
        : reference::fieldMaximum(oracle.volume, ray, depths[0], depths[1]));
  }
  return true;
}

/// A pixel shows what its own ray finds. Places and shears are rounded, which displaces the ray:
/// one that grazes a face of the field then ends elsewhere.
void expectOwnRay(const Oracle& oracle, const Rays& rays, const glm::dvec3& point, const Ways& ways,
  const std::vector<int>& winners, Expected& expected)
{
  reference::FieldRay ray;
  ray.axes = oracle.grid.axes;
  ray.start = point[ray.axes[2]];
  for (int a = 0; a < 2; ++a)
  {
    ray.at[a] = point[ray.axes[a]];
    ray.slope[a] = rays.direction[ray.axes[a]] / rays.direction[ray.axes[2]];
  }
  expected.certain = expected.certain && findOnRay(oracle, ray, ways, winners, expected.value);
  // Shears are rounded by 2^-25 a slice at most, from the middle of the stack on.
  const double way =
    0x1p-25 * *std::max_element(oracle.volume.size.begin(), oracle.volume.size.end());
  for (int n = 0; n < 4 && expected.certain; ++n)
  {
    reference::FieldRay displaced = ray;
    displaced.at[0] += n % 2 ? way : -way;
    displaced.at[1] += n / 2 ? way : -way;
    double value = 0.0;
    expected.certain = findOnRay(oracle, displaced, ways, winners, value);
    expected.slack = std::max(expected.slack, std::abs(value - expected.value));
  }
}

Expected expectedPixel(
  const Oracle& oracle, const std::array<int, 3>& size, const Rays& rays, const glm::dvec3& point)
{
  Expected expected;
  const double inside = lengthInside(size, point, rays.direction);
  expected.certain = std::abs(inside) > 1e-5;
  if (inside < 0.0)
  {
    return expected;
  }
  const auto& axes = oracle.grid.axes;
  const double depth = point[axes[2]] - oracle.grid.middle;
  const double pu =
    oracle.view.sampling * (point[axes[0]] + oracle.grid.margin[0] + oracle.view.shear[0] * depth);
  const double pv =
    oracle.view.sampling * (point[axes[1]] + oracle.grid.margin[1] + oracle.view.shear[1] * depth);
  const int u = static_cast<int>(std::floor(pu)), v = static_cast<int>(std::floor(pv));
  double sum = 0.0, weight = 0.0, lost = 0.0;
  Ways ways;
  std::vector<int> winners; // of those that are weighted
  for (int n = 0; n < 4; ++n)
  {
    const int i = u + n % 2, j = v + n / 2;
    const double w = std::abs(u + 1 - n % 2 - pu) * std::abs(v + 1 - n / 2 - pv);
    if (i < 0 || j < 0 || i >= oracle.grid.width || j >= oracle.grid.height)
    {
      ways.add(-1.0, w);
      continue;
    }
    const std::size_t pixel = std::size_t(j) * oracle.grid.width + i;
    const bool isExact = !oracle.ways.empty();
    if (isExact)
    {
      ways.add(oracle.ways[pixel], w);
      if (w > 0.0)
      {
        winners.push_back(oracle.winners[pixel]);
      }
    }
    expected.certain = expected.certain && (oracle.known[pixel] || isExact || w < 1e-9);
    if (oracle.meets[pixel])
    {
      (oracle.hit[pixel] ? weight : lost) += w;
      sum += oracle.hit[pixel] ? w * oracle.values[pixel] : 0.0;
    }
  }
  expected.certain = expected.certain && std::abs(lost - 0.5) > 1e-5 && weight > 1e-5;
  expected.hit = weight > 1e-5 && lost <= 0.5;
  expected.value = sum / weight;
  if (!oracle.ways.empty() && expected.hit)
  {
    expectOwnRay(oracle, rays, point, ways, winners, expected);
  }
  return expected;
}

struct Count
{
  int pixels = 0, hits = 0;
  double worst = 0.0;
};

template <class T>
void compare(Checks& check, const reference::Volume<T>& volume, Filter* filter, vtkImageData* image,
  const glm::dvec3& focus, Count& count)
{
  const Rays rays = raysOf(filter, image, focus);
  filter->SetBackgroundValue(NAN);
  filter->Update();
  vtkImageData* const output = filter->GetOutput();
  const int type = std::is_same_v<splatting::Accumulator<T>, float> ? VTK_FLOAT : VTK_DOUBLE;
  if (!check(output->GetScalarType() == type && output->GetNumberOfScalarComponents() == 1,
        "the type is ", output->GetScalarTypeAsString()))
  {
    return;
  }
  const Oracle oracle = oracleOf(volume, filter, image, rays);
  const double low = double(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
  const double high = double(*std::max_element(volume.voxels.begin(), volume.voxels.end()));
  // Weights as the class documentation has them, shading and means, then rounded places in the
  // shear image (2^-24 of a pixel and, of shears, 2^-25 a slice) and a bilinear mean.
  const double bound = coretesting::errorBound<T>(splatting::Quality::High, low, high) +
    1e-6 * oracle.view.sampling * (high - low) +
    32.0 * (type == VTK_FLOAT ? 0x1p-24 : 0x1p-53) * std::max(std::abs(low), std::abs(high));
  const int* const size = filter->GetOutputSize();
  for (int y = 0; y < size[1]; ++y)
  {
    for (int x = 0; x < size[0]; ++x)
    {
      const glm::dvec3 point = rays.corner + double(x) * rays.across + double(y) * rays.up;
      const Expected expected = expectedPixel(oracle, volume.size, rays, point);
      if (!expected.certain)
      {
        continue;
      }
      const double found = output->GetScalarComponentAsDouble(x, y, 0, 0);
      check(std::isnan(found) != expected.hit, "pixel ", x, " ", y, " is ", found, ", expected ",
        expected.hit ? "a sample" : "none");
      ++count.pixels;
      if (expected.hit && !std::isnan(found))
      {
        const double error = std::abs(found - expected.value) / (bound + expected.slack);
        check(error <= 1.0, "mode ", filter->GetQualityMode(), " blend ", filter->GetBlendMode(),
          " pixel ", x, " ", y, " is ", found, ", not ", expected.value, ": ", error, " bounds");
        count.worst = std::max(count.worst, error);
        ++count.hits;
      }
    }
  }
}

/// Any combination that the oracle knows without doubt.
void chooseAtRandom(Filter* filter, vtkImageData* image, bool integers, reference::Random& random)
{
  filter->SetQualityMode(random.uniform(0, 3));
  filter->SetKernel(random.uniform(0, 1));
  filter->SetKernelRadius(random.uniform(0.6, 1.5));
  filter->SetAcceleration(random.uniform<int>(Filter::AUTO, Filter::SORTED_VOLUME));
  filter->SetShearImageSampling(random.uniform(0, 4));
  if (filter->GetQualityMode() == Filter::EXACT)
  {
    return;
  }
  filter->SetBlendMode(random.uniform(1, 3));
  // Whether a local maximum ends hangs on comparisons, which need exact samples.
  const bool isSharp = integers && filter->GetQualityMode() == Filter::PREVIEW;
  filter->SetMaximumType(random.uniform(0, isSharp ? 2 : 1));
  filter->SetLocalMaximumThreshold(random.uniform(-100.0, 100.0));
  filter->SetDepthShadingAmbient(random.uniform(0.0, 0.6));
  filter->SetDepthShadingChangeRate(random.uniform(0.1, 0.4));
  const double* const centre = image->GetCenter();
  if (random.uniform(0, 1))
  {
    filter->SlabOn();
    filter->SetSlabThickness(random.uniform(1.0, 6.0));
    const double off[3] = { random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
      random.uniform(-2.0, 2.0) };
    filter->SetSlabCenter(centre[0] + off[0], centre[1] + off[1], centre[2] + off[2]);
  }
  if (random.uniform(0, 1))
  {
    filter->CroppingOn();
    filter->SetCroppingRegionFlags(random.uniform(1, 0x7ffffff));
    double planes[6];
    for (int plane = 0; plane < 6; ++plane)
    {
      const int a = plane / 2, length = image->GetDimensions()[a];
      const double index =
        length * (plane % 2 ? random.uniform(0.5, 0.9) : random.uniform(0.1, 0.4));
      planes[plane] =
        image->GetOrigin()[a] + image->GetSpacing()[a] * (image->GetExtent()[2 * a] + index);
    }
    filter->SetCroppingRegionPlanes(planes);
  }
}

/// A view from anywhere, of some pixels, whose principal axis the oracle knows.
glm::dvec3 lookAtRandom(Filter* filter, vtkImageData* image, reference::Random& random)
{
  glm::dvec3 direction, up;
  reference::ShearView view;
  do
  {
    direction = projectiontesting::randomDirection(random);
    up = projectiontesting::randomDirection(random);
    filter->SetViewDirection(direction.x, direction.y, direction.z);
    filter->SetViewUp(up.x, up.y, up.z);
    const int size[2] = { random.uniform(1, 28), random.uniform(1, 28) };
    filter->SetOutputSize(size[0], size[1]);
    // Pixels no wider than voxels, which show points; see TestPixelAreas for others.
    const double* const voxel = image->GetSpacing();
    const double least = std::min({ voxel[0], voxel[1], voxel[2] });
    const double spacing[2] = { least * random.uniform(0.2, 1.0),
      least * random.uniform(0.2, 1.0) };
    filter->SetOutputSpacing(spacing[0], spacing[1]);
  } while (
    !findView(raysOf(filter, image, {}), view) || glm::length(glm::cross(direction, up)) < 0.1);
  const double* const bounds = image->GetBounds();
  return { 0.5 * (bounds[0] + bounds[1]), 0.5 * (bounds[2] + bounds[3]),
    0.5 * (bounds[4] + bounds[5]) };
}

template <class T>
void testType(Checks& check, Count& all)
{
  Count count;
  const char* const type = vtkTypeTraits<T>::SizedName();
  reference::forScenes(type, 32,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size = { random.uniform(n % 6 ? 2 : 1, 9),
        random.uniform(n % 5 ? 2 : 1, 9), random.uniform(n % 4 ? 2 : 1, 9) };
      const auto volume = coretesting::wholeRangeNoise<T>(size, random.bits());
      const auto image = projectiontesting::imageOf(volume);
      projectiontesting::placeAtRandom(image, random);
      const auto filter = projectiontesting::projectionOf(image);
      glm::dvec3 focus = lookAtRandom(filter, image, random);
      chooseAtRandom(filter, image, std::is_integral_v<T>, random);
      if (random.uniform(0, 1))
      {
        focus += 2.0 * projectiontesting::randomDirection(random);
        filter->CenterOnVolumeOff();
        filter->SetFocalPoint(focus.x, focus.y, focus.z);
      }
      compare(check, volume, filter, image, focus, count);
    });
  all.hits += count.hits;
  std::cout << "type " << type << ": largest error " << count.worst << " of the bound, "
            << count.hits << " of " << count.pixels << " pixels with a sample\n";
}

/// What this process has loaded has nothing to do with a display.
void testLibraries(Checks& check)
{
  std::ifstream maps("/proc/self/maps");
  std::string line;
  int lines = 0;
  while (std::getline(maps, line))
  {
    ++lines;
    for (const char* library : { "libGL", "libOpenGL", "libEGL", "libOSMesa", "libX11",
           "libvtkRenderingOpenGL2", "libvtkRenderingVolume", "libvtkRenderingSplattingMIP" })
    {
      check(line.find(library) == std::string::npos, "this process has loaded ", line);
    }
  }
  std::cout << lines << " mappings, DISPLAY is "
            << (std::getenv("DISPLAY") ? std::getenv("DISPLAY") : "not set") << "\n";
}
}

int TestProjection(int, char*[])
{
  Checks check;
  Count all;
  coretesting::forEachType(
    [&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check, all); });
  // Eight scenes of each type; fewer may miss more.
  check(all.hits > 600 || reference::scenesRun() < 80, "only ", all.hits, " pixels with a sample");
  testLibraries(check);
  return check.result();
}
