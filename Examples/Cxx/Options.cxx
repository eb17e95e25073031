// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "Reading/Reading.h"
#include "Writing/PictureSeries.h"
#include "Writing/ValueFile.h"

#include "vtkNamedColors.h"
#include "vtkNew.h"
#include "vtkSplattingMIPProjection.h"
#include "vtkVersion.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <utility>

const std::vector<std::string> ModeNames = { "preview", "standard", "high", "exact" };

namespace
{
/**
 * Options that are words.
 */
struct Words
{
  std::string Mode = "exact";
  std::string Kernel = "trilinear";
  std::string Blend = "max";
  std::vector<double> Crop;
  std::string Blending = "over";
  std::string Colors;
  std::string View;
  std::string Size = "400x600";
  std::string Output = "splatmip.png";
};

/// Azimuth and elevation of --view.
const struct
{
  const char* Name;
  double Azimuth, Elevation;
} Sides[] = { { "anterior", 0, 0 }, { "posterior", 180, 0 }, { "left", 90, 0 }, { "right", -90, 0 },
  { "superior", 0, 90 }, { "inferior", 0, -90 } };

/**
 * Check a size. CLI11's checks return what is wrong with a text, or nothing.
 */
std::string CheckSize(const std::string& text)
{
  int width = 0, height = 0;
  char rest = 0;
  const int found = std::sscanf(text.c_str(), "%5dx%5d%c", &width, &height, &rest);
  return found == 2 && width >= 16 && height >= 16 && width <= 8192 && height <= 8192
    ? ""
    : "not a size such as 400x600, from 16x16 to 8192x8192";
}

std::string CheckComponentWord(const std::string& text)
{
  int number = 0;
  char rest = 0;
  const bool isNumber = std::sscanf(text.c_str(), "%5d%c", &number, &rest) == 1 && number > 0;
  return isNumber || text == "luminance" || text == "magnitude"
    ? ""
    : "not a number from 1 on, luminance or magnitude";
}

std::vector<std::string> SplitColors(const std::string& text)
{
  std::vector<std::string> colors;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
  {
    colors.push_back(word);
  }
  return colors;
}

std::string CheckColors(const std::string& text)
{
  vtkNew<vtkNamedColors> names;
  const auto colors = SplitColors(text);
  const bool areKnown = std::all_of(colors.begin(), colors.end(),
    [&](const std::string& color) { return names->ColorExists(color); });
  return !colors.empty() && areKnown ? "" : "not names of colours such as red,lime";
}

/**
 * Make a check for finite numbers in a range. NaN passes CLI11's own check.
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
 * A group of options in --help.
 */
class Group
{
public:
  Group(CLI::App& app, std::string name) : App(app), Name(std::move(name)) {}

