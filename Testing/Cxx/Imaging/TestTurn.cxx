// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Turns of vtkSplattingMIPProjection: each slice is the single view, bit for bit; shared
// projections, progress, aborts, and reuse in updates. TestTurnOfViews tests the geometry.
#include "ProjectionTesting.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkFloatArray.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;

/// Another filter's view through one camera.
vtkSmartPointer<vtkImageData> singleView(Filter* turn, vtkImageData* image, vtkCamera* camera)
{
  const auto single = projectiontesting::projectionOf(image);
  single->SetCamera(camera);
  single->SetOutputSize(turn->GetOutputSize());
  single->SetOutputSpacing(turn->GetOutputSpacing());
  single->SetQualityMode(turn->GetQualityMode());
  single->SetBlendMode(turn->GetBlendMode());
  single->SetMaximumType(turn->GetMaximumType());
  single->SetSlab(turn->GetSlab());
  single->SetSlabCenter(turn->GetSlabCenter());
  single->SetSlabThickness(turn->GetSlabThickness());
  single->SetBackgroundValue(turn->GetBackgroundValue());
  single->Update();
  return single->GetOutput();
}

void testSlices(Checks& check, Filter* turn, vtkImageData* image, vtkIdType projections)
{
  turn->Update();
  vtkImageData* const output = turn->GetOutput();
  const int views = turn->GetNumberOfViews();
  check(output->GetDimensions()[2] == views, "one slice per view");
  check(turn->GetNumberOfProjections() == projections, turn->GetNumberOfProjections(),
    " projections, not ", projections);
  for (int n = 0; n < views; ++n)
  {
    vtkNew<vtkCamera> camera;
    check(turn->GetViewCamera(n, camera), "view ", n, " has a camera");
    check(projectiontesting::sameScalars(
            projectiontesting::sliceOf(output, n), singleView(turn, image, camera)),
      "slice ", n, " of ", views, " is the single view");
  }
  vtkNew<vtkCamera> camera;
  check(!turn->GetViewCamera(views, camera) && !turn->GetViewCamera(-1, camera), "no other views");
}

void testViews(Checks& check)
{
  reference::forScenes("turns", 4,
    [&](int n, reference::Random& random)
    {
      const auto image = projectiontesting::anyImage({ 23, 31, 27 }, random);
      const auto turn = projectiontesting::projectionOf(image);
      turn->SetOutputSize(40, 32);
      turn->SetQualityMode(n);
      turn->SetNumberOfViews(9);
      turn->SetBackgroundValue(-1024.0);
      // As wide as the narrowest voxel: no overview.
      const double* const voxel = image->GetSpacing();
      const double pixel = std::min({ voxel[0], voxel[1], voxel[2] });
      turn->SetOutputSpacing(pixel, pixel);
      testSlices(check, turn, image, 9);
      turn->SetNumberOfViews(12);
      // Opposite views share shear images. In exact mode each view has pixels of its own.
      const vtkIdType projections = n == Filter::EXACT ? 12 : 6;
      testSlices(check, turn, image, projections);
      turn->SlabOn();
      turn->SetSlabThickness(5.0);
      turn->SetSlabCenter(image->GetCenter());
      testSlices(check, turn, image, projections);
      turn->SlabOff();
      turn->SetMaximumTypeToDepthShaded(); // but not where the viewer's side matters
      testSlices(check, turn, image, 12);
      turn->SetMaximumTypeToGlobal();
      turn->SetTotalAngle(-90.0);
      turn->SetRotationAxis(0.3, -0.2, 1.0);
      turn->SetOutputSpacing(0.7, 1.1);
      testSlices(check, turn, image, 12);
    });
}

void testPerspective(Checks& check)
{
  reference::Random random(6);
  const auto image = projectiontesting::anyImage({ 23, 31, 27 }, random);
  const auto turn = projectiontesting::projectionOf(image);
  vtkNew<vtkCamera> camera;
  const double* const centre = image->GetCenter();
  camera->SetFocalPoint(centre);
  camera->SetPosition(centre[0] + 70.0, centre[1] - 60.0, centre[2] + 20.0);
  camera->SetViewUp(0.1, 0.2, 1.0);
  turn->SetCamera(camera);
  turn->SetOutputSize(36, 30);
  turn->SetNumberOfViews(4);
  turn->SetQualityModeToStandard();
  testSlices(check, turn, image, 4);
  const double height = 2.0 * std::tan(0.5 * vtkMath::RadiansFromDegrees(camera->GetViewAngle())) *
    camera->GetDistance();
  check(std::abs(turn->GetOutput()->GetSpacing()[1] * 30.0 - height) < 1e-9 * height,
    "the view angle tells the spacing");
  // The same pixels by a spacing that is set.
  const auto before = projectiontesting::sliceOf(turn->GetOutput(), 0);
  double spacing[3];
  turn->GetOutput()->GetSpacing(spacing);
  camera->SetViewAngle(3.0);
  turn->SetOutputSpacing(spacing[0], spacing[1]);
  turn->Update();
  double largest = 0.0;
  for (vtkIdType p = 0; p < before->GetNumberOfPoints(); ++p)
  {
    largest = std::max(largest,
      std::abs(before->GetPointData()->GetScalars()->GetComponent(p, 0) -
        turn->GetOutput()->GetPointData()->GetScalars()->GetComponent(p, 0)));
  }
  check(largest < 1e-6 * 4000.0, "spacing takes the view angle's place: ", largest);
  testSlices(check, turn, image, 4);
}

