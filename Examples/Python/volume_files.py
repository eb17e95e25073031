# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Volumes of one file, in patient coordinates where the file says how the patient lies.

Needs NumPy and VTK, but no OpenGL.
"""
import bz2
import dataclasses
import gzip
import math
import pathlib
import struct
import zlib

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_BIT
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

# NumPy's types as NRRD and MetaImage name them.
TYPES = {
    "i1": ("signed char", "int8", "int8_t", "met_char"),
    "u1": ("uchar", "unsigned char", "uint8", "uint8_t", "met_uchar"),
    "i2": ("short", "short int", "signed short", "signed short int", "int16", "int16_t", "met_short"),
    "u2": ("ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t", "met_ushort"),
    "i4": ("int", "signed int", "int32", "int32_t", "met_int"),
    "u4": ("uint", "unsigned int", "uint32", "uint32_t", "met_uint"),
    "f4": ("float", "met_float"),
    "f8": ("double", "met_double"),
}
# Whether NRRD's x and y must change their signs to go to the patient's left and back.
SPACES = {
    "left-posterior-superior": (1, 1, 1),
    "right-anterior-superior": (-1, -1, 1),
    "left-anterior-superior": (1, -1, 1),
}
# Millimetres, by a unit's symbols and names.
UNITS = {**dict.fromkeys(("mm", "millimeter", "millimetre"), 1.0), **dict.fromkeys(("m", "meter", "metre"), 1000.0),
         **dict.fromkeys(("cm", "centimeter", "centimetre"), 10.0), **dict.fromkeys(("in", "inch"), 25.4),
         **dict.fromkeys(("um", "\u00b5m", "\u03bcm", "micron", "micrometer", "micrometre"), 0.001),
         **dict.fromkeys(("nm", "nanometer", "nanometre"), 1e-6)}
SPACES.update({"lps": (1, 1, 1), "ras": (-1, -1, 1), "las": (1, -1, 1)})


class VolumeError(Exception):
    """Says in a sentence what is wrong with a file and what to do."""


DAMAGED = VolumeError(
    "damaged, incomplete or not what its name says; check it, or export the volume again.")


@dataclasses.dataclass
class Volume:
    """Columns of axes are steps from voxel to voxel, in mm where that is known."""

    image: vtkImageData
    is_oriented: bool = False  # x to the patient's left, y to the back, z to the head
    is_in_mm: bool = False
    window: tuple = None  # the file's own (low, high)
    note: str = ""


def make_image(values, axes, origin):
    """From values[z, y, x]."""
    spacing = numpy.linalg.norm(axes, axis=0)
    if values.size == 0 or not (numpy.isfinite(spacing).all() and spacing.min() > 0.0):
        raise DAMAGED
    directions = axes / spacing
    if not numpy.allclose(directions.T @ directions, numpy.eye(3), atol=1e-3):
        raise VolumeError("its axes are not at right angles; resample the volume first.")
    image = vtkImageData()
    image.SetDimensions(values.shape[::-1])
    image.SetSpacing(spacing)
    image.SetOrigin(origin)
    image.SetDirectionMatrix(directions.ravel())
    image.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(values).ravel()))
    return image


def read_header(path):
    """The lines "key: value" (NRRD) or "key = value" (MetaImage) before the data, and the data."""
    fields = {}
    with open(path, "rb") as file:
        for line in iter(lambda: file.readline(65536).decode(errors="replace"), ""):
            key, separator, value = line.partition("=" if path.suffix.lower() == ".mha" else ":")
            key = key.strip().lower()
            if separator:
                fields[key] = value.strip()
            if not line.strip() or key == "elementdatafile":
                break
        return fields, file.read()


def decode(data, fields, shape):
    """Values[z, y, x] of a file's data."""
    code = fields.get("type", fields.get("elementtype", "")).lower()
    names = [numpy_type for numpy_type, words in TYPES.items() if code in words]
    if not names:
        raise VolumeError(f"values of type {code!r} cannot be read; save the volume as float.")
    encoding = fields.get("encoding", "raw").lower()
    is_zipped = fields.get("compresseddata", "").lower() == "true"
    if encoding in ("gzip", "gz") or is_zipped:
        data = gzip.decompress(data) if data[:2] == b"\x1f\x8b" else zlib.decompress(data)
    elif encoding in ("bzip2", "bz2"):
        data = bz2.decompress(data)
    elif encoding != "raw" or fields.get("binarydata", "true").lower() != "true":
        raise VolumeError("its data are text; save the volume with raw or gzip data.")
    is_big = fields.get("endian", "").lower() == "big" or "true" in (
        fields.get("binarydatabyteordermsb", "").lower(), fields.get("elementbyteordermsb", "").lower())
    values = numpy.frombuffer(data, (">" if is_big else "<") + names[0])
    if values.size != math.prod(shape):
        raise DAMAGED
    return values.astype(names[0], copy=False).reshape(shape)


