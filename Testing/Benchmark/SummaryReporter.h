// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SummaryReporter_h
#define SummaryReporter_h

#include <benchmark/benchmark.h>

#include <iosfwd>
#include <map>
#include <string>
#include <utility>
#include <vector>

/**
 * Passes everything on to the reporter that Google Benchmark would use, and remembers it for a
 * summary in Markdown.
 */
class SummaryReporter : public benchmark::BenchmarkReporter
{
public:
  SummaryReporter();

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

  /**
   * The machine, the frames with their ratios to the ray casters, and the projections with theirs
   * to the floor. Nothing if nothing was measured.
   */
  void PrintSummary(
    std::ostream& os, const std::vector<std::pair<std::string, std::string>>& machine) const;

private:
  using Counters = std::map<std::string, std::vector<double>>; // one value per repetition

  struct Result
  {
    std::vector<std::string> Name; // between the slashes
    Counters Values;
  };

  Result& FindOrAdd(const std::string& name);
  const Result* Find(const std::vector<std::string>& name) const;
  static double Get(const Result* result, const std::string& counter);
  void PrintFrames(std::ostream& os) const;
  void PrintRecolorings(std::ostream& os) const;
  void PrintProjections(std::ostream& os) const;
  void PrintCuts(std::ostream& os) const;
  void PrintIndexes(std::ostream& os) const;
  void PrintTurns(std::ostream& os) const;

  benchmark::BenchmarkReporter* Display;
  std::vector<Result> Results; // in the order of the runs
};

#endif
