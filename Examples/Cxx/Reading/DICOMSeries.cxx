// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOM.h"

#include "ProgressLine.h"
#include "Reading/Reading.h"

#include "vtkDICOMDirectory.h"
#include "vtkDICOMItem.h"
#include "vtkDICOMUtilities.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace
{
/// Levels of folders that are searched.
constexpr int Depth = 8;

struct Series
{
  std::vector<std::string> Files;
  std::string Name; // its unique identifier
  std::string Text; // for the user
  std::uintmax_t Bytes = 0;
};

Series MakeSeries(const vtkDICOMItem& record)
{
  Series series;
  const std::string description = record.Get(DC::SeriesDescription).AsUTF8String();
  series.Name = record.Get(DC::SeriesInstanceUID).AsString();
  series.Text = record.Get(DC::Modality).AsString();
  series.Text += description.empty() ? "" : " \"" + description + "\"";
  return series;
}

void AddFiles(Series& series, vtkStringArray* files)
{
  for (vtkIdType i = 0; i < files->GetNumberOfValues(); ++i)
  {
    series.Files.push_back(files->GetValue(i));
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(series.Files.back(), error);
    series.Bytes += error ? 0 : bytes;
  }
}

std::vector<Series> FindSeries(const std::string& folder, const QuietReading& quiet)
{
  vtkNew<vtkDICOMDirectory> directory;
  directory->SetDirectoryName(folder.c_str());
  directory->SetScanDepth(Depth);
  directory->RequirePixelDataOn();
  const ProgressLine line("looking for series in " + folder, directory);
  directory->Update();
  if (HasFailed(directory.Get(), quiet))
  {
    const char* const file = directory->GetInternalFileName();
    RefuseDamaged(file && *file ? file : folder, quiet.GetReason());
  }
  std::vector<Series> all;
  for (int i = 0; i < directory->GetNumberOfSeries(); ++i)
  {
    const Series series = MakeSeries(directory->GetSeriesRecord(i));
    // vtkDICOMDirectory lists copies of objects as another series
    auto known = std::find_if(all.begin(), all.end(),
      [&](const Series& other) { return !series.Name.empty() && other.Name == series.Name; });
    known = known == all.end() ? all.insert(known, series) : known;
    AddFiles(*known, directory->GetFileNamesForSeries(i));
  }
  return all;
}

/**
 * Find the series of a file, or the largest of a folder. Returns the number of series if there is
 * none.
 */
std::size_t FindDefault(const std::vector<Series>& all, const std::string& path)
{
  const std::string name = std::filesystem::path(path).filename().string();
  if (std::filesystem::is_directory(path) || vtksys::SystemTools::UpperCase(name) == "DICOMDIR")
  {
    const auto largest = std::max_element(
      all.begin(), all.end(), [](const Series& a, const Series& b) { return a.Bytes < b.Bytes; });
    return static_cast<std::size_t>(largest - all.begin());
  }
  const auto found = std::find_if(all.begin(), all.end(),
    [&](const Series& series)
    {
      return std::any_of(series.Files.begin(), series.Files.end(),
        [&](const std::string& file)
        {
          std::error_code error;
          return std::filesystem::equivalent(file, path, error);
        });
    });
  return static_cast<std::size_t>(found - all.begin());
}
}

std::string ExplainFile(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::string head(2048, '\0');
  file.read(&head[0], static_cast<std::streamsize>(head.size()));
  const std::string name = std::filesystem::path(path).filename().string();
  if (head.compare(0, 2, "\x1F\x8B") == 0)
  {
    return name + " is compressed by gzip; unpack it with gunzip.";
  }
  if (head.compare(128, 4, "DICM") == 0)
  {
    return head.find("1.2.840.10008.1.2.1.99") == std::string::npos
      ? ""
      : name + " is deflated DICOM; convert it with DCMTK's dcmconv +te.";
  }
  const auto isLetter = [](char c) { return c >= 'A' && c <= 'Z'; };
  // group 8 or 2, of an element below 0x100, with a type in two letters or a short length
  const bool isBig = head[0] == 0;
  const char group = head[isBig ? 1 : 0];
  const bool isElement = (group == 8 || group == 2) && head[isBig ? 0 : 1] == 0 &&
    head[isBig ? 2 : 3] == 0 &&
    ((isLetter(head[4]) && isLetter(head[5])) || (head[6] == 0 && head[7] == 0));
  return isElement
    ? name + " looks like DICOM without a header; convert it with DCMTK's dcmconv +te."
    : "";
}

bool IsDICOMFile(const std::string& path)
{
  return vtkDICOMUtilities::IsDICOMFile(path.c_str());
}

namespace
{
/**
 * Explain a file, or the first of a folder that has an explanation.
 */
std::string ExplainFiles(const std::string& path)
{
  std::error_code error;
  if (!std::filesystem::is_directory(path, error))
  {
    return ExplainFile(path);
  }
  std::string reason;
  for (std::filesystem::recursive_directory_iterator entry(path, error), end;
       reason.empty() && !error && entry != end; entry.increment(error))
  {
    reason = entry->is_regular_file(error) ? ExplainFile(entry->path().string()) : "";
  }
  return reason;
}
}

std::vector<std::string> ChooseSeries(const std::string& path, int number,
  const QuietReading& quiet, std::vector<std::string>& notes, std::vector<std::string>& files)
{
  const bool isFolder = std::filesystem::is_directory(path);
  const std::string parent = std::filesystem::path(path).parent_path().string();
  const std::vector<Series> all = FindSeries(isFolder ? path
      : parent.empty()                                ? "."
                                                      : parent,
    quiet);
  const std::size_t chosen =
    number > 0 ? static_cast<std::size_t>(number) - 1 : FindDefault(all, path);
  if (all.empty() || (number == 0 && chosen == all.size()))
  {
    const std::string reason = ExplainFiles(path);
    Refuse(path,
      reason.empty() ? "no DICOM images here; give the folder of a CT or MR series, or one of its "
                       "files."
                     : reason);
  }
  if (number > static_cast<int>(all.size()))
  {
    Refuse(path,
      "there is no series " + std::to_string(number) + " among " + std::to_string(all.size()) +
        "; leave --series out to see their list.");
  }
  if (all.size() > 1)
  {
    notes.push_back("there are " + std::to_string(all.size()) + " series (--series chooses):");
  }
  for (const Series& series : all)
  {
    files.insert(files.end(), series.Files.begin(), series.Files.end());
  }
  for (std::size_t i = 0; i < all.size() && all.size() > 1; ++i)
  {
    notes.push_back("  " + std::to_string(i + 1) + ": " + all[i].Text + ", " +
      std::to_string(all[i].Files.size()) + (all[i].Files.size() == 1 ? " file" : " files") +
      (i == chosen ? ", shown here" : ""));
  }
  return all[chosen].Files;
}