  template <class Value>
  CLI::Option* Add(const char* name, Value& value, const char* type, const CLI::Validator& check,
    const std::string& text)
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
    .add_option("file", options.Inputs,
      "A " + JoinWords(GetVolumeEndings()) +
        " file, a DICOM file, a DICOMDIR or a folder with DICOM files. Default: a built-in CT of a "
        "stented aorta. Several files are several volumes, which --blending combines; give the "
        "slices of one volume as a folder")
    ->type_name("FILE");
  Group group(app, "Input");
  group.Add("--series", options.Read.Series, "NUMBER", Between(1, 99999),
    "Number of a DICOM series in the printed list. Default: that of the file, or the largest");
  group.Add("--frame", options.Read.Frame, "NUMBER", Between(1, 99999),
    "Number of the volume to show, where the file has several, such as times or echoes. Default: "
    "the first");
  group.Add("--channel", options.Read.Channel, "NUMBER", Between(1, 99999),
    "Number of a channel of a TIFF stack by ImageJ or OME. Default: the first");
  group.Add("--array", options.Read.Array, "NAME", CLI::Validator(),
    "Name of an array of a VTK file. Default: the active one, or the first");
  group.Add("--component", options.Read.Component, "NUMBER", CLI::Validator(CheckComponentWord, ""),
    "Number of the component to show; or luminance, for red, green and blue; or magnitude, for "
    "vectors. Default: the first");
}

void DeclareProjectionOptions(CLI::App& app, Options& options, Words& words)
{
  Group group(app, "Projection");
  group.AddChoice("--mode", words.Mode, "MODE", { "preview", "standard", "high", "exact", "all" },
    "Quality mode, or all of them side by side (stills only)");
  group.AddChoice("--kernel", words.Kernel, "KERNEL", { "trilinear", "cosine-bell" },
    "Reconstruction kernel of mode high");
  group
    .Add("--kernel-radius", options.Projection.KernelRadius, "VOXELS", Between(0.5, 1.5),
      "Radius of the cosine bell in voxels, 0.5 to 1.5")
    ->capture_default_str();
  group.AddChoice("--blend", words.Blend, "BLEND", { "max", "min", "mean", "signed" },
    "Show the largest value along each ray, the least, the mean, or with signed the one of the "
    "largest and the least that is farther from --origin");
  group
    .Add("--origin", options.Projection.Origin, "VALUE", Between(-1e30, 1e30),
      "Value that --blend signed measures distances from")
    ->capture_default_str();
  group.AddFlag("--depth-shading", options.Projection.DepthShading,
    "Dim values by their distance from the viewer, then find the largest");
  group.Add("--slab", options.Projection.Slab, "MM", Between(1e-6, 1e9),
    "Thickness of a slab across the view, in the middle of the volume. Default: the whole volume");
  group
    .Add("--slab-offset", options.Projection.SlabOffset, "MM", Between(-1e9, 1e9),
      "Distance by which the slab is moved towards the viewer")
    ->needs("--slab");
  group
    .Add("--crop", words.Crop, "MM", Between(-1e9, 1e9),
      "Box to show, by six numbers: from and to along each axis of the volume, from its first "
      "voxel on, as in 0,200,0,200,50,150")
    ->expected(6)
    ->delimiter(',');
  group.Add("--mask", options.Mask.Path, "FILE", CLI::Validator(),
    "File of a mask: show only voxels whose nearest voxel of the mask is not 0");
  group.Add("--label", options.Mask.Label, "NUMBER", Between(1, 999999999),
    "Show only voxels with this number in the mask or the DICOM segmentation");
}

void DeclareLookOptions(CLI::App& app, Options& options, Words& words)
{
  Group group(app, "Colours");
  group.Add("--window", options.Look.Window, "VALUE", Between(1e-30, 1e30),
    "Range of values from black to white. Default: that of the file, or from the median to the "
    "value that one voxel in 2000 exceeds; with --blend signed, the same distance on both sides of "
    "--origin");
  group.Add("--level", options.Look.Level, "VALUE", Between(-1e30, 1e30),
    "Value in the middle of that range. Default: as for --window");
  group.AddChoice("--colormap", options.Look.Colormap, "COLORMAP", GetColormapNames(),
    "Colormap. Default of --blend signed: cold-hot, which diverges from black");
  group.Add("--color", words.Colors, "COLOR,...", CLI::Validator(CheckColors, ""),
    "Colours from black to this one, in place of a colormap, one for each file: names of CSS or "
    "vtkNamedColors, of "
    "which green is dark and lime bright. Default for several files: gray for the first, the "
    "--colormap (then hot by default) for the others");
  group.Add("--blending", words.Blending, "BLENDING", CLI::IsMember({ "over", "add", "maximum" }),
    "Combine the pictures of several files, each with a window of its own, at the positions in the "
    "files, in a view that fits all: each over those before it, with an opacity that rises "
    "linearly over its window; or by the sum or the maximum of each colour channel");
  group.AddFlag("--depth-coding", options.DepthCoding,
    "Show depth as hue, from red (near) over green to blue (far). The picture has a legend");
}

void DeclareViewOptions(CLI::App& app, Options& options, Words& words)
{
  const CLI::Validator angle = Between(-360.0, 360.0);
  Group group(app, "View");
  CLI::Option* const view = group.Add("--view", words.View, "SIDE", CLI::IsMember(ListNames(Sides)),
    "Side of the patient, in place of --azimuth and --elevation");
  group
    .Add("--azimuth", options.View.Azimuth, "DEGREES", angle,
      "Rotation of the camera around the patient, from the front to the left side")
    ->capture_default_str()
    ->excludes(view);
  group
    .Add("--elevation", options.View.Elevation, "DEGREES", angle,
      "Elevation of the camera above the horizontal plane")
    ->capture_default_str()
    ->excludes(view);
  group
    .Add("--roll", options.View.Roll, "DEGREES", angle,
      "Clockwise rotation of the camera about its axis")
    ->capture_default_str();
  group
    .Add("--zoom", options.View.Zoom, "FACTOR", Between(0.01, 1000.0),
      "Magnification; 1 fits the volume")
    ->capture_default_str();
  group.Add("--perspective", options.View.Perspective, "DEGREES", Between(1.0, 120.0),
    "Angle of a perspective view of the volume. Default: parallel rays");
  group
    .Add(
      "--size", words.Size, "WxH", CLI::Validator(CheckSize, ""), "Size of each picture in pixels")
    ->capture_default_str();
}

void DeclareOutputOptions(CLI::App& app, Options& options, Words& words)
{
  Group group(app, "Output");
  group
    .Add("--output,--out", words.Output, "FILE", CLI::Validator(),
      "Picture to write, .png, or its values in the file's unit, " + JoinWords(GetValueEndings()) +
        "; with --rotate, a film or numbered pictures, " + JoinWords(GetSeriesEndings()) +
        " (DICOM, a multi-frame secondary capture)")
    ->capture_default_str();
  group.Add("--rotate", options.Rotate, "VIEWS", Between(2, 3600),
    "Write a turn around the patient of 2 to 3600 views, from --azimuth on");
  group.Add("--rate", options.Rate, "VIEWS", Between(1, 50), "Views per second of a film")
    ->capture_default_str();
  group.AddFlag("--no-marks", options.NoMarks,
    "Leave out the scale bar and the letters for the patient's sides, which are drawn if the file "
    "has voxel size and orientation");
  group.AddFlag("--compare", options.Compare,
    "Also measure the times of the modes and of VTK's ray caster (needs a display; takes a while)");
  group.AddFlag("--interactive", options.Interactive,
    "Open a window instead of writing: drag to turn, keys 1 to 4 switch the mode, q quits");
}

void CheckOutputName(const Options& options)
{
  const bool isPNG = std::filesystem::path(options.Output).extension() == ".png";
  const bool isStill = isPNG || (IsValueFile(options.Output) && !options.Compare);
  const std::string fault = options.Rotate > 0 ? CheckSeriesName(options.Output)
    : isStill                                  ? ""
              : "not a name that ends in .png, or for values in " + JoinWords(GetValueEndings());
  if (!fault.empty())
  {
    throw CLI::ValidationError("--output", fault);
  }
}

std::vector<int> ChooseModes(const std::string& name)
{
  const auto mode = std::find(ModeNames.begin(), ModeNames.end(), name);
  if (mode != ModeNames.end())
  {
    return { static_cast<int>(mode - ModeNames.begin()) };
  }
  return { vtkSplattingMIPProjection::PREVIEW, vtkSplattingMIPProjection::STANDARD,
    vtkSplattingMIPProjection::HIGH, vtkSplattingMIPProjection::EXACT };
}

void TranslateWords(const Words& words, Options& options)
{
  std::sscanf(words.Size.c_str(), "%5dx%5d", &options.View.Size[0], &options.View.Size[1]);
  for (const auto& side : Sides)
  {
    if (side.Name == words.View)
    {
      options.View.Azimuth = side.Azimuth;
      options.View.Elevation = side.Elevation;
    }
  }
  ProjectionSettings& settings = options.Projection;
  settings.Kernel = words.Kernel == "cosine-bell" ? vtkSplattingMIPProjection::COSINE_BELL
                                                  : vtkSplattingMIPProjection::TRILINEAR;
  settings.BlendMode = words.Blend == "min" ? vtkSplattingMIPProjection::MINIMUM_INTENSITY_BLEND
    : words.Blend == "mean"                 ? vtkSplattingMIPProjection::AVERAGE_INTENSITY_BLEND
                                            : vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND;
  settings.Signed = words.Blend == "signed";
  options.Colors = SplitColors(words.Colors);
  options.Blending = words.Blending == "add" ? vtkSplattingMIPVolumeMapper::ADD
    : words.Blending == "maximum"            ? vtkSplattingMIPVolumeMapper::MAXIMUM
                                             : vtkSplattingMIPVolumeMapper::OVER;
  settings.Cropping = !words.Crop.empty();
  std::copy(words.Crop.begin(), words.Crop.end(), settings.Crop.begin());
}

/**
 * Declare options that do not go together, or need a file.
 */
void DeclareCombinations(CLI::App& app)
{
  const std::pair<const char*, std::vector<const char*>> exclusions[] = {
    { "--interactive", { "--compare", "--rotate", "--slab-offset" } },
    { "--compare",
      { "--rotate", "--blend", "--depth-shading", "--depth-coding", "--slab", "--crop",
        "--mask" } },
    { "--slab-offset", { "--rotate" } }, { "--depth-coding", { "--colormap", "--color" } },
    { "--color", { "--colormap" } }
  };
  for (const auto& [name, others] : exclusions)
  {
    for (const char* const other : others)
    {
      app.get_option(name)->excludes(app.get_option(other));
    }
  }
  for (const char* const name : { "--series", "--frame", "--channel", "--array", "--component" })
  {
    app.get_option(name)->needs(app.get_option("file"));
  }
}

/**
 * Refuse words of options that do not go together.
 */
void CheckCombinations(const Options& options)
{
  const ProjectionSettings& settings = options.Projection;
  if (options.Modes.size() > 1 &&
    (options.Interactive || options.Rotate > 0 || IsValueFile(options.Output)))
  {
    throw CLI::ValidationError("--mode", "all is for stills; choose one mode");
  }
  if (settings.DepthShading &&
    (settings.Signed || settings.BlendMode != vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND))
  {
    throw CLI::ValidationError("--depth-shading", "it is for maxima; leave --blend out");
  }
  if (options.DepthCoding &&
    (settings.BlendMode == vtkSplattingMIPProjection::AVERAGE_INTENSITY_BLEND ||
      IsValueFile(options.Output)))
  {
    throw CLI::ValidationError(
      "--depth-coding", "means have no depth, and values have no colours; leave it out");
  }
  if (options.DepthCoding && settings.Signed)
  {
    throw CLI::ValidationError(
      "--depth-coding", "signed maxima have colours of their own; leave it out");
  }
  if (!options.Colors.empty() && settings.Signed)
  {
    throw CLI::ValidationError("--color", "signed maxima have two colours; leave it out");
  }
  const std::size_t volumes = std::max<std::size_t>(options.Inputs.size(), 1);
  if (!options.Colors.empty() && options.Colors.size() != volumes)
  {
    throw CLI::ValidationError("--color", "give as many colours as files");
  }
  if (settings.Origin != 0.0 && !settings.Signed)
  {
    throw CLI::ValidationError("--origin", "it is for --blend signed");
  }
  for (int axis = 0; axis < 3 && settings.Cropping; ++axis)
  {
    if (!(settings.Crop[2 * axis] < settings.Crop[2 * axis + 1]))
    {
      throw CLI::ValidationError("--crop", "each pair of numbers must rise, as in 0,50,0,50,20,80");
    }
  }
}

/**
 * Refuse several files with options that are for one.
 */
void CheckSeveral(const CLI::App& app, const Options& options)
{
  if (options.Inputs.size() < 2)
  {
    return;
  }
  if (app.count("--blending") == 0)
  {
    throw CLI::ValidationError("file",
      "several files are several volumes and need --blending; give the slices of one volume as a "
      "folder");
  }
  for (const char* const name :
    { "--series", "--frame", "--channel", "--array", "--component", "--crop", "--mask", "--label",
      "--window", "--level", "--depth-coding", "--compare", "--interactive" })
  {
    if (app.count(name) > 0)
    {
      throw CLI::ValidationError(name, "it is for one file; leave it out, or give one file");
    }
  }
  if (options.Projection.Signed)
  {
    throw CLI::ValidationError("--blend", "signed is for one file; choose another one");
  }
  if (std::filesystem::path(options.Output).extension() == ".dcm" || IsValueFile(options.Output))
  {
    throw CLI::ValidationError("--output", "several volumes are written as .png or .ogv");
  }
}

const char* const Examples = R"(Examples:
  splatmip scan.nii.gz --azimuth 30 --output scan.png
      a picture, the camera 30 degrees to the patient's left
  splatmip dicom-folder --view left --slab 30 --window 600 --level 300
      a slab of 30 mm of the largest series in a folder, white from the value 600 on
  splatmip dapi.tif actin.tif --color blue,lime --blending add
      two channels in one picture; for PET over CT: splatmip ct pet --blending over
  splatmip dicom-folder --rotate 36 --output turn.ogv
      a film of a turn around the patient; for other films write numbered pictures by --output
      turn.png, then: ffmpeg -i turn-%05d.png turn.gif
)";

