# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""mpiexec -n 2 python3 TestSettings.py: ranks notice that they differ in a setting.

The settings are those that the mapper's class has, by its pairs of Set and Get. Each that changes
the picture of one rank by itself must keep two ranks that differ in it from drawing.
"""
import ctypes
import ctypes.util
import os
import re
import select
import signal
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelMPI import vtkMPIController

from vtksplattingmip import vtkSplattingMIPVolumeMapper

SIZE = (17, 15, 13)
PATIENCE = 20  # seconds; a setting takes a few hundredths of one
WINDOW = vtk.vtkRenderWindow()
WINDOW.OffScreenRenderingOn()
WINDOW.SetMultiSamples(0)
WINDOW.SetSize(40, 40)


def make_image():
    """Two components of bytes under one name, others under another."""
    image = vtk.vtkImageData()
    image.SetDimensions(*SIZE)
    for name, seed in (("first", 1), ("second", 2)):
        source = vtk.vtkMinimalStandardRandomSequence()
        source.SetSeed(seed)
        array = vtk.vtkUnsignedCharArray()
        array.SetName(name)
        array.SetNumberOfComponents(2)
        array.SetNumberOfTuples(image.GetNumberOfPoints())
        for n in range(array.GetNumberOfValues()):
            source.Next()
            array.SetValue(n, int(255 * source.GetValue() ** 4))
        image.GetPointData().AddArray(array)
    image.GetPointData().SetActiveScalars("first")
    return image


def make_object(name):
    """What a setter may take, by the name of its class. None for what is no setting: controllers,
    and masks, which are data as the input is, of which each rank has its own piece."""
    if name == "vtkPolyData":
        sphere = vtk.vtkSphereSource()
        sphere.SetCenter(8, 7, 6)
        sphere.SetRadius(5)
        sphere.Update()
        return sphere.GetOutput()
    if name == "vtkPlaneCollection":
        plane = vtk.vtkPlane()
        plane.SetOrigin(8, 7, 6)
        planes = vtk.vtkPlaneCollection()
        planes.AddItem(plane)
        return planes
    if name == "vtkScalarsToColors":
        table = vtk.vtkLookupTable()
        table.SetHueRange(0.3, 0.6)
        table.Build()
        return table
    return None


def other_values(setter, value):
    """Values of the same kind as a property's."""
    if isinstance(value, (bool, int, float)):
        return [not value] if isinstance(value, bool) else [0, 1, 2, 3, 8, value + 1, value + 30]
    if isinstance(value, tuple) and all(isinstance(x, (int, float)) for x in value):
        return [tuple(x + shift * (1 - 2 * (n % 2)) for n, x in enumerate(value))
                for shift in (2, -3)]
    if isinstance(value, str):
        return ["second"]
    names = re.findall(r"Set\w+\([^)]*?\b(vtk\w+)", setter.__doc__ or "")
    return [made for made in map(make_object, sorted(set(names))) if made]


def find_settings(mapper):
    """Setters' names and values that differ from the present ones, of all classes of mappers."""
    classes = [c for c in type(mapper).__mro__ if issubclass(c, vtk.vtkAbstractMapper)]
    for name in sorted({name for c in classes for name in vars(c) if name.startswith("Set")}):
        getter = getattr(mapper, "Get" + name[3:], None)
        if not getter:
            continue
        try:
            value = getter()
        except TypeError:
            continue
        setter = getattr(mapper, name)
        for other in other_values(setter, value):
            if other != value:
                yield name, other


