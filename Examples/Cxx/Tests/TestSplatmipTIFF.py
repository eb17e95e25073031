# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""TIFF stacks: the values that tifffile finds, at the size that the description gives, or a refusal
that names tag and value.
"""
import ctypes
import ctypes.util
import struct
import unittest

import numpy

import SplatmipTesting as splatmip

try:
    import tifffile
except ImportError:
    tifffile = None

UNIT = numpy.eye(3, 4)


def make_values(dtype=numpy.uint16, size=(9, 20, 30), seed=0):
    return numpy.random.default_rng(seed).integers(0, 250, size).astype(dtype)


@unittest.skipUnless(tifffile, "skipped: no tifffile")
class TestTIFF(splatmip.SplatmipTest):
    def write(self, values, name="a.tif", **settings):
        tifffile.imwrite(self.path(name), values, **settings)
        return self.path(name)

    def check(self, path, values=None, places=UNIT, *arguments):
        values = tifffile.imread(path) if values is None else values
        return self.assert_volume(path, values, places, *arguments)

    def patch(self, path, tag, value):
        """Change a short number in all pages."""
        with open(path, "r+b") as file:
            data = bytearray(file.read())
            place = struct.unpack_from("<I", data, 4)[0]
            while place:
                count = struct.unpack_from("<H", data, place)[0]
                for n in range(count):
                    entry = place + 2 + 12 * n
                    if struct.unpack_from("<H", data, entry)[0] == tag:
                        struct.pack_into("<HIHH", data, entry + 2, 3, 1, value, 0)
                place = struct.unpack_from("<I", data, place + 2 + 12 * count)[0]
            file.seek(0)
            file.write(data)
        return path

    def test_types(self):
        """The first row is at the front, the first page at the feet."""
        for dtype in ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64"):
            path = self.write(make_values(dtype), photometric="minisblack", metadata=None)
            text = self.check(path)
            self.assertIn("TIFF does not say how large voxels are", text)
        self.check(self.write(make_values(), name="a.tiff", bigtiff=True, photometric="minisblack"))
        self.check(self.write(make_values(), byteorder=">", photometric="minisblack"))

    def test_layouts(self):
        """Tiles, strips, compression and single pages."""
        settings = [{"tile": (16, 16)}, {"rowsperstrip": 7}, {"compression": "deflate"},
                    {"compression": "deflate", "predictor": True, "tile": (16, 32)}]
        for more in settings:
            self.check(self.write(make_values(), photometric="minisblack", **more))
        self.check(self.write(make_values(size=(1, 20, 30)), photometric="minisblack"),
                   make_values(size=(1, 20, 30)))

    def test_components(self):
        """Colours, contiguous or planar, and alpha are components; luminance is made of three."""
        for size, settings in (((9, 20, 30, 3), {"photometric": "rgb"}),
                               ((9, 20, 30, 2), {"photometric": "minisblack",
                                                 "planarconfig": "contig",
                                                 "extrasamples": ["unassalpha"]}),
                               ((9, 20, 30, 5), {"photometric": "minisblack",
                                                 "planarconfig": "contig"})):
            for dtype in ("uint8", "uint16"):
                values = make_values(dtype, size)
                path = self.write(values, metadata=None, **settings)
                for n in range(size[3]):
                    text = self.check(path, values[..., n], UNIT, "--component", str(n + 1))
                    self.assertIn(f"component {n + 1} of {size[3]}", text)
        planar = make_values("uint16", (9, 3, 20, 30))
        for more in ({}, {"tile": (16, 16)}):
            path = self.write(planar, photometric="rgb", planarconfig="separate", metadata=None, **more)
            self.check(path, planar[:, 1], UNIT, "--component", "2")
        luminance = numpy.tensordot(planar.astype(float), [0.299, 0.587, 0.114], ([1], [0]))
        self.check(path, luminance, UNIT, "--component", "luminance")

    def test_refused_tags(self):
        gray = {"photometric": "minisblack", "metadata": None}
        path = self.write(make_values(), photometric="miniswhite", metadata=None)
        self.assert_refused(path, word="page 1 has PhotometricInterpretation = 0, which is not sup")
        path = self.write(make_values("uint8"), photometric="palette", metadata=None,
                          colormap=numpy.zeros((3, 256), numpy.uint16))
        self.assert_refused(path, word="PhotometricInterpretation = 3")
        path = self.write(make_values("float16"), **gray)
        self.assert_refused(path, word="SampleFormat = 3 (float) and BitsPerSample = 16")
        path = self.write(make_values("complex64"), **gray)
        self.assert_refused(path, word="SampleFormat = 6")
        path = self.patch(self.write(make_values("uint8"), **gray), 258, 4)
        self.assert_refused(path, word="BitsPerSample = 4")
        path = self.patch(self.write(make_values(), **gray), 259, 34712)  # JPEG 2000
        self.assert_refused(path, word="Compression = 34712, which is not supported; save")

    def test_other_pages(self):
        """Reduced copies are left out; other pages that differ are refused."""
        path = self.path("a.tif")
        with tifffile.TiffWriter(path) as file:
            for page in make_values():
                file.write(page, photometric="minisblack", metadata=None)
                file.write(page[::4, ::4], photometric="minisblack", subfiletype=1, metadata=None)
        self.check(path, make_values())
        for other, word in ((make_values("uint8")[0], "page 2 has BitsPerSample = 8, which is not "
                                                      "supported; the first page has 16"),
                            (make_values("int16")[0], "SampleFormat = 2"),
                            (make_values()[0, :, :20], "ImageWidth = 20"),
                            (make_values()[0, :10], "ImageLength = 10")):
            with tifffile.TiffWriter(path) as file:
                for page in (make_values()[0], other):
                    file.write(page, photometric="minisblack", metadata=None)
            self.assert_refused(path, word=word)

    def test_damaged(self):
        for settings in ({}, {"compression": "deflate"}):
            path = self.write(make_values(), photometric="minisblack", metadata=None, **settings)
            with open(path, "rb") as file:
                data = file.read()
            for part in (0.01, 0.5, 0.95):
                splatmip.write_file(path, data[:int(part * len(data))])
                self.assert_refused(path, word="damaged, incomplete or not TIFF")
        self.assert_refused(splatmip.write_file(path, b"Not a picture." * 99), word="not TIFF")

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
            self.check(self.path("c.tif"), values)


@unittest.skipUnless(tifffile, "skipped: no tifffile")
class TestDescriptions(splatmip.SplatmipTest):
    PLACES = numpy.array([[0.25, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 2, 0.0]]) * 1e-3
    SIZES = {"Z": 4, "C": 3, "T": 2, "Y": 20, "X": 30}

    def make(self, axes):
        return make_values(size=tuple(self.SIZES[axis] for axis in axes))

    def check_all(self, path, values, axes, places):
        """Each channel and time."""
        for channel in range(self.SIZES["C"] if "C" in axes else 1):
            for time in range(self.SIZES["T"] if "T" in axes else 1):
                arguments = ["--channel", str(channel + 1)] if "C" in axes else []
                arguments += ["--frame", str(time + 1)] if "T" in axes else []
                part = values[tuple({"C": channel, "T": time}.get(axis, slice(None))
                                    for axis in axes)]
                text = self.assert_volume(path, part, places, *arguments)
        return text

    def write_imagej(self, axes, **settings):
        path = self.path("a.tif")
        tifffile.imwrite(path, self.make(axes), imagej=True, resolution=(4, 2),
                         metadata={"axes": axes, "spacing": 2.0, "unit": "um"}, **settings)
        return path

    def test_imagej(self):
        for axes in ("ZYX", "ZCYX", "TZYX", "TZCYX"):
            path = self.write_imagej(axes)
            with tifffile.TiffFile(path) as file:
                self.assertTrue(file.is_imagej)
            text = self.check_all(path, self.make(axes), axes, self.PLACES)
            self.assertIn("the file's unit of length is um; lengths here are in mm\n", text)
        self.assert_refused(path, "--channel", "4", word="there is no channel 4 here, only 3")
        self.assert_refused(path, "--frame", "3", word="there is no volume 3 here, only 2")
        self.assertIn("channel 2 of 3 (--channel chooses)",
                      self.project(path, "--channel", "2")[2])

    def test_imagej_pages(self):
        """A page for each picture, as ImageJ writes for compressed data."""
        self.check_all(self.write_imagej("TZCYX", compression="deflate"), self.make("TZCYX"),
                       "TZCYX", self.PLACES)

    def test_imagej_one_page(self):
        """The pictures follow each other behind the only page, of either byte order."""
        for order in "<>":
            values = make_values(size=(24, 20, 30))
            path = self.path("b.tif")
            tifffile.imwrite(path, values[:1], photometric="minisblack", metadata=None,
                             byteorder=order, description="ImageJ=1.53\nimages=24\nslices=24\n"
                             "unit=micron\nspacing=2.0\n", resolution=(4, 2))
            with open(path, "rb") as file:
                data = file.read()
            offset = tifffile.TiffFile(path).pages[0].dataoffsets[0]
            self.assertEqual(offset + 1200, len(data))
            splatmip.write_file(path, data[:offset] + values.astype(order + "u2").tobytes())
            self.assert_volume(path, values, self.PLACES)
            splatmip.write_file(path, data[:offset] + values.tobytes()[:-100])
            self.assert_refused(path, word="damaged, incomplete")

    def test_imagej_units(self):
        for unit, length in (("pixel", None), ("\\u00B5m", 1e-3), ("mm", 1), ("cm", 10), ("inch", 25.4)):
            path = self.path("a.tif")
            tifffile.imwrite(path, self.make("ZYX"), imagej=True, resolution=(4, 2),
                             metadata={"axes": "ZYX", "spacing": 2.0, "unit": unit})
            places = self.PLACES * 1e3 * length if length else UNIT
            text = self.assert_volume(path, self.make("ZYX"), places)
            self.assertEqual("voxels are and how" in text, length is None)

    def test_ome(self):
        for axes in ("ZYX", "CZYX", "TCZYX", "TZCYX", "CTZYX", "ZCTYX"):
            path = self.path("a.ome.tif")
            tifffile.imwrite(path, self.make(axes), photometric="minisblack", metadata={
                "axes": axes, "PhysicalSizeX": 0.25, "PhysicalSizeXUnit": "\u00b5m",
                "PhysicalSizeY": 0.5, "PhysicalSizeYUnit": "\u00b5m",
                "PhysicalSizeZ": 2.0, "PhysicalSizeZUnit": "\u00b5m"})
            with tifffile.TiffFile(path) as file:
                self.assertTrue(file.is_ome)
            self.check_all(path, self.make(axes), axes, self.PLACES)

    def test_ome_pages(self):
        """The description says which page is which; planes that are in no page are refused."""
        xml = ('<?xml version="1.0"?><OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06">'
               '<Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" Type="uint16" '
               'SizeX="30" SizeY="20" SizeZ="4" SizeC="1" SizeT="1" PhysicalSizeX="0.25" '
               'PhysicalSizeY="0.5" PhysicalSizeZ="2"><Channel ID="Channel:0:0"/>{}</Pixels></Image>'
               '</OME>')
        values = self.make("ZYX")
        order = (2, 0, 3, 1)
        data = "".join(f'<TiffData FirstZ="{z}" IFD="{page}"/>' for z, page in enumerate(order))
        path = self.path("a.tif")
        for text, expected in ((data, values[list(order)]), ("<TiffData/>", values), ("", values)):
            tifffile.imwrite(path, values, photometric="minisblack", metadata=None,
                             description=xml.format(text))
            self.assert_volume(path, expected, self.PLACES)
        for text in (data.replace('IFD="3"', 'IFD="9"'), '<TiffData FirstZ="1" IFD="0"/>'):
            tifffile.imwrite(path, values, photometric="minisblack", metadata=None,
                             description=xml.format(text))
            self.assert_refused(path, word="its description and its pages differ: 4 slices, 1 channels")

    def test_channel_of_others(self):
        self.assert_refused(splatmip.write_nrrd(self.path("a.nrrd")), "--channel", "1",
                            word="this is not TIFF and has no channels")


if __name__ == "__main__":
    splatmip.main()
