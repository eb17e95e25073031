// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOM.h"

#include "vtkDICOMItem.h"
#include "vtkDICOMSequence.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace
{
void AddNote(std::vector<std::string>& notes, const std::string& note)
{
  if (std::find(notes.begin(), notes.end(), note) == notes.end())
  {
    notes.push_back(note);
  }
}

/**
 * Interpret the first bit of a code as its sign.
 */
double AddSign(double code, const ValueMap& map)
{
  return map.IsSigned && code >= std::ldexp(1.0, map.Bits - 1) ? code - std::ldexp(1.0, map.Bits)
                                                               : code;
}

/**
 * Set a table of values and its first code.
 */
void SetTable(ValueMap& map, const vtkDICOMItem& table)
{
  const vtkDICOMValue descriptor = table.Get(DC::LUTDescriptor);
  const vtkDICOMValue data = table.Get(DC::LUTData);
  if (descriptor.GetNumberOfValues() != 3 || data.GetNumberOfValues() < 1)
  {
    return;
  }
  map.FirstOfTable = AddSign(descriptor.GetUnsignedShort(1), map);
  for (std::size_t i = 0; i < data.GetNumberOfValues(); ++i)
  {
    map.Table.push_back(static_cast<std::uint16_t>(data.GetInt(i)));
  }
}

void SetSlope(ValueMap& map, double slope, double intercept)
{
  if (std::isfinite(slope) && std::isfinite(intercept) && slope != 0.0)
  {
    map.Slope = slope;
    map.Intercept = intercept;
  }
}

/**
 * Set the conversion by the first of the elements that exists, in the order of the standard.
 */
void SetValues(ValueMap& map, const DICOMFrame& frame, std::vector<std::string>& notes)
{
  const vtkDICOMSequence tables = frame.Get(DC::ModalityLUTSequence);
  const vtkDICOMSequence worlds = frame.Get(DC::RealWorldValueMappingSequence);
  if (tables.GetNumberOfItems() > 0)
  {
    SetTable(map, tables.GetItem(0));
    AddNote(notes, "the values are those of the file's Modality LUT");
  }
  else if (frame.Get(DC::RescaleSlope).IsValid())
  {
    SetSlope(
      map, frame.Get(DC::RescaleSlope).AsDouble(), frame.Get(DC::RescaleIntercept).AsDouble());
  }
  else if (frame.Get(DC::DoseGridScaling).IsValid())
  {
    SetSlope(map, frame.Get(DC::DoseGridScaling).AsDouble(), 0.0);
  }
  else if (worlds.GetNumberOfItems() > 0)
  {
    const bool isLinear = worlds.Get(0, DC::RealWorldValueSlope).IsValid();
    SetSlope(map, isLinear ? worlds.Get(0, DC::RealWorldValueSlope).AsDouble() : 1.0,
      isLinear ? worlds.Get(0, DC::RealWorldValueIntercept).AsDouble() : 0.0);
    AddNote(notes,
      isLinear ? "the values are the file's real world values"
               : "the values are codes: the file's table of real world values is not applied");
  }
}

void SetPadding(ValueMap& map, const DICOMFrame& frame, bool hidesPadding)
{
  const vtkDICOMValue value = frame.Get(DC::PixelPaddingValue);
  const vtkDICOMValue limit = frame.Get(DC::PixelPaddingRangeLimit);
  if (!value.IsValid() || map.Bits == 0)
  {
    return;
  }
  // They should be signed if pixels are, but not all files obey.
  const double codes = std::ldexp(1.0, map.Bits);
  const auto read = [&](const vtkDICOMValue& code)
  { return AddSign(std::fmod(code.AsInt() + codes, codes), map); };
  const double first = read(value), second = limit.IsValid() ? read(limit) : first;
  const double middle = map.IsSigned ? 0.0 : 0.5 * codes;
  if (hidesPadding || std::max(first, second) >= middle)
  {
    map.Padding[0] = std::min(first, second);
    map.Padding[1] = std::max(first, second);
  }
}
}

