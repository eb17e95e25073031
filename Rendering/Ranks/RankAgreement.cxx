// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/RankAgreement.h"

#include "Components/ComponentProjector.h"
#include "Input/ScalarSource.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkCommunicator.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkMapper.h" // for VTK_GET_ARRAY_BY_ID
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>
#include <type_traits>

namespace splatting
{
static_assert(std::is_trivially_copyable<RankReport>::value, "reports are sent as bytes");

namespace
{
/// VTK's type of the numbers that images are reduced as.
int vtkTypeOf(ScalarType type)
{
  static const int types[] = { VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT,
    VTK_INT, VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG, VTK_FLOAT, VTK_DOUBLE };
  return types[static_cast<int>(type)];
}

/// FNV-1a hash of numbers.
class Hash
{
public:
  template <class T>
  void add(const T* values, int count)
  {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t n = 0; n < count * sizeof(T); ++n)
    {
      this->Value = (this->Value ^ bytes[n]) * 1099511628211u;
    }
  }
  template <class T>
  void add(const T& value)
  {
    static_assert(std::is_arithmetic<T>::value, "pointers and padding differ from rank to rank");
    this->add(&value, 1);
  }
  template <class T, int N>
  void add(const T (&values)[N])
  {
    this->add(values, N);
  }
  std::uint64_t get() const { return this->Value; }

private:
  std::uint64_t Value = 14695981039346656037u;
};

void addScalars(vtkSplattingMIPVolumeMapper* mapper, Hash& hash)
{
  hash.add(mapper->GetScalarMode());
  hash.add(mapper->GetArrayAccessMode());
  if (mapper->GetArrayAccessMode() == VTK_GET_ARRAY_BY_ID)
  {
    hash.add(mapper->GetArrayId());
  }
  else if (const char* const name = mapper->GetArrayName())
  {
    hash.add(name, static_cast<int>(std::strlen(name)));
  }
}

/// Adds some entries of a table, because all of them would take too long.
void addColors(vtkScalarsToColors* colors, Hash& hash)
{
  constexpr int samples = 64;
  const double* const range = colors->GetRange();
  hash.add(range, 2);
  for (int n = 0; n <= samples; ++n)
  {
    hash.add(colors->MapValue(range[0] + (range[1] - range[0]) * n / samples), 4);
  }
}

/// Adds all settings that change the picture, except masks, which are data.
void addSettings(vtkSplattingMIPVolumeMapper* mapper, Hash& hash)
{
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  mapper->PrintPictureSettings(text, vtkIndent());
  hash.add(text.str().data(), static_cast<int>(text.str().size()));
  hash.add(mapper->GetBlendMode());
  hash.add(mapper->GetAverageIPScalarRange(), 2);
  hash.add(mapper->GetCropping());
  hash.add(mapper->GetCroppingRegionPlanes(), 6);
  hash.add(mapper->GetCroppingRegionFlags());
  if (vtkScalarsToColors* const colors = mapper->GetDepthCodingColors())
  {
    addColors(colors, hash);
  }
  if (vtkPolyData* const surface = mapper->GetBoundingSurface())
  {
    hash.add(surface->GetNumberOfPoints());
    hash.add(surface->GetBounds(), 6);
  }
}

void addPlanes(vtkPlaneCollection* planes, Hash& hash)
{
  for (int n = 0; planes && n < planes->GetNumberOfItems(); ++n)
  {
    hash.add(planes->GetItem(n)->GetNormal(), 3);
    hash.add(planes->GetItem(n)->GetOrigin(), 3);
  }
}

bool sameGrid(const RankReport& a, const RankReport& b)
{
  return std::equal(a.origin, a.origin + 3, b.origin) &&
    std::equal(a.spacing, a.spacing + 3, b.spacing) &&
    std::equal(a.direction, a.direction + 9, b.direction);
}

bool sameScalars(const RankReport& a, const RankReport& b)
{
  return a.cells == b.cells && a.type == b.type && a.components == b.components;
}

/// The report of the first rank with a piece.
const RankReport* firstPiece(const std::vector<RankReport>& reports)
{
  const auto first = std::find_if(
    reports.begin(), reports.end(), [](const RankReport& report) { return !report.isEmpty(); });
  return first == reports.end() ? nullptr : &*first;
}

/// The first error of a rank or of all ranks together: of their grids alone, or also of views and
/// scalars.
std::string problemOf(const std::vector<RankReport>& reports, bool ofGrids)
{
  const auto absent = std::find_if(
    reports.begin(), reports.end(), [](const RankReport& report) { return report.absent != 0; });
  if (absent != reports.end())
  {
    return "Rank " + std::to_string(absent - reports.begin()) +
      " does not render the volume, while others do: make the volume visible on all ranks or on "
      "none, and give their cameras the same settings.";
  }
  for (std::size_t rank = 0; rank < reports.size(); ++rank)
  {
    if (reports[rank].problem[0])
    {
      return "Rank " + std::to_string(rank) + ": " + reports[rank].problem;
    }
  }
  const RankReport* const first = firstPiece(reports);
  if (!first)
  {
    return "No rank has any voxels: give at least one of them an image.";
  }
  const auto any = [&](auto&& isOther)
  { return std::any_of(reports.begin(), reports.end(), isOther); };
  if (!ofGrids && any([&](const RankReport& r) { return r.view != first->view; }))
  {
    return "Views or settings differ between ranks: give their cameras, windows and mappers "
           "the same settings.";
  }
  if (any([&](const RankReport& r) { return !r.isEmpty() && !sameGrid(r, *first); }))
  {
    return "The ranks' pieces are not of one image: give them the same origin, spacing and "
           "direction matrix, and extents of one grid.";
  }
  if (!ofGrids && any([&](const RankReport& r) { return !r.isEmpty() && !sameScalars(r, *first); }))
  {
    return "The ranks' scalars differ in type (pieces with hidden voxels are float), in the number "
           "of components, or in whether they belong to cells or points: give all pieces the same.";
  }
  return {};
}
}

