// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TIFFPages_h
#define TIFFPages_h

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct tiff;

/**
 * The pages of a TIFF file, which have the same size and type. Constructor and methods throw
 * std::runtime_error with one sentence, with tag and value where a page is not supported.
 */
class TIFFPages
{
public:
  explicit TIFFPages(const std::string& path);

  int GetWidth() const { return static_cast<int>(this->Width); }
  int GetHeight() const { return static_cast<int>(this->Height); }
  int GetVTKType() const;
  int GetComponents() const { return this->Samples; }

  /**
   * Get the number of pages, less masks and reduced copies of others.
   */
  int GetCount() const { return static_cast<int>(this->Pages.size()); }

  /**
   * Get the first page's description, and its pixels per unit, or 0.
   */
  const std::string& GetDescription() const { return this->Description; }
  const double* GetResolution() const { return this->Resolution; }

  /**
   * Read a page, from 0 on, top row first.
   */
  void Read(int page, char* pixels);

  /**
   * Read one of several pictures, from 0 on, that follow each other behind the only page.
   */
  void ReadBehind(int number, char* pixels);

private:
  [[noreturn]] void RefuseTag(const char* tag, double value, const std::string& advice) const;
  void CheckType() const;
  void CheckKind();
  [[noreturn]] void RefuseReported() const;
  std::size_t GetRowBytes() const { return this->Width * this->Samples * this->Bits / 8; }

  std::string Path;
  std::unique_ptr<tiff, void (*)(tiff*)> File;
  std::vector<std::uint32_t> Pages;
  std::uint32_t Width = 0;
  std::uint32_t Height = 0;
  std::uint16_t Bits = 1;
  std::uint16_t Format = 1;
  std::uint16_t Samples = 1;
  std::string Description;
  double Resolution[2] = { 0.0, 0.0 };
};

#endif
