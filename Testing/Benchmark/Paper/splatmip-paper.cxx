// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The experiments of W. Cai and G. Sakas, "Maximum Intensity Projection Using Splatting in Sheared
 * Object Space", 1998, done again. See --help.
 */
#include "Paper/PaperAccuracy.h"
#include "Paper/PaperFigures.h"
#include "Paper/PaperReport.h"
#include "Paper/PaperScene.h"
#include "Paper/PaperTables.h"
#include "Paper/SplattingRenderer.h"
#include "ProcessorName.h"

#include "vtkSMPTools.h"
#include "vtkVersion.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace
{
struct Options
{
  std::string Data = SPLATTINGMIP_TEST_DATA;
  std::string Folder = "splatmip-paper";
  bool Quick = false;
  bool IsHelp = false;
  std::string Unknown;
};

constexpr const char* help =
  R"(splatmip-paper: the experiments of Cai and Sakas, 1998, done again

Writes report.md, with tables 1 to 5 of the paper beside the numbers of this machine, figures 10 to
13 as PNG pictures, and the errors of splatting and projective shear-warp. Takes some minutes.

  --out=FOLDER  where the report goes; splatmip-paper in the current folder if not given
  --data=DIR    where spine-phantom-ultrasound.mha lies
  --quick       small volumes, few views: whether it works, in a few seconds
)";

bool Starts(const std::string& text, const std::string& start, std::string& rest)
{
  if (text.compare(0, start.size(), start) != 0)
  {
    return false;
  }
  rest = text.substr(start.size());
  return true;
}

Options ParseOptions(int argc, char** argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    if (option == "--quick")
    {
      options.Quick = true;
    }
    else if (option == "--help")
    {
      options.IsHelp = true;
    }
    else if (!Starts(option, "--data=", options.Data) && !Starts(option, "--out=", options.Folder))
    {
      options.Unknown = option;
    }
  }
  return options;
}

PaperSettings MakeSettings(bool isQuick)
{
  PaperSettings settings;
  if (isQuick)
  {
    settings.Voxels = 64;
    settings.Window = 100;
    settings.TurnStep = 45;
    settings.SlowStep = 90;
    settings.Passes = 1;
    settings.AccuracyViews = 2;
  }
  return settings;
}

void ReportMachine(PaperReport& report, const PaperSettings& settings)
{
  report.AddText("# Cai and Sakas 1998, done again");
  report.AddText("Written by `splatmip-paper`. Every \"holds\" and \"does not hold\" is computed "
                 "from the numbers of this run.");
  report.AddList({ "processor: " + GetProcessorName() + " (1998: Sun UltraSPARC 10)",
    "threads: " + std::to_string(vtkSMPTools::GetEstimatedNumberOfThreads()) + " (vtkSMPTools, " +
      vtkSMPTools::GetBackend() + "), for every method",
    std::string("instruction set of splatting: ") +
      splatting::nameOf(splatting::bestInstructionSet()),
    std::string("VTK ") + vtkVersion::GetVTKVersion(),
    "window: " + std::to_string(settings.Window) + "^2 pixels" });
}

void ReportData(PaperReport& report, const std::vector<PaperDataSet>& sets,
  const PaperSettings& settings, const std::vector<std::string>& notes)
{
  report.AddHeading("Data");
  std::vector<std::string> items;
  for (const PaperDataSet& data : sets)
  {
    items.push_back("**" + data.Name + "**: " + data.Origin);
  }
  items.insert(items.end(), notes.begin(), notes.end());
  report.AddList(items);
  const std::string fine = std::to_string(settings.Voxels) + "^3";
  report.AddText("All are made 8-bit (their range becomes 0 to 255) and resampled to " + fine +
    " voxels by linear interpolation, then to half of that along each axis by averaging, as the "
    "paper's. Volumes that were smaller are smoother than measured data of that size, which "
    "favours line encoding.");
}

