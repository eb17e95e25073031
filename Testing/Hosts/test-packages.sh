#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-packages.sh SUITE
#
# Makes the Debian packages in a root with that Debian (bookworm or trixie), then installs, uses and
# purges them in copies of a bare one. Prints a line for each check, and fails if one does. Needs root.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/debian-root.sh"
suite=${1:?"say which Debian: test-packages.sh bookworm, or trixie"}
build=build-$suite
bare=clean-$suite
clean=clean-$suite-copy
build_packages=(
  cmake ninja-build g++ ccache pkgconf xz-utils libvtk9-dev python3-vtk9 libglm-dev libcli11-dev
  libvtk-dicom-dev libinsighttoolkit5-dev libnifti-dev libtiff-dev libgdcm-tools dpkg-dev file
  help2man lintian)
# What the tests use, and the packages need not bring.
display=(xvfb xauth libgl1-mesa-dri)
compiler=(cmake make g++)
log=$(mktemp)
trap 'rm -rf --one-file-system "$log"* "${roots:?}/$clean"' EXIT
failures=0

# check WHAT COMMAND [ARGUMENT ...]
check() {
  local what=$1
  shift
  if "$@" >"$log" 2>&1; then
    echo "ok      $what"
  else
    echo "FAILED  $what"
    tail -n 30 "$log" | sed 's/^/        /'
    failures=$((failures + 1))
  fi
}

make_packages() {
  copy_source "$build" &&
    rm -rf "$roots/$build/splattingmip/packages" &&
    in_root "$build" bash -c '
      set -e
      cmake -S /splattingmip/source -B /splattingmip/build -G Ninja -Wno-dev \
        -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DBUILD_TESTING=OFF -DSPLATTINGMIP_BUILD_PACKAGES=ON
      nice -n 5 cmake --build /splattingmip/build
      cpack --config /splattingmip/build/CPackConfig.cmake -B /splattingmip/packages'
}

# What uses the library depends on that very version of it.
belong_together() {
  in_root "$build" bash -c '
    set -euo pipefail
    cd /splattingmip/packages
    version=$(dpkg-deb -f "$1"_*.deb Version)
    for package in "${@:2}"; do
      dpkg-deb -f "$package"_*.deb Depends | tee /dev/stderr | grep -qF "$1 (= $version)"
    done' belong_together "${packages[@]}"
}

make_clean_root() {
  copy_root "$bare" "$clean"
  mkdir -p "$roots/$clean/splattingmip"
  cp -r "$here/../Package" "$roots/$clean/splattingmip/tests"
  mkdir "$roots/$clean/splattingmip/packages"
  cp "$roots/$build/splattingmip/packages"/*.deb "$roots/$clean/splattingmip/packages"
}

# apt_install [OPTION ...] PACKAGE ..., with wildcards
apt_install() {
  in_root "$clean" bash -c "cd /splattingmip/packages &&
    DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $*"
}

# Runs in the clean root, with a display.
with_display() {
  in_root "$clean" xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" "$@"
}

has_version() {
  in_root "$clean" splatmip --version && in_root "$clean" splatmip --version | grep -q "^splatmip $version,"
}

# The man page names each option that --help names.
has_man_page() {
  in_root "$clean" bash -c '
    set -euo pipefail
    page=$(zcat /usr/share/man/man1/splatmip.1.gz | sed "s/\\\\-/-/g")
    options=$(splatmip --help | grep -o -- "^ *--[a-z-]*\|,--[a-z-]*" | tr -d " ,")
    [[ $(wc -l <<<"$options") -gt 10 ]]
    for option in $options; do
      grep -q -- "$option" <<<"$page" || { echo "no $option"; exit 1; }
    done'
}

turns() {
  in_root "$clean" bash -c '
    set -e
    splatmip --rotate 4 --size 64x96 --out /splattingmip/turn.ogv
    head -c 4 /splattingmip/turn.ogv | grep -q "^OggS$"
    rm /splattingmip/turn.*'
}

draws_picture() {
  in_root "$clean" splatmip --size 64x96 --output /splattingmip/picture.png &&
    head -c 4 "$roots/$clean/splattingmip/picture.png" | grep -q PNG
}

# A wavelet has 276 in the middle, and less at the rim.
python_projects() {
  in_root "$clean" /usr/bin/python3 -c '
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtksplattingmip import vtkSplattingMIPProjection
source = vtkRTAnalyticSource()
projection = vtkSplattingMIPProjection()
projection.SetInputConnection(source.GetOutputPort())
projection.Update()
low, high = projection.GetOutput().GetScalarRange()
print(low, high)
assert low < 200 and 250 < high < 277'
}

python_draws() {
  with_display env PYTHONPATH=/splattingmip/tests/Autoload /usr/bin/python3 -c '
from script import picture
from vtksplattingmip import vtkSplattingMIPVolumeMapper
mapper = vtkSplattingMIPVolumeMapper()
assert max(picture(mapper, mapper.MAXIMUM_INTENSITY_BLEND)) > 200
assert mapper.GetNumberOfProjections() == 1'
}

# A script that knows nothing of this project.
loads_into_programs() {
  with_display env VTK_AUTOLOAD_PATH="$autoload" SPLATTINGMIP_LOG=/splattingmip/log \
    /usr/bin/python3 /splattingmip/tests/Autoload/script.py 1 /splattingmip/pixels &&
    grep "renders by vtkSplattingMIPVolumeMapper" "$roots/$clean/splattingmip/log"
}

consumer_draws() {
  in_root "$clean" cmake -S /splattingmip/tests/Consumer -B /splattingmip/consumer-build &&
    in_root "$clean" cmake --build /splattingmip/consumer-build &&
    with_display /splattingmip/consumer-build/consumer
}

# What apt would bring along with our packages.
others() {
  apt_install --simulate './*.deb' | sed -n 's/^Inst \([^ ]*\) .*/\1/p' | grep -vxF "$(printf '%s\n' "${packages[@]}")" |
    tr '\n' ' '
}

