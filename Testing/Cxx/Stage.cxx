// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMultiThreader.h"
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkThreadedImageAlgorithm.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace stage
{

//------------------------------------------------------------------------------
Messages::Messages(vtkObject* object, unsigned long event) : Object(object)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(this);
  command->SetCallback(
    [](vtkObject*, unsigned long, void* self, void* text) {
      static_cast<Messages*>(self)->texts.emplace_back(text ? static_cast<const char*>(text) : "");
    });
  this->Tag = object->AddObserver(event, command);
}

//------------------------------------------------------------------------------
Messages::~Messages()
{
  this->Object->RemoveObserver(this->Tag);
}

//------------------------------------------------------------------------------
Stage::Stage(int width, int height) : Width(width), Height(height)
{
  this->window->SetOffScreenRendering(1);
  this->window->SetMultiSamples(0);
  this->window->SetSize(width, height);
  this->window->AddRenderer(this->renderer);
  // VTK 9.1 remembers for what size it computed the aspect, in members it does not initialise:
  // where an earlier renderer of this size lay in memory, the aspect would stay 1, as VTK's ray
  // casters would see it. Another pixel aspect first makes it compute both.
  for (double pixelAspect : { 2.0, 1.0 })
  {
    this->renderer->SetPixelAspect(pixelAspect, 1.0);
    this->renderer->ComputeAspect();
  }
  this->volume->SetProperty(this->property);
  this->property->SetInterpolationTypeToLinear();
  this->setGrayRamp(0.0, 255.0);
}

//------------------------------------------------------------------------------
Stage::~Stage() = default;

//------------------------------------------------------------------------------
void Stage::show(vtkVolumeMapper* mapper)
{
  this->volume->SetMapper(mapper);
  if (!this->renderer->HasViewProp(this->volume))
  {
    this->renderer->AddVolume(this->volume);
  }
}

//------------------------------------------------------------------------------
void Stage::setGrayRamp(double black, double white)
{
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(black, 0.0, 0.0, 0.0);
  color->AddRGBPoint(white, 1.0, 1.0, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(black, 1.0);
  opacity->AddPoint(white, 1.0);
  this->property->SetColor(color);
  this->property->SetScalarOpacity(opacity);
}

//------------------------------------------------------------------------------
void Stage::look(const Vector& direction, const Vector& up, double scale)
{
  double bounds[6];
  this->volume->GetBounds(bounds);
  const Vector size = { bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] };
  const double diagonal = vtkMath::Norm(size.data());
  const double height = 0.5 * scale * diagonal;
  const double distance = this->viewAngle > 0.0
    ? height / std::tan(0.5 * vtkMath::RadiansFromDegrees(this->viewAngle))
    : 2.0 * diagonal;
  const double far = distance / vtkMath::Norm(direction.data());
  vtkCamera* const camera = this->renderer->GetActiveCamera();
  Vector middle;
  Vector position;
  for (int a = 0; a < 3; ++a)
  {
    middle[a] = 0.5 * (bounds[2 * a] + bounds[2 * a + 1]);
    position[a] = middle[a] - far * direction[a];
  }
  camera->SetParallelProjection(this->viewAngle <= 0.0);
  camera->SetViewAngle(this->viewAngle > 0.0 ? this->viewAngle : 30.0);
  camera->SetFocalPoint(middle.data());
  camera->SetPosition(position.data());
  camera->SetViewUp(up.data());
  camera->SetParallelScale(height);
  this->renderer->ResetCameraClippingRange();
}

