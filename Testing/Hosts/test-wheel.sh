#!/usr/bin/env bash
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
#
# test-wheel.sh VTK_VERSION PYTHON
#
# Builds the wheel for a VTK from PyPI and tests it as a user of PyVista has it, in an environment of its own
# that knows nothing of Debian's VTK. Prints a line for each check; fails if one does. Needs root, to
# install what is missing.
set -euo pipefail

((EUID == 0)) || exec sudo bash "${BASH_SOURCE[0]}" "$@"
if (($# != 2)); then
  echo "Usage: test-wheel.sh VTK_VERSION PYTHON, such as test-wheel.sh 9.3.0 /usr/bin/python3" >&2
  exit 2
fi
vtk_version=$1
python=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

apt-get update -qq
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  cmake ninja-build ccache g++ libglm-dev libglew-dev python3-dev python3-venv \
  xvfb xauth libgl1 libgl1-mesa-dri libxrender1 >/dev/null

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

# in_venv COMMAND ...: a command of the environment, which sees nothing of the caller's Python.
in_venv() {
  env --unset=PYTHONPATH --unset=LD_LIBRARY_PATH --unset=VTK_AUTOLOAD_PATH "$work/venv/bin/$1" "${@:2}"
}

bash "$here/../../Module/Python/build-wheel.sh" "$vtk_version" "$python" >build.log 2>&1 || {
  cat build.log
  exit 1
}
wheel=$(echo vtksplattingmip-*.whl)
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
check "the wheel is for this Python only" "${wheel#vtksplattingmip-*-}" "$tag-$tag-linux_x86_64.whl"

"$python" -m venv venv
in_venv pip install -q "./$wheel" pyvista
check "the wheel brings its VTK" "$(in_venv pip list --format=freeze | grep ^vtk==)" "vtk==$vtk_version"
check "pip finds all requirements met" "$(in_venv pip check)" "No broken requirements found."

echo "PyVista $(in_venv pip list --format=freeze | sed -n 's/^pyvista==//p') draws:"
xvfb-run -a --server-args "-screen 0 1280x1024x24 -noreset" \
  env --unset=PYTHONPATH --unset=LD_LIBRARY_PATH --unset=VTK_AUTOLOAD_PATH \
  venv/bin/python "$here/DrawWithPyVista.py" "$work" || failures=$((failures + 1))

in_venv pip install -q --no-deps "vtk!=$vtk_version"
other=$(in_venv pip list --format=freeze | sed -n 's/^vtk==//p')
folder=$(echo "$work"/venv/lib/python3*/site-packages/vtkmodules)
check "beside VTK $other it is refused" \
  "$(in_venv python -c 'import vtksplattingmip' 2>&1 | tail -n 1)" \
  "ImportError: vtksplattingmip is built for VTK $vtk_version, but $folder is VTK $other: install \
VTK $vtk_version there, or a vtksplattingmip that is built for VTK $other."

((failures == 0))
