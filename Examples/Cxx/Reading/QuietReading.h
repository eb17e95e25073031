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
 * While it lives nothing that the readers have to say reaches the terminal: VTK's messages, its
 * log, and what the libraries beneath (MetaIO) write to the standard streams.
 */
class QuietReading
{
public:
  QuietReading();
  ~QuietReading();
  QuietReading(const QuietReading&) = delete;
  QuietReading& operator=(const QuietReading&) = delete;

  /**
   * Whether VTK reported an error, or one of the generic warnings by which its readers report a
   * file that ends too early.
   */
  bool HasErrors() const;

  /**
   * The first error without VTK's "ERROR: In FILE, line N" and object name; empty if there is
   * none.
   */
  std::string GetReason() const;

  /**
   * What libraries have written to the standard streams.
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
 * In its scope nothing that a C library prints reaches stderr.
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