/// Appends the examples as they are: newer versions of CLI11 wrap the lines of a footer.
class HelpWithExamples : public CLI::Formatter
{
public:
  std::string make_help(
    const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override
  {
    return Formatter::make_help(app, std::move(name), mode) + Examples;
  }
};
}

Options ParseOptions(CLI::App& app, int argc, char* argv[])
{
  Options options;
  Words words;
  DeclareVolumeOptions(app, options);
  DeclareProjectionOptions(app, options, words);
  DeclareLookOptions(app, options, words);
  DeclareViewOptions(app, options, words);
  DeclareOutputOptions(app, options, words);
  DeclareCombinations(app);
  app.set_version_flag(
    "--version", std::string("splatmip " SPLATMIP_VERSION ", VTK ") + vtkVersion::GetVTKVersion());
  app.formatter(std::make_shared<HelpWithExamples>());
  app.parse(argc, argv);

  options.Modes = ChooseModes(words.Mode);
  TranslateWords(words, options);
  if (words.Output.empty())
  {
    throw CLI::ValidationError("--output", "the name of a file is missing");
  }
  options.Output = std::filesystem::absolute(words.Output).string();
  options.HasWindow = app.count("--window") > 0;
  options.HasLevel = app.count("--level") > 0;
  if (options.Projection.Signed && app.count("--colormap") == 0)
  {
    options.Look.Colormap = "cold-hot";
  }
  else if (options.Inputs.size() > 1 && app.count("--colormap") == 0)
  {
    options.Look.Colormap = "hot";
  }
  CheckCombinations(options);
  CheckSeveral(app, options);
  CheckOutputName(options);
  return options;
}
