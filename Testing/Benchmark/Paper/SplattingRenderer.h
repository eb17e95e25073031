// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SplattingRenderer_h
#define SplattingRenderer_h

#include "Paper/PaperRenderer.h"
#include "Splat/Projection/Project.h"

/**
 * How the volume is held for splatting.
 */
enum class PaperEncoding
{
  Plain,        // voxels
  Lines,        // chains of equal voxels, slice by slice
  SortedLines,  // the same, sorted by value; preview only
  SortedVolume, // all chains sorted by value; preview only
  Automatic     // what the projector thinks best
};

/**
 * Splatting as the paper has it. The only place that knows how the core is told about encodings.
 */
class SplattingRenderer : public PaperRenderer
{
public:
  /**
   * The volume must outlive the renderer. The tolerance is the paper's N of delta encoding, in grey
   * levels; 0 is lossless.
   */
  SplattingRenderer(const PaperVolume& volume, splatting::Quality quality,
    PaperEncoding encoding = PaperEncoding::Plain, int tolerance = 0);

  void Render(const splatting::View& view) override;

  /**
   * The projection alone, before the warp, in grey levels.
   */
  reference::Image<double> Project(const splatting::ShearWarp& geometry);

  /**
   * Bytes held besides the volume for the views rendered so far.
   */
  std::size_t GetIndexMemory() const { return this->Index.memorySize(); }

private:
  splatting::VolumeIndex Index;
  splatting::ProjectionSettings Settings;
  splatting::Projector Projector;
  std::vector<splatting::ShearImage> Images = std::vector<splatting::ShearImage>(1);
};

#endif