//------------------------------------------------------------------------------
Pixels Stage::pixels()
{
  this->window->Render();
  vtkNew<vtkWindowToImageFilter> filter;
  filter->SetInput(this->window);
  filter->SetInputBufferTypeToRGB();
  filter->ReadFrontBufferOff();
  filter->ShouldRerenderOff();
  filter->Update();
  auto* const bytes =
    vtkUnsignedCharArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  return Pixels(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
}

//------------------------------------------------------------------------------
reference::Image<double> Stage::gray()
{
  const Pixels bytes = this->pixels();
  reference::Image<double> image(this->Width, this->Height);
  for (std::size_t pixel = 0; pixel < image.value.size(); ++pixel)
  {
    image.value[pixel] = bytes.at(3 * pixel);
  }
  return image;
}

//------------------------------------------------------------------------------
Vector anyDirection(reference::Random& random)
{
  const glm::dvec3 direction = coretesting::anyDirection(random);
  return { direction.x, direction.y, direction.z };
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> toImageData(const reference::Volume<std::uint8_t>& volume)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.size[0], volume.size[1], volume.size[2]);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::copy(volume.voxels.begin(), volume.voxels.end(),
    static_cast<unsigned char*>(image->GetScalarPointer()));
  return image;
}

namespace
{
/**
 * A straight tube, or a blob where both ends agree; in voxels.
 */
struct Capsule
{
  Vector from;
  Vector to;
  double radius;
  double value;
};

/**
 * Inside the volume by so much that its rim, too, stays off the border. Every third is a blob.
 */
Capsule randomCapsule(reference::Random& random, const std::array<int, 3>& size, int number)
{
  Capsule capsule;
  capsule.radius = random.uniform(1.5, 5.0);
  capsule.value = random.uniform(110.0, 255.0);
  const double margin = capsule.radius + 8.0;
  for (int a = 0; a < 3; ++a)
  {
    capsule.from[a] = random.uniform(margin, size[a] - 1.0 - margin);
    capsule.to[a] = random.uniform(margin, size[a] - 1.0 - margin);
  }
  if (number % 3 == 0)
  {
    capsule.to = capsule.from;
  }
  return capsule;
}

double distanceToAxis(const Capsule& capsule, const Vector& p)
{
  Vector axis;
  Vector offset;
  for (int a = 0; a < 3; ++a)
  {
    axis[a] = capsule.to[a] - capsule.from[a];
    offset[a] = p[a] - capsule.from[a];
  }
  const double length2 = vtkMath::Dot(axis.data(), axis.data());
  const double along =
    length2 > 0.0 ? std::clamp(vtkMath::Dot(offset.data(), axis.data()) / length2, 0.0, 1.0) : 0.0;
  for (int a = 0; a < 3; ++a)
  {
    offset[a] -= along * axis[a];
  }
  return vtkMath::Norm(offset.data());
}

/**
 * Raises the voxels to the capsule's value, which falls to nothing over six voxels about its
 * radius.
 */
void draw(reference::Volume<std::uint8_t>& volume, const Capsule& capsule)
{
  for (int k = 0; k < volume.size[2]; ++k)
  {
    for (int j = 0; j < volume.size[1]; ++j)
    {
      for (int i = 0; i < volume.size[0]; ++i)
      {
        const Vector position = { double(i), double(j), double(k) };
        const double distance = distanceToAxis(capsule, position);
        const double share = std::clamp((capsule.radius + 3.0 - distance) / 6.0, 0.0, 1.0);
        const auto value = static_cast<std::uint8_t>(capsule.value * share + 0.5);
        volume.at(i, j, k) = std::max(volume.at(i, j, k), value);
      }
    }
  }
}
}

void chooseSamples(
  vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image, reference::Random& random)
{
  mapper->SetMaximumType(random.uniform(0, 3));
  mapper->SetLocalMaximumThreshold(100.0);
  mapper->SetSignedOrigin(random.uniform(20.0, 200.0));
  mapper->SetSlab(random.oneIn(3));
  mapper->SetSlabCenter(image->GetCenter());
  mapper->SetSlabThickness(20.0);
  mapper->SetCropping(random.oneIn(3));
  mapper->SetCroppingRegionFlags(VTK_CROP_INVERTED_CROSS);
  const double* const b = image->GetBounds();
  mapper->SetCroppingRegionPlanes(0.7 * b[0] + 0.3 * b[1], 0.2 * b[0] + 0.8 * b[1],
    0.6 * b[2] + 0.4 * b[3], 0.3 * b[2] + 0.7 * b[3], 0.6 * b[4] + 0.4 * b[5],
    0.3 * b[4] + 0.7 * b[5]);
}

