// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SafeFiles_h
#define SafeFiles_h

#include <functional>
#include <string>
#include <vector>

/**
 * Ignore the signals that were ignored when the program started, such as SIGHUP under nohup, even
 * if a library handles them. Call it first.
 */
void KeepIgnoredSignals();

/**
 * Refuse names of outputs that cannot be written: folders and devices, files without permission,
 * files in folders without permission. Leaves existing files as they are. Throws
 * std::runtime_error.
 */
void CheckWritable(const std::vector<std::string>& outputs);

/**
 * Refuse outputs that are one of the inputs, by any name or link. Throws std::runtime_error.
 */
void CheckNotInput(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/**
 * Write files completely or not at all. The function gets a temporary name in the folder of each
 * output, with the same ending, and returns whether it has written all of them completely. They
 * replace the outputs only then. Otherwise, and if a signal ends the program, they are removed, and
 * the outputs remain as they were. If one of several cannot be replaced, those before it remain
 * written, and the error says so. Throws std::runtime_error.
 */
void WriteSafely(const std::vector<std::string>& outputs,
  const std::function<bool(const std::vector<std::string>& names)>& write);

#endif
