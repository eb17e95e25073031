// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperFigures.h"

#include "Paper/PaperErrors.h"
#include "Paper/SplattingRenderer.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace
{
using splatting::Quality;

struct NamedPicture
{
  std::string Name;
  PaperPicture Picture;
};

std::string Percent(double share)
{
  return Fixed(100.0 * share, 1) + " %";
}

/**
 * How sharp a picture is: how fast its slopes change, as the rms of second differences over that of
 * first differences. Brightness and contrast do not count, blurring makes it smaller.
 */
double Sharpness(const PaperPicture& picture)
{
  double slopes = 0.0, changes = 0.0;
  const auto add = [&](double before, double here, double after)
  {
    slopes += (after - here) * (after - here);
    changes += (after - 2.0 * here + before) * (after - 2.0 * here + before);
  };
  for (int y = 1; y + 1 < picture.height; ++y)
  {
    for (int x = 1; x + 1 < picture.width; ++x)
    {
      add(picture.at(x - 1, y), picture.at(x, y), picture.at(x + 1, y));
      add(picture.at(x, y - 1), picture.at(x, y), picture.at(x, y + 1));
    }
  }
  return std::sqrt(changes / slopes);
}

std::vector<PaperPicture> GetPictures(const std::vector<NamedPicture>& named)
{
  std::vector<PaperPicture> pictures;
  for (const NamedPicture& one : named)
  {
    pictures.push_back(one.Picture);
  }
  return pictures;
}

void ReportSharpness(PaperReport& report, const std::vector<NamedPicture>& pictures)
{
  std::vector<std::vector<std::string>> rows;
  for (const NamedPicture& one : pictures)
  {
    rows.push_back(
      { one.Name, Fixed(*std::max_element(one.Picture.value.begin(), one.Picture.value.end()), 0),
        Short(reference::mean(one.Picture)), Fixed(Sharpness(one.Picture), 4) });
  }
  report.AddText("Sharpness is how fast slopes change: the rms of second differences between "
                 "pixels over that of first differences.");
  report.AddTable({ "picture", "brightest grey", "mean grey", "sharpness" }, rows);
}

/// The sharpest (sign 1) or the smoothest (sign -1) of the pictures.
std::size_t FindExtreme(const std::vector<NamedPicture>& pictures, int sign)
{
  const auto less = [=](const NamedPicture& a, const NamedPicture& b)
  { return sign * Sharpness(a.Picture) < sign * Sharpness(b.Picture); };
  return std::max_element(pictures.begin(), pictures.end(), less) - pictures.begin();
}

std::string JudgeExtreme(const std::string& claim, const std::vector<NamedPicture>& pictures,
  int sign, std::size_t claimed)
{
  const std::size_t found = FindExtreme(pictures, sign);
  return claim + " Here the " + (sign > 0 ? "sharpest" : "smoothest") + " is *" +
    pictures[found].Name + "*: the claim **" + (found == claimed ? "holds" : "does not hold") +
    "**.";
}

//------------------------------------------------------------------------------
// Figures 10 and 11

const glm::dvec2 phantomTurns(25.0, 35.0);
constexpr double phantomZoom = 4.0;

std::vector<NamedPicture> RenderModes(const PaperVolume& volume, const splatting::View& view)
{
  std::vector<NamedPicture> pictures;
  const std::pair<const char*, Quality> modes[] = { { "preview", Quality::Preview },
    { "standard", Quality::Standard }, { "high", Quality::High } };
  for (const auto& mode : modes)
  {
    pictures.push_back({ mode.first, SplattingRenderer(volume, mode.second).MakePicture(view) });
  }
  return pictures;
}

std::vector<NamedPicture> RenderHighQuality(const PaperVolume& volume, const splatting::View& view)
{
  const auto bilinear = [](const auto& voxels, const auto& shear)
  { return reference::projectiveShearWarp(voxels, shear, reference::SliceSampling::Bilinear); };
  return { { "ray casting, trilinear samples",
             RayCastRenderer(volume, reference::castTrilinear).MakePicture(view) },
    { "projective shear-warp, bilinear samples",
      ReferenceRenderer(volume, bilinear).MakePicture(view) },
    { "splatting, high", SplattingRenderer(volume, Quality::High).MakePicture(view) } };
}

/// The picture between four pixels.
double Interpolate(const PaperPicture& picture, const glm::dvec2& p)
{
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
  const glm::dvec2 f(p.x - x, p.y - y);
  return (1.0 - f.y) * ((1.0 - f.x) * picture.at(x, y) + f.x * picture.at(x + 1, y)) +
    f.y * ((1.0 - f.x) * picture.at(x, y + 1) + f.x * picture.at(x + 1, y + 1));
}

constexpr int lineSamples = 400; // along a line
constexpr int lineSections = 31; // across it, over six voxels

/// A line alone, and where in the window the picture of it is looked at.
struct LineScene
{
  PaperVolume Volume{ reference::Bytes({ 64, 64, 64 }), glm::dvec3(1.0) };
  splatting::View View;
  glm::dvec2 Begin{ 0.0 }, End{ 0.0 }; // window pixels

  LineScene(const glm::dvec2& turns, int window)
  {
    const std::array<int, 3> from = { 6, 20, 10 }, to = { 57, 33, 50 };
    reference::drawLine<std::uint8_t>(this->Volume.Voxels, from, to, 255);
    this->View = MakePaperView(this->Volume, turns, window);
    const glm::dvec2 a = this->ToWindow(from), b = this->ToWindow(to);
    this->Begin = glm::mix(a, b, 0.1); // away from the ends
    this->End = glm::mix(a, b, 0.9);
  }

  glm::dvec2 ToWindow(const std::array<int, 3>& voxel) const
  {
    const glm::dvec4 clip = this->View.indexToClip * glm::dvec4(voxel[0], voxel[1], voxel[2], 1.0);
    return 0.5 * (glm::dvec2(clip) + 1.0) * glm::dvec2(this->View.viewport) - 0.5;
  }

  glm::dvec2 At(int sample, int section) const
  {
    const glm::dvec2 along = glm::normalize(this->End - this->Begin);
    const double voxel =
      0.5 * this->View.viewport.x * glm::length(glm::dvec3(this->View.indexToClip[0]));
    const double offset = 6.0 * voxel * (section / (lineSections - 1.0) - 0.5);
    return glm::mix(this->Begin, this->End, sample / (lineSamples - 1.0)) +
      offset * glm::dvec2(-along.y, along.x);
  }
};

/**
 * How uneven a line one voxel thick is drawn: how far the picture on and beside the line differs
 * from the line's average cross-section, as rms over the rms of the cross-section. 0 for a line
 * without stairs, beads and gaps, however blurred.
 */
double MeasureUnevenness(const LineScene& scene, Quality quality)
{
  const PaperPicture picture = SplattingRenderer(scene.Volume, quality).MakePicture(scene.View);
  double deviations = 0.0, sections = 0.0;
  for (int section = 0; section < lineSections; ++section)
  {
    double sum = 0.0, squares = 0.0;
    for (int sample = 0; sample < lineSamples; ++sample)
    {
      const double grey = Interpolate(picture, scene.At(sample, section));
      sum += grey;
      squares += grey * grey;
    }
    const double mean = sum / lineSamples;
    deviations += squares / lineSamples - mean * mean;
    sections += mean * mean;
  }
  return std::sqrt(deviations / sections);
}

/// The average over several views.
double MeasureUnevenness(Quality quality, int window)
{
  double sum = 0.0;
  int count = 0;
  for (double angle : { 0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0 })
  {
    sum += MeasureUnevenness(LineScene({ 25.0, angle }, window), quality);
    ++count;
  }
  return sum / count;
}

void ReportUnevenness(PaperReport& report, int window)
{
  const double preview = MeasureUnevenness(Quality::Preview, window),
               standard = MeasureUnevenness(Quality::Standard, window),
               high = MeasureUnevenness(Quality::High, window);
  report.AddText(
    "1998: \"in high quality mode images the line is smoother than the other two cases\". One "
    "oblique line alone differs from its average cross-section by (rms over the rms of the "
    "cross-section, mean of 7 views) " +
    Percent(preview) + " in preview, " + Percent(standard) + " in standard and " + Percent(high) +
    " in high: the claim **" + (high < std::min(preview, standard) ? "holds" : "does not hold") +
    "**.");
}

//------------------------------------------------------------------------------
// Figure 12

/// Encoded beside plain shear images over several views.
PaperErrors MeasureEncoding(const PaperVolume& volume, const PaperSettings& settings)
{
  SplattingRenderer plain(volume, Quality::Preview);
  SplattingRenderer encoded(volume, Quality::Preview, PaperEncoding::SortedLines, PaperTolerance);
  PaperErrors errors;
  for (int angle = 0; angle < 360; angle += 30)
  {
    const splatting::ShearWarp geometry(MakePaperView(volume, { 20.0, angle }, settings.Window));
    errors.Add(encoded.Project(geometry), plain.Project(geometry));
  }
  return errors;
}

void ReportEncodingErrors(PaperReport& report, const PaperDataSet& data, const PaperTimes& times,
  const PaperSettings& settings)
{
  const PaperErrors errors = MeasureEncoding(data.Volumes[0], settings);
  const double encoded = times.at(PaperMethod::Encoded)[0].Mean;
  const double toPlain = encoded / times.at(PaperMethod::Plain)[0].Mean;
  const double toLossless = encoded / times.at(PaperMethod::EncodedLossless)[0].Mean;
  report.AddText("Encoded and sorted with N = " + std::to_string(PaperTolerance) +
    " beside plain preview, shear images of 12 views, in grey levels of 256: largest difference " +
    Short(errors.GetMaximum()) + ", mean " + Short(errors.GetMean()) + ", rms " +
    Short(errors.GetRms()) + ". It takes " + Short(toPlain) +
    " times as long as plain preview (1998: 0.30 in the text, \"speed-up of ca 4\" in the "
    "caption): the speed-up **" +
    (toPlain < 0.95 ? "holds" : "does not hold") +
    "** on this machine. Beside lossless encoding, " + "the tolerance alone takes " +
    Short(toLossless) + " times as long.");
}

//------------------------------------------------------------------------------
// Figure 13

std::vector<NamedPicture> RenderMethods(const PaperVolume& volume, const splatting::View& view)
{
  std::vector<NamedPicture> pictures;
  for (PaperMethod method :
    { PaperMethod::Plain, PaperMethod::RayNearest, PaperMethod::Projective })
  {
    pictures.push_back({ GetName(method), MakeRenderer(method, volume)->MakePicture(view) });
  }
  return pictures;
}

std::string CompareMethods(const std::vector<NamedPicture>& pictures)
{
  PaperErrors rayAndProjective, rayAndSplatting;
  rayAndProjective.Add(pictures[1].Picture, pictures[2].Picture);
  rayAndSplatting.Add(pictures[1].Picture, pictures[0].Picture);
  const double toProjective = rayAndProjective.GetRms(), toSplatting = rayAndSplatting.GetRms();
  return "1998: \"the difference between ray casting and shear-warp is negligible\". Here it is " +
    Short(toProjective) + " grey levels (rms), " + Percent(toProjective / toSplatting) +
    " of the " + Short(toSplatting) + " between ray casting and splatting: the claim **" +
    (toProjective < 0.5 * toSplatting ? "holds" : "does not hold") +
    "**, taking less than half for negligible.";
}
}

