#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# run-deep-tests.sh PART ...
#
# The deep tests, part by part, on Debian 12; each says how long it took. Parts that need another
# Debian make one in /var/cache/splattingmip (or in SPLATTINGMIP_ROOTS) and need root.
#
#   more              what the quick tests leave out: builds of others that take in the module, VTK's
#                     own tests, short runs of the benchmark and of the paper's experiments, the
#                     viewer in a browser
#   scenes            four times as many random scenes as the quick tests
#   seeds             random tests with ten new numbers, which it prints
#   walk              10,000 random walks of mapper and filter, with ten new numbers
#   sanitizers        the address and undefined behaviour sanitizers
#   threads           the thread sanitizer, with VTK's STDThread backend
#   clang             the quick tests, built by Clang; warnings are errors
#   static            the quick tests of a static build
#   debian13          the quick tests on Debian 13 (VTK 9.3, GCC 14); warnings are errors
#   debian13-clang    the same, built by Clang
#   sid               the quick tests on Debian's unstable (VTK 9.6)
#   arm64             the core's tests on 64-bit ARM, emulated
#   paraview          the plugin in ParaView 5.11 (Debian 12); warnings are errors
#   paraview-debian13 the plugin in ParaView 5.13 (Debian 13)
#   remote            VTK 9.1's own build, which fetches the module as a remote module
#   packages          Debian packages, on Debian 12 and 13
#   wheel             wheels for vtk 9.3.0 and 9.6.2 of PyPI and for cvista, for each Python 3.11 to 3.13 that is there
set -euo pipefail

testing_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_dir=$(dirname "$testing_dir")
build_dir=$source_dir/build
source "$testing_dir/Hosts/debian-root.sh"
strict=-DCMAKE_COMPILE_WARNING_AS_ERROR=ON

# build FOLDER [CMAKE OPTION ...] [--target NAME ...]
build() {
  bash "$source_dir/Module/build-on-debian.sh" "$build_dir/$1" "${@:2}"
}

# run_tests FOLDER [CTEST OPTION ...]
run_tests() {
  VTK_TESTING=1 xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
    ctest --test-dir "$build_dir/$1" -j2 --output-on-failure --timeout 1200 "${@:2}"
}

part_more() {
  if ! command -v chromedriver >/dev/null || ! /usr/bin/python3 -c "import selenium" 2>/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      chromium-driver python3-selenium >/dev/null
  fi
  bash "$testing_dir/Hosts/fetch-vtk.sh" "$build_dir/vtk"
  build tests -DSPLATTINGMIP_BUILD_BENCHMARK=ON "-DSPLATTINGMIP_VTK_SOURCE=$build_dir/vtk"
  run_tests tests -L deep
}

part_scenes() {
  build tests
  SPLATTINGMIP_TEST_SCENES=100 run_tests tests -L 'core|render'
}

# with_new_seeds COMMAND: ten times, each with other random numbers
with_new_seeds() {
  local -x SPLATTINGMIP_TEST_SEED
  for _ in {1..10}; do
    SPLATTINGMIP_TEST_SEED=$((RANDOM * 32768 + RANDOM))
    echo "SPLATTINGMIP_TEST_SEED=$SPLATTINGMIP_TEST_SEED"
    "$@"
  done
}

part_seeds() {
  build tests
  with_new_seeds run_tests tests -L 'core|render'
}

part_walk() {
  build tests
  # 125 % of 800 walks, ten times.
  SPLATTINGMIP_TEST_SCENES=125 with_new_seeds run_tests tests -V -R TestWalk
}

# build_sanitized FOLDER SANITIZERS TARGET ...
#
# By Clang, which takes half the time that GCC takes for this. Optimised fully, templates would take
# minutes; with assertions, VTK's test driver would trap floating-point exceptions in the OpenGL driver.
build_sanitized() {
  CC=clang CXX=clang++ build "$1" "-DSPLATTINGMIP_SANITIZE=$2" \
    "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG" \
    -DSPLATTINGMIP_WRAP_PYTHON=OFF -DSPLATTINGMIP_BUILD_EXAMPLES=OFF --target "${@:3}"
}

