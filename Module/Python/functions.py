# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Projections of NumPy arrays, and the mapper for programs that use VTK's."""

from __future__ import annotations

import ctypes
import pathlib
import typing
from collections.abc import Sequence

import vtksplattingmip

if typing.TYPE_CHECKING:
    import numpy
    import numpy.typing

_MODES = {"preview": 0, "standard": 1, "high": 2, "exact": 3}
_BLENDS = {"maximum": 1, "minimum": 2, "mean": 3, "signed": 1}
# Settings of a mapper that the splatting mapper has, too, as far as VTK's mappers have them.
_COMMON_SETTINGS = (
    "BlendMode",
    "ScalarMode",
    "Cropping",
    "CroppingRegionPlanes",
    "CroppingRegionFlags",
    "AverageIPScalarRange",
    "VectorMode",
    "VectorComponent",
    "FinalColorWindow",
    "FinalColorLevel",
)
# Of each axis the direction and what is up, so that the picture is not mirrored.
_VIEWS = (((1, 0, 0), (0, -1, 0)), ((0, -1, 0), (-1, 0, 0)), ((0, 0, 1), (-1, 0, 0)))


def mip(
    array: numpy.typing.ArrayLike,
    spacing: Sequence[float] = (1.0, 1.0, 1.0),
    direction: int | Sequence[float] = 0,
    mode: str = "exact",
    *,
    blend: str = "maximum",
    up: Sequence[float] | None = None,
    shape: tuple[int, int] | None = None,
    pixel_spacing: float | Sequence[float] | None = None,
    background: float | None = None,
    views: int | None = None,
) -> numpy.ndarray:
    """Return the maximum intensity projection of a volume.

    mip(array, direction=n) shows the same as array.max(axis=n). All vectors are in the order of the
    array's axes. Needs neither a display nor OpenGL. Other Python threads run meanwhile.

    Parameters
    ----------
    array
        Three-dimensional array of numbers or bool. NaN are no samples.
    spacing
        Distance of the voxels along each axis.
    direction
        Axis to project along, or the direction from the viewer into the volume, as a vector.
    mode
        "preview", "standard", "high" or "exact"; see vtkSplattingMIPVolumeMapper.
    blend
        "maximum", "minimum", "mean", or "signed": the maximum or the minimum, whichever is farther
        from 0.
    up
        Direction that is up in the picture, as a vector. By default the first axis goes down, or
        the second one if the view is along the first.
    shape
        Rows and columns of the picture. By default it shows the whole volume.
    pixel_spacing
        Distance of rows and of columns, or one number for both. By default that of the voxels along
        an axis, and else the least of `spacing`.
    background
        Value of pixels without a sample. By default the least value of the array, for "minimum" the
        greatest, for "signed" 0.
    views
        Number of views of a whole turn about the picture's vertical.

    Returns
    -------
    numpy.ndarray
        Picture, its first row at the top; with `views` an array of pictures. Maxima and minima have
        the type of the array; those of integers are rounded. Means are float32, or float64 for
        32- and 64-bit integers and float64.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid. The message says what to do.
    MemoryError
        If there is not enough memory.
    """
    import numpy

    volume, result_type = _volume(array)
    spacing = numpy.broadcast_to(numpy.asarray(spacing, float), 3)
    along, up = _view(direction, up)
    across = numpy.cross(up, along)  # to the right; the axes are in reverse order
    down = numpy.cross(across, along)
    down, across = down / numpy.linalg.norm(down), across / numpy.linalg.norm(across)
    # Between the outermost voxels, along columns and rows of the picture.
    lengths = (numpy.array(volume.shape) - 1) * spacing
    width = abs(across) @ lengths if views is None else numpy.linalg.norm(lengths)
    extents = numpy.array([abs(down) @ lengths, width])
    if shape is not None and min(shape) < 1:
        raise ValueError("shape must be above 0.")
    if pixel_spacing is None and shape is not None:
        pixel_spacing = max((extents + spacing.min()) / shape)
    elif pixel_spacing is None and numpy.ndim(direction) == 0:
        pixel_spacing = abs(down) @ spacing, abs(across) @ spacing
    elif pixel_spacing is None:
        pixel_spacing = spacing.min()
    pixel_spacing = numpy.broadcast_to(numpy.asarray(pixel_spacing, float), 2)
    if not (pixel_spacing > 0).all():
        raise ValueError("spacing and pixel_spacing must be above 0.")
    if shape is None:
        shape = (numpy.ceil(extents / pixel_spacing - 1e-6) + 1).astype(int)

    projection = vtksplattingmip.vtkSplattingMIPProjection()
    projection.SetInputData(_image(volume, spacing))
    projection.SetViewDirection(*along[::-1])
    projection.SetViewUp(*up[::-1])
    projection.SetQualityMode(_choice("mode", mode, _MODES))
    projection.SetBlendMode(_choice("blend", blend, _BLENDS))
    if blend == "signed":
        projection.SetMaximumTypeToSigned()
    projection.SetOutputSize(int(shape[1]), int(shape[0]))
    projection.SetOutputSpacing(pixel_spacing[1], pixel_spacing[0])
    if views is not None:
        projection.SetNumberOfViews(views)
        projection.SetRotationAxis(*-down[::-1])
    if background is None and blend == "minimum":
        background = numpy.nanmax(volume)
    elif background is None and blend == "signed":
        background = 0
    elif background is None:
        background = numpy.nanmin(volume)
    elif not blend == "mean" and numpy.issubdtype(volume.dtype, numpy.integer):
        limits = numpy.iinfo(volume.dtype)
        if not limits.min <= background <= limits.max:
            raise ValueError(f"background is {background}: choose a number that {volume.dtype} can hold.")
    projection.SetBackgroundValue(float(background))
    _update(projection)

    support = vtksplattingmip._vtk_module("util.numpy_support")
    picture = support.vtk_to_numpy(projection.GetOutput().GetPointData().GetScalars())
    picture = picture.reshape(-1, *shape)[:, ::-1]
    if views is None:
        picture = picture[0]
    if blend == "mean":
        return picture.copy()
    if numpy.issubdtype(volume.dtype, numpy.integer):
        return _round(picture, volume.dtype).astype(result_type)
    return picture.astype(result_type)


