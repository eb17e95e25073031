// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingRenderTimes_h
#define splattingRenderTimes_h

#include <array>
#include <cstddef>
#include <vector>

namespace splatting
{
/**
 * Chooses the quality mode that fits into the time for a frame, from measured times. Modes are
 * numbers from 0, the fastest. A mode without measurement is assumed to fit.
 */
class RenderTimes
{
public:
  static constexpr int Modes = 4;
  /// Views that are stored. If there are more, the one that was added first is removed.
  static constexpr std::size_t MostViews = 64;

  /// A renderer and a volume; compared, never dereferenced.
  struct View
  {
    const void* renderer;
    const void* volume;

    bool operator==(const View& other) const
    {
      return this->renderer == other.renderer && this->volume == other.volume;
    }
  };

  /**
   * The best mode, up to the wanted one, that is expected to take no longer than the allocated
   * seconds. A better mode than the last one must fit into 80 % of them, so that modes do not
   * alternate. Mode 0 if none fits.
   */
  int choose(const View& view, int wanted, double allocated);

  /**
   * Adds the time of a frame with a projection. The first frame of a view is not counted, because
   * it allocates memory, textures and shaders. If the time of one mode changes, the times of the
   * other modes are multiplied by the same factor. They therefore adapt to the size of the volume
   * in the window and to the load of the machine.
   */
  void add(const View& view, int mode, double seconds);

  /// Call it for volumes of another size.
  void clear() { this->Entries.clear(); }

private:
  struct Entry
  {
    View view;
    std::array<double, Modes> seconds{}; // 0: unknown
    int last = Modes - 1;                // the last choice
    bool begun = false;                  // whether there was a first frame
  };
  Entry& find(const View& view);

  std::vector<Entry> Entries;
};
}

#endif
