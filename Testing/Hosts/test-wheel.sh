#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-wheel.sh cvista|VTK_VERSION PYTHON
#
# Makes the wheel (see Module/Python/build-wheel.sh) and tests it as Python users have it, in an environment
# of its own without Debian's VTK. Prints a line for each check; fails if one does. Needs root, to install
# what is missing.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
if (($# != 2)); then
  echo "Usage: test-wheel.sh cvista|VTK_VERSION PYTHON, such as test-wheel.sh 9.6.2 /usr/bin/python3" >&2
  exit 2
fi
vtk_version=$1
python=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_dir=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  cmake ninja-build ccache g++ python3-dev python3-venv xvfb xauth libgl1 libegl1 libgl1-mesa-dri libxrender1 >/dev/null

failures=0
# check WHAT FOUND EXPECTED
check() {
  if [[ $2 == "$3" ]]; then
    echo "ok: $1"
  else
    echo "FAILED: $1: found \"$2\", expected \"$3\""
    failures=$((failures + 1))
  fi
}

# in_venv COMMAND ...: a command of the environment, which has nothing of the caller's Python, and no display.
in_venv() {
  env --unset=PYTHONPATH --unset=LD_LIBRARY_PATH --unset=VTK_AUTOLOAD_PATH --unset=DISPLAY \
    --unset=WAYLAND_DISPLAY "$work/venv/bin/$1" "${@:2}"
}

# drawing COMMAND ...: the same, with a display where VTK needs one.
drawing() {
  if [[ $vtk_version == 9.3.* ]]; then
    xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
      env --unset=PYTHONPATH --unset=LD_LIBRARY_PATH --unset=VTK_AUTOLOAD_PATH "venv/bin/$1" "${@:2}"
  else
    in_venv "$@"
  fi
}

# run COMMAND ...: counts a failure.
run() {
  "$@" || failures=$((failures + 1))
}

SECONDS=0
bash "$source_dir/Module/Python/build-wheel.sh" "$vtk_version" "$python" >build.log 2>&1 || {
  cat build.log
  exit 1
}
wheel=$(echo vtksplattingmip-*.whl)
echo "made $wheel, $(($(stat -c %s "$wheel") / 1024)) KiB, in $SECONDS s"
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
tags=$tag-$tag vtk=vtk==$vtk_version pyvista=pyvista
if [[ $vtk_version == cvista ]]; then
  tags=cp312-abi3 vtk=$(grep -o 'cvista-sdk==[0-9.]*' "$source_dir/Module/Python/pyproject.toml" | sed s/-sdk//)
  pyvista='pyvista[cvista]'
fi
check "the wheel's tags" "${wheel#vtksplattingmip-*-}" \
  "$tags-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl"

"$python" -m venv tools
tools/bin/pip install -q auditwheel mypy
check "auditwheel's platform by symbols" "$(tools/bin/auditwheel show "$wheel" |
  sed -n 's/.*constrains the platform tag to "\(.*\)".*/\1/p')" manylinux_2_27_x86_64

"$python" -m venv venv
in_venv pip install -q "./$wheel" "$pyvista"
check "the wheel brings its VTK" "$(in_venv pip list --format=freeze | grep "^${vtk%%=*}==")" "$vtk"
check "pip finds all requirements met" "$(in_venv pip check)" "No broken requirements found."

echo "PyVista $(in_venv pip list --format=freeze | sed -n 's/^pyvista==//p') draws:"
run drawing python "$here/DrawWithPyVista.py" "$work"
echo "Frames of the example:"
run drawing python "$source_dir/Examples/Python/pyvista_mip.py" --frames 5 --output "$work"
run in_venv python "$source_dir/Examples/Python/numpy_mip.py"
echo "Functions, stubs and threads:"
run in_venv python "$source_dir/Testing/Python/TestFunctions.py"
check "mypy reads the stubs" \
  "$(tools/bin/mypy --python-executable venv/bin/python --follow-imports silent --ignore-missing-imports \
    --disable-error-code override -m vtksplattingmip -m vtksplattingmip.vtkImagingSplattingMIP \
    -m vtksplattingmip.vtkRenderingSplattingMIP 2>&1 | tail -n 1)" \
  "Success: no issues found in 3 source files"
run in_venv python "$here/MeasureThreads.py"

echo "The README's lines:"
programs=(mip PyVista napari)
packages=(napari)
if [[ $vtk_version != cvista ]]; then
  programs+=(vedo trame)
  packages+=(vedo trame trame-vtk)
fi
in_venv pip install -q "${packages[@]}"
run drawing python "$here/RunReadme.py" "$source_dir/README.md" "${programs[@]}"

if [[ $vtk_version != cvista ]]; then
  in_venv pip install -q --no-deps "vtk!=$vtk_version"
  other=$(in_venv pip list --format=freeze | sed -n 's/^vtk==//p')
  folder=$(echo "$work"/venv/lib/python3*/site-packages/vtkmodules)
  check "beside VTK $other it is refused" \
    "$(in_venv python -c 'import vtksplattingmip' 2>&1 | tail -n 1)" \
    "ImportError: vtksplattingmip is built for VTK $vtk_version, but $folder is VTK $other: install \
VTK $vtk_version there, or a vtksplattingmip that is built for VTK $other."
fi

((failures == 0))
