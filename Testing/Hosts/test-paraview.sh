#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-paraview.sh SUITE [-DCMAKE_OPTION=VALUE ...] [CTEST OPTION ...]
#
# Builds ParaView's plugin in a Debian SUITE (bookworm: ParaView 5.11, trixie: 5.13) and runs its tests
# on a virtual display. Debian's packages for development with VTK and with ParaView exclude each
# other, so both happen in a root of its own, which is used again the next time. Needs root (sudo,
# where the caller is not) for chroot.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
source "$(dirname "${BASH_SOURCE[0]}")/debian-root.sh"
suite=$1
shift
cmake_options=()
while [[ ${1:-} == -D* ]]; do
  cmake_options+=("$1")
  shift
done

# The libraries at the end are those that ParaView's CMake package asks for.
packages=(
  paraview-dev python3-paraview
  cmake ninja-build g++ ccache libglm-dev
  xvfb xauth libgl1-mesa-dri
  libdouble-conversion-dev libfreetype-dev libglew-dev libjpeg-dev liblz4-dev liblzma-dev
  libopenmpi-dev libpng-dev libpython3-dev libtiff-dev libutfcpp-dev
)
# That of ParaView 5.11 does without these.
[[ $suite == bookworm ]] || packages+=(libhdf5-dev libnetcdf-dev libxml2-dev)
root=paraview-$suite
make_root "$root" "$suite" "${packages[@]}"
copy_source "$root"
# In Debian 13 ParaView's CMake package asks for Python modules by names that they do not have.
in_root "$root" find /usr/lib/python3/dist-packages -name "*.cpython-*-linux-gnu.so" -exec bash -c \
  'for file; do ln -sf "${file##*/}" "${file%%.cpython-*}.so"; done' names {} +
in_root "$root" cmake -S /splattingmip/source -B /splattingmip/build -G Ninja -Wno-dev \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DSPLATTINGMIP_BUILD_PARAVIEW_PLUGIN=ON \
  "${cmake_options[@]}"
in_root "$root" cmake --build /splattingmip/build
in_root "$root" env VTK_TESTING=1 xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
  ctest --test-dir /splattingmip/build -j2 --output-on-failure --timeout 300 "$@"