/// A turn of 20 small pictures.
vtkSmartPointer<Filter> smallTurn()
{
  reference::Random random(8);
  const auto turn =
    projectiontesting::projectionOf(projectiontesting::anyImage({ 23, 31, 27 }, random));
  turn->SetNumberOfViews(20);
  turn->SetOutputSize(16, 16);
  return turn;
}

void testProgress(Checks& check)
{
  const auto turn = smallTurn();
  struct Log
  {
    std::vector<double> progress;
    double abortAt = 2.0;
    void note(vtkObject* filter, unsigned long, void* data)
    {
      this->progress.push_back(*static_cast<double*>(data));
      if (this->progress.back() >= this->abortAt)
      {
        static_cast<vtkAlgorithm*>(filter)->AbortExecuteOn();
      }
    }
  } log;
  turn->AddObserver(vtkCommand::ProgressEvent, &log, &Log::note);
  turn->Update();
  check(std::is_sorted(log.progress.begin(), log.progress.end()), "progress never goes back");
  check(log.progress.size() >= 20 && log.progress.size() < 130 && log.progress.back() == 1.0,
    log.progress.size(), " steps of progress");
  const auto whole = vtkSmartPointer<vtkImageData>::New();
  whole->DeepCopy(turn->GetOutput());
  log.progress.clear();
  log.abortAt = 0.5;
  turn->Modified();
  turn->Update();
  check(turn->GetOutput()->GetNumberOfPoints() == 0, "nothing is left after an abort");
  // Since VTK 9.2 the executive tells 1 all the same.
  log.progress.erase(
    std::remove(log.progress.begin(), log.progress.end(), 1.0), log.progress.end());
  check(!log.progress.empty() && log.progress.back() < 0.6,
    "an abort is soon: ", log.progress.empty() ? 0.0 : log.progress.back());
  log.abortAt = 2.0;
  turn->AbortExecuteOff();
  turn->Update();
  check(projectiontesting::sameScalars(turn->GetOutput(), whole), "and all is there again");
}

/// Settings that an observer changes during a turn apply from the next update on.
void testChangesInProgress(Checks& check)
{
  const auto turn = smallTurn();
  turn->SetQualityModeToPreview();
  turn->Update();
  const auto before = vtkSmartPointer<vtkImageData>::New();
  before->DeepCopy(turn->GetOutput());
  struct Changer
  {
    void change(vtkObject* object, unsigned long, void* progress)
    {
      if (*static_cast<double*>(progress) < 0.2) // VTK's own event precedes the projection
      {
        return;
      }
      auto* const filter = Filter::SafeDownCast(object);
      filter->RecordLocationsOn();
      filter->SetQualityModeToExact();
      filter->SlabOn();
      filter->SetSlabCenter(filter->GetFocalPoint());
      filter->SetBackgroundValue(-7.0);
    }
  } changer;
  turn->AddObserver(vtkCommand::ProgressEvent, &changer, &Changer::change);
  turn->Modified();
  turn->Update();
  check(projectiontesting::sameScalars(turn->GetOutput(), before) &&
      !turn->GetOutput()->GetPointData()->GetArray("Depth"),
    "changes in progress have no effect");
  turn->RemoveAllObservers();
  turn->Modified();
  turn->Update();
  const auto fresh = smallTurn();
  double done = 1.0;
  changer.change(fresh, 0, &done);
  fresh->Update();
  check(projectiontesting::sameScalars(turn->GetOutput(), fresh->GetOutput()) &&
      turn->GetOutput()->GetPointData()->GetArray("Depth"),
    "they have one in the next update");
}

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
/// Whoever aborts a filter upstream wants nothing of what is made of its output.
void testAbortUpstream(Checks& check)
{
  const auto turn = smallTurn();
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback(
    [](vtkObject* filter, unsigned long, void*, void* progress)
    {
      if (*static_cast<double*>(progress) >= 0.5)
      {
        static_cast<vtkAlgorithm*>(filter)->GetInputAlgorithm()->SetAbortExecuteAndUpdateTime();
      }
    });
  turn->AddObserver(vtkCommand::ProgressEvent, abort);
  turn->Update();
  check(turn->GetOutput()->GetNumberOfPoints() == 0, "nothing is left after an abort upstream");
  turn->RemoveAllObservers();
  turn->GetInputAlgorithm()->AbortExecuteOff();
  turn->Modified();
  turn->Update();
  check(turn->GetOutput()->GetNumberOfPoints() == 16 * 16 * 20, "and all is there again");
}
#endif

