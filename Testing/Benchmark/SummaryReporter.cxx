// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SummaryReporter.h"

#include "BenchmarkStage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <ostream>
#include <sstream>

namespace
{
std::vector<std::string> Split(const std::string& name)
{
  std::vector<std::string> parts;
  std::istringstream stream(name);
  std::string part;
  while (std::getline(stream, part, '/'))
  {
    parts.push_back(part);
  }
  return parts;
}

/// "-" for what was not measured.
std::string Format(double value, int decimals, const char* unit = "")
{
  if (!std::isfinite(value) || value < 0.0)
  {
    return "-";
  }
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f%s", decimals, value, unit);
  return text;
}

/// The ray caster that the mapper is compared with; empty for the ray casters.
std::string FindRival(const std::string& mapper)
{
  for (const BenchmarkMapper& candidate : GetBenchmarkMappers())
  {
    if (candidate.Name == mapper)
    {
      return candidate.Rival;
    }
  }
  return "";
}

/**
 * Rows of cells, padded so that the Markdown is readable as it is. The first columns hold words.
 */
class MarkdownTable
{
public:
  MarkdownTable(std::vector<std::string> titles, std::size_t words)
    : Words(words),
      Rows{ std::move(titles) }
  {
  }

  void Add(std::vector<std::string> cells) { this->Rows.push_back(std::move(cells)); }

  void Print(std::ostream& os) const
  {
    std::vector<std::size_t> widths(this->Rows[0].size(), 3);
    for (const std::vector<std::string>& row : this->Rows)
    {
      for (std::size_t c = 0; c < row.size(); ++c)
      {
        widths[c] = std::max(widths[c], row[c].size());
      }
    }
    for (std::size_t r = 0; r < this->Rows.size(); ++r)
    {
      for (std::size_t c = 0; c < widths.size(); ++c)
      {
        const std::string padding(widths[c] - this->Rows[r][c].size(), ' ');
        os << "| " << (c < this->Words ? this->Rows[r][c] + padding : padding + this->Rows[r][c])
           << ' ';
      }
      os << "|\n";
      for (std::size_t c = 0; r == 0 && c < widths.size(); ++c)
      {
        os << (c < this->Words ? "|:" : "|-") << std::string(widths[c], '-')
           << (c < this->Words ? "-" : ":");
      }
      os << (r == 0 ? "|\n" : "");
    }
  }

private:
  std::size_t Words;
  std::vector<std::vector<std::string>> Rows;
};
}

//------------------------------------------------------------------------------
SummaryReporter::SummaryReporter()
  : Display(benchmark::CreateDefaultDisplayReporter()) // the library keeps it
{
}

//------------------------------------------------------------------------------
bool SummaryReporter::ReportContext(const Context& context)
{
  return this->Display->ReportContext(context);
}

//------------------------------------------------------------------------------
void SummaryReporter::ReportRuns(const std::vector<Run>& runs)
{
  this->Display->ReportRuns(runs);
  for (const Run& run : runs)
  {
    // Mean, deviation and the like are runs, too; so are failures, which have no counters.
    if (run.run_type == Run::RT_Iteration && run.counters.count("median_ms"))
    {
      Result& result = this->FindOrAdd(run.run_name.function_name);
      for (const auto& counter : run.counters)
      {
        result.Values[counter.first].push_back(counter.second.value);
      }
    }
  }
}

//------------------------------------------------------------------------------
void SummaryReporter::Finalize()
{
  this->Display->Finalize();
}

//------------------------------------------------------------------------------
SummaryReporter::Result& SummaryReporter::FindOrAdd(const std::string& name)
{
  const std::vector<std::string> parts = Split(name);
  const auto found = std::find_if(this->Results.begin(), this->Results.end(),
    [&](const Result& result) { return result.Name == parts; });
  if (found != this->Results.end())
  {
    return *found;
  }
  this->Results.push_back({ parts, {} });
  return this->Results.back();
}

//------------------------------------------------------------------------------
const SummaryReporter::Result* SummaryReporter::Find(const std::vector<std::string>& name) const
{
  const auto found = std::find_if(this->Results.begin(), this->Results.end(),
    [&](const Result& result) { return result.Name == name; });
  return found == this->Results.end() ? nullptr : &*found;
}

