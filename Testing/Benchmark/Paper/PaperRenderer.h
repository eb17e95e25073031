// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The ways of the paper from a volume to the picture in a window, all with the same result: colours
 * of the window's pixels, by a table of 256 greys.
 */
#ifndef PaperRenderer_h
#define PaperRenderer_h

#include "Display/ScreenColors.h"
#include "Paper/PaperScene.h"
#include "Projection.h"
#include "Splat/Projection/ShearImage.h"
#include "Splat/Warp/Warp.h"
#include "Volume/VolumeIndex.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

using PaperPicture = reference::Image<double>; // grey levels, 0 beside the volume

class PaperRenderer
{
public:
  virtual ~PaperRenderer() = default;

  /**
   * All that is to be done anew for every frame, and is timed.
   */
  virtual void Render(const splatting::View& view) = 0;

  /**
   * Renders and returns the picture that fills the window.
   */
  PaperPicture MakePicture(const splatting::View& view);

protected:
  PaperRenderer();

  /// Warps a shear image of maxima to the frame.
  void Show(const std::vector<splatting::ShearImage>& images, const splatting::ShearWarp& geometry,
    const splatting::View& view);

  splatting::ColorTable Greys;
  splatting::Picture Frame;

private:
  splatting::WarpedScalars Warped;
};

/**
 * Rays from the window's pixels, cast by one of the functions of TimedProjection.h.
 */
class RayCastRenderer : public PaperRenderer
{
public:
  using Caster = void (*)(
    const reference::Bytes& volume, const reference::Rays& rays, reference::Image<float>& picture);

  /// The volume must outlive the renderer.
  RayCastRenderer(const PaperVolume& volume, Caster cast) : Volume(volume), Cast(cast) {}

  void Render(const splatting::View& view) override;

private:
  const PaperVolume& Volume;
  const Caster Cast;
  reference::Image<float> Values;
};

/**
 * A shear image by projectSlices(), then the warp of splatting.
 */
class ProjectiveRenderer : public PaperRenderer
{
public:
  /// The volume must outlive the renderer.
  explicit ProjectiveRenderer(const PaperVolume& volume);

  void Render(const splatting::View& view) override;

private:
  const PaperVolume& Volume;
  splatting::VolumeIndex Index; // for the slices along the first axis, as splatting has them
  reference::ByteImage Bytes;
  std::vector<splatting::ShearImage> Images = std::vector<splatting::ShearImage>(1); // of bytes
};

/**
 * Any projection to the shear grid, then the warp of splatting. For pictures, not for times.
 */
class ReferenceRenderer : public PaperRenderer
{
public:
  using Projection = std::function<reference::Image<double>(
    const reference::Volume<double>& volume, const reference::ShearView& view)>;

  ReferenceRenderer(const PaperVolume& volume, const Projection& project)
    : Volume(reference::toDouble(volume.Voxels)),
      Project(project)
  {
  }

  void Render(const splatting::View& view) override;

private:
  const reference::Volume<double> Volume;
  const Projection Project;
};

/**
 * The view as the reference projections want it.
 */
reference::ShearView ToReference(const splatting::ShearWarp& geometry);

#endif