def _round(picture, integer):
    """Round floats to a type of integers, the largest of which may have no float."""
    import numpy

    limits = numpy.iinfo(integer)
    with numpy.errstate(invalid="ignore"):
        rounded = numpy.rint(picture).astype(integer)
    rounded[picture >= float(limits.max)] = limits.max
    rounded[picture <= float(limits.min)] = limits.min
    return rounded


def _volume(array):
    """The array as VTK can use it, and the type of its maxima."""
    import numpy

    volume = numpy.asarray(array)
    if volume.ndim != 3:
        raise ValueError(f"array has {volume.ndim} dimensions: choose three.")
    if volume.size == 0:
        raise ValueError("array has no voxels.")
    if volume.dtype.kind not in "biuf":
        raise TypeError(f"array is of {volume.dtype}: choose numbers or bool.")
    result_type = volume.dtype.newbyteorder("=")
    if volume.dtype.kind == "b":
        return numpy.ascontiguousarray(volume).view(numpy.uint8), result_type
    if volume.dtype.kind == "f" and volume.dtype.itemsize not in (4, 8):
        used_type = numpy.dtype(numpy.float32 if volume.dtype.itemsize < 4 else numpy.float64)
    else:
        used_type = result_type
    return numpy.ascontiguousarray(volume, used_type), result_type


def _view(direction, up):
    """Direction and up of a view, as vectors."""
    import numpy

    if numpy.ndim(direction) == 0:
        if direction not in range(-3, 3):
            raise ValueError(f"direction is {direction}: choose 0, 1 or 2, or a vector.")
        view = _VIEWS[direction]
        direction = view[0]
        up = view[1] if up is None else up
    direction = numpy.asarray(direction, float)
    if up is None:
        up = numpy.array([-1.0, 0.0, 0.0])
        if numpy.linalg.norm(numpy.cross(direction, up)) <= 1e-6 * numpy.linalg.norm(direction):
            up = numpy.array([0.0, -1.0, 0.0])
    up = numpy.asarray(up, float)
    if direction.shape != (3,) or up.shape != (3,):
        raise ValueError("direction and up must be vectors of three numbers.")
    if not numpy.linalg.norm(numpy.cross(direction, up)) > 0:
        raise ValueError("up must not be along the direction, and neither may be 0.")
    return direction, up


