// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// PictureBlending of up to three volumes, in any order, with opaque and translucent geometry and in
// two viewports: each byte of each pixel against the pictures of the parts. Sums and maxima of
// bytes are exact in 8-bit framebuffers, because they are bytes themselves or clamped.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkHardwareSelector.h"
#include "vtkImageData.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#if __has_include("vtk_glad.h") // since VTK 9.4
#include "vtk_glad.h"
#else
#include "vtk_glew.h"
#endif

#include <algorithm>
#include <cmath>
#include <numeric>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
constexpr int Width = 240;
constexpr int Height = 150;
constexpr int Count = 3;

/// A sphere without lighting.
vtkSmartPointer<vtkActor> sphere(const stage::Vector& centre, double radius)
{
  vtkNew<vtkSphereSource> source;
  source->SetCenter(centre[0], centre[1], centre[2]);
  source->SetRadius(radius);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

/// Three volumes, spheres before, in and behind them, and a translucent sphere, in two viewports.
struct Scene : stage::Stage
{
  explicit Scene(reference::Random& random) : Stage(::Width, ::Height)
  {
    this->window->SetAlphaBitPlanes(1);
    this->renderer->SetViewport(0.0, 0.0, 0.6, 1.0);
    this->second->SetViewport(0.6, 0.2, 1.0, 1.0);
    this->window->AddRenderer(this->second);
    for (int n = 0; n < Count; ++n)
    {
      this->images[n] = stage::toImageData(stage::blobsAndTubes({ 32, 36, 34 }, 12, random));
      this->mappers[n] = stage::splatting(this->images[n]);
      this->mappers[n]->SetQualityMode(random.uniform(0, 3));
      vtkNew<vtkColorTransferFunction> color;
      color->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
      std::array<double, 3> rgb = { random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), 0.5 };
      rgb[n] = 1.0;
      color->AddRGBPoint(255.0, rgb[0], rgb[1], rgb[2]);
      // The first one is opaque, so that it is copied where that is right.
      vtkNew<vtkPiecewiseFunction> opacity;
      opacity->AddPoint(0.0, n == 0 ? 1.0 : 0.0);
      opacity->AddPoint(255.0, n == 0 ? 1.0 : random.uniform(0.3, 1.0));
      this->volumes[n]->SetMapper(this->mappers[n]);
      this->volumes[n]->GetProperty()->SetColor(color);
      this->volumes[n]->GetProperty()->SetScalarOpacity(opacity);
      this->volumes[n]->SetPosition(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), 0.0);
    }
    const double* const m = this->images[0]->GetCenter();
    this->actors = { sphere({ m[0] - 20.0, m[1], m[2] + 60.0 }, 13.0),
      sphere({ m[0] + 6.0, m[1] + 5.0, m[2] }, 12.0),
      sphere({ m[0] + 10.0, m[1] - 10.0, m[2] - 70.0 }, 30.0),
      sphere({ m[0] - 5.0, m[1] - 12.0, m[2] + 60.0 }, 20.0) };
    this->actors.back()->GetProperty()->SetOpacity(0.4);
    for (vtkRenderer* r : { this->renderer.Get(), this->second.Get() })
    {
      for (const auto& actor : this->actors)
      {
        r->AddActor(actor);
      }
      r->GetActiveCamera()->SetParallelProjection(r == this->renderer);
      r->GetActiveCamera()->Azimuth(r == this->renderer ? 20.0 : -10.0);
    }
    this->order({ 0, 1, 2 });
    for (vtkRenderer* r : { this->renderer.Get(), this->second.Get() })
    {
      r->ResetCamera();
      r->GetActiveCamera()->Zoom(2.5);
    }
  }

  void order(const std::vector<int>& numbers)
  {
    for (vtkRenderer* r : { this->renderer.Get(), this->second.Get() })
    {
      for (const auto& each : this->volumes)
      {
        r->RemoveVolume(each);
      }
      for (int n : numbers)
      {
        r->AddVolume(this->volumes[n]);
      }
    }
  }

  void showActors(int opaque, bool translucent, const std::array<double, 3>& color)
  {
    for (std::size_t n = 0; n < this->actors.size(); ++n)
    {
      this->actors[n]->SetVisibility(n + 1 == this->actors.size() ? translucent : opaque);
      this->actors[n]->GetProperty()->SetColor(color[0], color[1] / (1.0 + n), color[2]);
    }
  }

  void setBackground(double red, double green, double blue, double alpha)
  {
    for (vtkRenderer* r : { this->renderer.Get(), this->second.Get() })
    {
      r->SetBackground(red, green, blue);
      r->SetBackgroundAlpha(alpha);
    }
  }

  void setBlending(int blending)
  {
    for (const auto& mapper : this->mappers)
    {
      mapper->SetPictureBlending(blending);
    }
  }

  /// Four bytes a pixel. A second frame must be the same: the first one leaves no state.
  stage::Pixels rgba(reference::Checks& check)
  {
    stage::Pixels frames[2];
    for (stage::Pixels& frame : frames)
    {
      this->window->Render();
      vtkNew<vtkUnsignedCharArray> bytes;
      this->window->GetRGBACharPixelData(0, 0, ::Width - 1, ::Height - 1, 0, bytes);
      frame.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
    }
    check(frames[0] == frames[1], "A second frame is the same.");
    return frames[1];
  }

  /// The premultiplied picture of one volume.
  stage::Pixels alone(int n, reference::Checks& check)
  {
    this->order({ n });
    this->setBackground(0.0, 0.0, 0.0, 0.0);
    this->mappers[n]->SetPictureBlending(Mapper::OVER);
    return this->rgba(check);
  }

  vtkNew<vtkRenderer> second;
  std::array<vtkSmartPointer<vtkImageData>, Count> images;
  std::array<vtkSmartPointer<Mapper>, Count> mappers;
  std::array<vtkNew<vtkVolume>, Count> volumes;
  std::vector<vtkSmartPointer<vtkActor>> actors;
};

