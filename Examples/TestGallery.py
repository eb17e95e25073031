# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether the commands of README.md draw the pictures that it shows; --write draws them again.

    python3 TestGallery.py PROGRAM [--write]
"""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import vtk
from vtk.util.numpy_support import vtk_to_numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
README = ROOT / "Examples" / "README.md"
MOST_BYTES = 1000000  # of all pictures


def read(path):
    reader = vtk.vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars()).astype(float)
    return image.GetDimensions(), values.reshape(image.GetNumberOfPoints(), -1)


def compress(path):
    """Write a picture again, with as few bytes as there are for the same colours."""
    reader = vtk.vtkPNGReader()
    reader.SetFileName(str(path))
    components = vtk.vtkImageExtractComponents()
    components.SetInputConnection(reader.GetOutputPort())
    values = read(path)[1]
    if (values == values[:, :1]).all():
        components.SetComponents(0)  # gray
    else:
        components.SetComponents(0, 1, 2)
    components.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetInputConnection(components.GetOutputPort())
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(path))
    writer.Write()


def compare(found, expected):
    """What is wrong, or nothing. Lines and letters may be drawn otherwise by another OpenGL, or
    another FreeType; projections are the same bits everywhere."""
    if not expected.is_file():
        return "is not in the gallery"
    (size, one), (other_size, other) = read(found), read(expected)
    if size != other_size:
        return f"has {size} pixels, not {other_size}"
    different = (abs(one - other).max(axis=1) > 8).mean()
    return f"differs in {100 * different:.1f} % of the pixels" if different > 0.01 else ""


def main():
    program, *options = sys.argv[1:]
    text = README.read_text().split("\n## In a browser")[0]
    commands = [shlex.split(line) for block in re.findall(r"```sh\n(.*?)```", text, re.S)
                for line in block.splitlines()]
    shown = set(re.findall(r"\]\(([\w/-]+\.png)\)", text))
    faults = []
    with tempfile.TemporaryDirectory() as scratch:
        for command in commands:
            place = command.index("--output") + 1
            picture = ROOT / command[place]
            drawn = picture if "--write" in options else pathlib.Path(scratch) / picture.name
            command[place] = str(drawn)
            command[0] = {"splatmip": program, "python3": sys.executable}[command[0]]
            result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
            if "--write" in options and result.returncode == 0:
                compress(drawn)
            fault = compare(drawn, picture) if result.returncode == 0 else result.stderr
            faults += [f"{picture.name} {fault}"] * bool(fault)
            shown.discard(str(picture.relative_to(README.parent)))
    faults += [f"{name} has no command" for name in shown]
    there = [*README.parent.glob("*.png"), *README.parent.glob("Gallery/*")]
    if len(there) != len(commands):
        faults.append(f"{len(there)} pictures, {len(commands)} commands")
    if sum(path.stat().st_size for path in there) > MOST_BYTES:
        faults.append("the pictures are larger than a megabyte")
    for fault in faults:
        print("ERROR:", fault)
    print(f"{len(commands)} pictures")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
