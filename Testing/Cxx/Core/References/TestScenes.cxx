// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random numbers are the same whether they are recorded or not, and repeat what was recorded.
// Scenes that fail on purpose become the simplest ones that fail.
#include "Checks.h"
#include "Scenes.h"
#include "Volume.h"

#include <limits>
#include <string>

using reference::Checks;
using reference::Choices;
using reference::Random;
using reference::Tape;

namespace
{
/// Draws of all types.
std::string drawn(Random& random)
{
  std::ostringstream text;
  using Limits = std::numeric_limits<std::int64_t>;
  text << random.uniform(-7, 5) << ' ' << random.uniform(3, 9) << ' ' << random.uniform(-9, -3);
  text << ' ' << random.uniform<std::int64_t>(Limits::lowest(), Limits::max()) << ' ';
  text << random.uniform<std::uint8_t>(0, 255) << std::hexfloat << ' ' << random.uniform(-2.0, 5.0);
  text << ' ' << random.uniform(0.5f, 2.0f) << ' ' << random.uniform(3.0, 4.0) << ' ';
  text << random.oneIn(3) << random.chance(0.4) << ' ' << random.sign() << ' ' << random.bits();
  text << ' ' << reference::uniformNoise<std::int16_t>({ 1, 1, 1 }, random).voxels[0];
  return text.str();
}

void testDraws(Checks& check)
{
  for (std::uint64_t seed = 0; seed < 1000; ++seed)
  {
    Random plain(seed);
    Tape tape, second;
    Random recording(seed, tape);
    const std::string expected = drawn(plain), recorded = drawn(recording);
    check(recorded == expected, "recording changes ", expected, " to ", recorded);
    second.given = &tape.choices;
    Random repeating(seed + 1, second);
    const std::string repeated = drawn(repeating);
    check(repeated == expected, "repeating changes ", expected, " to ", repeated);
    check(second.choices == tape.choices, "repeated choices are recorded as others");
  }
  const Choices none;
  Tape tape;
  tape.given = &none;
  Random simplest(3, tape);
  check(
    drawn(simplest) == "0 3 -3 0 " + std::string(1, '\0') + " 0x0p+0 0x1p+0 0x1.8p+1 00 0x1p+0 0 0",
    "the simplest scene is ", drawn(simplest));
}

struct Box
{
  int size[3];
  double spacing;
  bool isCut;
  std::vector<int> bright;

  explicit Box(Random& random) : spacing(1.0), isCut(false)
  {
    for (int& n : this->size)
    {
      n = random.uniform(1, 60);
    }
    this->spacing = random.uniform(0.5, 2.0);
    this->isCut = random.oneIn(2);
    for (int n = random.uniform(0, 30); n > 0; --n)
    {
      this->bright.push_back(random.uniform(0, 200));
    }
  }
  std::string text() const
  {
    std::ostringstream text;
    text << this->size[0] << ' ' << this->size[1] << ' ' << this->size[2] << ' ' << this->spacing
         << ' ' << this->isCut;
    for (const int n : this->bright)
    {
      text << ' ' << n;
    }
    return text.str();
  }
};

/// The simplest box for which a condition is false, from any box for which it is.
template <class Holds>
void expectSimplest(Checks& check, const Holds& holds, const std::string& expected)
{
  const reference::Scene scene = [&](Random& random)
  {
    const Box box(random);
    Checks own;
    own(box.size[1] < 999, "never fails");
    own(holds(box), "injected, with ", box.size[0], " columns");
  };
  int failing = 0;
  for (std::uint64_t seed = 0; seed < 100 && failing < 10; ++seed)
  {
    Tape tape, second, last;
    Random random(seed, tape);
    if (holds(Box(random)))
    {
      continue;
    }
    ++failing;
    check(!firstFailure(scene, tape.choices, second).empty(), "a failure is not repeated");
    const Choices simplest = simplestFailure(scene, tape.choices, 5000);
    last.given = &simplest;
    Random again(0, last);
    const std::string found = Box(again).text();
    check(found == expected, "the simplest box is ", found, ", not ", expected);
  }
  check(failing == 10, "only ", failing, " boxes fail");
}

void testSimplification(Checks& check)
{
  const auto sum = [](const Box& box) { return box.size[0] + box.size[1]; };
  expectSimplest(
    check, [](const Box&) { return false; }, "1 1 1 1 0");
  expectSimplest(
    check, [](const Box& box) { return box.size[2] < 17; }, "1 1 17 1 0");
  expectSimplest(
    check, [](const Box& box) { return !box.isCut || box.size[0] < 5; }, "5 1 1 1 1");
  expectSimplest(
    check, [](const Box& box) { return box.spacing < 1.25; }, "1 1 1 1.25 0");
  expectSimplest(
    check, [](const Box& box) { return box.bright.size() < 2; }, "1 1 1 1 0 0 0");
  expectSimplest(
    check,
    [](const Box& box)
    {
      bool holds = true;
      for (const int n : box.bright)
      {
        holds = holds && n < 150;
      }
      return holds;
    },
    "1 1 1 1 0 150");
  // Whichever it is, one size cannot be smaller without the other being larger.
  Tape tape;
  const reference::Scene scene = [&](Random& random)
  {
    Checks own;
    own(sum(Box(random)) < 70, "injected");
  };
  const Choices simplest = simplestFailure(scene, Choices{ 59, 59, 59, 0, 1, 30, 100 }, 5000);
  tape.given = &simplest;
  Random random(0, tape);
  const Box box(random);
  check(sum(box) == 70 && box.size[2] == 1, "the simplest box is ", box.text());
}

/// Two numbers that must stay equal, for a check that fails with them.
void testPairs(Checks& check)
{
  const reference::Scene scene = [](Random& random)
  {
    const Box box(random);
    Checks own;
    own(box.size[0] != box.size[1] || !box.isCut, "injected");
  };
  const Choices simplest = simplestFailure(scene, { 40, 40, 7, 5, 1 }, 1000);
  check(simplest == Choices{ 0, 0, 0, 0, 1 }, "equal numbers are not made zeros together");
}

/// Another check that fails, and a scene without end, are no simpler scenes of the same failure.
void testOthers(Checks& check)
{
  const reference::Scene scene = [](Random& random)
  {
    Checks own;
    const int n = random.uniform(0, 100);
    while (n == 0 && random.uniform(0, 1) == 0) // for ever, with zeros
    {
    }
    own(n > 10, "too small: ", n);
    own(n < 50, "too large: ", n);
  };
  const Choices simplest = simplestFailure(scene, { 77 }, 1000);
  check(simplest == Choices{ 50 }, "not the simplest: ", simplest.empty() ? 0 : simplest[0]);
}
}

int TestScenes(int, char*[])
{
  Checks check;
  testDraws(check);
  testSimplification(check);
  testPairs(check);
  testOthers(check);
  return check.exitCode();
}
