// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeReader_h
#define VolumeReader_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

/**
 * Choices in files with several volumes: numbers from 1 on, 0 or no text for the default.
 */
struct ReadSettings
{
  int Series = 0;
  int Frame = 0;
  int Channel = 0;
  int Label = 0;             // of a DICOM segmentation
  bool HidesPadding = false; // all of it, not only what a maximum shows
  std::string Array;         // its name
  std::string Component;     // a number, "luminance" or "magnitude"
};

/**
 * A volume that is ready to be rendered.
 */
struct Volume
{
  /**
   * At least one voxel; active point scalars of one component. The direction matrix rotates to the
   * patient's coordinates: +x left, +y back, +z head (LPS, as in DICOM).
   */
  vtkSmartPointer<vtkImageData> Image;

  /**
   * Position of the first voxel in the patient (LPS), as far as the file says; it is 0 in Image.
   */
  std::array<double, 3> Origin = {};

  /**
   * The volume's name, and notes for the user, a line each.
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
   * Warnings that pictures must show, a few words on each line; may be empty.
   */
  std::string Caution;

  /**
   * The file's window, in its values; the width is 0 if it has none.
   */
  double Window = 0.0;
  double Level = 0.0;

  /**
   * The vtkDICOMMetaData of one of the files, from which outputs take patient and study; nullptr if
   * the input is not DICOM.
   */
  vtkSmartPointer<vtkObject> Study;
};

/**
 * List the endings of the files that can be read, less DICOM's.
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
 * Read the volume that is part of the program: CT angiography of a stented abdominal aorta.
 */
Volume ReadBuiltInVolume();

#endif
