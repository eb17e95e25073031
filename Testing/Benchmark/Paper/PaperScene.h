// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the paper's experiments look at: volumes of bytes, and views of a turn about an axis.
 */
#ifndef PaperScene_h
#define PaperScene_h

#include "Geometry/View.h"
#include "TimedProjection.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <string>
#include <vector>

/**
 * Voxels and their distances.
 */
struct PaperVolume
{
  reference::Bytes Voxels;
  glm::dvec3 Spacing{ 1.0 };
};

/**
 * One set of data in the two resolutions of the paper, the low one made of the high one by
 * averaging 2x2x2 voxels ("using the mip-map method").
 */
struct PaperDataSet
{
  std::string Name;
  std::string Origin; // a sentence
  std::array<PaperVolume, 2> Volumes;
};

/**
 * The aorta, the ultrasound if the folder has it, and a phantom, as cubes of `voxels` and
 * `voxels` / 2 along each side. Sentences on what is missing are appended to notes.
 */
std::vector<PaperDataSet> LoadPaperData(
  const std::string& folder, int voxels, std::vector<std::string>& notes);

/**
 * The phantom of the paper's figures 10 and 11, of lines one voxel thick.
 */
PaperVolume MakeLinePhantom();

/**
 * The volume turned about the x axis, then about the y axis (degrees), and seen along +z by a
 * camera whose square window holds it whole in every turn about one axis; then magnified about the
 * point `centre` of the window, whose corners are (-1, -1) and (1, 1).
 */
splatting::View MakePaperView(const PaperVolume& volume, const glm::dvec2& turns, int window,
  double zoom = 1.0, const glm::dvec2& centre = glm::dvec2(0.0));

/**
 * The rays of the window's pixels, with samples one voxel apart.
 */
reference::Rays MakeScreenRays(const splatting::View& view);

#endif