def numbers(text, count):
    found = [float(word) for word in text.translate(str.maketrans("(),", "   ")).split()]
    if len(found) != count:
        raise DAMAGED
    return numpy.array(found)


def find_unit(name):
    """The length of a unit in mm, which is 1 where it is unknown, and whether it is known."""
    name = name.lower() if name.lower() in UNITS else name.lower().rstrip("s")
    return UNITS.get(name, 1.0), name in UNITS


def check_dimensions(fields, *keys):
    """Three sizes, z first, of one value per voxel in this very file."""
    dimension = int(next((fields[key] for key in keys if key in fields), "0"))
    if dimension > 3 or fields.get("elementnumberofchannels", "1") != "1":
        raise VolumeError("it has several values per voxel or times; save one volume of it.")
    if dimension != 3 or "data file" in fields or fields.get("elementdatafile", "LOCAL") != "LOCAL":
        raise VolumeError("it is not one volume with its data in the same file; save it so.")
    if any(key in fields for key in ("line skip", "lineskip", "byte skip", "byteskip")):
        raise VolumeError("something lies between its header and its data; save it without.")
    shape = numbers(fields.get("sizes", fields.get("dimsize", "")), 3)[::-1].astype(int)
    if shape.min() < 1:
        raise DAMAGED
    return tuple(int(size) for size in shape)


def read_nrrd(path):
    fields, data = read_header(path)
    shape = check_dimensions(fields, "dimension")
    space = fields.get("space", "").lower()
    signs = numpy.array(SPACES.get(space, (1, 1, 1)))
    axes, note = numpy.eye(3), ""
    if "space directions" in fields:
        axes = signs[:, None] * numbers(fields["space directions"], 9).reshape(3, 3).T
    elif "spacings" in fields:
        axes = numpy.diag(numbers(fields["spacings"], 3))
    else:
        note = "the file has no voxel size: cubes of 1 are shown"
    origin = signs * numbers(fields.get("space origin", "0 0 0"), 3)
    length, is_known = find_unit((fields.get("space units", "") + '"mm"').split('"')[1])
    image = make_image(decode(data, fields, shape), axes * length, origin * length)
    return Volume(image, space in SPACES, is_known and "space directions" in fields, None, note)


def read_meta(path):
    fields, data = read_header(path)
    shape = check_dimensions(fields, "ndims")
    def find(*keys):
        return next((fields[key] for key in keys if key in fields), None)
    directions = find("transformmatrix", "rotation", "orientation")
    spacing = find("elementspacing", "elementsize")
    axes = numbers(directions or "1 0 0 0 1 0 0 0 1", 9).reshape(3, 3).T * numbers(spacing or "1 1 1", 3)
    origin = find("origin", "position", "offset") or "0 0 0"
    unit = find("distanceunits")
    length, is_known = find_unit("mm" if unit in (None, "?") else unit)
    image = make_image(decode(data, fields, shape), axes * length, numbers(origin, 3) * length)
    return Volume(image, directions is not None, is_known and spacing is not None)


def run_reader(reader, path):
    """The output of one of VTK's readers, which tell of errors by events only."""
    errors = []
    for part in (reader, reader.GetExecutive()):
        part.AddObserver("ErrorEvent", lambda *_: errors.append(True))
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    if errors or reader.GetErrorCode() or image.GetNumberOfPoints() < 1:
        raise DAMAGED
    scalars = image.GetPointData().GetScalars() or image.GetPointData().GetArray(0)
    if not scalars or scalars.GetNumberOfComponents() != 1:
        raise VolumeError("it has not one value at each point; save the volume so.")
    if scalars.GetDataType() == VTK_BIT:
        raise VolumeError("its values are bits; convert them to unsigned char with vtkImageCast.")
    image.GetPointData().SetScalars(scalars)
    return image


def read_vti(path):
    # VTK's reader does not miss the end of a file behind raw data.
    with open(path, "rb") as file:
        file.seek(max(0, path.stat().st_size - 256))
        if b"</VTKFile>" not in file.read():
            raise DAMAGED
    return Volume(run_reader(vtkXMLImageDataReader(), path))


