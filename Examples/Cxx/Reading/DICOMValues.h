// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMValues_h
#define DICOMValues_h

#include "Reading/DICOMFrames.h"

#include <string>
#include <vector>

/**
 * Conversion of the stored bits of a frame to values in the file's unit.
 */
struct ValueMap
{
  int Bits = 0;  // of a code; 0 if pixels are floating point
  int Shift = 0; // bits of a pixel below the code
  bool IsSigned = false;
  double Slope = 1.0;
  double Intercept = 0.0;
  std::vector<double> Table;        // of values, in place of slope and intercept, or empty
  double FirstOfTable = 0.0;        // its first code
  double Padding[2] = { 1.0, 0.0 }; // codes from, to, that become NaN; none if they fall

  double GetValue(double stored) const;
  bool operator==(const ValueMap& other) const;
};

/**
 * Find the conversion of a frame by rescale slope and intercept, Modality LUT, dose grid scaling or
 * real world values. Notes name what is not applied. Padding is hidden if its code is in the upper
 * half, or if the caller asks for that.
 */
ValueMap FindValueMap(const DICOMFrame& frame, bool hidesPadding, std::vector<std::string>& notes);

/**
 * Find the type that holds all possible values.
 */
int FindScalarType(const std::vector<const DICOMFrame*>& frames, const std::vector<ValueMap>& maps);

/**
 * Copies frames of pixels to slices of values. Keeps the table of the last conversion, so one
 * object should be used for many frames.
 */
class SliceConverter
{
public:
  void Convert(vtkImageData* stored, int frame, const ValueMap& map, vtkImageData* to, int slice);

private:
  ValueMap Map;
  std::vector<double> Values; // by stored bits, of at most 16
};

#endif
