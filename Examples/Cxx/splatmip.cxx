// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// splatmip: maximum intensity projections of a volume by vtkSplattingMIPVolumeMapper. Without an
// argument it shows the volume that it carries, in the three quality modes side by side, and how
// long each mode takes beside vtkFixedPointVolumeRayCastMapper. With --rotate it writes a turn by
// vtkSplattingMIPProjection.
#include "MIPScene.h"
#include "PictureSeries.h"
#include "Turn.h"
#include "VolumeReader.h"

#include "vtkCommand.h"
#include "vtkImageAppend.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMPTools.h"
#include "vtkVersion.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
const std::vector<std::string> ModeNames = { "preview", "standard", "high",
  "exact" }; // as QualityModes

struct Options
{
  std::string Input;
  std::string Mode = "all";
  std::string Kernel = "trilinear";
  double KernelRadius = 1.0;
  ViewSettings View;
  std::string Size = "400x600";
  LookSettings Look;
  bool HasWindow = false;
  bool HasLevel = false;
  std::string Output = "splatmip.png";
  bool NoTiming = false;
  bool Interactive = false;
  int Rotate = 0; // views, or 0
  int Rate = 12;
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
  if (options.Rotate > 0 && options.Interactive)
  {
    throw CLI::ValidationError("--rotate", "a turn has no window: leave --interactive out");
  }
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

void DeclareImageOptions(CLI::App& app, Options& options)
{
  app
    .add_option("file", options.Input,
      "A .vti, .vtk, .mha, .mhd, .nrrd, .nhdr, .nii or .nii.gz file, or the folder of a DICOM "
      "series; without it, a built-in CT of a stented aorta")
    ->type_name("FILE");
  app
    .add_option(
      "--mode", options.Mode, "Quality mode, or preview, standard and high (all) side by side")
    ->check(CLI::IsMember({ "preview", "standard", "high", "exact", "all" }))
    ->type_name("MODE")
    ->capture_default_str();
  app.add_option("--kernel", options.Kernel, "Reconstruction kernel of mode high")
    ->check(CLI::IsMember({ "trilinear", "cosine-bell" }))
    ->type_name("KERNEL")
    ->capture_default_str();
  app
    .add_option(
      "--kernel-radius", options.KernelRadius, "Radius of the cosine bell in voxels, 0.5 to 1.5")
    ->check(Between(0.5, 1.5))
    ->type_name("VOXELS")
    ->capture_default_str();
  app
    .add_option("--window", options.Look.Window,
      "Range of values from black to white; default: from the median value to the one that one "
      "voxel in 2000 exceeds")
    ->check(Between(1e-30, 1e30))
    ->type_name("VALUE");
  app.add_option("--level", options.Look.Level, "Value in the middle of that range")
    ->check(Between(-1e30, 1e30))
    ->type_name("VALUE");
  app.add_option("--colormap", options.Look.Colormap, "Colours")
    ->check(CLI::IsMember(GetColormapNames()))
    ->type_name("COLORMAP")
    ->capture_default_str();
}

void DeclareViewOptions(CLI::App& app, Options& options)
{
  const CLI::Validator angle = Between(-360.0, 360.0);
  app
    .add_option("--azimuth", options.View.Azimuth,
      "Degrees that the camera goes round, from the patient's front to the left side")
    ->check(angle)
    ->type_name("DEGREES")
    ->capture_default_str();
  app.add_option("--elevation", options.View.Elevation, "Degrees that the camera rises")
    ->check(angle)
    ->type_name("DEGREES")
    ->capture_default_str();
  app.add_option("--roll", options.View.Roll, "Degrees that the camera turns clockwise")
    ->check(angle)
    ->type_name("DEGREES")
    ->capture_default_str();
  app.add_option("--zoom", options.View.Zoom, "Enlargement; 1 fits the volume")
    ->check(Between(0.01, 1000.0))
    ->type_name("FACTOR")
    ->capture_default_str();
  app.add_option("--size", options.Size, "Pixels of each picture")
    ->check(CLI::Validator(CheckSize, ""))
    ->type_name("WxH")
    ->capture_default_str();
  app
    .add_option("--output,--out", options.Output,
      "The picture to write, .png; with --rotate .gif, .avi or .ogv (films), or .png (numbered "
      "pictures)")
    ->type_name("FILE")
    ->capture_default_str();
  app
    .add_option("--rotate", options.Rotate,
      "Once round the patient in so many views, 2 to 3600, from --azimuth on, in one mode (high "
      "unless --mode names one); needs no display")
    ->check(CLI::Range(2, 3600))
    ->type_name("VIEWS");
  app.add_option("--rate", options.Rate, "Views per second of a GIF or film")
    ->check(CLI::Range(1, 50))
    ->type_name("VIEWS")
    ->capture_default_str();
  app.add_flag("--no-timing", options.NoTiming, "Only draw");
  app.add_flag("--interactive", options.Interactive,
    "Open a window instead: drag to turn, 1, 2 and 3 switch the mode, q quits");
  app.set_version_flag(
    "--version", std::string("splatmip " SPLATMIP_VERSION ", VTK ") + vtkVersion::GetVTKVersion());
}

Options ParseOptions(CLI::App& app, int argc, char* argv[])
{
  Options options;
  DeclareImageOptions(app, options);
  DeclareViewOptions(app, options);
  app.parse(argc, argv);
  CheckOutputName(options);
  options.HasWindow = app.count("--window") > 0;
  options.HasLevel = app.count("--level") > 0;
  std::sscanf(options.Size.c_str(), "%5dx%5d", &options.View.Size[0], &options.View.Size[1]);
  return options;
}

LookSettings CompleteLook(const Options& options, vtkImageData* image)
{
  LookSettings look = options.Look;
  double window, level;
  ChooseWindowLevel(image, window, level);
  look.Window = options.HasWindow ? look.Window : window;
  look.Level = options.HasLevel ? look.Level : level;
  return look;
}

void PrintVolume(const Volume& volume, const LookSettings& look)
{
  const int* size = volume.Image->GetDimensions();
  std::printf("%s: %d x %d x %d voxels, %s", volume.Name.c_str(), size[0], size[1], size[2],
    volume.Image->GetScalarTypeAsString());
  std::printf("%s%s\n", volume.Note.empty() ? "" : ", ", volume.Note.c_str());
  std::printf("shown with window %g, level %g\n", look.Window, look.Level);
  std::fflush(stdout);
}

std::string FormatTime(double milliseconds)
{
  char text[32];
  std::snprintf(text, sizeof(text), milliseconds < 100 ? "%.1f ms" : "%.0f ms", milliseconds);
  return text;
}

/**
 * Times the modes and prints a line for each. The ray caster is measured with the interpolation
 * that comes next to the mode, each only once.
 */
class TimeTable
{
public:
  TimeTable(MIPScene& scene, const ViewSettings& view) : Scene(scene)
  {
    std::printf("\nWhole frame, view to pixels: median of %d frames of %d x %d, turned by one "
                "degree each; %d threads, %s\n",
      MIPScene::NumberOfTimedFrames, view.Size[0], view.Size[1],
      vtkSMPTools::GetEstimatedNumberOfThreads(), scene.GetSplatting()->GetInstructionSet());
    std::printf("%-10s %12s   vtkFixedPointVolumeRayCastMapper\n", "mode", "splatting");
  }