def check_nifti(path):
    """VTK's reader ends the program for some damaged headers."""
    with open(path, "rb") as file:
        is_zipped = file.read(2) == b"\x1f\x8b"
    with (gzip.open if is_zipped else open)(path, "rb") as file:
        header = file.read(544)
    for order in "<>":
        if header[:4] == struct.pack(order + "i", 348) and len(header) >= 352:
            sizes = struct.unpack_from(order + "8h", header, 40)
            bits = struct.unpack_from(order + "h", header, 72)[0]
        elif header[:4] == struct.pack(order + "i", 540) and len(header) >= 544:
            sizes = struct.unpack_from(order + "8q", header, 16)
            bits = struct.unpack_from(order + "h", header, 14)[0]
        else:
            continue
        if 3 <= sizes[0] <= 7 and min(sizes[1:1 + sizes[0]]) > 0 and bits > 0:
            return
    raise DAMAGED


def read_nifti(path):
    check_nifti(path)
    reader = vtkNIFTIImageReader()
    image = run_reader(reader, path)
    values = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    slope, intercept = reader.GetRescaleSlope(), reader.GetRescaleIntercept()
    is_scaled = slope != 0.0 and math.isfinite(slope) and math.isfinite(intercept)
    if is_scaled and (slope, intercept) != (1.0, 0.0):  # codes become values
        wide = numpy.float32 if values.dtype.itemsize <= 2 else numpy.float64
        values = values.astype(wide) * wide(slope) + wide(intercept)
    forms = [numpy.array([[form.GetElement(i, j) for j in range(4)] for i in range(3)])
             for form in (reader.GetSFormMatrix(), reader.GetQFormMatrix()) if form]
    # Programs write sforms of zeros beside a good qform.
    matrix = next((form for form in forms if abs(numpy.linalg.det(form[:, :3])) > 1e-9), None)
    header = reader.GetNIFTIHeader()
    unit = {1: 1000.0, 3: 0.001}.get(header.GetXYZTUnits() & 7, 1.0)  # m and um
    spacing = numpy.array(image.GetSpacing())  # with signs, by which VTK divides sforms
    axes, origin = numpy.diag(abs(spacing)) * unit, numpy.zeros(3)
    if matrix is not None:
        to_lps = numpy.array([[-1], [-1], [1]]) * unit
        axes, origin = to_lps * matrix[:, :3] * spacing, (to_lps * matrix[:, 3:]).ravel()
    low, high = header.GetCalMin(), header.GetCalMax()
    volumes = reader.GetTimeDimension()
    notes = [] if matrix is not None else ["the file has no orientation; left and right may be exchanged"]
    notes += [f"the first of {volumes} volumes"] if volumes > 1 else []
    return Volume(make_image(values, axes, origin), matrix is not None, True,
                  (low, high) if high > low else None, "; ".join(notes))


READERS = {".vti": read_vti, ".mha": read_meta, ".nrrd": read_nrrd, ".nii": read_nifti, ".nii.gz": read_nifti}


def read_volume(path):
    """A Volume, or a VolumeError."""
    path = pathlib.Path(path)
    try:
        reader = next((READERS[end] for end in READERS if path.name.lower().endswith(end)), None)
        if not path.exists():
            raise VolumeError("there is no such file; check the spelling and the current folder.")
        if not reader or path.is_dir():
            raise VolumeError(
                "this kind of volume cannot be read; convert it to one of "
                f"{', '.join(READERS)} (DICOM with dcm2niix).")
        volume = reader(path)
        if not numpy.isfinite(volume.image.GetOrigin() + volume.image.GetSpacing()).all():
            raise DAMAGED
        return volume
    except OSError as error:
        if error.errno:
            raise VolumeError(f"{path}: {error.strerror}; check its permissions.") from None
        raise VolumeError(f"{path}: {DAMAGED}") from None  # gzip's errors have no number
    except (ValueError, EOFError, zlib.error):
        raise VolumeError(f"{path}: {DAMAGED}") from None
    except MemoryError:
        raise VolumeError(f"{path}: there is not enough memory for this volume; reduce it first.") from None
    except VolumeError as error:
        raise VolumeError(f"{path}: {error}") from None


def choose_window(volume):
    """The file's window, or from the median to the value that one voxel in 2000 exceeds."""
    if volume.window:
        return volume.window
    values = vtk_to_numpy(volume.image.GetPointData().GetScalars())
    few = values[::max(1, values.size // 1000000)]
    few = few[numpy.isfinite(few)]
    if few.size == 0:
        few = values[numpy.isfinite(values)]
    if few.size == 0:
        raise VolumeError("the volume has no finite value, so that there is nothing to show.")
    low, high = (float(value) for value in numpy.quantile(few, (0.5, 0.9995)))
    if low == high:
        low, high = float(few.min()), float(few.max())
    return (low, high) if low < high else (low - 0.5, low + 0.5)