void ReportMethods(PaperReport& report, const PaperSettings& settings)
{
  report.AddHeading("Tables 1 to 4: times");
  const std::string slow = std::to_string(settings.SlowStep);
  report.AddText("Minimum / maximum / **mean** over a full turn about x and one about y in steps "
                 "of " +
    std::to_string(settings.TurnStep) + " degrees (ray casting and encoded volumes: " + slow +
    " degrees), starting from +z; of each view the fastest of " + std::to_string(settings.Passes) +
    " passes. The window just holds the volume in every view. "
    "All methods end at the same thing, the grey pixels of the window: splatting and projective "
    "shear-warp as projection to the shear image and the same warp, ray casting from the window's "
    "pixels. What is made once per volume (a transposed copy, lines) is in the first frames, "
    "not "
    "in the times.");
  report.AddList(
    { "*Ray casting* is plain floating-point code without index or empty-space skipping, rows "
      "shared out among the threads: samples one voxel apart, nearest or trilinear, or every voxel "
      "crossed (Amanatides and Woo). The paper's Table 1 is \"nearest neighbour, no "
      "interpolation\"; it does not say whether its rays sample or traverse.",
      "*Projective shear-warp* is what the paper says of Yen, Napel and Rubin 1996: slices are "
      "sheared, voxels are not, and each slice gives a pixel the one voxel that the ray meets in "
      "the slice's middle. One shift and one maximum per slice; the slices come from the same "
      "transposed copy as splatting's.",
      "*Splatting, plain* reads all voxels. The paper's four tables are all of preview quality." });
}

void ReportTables(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const std::vector<PaperTimes>& times)
{
  ReportTimes(report, sets, times);
  report.AddHeading("Ratios of the mean times");
  report.AddText("Within 5 % of each other, two methods are taken for equally fast.");
  ReportRatios(report, sets, times);
  report.AddHeading("Table 5: memory");
  report.AddText("MB (2^20 bytes) held besides the volume. Bricks are always among it. The paper "
                 "says that chains exist for all "
                 "three axes, not whether its table counts one or three.");
  ReportMemory(report, sets);
}

void ReportAccuracies(PaperReport& report, const PaperDataSet& data, const PaperSettings& settings)
{
  report.AddHeading("Accuracy");
  report.AddText(
    "1998: \"Splatting in sheared object space generates more accurate results than the original "
    "shear-warp.\" Whether that is so depends on what is true, a pixel being a point or an area "
    "and the volume interpolated or made of boxes. Three truths, on the same shear grid: the "
    "maximum of the trilinear volume along the ray of the pixel's centre (16 samples per slice); "
    "the same averaged over 4x4 rays per pixel (8 samples per slice); the maximum of all voxels "
    "that the ray crosses, which is preview's own definition.");
  ReportAccuracy(report, "Phantom of lines, 64^3", MakeLinePhantom(), settings.AccuracyViews);
  const PaperVolume& volume = data.Volumes[1];
  ReportAccuracy(report, data.Name + ", " + std::to_string(volume.Voxels.size[0]) + "^3", volume,
    settings.AccuracyViews);
}

void Run(const Options& options)
{
  const PaperSettings settings = MakeSettings(options.Quick);
  PaperReport report(options.Folder);
  std::vector<std::string> notes;
  const std::vector<PaperDataSet> sets = LoadPaperData(options.Data, settings.Voxels, notes);
  ReportMachine(report, settings);
  ReportData(report, sets, settings, notes);
  ReportMethods(report, settings);
  std::vector<PaperTimes> times;
  for (const PaperDataSet& data : sets)
  {
    std::cout << "times: " << data.Name << std::endl;
    times.push_back(MeasureTimes(data, settings));
  }
  ReportTables(report, sets, times);
  std::cout << "figures" << std::endl;
  ReportPhantom(report, settings);
  ReportEncoding(report, sets[0], times[0], settings);
  ReportResolutions(report, sets[1], settings); // the ultrasound, or else the phantom
  std::cout << "accuracy" << std::endl;
  ReportAccuracies(report, sets[0], settings);
  std::cout << "The report is " << options.Folder << "/report.md." << std::endl;
}
}

int main(int argc, char** argv)
{
  const Options options = ParseOptions(argc, argv);
  if (!options.Unknown.empty() || options.IsHelp)
  {
    std::cout << help;
    return options.Unknown.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  try
  {
    Run(options);
  }
  catch (const std::exception& error)
  {
    std::cerr << "ERROR: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
