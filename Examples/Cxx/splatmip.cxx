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
#include "Writing/Blending.h"
#include "Writing/Picture.h"
#include "Writing/PictureSeries.h"
#include "Writing/SafeFiles.h"
#include "Writing/ValueFile.h"

#include "vtkCommand.h"
#include "vtkImageAppend.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkSMPTools.h"

#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace
{
/**
 * A volume, and how it is shown.
 */
struct Layer
{
  Volume Data;
  LookSettings Look;
};

/**
 * Complete the look of volume n: the user's window, else the file's, else one from the values. The
 * file's window is not meant for signed maxima.
 */
LookSettings CompleteLook(const Options& options, const Volume& volume, std::size_t n)
{
  LookSettings look = options.Look;
  if (!options.Colors.empty())
  {
    look.Color = options.Colors[n];
  }
  else if (n == 0 && options.Inputs.size() > 1)
  {
    look.Colormap = "gray";
  }
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
 * Make a projector for each volume, with the same views.
 */
std::vector<Projector> MakeProjectors(
  const std::vector<Layer>& layers, const Options& options, int views)
{
  std::vector<vtkImageData*> images;
  for (const Layer& layer : layers)
  {
    images.push_back(layer.Data.Image);
  }
  const auto frame = MakeFrame(images);
  std::vector<Projector> projectors;
  for (const Layer& layer : layers)
  {
    projectors.emplace_back(layer.Data, frame, options.Projection, layer.Look, options.View, views);
  }
  return projectors;
}

/**
 * Draw the views with labels and marks: bytes for one volume, colours for several.
 */
vtkSmartPointer<vtkImageData> DrawViews(std::vector<Projector>& projectors, int mode,
  const std::vector<Layer>& layers, const Options& options, std::string label)
{
  std::vector<PaletteSlices> slices;
  for (std::size_t n = 0; n < layers.size(); ++n)
  {
    projectors[n].GetProjection()->SetQualityMode(mode);
    projectors[n].GetProjection()->SetRecordLocations(options.DepthCoding);
    slices.push_back({ projectors[n].Project(label.empty() ? "projecting" : "projecting, " + label),
      MakePalette(layers[n].Look) });
  }
  auto views = layers.size() == 1 ? slices.front().Bytes : Blend(slices, options.Blending);
  const Volume& volume = layers.front().Data;
  vtkSplattingMIPProjection* const projection = projectors.front().GetProjection();
  const auto add = [&label](const std::string& line)
  { label += label.empty() || line.empty() ? line : "\n" + line; };
  for (const Layer& layer : layers)
  {
    add(layer.Data.Caution);
  }
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
void WriteStill(const std::vector<Layer>& layers, const Options& options)
{
  const auto& [volume, look] = layers.front();
  std::unique_ptr<Comparison> comparison;
  if (options.Compare)
  {
    comparison = std::make_unique<Comparison>(volume, look, options);
  }
  auto projectors = MakeProjectors(layers, options, 1);
  if (IsValueFile(options.Output))
  {
    Projector& projector = projectors.front();
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
    const auto views = DrawViews(projectors, mode, layers, options, ModeNames[mode] + time);
    row->AddInputData(Paint(views, MakePalette(look), 0));
  }
  row->Update();
  WriteSafely({ options.Output },
    [&](const std::vector<std::string>& names)
    { return WritePNG(row->GetOutput(), names.front()); });
  std::printf("\npicture: %s\n", options.Output.c_str());
}

void WriteTurn(const std::vector<Layer>& layers, const Options& options)
{
  const auto& [volume, look] = layers.front();
  auto projectors = MakeProjectors(layers, options, options.Rotate);
  const auto views = DrawViews(projectors, options.Modes.front(), layers, options, "");
  double seconds = 0.0;
  for (const Projector& projector : projectors)
  {
    seconds += projector.GetSeconds();
  }
  std::printf("\n%d views of %d x %d in %.2f s, %.0f per second; %d threads, %s\n", options.Rotate,
    options.View.Size[0], options.View.Size[1], seconds, options.Rotate / seconds,
    vtkSMPTools::GetEstimatedNumberOfThreads(),
    projectors.front().GetProjection()->GetInstructionSet());
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
    CheckNotInput(outputs, options.Inputs);
    CheckNotInput(outputs, { options.Mask.Path });
    CheckWritable(outputs);
  }
}

Volume ReadInput(const std::string& path, const Options& options)
{
  ReadSettings read = options.Read;
  read.Label = options.Mask.Path.empty() ? options.Mask.Label : 0;
  read.HidesPadding = options.Projection.Signed ||
    options.Projection.BlendMode != vtkSplattingMIPProjection::MAXIMUM_INTENSITY_BLEND;
  Volume volume = path.empty() ? ReadBuiltInVolume() : ReadVolume(path, read);
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
  return volume;
}

/**
 * Read the volumes, and place them relative to the first one.
 */
std::vector<Layer> ReadLayers(const Options& options)
{
  std::vector<Layer> layers;
  for (const std::string& path :
    options.Inputs.empty() ? std::vector<std::string>{ "" } : options.Inputs)
  {
    Volume volume = ReadInput(path, options);
    const Volume& first = layers.empty() ? volume : layers.front().Data;
    if (volume.IsOriented != first.IsOriented || volume.IsInMillimeters != first.IsInMillimeters)
    {
      Refuse(path,
        "only some of the files have voxel size and orientation; convert all to one format that "
        "has them.");
    }
    volume.Image->SetOrigin(volume.Origin[0] - first.Origin[0], volume.Origin[1] - first.Origin[1],
      volume.Origin[2] - first.Origin[2]);
    const LookSettings look = CompleteLook(options, volume, layers.size());
    PrintVolume(volume, look);
    layers.push_back({ std::move(volume), look });
  }
  return layers;
}

void Run(const Options& options)
{
  CheckBeforehand(options);
  const std::vector<Layer> layers = ReadLayers(options);
  if (options.Interactive)
  {
    Interact(layers.front().Data, layers.front().Look, options);
  }
  else if (options.Rotate > 0)
  {
    WriteTurn(layers, options);
  }
  else
  {
    WriteStill(layers, options);
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
