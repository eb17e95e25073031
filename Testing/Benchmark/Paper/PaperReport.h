// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * A report in Markdown with pictures beside it.
 */
#ifndef PaperReport_h
#define PaperReport_h

#include "Paper/PaperRenderer.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

class PaperReport
{
public:
  /**
   * Makes the folder, and report.md in it. Throws std::runtime_error if that cannot be.
   */
  explicit PaperReport(const std::string& folder);

  void AddHeading(const std::string& text);
  /// A paragraph.
  void AddText(const std::string& text);
  void AddList(const std::vector<std::string>& items);
  void AddTable(
    const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

  /**
   * Panels row by row, the first row on top, all of the same size, as NAME.png. Throws
   * std::runtime_error if a panel is black or the file cannot be written.
   */
  void AddFigure(const std::string& name, const std::string& caption,
    const std::vector<std::vector<PaperPicture>>& panels);

private:
  const std::filesystem::path Folder;
  std::ofstream File;
};

/// The number with so many decimals.
std::string Fixed(double value, int decimals);
/// The number with about three digits.
std::string Short(double value);
/// "one, two and three".
std::string Join(const std::vector<std::string>& items);

#endif