/// The parts of a scene as pictures.
struct Parts
{
  stage::Pixels background;
  std::vector<stage::Pixels> volumes;
};

/// What the definition gives for a byte.
double expected(const Parts& parts, const std::vector<int>& order, int blending, std::size_t at)
{
  double result = parts.background[at];
  for (int n : order)
  {
    const double byte = parts.volumes[n][at], alpha = parts.volumes[n][at | 3] / 255.0;
    result = blending == Mapper::ADD ? std::min(result + byte, 255.0)
      : blending == Mapper::MAXIMUM  ? std::max(result, byte)
                                     : byte + (1.0 - alpha) * result;
  }
  return result;
}

/// Returns how many bytes the volumes change.
int compare(
  Scene& scene, const Parts& parts, int blending, bool hidesAlpha, reference::Checks& check)
{
  int changed = 0;
  for (std::vector<int> numbers : { std::vector<int>{ 1, 2 }, { 0, 1, 2 } })
  {
    stage::Pixels first;
    do
    {
      scene.order(numbers);
      const stage::Pixels pixels = scene.rgba(check);
      // Each volume that is blended over others rounds to a byte, by less than one level.
      const double tolerance = blending == Mapper::OVER ? double(numbers.size()) : 0.0;
      int wrong = 0;
      for (std::size_t at = 0; at < pixels.size(); ++at)
      {
        // Opaque geometry hides the opacity of pictures from this test.
        const double value =
          hidesAlpha && at % 4 == 3 ? pixels[at] : expected(parts, numbers, blending, at);
        wrong += std::abs(pixels[at] - value) > tolerance;
        changed += pixels[at] != parts.background[at];
      }
      check(wrong == 0, wrong, " bytes are wrong of ", numbers.size(), " volumes, blending ",
        blending, ", first is ", numbers[0]);
      first = first.empty() ? pixels : first;
      check(blending == Mapper::OVER || first == pixels, "The order changes the picture.");
    } while (std::next_permutation(numbers.begin(), numbers.end()));
  }
  return changed;
}

