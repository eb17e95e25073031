#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# run-splatmip.sh [ARGUMENT ...]
#
# All that a fresh Debian 12 needs to see a picture: installs, builds, and runs splatmip with the
# arguments given (see run-splatmip.sh --help), on a virtual display where there is none.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$source_dir/build/splatmip
log=$(mktemp)
echo "Building splatmip in $build_dir (some minutes the first time)" >&2
if ! bash "$source_dir/Module/build-on-debian.sh" "$build_dir" \
  -DBUILD_TESTING=OFF -DSPLATTINGMIP_WRAP_PYTHON=OFF >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
rm -f "$log"

display=()
[[ -n ${DISPLAY:-} ]] || display=(xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset")
exec "${display[@]}" "$build_dir/bin/splatmip" "$@"