bool RankReport::isEmpty() const
{
  return this->extent[0] > this->extent[1] || this->extent[2] > this->extent[3] ||
    this->extent[4] > this->extent[5];
}

void RankReport::setProblem(const std::string& sentence)
{
  std::strncpy(this->problem, sentence.c_str(), sizeof this->problem - 1);
}

void RankReport::setGrid(vtkImageData* image)
{
  std::copy(image->GetExtent(), image->GetExtent() + 6, this->extent);
  std::copy(image->GetOrigin(), image->GetOrigin() + 3, this->origin);
  std::copy(image->GetSpacing(), image->GetSpacing() + 3, this->spacing);
  const double* const direction9 = image->GetDirectionMatrix()->GetData();
  std::copy(direction9, direction9 + 9, this->direction);
}

vtkImageData* pieceOf(vtkSplattingMIPVolumeMapper* mapper)
{
  auto* const image = vtkImageData::SafeDownCast(mapper->GetDataSetInput());
  return image && image->GetNumberOfPoints() > 0 ? image : nullptr;
}

RankReport reportOf(vtkSplattingMIPVolumeMapper* mapper, const std::string& problem)
{
  RankReport report;
  report.setProblem(problem);
  // EXACT is replaced by HIGH, which needs more layers, if it takes too long.
  const int mode = mapper->GetAutoAdjustSampleDistances()
    ? std::min<int>(mapper->GetQualityMode(), vtkSplattingMIPVolumeMapper::HIGH)
    : mapper->GetQualityMode();
  report.layers = reachOf(static_cast<Quality>(mode)).layers();
  if (vtkImageData* const image = pieceOf(mapper))
  {
    report.setGrid(image);
  }
  else if (mapper->GetDataSetInput() && mapper->GetDataSetInput()->GetNumberOfPoints() > 0)
  {
    report.setProblem(
      "With several ranks the input must be a piece of a vtkImageData: resample the input.");
  }
  const int blend = mapper->GetBlendMode();
  if (blend != vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND &&
    blend != vtkVolumeMapper::MINIMUM_INTENSITY_BLEND)
  {
    report.setProblem(
      "With several ranks only maxima and minima are projected, because sums and blended values "
      "depend on the order of pieces: choose another blend mode.");
  }
  else if (blend == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND &&
    mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::LOCAL)
  {
    report.setProblem(
      "Several ranks do not project local maxima, which depend on the order of pieces "
      "along a ray: choose the global or the depth-shaded maximum.");
  }
  return report;
}

std::uint64_t viewHash(
  vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume)
{
  Hash hash;
  int size[2], origin[2];
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  hash.add(size, 2);
  vtkCamera* const camera = renderer->GetActiveCamera();
  hash.add(
    camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1.0, 1.0)->GetData(),
    16);
  hash.add(camera->GetViewTransformMatrix()->GetData(), 16);
  hash.add(volume->GetMatrix()->GetData(), 16);
  hash.add(volume->GetProperty()->GetIndependentComponents());
  addSettings(mapper, hash);
  addScalars(mapper, hash);
  addPlanes(mapper->GetClippingPlanes(), hash);
  return hash.get();
}

bool RankAgreement::Use(vtkMultiProcessController* controller)
{
  vtkMultiProcessController* const several =
    controller && controller->GetNumberOfProcesses() > 1 ? controller : nullptr;
  if (several != this->Controller)
  {
    this->Controller = several;
    this->Image = nullptr;
  }
  return this->AreMany();
}