double ValueMap::GetValue(double stored) const
{
  const double code = this->Shift > 0 ? std::floor(std::ldexp(stored, -this->Shift)) : stored;
  if (code >= this->Padding[0] && code <= this->Padding[1])
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!this->Table.empty())
  {
    const double last = static_cast<double>(this->Table.size() - 1);
    return this->Table[static_cast<std::size_t>(std::clamp(code - this->FirstOfTable, 0.0, last))];
  }
  return this->Slope * code + this->Intercept;
}

ValueMap FindValueMap(const DICOMFrame& frame, bool hidesPadding, std::vector<std::string>& notes)
{
  ValueMap map;
  const int type = frame.File->ScalarType;
  if (type != VTK_FLOAT && type != VTK_DOUBLE)
  {
    const int most = 8 * vtkDataArray::GetDataTypeSize(type);
    const int stored = frame.Get(DC::BitsStored).AsInt();
    map.Shift = frame.File->Shift;
    map.Bits = (stored > 0 ? std::min(stored, most) : most) - map.Shift;
    map.IsSigned = frame.Get(DC::PixelRepresentation).AsInt() == 1;
  }
  SetValues(map, frame, notes);
  SetPadding(map, frame, hidesPadding);
  if (frame.Get(DC::PhotometricInterpretation).AsString() == "MONOCHROME1")
  {
    AddNote(
      notes, "low values are bright in this file (MONOCHROME1): --colormap inverted shows them so");
  }
  return map;
}

int FindScalarType(const DICOMFrames& frames, const std::vector<ValueMap>& maps)
{
  double low = 0.0, high = 0.0;
  bool isWhole = true, isNarrow = true;
  for (std::size_t i = 0; i < maps.size(); ++i)
  {
    ValueMap map = maps[i];
    const int type = frames[i].File->ScalarType;
    const bool hasPadding = map.Padding[0] <= map.Padding[1];
    isNarrow = isNarrow && (type == VTK_FLOAT || vtkDataArray::GetDataTypeSize(type) <= 2);
    isWhole = isWhole && map.Bits > 0 && !hasPadding && std::floor(map.Slope) == map.Slope &&
      std::floor(map.Intercept) == map.Intercept;
    const double codes = std::ldexp(1.0, map.Bits);
    for (const double code :
      { map.IsSigned ? -0.5 * codes : 0.0, map.IsSigned ? 0.5 * codes - 1.0 : codes - 1.0 })
    {
      const double value = map.Table.empty() ? map.Slope * code + map.Intercept
        : code > 0.0                         ? 65535.0
                                             : 0.0;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!isWhole)
  {
    return isNarrow ? VTK_FLOAT : VTK_DOUBLE;
  }
  return low >= 0.0 && high <= VTK_UNSIGNED_CHAR_MAX ? VTK_UNSIGNED_CHAR
    : low >= VTK_SHORT_MIN && high <= VTK_SHORT_MAX  ? VTK_SHORT
    : low >= 0.0 && high <= VTK_UNSIGNED_SHORT_MAX   ? VTK_UNSIGNED_SHORT
    : low >= VTK_INT_MIN && high <= VTK_INT_MAX      ? VTK_INT
    : low >= 0.0 && high <= VTK_UNSIGNED_INT_MAX     ? VTK_UNSIGNED_INT
                                                     : VTK_DOUBLE;
}

void ConvertSlice(vtkImageData* stored, int frame, const ValueMap& map, vtkImageData* to, int slice)
{
  vtkDataArray* const from = stored->GetPointData()->GetScalars();
  vtkDataArray* const values = to->GetPointData()->GetScalars();
  const vtkIdType pixels = vtkIdType(to->GetDimensions()[0]) * to->GetDimensions()[1];
  const auto convert = [&](vtkIdType begin, vtkIdType end)
  {
    for (vtkIdType i = begin; i < end; ++i)
    {
      for (int n = 0; n < from->GetNumberOfComponents(); ++n)
      {
        const double code = from->GetComponent(frame * pixels + i, n);
        values->SetComponent(slice * pixels + i, n, map.GetValue(code));
      }
    }
  };
  vtkSMPTools::For(0, pixels, convert);
}