# The names of installed packages, and all files but the tests' own, what apt remembers, and logs.
contents() {
  {
    in_root "$clean" dpkg-query -W -f '${db:Status-Abbrev} ${binary:Package}\n'
    in_root "$clean" find / -xdev \( -path /splattingmip -o -path /proc -o -path /sys -o -path /dev \
      -o -path /tmp -o -path /run -o -path /root -o -path /var/log -o -path /var/lib/apt \
      -o -path /var/cache/apt \) -prune -o -print
  } | sort
}

leaves_nothing() {
  in_root "$clean" apt-get purge -y "${packages[@]}" || return 1
  contents | diff "$log.before" -
}

make_root "$build" "$suite" "${build_packages[@]}"
make_root "$bare" "$suite"
check "packages are made" make_packages
((failures == 0)) || exit 1
version=$(sed -n 's/^  VERSION //p' "$here/../../CMakeLists.txt")
library=libvtksplattingmip${version%.*}
packages=("$library" libvtksplattingmip-dev python3-vtksplattingmip splatmip)
autoload=/usr/lib/x86_64-linux-gnu/splattingmip-${version%.*}/autoload
check "they belong together" belong_together
check "lintian finds no error" in_root "$build" \
  bash -c 'lintian --allow-root --fail-on error /splattingmip/packages/*.deb'
grep '^W:' "$log" | sed 's/^/        /' || true
in_root "$bare" apt-get update -qq

make_clean_root
check "splatmip can be installed alone" apt_install "./splatmip_*.deb ./${library}_*.deb"
check "splatmip draws without a display" draws_picture
check "splatmip writes turns without a display" turns

make_clean_root
check "python3-vtksplattingmip can be installed alone" \
  apt_install "./python3-vtksplattingmip_*.deb ./${library}_*.deb"
check "Python projects without a display" python_projects
apt_install "${display[*]}" >/dev/null
check "Python draws" python_draws

# All others first, for a list of files without ours.
make_clean_root
apt_install "$(others) ${display[*]} ${compiler[*]}" >/dev/null
contents >"$log.before"
check "apt install ./*.deb" apt_install './*.deb'
check "splatmip --version" has_version
check "man splatmip names all options" has_man_page
check "import vtksplattingmip" in_root "$clean" /usr/bin/python3 -c 'import vtksplattingmip'
check "find_package(SplattingMIP): a program is built, and draws" consumer_draws
check "VTK_AUTOLOAD_PATH: a script splats that knows nothing of it" loads_into_programs
check "purging leaves no file" leaves_nothing

echo "$failures checks failed"
((failures == 0))
