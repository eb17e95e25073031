// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random slabs of vtkSplattingMIPReslice at every pixel: against the definition, and against
// vtkImageReslice with ten times as many samples.
#include "ResliceTesting.h"

#include "vtkSplattingMIPReslice.h"

#include "vtkDataArray.h"
#include "vtkImageStencilData.h"

namespace
{
using reference::Checks;
using reference::Random;
using namespace reslicetesting;

template <class T>
vtkSmartPointer<vtkImageData> randomImage(Random& random, bool isWide, int components, bool dyadic)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  int extent[6];
  double spacing[3], origin[3];
  for (int a = 0; a < 3; ++a)
  {
    extent[2 * a] = random.uniform(-3, 3);
    extent[2 * a + 1] = extent[2 * a] + (!random.oneIn(6) ? random.uniform(1, 11) : 0);
    spacing[a] = dyadic ? std::ldexp(1.0, random.uniform(-1, 1)) : random.uniform(0.3, 2.0);
    origin[a] = dyadic ? 0.25 * random.uniform(-9, 9) : random.uniform(-9.0, 9.0);
  }
  image->SetExtent(extent);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  image->AllocateScalars(vtkTypeTraits<T>::VTK_TYPE_ID, components);
  // Doubles have all integers of up to 50 bits.
  const double most = !isWide ? 100.0
    : std::is_integral_v<T>   ? std::min(0x1p50, double(std::numeric_limits<T>::max()))
                              : 1e7;
  const double least = std::is_unsigned_v<T> ? 0.0 : -most;
  T* const voxels = static_cast<T*>(image->GetScalarPointer());
  // Lines between octants would be ambiguous.
  const bool hasHoles = std::is_floating_point_v<T> && !dyadic && random.oneIn(3);
  Random many = random.fork();
  for (vtkIdType n = 0; n < image->GetNumberOfPoints() * components; ++n)
  {
    voxels[n] = static_cast<T>(many.uniform(least, most));
    if (hasHoles && many.oneIn(10))
    {
      voxels[n] = std::numeric_limits<T>::quiet_NaN();
    }
  }
  return image;
}

glm::dmat4 randomMatrix(Random& random)
{
  const double angle = random.uniform(0.0, 6.3);
  glm::dmat4 m = glm::rotate(glm::dmat4(1.0), angle, coretesting::anyDirection(random));
  if (random.oneIn(2)) // with shear and scale
  {
    for (int n = 0; n < 3; ++n)
    {
      m[n] *= random.uniform(0.6, 1.4);
      m[n][(n + 1) % 3] += random.uniform(-0.4, 0.4);
    }
  }
  return m;
}

/// Axes along those of the image, so that lines run through voxels and along sides.
void alignAxes(Settings& s, vtkImageData* image, Random& random)
{
  s.axes = glm::dmat4(0.0);
  s.axes[3][3] = 1.0;
  const int first = random.uniform(0, 2), step = random.uniform(1, 2);
  for (int n = 0; n < 3; ++n)
  {
    const int a = (first + n * step) % 3;
    s.axes[n][a] = random.sign();
    s.spacing[n] = image->GetSpacing()[a] * (random.oneIn(2) ? 1.0 : 0.5);
  }
}

Settings randomSettings(vtkImageData* image, bool isAligned, Random& random)
{
  Settings s;
  for (int a = 0; a < 3; ++a)
  {
    s.extent[2 * a] = random.uniform(-4, 4);
    s.extent[2 * a + 1] = s.extent[2 * a] + random.uniform(0, a < 2 ? 14 : 2);
    s.spacing[a] = random.uniform(0.2, 1.5);
    s.origin[a] = 0.25 * random.uniform(-9, 9);
  }
  s.slices = random.uniform(2, 9);
  s.fraction = random.oneIn(2) ? 1.0 : random.uniform(-0.9, 0.9);
  s.minima = random.oneIn(3);
  s.trapezoid = random.oneIn(2);
  s.border = !random.oneIn(3);
  const double thicknesses[] = { 0.5, 0.5, 0.0, 0.25, 0.75 };
  s.thickness = thicknesses[random.uniform(0, 4)];
  s.hasTransform = !isAligned && random.uniform(0, 1);
  if (isAligned)
  {
    alignAxes(s, image, random);
  }
  else
  {
    s.axes = randomMatrix(random);
    s.transform = s.hasTransform ? randomMatrix(random) : s.transform;
  }
  // The middle of the output is at half a voxel, or anywhere.
  glm::dvec3 index, target;
  for (int a = 0; a < 3; ++a)
  {
    index[a] = std::floor(0.5 * (s.extent[2 * a] + s.extent[2 * a + 1]));
    const int last = image->GetDimensions()[a] - 1;
    target[a] =
      isAligned ? 0.5 * random.uniform(-1, 2 * last + 1) : random.uniform(-0.5, last + 0.5);
  }
  const glm::dvec3 missed = target - s.voxelAt(image, index);
  const glm::dvec3 spacing(image->GetSpacing()[0], image->GetSpacing()[1], image->GetSpacing()[2]);
  const glm::dmat3 linear = s.hasTransform ? glm::dmat3(s.transform) : glm::dmat3(1.0);
  s.axes[3] += glm::dvec4(glm::inverse(linear) * (missed * spacing), 0.0);
  return s;
}