//------------------------------------------------------------------------------
void ReportPhantom(PaperReport& report, const PaperSettings& settings)
{
  const PaperVolume phantom = MakeLinePhantom();
  const splatting::View whole = MakePaperView(phantom, phantomTurns, settings.Window);
  const splatting::View detail =
    MakePaperView(phantom, phantomTurns, settings.Window, phantomZoom, glm::dvec2(0.25, -0.2));
  report.AddHeading("Figure 10: the modes");
  report.AddFigure("figure-10",
    "Phantom of lines one voxel thick, 64^3. Preview, standard and high; whole and magnified.",
    { GetPictures(RenderModes(phantom, whole)), GetPictures(RenderModes(phantom, detail)) });
  ReportUnevenness(report, settings.Window);

  report.AddHeading("Figure 11: the methods");
  const std::vector<NamedPicture> methods = RenderHighQuality(phantom, detail);
  report.AddFigure("figure-11",
    "The phantom magnified, in high quality: ray casting, projective shear-warp, splatting.",
    { GetPictures(methods) });
  ReportSharpness(report, methods);
  report.AddText(JudgeExtreme("1998: \"ray casting image is typically sharper than other two "
                              "images\", as shear-warp interpolates twice.",
    methods, 1, 0));
}

//------------------------------------------------------------------------------
void ReportEncoding(PaperReport& report, const PaperDataSet& data, const PaperTimes& times,
  const PaperSettings& settings)
{
  const PaperVolume& volume = data.Volumes[0];
  std::vector<std::vector<PaperPicture>> panels;
  for (double zoom : { 1.0, 3.0 })
  {
    const splatting::View view =
      MakePaperView(volume, { -80.0, 20.0 }, settings.Window, zoom, glm::dvec2(0.0, 0.1));
    panels.push_back(GetPictures(RenderModes(volume, view)));
    panels.back().insert(
      panels.back().begin(), MakeRenderer(PaperMethod::Encoded, volume)->MakePicture(view));
  }
  report.AddHeading("Figure 12: line encoding");
  report.AddFigure("figure-12",
    "The " + data.Name +
      ": preview with delta encoding, preview, standard and high; whole and magnified.",
    panels);
  ReportEncodingErrors(report, data, times, settings);
}

//------------------------------------------------------------------------------
void ReportResolutions(PaperReport& report, const PaperDataSet& data, const PaperSettings& settings)
{
  report.AddHeading("Figure 13: two resolutions");
  std::vector<std::vector<PaperPicture>> panels;
  std::vector<std::vector<NamedPicture>> named;
  for (const PaperVolume& volume : data.Volumes)
  {
    named.push_back(RenderMethods(
      volume, MakePaperView(volume, { -70.0, 25.0 }, settings.Window, 2.5, glm::dvec2(0.0, 0.13))));
    panels.push_back(GetPictures(named.back()));
  }
  report.AddFigure("figure-13",
    "The " + data.Name +
      " by splatting (preview), ray casting (nearest samples) and projective "
      "shear-warp, in high and low resolution.",
    panels);
  for (const std::vector<NamedPicture>& pictures : named)
  {
    ReportSharpness(report, pictures);
    report.AddText(
      JudgeExtreme("1998: \"splatting creates the smoothest images\".", pictures, -1, 0));
    report.AddText(CompareMethods(pictures));
  }
}
