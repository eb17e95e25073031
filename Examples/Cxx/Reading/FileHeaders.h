// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef FileHeaders_h
#define FileHeaders_h

#include <cstdint>
#include <map>
#include <string>

// VTK's readers trust headers: version 9.1 shows cut raw and MetaImage data without a word, waits
// forever on a cut NRRD header, and ends the program for some damaged NRRD, MetaImage and NIfTI
// headers. What is here is looked at before they are asked.

/**
 * The lines "key: value" (NRRD) or "key = value" (MetaImage) that begin a file.
 */
class TextHeader
{
public:
  explicit TextHeader(const std::string& path);

  /**
   * The value of a key; empty if the header does not have it.
   */
  std::string Get(const std::string& key) const;

  /**
   * The number of dimensions, or 0.
   */
  int GetDimension() const;

  /**
   * Whether the header is text to its end and gives a size for each of two or three dimensions.
   */
  bool IsSound() const;

  /**
   * Whether the data are in several files, named by a list or a pattern.
   */
  bool IsSplit() const;

  /**
   * Whether there are enough data for so many values, after decompression; a value in text has at
   * least two characters.
   */
  bool HasData(std::uintmax_t values, std::uintmax_t bytesPerValue) const;

private:
  std::string GetDataFile() const;

  std::string Path;
  std::uintmax_t Size = 0; // where the data begin if they are in the same file
  bool IsText = true;
  std::map<std::string, std::string> Fields;
};

/**
 * Whether a NIfTI file, or the .hdr of an .img, compressed or not, begins with a header with three
 * sizes and a known type.
 */
bool HasSoundNIFTIHeader(const std::string& path);

/**
 * Whether a TIFF file has all pages that it announces: VTK shows those that are left of a cut file.
 */
bool HasSoundTIFFPages(const std::string& path);

#endif
