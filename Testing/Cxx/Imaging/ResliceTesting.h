// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of vtkSplattingMIPReslice share: the properties of slabs, and their definition,
 * computed cell by cell.
 */
#ifndef ResliceTesting_h
#define ResliceTesting_h

#include "CellOracle.h"
#include "ProjectionTesting.h"

#include "vtkAbstractImageInterpolator.h"
#include "vtkImageReslice.h"
#include "vtkMatrix4x4.h"
#include "vtkTransform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace reslicetesting
{
/// Beyond its border, in voxels, the input is this much larger.
inline constexpr double Widening = 0x1p-19;
/// VTK's tolerance of positions, in voxels, and of rounding.
inline constexpr double Tolerance = 0x1p-17;
/// A pixel is ambiguous if a line this many voxels beside its own has another value.
inline constexpr double Beside = 0x1p-20;
/// A line that crosses the input over less has no value.
inline constexpr double Shortest = 0x1p-20;

template <class T>
constexpr bool IsWide = sizeof(T) > 4 || (std::is_integral_v<T> && sizeof(T) > 2);
template <class T>
using Real = std::conditional_t<IsWide<T>, long double, double>;

/// Properties of a slab and where it lies.
struct Settings
{
  glm::dmat4 axes{ 1.0 }, transform{ 1.0 };
  bool hasTransform = false;
  glm::dvec3 spacing{ 1.0 }, origin{ 0.0 };
  int extent[6] = { 0, 0, 0, 0, 0, 0 };
  int slices = 2;
  double fraction = 1.0;
  bool minima = false, border = true, trapezoid = false;
  double thickness = 0.5;
  int firstComponent = 0, components = -1;
  double shift = 0.0, scale = 1.0;
  int type = -1;
  double background[4] = { 111.0, 112.0, 113.0, 114.0 };

  void apply(vtkImageReslice* reslice) const
  {
    vtkNew<vtkMatrix4x4> matrix;
    const auto copy = [&](const glm::dmat4& m)
    {
      for (int n = 0; n < 16; ++n)
      {
        matrix->SetElement(n % 4, n / 4, m[n / 4][n % 4]);
      }
    };
    copy(this->axes);
    vtkNew<vtkMatrix4x4> resliceAxes;
    resliceAxes->DeepCopy(matrix);
    reslice->SetResliceAxes(resliceAxes);
    copy(this->transform);
    vtkNew<vtkTransform> linear;
    linear->SetMatrix(matrix);
    reslice->SetResliceTransform(this->hasTransform ? linear.Get() : nullptr);
    reslice->SetOutputSpacing(&this->spacing.x);
    reslice->SetOutputOrigin(&this->origin.x);
    reslice->SetOutputExtent(this->extent);
    reslice->SetInterpolationModeToLinear();
    reslice->SetSlabMode(this->minima ? VTK_IMAGE_SLAB_MIN : VTK_IMAGE_SLAB_MAX);
    reslice->SetSlabNumberOfSlices(this->slices);
    reslice->SetSlabSliceSpacingFraction(this->fraction);
    reslice->SetSlabTrapezoidIntegration(this->trapezoid);
    reslice->SetBorder(this->border);
    reslice->SetBorderThickness(this->thickness);
    reslice->GetInterpolator()->SetComponentOffset(this->firstComponent);
    reslice->GetInterpolator()->SetComponentCount(this->components);
    reslice->SetScalarShift(this->shift);
    reslice->SetScalarScale(this->scale);
    reslice->SetOutputScalarType(this->type);
    reslice->SetBackgroundColor(this->background);
  }

  /// The voxel, first one 0, at an output index.
  glm::dvec3 voxelAt(vtkImageData* image, const glm::dvec3& index) const
  {
    glm::dvec4 p = this->axes * glm::dvec4(this->origin + this->spacing * index, 1.0);
    p = this->hasTransform ? this->transform * p : p;
    glm::dvec3 voxel;
    for (int a = 0; a < 3; ++a)
    {
      voxel[a] =
        (p[a] - image->GetOrigin()[a]) / image->GetSpacing()[a] - image->GetExtent()[2 * a];
    }
    return voxel;
  }
};

/// The definition of an output's slabs.
template <class T>
class Oracle
{
public:
  using R = Real<T>;
  using Sample = reference::CellSample<R>;

  Oracle(vtkImageData* image, const Settings& settings, int component) : S(settings)
  {
    glm::ivec3 size;
    image->GetDimensions(&size.x);
    // The outermost voxels are repeated once, and half-spaces cut the field at the border.
    this->Scene.size = size + 2;
    this->Scene.showsBoxes = false;
    const int* const e = image->GetExtent();
    for (int z = -1; z <= size.z; ++z)
    {
      for (int y = -1; y <= size.y; ++y)
      {
        for (int x = -1; x <= size.x; ++x)
        {
          const glm::ivec3 p = glm::clamp(glm::ivec3(x, y, z), glm::ivec3(0), size - 1);
          this->Scene.voxels.push_back(static_cast<const T*>(
            image->GetScalarPointer(p.x + e[0], p.y + e[2], p.z + e[4]))[component]);
        }
      }
    }
    const glm::dvec3 zero = settings.voxelAt(image, glm::dvec3(0.0)) + 1.0;
    for (int a = 0; a < 3; ++a)
    {
      glm::dvec3 unit(0.0);
      unit[a] = 1.0;
      this->ToVoxel[a] = glm::dvec4(settings.voxelAt(image, unit) + 1.0 - zero, 0.0);
      const double border = std::max(
        { settings.border ? settings.thickness : 0.0, Tolerance, size[a] == 1 ? 0.5 : 0.0 });
      glm::dvec4 h(0.0);
      h[a] = 1.0;
      h.w = border + Widening - 1.0;
      this->Borders.push_back(h);
      h[a] = -1.0;
      h.w = size[a] + border + Widening;
      this->Borders.push_back(h);
    }
    this->ToVoxel[3] = glm::dvec4(zero, 1.0);
    const glm::dmat4 toOutput = glm::inverse(this->ToVoxel);
    this->Scene.viewport = { settings.extent[1] - settings.extent[0] + 1,
      settings.extent[3] - settings.extent[2] + 1 };
    for (int c = 0; c < 4; ++c)
    {
      for (int r = 0; r < 4; ++r)
      {
        const double size2 = r < 2 ? this->Scene.viewport[r] : 2;
        const double offset = r < 2 && c == 3 ? 0.5 - settings.extent[2 * r] : 0.0;
        this->Scene.indexToClip[c][r] =
          r < 3 ? 2.0 * (toOutput[c][r] + offset) / size2 - (r < 2 && c == 3) : c == 3;
      }
    }
    const double half = 0.5 * (settings.slices - 1) * std::abs(settings.fraction);
    for (int c = 0; c < 4; ++c)
    {
      this->First[c] = toOutput[c][2] + (c == 3 ? half : 0.0);
      this->Last[c] = -toOutput[c][2] + (c == 3 ? half : 0.0);
    }
    R low = HUGE_VAL, high = -HUGE_VAL;
    for (const R voxel : this->Scene.voxels)
    {
      low = std::isfinite(voxel) ? std::min(low, voxel) : low;
      high = std::isfinite(voxel) ? std::max(high, voxel) : high;
      this->Largest =
        std::isfinite(voxel) ? std::max(this->Largest, std::fabs(voxel)) : this->Largest;
    }
    const R epsilon =
      IsWide<T> ? std::numeric_limits<double>::epsilon() : std::numeric_limits<float>::epsilon();
    // Positions are computed in double, from matrices with numbers of up to about 100.
    this->Error = low <= high ? (IsWide<T> ? R(1e-12) : R(1e-6)) * (high - low) +
        epsilon * this->Largest + this->changeOver(glm::dvec3(0x1p-40))
                              : R(0);
  }

  void setSlice(int z)
  {
    this->Scene.halfSpaces = this->Borders;
    this->Scene.halfSpaces.push_back(this->First - glm::dvec4(0.0, 0.0, 0.0, z));
    this->Scene.halfSpaces.push_back(this->Last + glm::dvec4(0.0, 0.0, 0.0, z));
  }
  /// Of pixel (x, y), counted from the extent's first one.
  Sample at(int x, int y, const glm::dvec3& shift = glm::dvec3(0.0)) const
  {
    const reference::CellOracle<R> oracle(this->Scene);
    const reference::CellRay<R> ray = oracle.ray(x, y, shift);
    return ray.far - ray.near > R(Shortest) ? oracle.largest(ray, this->S.minima) : Sample();
  }
  R error() const { return this->Error; }
  /// A bound for samples along z that are `step` slices apart: the field's change over that.
  double change(double step) const { return this->changeOver(step * glm::dvec3(this->ToVoxel[2])); }
  /// vtkImageReslice rounds positions to 2^-16 voxels, and sums eight products.
  double rounding() const
  {
    return this->changeOver(glm::dvec3(0x1p-16)) +
      8.0 * std::numeric_limits<double>::epsilon() * static_cast<double>(this->Largest);
  }

private:
  /// The most by which the field can change over a distance.
  double changeOver(const glm::dvec3& distance) const
  {
    double sum = 0.0;
    for (int a = 0, stride = 1; a < 3; stride *= this->Scene.size[a], ++a)
    {
      R largest = 0;
      for (std::size_t n = stride; n < this->Scene.voxels.size(); ++n)
      {
        if (n / stride % this->Scene.size[a] != 0)
        {
          const R step = this->Scene.voxels[n] - this->Scene.voxels[n - stride];
          largest = std::max(largest, std::fabs(step));
        }
      }
      sum += std::abs(distance[a]) * static_cast<double>(largest);
    }
    return sum;
  }

  const Settings& S;
  reference::CellScene<R> Scene;
  glm::dmat4 ToVoxel{ 1.0 };
  std::vector<glm::dvec4> Borders;
  glm::dvec4 First{ 0.0 }, Last{ 0.0 };
  R Largest = 0, Error = 0;
};

}

#endif
