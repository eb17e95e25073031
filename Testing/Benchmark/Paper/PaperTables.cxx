// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperTables.h"

#include "Paper/SplattingRenderer.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace
{
using splatting::Quality;
using Row = std::vector<std::string>;

/// Minimum, maximum and mean, in seconds, in high and low resolution.
using PaperSeconds = std::array<std::array<double, 3>, 2>;

struct MethodFacts
{
  std::string Name;
  std::string Table; // of the paper
  PaperSeconds Paper;
};

const MethodFacts& GetFacts(PaperMethod method)
{
  const PaperSeconds none{};
  const std::string delta = "N = " + std::to_string(PaperTolerance);
  // clang-format off
  static const std::map<PaperMethod, MethodFacts> facts = {
    { PaperMethod::RayNearest, { "ray casting, nearest samples", "1",
        { { { 2.33, 4.27, 3.11 }, { 1.12, 1.71, 1.32 } } } } },
    { PaperMethod::RayCrossed, { "ray casting, every voxel crossed", "", none } },
    { PaperMethod::RayLinear, { "ray casting, trilinear samples", "", none } },
    { PaperMethod::Plain, { "splatting, preview, plain", "2",
        { { { 5.40, 9.91, 7.44 }, { 0.69, 1.10, 0.93 } } } } },
    { PaperMethod::PlainStandard, { "splatting, standard, plain", "", none } },
    { PaperMethod::PlainHigh, { "splatting, high, plain", "", none } },
    { PaperMethod::Projective, { "projective shear-warp", "3",
        { { { 3.77, 4.48, 4.02 }, { 0.35, 0.49, 0.40 } } } } },
    { PaperMethod::Encoded, { "splatting, preview, encoded and sorted, " + delta, "4",
        { { { 1.17, 2.37, 1.70 }, { 0.17, 0.37, 0.26 } } } } },
    { PaperMethod::EncodedLossless, { "splatting, preview, encoded and sorted, N = 0", "", none } },
    { PaperMethod::EncodedStandard, { "splatting, standard, encoded, " + delta, "", none } },
    { PaperMethod::EncodedHigh, { "splatting, high, encoded, " + delta, "", none } },
    { PaperMethod::Automatic, { "splatting, preview, by the module's own choice", "", none } },
  };
  // clang-format on
  return facts.at(method);
}

/// Whether a full turn in small steps would take minutes.
bool IsSlow(PaperMethod method)
{
  return method <= PaperMethod::RayLinear ||
    (method >= PaperMethod::Encoded && method <= PaperMethod::EncodedHigh);
}

//------------------------------------------------------------------------------
// Times

double MeasureFrame(PaperRenderer& renderer, const splatting::View& view)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  renderer.Render(view);
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

/// Turns about x and y, in degrees.
std::vector<glm::dvec2> ListTurns(int step)
{
  std::vector<glm::dvec2> turns;
  for (int axis = 0; axis < 2; ++axis)
  {
    for (int angle = 0; angle < 360; angle += step)
    {
      turns.push_back(axis == 0 ? glm::dvec2(angle, 0.0) : glm::dvec2(0.0, angle));
    }
  }
  return turns;
}

/// Milliseconds of one pass through the views.
struct Pass
{
  double Preparation = 0.0;
  std::vector<double> Frames;
};

Pass MeasurePass(PaperMethod method, const PaperVolume& volume, const PaperSettings& settings)
{
  const std::unique_ptr<PaperRenderer> renderer = MakeRenderer(method, volume);
  const auto measure = [&](const glm::dvec2& turn)
  { return MeasureFrame(*renderer, MakePaperView(volume, turn, settings.Window)); };
  Pass pass;
  // +z, and the other two axes.
  for (const glm::dvec2& turn : { glm::dvec2(0.0), glm::dvec2(90.0, 0.0), glm::dvec2(0.0, 90.0) })
  {
    pass.Preparation += measure(turn);
  }
  for (const glm::dvec2& turn : ListTurns(IsSlow(method) ? settings.SlowStep : settings.TurnStep))
  {
    pass.Frames.push_back(measure(turn));
  }
  return pass;
}

/// The fastest of the passes counts, view by view: whatever else the machine does only adds time.
PaperTiming Summarise(const std::vector<Pass>& passes)
{
  Pass best = passes[0];
  for (const Pass& pass : passes)
  {
    best.Preparation = std::min(best.Preparation, pass.Preparation);
    for (std::size_t view = 0; view < best.Frames.size(); ++view)
    {
      best.Frames[view] = std::min(best.Frames[view], pass.Frames[view]);
    }
  }
  PaperTiming timing;
  timing.Preparation = best.Preparation;
  timing.Views = static_cast<int>(best.Frames.size());
  timing.Mean = std::accumulate(best.Frames.begin(), best.Frames.end(), 0.0) / timing.Views;
  timing.Minimum = *std::min_element(best.Frames.begin(), best.Frames.end());
  timing.Maximum = *std::max_element(best.Frames.begin(), best.Frames.end());
  return timing;
}

std::string Cube(const PaperDataSet& data, int resolution)
{
  return std::to_string(data.Volumes[resolution].Voxels.size[0]) + "^3";
}

std::string DescribeTiming(const PaperTiming& timing)
{
  return Short(timing.Minimum) + " / " + Short(timing.Maximum) + " / **" + Short(timing.Mean) +
    "**";
}

std::string DescribePaper(const MethodFacts& facts, int resolution)
{
  const std::array<double, 3>& seconds = facts.Paper[resolution];
  return facts.Table.empty()
    ? "-"
    : Fixed(seconds[0], 2) + " / " + Fixed(seconds[1], 2) + " / **" + Fixed(seconds[2], 2) + "**";
}

//------------------------------------------------------------------------------
// Ratios of mean times

struct Ratio
{
  PaperMethod A;
  PaperMethod B;
  int Resolution;

  /// How many times as long A takes as B; 0 where the paper does not say.
  double GetPaper() const
  {
    const double b = GetFacts(this->B).Paper[this->Resolution][2];
    return b > 0.0 ? GetFacts(this->A).Paper[this->Resolution][2] / b : 0.0;
  }
  double Get(const PaperTimes& times) const
  {
    return times.at(this->A)[this->Resolution].Mean / times.at(this->B)[this->Resolution].Mean;
  }
};

std::vector<Ratio> ListRatios()
{
  using M = PaperMethod;
  const std::pair<M, M> pairs[] = { { M::Plain, M::RayNearest }, { M::Projective, M::Plain },
    { M::Projective, M::RayNearest }, { M::Encoded, M::Plain }, { M::Encoded, M::RayNearest },
    { M::Plain, M::RayCrossed }, { M::PlainStandard, M::RayLinear }, { M::PlainHigh, M::RayLinear },
    { M::EncodedLossless, M::Plain }, { M::EncodedStandard, M::PlainStandard },
    { M::EncodedHigh, M::PlainHigh }, { M::Automatic, M::Plain } };
  std::vector<Ratio> ratios;
  for (const auto& pair : pairs)
  {
    for (int resolution = 0; resolution < 2; ++resolution)
    {
      ratios.push_back({ pair.first, pair.second, resolution });
    }
  }
  return ratios;
}

/// Which of the two is faster: -1 or 1, 0 within 5 %.
int Order(double ratio)
{
  return ratio < 1.0 / 1.05 ? -1 : ratio > 1.05 ? 1 : 0;
}

/// What the order in the paper is worth here.
std::string Judge(double paper, const std::vector<double>& ours)
{
  const auto agrees = [&](double ratio) { return Order(ratio) == Order(paper); };
  const auto count = std::count_if(ours.begin(), ours.end(), agrees);
  return count == static_cast<std::ptrdiff_t>(ours.size()) ? "holds"
    : count == 0                                           ? "does not hold"
                                                           : "depends on the data";
}

/// "takes 1.2 to 1.3 times as long".
std::string Compare(double low, double high)
{
  const std::string range =
    Short(low) == Short(high) ? Short(low) : Short(low) + " to " + Short(high);
  return "takes " + range + " times as long";
}

std::vector<double> GetRatios(const Ratio& ratio, const std::vector<PaperTimes>& times)
{
  std::vector<double> ours;
  for (const PaperTimes& one : times)
  {
    ours.push_back(ratio.Get(one));
  }
  return ours;
}

std::string MakeSentence(
  const Ratio& ratio, const std::string& cube, const std::vector<double>& ours)
{
  const auto range = std::minmax_element(ours.begin(), ours.end());
  const double paper = ratio.GetPaper();
  const std::string paperCube = ratio.Resolution == 0 ? "256^3" : "128^3";
  return "In 1998, at " + paperCube + ", *" + GetName(ratio.A) + "* was " +
    (paper > 1.0 ? "slower" : "faster") + " than *" + GetName(ratio.B) + "* (" + Short(paper) +
    " times its time). Here, at " + cube + ", it " + Compare(*range.first, *range.second) +
    ": on this machine that order **" + Judge(paper, ours) + "**.";
}

//------------------------------------------------------------------------------
// Memory

double ToMegabytes(std::size_t bytes)
{
  return static_cast<double>(bytes) / (1 << 20); // the paper's 256^3 voxels are 16 MB
}

/// What is held besides the volume after views along the axes: z, or all three.
double MeasureMemory(const PaperVolume& volume, PaperEncoding encoding, int tolerance, bool allAxes)
{
  SplattingRenderer renderer(volume, Quality::Standard, encoding, tolerance);
  renderer.Render(MakePaperView(volume, { 0.0, 0.0 }, 64));
  if (allAxes)
  {
    renderer.Render(MakePaperView(volume, { 90.0, 0.0 }, 64));
    renderer.Render(MakePaperView(volume, { 0.0, 90.0 }, 64));
  }
  return ToMegabytes(renderer.GetIndexMemory());
}

struct Memory
{
  double Volume = 0.0;
  double Plain = 0.0;
  double OneAxis = 0.0;
  double AllAxes = 0.0;
  double AllAxesDelta = 0.0;
};

Memory MeasureMemory(const PaperVolume& volume)
{
  Memory memory;
  memory.Volume = ToMegabytes(volume.Voxels.voxels.size());
  memory.Plain = MeasureMemory(volume, PaperEncoding::Plain, 0, true);
  memory.OneAxis = MeasureMemory(volume, PaperEncoding::Lines, 0, false);
  memory.AllAxes = MeasureMemory(volume, PaperEncoding::Lines, 0, true);
  memory.AllAxesDelta = MeasureMemory(volume, PaperEncoding::Lines, PaperTolerance, true);
  return memory;
}

std::string Percent(double part, double whole)
{
  return Fixed(100.0 * part / whole, 0) + " %";
}

std::string MakeMemorySentence(const std::string& name, const Memory& memory, double paper)
{
  return name + ": the lossless lines of one axis take " + Percent(memory.OneAxis, memory.Volume) +
    " of the volume, those of three axes with delta encoding " +
    Percent(memory.AllAxesDelta, memory.Volume) + " (1998: " + Percent(paper, 1.0) +
    "). That encoding the three axes saves memory **" +
    (memory.AllAxesDelta < memory.Volume ? "holds" : "does not hold") + "** for these data.";
}
}

