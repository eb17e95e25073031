// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// splatmip: maximum intensity projections of a volume by splatting. Without an argument it writes a
// picture of the built-in volume. Stills and turns are made by vtkSplattingMIPProjection, which
// needs no display; windows are drawn by vtkSplattingMIPVolumeMapper.
#include "MIPScene.h"
#include "Options.h"
#include "Projector.h"
#include "Reading/Mask.h"
#include "Reading/Reading.h"
#include "Reading/VolumeReader.h"
#include "Writing/Picture.h"
#include "Writing/PictureSeries.h"
#include "Writing/SafeFiles.h"
#include "Writing/ValueFile.h"

#include "vtkCommand.h"
#include "vtkImageAppend.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMPTools.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
/**
 * Complete the look: the user's window, else the file's, else one from the values. The file's
 * window is not meant for signed maxima.
 */
LookSettings CompleteLook(const Options& options, const Volume& volume)
{
  LookSettings look = options.Look;
  double window = volume.Window, level = volume.Level;
  if (options.Projection.Signed)
  {
    ChooseSignedWindow(volume.Image, options.Projection.Origin, window, level);
  }
  else if (window <= 0.0)
  {
    ChooseWindowLevel(volume.Image, options.Projection.BlendMode, window, level);
  }
  look.Window = options.HasWindow ? look.Window : window;
  look.Level = options.HasLevel ? look.Level : level;
  return look;
}

void PrintVolume(const Volume& volume, const LookSettings& look)
{
  const int* size = volume.Image->GetDimensions();
  std::printf("%s: %d x %d x %d voxels, %s\n", MakePrintable(volume.Name).c_str(), size[0], size[1],
    size[2], volume.Image->GetScalarTypeAsString());
  for (const std::string& note : volume.Notes)
  {
    std::printf("%s\n", MakePrintable(note).c_str());
  }
  std::printf("shown with window %g, level %g\n", look.Window, look.Level);
  std::fflush(stdout);
}

/**
 * Draw the views with labels and marks.
 */
vtkSmartPointer<vtkImageData> DrawViews(
  Projector& projector, const Volume& volume, const Options& options, std::string label)
{
  vtkSplattingMIPProjection* const projection = projector.GetProjection();
  projection->SetRecordLocations(options.DepthCoding);
  auto views = projector.Project(label.empty() ? "projecting" : "projecting, " + label);
  const auto add = [&label](const std::string& line)
  { label += label.empty() || line.empty() ? line : "\n" + line; };
  add(volume.Caution);
  if (options.DepthCoding)
  {
    const DepthRange range = FindDepthRange(projection);
    views = ColorByDepth(views, projection, range);
    add(DescribeHues(range, volume.IsInMillimeters));
  }
  DrawLabel(views, label);
  if (volume.IsOriented && !options.NoMarks)
  {
    DrawSides(views, projection);
  }
  if (volume.IsInMillimeters && !options.NoMarks)
  {
    DrawScaleBar(views, projection->GetOutputSpacing()[0]);
  }
  return views;
}

/**
 * Times the modes and prints a line for each, beside the ray caster with the most similar
 * interpolation.
 */
class Comparison
{
public:
  Comparison(const Volume& volume, const LookSettings& look, const Options& options);

  /**
   * Return a mode's time in milliseconds.
   */
  double AddMode(int mode);

private:
  MIPScene Scene;
  double RayCasting[2] = { 0.0, 0.0 };
};

Comparison::Comparison(const Volume& volume, const LookSettings& look, const Options& options)
  : Scene(volume, options.Projection, look, options.View, true)
{
  std::printf("\nWhole frame, view to pixels: median of %d frames of %d x %d, turned by one "
              "degree each; %d threads, %s\n",
    MIPScene::NumberOfTimedFrames, options.View.Size[0], options.View.Size[1],
    vtkSMPTools::GetEstimatedNumberOfThreads(), this->Scene.GetSplatting()->GetInstructionSet());
  std::printf("%-10s %12s   vtkFixedPointVolumeRayCastMapper\n", "mode", "splatting");
}

double Comparison::AddMode(int mode)
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
    FormatTime(splatting).c_str(), FormatTime(rayCasting).c_str(), isPreview ? "nearest" : "linear",
    rayCasting / splatting);
  std::fflush(stdout);
  return splatting;
}

/**
 * Write the modes side by side, or the values of one.
 */
void WriteStill(const Volume& volume, const LookSettings& look, const Options& options)
{
  std::unique_ptr<Comparison> comparison;
  if (options.Compare)
  {
    comparison = std::make_unique<Comparison>(volume, look, options);
  }
  Projector projector(volume, options.Projection, look, options.View, 1);
  const auto palette = MakePalette(look);
  if (IsValueFile(options.Output))
  {
    projector.GetProjection()->SetQualityMode(options.Modes.front());
    projector.Project("projecting");
    WriteValues(projector.GetProjection()->GetOutput(), volume.Origin, options.Output);
    std::printf("\nvalues: %s\n", options.Output.c_str());
    return;
  }
  vtkNew<vtkImageAppend> row;
  for (const int mode : options.Modes)
  {
    const std::string time = comparison ? "  " + FormatTime(comparison->AddMode(mode)) : "";
    projector.GetProjection()->SetQualityMode(mode);
    const auto views = DrawViews(projector, volume, options, ModeNames[mode] + time);
    row->AddInputData(Paint(views, palette, 0));
  }
  row->Update();
  WriteSafely({ options.Output },
    [&](const std::vector<std::string>& names)
    { return WritePNG(row->GetOutput(), names.front()); });
  std::printf("\npicture: %s\n", options.Output.c_str());
}

