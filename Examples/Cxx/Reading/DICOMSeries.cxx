// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/DICOMSeries.h"

#include "ProgressLine.h"
#include "Reading/Reading.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDICOMDirectory.h"
#include "vtkDICOMItem.h"
#include "vtkDICOMUtilities.h"
#include "vtkNew.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

namespace
{
/// Folders in folders: a patient's, a study's, a series', and some to spare.
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
  std::string description = record.Get(DC::SeriesDescription).AsString();
  std::replace_if(
    description.begin(), description.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
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
  ProgressLine line("looking for series in " + folder);
  vtkNew<vtkCallbackCommand> tell;
  tell->SetClientData(&line);
  tell->SetCallback(
    [](vtkObject* caller, unsigned long, void* client, void*) {
      static_cast<ProgressLine*>(client)->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress());
    });
  vtkNew<vtkDICOMDirectory> directory;
  directory->SetDirectoryName(folder.c_str());
  directory->SetScanDepth(Depth);
  directory->RequirePixelDataOn();
  directory->AddObserver(vtkCommand::ProgressEvent, tell);
  directory->Update();
  if (HasFailed(directory.Get(), quiet))
  {
    const char* const file = directory->GetInternalFileName();
    RefuseDamaged(file && *file ? file : folder, quiet);
  }
  std::vector<Series> all;
  for (int i = 0; i < directory->GetNumberOfSeries(); ++i)
  {
    const Series series = MakeSeries(directory->GetSeriesRecord(i));
    // vtkDICOMDirectory makes another series of objects that are there twice
    auto known = std::find_if(all.begin(), all.end(),
      [&](const Series& other) { return !series.Name.empty() && other.Name == series.Name; });
    known = known == all.end() ? all.insert(known, series) : known;
    AddFiles(*known, directory->GetFileNamesForSeries(i));
  }
  return all;
}

/**
 * The series that a file belongs to, or else the largest.
 */
std::size_t FindDefault(const std::vector<Series>& all, const std::string& path)
{
  std::size_t largest = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    for (const std::string& file : all[i].Files)
    {
      std::error_code error;
      if (std::filesystem::equivalent(file, path, error))
      {
        return i;
      }
    }
    largest = all[i].Bytes > all[largest].Bytes ? i : largest;
  }
  return largest;
}
}

bool IsDICOMFile(const std::string& path)
{
  return vtkDICOMUtilities::IsDICOMFile(path.c_str());
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
  if (all.empty())
  {
    Refuse(
      path, "no DICOM images here; give the folder of a CT or MR series, or one of its files.");
  }
  if (number > static_cast<int>(all.size()))
  {
    Refuse(path,
      "there is no series " + std::to_string(number) + " among " + std::to_string(all.size()) +
        "; leave --series out to see their list.");
  }
  const std::size_t chosen =
    number > 0 ? static_cast<std::size_t>(number) - 1 : FindDefault(all, path);
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
