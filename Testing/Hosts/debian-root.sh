# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Functions for scripts that test on another Debian than the machine's: to be sourced. A root is a
# small Debian in a folder of its own, made once by mmdebstrap and kept for the next run. Needs root.

roots=${SPLATTINGMIP_ROOTS:-/var/cache/splattingmip}

# make_root NAME SUITE [--MMDEBSTRAP_OPTION=VALUE ...] PACKAGE ...
#
# Makes $roots/NAME, a Debian SUITE (such as bookworm) with these packages, or with apt alone, unless it
# is there. What it is made of is written down when all is installed: what was interrupted, or is made
# of something else, is made anew.
make_root() {
  local root=$roots/$1 suite=$2 list lock options=(--variant=apt)
  shift 2
  while [[ ${1:-} == --* ]]; do
    options+=("$1")
    shift
  done
  # Mirrors of unstable may be some days old, whose lists apt would refuse as expired, now and in the root.
  [[ $suite != sid ]] || options+=('--aptopt=Acquire::Check-Valid-Until "false"')
  list=$(IFS=,; echo "$suite,${options[*]},$*")
  if ((EUID != 0)); then
    echo "Tests in another Debian need root, for chroot: run them with sudo." >&2
    return 1
  fi
  mkdir -p "$roots"
  exec {lock}>"$root.lock"
  flock "$lock"
  if [[ $(cat "$root/installed-packages" 2>/dev/null || true) != "$list" ]]; then
    if [[ -e $root && ! -e $root/installed-packages && ! -e $root/unfinished ]]; then
      echo "$root holds something else: name another folder in SPLATTINGMIP_ROOTS." >&2
      return 1
    fi
    if ! command -v mmdebstrap >/dev/null; then
      apt-get update -qq
      DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mmdebstrap >/dev/null
    fi
    echo "Making a Debian $suite in $root (some minutes, once)"
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    touch "$root/unfinished"
    # What fails ends here, whether or not the caller has set -e.
    mmdebstrap --quiet --mode=root --format=directory --skip=check/empty \
      --dpkgopt=force-unsafe-io "${options[@]}" ${*:+--include="$(IFS=,; echo "$*")"} "$suite" "$root" &&
      echo "$list" >"$root/installed-packages" && rm "$root/unfinished" || {
      echo "No Debian $suite could be made in $root: see above." >&2
      flock -u "$lock"
      return 1
    }
  fi
  flock -u "$lock"
}

# copy_root FROM TO
#
# Makes $roots/TO a copy of $roots/FROM, whatever it was before.
copy_root() {
  rm -rf --one-file-system "${roots:?}/$2"
  cp -a --reflink=auto "$roots/$1" "$roots/$2"
}

# in_root NAME COMMAND [ARGUMENT ...]
#
# Runs the command in the root, with /proc, /dev and /dev/shm of its own where the kernel lets us: they are
# mounted in a namespace that ends with the command, so that nothing is left mounted.
in_root() {
  local root=$roots/$1
  shift
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  local clean=(env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HWLOC_HIDE_ERRORS=2)
  if unshare --mount --pid --fork true 2>/dev/null; then
    unshare --mount --pid --fork --kill-child bash -c '
      root=$1
      shift
      mount -t proc proc "$root/proc"
      mount --rbind /dev "$root/dev"
      mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
      # Not exec: xvfb-run would wait for ever, as Xvfb tells nothing to a parent that is process 1.
      chroot "$root" "$@"
      exit $?' in_root "$root" "${clean[@]}" "$@"
  else
    chroot "$root" "${clean[@]}" "$@"
  fi
}

# copy_source NAME
#
# Copies this project into the root's folder /splattingmip/source. Files keep their times, so that
# only what changed is built again.
copy_source() {
  local root=$roots/$1 source_dir
  source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
  mkdir -p "$root/splattingmip/source"
  find "$root/splattingmip/source" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  tar -C "$source_dir" -c CMakeLists.txt LICENSE README.md vtk.module Module Rendering Testing Examples |
    tar -C "$root/splattingmip/source" -x
}
