// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperReport.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace
{
constexpr int Gap = 4; // white pixels between panels

std::string MakeRow(const std::vector<std::string>& cells)
{
  std::string row = "|";
  for (const std::string& cell : cells)
  {
    row += " " + cell + " |";
  }
  return row + "\n";
}

/// Row 0 of pictures and images is the lowest.
void Paste(const PaperPicture& picture, int left, int bottom, vtkImageData* image)
{
  for (int y = 0; y < picture.height; ++y)
  {
    auto* row = static_cast<unsigned char*>(image->GetScalarPointer(left, bottom + y, 0));
    for (int x = 0; x < picture.width; ++x)
    {
      row[x] = static_cast<unsigned char>(std::lround(picture.at(x, y)));
    }
  }
}

void RequireContents(const PaperPicture& picture, const std::string& name)
{
  if (*std::max_element(picture.value.begin(), picture.value.end()) <= 0.0)
  {
    throw std::runtime_error("A panel of " + name + " is black.");
  }
}
}

//------------------------------------------------------------------------------
PaperReport::PaperReport(const std::string& folder) : Folder(folder)
{
  std::error_code error;
  std::filesystem::create_directories(this->Folder, error);
  this->File.open(this->Folder / "report.md");
  if (!this->File)
  {
    throw std::runtime_error("The report cannot be written to " + folder + ".");
  }
}

//------------------------------------------------------------------------------
void PaperReport::AddHeading(const std::string& text)
{
  this->File << "## " << text << "\n\n" << std::flush;
}

//------------------------------------------------------------------------------
void PaperReport::AddText(const std::string& text)
{
  this->File << text << "\n\n";
}

//------------------------------------------------------------------------------
void PaperReport::AddList(const std::vector<std::string>& items)
{
  for (const std::string& item : items)
  {
    this->File << "- " << item << "\n";
  }
  this->File << "\n";
}

//------------------------------------------------------------------------------
void PaperReport::AddTable(
  const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows)
{
  this->File << MakeRow(head) << MakeRow(std::vector<std::string>(head.size(), "---"));
  for (const std::vector<std::string>& row : rows)
  {
    this->File << MakeRow(row);
  }
  this->File << "\n";
}

//------------------------------------------------------------------------------
void PaperReport::AddFigure(const std::string& name, const std::string& caption,
  const std::vector<std::vector<PaperPicture>>& panels)
{
  const int stepX = panels[0][0].width + Gap, stepY = panels[0][0].height + Gap;
  const int columns = static_cast<int>(panels[0].size()), rows = static_cast<int>(panels.size());
  vtkNew<vtkImageData> image;
  image->SetDimensions(columns * stepX - Gap, rows * stepY - Gap, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  std::fill_n(static_cast<unsigned char*>(image->GetScalarPointer()), image->GetNumberOfPoints(),
    static_cast<unsigned char>(255));
  for (int row = 0; row < rows; ++row)
  {
    for (int column = 0; column < columns; ++column)
    {
      RequireContents(panels[row][column], name);
      Paste(panels[row][column], column * stepX, (rows - 1 - row) * stepY, image);
    }
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName((this->Folder / (name + ".png")).string().c_str());
  writer->SetInputData(image);
  writer->Write();
  if (writer->GetErrorCode() != 0)
  {
    throw std::runtime_error(name + ".png cannot be written.");
  }
  this->File << "![" << caption << "](" << name << ".png)\n\n" << caption << "\n\n";
}

//------------------------------------------------------------------------------
std::string Fixed(double value, int decimals)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

//------------------------------------------------------------------------------
std::string Short(double value)
{
  const double magnitude = std::abs(value);
  return Fixed(value, magnitude >= 99.95 ? 0 : magnitude >= 9.995 ? 1 : magnitude >= 0.1 ? 2 : 3);
}

//------------------------------------------------------------------------------
std::string Join(const std::vector<std::string>& items)
{
  std::string text;
  for (std::size_t n = 0; n < items.size(); ++n)
  {
    text += (n == 0 ? "" : n + 1 == items.size() ? " and " : ", ") + items[n];
  }
  return text;
}