void WriteTurn(const Volume& volume, const LookSettings& look, const Options& options)
{
  Projector projector(volume, options.Projection, look, options.View, options.Rotate);
  projector.GetProjection()->SetQualityMode(options.Modes.front());
  const auto views = DrawViews(projector, volume, options, "");
  std::printf("\n%d views of %d x %d in %.2f s, %.0f per second; %d threads, %s\n", options.Rotate,
    options.View.Size[0], options.View.Size[1], projector.GetSeconds(),
    options.Rotate / projector.GetSeconds(), vtkSMPTools::GetEstimatedNumberOfThreads(),
    projector.GetProjection()->GetInstructionSet());
  const FilmSettings film = { MakePalette(look), options.Rate, volume.IsInMillimeters,
    volume.Study };
  WriteSeries(views, film, options.Output);
  std::printf("\nturn: %s\n", options.Output.c_str());
}

struct Session
{
  MIPScene Scene;
  vtkNew<vtkRenderWindowInteractor> Interactor;
  vtkIdType NumberOfProjections = 0;

  /**
   * Switch the mode or quit. VTK's usual keys are disabled, because the style has an observer.
   */
  void OnChar(vtkObject*, unsigned long, void*)
  {
    const char key = this->Interactor->GetKeyCode();
    if (key >= '1' && key < '1' + static_cast<int>(ModeNames.size()))
    {
      this->Scene.UseSplatting(key - '1');
      this->Interactor->Render();
    }
    else if (key == 'q')
    {
      this->Interactor->TerminateApp();
    }
  }

  /**
   * Show the mode and its time after each frame that was projected anew. The window is rendered
   * once more to show the label; that frame re-uses the projection, so there is no third.
   */
  void UpdateLabel(vtkObject*, unsigned long, void*)
  {
    vtkSplattingMIPVolumeMapper* const mapper = this->Scene.GetSplatting();
    if (mapper->GetNumberOfProjections() != this->NumberOfProjections)
    {
      this->NumberOfProjections = mapper->GetNumberOfProjections();
      this->Scene.SetLabel(
        ModeNames[mapper->GetQualityMode()] + "  " + FormatTime(1000.0 * mapper->GetTimeToDraw()));
      this->Scene.GetWindow()->Render();
    }
  }
};

/**
 * Show a volume in a window until the user closes it.
 */
void Interact(const Volume& volume, const LookSettings& look, const Options& options)
{
  Session session{ { volume, options.Projection, look, options.View, false }, {}, 0 };
  session.Scene.UseSplatting(options.Modes.front());
  session.Scene.GetSplatting()->SetDepthCoding(options.DepthCoding);
  vtkRenderWindow* const window = session.Scene.GetWindow();
  const auto label = window->AddObserver(vtkCommand::EndEvent, &session, &Session::UpdateLabel);
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  style->AddObserver(vtkCommand::CharEvent, &session, &Session::OnChar);
  session.Interactor->SetRenderWindow(window);
  session.Interactor->SetInteractorStyle(style);
  window->SetWindowName("splatmip: 1 preview, 2 standard, 3 high, 4 exact, q quit");
  window->Render();
  session.Interactor->Start();
  window->RemoveObserver(label);
}

std::vector<std::string> GetOutputFiles(const Options& options)
{
  return options.Rotate > 0 ? GetSeriesFiles(options.Output, options.Rotate)
                            : std::vector<std::string>{ options.Output };
}

/**
 * Check display and outputs before the volume is read.
 */
void CheckBeforehand(const Options& options)
{
  if (options.Compare || options.Interactive)
  {
    CheckDisplay();
  }
  if (!options.Interactive)
  {
    const auto outputs = GetOutputFiles(options);
    CheckNotInput(outputs, { options.Input, options.Mask.Path });
    CheckWritable(outputs);
  }
}

void Run(const Options& options)
{
  CheckBeforehand(options);
  ReadSettings read = options.Read;
  read.Label = options.Mask.Path.empty() ? options.Mask.Label : 0;
  read.HidesPadding = options.Projection.Signed ||
    options.Projection.BlendMode != vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND;
  Volume volume = options.Input.empty() ? ReadBuiltInVolume() : ReadVolume(options.Input, read);
  if (!options.Mask.Path.empty())
  {
    ApplyMask(options.Mask, volume);
  }
  else if (options.Mask.Label != 0 && !volume.HasLabels)
  {
    throw std::runtime_error(
      "--label is for a --mask or a DICOM segmentation; give one, or leave --label out.");
  }
  if (!options.Interactive)
  {
    CheckNotInput(GetOutputFiles(options), volume.Files);
  }
  const LookSettings look = CompleteLook(options, volume);
  PrintVolume(volume, look);
  if (options.Interactive)
  {
    Interact(volume, look, options);
  }
  else if (options.Rotate > 0)
  {
    WriteTurn(volume, look, options);
  }
  else
  {
    WriteStill(volume, look, options);
  }
}
}

int main(int argc, char* argv[])
{
  KeepIgnoredSignals();
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
    std::cerr << "splatmip: " << MakePrintable(error.what()) << "\n";
    return 1;
  }
}
