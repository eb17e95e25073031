# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""TIFF stacks: the values that tifffile finds, at the size that the description gives, or a refusal
that names tag and value.
"""
import ctypes
import ctypes.util
import struct

import numpy
import tifffile

import SplatmipTesting as splatmip

UNIT = numpy.eye(3, 4)
PLACES = numpy.array([[0.25, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 2, 0.0]]) * 1e-3
SIZES = {"Z": 4, "C": 3, "T": 2, "Y": 20, "X": 30}
GRAY = {"photometric": "minisblack", "metadata": None}


def make_values(dtype="uint16", size=(9, 20, 30)):
    return numpy.random.default_rng(0).integers(0, 250, size).astype(dtype)


def make_axes(axes):
    return make_values(size=tuple(SIZES[axis] for axis in axes))


class TIFFTest(splatmip.SplatmipTest):
    def write(self, values, **settings):
        tifffile.imwrite(self.path("a.tif"), values, **settings)
        return self.path("a.tif")

    def patch(self, path, tag, value):
        """Change a short number in all pages."""
        data, changes = splatmip.read_file(path), {}
        place = struct.unpack_from("<I", data, 4)[0]
        while place:
            count = struct.unpack_from("<H", data, place)[0]
            for entry in range(place + 2, place + 2 + 12 * count, 12):
                if struct.unpack_from("<H", data, entry)[0] == tag:
                    changes[entry + 2] = struct.pack("<HIHH", 3, 1, value, 0)
            place = struct.unpack_from("<I", data, place + 2 + 12 * count)[0]
        return splatmip.patch_file(path, changes)


class TestPages(TIFFTest):
    def test_layouts(self):
        """The first row is at the front, the first page at the feet."""
        types = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")
        for dtype, settings in (
                *((dtype, {}) for dtype in types), ("uint16", {"bigtiff": True}),
                ("uint16", {"byteorder": ">"}), ("uint16", {"tile": (16, 16)}),
                ("uint16", {"rowsperstrip": 7}), ("uint16", {"compression": "deflate"}),
                ("uint16", {"compression": "deflate", "predictor": True, "tile": (16, 32)})):
            path = self.write(make_values(dtype), **GRAY, **settings)
            self.assert_volume(path, tifffile.imread(path), UNIT, words="has no voxel size: 1 mm is assumed")
        values = make_values(size=(1, 20, 30))
        self.assert_volume(self.write(values, **GRAY), values, UNIT)

    def test_components(self):
        """Colours and alpha are components; luminance is made of three."""
        for count, settings in ((3, {"photometric": "rgb"}), (5, {"photometric": "minisblack"}),
                                (2, {"photometric": "minisblack", "extrasamples": ["unassalpha"]})):
            for dtype in ("uint8", "uint16"):
                values = make_values(dtype, (9, 20, 30, count))
                path = self.write(values, planarconfig="contig", metadata=None, **settings)
                for n in range(count):
                    self.assert_volume(path, values[..., n], UNIT, "--component", n + 1,
                                       words=f"component {n + 1} of {count}")
        values = make_values(size=(9, 20, 30, 3))
        path = self.write(values, photometric="rgb", metadata=None, tile=(16, 16))
        self.assert_volume(path, values @ [0.299, 0.587, 0.114], UNIT, "--component", "luminance")

    def test_refused_tags(self):
        palette = {"photometric": "palette", "colormap": numpy.zeros((3, 256), numpy.uint16)}
        planar = {"photometric": "rgb", "planarconfig": "separate"}
        for dtype, size, settings, patch, words in (
                ("uint16", (), {"photometric": "miniswhite"}, (), "page 1 has PhotometricInterpretation = 0, which"),
                ("uint8", (), palette, (), "PhotometricInterpretation = 3"),
                ("uint16", (3,), planar, (), "PlanarConfiguration = 2"),
                ("float16", (), {}, (), "SampleFormat = 3 (float) and BitsPerSample = 16"),
                ("complex64", (), {}, (), "SampleFormat = 6"), ("uint8", (), {}, (258, 4), "BitsPerSample = 4"),
                ("uint16", (), {}, (259, 34712), "Compression = 34712, which is not supported; save")):
            path = self.write(make_values(dtype, (9, *size, 20, 30)), **{**GRAY, **settings})
            self.assert_refused(self.patch(path, *patch) if patch else path, words=words)

    def test_other_pages(self):
        """Reduced copies are left out; other pages that differ are refused."""
        def write(pages):
            with tifffile.TiffWriter(self.path("a.tif")) as file:
                for page, kind in pages:
                    file.write(page, subfiletype=kind, **GRAY)
            return self.path("a.tif")
        values = make_values()
        path = write((part, kind) for page in values for part, kind in ((page, 0), (page[::4, ::4], 1)))
        self.assert_volume(path, values, UNIT)
        for other, words in ((values[0].astype("uint8"), "page 2 has BitsPerSample = 8, which is not supported"),
                             (values[0].astype("int16"), "SampleFormat = 2"),
                             (values[0, :, :20], "ImageWidth = 20"), (values[0, :10], "ImageLength = 10")):
            self.assert_refused(write([(values[0], 0), (other, 0)]), words=words)

    def test_damaged(self):
        for settings in ({}, {"compression": "deflate"}):
            path = self.write(make_values(), **GRAY, **settings)
            data = splatmip.read_file(path)
            for part in (0, 0.01, 0.5, 0.95):
                content = data[:int(part * len(data))] or b"Not a picture." * 99
                self.assert_refused(splatmip.write_file(path, content), words="damaged, incomplete")

    def test_compressions(self):
        """What libtiff can compress, too; tifffile needs other packages to read that."""
        name = ctypes.util.find_library("tiff")
        if not name:
            self.skipTest("skipped: no libtiff")
        library = ctypes.CDLL(name)
        library.TIFFOpen.restype = ctypes.c_void_p
        values = make_values()
        for number in (1, 5, 32773, 34925, 50000):  # none, LZW, PackBits, LZMA, Zstandard
            if not library.TIFFIsCODECConfigured(number):
                continue
            file = ctypes.c_void_p(library.TIFFOpen(self.path("c.tif").encode(), b"w"))
            for page in values:
                for tag, value in ((256, 30), (257, 20), (258, 16), (277, 1), (262, 1), (278, 7),
                                   (259, number)):
                    library.TIFFSetField(file, tag, value)
                for n, row in enumerate(page):
                    library.TIFFWriteScanline(
                        file, row.ctypes.data_as(ctypes.c_void_p), n, 0)
                library.TIFFWriteDirectory(file)
            library.TIFFClose(file)
            self.assert_volume(self.path("c.tif"), values, UNIT)


class TestDescriptions(TIFFTest):
    def check_all(self, path, axes):
        """Each channel and time."""
        values = make_axes(axes)
        for channel, time in numpy.ndindex(SIZES["C"] if "C" in axes else 1, SIZES["T"] if "T" in axes else 1):
            arguments = ["--channel", channel + 1] if "C" in axes else []
            arguments += ["--frame", time + 1] if "T" in axes else []
            part = values[tuple({"C": channel, "T": time}.get(axis, slice(None)) for axis in axes)]
            self.assert_volume(path, part, PLACES, *arguments, words="unit of length is um; lengths here are in mm")

    def write_imagej(self, axes, unit="um", **settings):
        return self.write(make_axes(axes), imagej=True, resolution=(4, 2),
                          metadata={"axes": axes, "spacing": 2.0, "unit": unit}, **settings)

    def test_imagej(self):
        for axes, settings in (("ZYX", {}), ("ZCYX", {}), ("TZYX", {}), ("TZCYX", {"compression": "deflate"}),
                               ("TZCYX", {})):
            path = self.write_imagej(axes, **settings)
            with tifffile.TiffFile(path) as file:
                self.assertTrue(file.is_imagej)
            self.check_all(path, axes)
        self.assertIn("channel 2 of 3 (--channel chooses)", self.project(path, "--channel", "2")[2])
        self.assert_refused(path, "--channel", "4", words="there is no channel 4 here, only 3")
        self.assert_refused(path, "--frame", "3", words="there is no volume 3 here, only 2")

    def test_imagej_one_page(self):
        """The pictures follow each other behind the only page, of either byte order."""
        values = make_values(size=(24, 20, 30))
        for order in "<>":
            path = self.write(values[:1], byteorder=order, resolution=(4, 2), **GRAY, description=(
                "ImageJ=1.53\nimages=24\nslices=24\nunit=micron\nspacing=2.0\n"))
            offset = tifffile.TiffFile(path).pages[0].dataoffsets[0]
            data = splatmip.read_file(path)
            self.assertEqual(offset + 1200, len(data))
            splatmip.write_file(path, data[:offset] + values.astype(order + "u2").tobytes())
            self.assert_volume(path, values, PLACES)
            splatmip.write_file(path, data[:offset] + values.tobytes()[:-100])
            self.assert_refused(path, words="damaged, incomplete")

    def test_units(self):
        for unit, length in (("pixel", None), ("\\u00B5m", 1e-3), ("mm", 1), ("cm", 10), ("inch", 25.4)):
            places = PLACES * 1e3 * length if length else UNIT
            text = self.assert_volume(self.write_imagej("ZYX", unit), make_axes("ZYX"), places)
            self.assertEqual("no voxel size" in text, length is None)

    def test_ome(self):
        for axes in ("ZYX", "CZYX", "TCZYX", "TZCYX", "CTZYX", "ZCTYX"):
            path = self.write(make_axes(axes), photometric="minisblack", ome=True, metadata={
                "axes": axes, "PhysicalSizeX": 0.25, "PhysicalSizeXUnit": "\u00b5m",
                "PhysicalSizeY": 0.5, "PhysicalSizeYUnit": "\u00b5m",
                "PhysicalSizeZ": 2.0, "PhysicalSizeZUnit": "\u00b5m"})
            with tifffile.TiffFile(path) as file:
                self.assertTrue(file.is_ome)
            self.check_all(path, axes)

    def write_ome(self, content, **changes):
        attributes = {"DimensionOrder": "XYZCT", "SizeZ": 4, "SizeC": 1, "SizeT": 1, "PhysicalSizeX": 0.25,
                      "PhysicalSizeY": 0.5, "PhysicalSizeZ": 2, **changes}
        words = " ".join(f'{name}="{value}"' for name, value in attributes.items())
        return self.write(make_axes("ZYX"), **GRAY, description=(
            '<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06">'
            f'<Image ID="Image:0"><Pixels ID="Pixels:0" Type="uint16" {words}>{content}</Pixels></Image></OME>'))

    def test_ome_pages(self):
        """The description says which page is which."""
        values, order = make_axes("ZYX"), (2, 0, 3, 1)
        data = "".join(f'<TiffData FirstZ="{z}" IFD="{page}"/>' for z, page in enumerate(order))
        for content, expected in ((data, values[list(order)]), ("<TiffData/>", values), ("", values)):
            self.assert_volume(self.write_ome(content), expected, PLACES)
        files = "".join(f'<TiffData FirstZ="{z}" IFD="0"><UUID FileName="{z}.tif"/></TiffData>' for z in range(4))
        self.assert_refused(self.write_ome(files), words="its planes are in several files, which is not supported")

    def test_damaged_descriptions(self):
        """Counts that do not fit, are too large to multiply, or are no numbers."""
        differs = "its description and its pages differ: "
        for content, changes, words in (
                ('<TiffData IFD="9" FirstZ="3"/>', {}, differs), ('<TiffData FirstZ="1" IFD="0"/>', {}, differs),
                ('<TiffData IFD="2147483647" PlaneCount="2"/>', {}, differs),
                ('<TiffData FirstZ="99999999999"/><TiffData FirstT="-5" FirstC="7"/>', {"SizeZ": 5}, differs),
                ("", {"SizeC": 65536, "SizeT": 65536, "SizeZ": 65536}, differs),
                ("<TiffData/>", {"DimensionOrder": "XYQQQ", "SizeT": 3, "SizeZ": 1}, "its OME description is damaged"),
                ("<TiffData/>", {"DimensionOrder": "Z"}, "its OME description is damaged"),
                ("", {"PhysicalSizeXUnit": "mm", "PhysicalSizeZUnit": "nm"}, "different units of length")):
            self.assert_refused(self.write_ome(content, **changes), words=words)
        for text in ("channels=65536\nframes=65536\n", "channels=nan\nslices=99999999999999999999\n",
                     "images=2147483647\nchannels=2147483647\n"):
            path = self.write(make_axes("ZYX"), description="ImageJ=1.53\n" + text, **GRAY)
            self.assert_refused(path, words=differs)


if __name__ == "__main__":
    splatmip.main()
