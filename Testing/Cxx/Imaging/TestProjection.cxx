// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of vtkSplattingMIPProjection against the definition: where a pixel's ray meets the shear
// image, between the four rays beside it, each reduced sample by sample; in overviews from the
// samples in the pixel's area; in exact mode the field on its own ray. Half of the images are
// skewed. In a process without a display, which never loads OpenGL.
#include "AverageTesting.h"
#include "PixelOracle.h"

#include "CellBounds.h"

#include "vtkMatrix4x4.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;
using namespace projectiontesting;

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

/// Overviews of exact mode show the voxels of mode PREVIEW, but averages are those of HIGH.
bool showsVoxels(Filter* filter)
{
  return filter->GetQualityMode() == Filter::PREVIEW ||
    (filter->GetQualityMode() == Filter::EXACT &&
      filter->GetBlendMode() != Filter::AVERAGE_INTENSITY_BLEND);
}

template <class T>
Oracle oracleOf(
  const reference::Volume<T>& volume, Filter* filter, vtkImageData* image, const Rays& rays)
{
  reference::ShearView view;
  findView(rays, view);
  Oracle oracle{ reference::raysOf(volume.size, view), {} };
  const reference::Volume<double> exact = reference::toDouble(volume);
  const auto samples = showsVoxels(filter)
    ? reference::voxelSamples(exact, oracle.rays)
    : reference::slabSamples(exact, oracle.rays, kernelOf(filter));
  const reference::RayCutter cutter(oracle.rays, cutsOf(filter, image));
  const double lowest = reference::lowestVoxel(volume);
  const bool reversed = rays.direction[view.axis] < 0.0;
  for (std::size_t n = 0; n < samples.size(); ++n)
  {
    const int u = int(n) % oracle.rays.width(), v = int(n) / oracle.rays.width();
    const reference::Outcome<double> outcome =
      reduced(reference::cutRay(samples[n], cutter, u, v, reversed), lowest, filter);
    oracle.reduced.push_back({ !samples[n].empty(), outcome.hit, outcome.value });
  }
  return oracle;
}

/// In exact mode: the largest value of the field on the pixel's own ray, or the least.
reference::ExpectedPixel expectedOnRay(const reference::CellScene<double>& field, Filter* filter,
  const Rays& rays, const glm::dvec3& point)
{
  const glm::dvec3 reach = glm::normalize(rays.direction) * 1000.0;
  const bool isMinimum = filter->GetBlendMode() == Filter::MINIMUM_INTENSITY_BLEND;
  const double beside = filter->GetOutput()->GetScalarType() == VTK_FLOAT ? 0x1p-20 : 1e-12;
  const auto bounds =
    reference::boundsBetween(field, point - reach, point + reach, isMinimum, beside);
  return { bounds.isCertain, bounds.isHit, 0.5 * (bounds.low + bounds.high),
    0.5 * (bounds.high - bounds.low) };
}

