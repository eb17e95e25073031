// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "PictureSeries.h"

#include "vtkSplattingMIPProjection.h"
#include "vtkVersion.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>

const std::vector<std::string> ModeNames = { "preview", "standard", "high", "exact" };

namespace
{
/**
 * What the command line says in words.
 */
struct Words
{
  std::string Mode = "all";
  std::string Kernel = "trilinear";
  std::string Size = "400x600";
  std::string Output = "splatmip.png";
};

/**
 * What CLI11 asks of a check: nothing if the text is fine, else what is wrong with it.
 */
std::string CheckSize(const std::string& text)
{
  int width = 0, height = 0;
  char rest = 0;
  const int found = std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &rest);
  return found == 2 && width >= 16 && height >= 16 && width <= 8192 && height <= 8192
    ? ""
    : "not a size such as 400x600, each between 16 and 8192";
}

/**
 * A check for finite numbers in a range; CLI11's own lets NaN pass.
 */
CLI::Validator Between(double low, double high)
{
  const auto check = [low, high](const std::string& text)
  {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    std::ostringstream message;
    message << "not a number from " << low << " to " << high;
    return end != text.c_str() && *end == 0 && value >= low && value <= high ? "" : message.str();
  };
  return CLI::Validator(check, "");
}

/**
 * A heading in --help, and what is declared under it.
 */
class Group
{
public:
  Group(CLI::App& app, std::string name) : App(app), Name(std::move(name)) {}

  template <class Value>
  CLI::Option* Add(
    const char* name, Value& value, const char* type, const CLI::Validator& check, const char* text)
  {
    return this->App.add_option(name, value, text)
      ->check(check)
      ->type_name(type)
      ->group(this->Name);
  }

  void AddChoice(const char* name, std::string& choice, const char* type,
    const std::vector<std::string>& names, const char* text)
  {
    this->Add(name, choice, type, CLI::IsMember(names), text)->capture_default_str();
  }

  void AddFlag(const char* name, bool& flag, const char* text)
  {
    this->App.add_flag(name, flag, text)->group(this->Name);
  }

private:
  CLI::App& App;
  std::string Name;
};

void DeclareVolumeOptions(CLI::App& app, Options& options)
{
  app
    .add_option("file", options.Input,
      "A .vti, .vtk, .mha, .mhd, .nrrd, .nhdr, .nii, .nii.gz, .hdr, .img or .tif file, or a DICOM "
      "file, a DICOMDIR "
      "or "
      "a folder with DICOM files; without it, a built-in CT of a stented aorta")
    ->type_name("FILE");
  Group group(app, "Which volume");
  group.Add("--series", options.Read.Series, "NUMBER", Between(1, 99999),
    "Of several DICOM series, as their list counts them; default: the largest, or that of the "
    "file");
  group.Add("--frame", options.Read.Frame, "NUMBER", Between(1, 99999),
    "Of several volumes at the same place, such as times or echoes; default: the first");
}

void DeclareProjectionOptions(CLI::App& app, Options& options, Words& words)
{
  Group group(app, "What is projected");
  group.AddChoice("--mode", words.Mode, "MODE", { "preview", "standard", "high", "exact", "all" },
    "Quality mode, or preview, standard and high (all) side by side");
  group.AddChoice("--kernel", words.Kernel, "KERNEL", { "trilinear", "cosine-bell" },
    "Reconstruction kernel of mode high");
  group
    .Add("--kernel-radius", options.KernelRadius, "VOXELS", Between(0.5, 1.5),
      "Radius of the cosine bell in voxels, 0.5 to 1.5")
    ->capture_default_str();
}

void DeclareLookOptions(CLI::App& app, Options& options)
{
  Group group(app, "How values are shown");
  group.Add("--window", options.Look.Window, "VALUE", Between(1e-30, 1e30),
    "Range of values from black to white; default: the file's, or from the median value to the one "
    "that one voxel in 2000 exceeds");
  group.Add("--level", options.Look.Level, "VALUE", Between(-1e30, 1e30),
    "Value in the middle of that range");
  group.AddChoice("--colormap", options.Look.Colormap, "COLORMAP", GetColormapNames(), "Colours");
}

