// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Checks.h
 * @brief   reports what does not hold, with what runs its scene alone
 */
#ifndef reference_Checks_h
#define reference_Checks_h

#include <sstream>
#include <string>

namespace reference
{

/**
 * The checks of a test, which is a program of its own. Prints the first failures.
 */
class Checks
{
public:
  /**
   * Returns the condition. The message says what is wrong: where, what was found and expected.
   */
  template <class... Message>
  bool operator()(bool condition, const Message&... message)
  {
    if (!condition)
    {
      std::ostringstream text;
      (text << ... << message);
      fail(text.str());
    }
    return condition;
  }

  /**
   * Compares two images of the same pixels, and reports the first pixel that differs by more than
   * the tolerance, or that only one of them has.
   */
  template <class Image, class... Message>
  bool same(const Image& expected, const Image& found, double tolerance, const Message&... message)
  {
    if (!(*this)(expected.width == found.width && expected.height == found.height, message..., ": ",
          found.width, " x ", found.height, " pixels, not ", expected.width, " x ",
          expected.height))
    {
      return false;
    }
    for (std::size_t p = 0; p < expected.value.size(); ++p)
    {
      const double error = double(found.value[p]) - double(expected.value[p]);
      if (expected.hit[p] != found.hit[p] ||
        (expected.hit[p] && expected.value[p] != found.value[p] &&
          !(error <= tolerance && -error <= tolerance)))
      {
        const auto text = [](const Image& image, std::size_t n)
        { return image.hit[n] ? std::to_string(image.value[n]) : std::string("nothing"); };
        return (*this)(false, message..., ": pixel ", p % expected.width, ", ", p / expected.width,
          ": ", text(found, p), ", not ", text(expected, p));
      }
    }
    return true;
  }

  /**
   * Reports that something is left out, as this file of test data is missing.
   */
  void skip(const std::string& file);

  /**
   * What the test returns. Of one that skips something and has no failures, what VTK takes for a
   * skipped test.
   */
  int exitCode();

private:
  static void fail(const std::string& message);

  bool Skips = false;
};
}

#endif