/// A value as the output's type stores it, if it is rounded up or down by `error` before.
template <class R>
std::array<R, 2> stored(R value, R error, const Settings& s, vtkImageData* output)
{
  const R u = (value + R(s.shift)) * R(s.scale);
  R low = u - std::fabs(R(s.scale)) * error, high = u + std::fabs(R(s.scale)) * error;
  const int type = output->GetScalarType();
  if (type == VTK_FLOAT || type == VTK_DOUBLE)
  {
    const R epsilon = type == VTK_FLOAT ? std::numeric_limits<float>::epsilon()
                                        : std::numeric_limits<double>::epsilon();
    return { low - epsilon * std::fabs(u), high + epsilon * std::fabs(u) };
  }
  for (R* const x : { &low, &high })
  {
    *x = std::floor(*x + R(0.5) + R(Tolerance));
    *x = std::min(std::max(*x, R(output->GetScalarTypeMin())), R(output->GetScalarTypeMax()));
  }
  return { low, high };
}

/// In rows of the output, each with one span or none.
vtkSmartPointer<vtkImageStencilData> randomStencil(const int extent[6], Random& random)
{
  auto stencil = vtkSmartPointer<vtkImageStencilData>::New();
  stencil->SetExtent(extent);
  stencil->AllocateExtents();
  for (int z = extent[4]; z <= extent[5]; ++z)
  {
    for (int y = extent[2]; y <= extent[3]; ++y)
    {
      const int first = random.uniform(extent[0], extent[1]);
      const int last = random.uniform(first - 1, extent[1]);
      if (first <= last)
      {
        stencil->InsertNextExtent(first, last, y, z);
      }
    }
  }
  return stencil;
}

struct Counts
{
  long samples = 0, ambiguous = 0, dense = 0;
};

/// The filter's output against the oracle; isNarrow if voxels never equal the background.
template <class T>
void compareWithOracle(vtkSplattingMIPReslice* filter, vtkImageData* image, const Settings& s,
  bool isNarrow, Checks& check, Counts& counts)
{
  using R = Real<T>;
  vtkImageData* const output = filter->GetOutput();
  vtkImageStencilData* const stencil = filter->GetStencil();
  vtkImageStencilData* const meets = filter->GetStencilOutput();
  const int components = output->GetNumberOfScalarComponents();
  for (int c = 0; c < components; ++c)
  {
    Oracle<T> oracle(image, s, std::max(s.firstComponent, 0) + c);
    for (int z = s.extent[4]; z <= s.extent[5]; ++z)
    {
      oracle.setSlice(z);
      for (int n = 0, y = s.extent[2]; y <= s.extent[3]; ++y)
      {
        for (int x = s.extent[0]; x <= s.extent[1]; ++x, ++n)
        {
          const R value = output->GetScalarComponentAsDouble(x, y, z, c);
          const R background = c < 4 ? s.background[c] : 0.0;
          const bool isIn = !stencil || stencil->IsInside(x, y, z);
          const auto fits = [&](const typename Oracle<T>::Sample& sample)
          {
            const auto bounds = stored(sample.value, oracle.error(), s, output);
            return sample.exists && isIn ? value >= bounds[0] && value <= bounds[1]
                                         : value == background;
          };
          const auto sample = oracle.at(x - s.extent[0], y - s.extent[2]);
          bool isRight = fits(sample);
          counts.samples += sample.exists && isIn;
          for (int a = 0; a < 6 && !isRight; ++a)
          {
            glm::dvec3 shift(0.0);
            shift[a / 2] = a % 2 ? Beside : -Beside;
            isRight = fits(oracle.at(x - s.extent[0], y - s.extent[2], shift));
            counts.ambiguous += isRight;
          }
          check(isRight, "pixel ", x, ", ", y, ", ", z, ", component ", c, ": ", double(value),
            ", not ", double(sample.value), sample.exists && isIn ? "" : " (background)");
          if (meets && filter->GetGenerateStencilOutput() && isNarrow && components == 1)
          {
            check((meets->IsInside(x, y, z) != 0) == (value != background), "output stencil at ", x,
              ", ", y, ", ", z);
          }
        }
      }
    }
  }
}