//------------------------------------------------------------------------------
// The median of the repetitions; NaN if there is none.
double SummaryReporter::Get(const Result* result, const std::string& counter)
{
  if (!result || !result->Values.count(counter))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::vector<double> values = result->Values.at(counter);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintFrames(std::ostream& os) const
{
  MarkdownTable table({ "volume", "window", "mapper", "views", "median ms", "worst ms", "first ms",
                        "peak MB", "ray caster / it", "first / it" },
    3);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] != "frame")
    {
      continue;
    }
    const std::string& mapper = result.Name[3];
    const Result* rival =
      this->Find({ "frame", result.Name[1], result.Name[2], FindRival(mapper) });
    const double median = Get(&result, "median_ms"), first = Get(&result, "first_ms");
    table.Add({ result.Name[1], result.Name[2], mapper, Format(Get(&result, "views"), 0),
      Format(median, 2), Format(Get(&result, "worst_ms"), 2), Format(first, 1),
      Format(Get(&result, "peak_MB"), 1), Format(Get(rival, "median_ms") / median, 1, "x"),
      Format(Get(rival, "first_ms") / first, 1, "x") });
  }
  os << "\nWhole frames, render and read-back. Median and worst of the views; first: the slowest "
        "first frame\nof a fresh mapper along three axes; ray caster / it: raycast-nearest over "
        "preview, raycast-linear\nover the others.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintRecolorings(std::ostream& os) const
{
  MarkdownTable table(
    { "volume", "window", "mode", "views", "median ms", "worst ms", "it / turned" }, 3);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] == "recolor")
    {
      table.Add({ result.Name[1], result.Name[2], result.Name[3], Format(Get(&result, "views"), 0),
        Format(Get(&result, "median_ms"), 2), Format(Get(&result, "worst_ms"), 2),
        Format(Get(&result, "share"), 2, "x") });
    }
  }
  os << "\nWhole frames after a change of window and level: the shear image is used again. Turned: "
        "frames that\nshow another view.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintProjections(std::ostream& os) const
{
  MarkdownTable table({ "volume", "mode", "views", "median ms", "worst ms", "floor ms",
                        "it / floor", "it / dense", "first ms", "first / dense's" },
    2);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] != "projection")
    {
      continue;
    }
    const Result* floor = this->Find({ "floor", result.Name[1] });
    const double median = Get(&result, "median_ms"), least = Get(floor, "median_ms");
    const std::string& mode = result.Name[2];
    const std::string dense = mode.substr(0, mode.find('-')) + "-dense";
    const double first = Get(this->Find({ "first", result.Name[1], mode }), "median_ms");
    table.Add({ result.Name[1], mode, Format(Get(&result, "views"), 0), Format(median, 2),
      Format(Get(&result, "worst_ms"), 2), Format(least, 2), Format(median / least, 2, "x"),
      Format(
        median / Get(this->Find({ "projection", result.Name[1], dense }), "median_ms"), 2, "x"),
      Format(first, 1),
      Format(first / Get(this->Find({ "first", result.Name[1], dense }), "median_ms"), 2, "x") });
  }
  os << "\nThe projection alone, volume to shear image. Floor: the largest byte of the volume, by "
        "the same\nthreads. First: the slowest first frame of a fresh mapper along three axes, "
        "300^2.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintCuts(std::ostream& os) const
{
  MarkdownTable table({ "volume", "mode", "cut", "median ms", "worst ms", "it / uncut" }, 3);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] == "cut")
    {
      const Result* whole = this->Find({ "cut", result.Name[1], result.Name[2], "none" });
      const double median = Get(&result, "median_ms");
      table.Add({ result.Name[1], result.Name[2], result.Name[3], Format(median, 2),
        Format(Get(&result, "worst_ms"), 2), Format(median / Get(whole, "median_ms"), 2, "x") });
    }
  }
  os
    << "\nThe projection alone, cut by clipping planes. Around: planes that leave nothing out.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintIndexes(std::ostream& os) const
{
  MarkdownTable table({ "volume", "bricks ms", "floor ms", "floor GB/s", "bricks / floor" }, 1);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] == "index")
    {
      const Result* floor = this->Find({ "floor", result.Name[1] });
      const double median = Get(&result, "median_ms"), least = Get(floor, "median_ms");
      table.Add({ result.Name[1], Format(median, 2), Format(least, 2),
        Format(Get(floor, "GB_per_s"), 1), Format(median / least, 2, "x") });
    }
  }
  os << "\nMaking the index: range and bricks in one survey.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintTurns(std::ostream& os) const
{
  MarkdownTable table({ "volume", "mode", "views", "ms", "views / s" }, 2);
  for (const Result& result : this->Results)
  {
    if (result.Name[0] == "turn")
    {
      table.Add({ result.Name[1], result.Name[2], Format(Get(&result, "views"), 0),
        Format(Get(&result, "median_ms"), 1), Format(Get(&result, "views_per_s"), 0) });
    }
  }
  os << "\nTurns without OpenGL, 256 x 256 pixels, the index included.\n\n";
  table.Print(os);
}

//------------------------------------------------------------------------------
void SummaryReporter::PrintSummary(
  std::ostream& os, const std::vector<std::pair<std::string, std::string>>& machine) const
{
  if (this->Results.empty())
  {
    return;
  }
  os << "\n";
  for (const auto& fact : machine)
  {
    os << "- " << fact.first << ": " << fact.second << "\n";
  }
  const auto has = [this](const char* what)
  {
    return std::any_of(this->Results.begin(), this->Results.end(),
      [=](const Result& result) { return result.Name[0] == what; });
  };
  if (has("frame"))
  {
    this->PrintFrames(os);
  }
  if (has("recolor"))
  {
    this->PrintRecolorings(os);
  }
  if (has("projection"))
  {
    this->PrintProjections(os);
  }
  if (has("cut"))
  {
    this->PrintCuts(os);
  }
  if (has("index"))
  {
    this->PrintIndexes(os);
  }
  if (has("turn"))
  {
    this->PrintTurns(os);
  }
  os.flush();
}
