// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/SafeFiles.h"

#include <vtksys/SystemTools.hxx>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

namespace
{
constexpr int Interrupts[] = { SIGINT, SIGTERM, SIGHUP };

/// The signals that were ignored when the program started, as SIGHUP is under nohup.
bool IgnoredAtStart[std::size(Interrupts)] = {};

#ifdef __linux__
void FindIgnored(int, char**, char**)
{
  for (std::size_t n = 0; n < std::size(Interrupts); ++n)
  {
    struct sigaction action = {};
    sigaction(Interrupts[n], nullptr, &action);
    IgnoredAtStart[n] = action.sa_handler == SIG_IGN;
  }
}

/// Runs before libraries are initialised, because UCX, which VTK may load with MPI, handles SIGHUP
/// from then on.
__attribute__((section(".preinit_array"), used)) void (*FindIgnoredFirst)(
  int, char**, char**) = &FindIgnored;
#endif

/// The files that an interrupt must remove, or nullptr.
std::atomic<const std::vector<std::string>*> Unfinished{ nullptr };

/// Async-signal-safe on POSIX: the list does not change while it is registered.
void RemoveUnfinished(int signal)
{
  const std::vector<std::string>* const names = Unfinished.load();
  for (std::size_t n = 0; names && n < names->size(); ++n)
  {
    std::remove((*names)[n].c_str());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/**
 * Names of files that do not exist yet, which are removed at the end of the scope or by a signal.
 */
class TemporaryFiles
{
public:
  explicit TemporaryFiles(const std::vector<std::string>& outputs)
  {
    for (const std::string& output : outputs)
    {
      this->Names.push_back(MakeName(output, this->Names.size()));
    }
    Unfinished = &this->Names;
    for (std::size_t n = 0; n < std::size(Interrupts); ++n)
    {
      // Ignored signals remain ignored at any moment.
      this->Handlers[n] = std::signal(Interrupts[n], SIG_IGN);
      if (this->Handlers[n] != SIG_IGN)
      {
        std::signal(Interrupts[n], RemoveUnfinished);
      }
    }
  }

  ~TemporaryFiles()
  {
    for (const std::string& name : this->Names) // while a signal would remove them, too
    {
      std::remove(name.c_str());
    }
    for (std::size_t n = 0; n < std::size(Interrupts); ++n)
    {
      std::signal(Interrupts[n], this->Handlers[n]);
    }
    Unfinished = nullptr;
  }

  TemporaryFiles(const TemporaryFiles&) = delete;
  TemporaryFiles& operator=(const TemporaryFiles&) = delete;

  std::vector<std::string> Names;

private:
  /// In the same folder, so that it can be renamed; readers and writers need the ending.
  static std::string MakeName(const std::string& output, std::size_t number)
  {
    const std::filesystem::path path(output);
    const std::string end = path.extension().string();
    const std::string ending = end == ".gz" ? path.stem().extension().string() + end : end;
    std::random_device random;
    std::filesystem::path name;
    std::error_code error;
    do
    {
      name = path.parent_path() /
        (".splatmip-" + std::to_string(random()) + "-" + std::to_string(number) + ending);
    } while (std::filesystem::exists(name, error));
    return name.string();
  }

  void (*Handlers[std::size(Interrupts)])(int);
};

/// Follow links, also to files that do not exist yet, so that links remain links.
std::string FollowLinks(const std::string& output)
{
  constexpr int MostLinks = 40;
  std::error_code error;
  std::filesystem::path path = output;
  for (int n = 0; n < MostLinks && std::filesystem::is_symlink(path, error); ++n)
  {
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  }
  return path.string();
}

std::runtime_error CannotWrite(const std::string& output)
{
  return std::runtime_error(
    output + ": this cannot be written; give a file in a folder that you may write to (--output).");
}

/// Give a new file the permissions of the one that it replaces.
void KeepPermissions(const std::string& name, const std::string& output)
{
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(output, error);
  if (std::filesystem::is_regular_file(status))
  {
    std::filesystem::permissions(name, status.permissions(), error);
  }
}
}

void KeepIgnoredSignals()
{
  for (std::size_t n = 0; n < std::size(Interrupts); ++n)
  {
    if (IgnoredAtStart[n])
    {
      std::signal(Interrupts[n], SIG_IGN);
    }
  }
}

void CheckWritable(const std::vector<std::string>& outputs)
{
  for (const std::string& output : outputs)
  {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(output, error);
    if (std::filesystem::exists(status) &&
      (!std::filesystem::is_regular_file(status) ||
        !vtksys::SystemTools::TestFileAccess(output, vtksys::TEST_FILE_WRITE)))
    {
      throw CannotWrite(output);
    }
  }
  const TemporaryFiles temporary({ FollowLinks(outputs.front()) });
  if (!std::ofstream(temporary.Names.front(), std::ios::binary))
  {
    throw CannotWrite(outputs.front());
  }
}

void CheckNotInput(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs)
{
  for (const std::string& output : outputs)
  {
    std::error_code error;
    for (std::size_t n = 0; n < inputs.size() && std::filesystem::exists(output, error); ++n)
    {
      if (std::filesystem::equivalent(output, inputs[n], error))
      {
        throw std::runtime_error(
          output + ": this is one of the files to read; give another --output.");
      }
    }
  }
}

void WriteSafely(const std::vector<std::string>& outputs,
  const std::function<bool(const std::vector<std::string>& names)>& write)
{
  std::vector<std::string> targets;
  for (const std::string& output : outputs)
  {
    targets.push_back(FollowLinks(output));
  }
  const TemporaryFiles temporary(targets);
  if (!write(temporary.Names))
  {
    throw std::runtime_error(outputs.front() +
      ": this could not be written completely, so nothing was written; see whether the disk is "
      "full.");
  }
  for (std::size_t n = 0; n < targets.size(); ++n)
  {
    std::error_code error;
    KeepPermissions(temporary.Names[n], targets[n]);
    std::filesystem::rename(temporary.Names[n], targets[n], error);
    if (error)
    {
      throw std::runtime_error(outputs[n] + ": this could not be replaced" +
        (n > 0 ? ", but the files before it were written" : "") +
        "; see whether another program uses it.");
    }
  }
}
