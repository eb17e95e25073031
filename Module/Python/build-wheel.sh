#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# build-wheel.sh VTK_VERSION PYTHON
#
# Makes the wheel of the package vtksplattingmip for one version of VTK from PyPI and one Python, such
# as build-wheel.sh 9.3.0 /usr/bin/python3, and puts it into the current folder. VTK's wheel has
# libraries, but neither headers nor CMake files: those come from Debian's package of the same version,
# which is unpacked in a temporary folder. So it takes a version that Debian 13 or Debian sid has.
#
# Needs Debian, with cmake, ninja-build, ccache, g++, libglm-dev and libglew-dev, and the headers and
# the module venv of the Python (python3-dev and python3-venv). Needs no root.
set -euo pipefail

if (($# != 2)); then
  echo "Usage: build-wheel.sh VTK_VERSION PYTHON, such as build-wheel.sh 9.3.0 /usr/bin/python3" >&2
  exit 2
fi
vtk_version=$1
python=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
series=${vtk_version%.*} # 9.3 of 9.3.0
multiarch=$(gcc -print-multiarch)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# apt_of_others TOOL ARGUMENT ...
#
# Runs one of apt's tools with the Debians whose VTK is wanted, instead of the machine's own.
apt_of_others() {
  local tool=$1 apt=$work/apt
  shift
  "$tool" -o "Dir::Etc::SourceList=$apt/sources.list" -o Dir::Etc::SourceParts=- -o "Dir::State=$apt" \
    -o Dir::State::Status=/dev/null -o "Dir::Cache=$apt" -o APT::Sandbox::User= "$@"
}

# Unpacks headers, CMake package and wrapping tools of this VTK into $work/debian, and the tools' libc.
unpack_debian() {
  local line suite package
  mkdir -p "$work/apt/lists/partial" "$work/apt/archives/partial" "$work/debian"
  printf 'deb http://deb.debian.org/debian %s main\n' trixie sid >"$work/apt/sources.list"
  apt_of_others apt-get update -qq
  line=$(apt_of_others apt-cache madison libvtk9-dev | grep -E "\| ${vtk_version//./\\.}[+-]" || true)
  if [[ -z $line ]]; then
    echo "Neither Debian 13 nor sid has headers of VTK $vtk_version: choose a version that one has." >&2
    apt_of_others apt-cache madison libvtk9-dev >&2
    return 1
  fi
  suite=$(sed -E 's:.* ([a-z]+)/main .*:\1:' <<<"$line")
  (cd "$work/apt" && apt_of_others apt-get download -qq \
    {libvtk9-dev,vtk9,python3-vtk9,"libvtk$series",libc6}"/$suite")
  for package in "$work"/apt/*.deb; do
    dpkg-deb -x "$package" "$work/debian"
  done
}

# Unpacks VTK's wheel for this Python into $work/wheel.
unpack_wheel() {
  "$python" -m venv "$work/venv"
  "$work/venv/bin/pip" download -q --no-deps --only-binary :all: -d "$work" "vtk==$vtk_version"
  "$python" -m zipfile -e "$work"/vtk-*.whl "$work/wheel"
}

# The tools run with the libc that they were built for.
make_tools() {
  local tool lib=$work/debian/usr/lib/$multiarch
  mkdir "$work/tools"
  for tool in WrapHierarchy WrapPython WrapPythonInit; do
    printf '#!/bin/sh\nexec "%s" --library-path "%s" "%s" "$@"\n' \
      "$lib/ld-linux-x86-64.so.2" "$lib" "$work/debian/usr/bin/vtk$tool-$series" >"$work/tools/$tool"
    chmod +x "$work/tools/$tool"
  done
}

# Debian's VTK has threads by TBB, the wheel its own, and headers bring that into what includes them.
configure_headers() {
  sed -i -E -e 's/(_(ENABLE|IMPLEMENTATION)_TBB) 1/\1 0/' \
    -e 's/(_(ENABLE|IMPLEMENTATION)_STDTHREAD) 0/\1 1/' \
    -e 's/VTK_SMP_TBB/VTK_SMP_STDThread/' -e 's/"TBB"/"STDThread"/' \
    "$work/debian/usr/include/vtk-$series/vtkSMP.h"
}

# Makes the CMake package describe the wheel, which has VTK's libraries and those that Debian's VTK takes
# from other packages.
configure_cmake_package() {
  local package=$work/debian/usr/lib/$multiarch/cmake/vtk-$series
  rm "$package"/VTK*-targets-*.cmake
  # Says which headers of other packages to compile with, in words that older CMakes do not know.
  sed -i 's/\\\$<COMPILE_ONLY:[^>]*>//g' "$package/VTK-targets.cmake"
  cp "$here/Wheel/VTK-targets-wheel.cmake" "$package"
  echo 'find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(Threads REQUIRED)' >"$package/VTK-vtk-module-find-packages.cmake"
}

# Builds in $work/build, with the C++ library's ABI that the wheel was built with.
build() {
  local abi=0 path="'\$ORIGIN:\$ORIGIN/../vtkmodules'"
  if nm -D "$work"/wheel/vtkmodules/libvtkCommonCore*.so | grep -q __cxx11; then
    abi=1
  fi
  # Lets ccache know the same files in another temporary folder.
  CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1
  export CCACHE_BASEDIR CCACHE_NOHASHDIR
  cmake -S "$here/../.." -B "$work/build" -G Ninja -Wno-dev -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    "-DVTK_DIR=$work/debian/usr/lib/$multiarch/cmake/vtk-$series" \
    "-DSPLATTINGMIP_VTK_WHEEL=$work/wheel" "-DSPLATTINGMIP_VTK_TOOLS=$work/tools" \
    "-DPython3_EXECUTABLE=$work/venv/bin/python" \
    "-DCMAKE_CXX_FLAGS=-D_GLIBCXX_USE_CXX11_ABI=$abi" \
    -DCMAKE_SKIP_RPATH=ON -DCMAKE_PLATFORM_NO_VERSIONED_SONAME=ON \
    "-DCMAKE_SHARED_LINKER_FLAGS=-s -Wl,--as-needed,--no-undefined,-rpath,$path" \
    "-DCMAKE_MODULE_LINKER_FLAGS=-s -Wl,--as-needed,-rpath,$path" \
    -DBUILD_TESTING=OFF -DSPLATTINGMIP_BUILD_EXAMPLES=OFF
  cmake --build "$work/build"
}

# Packs what was built as a wheel that depends on exactly this VTK.
pack() {
  local package=$work/package/vtksplattingmip
  mkdir -p "$package"
  cp "$here/Wheel/setup.py" "$here/../../LICENSE" "$work/package"
  cp "$work"/build/lib*/libvtk*SplattingMIP.so "$work"/build/lib*/python3*/*/vtksplattingmip/* "$package"
  VTK_VERSION=$vtk_version "$work/venv/bin/pip" wheel -q --no-deps --use-pep517 -w "$work/out" "$work/package"
  cp "$work"/out/*.whl .
  echo "Made $(basename "$work"/out/*.whl)"
}

unpack_debian
unpack_wheel
make_tools
configure_headers
configure_cmake_package
build
pack