//------------------------------------------------------------------------------
std::vector<PaperMethod> ListPaperMethods()
{
  std::vector<PaperMethod> methods;
  for (int n = 0; n <= static_cast<int>(PaperMethod::Automatic); ++n)
  {
    methods.push_back(static_cast<PaperMethod>(n));
  }
  return methods;
}

//------------------------------------------------------------------------------
std::string GetName(PaperMethod method)
{
  return GetFacts(method).Name;
}

//------------------------------------------------------------------------------
std::unique_ptr<PaperRenderer> MakeRenderer(PaperMethod method, const PaperVolume& volume)
{
  const auto cast = [&](RayCastRenderer::Caster caster)
  { return std::make_unique<RayCastRenderer>(volume, caster); };
  const auto splat = [&](Quality quality, PaperEncoding encoding, int tolerance)
  { return std::make_unique<SplattingRenderer>(volume, quality, encoding, tolerance); };
  switch (method)
  {
    case PaperMethod::RayNearest:
      return cast(reference::castNearest);
    case PaperMethod::RayCrossed:
      return cast(reference::castThroughVoxels);
    case PaperMethod::RayLinear:
      return cast(reference::castTrilinear);
    case PaperMethod::Projective:
      return std::make_unique<ProjectiveRenderer>(volume);
    case PaperMethod::Plain:
      return splat(Quality::Preview, PaperEncoding::Plain, 0);
    case PaperMethod::PlainStandard:
      return splat(Quality::Standard, PaperEncoding::Plain, 0);
    case PaperMethod::PlainHigh:
      return splat(Quality::High, PaperEncoding::Plain, 0);
    case PaperMethod::Encoded:
      return splat(Quality::Preview, PaperEncoding::SortedLines, PaperTolerance);
    case PaperMethod::EncodedLossless:
      return splat(Quality::Preview, PaperEncoding::SortedLines, 0);
    case PaperMethod::EncodedStandard:
      return splat(Quality::Standard, PaperEncoding::Lines, PaperTolerance);
    case PaperMethod::EncodedHigh:
      return splat(Quality::High, PaperEncoding::Lines, PaperTolerance);
    case PaperMethod::Automatic:
      break;
  }
  return splat(Quality::Preview, PaperEncoding::Automatic, 0);
}

