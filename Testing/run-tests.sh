#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# run-tests.sh [CTEST OPTION ...]
#
# All that a fresh Debian 12 needs to run every test: installs, builds with warnings as errors, and
# runs ctest on a virtual display; then the same for ParaView's plugin in a Debian of its own.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$source_dir/build/tests
vtk_tests=$source_dir/build/vtk-tests
bash "$source_dir/Module/build-on-debian.sh" "$build_dir" \
  -DSPLATTINGMIP_STRICT=ON -DSPLATTINGMIP_BUILD_BENCHMARK=ON "-DSPLATTINGMIP_VTK_TESTS=$vtk_tests"
bash "$source_dir/Testing/Package/VTKsOwn/fetch-on-debian.sh" "$vtk_tests"
# The tests compare with pictures that were rendered without multisampling.
export VTK_TESTING=1
# Without -noreset the server would forget its settings whenever a test closes its last window.
xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
  ctest --test-dir "$build_dir" -j2 --output-on-failure --timeout 600 "$@"
exec bash "$source_dir/Module/ParaView/test-on-debian.sh" "$@"
