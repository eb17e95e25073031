#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-on-debian.sh [--root FOLDER] [CTEST OPTION ...]
#
# All that a fresh Debian 12 needs to build ParaView's plugin, with warnings as errors, and to run
# its tests on a virtual display. Debian's packages for development with VTK and with ParaView
# exclude each other, so both happen in a small Debian of their own in FOLDER, by default
# /var/cache/splattingmip-paraview, which is used again the next time. Needs root (sudo, where the
# caller is not) for chroot; mounts nothing.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
root=/var/cache/splattingmip-paraview
if [[ ${1:-} == --root ]]; then
  root=$(realpath -m "$2")
  shift 2
fi

# The libraries at the end are those that ParaView's CMake package asks for.
packages=(
  paraview-dev python3-paraview
  cmake ninja-build g++ ccache libglm-dev
  xvfb xauth libgl1-mesa-dri
  libdouble-conversion-dev libfreetype-dev libglew-dev libjpeg-dev liblz4-dev liblzma-dev
  libopenmpi-dev libpng-dev libpython3-dev libtiff-dev libutfcpp-dev libxml2-dev
)
list=$(IFS=,; echo "${packages[*]}")

mkdir -p "$(dirname "$root")"
exec {lock}>"$root.lock"
flock "$lock"
# The list is written when all is installed: what was interrupted, or has other packages, is made anew.
if [[ $(cat "$root/installed-packages" 2>/dev/null || true) != "$list" ]]; then
  if [[ -e $root && -n $(ls -A "$root") && ! -e $root/installed-packages && ! -e $root/unfinished ]]; then
    echo "$root holds something else: choose another folder." >&2
    exit 1
  fi
  if ! command -v mmdebstrap >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mmdebstrap >/dev/null
  fi
  echo "Installing ParaView in $root (some minutes, once)"
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  touch "$root/unfinished"
  mmdebstrap --quiet --mode=root --format=directory --variant=apt --skip=check/empty \
    --dpkgopt=force-unsafe-io \
    --include="$list" bookworm "$root"
  echo "$list" >"$root/installed-packages"
  rm "$root/unfinished"
fi

# A copy of what the plugin is made of; files keep their times, so that only what changed is built.
rm -rf "$root/splattingmip/source"
mkdir -p "$root/splattingmip/source"
tar -C "$source_dir" -c CMakeLists.txt LICENSE Rendering Module/ParaView \
  Testing/ParaView Testing/Data | tar -C "$root/splattingmip/source" -x

in_root() {
  env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 VTK_TESTING=1 \
    HWLOC_HIDE_ERRORS=2 chroot "$root" "$@"
}
in_root cmake -S /splattingmip/source -B /splattingmip/build -G Ninja -Wno-dev \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DSPLATTINGMIP_BUILD_PARAVIEW_PLUGIN=ON -DSPLATTINGMIP_STRICT=ON
in_root cmake --build /splattingmip/build
in_root xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
  ctest --test-dir /splattingmip/build -j2 --output-on-failure --timeout 300 "$@"