  /**
   * Leaves the scene in the given mode and returns that mode's time in milliseconds.
   */
  double AddMode(int mode)
  {
    const bool isPreview = mode == vtkSplattingMIPVolumeMapper::PREVIEW;
    const int interpolation = isPreview ? VTK_NEAREST_INTERPOLATION : VTK_LINEAR_INTERPOLATION;
    double& rayCasting = this->RayCasting[interpolation];
    if (rayCasting == 0.0)
    {
      this->Scene.UseRayCasting(interpolation);
      rayCasting = this->Scene.MeasureFrame("ray casting");
    }
    this->Scene.UseSplatting(mode);
    const double splatting = this->Scene.MeasureFrame(ModeNames[mode]);
    std::printf("%-10s %12s   %12s (%s), %.1f times as long\n", ModeNames[mode].c_str(),
      FormatTime(splatting).c_str(), FormatTime(rayCasting).c_str(),
      isPreview ? "nearest" : "linear", rayCasting / splatting);
    std::fflush(stdout);
    return splatting;
  }

private:
  MIPScene& Scene;
  double RayCasting[2] = { 0.0, 0.0 };
};

void WritePictures(MIPScene& scene, const Options& options)
{
  std::vector<int> modes = { vtkSplattingMIPVolumeMapper::PREVIEW,
    vtkSplattingMIPVolumeMapper::STANDARD, vtkSplattingMIPVolumeMapper::HIGH };
  if (options.Mode != "all")
  {
    modes = { static_cast<int>(
      std::find(ModeNames.begin(), ModeNames.end(), options.Mode) - ModeNames.begin()) };
  }
  std::unique_ptr<TimeTable> table;
  if (!options.NoTiming)
  {
    table = std::make_unique<TimeTable>(scene, options.View);
  }
  vtkNew<vtkImageAppend> row;
  for (const int mode : modes)
  {
    std::string label = ModeNames[mode];
    label += table ? "  " + FormatTime(table->AddMode(mode)) : "";
    scene.UseSplatting(mode);
    row->AddInputData(scene.TakePicture(label));
  }
  row->Update();
  const std::filesystem::path path = std::filesystem::absolute(options.Output);
  WritePNG(row->GetOutput(), path.string());
  std::printf("\npicture: %s\n", path.string().c_str());
}

/**
 * The trackball, with keys for the modes in place of VTK's usual keys.
 */
class ModeKeys : public vtkInteractorStyleTrackballCamera
{
public:
  static ModeKeys* New();
  vtkTypeMacro(ModeKeys, vtkInteractorStyleTrackballCamera);

  void OnChar() override
  {
    const std::string keys = "123psh";
    const std::size_t key = keys.find(this->Interactor->GetKeyCode());
    if (key != std::string::npos)
    {
      this->Scene->UseSplatting(static_cast<int>(key % 3));
      this->Interactor->Render();
    }
    else if (this->Interactor->GetKeyCode() == 'q')
    {
      this->Interactor->TerminateApp();
    }
  }

