// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperAccuracy.h"

#include "Paper/PaperErrors.h"
#include "Paper/SplattingRenderer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace
{
using reference::SliceSampling;
using splatting::Quality;
using ShearPicture = reference::Image<double>;

enum Methods
{
  PROJECTIVE_NEAREST,
  PROJECTIVE_BILINEAR,
  PREVIEW,
  STANDARD,
  HIGH,
  METHOD_COUNT
};
const char* const methodNames[METHOD_COUNT] = { "projective, nearest", "projective, bilinear",
  "splatting, preview", "splatting, standard", "splatting, high" };

/// Rays per pixel along x and y where pixels are areas.
constexpr int raysAcross = 4;

/// The ray of the pixel's centre.
ShearPicture CastCentres(const PaperVolume& volume, const reference::ShearView& view)
{
  reference::Image<float> picture;
  reference::castTrilinear(
    volume.Voxels, reference::shearRays(volume.Voxels.size, view, 1.0 / 16.0), picture);
  return reference::toDouble(picture);
}

/// The volume of boxes that preview is about.
ShearPicture CastThroughVoxels(const PaperVolume& volume, const reference::ShearView& view)
{
  reference::Image<float> picture;
  reference::castThroughVoxels(
    volume.Voxels, reference::shearRays(volume.Voxels.size, view, 1.0), picture);
  return reference::toDouble(picture);
}

/// The average of those of the pixel's rays that meet the volume.
void AveragePixel(const reference::Image<float>& fine, int u, int v, ShearPicture& picture)
{
  double sum = 0.0;
  int count = 0;
  for (int y = v * raysAcross; y < (v + 1) * raysAcross; ++y)
  {
    for (int x = u * raysAcross; x < (u + 1) * raysAcross; ++x)
    {
      sum += fine.isHit(x, y) ? fine.at(x, y) : 0.0;
      count += fine.isHit(x, y);
    }
  }
  if (count > 0)
  {
    picture.raise(u, v, sum / count);
  }
}

/// The average of rays all over the pixel.
ShearPicture CastAreas(const PaperVolume& volume, const reference::ShearView& view)
{
  reference::Rays rays = reference::shearRays(volume.Voxels.size, view, 1.0 / 8.0);
  ShearPicture picture(rays.width, rays.height);
  rays.perColumn /= raysAcross;
  rays.perRow /= raysAcross;
  rays.origin -= 0.5 * (raysAcross - 1) * (rays.perColumn + rays.perRow);
  rays.width *= raysAcross;
  rays.height *= raysAcross;
  reference::Image<float> fine;
  reference::castTrilinear(volume.Voxels, rays, fine);
  for (int v = 0; v < picture.height; ++v)
  {
    for (int u = 0; u < picture.width; ++u)
    {
      AveragePixel(fine, u, v, picture);
    }
  }
  return picture;
}

using Pictures = std::array<ShearPicture, METHOD_COUNT>;

Pictures ProjectAll(const PaperVolume& volume, const splatting::ShearWarp& geometry)
{
  const reference::Volume<double> voxels = reference::toDouble(volume.Voxels);
  const reference::ShearView view = ToReference(geometry);
  return { reference::projectiveShearWarp(voxels, view, SliceSampling::Nearest),
    reference::projectiveShearWarp(voxels, view, SliceSampling::Bilinear),
    SplattingRenderer(volume, Quality::Preview).Project(geometry),
    SplattingRenderer(volume, Quality::Standard).Project(geometry),
    SplattingRenderer(volume, Quality::High).Project(geometry) };
}

/// What each method is compared with.
enum Truths
{
  CENTRES,
  AREAS,
  BOXES,
  TRUTH_COUNT
};
const char* const truthNames[TRUTH_COUNT] = { "rays of pixel centres, trilinear",
  "rays averaged over pixels, trilinear", "every voxel crossed" };

using MethodErrors = std::array<PaperErrors, METHOD_COUNT>;
using Errors = std::array<MethodErrors, TRUTH_COUNT>;

Errors Measure(const PaperVolume& volume, int views)
{
  const glm::dvec2 turns[] = { { 10, 20 }, { -35, 15 }, { 25, -40 }, { 50, 30 }, { -15, 60 },
    { 5, -85 }, { 44, 1 }, { 30, 45 } };
  Errors errors;
  for (int n = 0; n < views; ++n)
  {
    const splatting::ShearWarp geometry(MakePaperView(volume, turns[n], 64));
    const reference::ShearView view = ToReference(geometry);
    const ShearPicture truths[] = { CastCentres(volume, view), CastAreas(volume, view),
      CastThroughVoxels(volume, view) };
    const Pictures pictures = ProjectAll(volume, geometry);
    for (int method = 0; method < METHOD_COUNT; ++method)
    {
      for (int truth = 0; truth < TRUTH_COUNT; ++truth)
      {
        errors[truth][method].Add(pictures[method], truths[truth]);
      }
    }
  }
  return errors;
}

std::string Describe(const PaperErrors& errors)
{
  return Short(errors.GetRms()) + " / " + Short(errors.GetMaximum()) + " / " +
    (errors.GetBias() < 0.0 ? "-" : "+") + Short(std::abs(errors.GetBias()));
}

/// Who is nearer to the truth.
std::string Compare(int splatting, int projective, const MethodErrors& errors)
{
  const double ours = errors[splatting].GetRms(), theirs = errors[projective].GetRms();
  return std::string("*") + methodNames[splatting] + "* has " + Short(ours / theirs) +
    " times the rms error of *" + methodNames[projective] + "*: the claim **" +
    (ours < theirs ? "holds" : "does not hold") + "**";
}

/// The comparisons between equals: one voxel per sample, or interpolated ones.
std::string CompareAll(int truth, const MethodErrors& errors)
{
  const auto best = std::min_element(errors.begin(), errors.end(),
    [](const PaperErrors& a, const PaperErrors& b) { return a.GetRms() < b.GetRms(); });
  std::string text = std::string("Beside ") + truthNames[truth] + ": " +
    Compare(PREVIEW, PROJECTIVE_NEAREST, errors) + ".";
  if (truth != BOXES) // what interpolates does not mean boxes
  {
    text += " " + Compare(STANDARD, PROJECTIVE_BILINEAR, errors) + ". " +
      Compare(HIGH, PROJECTIVE_BILINEAR, errors) + ".";
  }
  return text + " The most accurate of all is *" + methodNames[best - errors.begin()] + "*.";
}
}

//------------------------------------------------------------------------------
void ReportAccuracy(
  PaperReport& report, const std::string& name, const PaperVolume& volume, int views)
{
  const Errors errors = Measure(volume, views);
  std::vector<std::vector<std::string>> rows;
  for (int method = 0; method < METHOD_COUNT; ++method)
  {
    rows.push_back({ methodNames[method] });
    for (const MethodErrors& one : errors)
    {
      rows.back().push_back(Describe(one[method]));
    }
  }
  std::vector<std::string> head = { "rms / max / mean error, grey levels of 256, beside" };
  head.insert(head.end(), truthNames, truthNames + TRUTH_COUNT);
  report.AddText("### " + name + ", " + std::to_string(views) + " views");
  report.AddTable(head, rows);
  std::vector<std::string> sentences;
  for (int truth = 0; truth < TRUTH_COUNT; ++truth)
  {
    sentences.push_back(CompareAll(truth, errors[truth]));
  }
  report.AddList(sentences);
}
