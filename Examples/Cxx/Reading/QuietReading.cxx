// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/QuietReading.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

/**
 * Collects VTK's messages instead of showing them.
 */
class MessageCollector : public vtkOutputWindow
{
public:
  static MessageCollector* New();
  vtkTypeMacro(MessageCollector, vtkOutputWindow);

  void DisplayErrorText(const char* text) override { this->Errors.emplace_back(text); }
  void DisplayGenericWarningText(const char* text) override { this->Errors.emplace_back(text); }
  void DisplayWarningText(const char*) override {}
  void DisplayText(const char*) override {}

  std::vector<std::string> Errors;

protected:
  MessageCollector() = default;
  ~MessageCollector() override = default;

private:
  MessageCollector(const MessageCollector&) = delete;
  void operator=(const MessageCollector&) = delete;
};

vtkStandardNewMacro(MessageCollector);

QuietReading::QuietReading()
  : Collector(vtkSmartPointer<MessageCollector>::New()),
    Window(vtkOutputWindow::GetInstance()),
    Verbosity(vtkLogger::GetCurrentVerbosityCutoff()),
    Cout(std::cout.rdbuf(this->Sink.rdbuf())),
    Cerr(std::cerr.rdbuf(this->Sink.rdbuf()))
{
  vtkOutputWindow::SetInstance(this->Collector);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

QuietReading::~QuietReading()
{
  std::cout.rdbuf(this->Cout);
  std::cerr.rdbuf(this->Cerr);
  vtkLogger::SetStderrVerbosity(this->Verbosity);
  vtkOutputWindow::SetInstance(this->Window);
}

bool QuietReading::HasErrors() const
{
  return !this->Collector->Errors.empty();
}

std::string QuietReading::GetReason() const
{
  if (!this->HasErrors())
  {
    return "";
  }
  std::string text = this->Collector->Errors.front();
  std::size_t place = text.find(", line "); // an error may quote another with its place
  for (; place != std::string::npos; place = text.find(", line "))
  {
    text.erase(0, std::min(text.size(), text.find('\n', place)) + 1);
    const std::size_t object = text.find("): ");
    text.erase(0, object < text.find('\n') ? object + 3 : 0);
  }
  return text.substr(0, text.find('\n'));
}

SilentErrors::SilentErrors()
{
  const int nowhere = open("/dev/null", O_WRONLY);
  std::fflush(stderr);
  this->Saved = dup(2);
  dup2(nowhere, 2);
  close(nowhere);
}

SilentErrors::~SilentErrors()
{
  std::fflush(stderr);
  dup2(this->Saved, 2);
  close(this->Saved);
}
