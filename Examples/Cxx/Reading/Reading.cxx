// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkImageExtractComponents.h"
#include "vtkNew.h"
#include "vtk_utf8.h"

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <stdexcept>

void Refuse(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

void RefuseDamaged(const std::string& path, const std::string& report)
{
  const std::string reason = report.substr(0, report.find_last_not_of(" .\n\r") + 1);
  Refuse(path,
    "damaged, incomplete or not what its name says" + (reason.empty() ? "" : " (" + reason + ")") +
      "; check it, or export the volume again.");
}

std::string MakePrintable(const std::string& text)
{
  std::string valid, printable;
  utf8::replace_invalid(text.begin(), text.end(), std::back_inserter(valid), '?');
  for (auto place = valid.begin(); place != valid.end();)
  {
    const std::uint32_t letter = utf8::next(place, valid.end());
    const bool isControl = letter < ' ' || (letter >= 0x7F && letter < 0xA0);
    utf8::append(isControl ? '?' : letter, std::back_inserter(printable));
  }
  return printable;
}

std::string ReadHead(const std::string& path)
{
  std::string head(1 << 20, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(&head[0], static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

int Choose(const std::string& path, const std::string& what, int number, int count,
  std::vector<std::string>& notes)
{
  const std::string option = what == "volume" ? "--frame" : "--" + what;
  if (number > count)
  {
    Refuse(path,
      "there is no " + what + " " + std::to_string(number) + " here, only " +
        std::to_string(count) + "; give another " + option + ".");
  }
  number = std::max(number, 1);
  if (count > 1)
  {
    notes.push_back(what + " " + std::to_string(number) + " of " + std::to_string(count) + " (" +
      option + " chooses)");
  }
  return number;
}

vtkSmartPointer<vtkImageData> ExtractComponent(vtkImageData* image, int number)
{
  if (image->GetNumberOfScalarComponents() == 1)
  {
    return image;
  }
  vtkNew<vtkImageExtractComponents> extract;
  extract->SetInputData(image);
  extract->SetComponents(number - 1);
  extract->Update();
  extract->GetOutput()->SetDirectionMatrix(image->GetDirectionMatrix()); // filters omit it
  return extract->GetOutput();
}

int FindFloatType(int type)
{
  return type == VTK_FLOAT || vtkDataArray::GetDataTypeSize(type) <= 2 ? VTK_FLOAT : VTK_DOUBLE;
}

int FindScalarType(std::size_t bytes, bool isFloat, bool isSigned)
{
  switch (bytes)
  {
    case 1:
      return isFloat ? VTK_VOID : isSigned ? VTK_SIGNED_CHAR : VTK_UNSIGNED_CHAR;
    case 2:
      return isFloat ? VTK_VOID : isSigned ? VTK_SHORT : VTK_UNSIGNED_SHORT;
    case 4:
      return isFloat ? VTK_FLOAT : isSigned ? VTK_INT : VTK_UNSIGNED_INT;
    case 8:
      return isFloat ? VTK_DOUBLE : isSigned ? VTK_LONG_LONG : VTK_UNSIGNED_LONG_LONG;
    default:
      return VTK_VOID;
  }
}

std::string JoinWords(const std::vector<std::string>& words)
{
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n)
  {
    text += n == 0 ? "" : n + 1 < words.size() ? ", " : " or ";
    text += words[n];
  }
  return text;
}

void CheckMemory(double voxels, const std::string& path)
{
  vtksys::SystemInformation machine;
  machine.RunMemoryCheck();
  const double mebibytes = static_cast<double>(machine.GetTotalPhysicalMemory());
  if (voxels > mebibytes * 1024.0 * 1024.0)
  {
    Refuse(path,
      "the header asks for more voxels than this machine has bytes of memory; it is damaged, or "
      "the volume must be reduced first.");
  }
}
