// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeReader_h
#define VolumeReader_h

#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

/**
 * What of a file with several volumes is wanted: numbers from 1 on, 0 and no text for the
 * usual ones.
 */
struct ReadSettings
{
  int Series = 0;
  int Frame = 0;
  int Channel = 0;
  int Label = 0;             // of a DICOM segmentation
  bool HidesPadding = false; // also where a maximum does not show it
  std::string Array;         // its name
  std::string Component;     // a number, "luminance" or "magnitude"
};

/**
 * A volume that is ready to be rendered.
 */
struct Volume
{
  /**
   * At least one voxel; active point scalars of one component; no direction matrix.
   */
  vtkSmartPointer<vtkImageData> Image;

  /**
   * Turns Image's coordinates to the patient's: +x left, +y back, +z head (LPS, as in DICOM). It is
   * the volume's prop matrix, because vtkFixedPointVolumeRayCastMapper ignores direction matrices.
   */
  vtkSmartPointer<vtkMatrix4x4> Orientation;

  /**
   * Where the first voxel lies in the patient (LPS), as far as the file says; Image has it at 0.
   */
  std::array<double, 3> Origin = {};

  /**
   * What to call the volume, and what the user should know of it, a line each.
   */
  std::string Name;
  std::vector<std::string> Notes;

  /**
   * The files that were read, and others of the same DICOM folder, which no output may replace.
   */
  std::vector<std::string> Files;

  /**
   * Whether the file says how the patient lies, and how large voxels are.
   */
  bool IsOriented = false;
  bool IsInMillimeters = false;

  /**
   * Whether values are labels, of which the settings choose one.
   */
  bool HasLabels = false;

  /**
   * What whoever sees a picture must know, in a few words; may be empty.
   */
  std::string Caution;

  /**
   * How the file wants to be shown, in its values; the window is 0 if it does not say.
   */
  double Window = 0.0;
  double Level = 0.0;

  /**
   * Of DICOM, the vtkDICOMMetaData of one of the files, for what is derived from them.
   */
  vtkSmartPointer<vtkObject> Study;
};

/**
 * How the names of files end that can be read, less those of DICOM.
 */
std::vector<std::string> GetVolumeEndings();

/**
 * Read a file with one of those endings or, where this build has vtk-dicom, a series of a folder,
 * of a DICOMDIR, or that of a DICOM file: the largest, unless the settings name one. Throws
 * std::runtime_error with one sentence that says what is wrong and what to do; nothing else is
 * printed.
 */
Volume ReadVolume(const std::string& path, const ReadSettings& settings);

/**
 * The volume that is part of the program: CT angiography of a stented abdominal aorta.
 */
Volume ReadBuiltInVolume();

#endif