//------------------------------------------------------------------------------
PaperTimes MeasureTimes(const PaperDataSet& data, const PaperSettings& settings)
{
  const std::vector<PaperMethod> methods = ListPaperMethods();
  std::map<PaperMethod, std::array<std::vector<Pass>, 2>> passes;
  // Method after method in each pass: what else the machine does for some seconds then spoils no
  // method's fastest pass.
  for (int pass = 0; pass < settings.Passes; ++pass)
  {
    for (PaperMethod method : methods)
    {
      for (int resolution = 0; resolution < 2; ++resolution)
      {
        passes[method][resolution].push_back(
          MeasurePass(method, data.Volumes[resolution], settings));
      }
    }
  }
  PaperTimes times;
  for (PaperMethod method : methods)
  {
    times[method] = { Summarise(passes[method][0]), Summarise(passes[method][1]) };
  }
  return times;
}

//------------------------------------------------------------------------------
void ReportTimes(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const std::vector<PaperTimes>& times)
{
  for (std::size_t n = 0; n < sets.size(); ++n)
  {
    std::vector<Row> rows;
    for (PaperMethod method : ListPaperMethods())
    {
      const MethodFacts& facts = GetFacts(method);
      const auto& timing = times[n].at(method);
      rows.push_back({ facts.Name, DescribeTiming(timing[0]), DescribeTiming(timing[1]),
        std::to_string(timing[0].Views),
        Short(timing[0].Preparation) + ", " + Short(timing[1].Preparation),
        facts.Table.empty() ? "-" : facts.Table, DescribePaper(facts, 0),
        DescribePaper(facts, 1) });
    }
    report.AddText("### " + sets[n].Name);
    report.AddTable({ "method", Cube(sets[n], 0) + ", ms", Cube(sets[n], 1) + ", ms", "views",
                      "first frames, ms", "paper's table", "256^3, s, 1998", "128^3, s, 1998" },
      rows);
  }
}

