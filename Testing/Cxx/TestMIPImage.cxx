// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestMIPImage --scene NAME --mode preview|standard|high [--demo-data DIR] [--test-data DIR] -V PNG
// TestMIPImage --scene NAME --mode ... --baseline PNG   writes the baseline instead
//
// The baselines are what conventional ray casting shows, not what the mapper once showed:
// vtkFixedPointVolumeRayCastMapper with trilinear interpolation, four samples per voxel. That is
// the truth for all modes. (With nearest-neighbour interpolation, which would be closer to the
// preview, that mapper moves the volume by half a voxel.) In perspective that mapper is up to 0.2
// pixel off, and the baselines are vtkOpenGLGPUVolumeRayCastMapper's.
//
// Pictures are judged twice. VTK's own comparison says whether they are alike anywhere, but
// vtkImageDifference (VTK < 9.4) forgives shifts of a pixel. So the same baseline is also compared
// with numbers that are known beforehand, from both sides: a picture that is nearer to the baseline
// than its mode can be is as wrong as one that is too far from it.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkDataSetReader.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkPNGReader.h"
#include "vtkPNGWriter.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWindowToImageFilter.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace
{
constexpr int Size = 300;

struct Scene
{
  const char* name;
  const char* option; // which says where the file lies; none: made here
  const char* file;
  double black;
  double white;
  stage::Vector direction;
  stage::Vector up;
  double scale;
  double viewAngle; // 0: a parallel projection
};

// The principal axes are z, y, z and x. In perspective: VTK's camera as vtkRenderer::ResetCamera()
// places it, an eye in the volume, before the aorta, and one that is near and has a wide view.
const Scene scenes[] = {
  { "phantom", nullptr, nullptr, 0.0, 100.0, { 0.45, 0.35, -0.82 }, { 0.1, 1.0, 0.0 }, 0.9, 0.0 },
  { "aorta", "--demo-data", "aorta-stent.vti", 0.0, 1800.0, { 0.42, 0.85, -0.3 }, { 0.1, 0.0, 1.0 },
    0.9, 0.0 },
  { "head", "--test-data", "headsq.vti", 0.0, 3000.0, { -0.4, 0.5, 0.75 }, { 0.0, 1.0, 0.3 }, 0.8,
    0.0 },
  { "protein", "--test-data", "ironProt.vtk", 0.0, 255.0, { -0.8, 0.3, 0.45 }, { 0.2, 1.0, 0.0 },
    0.8, 0.0 },
  { "aortaperspective", "--demo-data", "aorta-stent.vti", 0.0, 1800.0, { -0.7, 0.65, -0.2 },
    { 0.1, 0.0, 1.0 }, 1.035, 30.0 },
  { "aortainside", "--demo-data", "aorta-stent.vti", 0.0, 1800.0, { 0.35, 0.9, -0.2 },
    { 0.1, 0.0, 1.0 }, 0.22, 75.0 },
  { "proteinwide", "--test-data", "ironProt.vtk", 0.0, 255.0, { -0.3, 0.8, 0.5 }, { 0.0, 0.3, 1.0 },
    1.0, 90.0 },
};

struct Expectation
{
  const char* scene;
  const char* mode;
  double difference; // rms in gray levels of 255
  double ssim;
  double gain;        // of the least squares fit
  double legacyError; // upper bounds of what VTK finds with LEGACY_VALID, the only way before 9.4,
  double tightError;  // and with TIGHT_VALID
};

// Measured, and what should be: the most in the phantom, where nothing is wider than a voxel.
// Standard and high average over a pixel of the shear image (a voxel) and the slice's thickness,
// high also over the interpolation's own width: lines become smoother and dimmer, to 87 % and 64 %
// in the phantom (gain), while wide structures keep their value (protein: 99 % and 98 %). The
// preview takes the largest voxel that a ray so much as touches: lines are as wide as voxels' boxes
// and brighter than the samples of a tent, which reach the voxel's value in one point only.
// Since the same input gives the same bits, the tolerances (below) may be narrow. A picture in
// another mode is out of them: the rms differences of a scene's modes are 46 % apart or more. So is
// one that is shifted by a pixel or not warped.
const Expectation expectations[] = {
  { "phantom", "preview", 42.40, 0.833, 1.557, 118.0, 0.165 },
  { "phantom", "standard", 18.99, 0.900, 0.869, 0.15, 0.080 },
  { "phantom", "high", 27.82, 0.841, 0.645, 27.0, 0.140 },
  { "aorta", "preview", 11.20, 0.941, 1.188, 0.15, 0.045 },
  { "aorta", "standard", 4.34, 0.976, 0.991, 0.15, 0.015 },
  { "aorta", "high", 7.46, 0.964, 0.876, 0.15, 0.030 },
  { "head", "preview", 11.43, 0.890, 1.067, 0.15, 0.045 },
  { "head", "standard", 4.28, 0.946, 0.991, 0.15, 0.015 },
  { "head", "high", 7.00, 0.933, 0.949, 0.15, 0.025 },
  { "protein", "preview", 9.47, 0.969, 1.047, 0.15, 0.025 },
  { "protein", "standard", 3.11, 0.987, 0.990, 0.15, 0.010 },
  { "protein", "high", 4.62, 0.981, 0.978, 0.15, 0.010 },
  { "aortaperspective", "preview", 10.15, 0.951, 1.209, 0.15, 0.045 },
  { "aortaperspective", "standard", 3.25, 0.986, 0.975, 0.15, 0.015 },
  { "aortaperspective", "high", 6.80, 0.972, 0.858, 0.15, 0.030 },
  { "aortainside", "preview", 24.38, 0.735, 1.282, 0.15, 0.200 },
  { "aortainside", "standard", 6.43, 0.939, 0.994, 0.15, 0.050 },
  { "aortainside", "high", 12.36, 0.917, 0.811, 0.15, 0.080 },
  { "proteinwide", "preview", 10.81, 0.952, 1.041, 0.15, 0.045 },
  { "proteinwide", "standard", 2.24, 0.992, 0.998, 0.15, 0.010 },
  { "proteinwide", "high", 3.50, 0.991, 0.985, 0.15, 0.010 },
};

template <class Entry, class Match>
const Entry* find(const Entry* first, const Entry* last, Match match)
{
  const Entry* const found = std::find_if(first, last, match);
  return found == last ? nullptr : found;
}

vtkSmartPointer<vtkImageData> load(const std::string& file)
{
  if (vtksys::SystemTools::GetFilenameLastExtension(file) == ".vti")
  {
    vtkNew<vtkXMLImageDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
  }
  vtkNew<vtkDataSetReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return vtkImageData::SafeDownCast(reader->GetOutput());
}

/// Nothing where there is no data.
vtkSmartPointer<vtkImageData> imageOf(const Scene& scene, int argc, char* argv[])
{
  if (!scene.file)
  {
    return stage::toImageData(reference::linePhantom<std::uint8_t>());
  }
  const std::string file = stage::argument(argc, argv, scene.option) + "/" + scene.file;
  return vtksys::SystemTools::FileExists(file, true) ? load(file) : nullptr;
}

double smallestSpacing(vtkImageData* image)
{
  const double* spacing = image->GetSpacing();
  return *std::min_element(spacing, spacing + 3);
}

bool writeBaseline(stage::Stage& stage, vtkImageData* image, const std::string& file)
{
  const double distance = 0.25 * smallestSpacing(image);
  vtkSmartPointer<vtkVolumeMapper> rayCaster = stage::fixedPointRayCaster(image, distance);
  if (stage.viewAngle > 0.0)
  {
    rayCaster = stage::gpuRayCaster(image, distance);
  }
  stage.show(rayCaster);
  stage.window->Render();
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(stage.window);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(filter->GetOutputPort());
  writer->SetFileName(file.c_str());
  writer->Write();
  stage.volume->SetMapper(nullptr);
  rayCaster->ReleaseGraphicsResources(stage.window);
  return writer->GetErrorCode() == 0;
}

reference::Image<double> readBaseline(const std::string& file)
{
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* const image = reader->GetOutput();
  const int* size = image->GetDimensions();
  reference::Image<double> result(size[0], size[1]);
  for (int y = 0; y < size[1]; ++y)
  {
    for (int x = 0; x < size[0]; ++x)
    {
      result.at(x, y) = image->GetScalarComponentAsDouble(x, y, 0, 0);
    }
  }
  return result;
}

/// VTK 9.4 and later choose the way of comparison by this variable, which vtk_add_test_cxx sets.
double threshold(const Expectation& expected)
{
  std::string method;
  vtksys::SystemTools::GetEnv("VTK_TESTING_IMAGE_COMPARE_METHOD", method);
  return method == "TIGHT_VALID" ? expected.tightError : expected.legacyError;
}

void judge(const Expectation& expected, const reference::Image<double>& baseline,
  const reference::Image<double>& picture, reference::Checks& check)
{
  const stage::Likeness found(baseline, picture);
  const double difference = 255.0 * std::pow(10.0, -found.psnr / 20.0);
  std::cout << expected.scene << ", " << expected.mode << ": rms difference " << difference << ", "
            << found.text() << std::endl;
  check(std::abs(difference - expected.difference) <= 0.05 * expected.difference,
    "The rms difference is within 5 % of the known one.");
  check(std::abs(found.ssim - expected.ssim) <= 0.01, "SSIM is within 0.01 of the known one.");
  check(std::abs(found.shift.gain - expected.gain) <= 0.01,
    "The gain is within 0.01 of the known one.");
  // A voxel is about four pixels wide here, and more in the volume; the preview's structures are
  // that coarse.
  check(found.largestShift() <= 0.25, "The picture lies within 0.25 pixel of the baseline.");
}
}

