// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Random.h
 * @brief   random numbers that are the same on every machine, and the scenes of random tests
 *
 * Three environment variables steer all random tests:
 *
 * - SPLATTINGMIP_TEST_SEED=n (default 0): other random numbers for each n. A test must pass for
 *   any n.
 * - SPLATTINGMIP_TEST_SCENES=p (default 25): p percent of each series' scenes, at least one.
 * - SPLATTINGMIP_TEST_SCENE=SERIES/NUMBER: this scene alone. A check that fails prints the name.
 */
#ifndef reference_Random_h
#define reference_Random_h

#include <cstdint>
#include <cstdlib>
#include <string>
#include <type_traits>

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
 * Sebastiano Vigna's splitmix64: 64 random bits per call, any seed.
 *
 * C++ leaves the order open in which the arguments of a call are computed. So no two draws may be
 * arguments of one call, or compilers would try different scenes.
 */
class Random
{
public:
  explicit Random(std::uint64_t seed) : State(seed + shift()) {}

  /// What SPLATTINGMIP_TEST_SEED adds to all seeds.
  static std::uint64_t shift() { return seedShift() * 1000003; }

  std::uint64_t bits()
  {
    this->State += 0x9E3779B97F4A7C15u;
    std::uint64_t z = this->State;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  /**
   * Uniform in [low, high]; for floating types in [low, high) up to rounding.
   */
  template <class T>
  T uniform(T low, T high)
  {
    if constexpr (std::is_floating_point<T>::value)
    {
      const double unit = static_cast<double>(this->bits() >> 11) * 0x1p-53;
      return static_cast<T>(low + (static_cast<double>(high) - low) * unit);
    }
    else
    {
      // Unsigned 64-bit arithmetic wraps to the right result for signed types too. The range of a
      // 64-bit type has 2^64 values, a number that itself wraps to 0.
      const std::uint64_t first = static_cast<std::uint64_t>(low);
      const std::uint64_t count = static_cast<std::uint64_t>(high) - first + 1;
      return static_cast<T>(first + (count == 0 ? this->bits() : this->bits() % count));
    }
  }

private:
  std::uint64_t State;
};

/**
 * The scene of SPLATTINGMIP_TEST_SCENE, empty if all are run. What counts over all scenes of a
 * series ("enough of them are cut") is checked only if it is empty.
 */
inline const std::string& onlyScene()
{
  static const char* const text = std::getenv("SPLATTINGMIP_TEST_SCENE");
  static const std::string scene = text ? text : "";
  return scene;
}

/**
 * The scene that is being run, as SPLATTINGMIP_TEST_SCENE names it; empty between scenes.
 */
inline std::string& currentScene()
{
  static std::string scene;
  return scene;
}

/**
 * What to say of a failed check, so that its scene can be run alone; empty between scenes.
 */
inline std::string howToRepeat()
{
  return currentScene().empty() ? std::string()
                                : " [SPLATTINGMIP_TEST_SEED=" + std::to_string(seedShift()) +
      " SPLATTINGMIP_TEST_SCENE='" + currentScene() + "']";
}

/**
 * How many scenes have been run.
 */
inline int& scenesRun()
{
  static int scenes = 0;
  return scenes;
}

/**
 * How many of a series' scenes are run: SPLATTINGMIP_TEST_SCENES percent of them, at least one.
 */
inline int scenesOf(int count)
{
  static const char* const text = std::getenv("SPLATTINGMIP_TEST_SCENES");
  static const double percent = text ? std::strtod(text, nullptr) : 25.0;
  const int scenes = static_cast<int>(count * percent / 100.0);
  return scenes > 1 ? scenes : 1;
}

/**
 * Calls body(number, random) for each scene of a series. A scene's random numbers depend on the
 * series' name and the scene's number alone, so that each can be run by itself.
 */
template <class Body>
void forScenes(const std::string& series, int count, Body&& body)
{
  std::uint64_t seed = 0xCBF29CE484222325u; // of the hash FNV-1a
  for (const char letter : series)
  {
    seed = (seed ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
  }
  const bool alone = !onlyScene().empty();
  const int scenes = alone ? count : scenesOf(count);
  for (int number = 0; number < scenes; ++number)
  {
    currentScene() = series + "/" + std::to_string(number);
    if (!alone || currentScene() == onlyScene())
    {
      ++scenesRun();
      Random random(seed + static_cast<std::uint64_t>(number));
      body(number, random);
    }
  }
  currentScene().clear();
}
}

#endif