void DeclareViewOptions(CLI::App& app, Options& options, Words& words)
{
  const CLI::Validator angle = Between(-360.0, 360.0);
  Group group(app, "From where");
  group
    .Add("--azimuth", options.View.Azimuth, "DEGREES", angle,
      "Degrees that the camera goes round, from the patient's front to the left side")
    ->capture_default_str();
  group
    .Add("--elevation", options.View.Elevation, "DEGREES", angle, "Degrees that the camera rises")
    ->capture_default_str();
  group
    .Add("--roll", options.View.Roll, "DEGREES", angle, "Degrees that the camera turns clockwise")
    ->capture_default_str();
  group
    .Add("--zoom", options.View.Zoom, "FACTOR", Between(0.01, 1000.0),
      "Enlargement; 1 fits the volume")
    ->capture_default_str();
  group.Add("--size", words.Size, "WxH", CLI::Validator(CheckSize, ""), "Pixels of each picture")
    ->capture_default_str();
}

void DeclareOutputOptions(CLI::App& app, Options& options, Words& words)
{
  Group group(app, "What comes out");
  group
    .Add("--output,--out", words.Output, "FILE", CLI::Validator(),
      "The picture to write, .png; with --rotate .gif, .avi or .ogv (films), or .png (numbered "
      "pictures)")
    ->capture_default_str();
  group.Add("--rotate", options.Rotate, "VIEWS", Between(2, 3600),
    "Once round the patient in so many views, 2 to 3600, from --azimuth on, in one mode (high "
    "unless --mode names one)");
  group.Add("--rate", options.Rate, "VIEWS", Between(1, 50), "Views per second of a GIF or film")
    ->capture_default_str();
  group.AddFlag("--compare", options.Compare,
    "Also time the modes beside VTK's ray caster, which takes a while, in a window (needs a "
    "display)");
  group.AddFlag("--interactive", options.Interactive,
    "Open a window instead: drag to turn, 1, 2 and 3 switch the mode, q quits");
}

void RequireOneResult(const Options& options)
{
  if (options.Interactive + options.Compare + (options.Rotate > 0) > 1)
  {
    throw CLI::ValidationError("--rotate, --compare, --interactive", "choose one of them");
  }
}

void CheckOutputName(const Options& options)
{
  const bool isPNG = std::filesystem::path(options.Output).extension() == ".png";
  const std::string fault = options.Rotate > 0 ? CheckSeriesName(options.Output)
    : isPNG                                    ? ""
                                               : "not a name that ends in .png";
  if (!fault.empty())
  {
    throw CLI::ValidationError("--output", fault);
  }
}

std::vector<int> ChooseModes(const std::string& name, bool isOne)
{
  const auto mode = std::find(ModeNames.begin(), ModeNames.end(), name);
  if (mode != ModeNames.end())
  {
    return { static_cast<int>(mode - ModeNames.begin()) };
  }
  return isOne ? std::vector<int>{ vtkSplattingMIPProjection::HIGH }
               : std::vector<int>{ vtkSplattingMIPProjection::PREVIEW,
                   vtkSplattingMIPProjection::STANDARD, vtkSplattingMIPProjection::HIGH };
}

const char* const Examples = R"(Examples:
  splatmip scan.nii.gz --mode high --azimuth 30 --output scan.png
      a picture, the camera 30 degrees to the patient's left
  splatmip dicom-folder --mode exact --window 600 --level 300
      the largest series in a folder, white from the value 600 on
  splatmip dicom-folder --rotate 36 --output turn.gif
      a film once round the patient)";
}

Options ParseOptions(CLI::App& app, int argc, char* argv[])
{
  Options options;
  Words words;
  DeclareVolumeOptions(app, options);
  DeclareProjectionOptions(app, options, words);
  DeclareLookOptions(app, options);
  DeclareViewOptions(app, options, words);
  DeclareOutputOptions(app, options, words);
  app.set_version_flag(
    "--version", std::string("splatmip " SPLATMIP_VERSION ", VTK ") + vtkVersion::GetVTKVersion());
  app.footer(Examples);
  app.parse(argc, argv);

  options.Modes = ChooseModes(words.Mode, options.Interactive || options.Rotate > 0);
  options.Kernel = words.Kernel == "cosine-bell" ? vtkSplattingMIPProjection::COSINE_BELL
                                                 : vtkSplattingMIPProjection::TRILINEAR;
  std::sscanf(words.Size.c_str(), "%5dx%5d", &options.View.Size[0], &options.View.Size[1]);
  options.Output = std::filesystem::absolute(words.Output).string();
  options.HasWindow = app.count("--window") > 0;
  options.HasLevel = app.count("--level") > 0;
  RequireOneResult(options);
  CheckOutputName(options);
  return options;
}