//------------------------------------------------------------------------------
int TestMIPImage(int argc, char* argv[])
{
  const std::string sceneName = stage::argument(argc, argv, "--scene");
  const std::string mode = stage::argument(argc, argv, "--mode");
  const Scene* const scene =
    find(std::begin(scenes), std::end(scenes), [&](const Scene& s) { return sceneName == s.name; });
  const Expectation* const expected = find(std::begin(expectations), std::end(expectations),
    [&](const Expectation& e) { return sceneName == e.scene && mode == e.mode; });
  if (!scene || !expected)
  {
    std::cout << "There is no scene " << sceneName << " with mode " << mode << "." << std::endl;
    return EXIT_FAILURE;
  }
  reference::Checks check;
  const vtkSmartPointer<vtkImageData> image = imageOf(*scene, argc, argv);
  if (!image)
  {
    check.skip(scene->file);
    return check.exitCode();
  }
  stage::Stage stage(Size, Size);
  stage.setGrayRamp(scene->black, scene->white);
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  stage.viewAngle = scene->viewAngle;
  stage.look(scene->direction, scene->up, scene->scale);
  const std::string output = stage::argument(argc, argv, "--baseline");
  if (!output.empty())
  {
    return writeBaseline(stage, image, output) ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  mapper->SetQualityMode(mode == "preview" ? vtkSplattingMIPVolumeMapper::PREVIEW
      : mode == "standard"                 ? vtkSplattingMIPVolumeMapper::STANDARD
                                           : vtkSplattingMIPVolumeMapper::HIGH);
  check(mapper->GetQualityModeAsString() == mode, "The mode is named as it is.");
  judge(*expected, readBaseline(stage::argument(argc, argv, "-V")), stage.gray(), check);
  check(vtkRegressionTestImageThreshold(stage.window, threshold(*expected)) == vtkTesting::PASSED,
    "VTK's comparison finds the pictures alike.");
  return check.exitCode();
}
