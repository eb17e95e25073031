// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Turn_h
#define Turn_h

#include "MIPScene.h"
#include "PictureSeries.h"
#include "VolumeReader.h"

#include "vtkSplattingMIPProjection.h"

/**
 * The views of a volume once round the patient's long axis, by vtkSplattingMIPProjection, which
 * needs no display.
 */
class Turn
{
public:
  Turn(const Volume& volume, const LookSettings& look, const ViewSettings& view, int views);

  vtkSplattingMIPProjection* GetProjection() { return this->Projection; }

  /**
   * Views as bytes, which are places in the palette. Throws std::runtime_error.
   */
  vtkSmartPointer<vtkImageData> Project();
  Palette GetPalette() const;

  /**
   * The seconds that Project() took for what it shows.
   */
  double GetSeconds() const { return this->Seconds; }

private:
  LookSettings Look;
  vtkNew<vtkSplattingMIPProjection> Projection;
  double Seconds = 0.0;
};

#endif
