// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The voxel types of the core: VTK's thirteen numeric types become ten, because types of equal size
 * and sign are the same.
 */
#ifndef splattingScalarType_h
#define splattingScalarType_h

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace splatting
{
enum class ScalarType
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float32,
  Float64
};

/**
 * The type in which worksheets are summed: float for 8- and 16-bit integers, which it holds
 * exactly, and float; double for wider types.
 */
template <class T>
struct AccumulatorOf
{
  using type = double;
};
// clang-format off
template <> struct AccumulatorOf<std::int8_t> { using type = float; };
template <> struct AccumulatorOf<std::uint8_t> { using type = float; };
template <> struct AccumulatorOf<std::int16_t> { using type = float; };
template <> struct AccumulatorOf<std::uint16_t> { using type = float; };
template <> struct AccumulatorOf<float> { using type = float; };
// clang-format on
template <class T>
using Accumulator = typename AccumulatorOf<T>::type;

/**
 * The ScalarType of a C++ type.
 */
template <class T>
constexpr ScalarType scalarTypeOf();
// clang-format off
template <> constexpr ScalarType scalarTypeOf<std::int8_t>() { return ScalarType::Int8; }
template <> constexpr ScalarType scalarTypeOf<std::uint8_t>() { return ScalarType::UInt8; }
template <> constexpr ScalarType scalarTypeOf<std::int16_t>() { return ScalarType::Int16; }
template <> constexpr ScalarType scalarTypeOf<std::uint16_t>() { return ScalarType::UInt16; }
template <> constexpr ScalarType scalarTypeOf<std::int32_t>() { return ScalarType::Int32; }
template <> constexpr ScalarType scalarTypeOf<std::uint32_t>() { return ScalarType::UInt32; }
template <> constexpr ScalarType scalarTypeOf<std::int64_t>() { return ScalarType::Int64; }
template <> constexpr ScalarType scalarTypeOf<std::uint64_t>() { return ScalarType::UInt64; }
template <> constexpr ScalarType scalarTypeOf<float>() { return ScalarType::Float32; }
template <> constexpr ScalarType scalarTypeOf<double>() { return ScalarType::Float64; }
// clang-format on

// For explicit instantiations: f of each voxel type.
#define SPLATTING_INTEGERS(f)                                                                      \
  f(std::int8_t) f(std::uint8_t) f(std::int16_t) f(std::uint16_t) f(std::int32_t) f(std::uint32_t) \
    f(std::int64_t) f(std::uint64_t)
#define SPLATTING_TYPES(f) SPLATTING_INTEGERS(f) f(float) f(double)

/**
 * Calls f with a null pointer to the C++ type of `type`, and returns its result.
 */
template <class F>
decltype(auto) dispatch(ScalarType type, F&& f)
{
  switch (type)
  {
    case ScalarType::Int8:
      return f(static_cast<std::int8_t*>(nullptr));
    case ScalarType::UInt8:
      return f(static_cast<std::uint8_t*>(nullptr));
    case ScalarType::Int16:
      return f(static_cast<std::int16_t*>(nullptr));
    case ScalarType::UInt16:
      return f(static_cast<std::uint16_t*>(nullptr));
    case ScalarType::Int32:
      return f(static_cast<std::int32_t*>(nullptr));
    case ScalarType::UInt32:
      return f(static_cast<std::uint32_t*>(nullptr));
    case ScalarType::Int64:
      return f(static_cast<std::int64_t*>(nullptr));
    case ScalarType::UInt64:
      return f(static_cast<std::uint64_t*>(nullptr));
    case ScalarType::Float32:
      return f(static_cast<float*>(nullptr));
    case ScalarType::Float64:
      break;
  }
  return f(static_cast<double*>(nullptr));
}

/**
 * The least and the greatest value of type T, infinities included.
 */
template <class T>
constexpr T leastValue()
{
  using Limits = std::numeric_limits<T>;
  return Limits::has_infinity ? -Limits::infinity() : Limits::lowest();
}
template <class T>
constexpr T greatestValue()
{
  using Limits = std::numeric_limits<T>;
  return Limits::has_infinity ? Limits::infinity() : Limits::max();
}

/**
 * The type that holds averages of scalars of a type: its Accumulator.
 */
inline ScalarType averageType(ScalarType type)
{
  return dispatch(type,
    [](auto* null) { return scalarTypeOf<Accumulator<std::remove_pointer_t<decltype(null)>>>(); });
}

/**
 * Bytes of a scalar.
 */
inline std::size_t sizeOf(ScalarType type)
{
  return dispatch(type, [](auto* null) { return sizeof(std::remove_pointer_t<decltype(null)>); });
}
}

#endif
