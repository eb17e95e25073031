// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Random.h
 * @brief   random numbers that are the same on every machine, and that scenes record
 */
#ifndef reference_Random_h
#define reference_Random_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace reference
{

/**
 * The n of SPLATTINGMIP_TEST_SEED.
 */
inline std::uint64_t seedShift()
{
  static const char* const text = std::getenv("SPLATTINGMIP_TEST_SEED");
  static const std::uint64_t shift = text ? std::strtoull(text, nullptr, 10) : 0;
  return shift;
}

/**
 * What has been drawn, as numbers. 0 is the simplest value of each draw: 0, else 1, else the lower
 * limit; false; the first of several. Of floating point, small choices have few binary digits.
 */
using Choices = std::vector<std::uint64_t>;

/**
 * The choices of one scene: records them, or repeats given ones, after their end zeros.
 */
struct Tape
{
  Choices choices;                ///< drawn so far
  const Choices* given = nullptr; ///< to repeat
  std::vector<std::string> notes; ///< of what is repeated, see Random::note()
  std::size_t longest = SIZE_MAX; ///< a scene that draws more choices than that is given up

  struct TooLong : std::runtime_error
  {
    TooLong() : std::runtime_error("A scene draws too many numbers.") {}
  };

  /**
   * @param count  there are so many choices; 0 stands for 2^64
   */
  template <class Draw>
  std::uint64_t next(std::uint64_t count, Draw&& draw)
  {
    const std::size_t n = this->choices.size();
    if (n >= this->longest)
    {
      throw TooLong();
    }
    std::uint64_t choice = 0;
    if (!this->given)
    {
      choice = draw();
    }
    else if (n < this->given->size())
    {
      choice = count == 0 ? (*this->given)[n] : (*this->given)[n] % count;
    }
    this->choices.push_back(choice);
    return choice;
  }
};

/**
 * Sebastiano Vigna's splitmix64: 64 random bits per call, any seed.
 *
 * C++ leaves the order open in which the arguments of a call are computed. So no two draws may be
 * arguments of one call, or compilers would try different scenes.
 */
class Random
{
public:
  Random(std::uint64_t seed) : State(seed + shift()) {}
  Random(std::uint64_t seed, Tape& tape) : State(seed + shift()), Record(&tape) {}

  /// What SPLATTINGMIP_TEST_SEED adds to all seeds.
  static std::uint64_t shift() { return seedShift() * 1000003; }

  std::uint64_t bits() { return this->choose(0, 0); }

  /**
   * Uniform in [low, high]; for floating types in [low, high) up to rounding.
   */
  template <class T>
  T uniform(T low, T high)
  {
    if constexpr (std::is_floating_point<T>::value)
    {
      const bool isFree = !this->Record && !this->IsSimplest;
      const std::uint64_t digits = isFree ? this->draw() >> 11 : this->chooseDigits();
      if (digits == 0 && !isFree)
      {
        return low <= T(0) && high > T(0) ? T(0) : low <= T(1) && high > T(1) ? T(1) : low;
      }
      const double unit = static_cast<double>(digits) * 0x1p-53;
      return static_cast<T>(low + (static_cast<double>(high) - low) * unit);
    }
    else
    {
      // Unsigned 64-bit arithmetic wraps to the right result for signed types too. The range of a
      // 64-bit type has 2^64 values, a number that itself wraps to 0.
      const std::uint64_t first = static_cast<std::uint64_t>(low);
      const std::uint64_t last = static_cast<std::uint64_t>(high);
      const std::uint64_t simplest = low > T(0) ? 0 : high < T(0) ? last - first : 0 - first;
      return static_cast<T>(first + this->choose(last - first + 1, simplest));
    }
  }

  /// What happens once in so many times, and not in the simplest scene.
  bool oneIn(int times) { return this->uniform(0, times - 1) == times - 1; }
  /// What happens with a probability, and not in the simplest scene.
  bool chance(double probability) { return this->uniform(0.0, 1.0) >= 1.0 - probability; }
  /// 1 or -1.
  double sign() { return this->oneIn(2) ? -1.0 : 1.0; }
  /// One of several values, of which the first is the simplest.
  template <class T, std::size_t N>
  T among(const T (&values)[N])
  {
    return values[this->uniform<std::size_t>(0, N - 1)];
  }

  /// Random numbers for many voxels: one choice of the scene. All simplest values, if it is 0.
  Random fork()
  {
    const std::uint64_t seed = this->bits();
    Random result(seed);
    result.IsSimplest = this->IsSimplest || (this->Record && seed == 0);
    return result;
  }

  /// Describes what has been drawn, for a scene that fails.
  template <class... Text>
  void note(const Text&... text)
  {
    if (this->Record && this->Record->given)
    {
      std::ostringstream stream;
      (stream << ... << text);
      this->Record->notes.push_back(stream.str());
    }
  }

private:
  std::uint64_t draw()
  {
    this->State += 0x9E3779B97F4A7C15u;
    std::uint64_t z = this->State;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  /// The order of 53 bits is reversed: few digits of a fraction are a small number.
  static std::uint64_t reversed(std::uint64_t bits)
  {
    std::uint64_t result = 0;
    for (int n = 0; n < 53; ++n)
    {
      result = (result << 1) | ((bits >> n) & 1);
    }
    return result;
  }

  /// The 53 digits of a fraction. Choices have the last one first.
  std::uint64_t chooseDigits()
  {
    return this->IsSimplest ? 0
                            : reversed(this->Record->next(std::uint64_t(1) << 53,
                                [this] { return reversed(this->draw() >> 11); }));
  }

  /// A number below count, or of 64 bits where it is 0. The choice counts from the simplest one on.
  std::uint64_t choose(std::uint64_t count, std::uint64_t simplest)
  {
    if (this->IsSimplest)
    {
      return simplest;
    }
    const auto number = [&] { return count == 0 ? this->draw() : this->draw() % count; };
    if (!this->Record)
    {
      return number();
    }
    const std::uint64_t below = count - simplest;
    const std::uint64_t choice = this->Record->next(count,
      [&]
      {
        const std::uint64_t n = number();
        return n >= simplest ? n - simplest : n + below;
      });
    return choice < below || count == 0 ? choice + simplest : choice - below;
  }

  std::uint64_t State;
  Tape* Record = nullptr;
  bool IsSimplest = false;
};
}

#endif
