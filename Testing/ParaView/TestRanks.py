# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Several ranks show the picture of one, through ParaView's compositor.

One rank writes the volume and its pictures; `mpiexec -n N pvbatch [--symmetric]`, or the client of a
`mpiexec -n N pvserver` (N in the variable SPLATTINGMIP_SERVER_RANKS), compares its own with these.
"""

import os
import socket
import subprocess

import numpy
from paraview import servermanager, simple

import Stage

HOST = "127.0.0.1"


def start_server(ranks):
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        port = probe.getsockname()[1]
    # This process has initialised MPI, too, and must not be taken for one of the server's.
    ours = ("PMIX_", "OMPI_MCA_ess", "OMPI_MCA_orte", "OMPI_MCA_pmix", "OMPI_COMM", "OMPI_UNIVERSE")
    server = subprocess.Popen(
        ["mpiexec", "-n", ranks, "pvserver", f"--server-port={port}"],
        env={key: value for key, value in os.environ.items() if not key.startswith(ours)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    for line in server.stdout:
        if "Accepting connection" in line:
            break
    simple.Connect(HOST, port)
    Stage.load_plugin()
    Stage.load_plugin(remote=True)
    return server


def render(view, display):
    """All pictures, by name."""
    pictures = {}
    for projection in ("Maximum", "Minimum", "Depth-Shaded Maximum"):
        display.MIPProjection = projection
        for quality in ("Preview", "Standard", "High"):
            display.MIPQuality = quality
            for name, is_parallel, place, scale in (
                ("axis", 1, (0, 0, 200), 32),
                ("oblique", 1, (130, 60, 90), 32),
                ("perspective", 0, (70, 30, 60), 32),
                ("detail", 1, (130, -60, 90), 4),  # most pieces are out of sight
            ):
                view.CameraParallelProjection = is_parallel
                view.CameraFocalPoint = [19.5, 17.5, 21.5]
                view.CameraPosition = [a + b for a, b in zip(view.CameraFocalPoint, place)]
                view.CameraViewUp = [0, 1, 0]
                view.CameraParallelScale = scale
                key = f"{projection} {quality} {name}"
                pictures[key] = Stage.picture(view, "ranks")
    return pictures


def main():
    simple._DisableFirstRenderCameraReset()
    server_ranks = os.environ.get("SPLATTINGMIP_SERVER_RANKS")
    server = start_server(server_ranks) if server_ranks else None
    if not server:
        Stage.load_plugin()
    controller = servermanager.vtkProcessModule.GetProcessModule().GetGlobalController()
    ranks = int(server_ranks or controller.GetNumberOfProcesses())
    is_root = controller.GetLocalProcessId() == 0
    file = Stage.path("volume.vti")
    expected_file = Stage.path("expected.npz")
    if ranks == 1:
        Stage.open_images("volume", Stage.image(scalars=Stage.noise(5)))
        os.replace(Stage.path("volume0.vti"), file)
    view = Stage.new_view()
    source = simple.XMLImageDataReader(FileName=[file])
    display = Stage.show(source, view)
    colors = simple.GetColorTransferFunction("scalars")
    colors.RGBPoints = [0, 0, 0.1, 0.4, 128, 0.9, 0.3, 0, 255, 1, 1, 0.9]
    opacity = simple.GetOpacityTransferFunction("scalars")
    opacity.Points = [0, 0.1, 0.5, 0, 255, 0.8, 0.5, 0]
    view.Background = [0.2, 0.3, 0.1]
    pictures = render(view, display)
    if ranks == 1:
        numpy.savez(expected_file, **pictures)
    elif is_root:
        expected = numpy.load(expected_file)
        for key, pixels in pictures.items():
            different = int(numpy.abs(pixels.astype(int) - expected[key].astype(int)).max())
            print(key, "differs by", different, flush=True)
            if different:
                raise RuntimeError(f"{ranks} ranks show another picture: {key}")
            # The least of noise is nearly the same everywhere: one colour beside the background's.
            if len(numpy.unique(pixels)) < (20 if "Maximum" in key else 4):
                raise RuntimeError(f"there is nothing to see: {key}")
    if server:
        # Its ranks do not end with the connection, of which the client would still send the end.
        server.terminate()
        server.communicate(timeout=60)
        os._exit(0)


main()