bool RankAgreement::IsRoot() const
{
  return !this->AreMany() || this->Controller->GetLocalProcessId() == 0;
}

std::vector<RankReport> RankAgreement::Gather(const RankReport& own) const
{
  std::vector<RankReport> reports(this->Controller->GetNumberOfProcesses());
  this->Controller->AllGather(reinterpret_cast<const unsigned char*>(&own),
    reinterpret_cast<unsigned char*>(reports.data()), sizeof own);
  return reports;
}

// All reports must have the same grid.
void RankAgreement::SetWhole(const std::vector<RankReport>& reports)
{
  this->All = *firstPiece(reports);
  for (const RankReport& report : reports)
  {
    for (int a = 0; a < 3 && !report.isEmpty(); ++a)
    {
      this->All.extent[2 * a] = std::min(this->All.extent[2 * a], report.extent[2 * a]);
      this->All.extent[2 * a + 1] = std::max(this->All.extent[2 * a + 1], report.extent[2 * a + 1]);
    }
    for (int c = 0; c < this->All.components && !report.isEmpty(); ++c)
    {
      auto& range = this->All.ranges[c];
      range.low = std::min(range.low, report.ranges[c].low);
      range.high = std::max(range.high, report.ranges[c].high);
      range.nonFinite = std::max(range.nonFinite, report.ranges[c].nonFinite);
      range.magnitude = std::max(range.magnitude, report.ranges[c].magnitude);
    }
  }
  if (!this->Image)
  {
    this->Image = vtkSmartPointer<vtkImageData>::New();
  }
  this->Image->SetExtent(this->All.extent);
  this->Image->SetOrigin(this->All.origin);
  this->Image->SetSpacing(this->All.spacing);
  this->Image->SetDirectionMatrix(this->All.direction);
}

// In voxels of the whole volume.
Box RankAgreement::BoxOf(const RankReport& report) const
{
  Box box;
  for (int a = 0; a < 3; ++a)
  {
    box.begin[a] = report.extent[2 * a] - this->All.extent[2 * a];
    const int points = report.extent[2 * a + 1] - report.extent[2 * a] + 1;
    box.end[a] = box.begin[a] + (report.cells ? std::max(points - 1, 1) : points);
  }
  return box;
}

bool RankAgreement::IsCovered(const std::vector<RankReport>& reports) const
{
  std::vector<Box> interiors;
  for (const RankReport& report : reports)
  {
    if (!report.isEmpty())
    {
      interiors.push_back(
        interiorOf(this->BoxOf(report), this->Layout.grid.dimensions, glm::ivec3(report.layers)));
    }
  }
  return cover(interiors, this->Layout.grid.dimensions);
}

std::string RankAgreement::AgreeOnGrid(const RankReport& own)
{
  const std::vector<RankReport> reports = this->Gather(own);
  const std::string problem = problemOf(reports, true);
  if (problem.empty())
  {
    this->SetWhole(reports);
  }
  return problem;
}

std::string RankAgreement::Agree(const RankReport& own)
{
  const std::vector<RankReport> reports = this->Gather(own);
  std::string problem = problemOf(reports, false);
  if (!problem.empty())
  {
    return problem;
  }
  this->SetWhole(reports);
  problem = describeGrid(this->Image, this->All.cells != 0, this->Layout);
  if (problem.empty() && !this->IsCovered(reports))
  {
    problem = "The ranks' pieces do not cover the image: each needs " + std::to_string(own.layers) +
      (own.layers == 1 ? " layer" : " layers") +
      " of its neighbours' voxels in this quality mode. Request as many ghost "
      "layers.";
  }
  if (!own.isEmpty())
  {
    this->FirstVoxel = this->BoxOf(own).begin;
  }
  return problem;
}

std::string RankAgreement::ReportMissingFrame() const
{
  RankReport own;
  own.absent = 1;
  const std::vector<RankReport> reports = this->Gather(own);
  const bool areAll = std::all_of(
    reports.begin(), reports.end(), [](const RankReport& report) { return report.absent != 0; });
  return areAll ? std::string() : problemOf(reports, false);
}

bool RankAgreement::Any(bool here) const
{
  return this->Least(here ? 0 : 1) == 0;
}

int RankAgreement::Least(int here) const
{
  int least = here;
  this->Controller->AllReduce(&here, &least, 1, vtkCommunicator::MIN_OP);
  return least;
}