//------------------------------------------------------------------------------
void ReportRatios(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const std::vector<PaperTimes>& times)
{
  Row head = { "how many times as long as", "takes", "at", "paper" };
  for (const PaperDataSet& data : sets)
  {
    head.push_back(data.Name);
  }
  head.push_back("the paper's order");
  std::vector<Row> rows;
  std::vector<std::string> sentences;
  for (const Ratio& ratio : ListRatios())
  {
    const std::vector<double> ours = GetRatios(ratio, times);
    const double paper = ratio.GetPaper();
    const std::string cube = Cube(sets[0], ratio.Resolution);
    Row row = { GetName(ratio.B), GetName(ratio.A), cube, paper > 0.0 ? Short(paper) : "-" };
    for (double our : ours)
    {
      row.push_back(Short(our));
    }
    row.push_back(paper > 0.0 ? Judge(paper, ours) : "-");
    rows.push_back(row);
    if (paper > 0.0)
    {
      sentences.push_back(MakeSentence(ratio, cube, ours));
    }
  }
  report.AddTable(head, rows);
  report.AddList(sentences);
}

//------------------------------------------------------------------------------
void ReportMemory(PaperReport& report, const std::vector<PaperDataSet>& sets)
{
  const double paper[2][2] = { { 16.0, 6.245 }, { 2.0, 1.017 } };
  const std::string delta = "N = " + std::to_string(PaperTolerance);
  std::vector<Row> rows;
  std::vector<std::string> sentences;
  for (const PaperDataSet& data : sets)
  {
    for (int resolution = 0; resolution < 2; ++resolution)
    {
      const Memory memory = MeasureMemory(data.Volumes[resolution]);
      rows.push_back(
        { data.Name, Cube(data, resolution), Fixed(memory.Volume, 2), Fixed(memory.Plain, 2),
          Fixed(memory.OneAxis, 2), Fixed(memory.AllAxes, 2), Fixed(memory.AllAxesDelta, 2),
          Fixed(paper[resolution][1], 3) + " of " + Fixed(paper[resolution][0], 1) });
      sentences.push_back(MakeMemorySentence(data.Name + ", " + Cube(data, resolution), memory,
        paper[resolution][1] / paper[resolution][0]));
    }
  }
  report.AddTable({ "data", "resolution", "volume, MB", "plain: bricks, copy for one axis",
                    "lines of the z axis, N = 0", "lines of three axes, N = 0",
                    "lines of three axes, " + delta, "paper" },
    rows);
  report.AddList(sentences);
}
