// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Projector_h
#define Projector_h

#include "Look.h"
#include "ProjectionSettings.h"
#include "Reading/VolumeReader.h"
#include "View.h"

#include "vtkNew.h"
#include "vtkSplattingMIPProjection.h"

#include <string>

/**
 * One view of a volume, or several once round the patient's long axis, by
 * vtkSplattingMIPProjection, which needs no display.
 */
class Projector
{
public:
  Projector(const Volume& volume, const ProjectionSettings& settings, const LookSettings& look,
    const ViewSettings& view, int views);

  vtkSplattingMIPProjection* GetProjection() { return this->Projection; }

  /**
   * Views as bytes, which are places in the look's palette. What says in the progress line what is
   * done. Throws std::runtime_error if nothing of the volume is seen.
   */
  vtkSmartPointer<vtkImageData> Project(const std::string& what);

  /**
   * The seconds that the last Project() took for what it shows.
   */
  double GetSeconds() const { return this->Seconds; }

private:
  LookSettings Look;
  vtkNew<vtkSplattingMIPProjection> Projection;
  double Seconds = 0.0;
};

#endif