/// TestWalk tests changes that project again.
void testReuse(Checks& check)
{
  reference::Random random(9);
  const auto image = projectiontesting::anyImage({ 23, 31, 27 }, random);
  const auto filter = projectiontesting::projectionOf(image);
  filter->SetQualityModeToHigh(); // a shear image for all sizes of pixels
  filter->SetOutputSize(30, 30);
  filter->Update();
  check(filter->GetNumberOfProjections() == 1, "the first view is projected");
  const vtkIdType memory = filter->GetIndexMemorySize();
  check(memory > 0, "there is an index");
  filter->SetBackgroundValue(-7.0);
  filter->Update();
  check(filter->GetNumberOfProjections() == 0, "the same rays are not projected again");
  filter->SetOutputSpacing(0.1, 0.2);
  filter->Update();
  check(filter->GetNumberOfProjections() == 0, "nor for other pixels");
}

/// An image with the scalars of two images as its components, and another array.
vtkSmartPointer<vtkImageData> withBoth(vtkImageData* one, vtkImageData* two)
{
  auto both = vtkSmartPointer<vtkImageData>::New();
  both->CopyStructure(one);
  both->AllocateScalars(VTK_UNSIGNED_CHAR, 2);
  vtkDataArray* const scalars = both->GetPointData()->GetScalars();
  scalars->CopyComponent(0, one->GetPointData()->GetScalars(), 0);
  scalars->CopyComponent(1, two->GetPointData()->GetScalars(), 0);
  scalars->SetName("both");
  vtkNew<vtkFloatArray> other;
  other->SetName("other");
  other->SetNumberOfTuples(both->GetNumberOfPoints());
  other->Fill(3.5);
  both->GetPointData()->AddArray(other);
  return both;
}

/// Independent components are what each is by itself; magnitudes and names are kept.
void testComponents(Checks& check)
{
  reference::Random random(10);
  const auto one =
    projectiontesting::imageOf(reference::uniformNoise<std::uint8_t>({ 13, 11, 12 }, random));
  const auto two =
    projectiontesting::imageOf(reference::uniformNoise<std::uint8_t>({ 13, 11, 12 }, random));
  const auto both = withBoth(one, two);
  const auto filter = projectiontesting::projectionOf(both);
  filter->SetViewDirection(0.3, 1.0, -0.2);
  filter->SetBackgroundValue(-1.0);
  filter->SetOutputSize(20, 22);
  filter->Update();
  vtkDataArray* const found = filter->GetOutput()->GetPointData()->GetScalars();
  check(found->GetNumberOfComponents() == 2 && std::string(found->GetName()) == "both",
    "two components under their name");
  for (int c = 0; c < 2; ++c)
  {
    const auto single = projectiontesting::projectionOf(c ? two : one);
    single->SetViewDirection(0.3, 1.0, -0.2);
    single->SetBackgroundValue(-1.0);
    single->SetOutputSize(20, 22);
    single->Update();
    vtkDataArray* const expected = single->GetOutput()->GetPointData()->GetScalars();
    int wrong = 0;
    for (vtkIdType p = 0; p < found->GetNumberOfTuples(); ++p)
    {
      wrong += found->GetComponent(p, c) != expected->GetComponent(p, 0);
    }
    check(wrong == 0, wrong, " pixels of component ", c);
    filter->SetVectorModeToComponent();
    filter->SetVectorComponent(c);
    filter->Update();
    check(
      projectiontesting::sameScalars(filter->GetOutput(), single->GetOutput()), "component ", c);
    filter->SetVectorModeToDisabled();
    filter->Update();
  }
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "other");
  filter->Update();
  check(filter->GetOutput()->GetScalarComponentAsDouble(10, 11, 0, 0) == 3.5 &&
      filter->GetOutput()->GetNumberOfScalarComponents() == 1,
    "the array to process is projected");
}
}

int TestTurn(int, char*[])
{
  Checks check;
  testViews(check);
  testPerspective(check);
  testProgress(check);
  testChangesInProgress(check);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  testAbortUpstream(check);
#endif
  testReuse(check);
  testComponents(check);
  return check.exitCode();
}
