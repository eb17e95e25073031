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
 * Chooses the quality mode that fits into the time for a frame, by the times that frames took.
 * Modes are numbers from 0, the fastest; a mode that has not been timed is taken to fit.
 */
class RenderTimes
{
public:
  static constexpr int Modes = 4;
  /// So many views are remembered; beyond them the one that was added first is forgotten.
  static constexpr std::size_t MostViews = 64;

  /// Who sees what: only compared, so that they may be gone.
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
   * The best mode up to the wanted one that is expected to take no longer than the allocated
   * seconds: 80 % of them to go up again, so that modes do not alternate. Mode 0 if none does.
   */
  int choose(const View& view, int wanted, double allocated);

  /**
   * A frame with a projection took so many seconds. The first frame of a view is not counted: that
   * is when memory, textures and shaders come into being. What made another slower or faster than
   * the last one in this mode is expected to do the same to the other modes; so modes that are not
   * in use keep up when the volume's share of the window or the load of the machine changes.
   */
  void add(const View& view, int mode, double seconds);

  /// Volumes of another size, other times.
  void clear() { this->Entries.clear(); }

private:
  struct Entry
  {
    View view;
    std::array<double, Modes> seconds{}; // 0: not known
    int last = Modes - 1;                // what was chosen last
    bool begun = false;                  // whether there was a first frame
  };
  Entry& find(const View& view);

  std::vector<Entry> Entries;
};
}

#endif
