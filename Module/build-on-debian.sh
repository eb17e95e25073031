#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# build-on-debian.sh FOLDER [CMAKE OPTION ...] [--target NAME ...]
#
# Installs what Debian 12 or 13 needs to build and run this project, as far as it is missing (with
# sudo where the caller is not root), then configures it in FOLDER and builds all of it or the targets
# named. The variables CC and CXX choose the compiler, as in CMake.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$1
shift
cmake_options=()
while (($#)) && [[ $1 != --target ]]; do
  cmake_options+=("$1")
  shift
done

compiler=(g++)
[[ ${CXX:-} != *clang* ]] || compiler=(clang libclang-rt-dev) # which has the sanitizers

packages=(
  cmake ninja-build "${compiler[@]}" pkgconf ccache xz-utils
  libvtk9-dev python3-vtk9 libglm-dev          # the module and its Python package
  libcli11-dev                                 # splatmip, with ...
  libvtk-dicom-dev libinsighttoolkit5-dev      # ... the libraries that ...
  libnifti-dev libtiff-dev                     # ... read its files, and what the CMake files ...
  libgdcm-tools                                # ... of GDCM, below them, refer to
  libbenchmark-dev                             # the benchmark
  dpkg-dev file help2man                       # Debian packages
  python3-numpy                                # tests and examples in Python
  xvfb xauth libgl1-mesa-dri                   # OpenGL without a display
)
[[ " ${cmake_options[*]} " == *" -DBUILD_TESTING=OFF "* ]] || packages+=(
  python3-pydicom python3-nibabel              # judge what splatmip reads, as does SimpleITK, ...
  python3-tifffile                             # ... which Debian does not have
  python3-vedo python3-vedo-examples           # programs of others
  openmpi-bin                                  # mpiexec, for several ranks
)
missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Abbrev}' "$package" 2>/dev/null || true)
  [[ $status == ii* ]] || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "Installing ${missing[*]}"
  as_root=()
  ((EUID == 0)) || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  # Slim images leave documentation out, which is where examples are.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends \
    -o Dpkg::Options::='--path-include=/usr/share/doc/*/examples/*' "${missing[@]}" >/dev/null
fi

cmake -S "$source_dir" -B "$build_dir" -G Ninja -Wno-dev \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "${cmake_options[@]}"
cmake --build "$build_dir" "$@"
