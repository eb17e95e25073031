// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Layers of a picture: sums are clamped, products with opacities are rounded to the nearest byte.
// All pairs of bytes.
#include "CoreTesting.h"

#include "Display/Picture.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

using namespace coretesting;

namespace
{
/// A pixel for each pair of bytes (a, b), with four bytes made of them.
template <class F>
splatting::Picture pairs(F&& f)
{
  splatting::Picture picture;
  picture.size = { 256, 256 };
  for (int n = 0; n < 256 * 256; ++n)
  {
    unsigned char bytes[4];
    for (int c = 0; c < 4; ++c)
    {
      bytes[c] = static_cast<unsigned char>(f(n % 256, n / 256, c));
    }
    std::uint32_t pixel;
    std::memcpy(&pixel, bytes, sizeof pixel);
    picture.pixels.push_back(pixel);
  }
  return picture;
}

int byteOf(const splatting::Picture& picture, int n, int c)
{
  unsigned char bytes[4];
  std::memcpy(bytes, &picture.pixels[n], sizeof bytes);
  return bytes[c];
}

void testSums(Checks& check)
{
  const splatting::Picture layer = pairs([](int a, int, int c) { return c % 2 ? 255 - a : a; });
  splatting::Picture sum = pairs([](int, int b, int) { return b; });
  splatting::addSaturated(layer, sum);
  for (int n = 0; n < 256 * 256; ++n)
  {
    for (int c = 0; c < 4; ++c)
    {
      const int a = c % 2 ? 255 - n % 256 : n % 256, b = n / 256;
      check(byteOf(sum, n, c) == std::min(a + b, 255), a, " + ", b, " is ", byteOf(sum, n, c));
    }
  }
}

void testProducts(Checks& check)
{
  // The other bytes of the opacities have no meaning.
  const splatting::Picture opacity = pairs([](int a, int b, int c) { return c == 3 ? a : a ^ b; });
  splatting::Picture product = pairs([](int, int b, int c) { return c == 3 ? 255 : b; });
  splatting::multiplyByOpacity(opacity, product);
  for (int n = 0; n < 256 * 256; ++n)
  {
    for (int c = 0; c < 4; ++c)
    {
      const int a = n % 256, b = c == 3 ? 255 : n / 256;
      // No product is halfway between two bytes, as 255 is odd.
      const int error = 2 * (255 * byteOf(product, n, c) - a * b);
      check(error >= -255 && error <= 255, "opacity ", a, " of ", b, " is ", byteOf(product, n, c));
    }
  }
}
}

int TestPicture(int, char*[])
{
  Checks check;
  testSums(check);
  testProducts(check);
  return check.exitCode();
}