void testColors(reference::Checks& check, reference::Random& random)
{
  Scene scene(random);
  int changed = 0;
  for (int geometry = 0; geometry < 3; ++geometry)
  {
    const bool opaque = geometry > 0, translucent = geometry == 2;
    for (vtkRenderer* r : { scene.renderer.Get(), scene.second.Get() })
    {
      r->SetUseDepthPeeling(translucent && random.oneIn(2));
    }
    Parts parts;
    scene.showActors(opaque, false, { 0.0, 0.0, 0.0 }); // black geometry cuts, and adds nothing
    for (int n = 0; n < Count; ++n)
    {
      parts.volumes.push_back(scene.alone(n, check));
    }
    scene.showActors(opaque, translucent, { 0.5, 0.7, 0.2 });
    for (double alpha : { 0.0, 1.0 })
    {
      scene.setBackground(0.1 * alpha, 0.2 * alpha, 0.4 * alpha, alpha);
      scene.order({});
      parts.background = scene.rgba(check);
      for (int blending : { Mapper::ADD, Mapper::MAXIMUM, Mapper::OVER })
      {
        if (blending != Mapper::OVER || !opaque)
        {
          scene.setBlending(blending);
          changed += compare(scene, parts, blending, opaque, check);
        }
      }
    }
  }
  check(changed > 100000, "The volumes are hardly visible: ", changed);
}

/// The blend state of OpenGL.
std::vector<int> blendState(vtkOpenGLState* state)
{
  std::vector<int> values;
  for (unsigned int name : { GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA, GL_BLEND_SRC_RGB,
         GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA })
  {
    int value = -1;
    state->vtkglGetIntegerv(name, &value);
    values.push_back(value);
  }
  return values;
}

/// Renders with another blend equation than VTK's, which must be there again afterwards.
struct StateChecks
{
  vtkOpenGLState* state;
  std::vector<int> before;
  int wrong = 0;

  void start(vtkObject*, unsigned long, void*)
  {
    this->state->vtkglBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    this->before = blendState(this->state);
  }
  void end(vtkObject*, unsigned long, void*)
  {
    this->wrong += this->before != blendState(this->state);
    this->state->vtkglBlendEquation(GL_FUNC_ADD);
  }
};

void testState(reference::Checks& check, reference::Random& random)
{
  Scene scene(random);
  scene.window->Render();
  for (int blending : { Mapper::OVER, Mapper::ADD, Mapper::MAXIMUM })
  {
    scene.setBlending(blending);
    const stage::Pixels expected = scene.rgba(check);
    StateChecks states{ vtkOpenGLRenderWindow::SafeDownCast(scene.window)->GetState(), {} };
    const unsigned long tags[] = { scene.mappers[0]->AddObserver(
                                     vtkCommand::VolumeMapperRenderStartEvent, &states,
                                     &StateChecks::start),
      scene.mappers[0]->AddObserver(
        vtkCommand::VolumeMapperRenderEndEvent, &states, &StateChecks::end) };
    check(scene.rgba(check) == expected, "The picture depends on the blend equation.");
    check(states.wrong == 0 && !states.before.empty(), "The blend state is restored.");
    for (unsigned long tag : tags)
    {
      scene.mappers[0]->RemoveObserver(tag);
    }
  }
}

/// What a selector finds at each pixel.
std::vector<vtkProp*> found(Scene& scene)
{
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.renderer);
  const int width = static_cast<int>(0.6 * Width);
  selector->SetArea(0, 0, static_cast<unsigned int>(width - 1), Height - 1);
  std::vector<vtkProp*> props;
  if (selector->CaptureBuffers())
  {
    for (unsigned int y = 0; y < static_cast<unsigned int>(Height); ++y)
    {
      for (unsigned int x = 0; x < static_cast<unsigned int>(width); ++x)
      {
        const unsigned int place[2] = { x, y };
        props.push_back(selector->GetPixelInformation(place).Prop);
      }
    }
  }
  return props;
}

void testSelection(reference::Checks& check, reference::Random& random)
{
  Scene scene(random);
  scene.window->Render();
  const std::vector<vtkProp*> over = found(scene);
  for (const auto& volume : scene.volumes)
  {
    check(std::count(over.begin(), over.end(), volume.Get()) > 0, "All volumes are selected.");
  }
  for (int blending : { Mapper::ADD, Mapper::MAXIMUM })
  {
    scene.setBlending(blending);
    scene.window->Render();
    check(found(scene) == over, "A selection depends on PictureBlending.");
  }
}
}

//------------------------------------------------------------------------------
int TestPictureBlending(int, char*[])
{
  reference::Checks check;
  stage::Stage keeper(10, 10); // X servers may restart when their last client leaves
  keeper.window->Render();
  reference::forScenes("blending", 2,
    [&](int, reference::Random& random)
    {
      testColors(check, random);
      testState(check, random);
      testSelection(check, random);
    });
  return check.exitCode();
}