/// The filter's values against vtkImageReslice's with ten times as many samples.
template <class T>
void compareWithDense(
  vtkSplattingMIPReslice* filter, vtkImageData* image, Settings s, Checks& check, Counts& counts)
{
  s.shift = 0.0;
  s.scale = 1.0;
  s.type = VTK_DOUBLE;
  s.background[0] = s.background[1] = s.background[2] = s.background[3] = 1e300;
  s.apply(filter);
  filter->Update();
  Settings samples = s;
  samples.slices = 10 * (s.slices - 1) + 1;
  samples.fraction = 0.1 * s.fraction;
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(image);
  reslice->OptimizationOff();
  samples.apply(reslice);
  reslice->Update();
  vtkImageData* const exact = filter->GetOutput();
  vtkImageData* const dense = reslice->GetOutput();
  const double sense = s.minima ? -1.0 : 1.0;
  for (int c = 0; c < std::min(exact->GetNumberOfScalarComponents(), 4); ++c)
  {
    const Oracle<T> oracle(image, s, std::max(s.firstComponent, 0) + c);
    const double error = static_cast<double>(oracle.error()) + oracle.rounding();
    const double change = oracle.change(samples.fraction);
    for (int z = s.extent[4]; z <= s.extent[5]; ++z)
    {
      for (int y = s.extent[2]; y <= s.extent[3]; ++y)
      {
        for (int x = s.extent[0]; x <= s.extent[1]; ++x)
        {
          const double sampled = dense->GetScalarComponentAsDouble(x, y, z, c);
          if (sampled != 1e300)
          {
            const double more = sense * (exact->GetScalarComponentAsDouble(x, y, z, c) - sampled);
            check(more >= -error && more <= change + error, "pixel ", x, ", ", y, ", ", z, " is ",
              more, " above vtkImageReslice's, not 0 to ", change);
            ++counts.dense;
          }
        }
      }
    }
  }
}

bool hasNaN(vtkImageData* image)
{
  vtkDataArray* const scalars = image->GetPointData()->GetScalars();
  bool found = false;
  for (vtkIdType n = 0; n < scalars->GetNumberOfValues(); ++n)
  {
    const int components = scalars->GetNumberOfComponents();
    found = found || std::isnan(scalars->GetComponent(n / components, n % components));
  }
  return found;
}

template <class T>
void testSlabs(Checks& check)
{
  Counts counts;
  reference::forScenes(coretesting::seriesOf<T>("slabs"), 320,
    [&](int, Random& random)
    {
      const bool isAligned = random.oneIn(3), isWide = random.oneIn(2);
      const int components = !random.oneIn(4) ? 1 : random.uniform(2, 6);
      const auto image = randomImage<T>(random, isWide, components, isAligned);
      Settings s = randomSettings(image, isAligned, random);
      s.firstComponent = components > 1 ? random.uniform(0, 2) % components : 0;
      s.components = random.uniform(-1, 3);
      if (!isWide && random.oneIn(2))
      {
        const double scales[] = { 0.5, -0.25, 1.0 };
        s.shift = random.uniform(-10.0, 10.0);
        s.scale = scales[random.uniform(0, 2)];
      }
      const int types[] = { -1, -1, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT, VTK_DOUBLE };
      s.type = types[random.uniform(0, 5)];
      vtkNew<vtkSplattingMIPReslice> filter;
      filter->SetInputData(image);
      s.apply(filter);
      filter->SetGenerateStencilOutput(random.uniform(0, 1));
      if (random.oneIn(4))
      {
        filter->SetStencilData(randomStencil(s.extent, random));
      }
      filter->Update();
      check(filter->GetSlabIsExact(), "the slab is not exact");
      compareWithOracle<T>(filter, image, s, !isWide, check, counts);
      // The same voxels with another border.
      s.border = !s.border;
      s.apply(filter);
      filter->Update();
      compareWithOracle<T>(filter, image, s, !isWide, check, counts);
      if (!(std::is_integral_v<T> && sizeof(T) == 8) && !filter->GetStencil() && !hasNaN(image))
      {
        compareWithDense<T>(filter, image, s, check, counts);
      }
    });
  std::cout << coretesting::seriesOf<T>("slabs") << ": samples " << counts.samples << ", ambiguous "
            << counts.ambiguous << ", compared with vtkImageReslice " << counts.dense << std::endl;
  if (reference::onlyScene().empty())
  {
    check(counts.samples > 0 && counts.ambiguous < 10 + counts.samples / 100,
      "too few samples are unambiguous");
  }
}
}

int TestReslice(int, char*[])
{
  Checks check;
  coretesting::forEachType(
    [&](auto* null) { testSlabs<std::remove_pointer_t<decltype(null)>>(check); });
  return check.exitCode();
}