void RankAgreement::Reduce(ShearImage& image, const ShearWarp& geometry, Reduction reduction)
{
  if (reduction == Reduction::Signed)
  {
    this->Reduce(image.minima.front(), geometry, Reduction::Minimum);
    reduction = Reduction::Maximum;
  }
  const ScalarType type = image.type, keys = encode(image, reduction);
  this->Received.resize(image.bytes.size());
  this->Controller->GetCommunicator()->AllReduceVoidArray(image.bytes.data(), this->Received.data(),
    vtkIdType(image.width) * image.height, vtkTypeOf(keys),
    reduction == Reduction::Minimum ? vtkCommunicator::MIN_OP : vtkCommunicator::MAX_OP);
  image.bytes.swap(this->Received); // Received now has the pixels of this rank.
  if (!image.winners.empty())
  {
    this->ReduceWinners(image, geometry);
  }
  decode(image, type, reduction);
}

// Steps are counted from the first slice of this rank's piece. They are converted to steps from the
// first slice of the whole.
void RankAgreement::ReduceWinners(ShearImage& image, const ShearWarp& geometry)
{
  constexpr std::int32_t behind = std::numeric_limits<std::int32_t>::max();
  const std::int32_t none = geometry.reversed() ? -1 : behind;
  const std::int32_t first = StepsPerSlice * this->FirstVoxel[geometry.principalAxis()];
  const std::size_t size = sizeOf(image.type);
  for (std::size_t pixel = 0; pixel < image.winners.size(); ++pixel)
  {
    std::int32_t& step = image.winners[pixel];
    const bool wins = step >= 0 &&
      std::memcmp(&image.bytes[pixel * size], &this->Received[pixel * size], size) == 0;
    step = wins ? step + first : none;
  }
  this->ReceivedSteps.resize(image.winners.size());
  this->Controller->AllReduce(image.winners.data(), this->ReceivedSteps.data(),
    static_cast<vtkIdType>(image.winners.size()),
    geometry.reversed() ? vtkCommunicator::MAX_OP : vtkCommunicator::MIN_OP);
  image.winners.swap(this->ReceivedSteps);
  std::replace(image.winners.begin(), image.winners.end(), behind, std::int32_t(-1));
}

void RankAgreement::Reduce(CellScreen& screen)
{
  for (CellScreen& minima : screen.minima)
  {
    this->Reduce(minima);
  }
  ShearImage& image = this->Pixels;
  image.type = screen.type;
  image.width = screen.size.x;
  image.height = screen.size.y;
  image.spans.assign(screen.size.y, { 0, screen.size.x });
  image.nonFinite = true; // pixels without a sample are NaN
  image.bytes.swap(screen.bytes);
  const ScalarType keys = encode(image, Reduction::Maximum);
  screen.bytes.resize(image.bytes.size());
  this->Controller->GetCommunicator()->AllReduceVoidArray(image.bytes.data(), screen.bytes.data(),
    vtkIdType(image.width) * image.height, vtkTypeOf(keys), vtkCommunicator::MAX_OP);
  if (!screen.depths.empty())
  {
    constexpr float behind = std::numeric_limits<float>::infinity();
    const std::size_t size = sizeOf(screen.type);
    for (std::size_t pixel = 0; pixel < screen.depths.size(); ++pixel)
    {
      float& depth = screen.depths[pixel];
      const bool wins = depth == depth &&
        std::memcmp(&image.bytes[pixel * size], &screen.bytes[pixel * size], size) == 0;
      depth = wins ? depth : behind;
    }
    this->ReceivedDepths.resize(screen.depths.size());
    this->Controller->AllReduce(screen.depths.data(), this->ReceivedDepths.data(),
      static_cast<vtkIdType>(screen.depths.size()), vtkCommunicator::MIN_OP);
    screen.depths.swap(this->ReceivedDepths);
    std::replace(
      screen.depths.begin(), screen.depths.end(), behind, std::numeric_limits<float>::quiet_NaN());
  }
  image.bytes.swap(screen.bytes);
  decode(image, screen.type, Reduction::Maximum);
  image.bytes.swap(screen.bytes);
}

VolumeIndex::Range RankAgreement::RangeOfWhole(std::size_t component) const
{
  const auto& range = this->All.ranges[component];
  return { range.low, range.high, range.nonFinite != 0.0, range.magnitude };
}

void describeScalars(ComponentProjector& components, const ScalarSource& source, RankReport& report)
{
  report.cells = source.Grid().cells;
  report.vtkType = source.GetVtkType();
  report.type = static_cast<std::int32_t>(components.VolumeType());
  report.components = static_cast<std::int32_t>(components.NumberOfComponents());
  for (std::size_t c = 0; c < components.NumberOfComponents(); ++c)
  {
    const VolumeIndex::Range& range = components.RangeOfPiece(c);
    report.ranges[c] = { range.low, range.high, range.nonFinite ? 1.0 : 0.0, range.magnitude };
  }
  if (components.AreDependent())
  {
    report.setProblem(
      "With several ranks dependent components are not projected, because they are taken from the "
      "position of the maximum: set IndependentComponents of the vtkVolumeProperty.");
  }
}
}