struct Count
{
  int pixels = 0, hits = 0, ofOverviews = 0;
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
  const bool isOverview = voxelsPerPixel(rays) > 1.0;
  const bool isExact = filter->GetQualityMode() == Filter::EXACT && !isOverview;
  const Oracle oracle = isExact ? Oracle() : oracleOf(volume, filter, image, rays);
  const auto field = reference::cellScene(reference::toDouble(volume), cutsOf(filter, image));
  const double low = double(*std::min_element(volume.voxels.begin(), volume.voxels.end()));
  const double high = double(*std::max_element(volume.voxels.begin(), volume.voxels.end()));
  // Weights as the class documentation has them, shading and means, then rounded places in the
  // shear image (2^-24 of a pixel and, of shears, 2^-25 a slice) and a bilinear mean. In exact mode
  // 10^-6 of the range, or 10^-12 with double precision, and a value's own rounding.
  const double rounding = type == VTK_FLOAT ? 0x1p-24 : 0x1p-53;
  const double largest = std::max(std::abs(low), std::abs(high));
  const double bound = isExact
    ? (type == VTK_FLOAT ? 1e-6 : 1e-12) * (high - low) + 2.0 * rounding * largest
    : coretesting::errorBound<T>(splatting::Quality::High, low, high) + 1e-6 * (high - low) +
      32.0 * rounding * largest;
  const int* const size = filter->GetOutputSize();
  for (int y = 0; y < size[1]; ++y)
  {
    for (int x = 0; x < size[0]; ++x)
    {
      const glm::dvec3 point = rays.corner + double(x) * rays.across + double(y) * rays.up;
      const reference::ExpectedPixel expected = isOverview
        ? ofArea(OverviewSource(oracle, rays), x, y, filter)
        : isExact
        ? expectedOnRay(field, filter, rays, point)
        : reference::betweenRays(oracle.rays, point, [&](int u, int v) { return oracle.at(u, v); });
      if (!expected.isCertain)
      {
        continue;
      }
      const double found = output->GetScalarComponentAsDouble(x, y, 0, 0);
      check(std::isnan(found) != expected.isHit, "pixel ", x, " ", y, " is ", found, ", expected ",
        expected.isHit ? "a sample" : "none");
      ++count.pixels;
      if (expected.isHit && !std::isnan(found))
      {
        const double error = std::abs(found - expected.value) / (bound + expected.slack);
        check(error <= 1.0, "mode ", filter->GetQualityMode(), " blend ", filter->GetBlendMode(),
          " pixel ", x, " ", y, " is ", found, ", not ", expected.value, ": ", error, " bounds");
        count.worst = std::max(count.worst, error);
        ++count.hits;
        count.ofOverviews += isOverview;
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
  const bool isExact = filter->GetQualityMode() == Filter::EXACT;
  // Of exact mode the global extrema: means are those of high mode.
  const int blendModes[] = { Filter::MAXIMUM_INTENSITY_BLEND, Filter::MINIMUM_INTENSITY_BLEND,
    Filter::AVERAGE_INTENSITY_BLEND };
  filter->SetBlendMode(blendModes[random.uniform(0, isExact ? 1 : 2)]);
  // Whether a local maximum ends hangs on comparisons, which need exact samples.
  const bool isSharp = integers && filter->GetQualityMode() == Filter::PREVIEW;
  filter->SetMaximumType(random.uniform(0, isSharp ? 2 : isExact ? 0 : 1));
  filter->SetLocalMaximumThreshold(random.uniform(-100.0, 100.0));
  filter->SetDepthShadingAmbient(random.uniform(0.0, 0.6));
  filter->SetDepthShadingChangeRate(random.uniform(0.1, 0.4));
  const double* const centre = image->GetCenter();
  if (random.oneIn(2))
  {
    filter->SlabOn();
    filter->SetSlabThickness(random.uniform(1.0, 6.0));
    const double off[3] = { random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0),
      random.uniform(-2.0, 2.0) };
    filter->SetSlabCenter(centre[0] + off[0], centre[1] + off[1], centre[2] + off[2]);
  }
  if (random.oneIn(2))
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

/// Displaces the slices of an image along its first two axes.
void skew(vtkImageData* image, reference::Random& random)
{
  vtkNew<vtkMatrix3x3> shear, direction;
  shear->SetElement(0, 2, random.uniform(-1.5, 1.5));
  shear->SetElement(1, 2, random.uniform(-1.5, 1.5));
  vtkMatrix3x3::Multiply3x3(image->GetDirectionMatrix(), shear, direction);
  image->SetDirectionMatrix(direction);
}

/// A view from anywhere, of some pixels, whose principal axis the oracle knows.
glm::dvec3 lookAtRandom(Filter* filter, vtkImageData* image, reference::Random& random)
{
  glm::dvec3 direction, up;
  reference::ShearView view;
  do
  {
    direction = coretesting::anyDirection(random);
    up = coretesting::anyDirection(random);
    filter->SetViewDirection(direction.x, direction.y, direction.z);
    filter->SetViewUp(up.x, up.y, up.z);
    const int size[2] = { random.uniform(1, 28), random.uniform(1, 28) };
    filter->SetOutputSize(size[0], size[1]);
    // Most of them narrower than voxels. Wider ones make an overview.
    const double* const voxel = image->GetSpacing();
    const double least = std::min({ voxel[0], voxel[1], voxel[2] });
    const double x = least * random.uniform(0.2, 1.5), y = least * random.uniform(0.2, 1.5);
    filter->SetOutputSpacing(x, y);
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
      const auto volume = reference::uniformNoise<T>(size, random);
      const auto image = imageOf(volume);
      coretesting::placeAtRandom(image, random, true);
      if (random.oneIn(2))
      {
        skew(image, random);
      }
      const auto filter = projectionOf(image);
      glm::dvec3 focus = lookAtRandom(filter, image, random);
      chooseAtRandom(filter, image, std::is_integral_v<T>, random);
      if (random.oneIn(2))
      {
        focus += 2.0 * coretesting::anyDirection(random);
        filter->CenterOnVolumeOff();
        filter->SetFocalPoint(focus.x, focus.y, focus.z);
      }
      compare(check, volume, filter, image, focus, count);
    });
  all.hits += count.hits;
  all.ofOverviews += count.ofOverviews;
  std::cout << "type " << type << ": largest error " << count.worst << " of the bound, "
            << count.hits << " of " << count.pixels << " pixels with a sample, "
            << count.ofOverviews << " of overviews\n";
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
  check(all.ofOverviews > 60 || reference::scenesRun() < 80, "only ", all.ofOverviews,
    " pixels of overviews with a sample");
  testLibraries(check);
  return check.exitCode();
}
