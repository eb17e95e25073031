// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeReader_h
#define VolumeReader_h

#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkSmartPointer.h"

#include <string>

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
   * What to call the volume, and what the user should know of it; may be empty.
   */
  std::string Name;
  std::string Note;
};

/**
 * Read a .vti, .vtk, .mha, .mhd, .nrrd, .nhdr, .nii or .nii.gz file or, where this build has
 * vtk-dicom, the largest series of a DICOM folder. Throws std::runtime_error with one sentence that
 * says what is wrong and what to do; nothing else is printed.
 */
Volume ReadVolume(const std::string& path);

/**
 * The volume that is part of the program: CT angiography of a stented abdominal aorta.
 */
Volume ReadBuiltInVolume();

#endif
