#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# run-tests.sh [-DCMAKE_OPTION=VALUE ...] [CTEST OPTION ...]
#
# The quick tests: all that a fresh Debian 12 or 13 needs to show that the product works. Installs
# what is missing, builds in build/tests, and runs ctest on a virtual display. What takes longer is in
# run-deep-tests.sh; README.md beside this file says how to run a single test.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$source_dir/build/tests
cmake_options=()
while [[ ${1:-} == -D* ]]; do
  cmake_options+=("$1")
  shift
done
bash "$source_dir/Module/build-on-debian.sh" "$build_dir" "${cmake_options[@]}"
# Baselines were rendered without multisampling.
export VTK_TESTING=1
# Without -noreset the server would forget its settings whenever a test closes its last window.
xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
  ctest --test-dir "$build_dir" -j2 --output-on-failure --timeout 600 -LE deep "$@"
