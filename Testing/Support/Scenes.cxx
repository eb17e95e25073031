// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scenes.h"

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace reference
{
namespace
{
constexpr int FailuresPrinted = 20;
/// Simpler scenes are looked for in so many runs and seconds.
constexpr int RunsToSimplify = 2000;
constexpr double SecondsToSimplify = 20.0;

/// What happens in this program.
struct Status
{
  std::string scene; ///< that is being run; empty between scenes
  int scenesRun = 0, failures = 0;
  std::string* firstFailure = nullptr; ///< takes it instead of the output
  bool isSimplified = false;           ///< one failing scene is enough
};

Status& status()
{
  static Status status;
  return status;
}

std::string variable(const char* name)
{
  const char* const text = std::getenv(name);
  return text ? text : "";
}

/// A message without numbers: which check it is of.
std::string wordsOf(const std::string& message)
{
  std::istringstream stream(message);
  std::string words, word;
  while (stream >> word)
  {
    const bool isNumber = word.find_first_of("0123456789") != std::string::npos ||
      word.find("nan") != std::string::npos || word.find("inf") != std::string::npos;
    words += isNumber ? "" : word + ' ';
  }
  return words;
}

/// Looks for simpler choices of one scene.
class Simplification
{
public:
  Simplification(const Scene& scene, const Choices& choices, int runs)
    : Run(scene),
      Best(choices),
      RunsLeft(runs)
  {
    Tape tape;
    this->Words = wordsOf(firstFailure(scene, choices, tape));
    this->Longest = 2 * tape.choices.size() + 100;
  }

  Choices find()
  {
    this->accept({});
    for (bool simpler = true; simpler;)
    {
      simpler = this->simplifyBlocks();
      simpler = this->simplifyNumbers() || simpler;
    }
    return this->Best;
  }

private:
  bool isAtEnd() const
  {
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - this->Start;
    return this->RunsLeft <= 0 || past.count() > SecondsToSimplify;
  }

  /// Keeps choices if the same check fails.
  bool accept(const Choices& choices)
  {
    if (this->isAtEnd() || choices == this->Best)
    {
      return false;
    }
    --this->RunsLeft;
    Tape tape;
    tape.longest = this->Longest;
    const std::string failure = firstFailure(this->Run, choices, tape);
    if (failure.empty() || wordsOf(failure) != this->Words)
    {
      return false;
    }
    this->Best =
      std::min(choices.size(), tape.choices.size()) == choices.size() ? choices : tape.choices;
    return true;
  }

  /// Leaves out blocks of choices, or makes them zeros, the largest blocks first.
  bool simplifyBlocks()
  {
    bool simpler = false;
    for (std::size_t length = this->Best.size(); length > 0; length /= 2)
    {
      for (std::size_t begin = 0; begin < this->Best.size();)
      {
        const std::size_t end = std::min(begin + length, this->Best.size());
        Choices shorter = this->Best, zeros = this->Best;
        shorter.erase(shorter.begin() + begin, shorter.begin() + end);
        std::fill(zeros.begin() + begin, zeros.begin() + end, 0);
        if (this->accept(shorter))
        {
          simpler = true; // the next block has moved here
          continue;
        }
        simpler = this->accept(zeros) || simpler;
        begin += length;
      }
    }
    return simpler;
  }

  /// Makes numbers smaller: fewer digits, halves, one less.
  bool simplifyNumbers()
  {
    bool simpler = false;
    for (std::size_t n = 0; n < this->Best.size(); ++n)
    {
      const auto replace = [&](std::uint64_t number)
      {
        Choices choices = this->Best;
        choices[n] = number;
        return n < this->Best.size() && number < this->Best[n] && this->accept(choices);
      };
      for (int digits = 1; digits < 64 && n < this->Best.size(); digits *= 2)
      {
        simpler = replace(this->Best[n] & ((std::uint64_t(1) << digits) - 1)) || simpler;
      }
      while (n < this->Best.size() && (replace(this->Best[n] / 2) || replace(this->Best[n] - 1)))
      {
        simpler = true;
      }
    }
    return simpler;
  }

  const Scene& Run;
  Choices Best;
  std::string Words;
  std::size_t Longest = 0;
  int RunsLeft;
  const std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

std::string textOf(const Choices& choices)
{
  std::string text;
  for (const std::uint64_t choice : choices)
  {
    text += (text.empty() ? "" : " ") + std::to_string(choice);
  }
  return text;
}

Choices choicesOf(const std::string& text)
{
  std::istringstream stream(text);
  Choices choices;
  for (std::uint64_t choice; stream >> choice;)
  {
    choices.push_back(choice);
  }
  return choices;
}

void describeSimplest(const Scene& scene, const Choices& choices)
{
  status().isSimplified = true;
  const Choices simplest = simplestFailure(scene, choices, RunsToSimplify);
  Tape tape;
  const std::string failure = firstFailure(scene, simplest, tape);
  std::cerr << "The simplest scene that fails: " << failure << howToRepeat()
            << "\n  [SPLATTINGMIP_TEST_CHOICES='" << textOf(simplest) << "']\n";
  for (const std::string& note : tape.notes)
  {
    std::cerr << "  " << note << '\n';
  }
}

/// Runs one scene, and simplifies it if it fails.
void runScene(const Scene& scene, std::uint64_t seed)
{
  static const std::string given = variable("SPLATTINGMIP_TEST_CHOICES");
  static const Choices choices = choicesOf(given);
  Tape tape;
  tape.given = given.empty() ? nullptr : &choices;
  tape.longest = given.empty() ? SIZE_MAX : 10 * choices.size() + 100000;
  Random random(seed, tape);
  const int before = failures();
  try
  {
    scene(random);
  }
  catch (const Tape::TooLong& tooLong)
  {
    reportFailure(tooLong.what());
  }
  if (failures() > before && given.empty() && !status().isSimplified)
  {
    describeSimplest(scene, tape.choices);
  }
  for (const std::string& note : tape.notes)
  {
    std::cout << "  " << note << '\n';
  }
}
}

//------------------------------------------------------------------------------
const std::string& onlyScene()
{
  static const std::string scene = variable("SPLATTINGMIP_TEST_SCENE");
  return scene;
}

//------------------------------------------------------------------------------
std::string howToRepeat()
{
  return status().scene.empty() ? std::string()
                                : " [SPLATTINGMIP_TEST_SEED=" + std::to_string(seedShift()) +
      " SPLATTINGMIP_TEST_SCENE='" + status().scene + "']";
}

//------------------------------------------------------------------------------
int scenesRun()
{
  return status().scenesRun;
}

//------------------------------------------------------------------------------
int scenesOf(int count)
{
  static const std::string text = variable("SPLATTINGMIP_TEST_SCENES");
  const double percent = text.empty() ? 25.0 : std::strtod(text.c_str(), nullptr);
  return std::max(static_cast<int>(count * percent / 100.0), 1);
}

//------------------------------------------------------------------------------
void reportFailure(const std::string& message)
{
  Status& s = status();
  if (s.firstFailure)
  {
    *s.firstFailure = s.firstFailure->empty() ? message : *s.firstFailure;
  }
  else if (++s.failures <= FailuresPrinted)
  {
    std::cerr << "FAILED: " << message << howToRepeat() << std::endl;
  }
}

//------------------------------------------------------------------------------
int failures()
{
  return status().failures;
}

//------------------------------------------------------------------------------
std::string firstFailure(const Scene& scene, const Choices& choices, Tape& tape)
{
  std::string failure;
  std::string* const before = status().firstFailure;
  status().firstFailure = &failure;
  tape.given = &choices;
  Random random(0, tape);
  try
  {
    scene(random);
  }
  catch (const Tape::TooLong&)
  {
    failure.clear();
  }
  status().firstFailure = before;
  return failure;
}

//------------------------------------------------------------------------------
Choices simplestFailure(const Scene& scene, Choices choices, int runs)
{
  return Simplification(scene, choices, runs).find();
}

//------------------------------------------------------------------------------
void forScenes(
  const std::string& series, int count, const std::function<void(int number, Random&)>& body)
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
    status().scene = series + "/" + std::to_string(number);
    if (!alone || status().scene == onlyScene())
    {
      ++status().scenesRun;
      runScene(
        [&](Random& random) { body(number, random); }, seed + static_cast<std::uint64_t>(number));
    }
  }
  status().scene.clear();
}
}
