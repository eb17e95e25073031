// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/FileHeaders.h"

#include "vtk_zlib.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace
{
std::string Trim(const std::string& text)
{
  const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/**
 * Whether a text starts with the given lower-case letters, in either case.
 */
bool StartsWith(const std::string& text, const std::string& letters)
{
  return text.size() >= letters.size() &&
    std::equal(letters.begin(), letters.end(), text.begin(),
      [](char letter, unsigned char c)
      { return std::tolower(c) == static_cast<unsigned char>(letter); });
}

/**
 * Whether a file's zlib or gzip data from offset on are sound and have so many bytes inside.
 */
bool Inflates(const std::string& path, std::uintmax_t offset, std::uintmax_t bytes)
{
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  std::vector<char> packed(1 << 18), unpacked(1 << 20);
  z_stream stream = {};
  if (inflateInit2(&stream, 15 + 32) != Z_OK) // 32: either header
  {
    return false;
  }
  std::uintmax_t found = 0;
  int state = Z_OK;
  while (found < bytes && state >= Z_OK)
  {
    if (stream.avail_in == 0)
    {
      file.read(packed.data(), static_cast<std::streamsize>(packed.size()));
      stream.next_in = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_in = static_cast<uInt>(file.gcount());
      if (stream.avail_in == 0)
      {
        break;
      }
    }
    stream.next_out = reinterpret_cast<Bytef*>(unpacked.data());
    stream.avail_out = static_cast<uInt>(unpacked.size());
    state = inflate(&stream, Z_NO_FLUSH);
    found += unpacked.size() - stream.avail_out;
    if (state == Z_STREAM_END)
    {
      state = inflateReset(&stream); // gzip files may be chained
    }
  }
  inflateEnd(&stream);
  return found >= bytes;
}

/**
 * Whether NIfTI has a type of this code with so many bits, and VTK too.
 */
bool IsNIFTIType(std::uint64_t code, std::uint64_t bits)
{
  static const std::map<std::uint64_t, std::uint64_t> types = { { 2, 8 }, { 4, 16 }, { 8, 32 },
    { 16, 32 }, { 32, 64 }, { 64, 64 }, { 128, 24 }, { 256, 8 }, { 512, 16 }, { 768, 32 },
    { 1024, 64 }, { 1280, 64 }, { 1792, 128 }, { 2304, 32 } };
  const auto type = types.find(code);
  return type != types.end() && type->second == bits;
}

/**
 * The .hdr that belongs to an .img, either of which may be compressed.
 */
std::string FindNIFTIHeader(const std::string& path)
{
  std::filesystem::path name(path);
  name = name.extension() == ".gz" ? name.replace_extension() : name;
  const std::string ending = name.extension().string();
  if (!StartsWith(ending, ".img"))
  {
    return path;
  }
  name.replace_extension(ending == ".IMG" ? ".HDR" : ".hdr");
  std::error_code error;
  return std::filesystem::exists(name, error) ? name.string() : name.string() + ".gz";
}
}

TextHeader::TextHeader(const std::string& path) : Path(path)
{
  std::ifstream file(path, std::ios::binary);
  std::string line;
  while (std::getline(file, line))
  {
    // VTK waits forever for the end of a last line of NRRD
    this->IsText = this->IsText && !file.eof() && line.find('\0') == std::string::npos;
    this->Size += line.size() + 1;
    line = Trim(line);
    const std::size_t end = line.find_first_of(":=");
    const std::string key = Trim(line.substr(0, end));
    if (end != std::string::npos)
    {
      this->Fields.emplace(key, Trim(line.substr(end + 1)));
    }
    if (line.empty() || key == "ElementDataFile") // the last line of NRRD, of MetaImage
    {
      break;
    }
  }
}

std::string TextHeader::Get(const std::string& key) const
{
  const auto field = this->Fields.find(key);
  return field == this->Fields.end() ? "" : field->second;
}

int TextHeader::GetDimension() const
{
  return std::atoi((this->Get("dimension") + this->Get("NDims")).c_str());
}

bool TextHeader::IsSound() const
{
  const int dimension = this->GetDimension();
  std::istringstream sizes(this->Get("sizes") + this->Get("DimSize"));
  int found = 0;
  for (int size = 0; sizes >> size && size > 0; ++found)
  {
  }
  const bool hasEmptyName = (this->Fields.count("data file") || this->Fields.count("datafile")) &&
    this->GetDataFile().empty();
  return this->IsText && !hasEmptyName && dimension >= 2 && dimension <= 3 && found == dimension;
}

bool TextHeader::IsSplit() const
{
  const std::string name = this->GetDataFile();
  return name.find('%') != std::string::npos || StartsWith(name, "list");
}

bool TextHeader::HasData(std::uintmax_t values, std::uintmax_t bytesPerValue) const
{
  const std::string name = this->GetDataFile();
  const bool isInside = name.empty() || (name.size() == 5 && StartsWith(name, "local"));
  const std::filesystem::path folder = std::filesystem::path(this->Path).parent_path();
  const std::string path = isInside ? this->Path : (folder / name).string();
  const long long skip = std::max(0LL, std::atoll(this->Get("HeaderSize").c_str()));
  const std::uintmax_t offset = isInside ? this->Size : static_cast<std::uintmax_t>(skip);
  if (StartsWith(this->Get("encoding"), "g") || StartsWith(this->Get("CompressedData"), "t"))
  {
    return Inflates(path, offset, values * bytesPerValue);
  }
  const bool isText = StartsWith(this->Get("encoding"), "a") ||
    StartsWith(this->Get("encoding"), "t") || StartsWith(this->Get("BinaryData"), "f");
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return !error && size >= offset + (isText ? 2 * values - 1 : bytesPerValue * values);
}

std::string TextHeader::GetDataFile() const
{
  return this->Get("ElementDataFile") + this->Get("data file") + this->Get("datafile");
}

bool HasSoundNIFTIHeader(const std::string& path)
{
  unsigned char header[80] = {}; // up to the end of the sizes, in either version
  gzFile file = gzopen(FindNIFTIHeader(path).c_str(), "rb"); // reads uncompressed files, too
  const int found = file ? gzread(file, header, sizeof(header)) : 0;
  if (file)
  {
    gzclose(file);
  }
  const bool isLittle = header[0] != 0;
  const auto read = [&](int offset, int bytes)
  {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
    {
      value = value * 256 + header[offset + (isLittle ? bytes - 1 - i : i)];
    }
    return value;
  };
  // The first number is the header's size: 348, or 540 for version 2 with its wider numbers.
  const std::uint64_t size = read(0, 4);
  const bool isWide = size == 540;
  const auto readSize = [&](int axis)
  { return isWide ? read(16 + 8 * axis, 8) : read(40 + 2 * axis, 2); };
  bool isSound = found == sizeof(header) && (size == 348 || isWide) && readSize(0) >= 2 &&
    readSize(0) <= 7 && IsNIFTIType(read(isWide ? 12 : 70, 2), read(isWide ? 14 : 72, 2));
  for (int axis = 1; axis <= 3; ++axis)
  {
    isSound = isSound && readSize(axis) >= 1 && readSize(axis) <= 32767;
  }
  return isSound;
}

bool HasSoundTIFFPages(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  const auto readNumber = [&](int bytes, bool isLittle)
  {
    unsigned char digits[8] = {};
    file.read(reinterpret_cast<char*>(digits), bytes);
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
    {
      value = value * 256 + digits[isLittle ? bytes - 1 - i : i];
    }
    return value;
  };
  const bool isLittle = readNumber(2, true) == 0x4949;
  const bool isBig = readNumber(2, isLittle) == 43; // BigTIFF has wider numbers, and two more
  file.seekg(isBig ? 8 : 4);
  const int bytes = isBig ? 8 : 4;
  std::uint64_t page = readNumber(bytes, isLittle);
  const bool hasPage = page != 0;
  for (int n = 0; n < 1000000 && file && page != 0; ++n) // damaged pages may run in a circle
  {
    file.seekg(static_cast<std::streamoff>(page));
    const std::uint64_t entries = readNumber(isBig ? 8 : 2, isLittle);
    file.seekg(static_cast<std::streamoff>(entries * (isBig ? 20 : 12)), std::ios::cur);
    page = readNumber(bytes, isLittle);
  }
  return hasPage && file && page == 0;
}