def _choice(name, value, values):
    if value not in values:
        raise ValueError(f"{name} is {value!r}: choose one of {', '.join(values)}.")
    return values[value]


def _image(volume, spacing):
    support = vtksplattingmip._vtk_module("util.numpy_support")
    image = vtksplattingmip._vtk_module("vtkCommonDataModel").vtkImageData()
    image.SetDimensions(volume.shape[::-1])
    image.SetSpacing(spacing[::-1])
    image.GetPointData().SetScalars(support.numpy_to_vtk(volume.ravel()))
    return image


def _update(algorithm):
    """Update an algorithm without Python's lock, and raise its error.

    Update() releases the lock in newer VTKs only. A function that ctypes calls does so always.
    """
    errors = []

    def record(_, __, message):
        errors.append(" ".join(message.split("\n")[-3:]).strip())

    record.CallDataType = "string0"
    observer = algorithm.AddObserver("ErrorEvent", record)
    library = ctypes.CDLL(str(next(pathlib.Path(__file__).parent.glob("libsplattingmip_update*"))))
    library.splattingmip_update.argtypes = [ctypes.c_void_p]
    library.splattingmip_update.restype = ctypes.c_bool
    done = library.splattingmip_update(int(algorithm.GetAddressAsString("").split("=")[1], 16))
    algorithm.RemoveObserver(observer)
    if not done:
        raise MemoryError("There is not enough memory for the projection.")
    if errors:
        raise (MemoryError if " memory" in errors[0] else ValueError)(errors[0])


def enable(mode: str = "exact") -> None:
    """Let VTK's GPU mapper splat maxima and minima, in this process.

    vtkSmartVolumeMapper uses it, too, and with it PyVista's plotter.add_volume(..., mapper="smart").
    Other blend modes stay VTK's.

    Parameters
    ----------
    mode
        Quality of mappers that are made from now on: "preview", "standard", "high" or "exact".
    """
    override = vtksplattingmip.vtkSplattingMIPGPUVolumeRayCastMapper
    override.SetGlobalQualityMode(_choice("mode", mode, _MODES))
    override.GlobalOverrideOn()


def disable() -> None:
    """Undo enable() for mappers that are made from now on."""
    override = vtksplattingmip.vtkSplattingMIPGPUVolumeRayCastMapper
    override.SetGlobalQualityMode(_MODES["exact"])
    override.GlobalOverrideOff()


def use_for(volume: typing.Any, mode: str = "exact") -> typing.Any:
    """Give a volume the splatting mapper.

    The new mapper has the old one's input, scalars, blend mode, cropping, clipping planes, vector
    mode, final colour window and range of averages. Masks are not taken over.

    Parameters
    ----------
    volume
        vtkVolume, such as the actor that PyVista's plotter.add_volume() returns.
    mode
        "preview", "standard", "high" or "exact".

    Returns
    -------
    vtkSplattingMIPVolumeMapper
        The volume's new mapper.

    Raises
    ------
    ValueError
        If the volume has no mapper or the mode is unknown.
    """
    old = volume.GetMapper()
    if old is None:
        raise ValueError("The volume has no mapper: give it one with an input first.")
    mapper = vtksplattingmip.vtkSplattingMIPVolumeMapper()
    if old.GetNumberOfInputConnections(0):
        mapper.SetInputConnection(old.GetInputConnection(0, 0))
    for name in _COMMON_SETTINGS:
        if hasattr(old, f"Get{name}"):
            getattr(mapper, f"Set{name}")(getattr(old, f"Get{name}")())
    if old.GetArrayAccessMode() == 1:  # VTK_GET_ARRAY_BY_NAME
        mapper.SelectScalarArray(old.GetArrayName())
    else:
        mapper.SelectScalarArray(old.GetArrayId())
    if old.GetClippingPlanes():
        mapper.SetClippingPlanes(old.GetClippingPlanes())
    mapper.SetQualityMode(_choice("mode", mode, _MODES))
    volume.SetMapper(mapper)
    return mapper