part_sanitizers() {
  build_sanitized sanitizers address,undefined SplattingMIPCoreTests vtkImagingSplattingMIPCxxTests \
    SplattingMIPMapperTests
  # Where there is no memory for an output, it is asked for in vain.
  local -x ASAN_OPTIONS=allocator_may_return_null=1
  local -x SPLATTINGMIP_TEST_SCENES=5
  run_tests sanitizers -L core
  # The OpenGL driver's own leaks cannot be told apart once it is unloaded.
  ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0 run_tests sanitizers -L render
}

part_threads() {
  build_sanitized threads thread SplattingMIPCoreTests vtkImagingSplattingMIPCxxTests
  local -x TSAN_OPTIONS="halt_on_error=1 allocator_may_return_null=1"
  TSAN_OPTIONS+=" suppressions=$testing_dir/thread-sanitizer.txt"
  local -x SPLATTINGMIP_TEST_SCENES=5
  local -x VTK_SMP_BACKEND_IN_USE=STDThread VTK_SMP_MAX_THREADS=4
  run_tests threads -L core
  run_tests threads -R ImagingSplattingMIPCxx
}

part_clang() {
  CC=clang CXX=clang++ build clang "$strict"
  run_tests clang -LE deep
}

part_static() {
  build static -DBUILD_SHARED_LIBS=OFF -DSPLATTINGMIP_WRAP_PYTHON=OFF
  run_tests static -LE deep
}

# quick_tests_in ROOT SUITE [VARIABLE=VALUE ...] [-- -DCMAKE_OPTION=VALUE ...]
quick_tests_in() {
  local root=$1 suite=$2 variables=()
  shift 2
  while (($#)) && [[ $1 != -- ]]; do
    variables+=("$1")
    shift
  done
  make_root "$root" "$suite" ca-certificates
  copy_source "$root"
  in_root "$root" env "${variables[@]}" bash /splattingmip/source/Testing/run-tests.sh "${@:2}"
}

part_debian13() {
  quick_tests_in debian13 trixie -- "$strict"
}

part_debian13-clang() {
  quick_tests_in debian13-clang trixie CC=clang CXX=clang++ -- "$strict"
}

part_sid() {
  quick_tests_in sid sid
}

part_arm64() {
  bash "$testing_dir/Hosts/test-arm64.sh"
}

part_paraview() {
  bash "$testing_dir/Hosts/test-paraview.sh" bookworm "$strict"
}

part_paraview-debian13() {
  bash "$testing_dir/Hosts/test-paraview.sh" trixie
}

part_remote() {
  bash "$testing_dir/Hosts/test-remote.sh" bookworm
}

part_packages() {
  bash "$testing_dir/Hosts/test-packages.sh" bookworm
  bash "$testing_dir/Hosts/test-packages.sh" trixie
}

part_wheel() {
  local python
  for python in /usr/bin/python3 python3.12 python3.13; do
    if ! "$python" --version; then
      echo "Skipped: there is no $python"
      continue
    fi
    [[ $python == /usr/bin/python3 ]] || bash "$testing_dir/Hosts/test-wheel.sh" cvista "$python"
    [[ $python == python3.13 ]] || bash "$testing_dir/Hosts/test-wheel.sh" 9.3.0 "$python" # PyPI has none for 3.13
    bash "$testing_dir/Hosts/test-wheel.sh" 9.6.2 "$python"
  done
}

if (($# == 0)); then
  sed -n '/^# run-deep/,/^set -euo/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
  exit 2
fi
for part in "$@"; do
  if ! declare -F "part_$part" >/dev/null; then
    echo "There is no part $part; without arguments this script lists them." >&2
    exit 2
  fi
done
for part in "$@"; do
  echo "=== $part"
  SECONDS=0
  # In a shell of its own: what a part sets ends with it, and a failure ends all.
  (set -e; "part_$part")
  echo "=== $part passed in $((SECONDS / 60)) min $((SECONDS % 60)) s"
done
