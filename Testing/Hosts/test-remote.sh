#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-remote.sh SUITE
#
# VTK's own build fetches the module by Module/SplattingMIP.remote.cmake and builds both libraries, with
# the sources of VTK of a Debian SUITE (bookworm: VTK 9.1), in a root that has no other VTK. Then a
# program renders with them. The root is used again the next time. Needs root (sudo, where the caller
# is not) for chroot.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
source "$(dirname "${BASH_SOURCE[0]}")/debian-root.sh"
suite=$1

# Debian's sources of VTK lack what comes as a library from these packages.
external=(doubleconversion expat glew lz4 lzma utf8 zlib)
packages=(
  ca-certificates cmake g++ ccache git ninja-build xz-utils libglm-dev
  libdouble-conversion-dev libexpat1-dev libglew-dev liblz4-dev liblzma-dev libutfcpp-dev zlib1g-dev
  libx11-dev libxcursor-dev xvfb xauth libgl1-mesa-dri
)
root=remote-$suite
make_root "$root" "$suite" "${packages[@]}"
copy_source "$root"

source=/splattingmip/source
vtk=/splattingmip/vtk
build=/splattingmip/build
in_root "$root" bash "$source/Testing/Hosts/fetch-vtk.sh" "$vtk"
in_root "$root" cp "$source/Module/SplattingMIP.remote.cmake" "$vtk/Remote/"

# A repository with the source as it is, committed or not.
git=(git "--git-dir=/splattingmip/repository" "--work-tree=$source")
in_root "$root" "${git[@]}" init --quiet
in_root "$root" "${git[@]}" -C "$source" add --all
in_root "$root" "${git[@]}" -c user.name=test -c user.email=test@splattingmip.invalid \
  commit --quiet --allow-empty --message "The source to test"
commit=$(in_root "$root" "${git[@]}" rev-parse HEAD)

launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
external=("${external[@]/#/-DVTK_MODULE_USE_EXTERNAL_VTK_}")
configure_vtk() {
  # Not optimised: one short program runs.
  in_root "$root" cmake -S "$vtk" -B "$build/vtk" -G Ninja -Wno-dev "${launcher[@]}" \
    -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG" "${external[@]/%/=ON}" \
    -DVTK_GROUP_ENABLE_StandAlone=DONT_WANT -DVTK_GROUP_ENABLE_Rendering=DONT_WANT \
    -DVTK_ENABLE_WRAPPING=OFF -DVTK_ENABLE_REMOTE_MODULES=ON \
    -DVTK_MODULE_ENABLE_VTK_RenderingSplattingMIP=YES "$@"
}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if configure_vtk -DSPLATTINGMIP_GIT_REPOSITORY= >"$log" 2>&1; then
  echo "VTK was configured with the module, but without a repository." >&2
  exit 1
fi
grep "There is no repository to fetch VTK::RenderingSplattingMIP from" "$log"
configure_vtk -DSPLATTINGMIP_GIT_REPOSITORY=/splattingmip/repository "-DSPLATTINGMIP_GIT_TAG=$commit"
# 1500 files: ccache is not to run the preprocessor first.
in_root "$root" env CCACHE_DEPEND=1 cmake --build "$build/vtk" -j "$(nproc)" \
  --target ImagingSplattingMIP RenderingSplattingMIP RenderingVolumeOpenGL2

in_root "$root" cmake -S "$source/Testing/Package/Remote" -B "$build/consumer" -G Ninja \
  "${launcher[@]}" "-DCMAKE_PREFIX_PATH=$build/vtk"
in_root "$root" cmake --build "$build/consumer"
in_root "$root" xvfb-run -a "$build/consumer/consumer"
