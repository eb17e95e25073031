#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-arm64.sh [CTEST OPTION ...]
#
# Compiles the module for 64-bit ARM on Debian 12, runs the core's tests, emulated by QEMU, and compares
# checksums of many projections with those that this machine makes. VTK for ARM is unpacked into a
# folder, not installed: nothing but the tests is emulated. Needs root.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
source "$(dirname "${BASH_SOURCE[0]}")/debian-root.sh"
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build_dir=$source_dir/build/arm64

apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  cmake ninja-build ccache g++ g++-aarch64-linux-gnu qemu-user libvtk9-dev libglm-dev >/dev/null
make_root arm64 bookworm --architectures=arm64 --variant=extract libvtk9-dev libglm-dev libc6-dev

target=$roots/arm64
export QEMU_LD_PREFIX=$target
# VTK's tests ignore the emulator that CMake is told of, but start with what a variable of its own holds.
cmake -S "$source_dir" -B "$build_dir" -G Ninja -Wno-dev \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64 -D_vtk_test_cxx_pre_args=qemu-aarch64 \
  -DCMAKE_SYSROOT="$target" -DCMAKE_FIND_ROOT_PATH="$target" \
  -DCMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu \
  -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY \
  -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY \
  -DSPLATTINGMIP_WRAP_PYTHON=OFF -DSPLATTINGMIP_BUILD_EXAMPLES=OFF
cmake --build "$build_dir" --target SplattingMIPCoreTests splatmip-checksums
SPLATTINGMIP_TEST_SCENES=${SPLATTINGMIP_TEST_SCENES:-2} \
  ctest --test-dir "$build_dir" -j2 --output-on-failure --timeout 3600 -L core "$@"

cmake -S "$source_dir" -B "$build_dir/native" -G Ninja -Wno-dev -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DSPLATTINGMIP_WRAP_PYTHON=OFF -DSPLATTINGMIP_BUILD_EXAMPLES=OFF
cmake --build "$build_dir/native" --target splatmip-checksums
"$build_dir/native/bin/splatmip-checksums" >"$build_dir/checksums-native.txt"
qemu-aarch64 "$build_dir/bin/splatmip-checksums" >"$build_dir/checksums-arm64.txt"
if ! diff "$build_dir"/checksums-{native,arm64}.txt >"$build_dir/checksums.diff"; then
  head "$build_dir/checksums.diff"
  echo "$(grep -c '^>' "$build_dir/checksums.diff") of $(wc -l <"$build_dir/checksums-native.txt")" \
    "checksums differ between this machine and 64-bit ARM." >&2
  exit 1
fi
echo "$(wc -l <"$build_dir/checksums-native.txt") checksums are those of this machine."
