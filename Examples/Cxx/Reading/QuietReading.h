// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef QuietReading_h
#define QuietReading_h

#include "vtkLogger.h"
#include "vtkOutputWindow.h"
#include "vtkSmartPointer.h"

#include <sstream>
#include <string>

class MessageCollector;

/**
 * Keeps messages of readers from the terminal in its scope: VTK's messages, its log, and the output
 * of libraries (MetaIO) to the standard streams.
 */
class QuietReading
{
public:
  QuietReading();
  ~QuietReading();
  QuietReading(const QuietReading&) = delete;
  QuietReading& operator=(const QuietReading&) = delete;

  /**
   * Return whether VTK reported an error, or one of the generic warnings by which its readers
   * report a file that ends too early.
   */
  bool HasErrors() const;

  /**
   * Get the first error without VTK's "ERROR: In FILE, line N" and object name; empty if there is
   * none.
   */
  std::string GetReason() const;

  /**
   * Get the output of libraries to the standard streams.
   */
  std::string GetPrinted() const { return this->Sink.str(); }

private:
  vtkSmartPointer<MessageCollector> Collector;
  vtkSmartPointer<vtkOutputWindow> Window;
  vtkLogger::Verbosity Verbosity;
  std::ostringstream Sink;
  std::streambuf* Cout;
  std::streambuf* Cerr;
};

/**
 * Keeps the output of C libraries from stderr in its scope.
 */
class SilentErrors
{
public:
  SilentErrors();
  ~SilentErrors();
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

private:
  int Saved; // file descriptor
};

#endif