//------------------------------------------------------------------------------
reference::Volume<std::uint8_t> blobsAndTubes(
  const std::array<int, 3>& size, int count, reference::Random& random)
{
  reference::Volume<std::uint8_t> volume(size);
  for (int number = 0; number < count; ++number)
  {
    draw(volume, randomCapsule(random, size, number));
  }
  return volume;
}

reference::Volume<std::uint8_t> anyBlobs(reference::Random& random)
{
  const std::array<int, 3> size = coretesting::anySize(random, 32, 52);
  const int count = random.uniform(4, 16);
  return blobsAndTubes(size, count, random);
}

//------------------------------------------------------------------------------
reference::Volume<std::uint8_t> blobsAndTubes(const std::array<int, 3>& size, int count)
{
  // What the environment adds is taken away again.
  reference::Random random(3 - reference::Random::shift());
  return blobsAndTubes(size, count, random);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkSplattingMIPVolumeMapper> splatting(vtkImageData* image)
{
  auto mapper = vtkSmartPointer<vtkSplattingMIPVolumeMapper>::New();
  mapper->SetInputData(image);
  return mapper;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> fixedPointRayCaster(
  vtkImageData* image, double sampleDistance)
{
  // The space that it skips is found by a filter that makes mistakes where threads share the work:
  // pictures of two dependent components then differ by 7 dB.
  const bool shares = vtkThreadedImageAlgorithm::GetGlobalDefaultEnableSMP();
  const int threads = vtkMultiThreader::GetGlobalDefaultNumberOfThreads();
  vtkThreadedImageAlgorithm::SetGlobalDefaultEnableSMP(false);
  vtkMultiThreader::SetGlobalDefaultNumberOfThreads(1);
  auto mapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
  vtkThreadedImageAlgorithm::SetGlobalDefaultEnableSMP(shares);
  vtkMultiThreader::SetGlobalDefaultNumberOfThreads(threads);
  mapper->SetInputData(image);
  mapper->SetBlendModeToMaximumIntensity();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetSampleDistance(static_cast<float>(sampleDistance));
  mapper->SetInteractiveSampleDistance(static_cast<float>(sampleDistance));
  return mapper;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkGPUVolumeRayCastMapper> gpuRayCaster(vtkImageData* image, double sampleDistance)
{
  auto mapper = vtkSmartPointer<vtkOpenGLGPUVolumeRayCastMapper>::New();
  mapper->SetInputData(image);
  mapper->SetBlendModeToMaximumIntensity();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->UseJitteringOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetSampleDistance(static_cast<float>(sampleDistance));
  return mapper;
}

//------------------------------------------------------------------------------
Likeness::Likeness(const reference::Image<double>& truth, const reference::Image<double>& picture)
  : psnr(reference::psnr(truth, picture, 255.0)),
    ssim(reference::ssim(truth, picture, 255.0)),
    shift(reference::subPixelShift(truth, picture))
{
}

//------------------------------------------------------------------------------
double Likeness::largestShift() const
{
  return std::max(std::abs(this->shift.dx), std::abs(this->shift.dy));
}

//------------------------------------------------------------------------------
std::string Likeness::text() const
{
  std::ostringstream text;
  text << "PSNR " << this->psnr << " dB, SSIM " << this->ssim << ", shift (" << this->shift.dx
       << ", " << this->shift.dy << "), gain " << this->shift.gain;
  return text.str();
}

//------------------------------------------------------------------------------
std::string argument(int argc, char* argv[], const std::string& option)
{
  for (int n = 1; n + 1 < argc; ++n)
  {
    if (argv[n] == option)
    {
      return argv[n + 1];
    }
  }
  return {};
}

} // namespace stage