class Scene:
    """A volume in which a cube hides something, alone in the window."""

    def __init__(self, prepare):
        self.mapper = vtkSplattingMIPVolumeMapper()
        self.mapper.SetInputData(make_image())
        prepare(self.mapper)
        self.errors = []
        self.mapper.AddObserver("ErrorEvent", self.note)
        self.mapper.AddObserver("WarningEvent", lambda *_: None)
        colors = vtk.vtkColorTransferFunction()
        colors.AddRGBPoint(0, 0, 0, 0)
        colors.AddRGBPoint(255, 1, 0.8, 1)
        opaque = vtk.vtkPiecewiseFunction()
        opaque.AddPoint(0, 1)
        volume = vtk.vtkVolume()
        volume.SetMapper(self.mapper)
        for component in range(2):
            volume.GetProperty().SetColor(component, colors)
            volume.GetProperty().SetScalarOpacity(component, opaque)
            volume.GetProperty().SetComponentWeight(component, 0.5)
        cube = vtk.vtkCubeSource()
        cube.SetCenter(8, 7, 6)
        cube.SetXLength(9)
        cube_mapper = vtk.vtkPolyDataMapper()
        cube_mapper.SetInputConnection(cube.GetOutputPort())
        actor = vtk.vtkActor()
        actor.SetMapper(cube_mapper)
        renderer = vtk.vtkRenderer()
        renderer.AddActor(actor)
        renderer.AddVolume(volume)
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(8, 7, 6)
        camera.SetPosition(20, 30, 50)
        camera.SetParallelScale(12)
        camera.SetClippingRange(1, 200)
        WINDOW.GetRenderers().RemoveAllItems()
        WINDOW.AddRenderer(renderer)

    def note(self, *_):
        self.errors.append(True)

    def set(self, name, value):
        """Whether the value was taken."""
        try:
            setter = getattr(self.mapper, name)
            setter(*value) if isinstance(value, tuple) else setter(value)
        except (TypeError, ValueError):
            return False
        return True

    def pixels(self):
        WINDOW.Render()
        pixels = vtk.vtkUnsignedCharArray()
        WINDOW.GetPixelData(0, 0, 39, 39, 0, pixels, 0)
        return vtk_to_numpy(pixels).tobytes()


def watch_rank():
    """Ranks that differ unnoticed may wait for each other for ever. Starts a process that then ends
    this one; a thread would get no turn while VTK waits. Returns what to tell each step to."""
    reading, writing = os.pipe()
    rank = os.getpid()
    if os.fork():
        os.close(reading)
        return lambda step: os.write(writing, f"{step}\n".encode())
    os.close(writing)
    steps = b"the start"
    while select.select([reading], [], [], PATIENCE)[0]:
        steps = os.read(reading, 4096)
        if not steps:
            os._exit(0)
    step = steps.decode().splitlines()[-1]
    print("ERROR: not noticed, ranks wait for each other:", step, flush=True)
    os.kill(rank, signal.SIGKILL)
    os._exit(1)


def plain(_):
    pass


def cut(mapper):
    mapper.SetQualityModeToHigh()
    mapper.CroppingOn()
    mapper.SetCroppingRegionPlanes(3, 12, 3, 11, 2, 10)
    mapper.SlabOn()
    mapper.SetSlabCenter(8, 7, 6)
    mapper.SetSlabThickness(8)
    mapper.SetKernelToCosineBell()


def shaded(mapper):
    mapper.SetMaximumTypeToDepthShaded()
    mapper.SetVectorModeToComponent()
    mapper.SelectScalarArray("first")
    mapper.SetScalarModeToUsePointFieldData()


def coded(mapper):
    mapper.SetVectorModeToMagnitude()
    mapper.DepthCodingOn()
    mapper.SetDepthCodingRange(30, 80)
    mapper.SetAccelerationToLines()
    mapper.SetQualityModeToPreview()


def main():
    tell = watch_rank()
    # VTK's controller leaves it to the program to start MPI.
    ctypes.CDLL(ctypes.util.find_library("mpi"), ctypes.RTLD_GLOBAL).MPI_Init(None, None)
    controller = vtkMPIController()
    controller.Initialize()
    rank = controller.GetLocalProcessId()
    failed, compared = False, set()
    for prepare in (plain, cut, shaded, coded):
        expected = Scene(prepare).pixels()
        assert any(expected), "the scene is black"
        for name, value in find_settings(Scene(prepare).mapper):
            shown = value.GetClassName() if isinstance(value, vtk.vtkObject) else value
            step = f"{prepare.__name__}, {name}({shown})"
            tell(step)
            alone = Scene(prepare)
            if not alone.set(name, value):
                continue
            if alone.pixels() == expected:
                continue
            # Both ranks hold all of the volume; the second one has another setting.
            together = Scene(prepare)
            together.mapper.SetController(controller)
            if rank == 1:
                together.set(name, value)
            together.pixels()
            compared.add(name)
            if not together.errors:
                failed = True
                print("ERROR: not noticed:", step, flush=True)
        # Ranks that agree draw.
        together = Scene(prepare)
        together.mapper.SetController(controller)
        if together.pixels() != expected or together.errors:
            failed = True
            print(f"ERROR: {prepare.__name__}: ranks that agree do not draw the same", flush=True)
    controller.Barrier()
    if rank == 0:
        print("settings that change a picture:", ", ".join(sorted(compared)))
    controller.Finalize()
    # As many as the classes had when this was written, or the search is broken.
    return 1 if failed or len(compared) < 25 else 0


if __name__ == "__main__":
    sys.exit(main())