  MIPScene* Scene = nullptr;

protected:
  ModeKeys() = default;
  ~ModeKeys() override = default;

private:
  ModeKeys(const ModeKeys&) = delete;
  void operator=(const ModeKeys&) = delete;
};

vtkStandardNewMacro(ModeKeys);

/**
 * After a frame that projected anew: say the mode and how long the volume took, and draw once more
 * for the label to be seen. That frame re-uses the projection, so there is no third.
 */
class LabelUpdate : public vtkCommand
{
public:
  static LabelUpdate* New() { return new LabelUpdate; }

  void Execute(vtkObject*, unsigned long, void*) override
  {
    vtkSplattingMIPVolumeMapper* mapper = this->Scene->GetSplatting();
    if (mapper->GetNumberOfProjections() != this->NumberOfProjections)
    {
      this->NumberOfProjections = mapper->GetNumberOfProjections();
      this->Scene->SetLabel(
        ModeNames[mapper->GetQualityMode()] + "  " + FormatTime(1000.0 * mapper->GetTimeToDraw()));
      this->Scene->GetWindow()->Render();
    }
  }

  MIPScene* Scene = nullptr;
  vtkIdType NumberOfProjections = 0;
};

void Interact(MIPScene& scene, const Options& options)
{
  const auto start = std::find(ModeNames.begin(), ModeNames.end(), options.Mode);
  scene.UseSplatting(start == ModeNames.end() ? vtkSplattingMIPVolumeMapper::HIGH
                                              : static_cast<int>(start - ModeNames.begin()));
  vtkNew<LabelUpdate> label;
  label->Scene = &scene;
  scene.GetWindow()->AddObserver(vtkCommand::EndEvent, label);

  vtkNew<ModeKeys> keys;
  keys->Scene = &scene;
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(scene.GetWindow());
  interactor->SetInteractorStyle(keys);
  scene.GetWindow()->SetWindowName("splatmip: 1 preview, 2 standard, 3 high, q quit");
  scene.GetWindow()->Render();
  interactor->Start();
  scene.GetWindow()->RemoveObserver(label);
}

void WriteTurn(const Volume& volume, const LookSettings& look, const Options& options)
{
  Turn turn(volume, look, options.View, options.Rotate);
  const auto mode = std::find(ModeNames.begin(), ModeNames.end(), options.Mode);
  turn.GetProjection()->SetQualityMode(mode == ModeNames.end()
      ? vtkSplattingMIPProjection::HIGH
      : static_cast<int>(mode - ModeNames.begin()));
  turn.GetProjection()->SetKernel(options.Kernel == "cosine-bell"
      ? vtkSplattingMIPProjection::COSINE_BELL
      : vtkSplattingMIPProjection::TRILINEAR);
  turn.GetProjection()->SetKernelRadius(options.KernelRadius);
  const auto views = turn.Project();
  if (!options.NoTiming)
  {
    std::printf("\n%d views of %d x %d in %.2f s, %.0f per second; %d threads, %s\n",
      options.Rotate, options.View.Size[0], options.View.Size[1], turn.GetSeconds(),
      options.Rotate / turn.GetSeconds(), vtkSMPTools::GetEstimatedNumberOfThreads(),
      turn.GetProjection()->GetInstructionSet());
  }
  const std::filesystem::path path = std::filesystem::absolute(options.Output);
  WriteSeries(views, turn.GetPalette(), options.Rate, path.string());
  std::printf("\nturn: %s\n", path.string().c_str());
}

void Run(const Options& options)
{
  const Volume volume = options.Input.empty() ? ReadBuiltInVolume() : ReadVolume(options.Input);
  const LookSettings look = CompleteLook(options, volume.Image);
  PrintVolume(volume, look);
  if (options.Rotate > 0)
  {
    WriteTurn(volume, look, options);
    return;
  }
  MIPScene scene(volume, look, options.View, !options.Interactive);
  scene.GetSplatting()->SetKernel(options.Kernel == "cosine-bell"
      ? vtkSplattingMIPVolumeMapper::COSINE_BELL
      : vtkSplattingMIPVolumeMapper::TRILINEAR);
  scene.GetSplatting()->SetKernelRadius(options.KernelRadius);
  if (options.Interactive)
  {
    Interact(scene, options);
  }
  else
  {
    WritePictures(scene, options);
  }
}
}

int main(int argc, char* argv[])
{
  CLI::App app(
    "Maximum intensity projection of a volume by splatting in sheared object space", "splatmip");
  try
  {
    Run(ParseOptions(app, argc, argv));
    return 0;
  }
  catch (const CLI::Success& request) // --help, --version
  {
    return app.exit(request);
  }
  catch (const CLI::ParseError& error)
  {
    std::cerr << "splatmip: " << error.what() << "; see splatmip --help.\n";
    return 2;
  }
  catch (const std::exception& error)
  {
    std::cerr << "splatmip: " << error.what() << "\n";
    return 1;
  }
}
