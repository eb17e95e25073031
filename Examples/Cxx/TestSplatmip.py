# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the program splatmip on good and bad input.

    python3 TestSplatmip.py PROGRAM [--dicom] [unittest's arguments]

--dicom tells that the program was built with vtk-dicom.
"""
import gzip
import itertools
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = ""
HAS_DICOM = False
SIZE = (10, 12, 14)


def make_image(x_of_left=1):
    """A dark image, coordinates as the patient's, with a bright block at the left and the feet."""
    image = vtk.vtkImageData()
    image.SetDimensions(*SIZE)
    image.SetSpacing(1.5, 1.0, 2.0)
    image.AllocateScalars(vtk.VTK_SHORT, 1)
    image.GetPointData().GetScalars().SetName("intensity")
    image.GetPointData().GetScalars().Fill(0)
    for k in range(1, 5):
        for j in range(4, 8):
            for i in range(1, 4):
                x = SIZE[0] - 1 - i if x_of_left else i
                image.SetScalarComponentFromDouble(x, j, k, 0, 1000)
    return image


def get_bytes(image):
    return bytes(memoryview(image.GetPointData().GetScalars()))


def write_with(writer, image, path):
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.Write()
    return path


def write_file(path, data):
    with open(path, "wb") as file:
        file.write(data)
    return path


def write_vti(path):
    return write_with(vtk.vtkXMLImageDataWriter(), make_image(), path)


def write_vtk(path):
    return write_with(vtk.vtkDataSetWriter(), make_image(), path)


def write_meta(path):
    """A .mha file, or a .mhd file with the voxels in a file of its own."""
    return write_with(vtk.vtkMetaImageWriter(), make_image(), path)


def write_nifti(path):
    """NIfTI counts x to the patient's right."""
    return write_with(vtk.vtkNIFTIImageWriter(), make_image(x_of_left=0), path)


def write_nrrd(path, encoding="raw", space="left-posterior-superior", x_of_left=1,
               directions="(1.5,0,0) (0,1,0) (0,0,2)"):
    data = get_bytes(make_image(x_of_left))
    data = gzip.compress(data) if encoding == "gzip" else data
    header = f"""NRRD0004
type: short
dimension: 3
space: {space}
sizes: {SIZE[0]} {SIZE[1]} {SIZE[2]}
space directions: {directions}
kinds: domain domain domain
endian: little
encoding: {encoding}
"""
    if path.endswith(".nhdr"):
        write_file(path + ".raw", data)
        return write_file(path, (header + f"data file: {os.path.basename(path)}.raw\n").encode())
    return write_file(path, header.encode() + b"\n" + data)


def dicom_element(group, element, vr, value):
    """One data element, explicit VR little endian."""
    if isinstance(value, str):
        value = value.encode()
    value += (b"\0" if vr in ("UI", "OW") else b" ") * (len(value) % 2)
    form = "<HH2sxxI" if vr in ("OB", "OW") else "<HH2sH"
    return struct.pack(form, group, element, vr.encode(), len(value)) + value


def dicom_slice(image, k):
    """A CT slice as a DICOM file; rows run to the left, columns to the back."""
    number = struct.Struct("<H").pack
    ct_storage, root = "1.2.840.10008.5.1.4.1.1.2", "1.2.826.0.1.3680043.9.9999"
    pixels = SIZE[0] * SIZE[1] * 2
    elements = [
        (0x0008, 0x0016, "UI", ct_storage), (0x0008, 0x0018, "UI", f"{root}.3.{k + 1}"),
        (0x0008, 0x0060, "CS", "CT"), (0x0020, 0x000D, "UI", root + ".1"),
        (0x0020, 0x000E, "UI", root + ".2"), (0x0020, 0x0013, "IS", str(k + 1)),
        (0x0020, 0x0032, "DS", f"0\\0\\{2.0 * k}"), (0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0"),
        (0x0028, 0x0002, "US", number(1)), (0x0028, 0x0004, "CS", "MONOCHROME2"),
        (0x0028, 0x0010, "US", number(SIZE[1])), (0x0028, 0x0011, "US", number(SIZE[0])),
        (0x0028, 0x0030, "DS", "1\\1.5"), (0x0028, 0x0100, "US", number(16)),
        (0x0028, 0x0101, "US", number(16)), (0x0028, 0x0102, "US", number(15)),
        (0x0028, 0x0103, "US", number(1)),
        (0x7FE0, 0x0010, "OW", get_bytes(image)[k * pixels:(k + 1) * pixels])]
    meta = b"".join(dicom_element(*item) for item in [
        (0x0002, 0x0001, "OB", b"\0\1"), (0x0002, 0x0002, "UI", ct_storage),
        (0x0002, 0x0003, "UI", f"{root}.3.{k + 1}"),
        (0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1")])
    length = dicom_element(0x0002, 0x0000, "UL", struct.pack("<I", len(meta)))
    return b"\0" * 128 + b"DICM" + length + meta + b"".join(dicom_element(*e) for e in elements)


def write_dicom(folder):
    os.makedirs(folder)
    image = make_image()
    for k in range(SIZE[2]):
        write_file(os.path.join(folder, f"{SIZE[2] - k:03}.dcm"), dicom_slice(image, k))
    return folder


def read_picture(reader, path):
    """Rows from the top, of pixels of three colours."""
    reader.SetFileName(path)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, 3)[::-1].astype(float)


def read_chunks(data):
    """All chunks of a RIFF file as pairs of name and content; lists are entered."""
    place = 0
    while place < len(data):
        name, size = struct.unpack_from("<4sI", data, place)
        content = data[place + 8:place + 8 + size]
        if name in (b"RIFF", b"LIST"):
            yield from read_chunks(content[4:])
        else:
            yield name, content
        place += 8 + size + size % 2


def double_length(plane, axis):
    """libjpeg's interpolation: three parts of the nearest sample and one of the next."""
    plane = numpy.moveaxis(plane, axis, 0)
    before = numpy.concatenate((plane[:1], plane[:-1]))
    after = numpy.concatenate((plane[1:], plane[-1:]))
    both = numpy.stack((3 * plane + before, 3 * plane + after), axis=1) / 4
    return numpy.moveaxis(both.reshape(-1, *plane.shape[1:]), 0, axis)


def halve_chroma(picture):
    """What JPEG with 4:2:0 keeps of a picture before anything is rounded."""
    to_ycbcr = numpy.array([[0.299, 0.587, 0.114], [-0.299 / 1.772, -0.587 / 1.772, 0.5],
                            [0.5, -0.587 / 1.402, -0.114 / 1.402]])
    planes = picture @ to_ycbcr.T
    height, width, _ = planes.shape
    even = numpy.pad(planes[..., 1:], ((0, height % 2), (0, width % 2), (0, 0)), "edge")
    chroma = even.reshape(len(even) // 2, 2, -1, 2, 2).mean(axis=(1, 3))
    planes[..., 1:] = double_length(double_length(chroma, 0), 1)[:height, :width]
    return numpy.clip(planes @ numpy.linalg.inv(to_ycbcr).T, 0, 255)


def bound_jpeg_errors(steps, size, has_colors):
    """The most that red, green and blue can be off, as root mean squares over a picture.

    A coefficient is off by at most 5/8 of its step (libavcodec rounds up from there on), and the
    transform keeps sums of squares. Blocks reach beyond the picture, so that all their error may
    lie in what is seen. Y is rounded before and after that, Cb and Cr also when halved and doubled,
    and the colours in the end.
    """
    seen = numpy.prod(size) / numpy.prod([(length + 15) // 16 * 16 for length in size])
    transformed = numpy.sqrt(numpy.mean((0.625 * steps) ** 2) / seen)
    chroma = has_colors * (transformed + 2.0)
    shares = numpy.array([1.402, (0.299 * 1.402 + 0.114 * 1.772) / 0.587, 1.772])
    return transformed + 1.5 + chroma * shares


class SplatmipTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def path(self, name):
        return os.path.join(self.scratch.name, name)

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=self.scratch.name, capture_output=True,
                              text=True, errors="replace", timeout=300, check=False)

    def draw(self, *arguments):
        """Run the program and return the picture, which it must have announced."""
        result = self.run_program(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        last = result.stdout.splitlines()[-1]
        self.assertTrue(last.startswith("picture: "), result.stdout)
        path = last[len("picture: "):]
        self.assertTrue(os.path.isabs(path))
        reader = vtk.vtkPNGReader()
        reader.SetFileName(path)
        reader.Update()
        return reader.GetOutput(), result.stdout

    def assert_refused(self, *arguments, word="", code=1):
        """One sentence on stderr, nothing else, and the exit status."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("splatmip: "), result.stderr)
        self.assertTrue(result.stderr.endswith(".\n"), result.stderr)
        self.assertIn(word, result.stderr)


class TestPictures(SplatmipTest):
    def test_default(self):
        picture, text = self.draw()
        self.assertEqual(picture.GetDimensions(), (1200, 600, 1))
        self.assertTrue(os.path.exists(self.path("splatmip.png")))
        self.assertIn("128 x 128 x 256", text)
        for mode in ("preview", "standard", "high"):
            self.assertRegex(text, rf"(?m)^{mode} .* ms .* ms \((nearest|linear)\)")

    def test_options(self):
        picture, text = self.draw(
            "--no-timing", "--mode", "high", "--kernel", "cosine-bell", "--kernel-radius", "1.25",
            "--azimuth", "-30", "--elevation", "90", "--roll", "15", "--window", "400", "--level",
            "-50", "--colormap", "inverted", "--size", "120x80", "--zoom", "2", "--output", "a.png")
        self.assertEqual(picture.GetDimensions(), (120, 80, 1))
        self.assertIn("window 400, level -50", text)
        self.assertNotIn(" ms", text)

    def test_modes(self):
        """Each mode shows the bright block where it is, and from aslant a picture of its own."""
        path = write_vti(self.path("a.vti"))

        def show(mode, *arguments):
            picture, text = self.draw(path, "--mode", mode, *arguments, "--size", "128x128",
                                      "--window", "1000", "--level", "500", "--output", "a.png")
            self.assertEqual(picture.GetDimensions(), (128, 128, 1))
            pixels = vtk_to_numpy(picture.GetPointData().GetScalars())
            return pixels.reshape(128, 128, -1)[:100, :, 0], text  # without the label

        pictures = set()
        for mode in ("preview", "standard", "high", "exact"):
            pixels, text = show(mode, "--azimuth", "0", "--elevation", "0")
            self.assertRegex(text, rf"(?m)^{mode} .* ms .* ms \((nearest|linear)\)")
            self.assertGreater(pixels[:50, 66:].max(), 250, mode)
            # A footprint and the warp reach 2.5 voxels beyond the block.
            self.assertEqual(pixels[:, :56].max(), 0, mode)
            self.assertEqual(pixels[66:, :].max(), 0, mode)
            pixels, text = show(mode, "--azimuth", "20", "--elevation", "10", "--no-timing")
            self.assertNotIn(" ms", text)
            self.assertGreater(pixels.max(), 250, mode)
            pictures.add(pixels.tobytes())
        self.assertEqual(len(pictures), 4)

    def test_version(self):
        result = self.run_program("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^splatmip \d+\.\d+\.\d+, VTK \d+\.\d+\.\d+\n$")


class TestTurns(SplatmipTest):
    def turn(self, *arguments):
        """Without a display; returns what was printed."""
        environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
        result = subprocess.run([PROGRAM, *arguments], cwd=self.scratch.name, capture_output=True,
                                text=True, timeout=300, check=False, env=environment)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertTrue(result.stdout.splitlines()[-1].startswith("turn: "), result.stdout)
        return result.stdout

    def read(self, name):
        reader = vtk.vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        return get_bytes(reader.GetOutput())

    def test_pictures(self):
        options = ("--size", "60x90", "--mode", "standard", "--azimuth", "0", "--elevation", "0")
        text = self.turn("--rotate", "8", "--out", "turn.png", *options)
        self.assertRegex(text, r"8 views of 60 x 90 in .* per second")
        names = sorted(os.listdir(self.scratch.name))
        self.assertEqual(names, [f"turn-{n:05}.png" for n in range(8)])
        pictures = [self.read(name) for name in names]
        self.assertEqual(len(set(pictures)), 8)
        # The view from behind is the mirror image of the front.
        width = 3 * 60
        rows = [pictures[0][n:n + width] for n in range(0, len(pictures[0]), width)]
        mirrored = b"".join(row[::-1] for row in rows)  # gray
        differences = [abs(a - b) for a, b in zip(mirrored, pictures[4])]
        self.assertLessEqual(max(differences), 1)
        # The first view is what the mapper shows; the turn is as large as fits from all sides.
        self.assertGreater(max(pictures[0]), 250)

    def test_gif(self):
        text = self.turn("--rotate", "4", "--size", "50x40", "--rate", "10", "--out", "turn.gif",
                         "--mode", "preview", "--colormap", "hot", "--no-timing")
        self.assertNotIn("per second", text)
        with open(self.path("turn.gif"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"GIF89a" + bytes([50, 0, 40, 0])))
        self.assertTrue(data.endswith(b";"))
        self.assertIn(b"NETSCAPE2.0", data)
        self.assertEqual(data.count(bytes([0x21, 0xF9, 4, 4, 10, 0])), 4)

    def test_film(self):
        self.turn("--rotate", "4", "--size", "64x48", "--output", "turn.ogv", "--mode", "preview")
        with open(self.path("turn.ogv"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"OggS"))
        self.assertIn(b"theora", data[:200])

    def read_avi(self, name, size, rate, views):
        """The pictures as JPEG, after a look at what players go by."""
        with open(self.path(name), "rb") as file:
            data = file.read()
        self.assertEqual(data[:12], struct.pack("<4sI4s", b"RIFF", len(data) - 8, b"AVI "))
        chunks = list(read_chunks(data))
        frames = [content for name, content in chunks if name == b"00dc"]
        self.assertEqual(len(frames), views)
        headers = dict(chunks)
        main = struct.unpack_from("<10I", headers[b"avih"])
        self.assertEqual((main[4], main[6], main[8:]), (views, 1, size))
        self.assertEqual(headers[b"strh"][:8], b"vidsMJPG")
        self.assertEqual(struct.unpack_from("<4I", headers[b"strh"], 20), (1, rate, 0, views))
        movie = data.index(b"movi")  # where the index, by which players jump, counts from
        for (_, _, place, length), frame in itertools.zip_longest(
                struct.iter_unpack("<4s3I", headers[b"idx1"]), frames):
            self.assertEqual(data[movie + place + 8:movie + place + 8 + length], frame)
        return frames

    def check_avi(self, colormap):
        size, views = (61, 47), 4
        options = ("--rotate", str(views), "--size", "61x47", "--rate", "10", "--mode", "standard",
                   "--colormap", colormap)
        self.turn("--out", "turn.avi", *options)
        self.turn("--out", "turn.png", *options)
        for n, frame in enumerate(self.read_avi("turn.avi", size, 10, views)):
            steps = numpy.frombuffer(frame, numpy.uint8, 64, frame.index(b"\xFF\xDB") + 5)
            self.assertLessEqual(max(steps), 83 // 8)  # libavcodec's finest
            found = read_picture(vtk.vtkJPEGReader(), write_file(self.path("frame.jpg"), frame))
            expected = read_picture(vtk.vtkPNGReader(), self.path(f"turn-{n:05}.png"))
            errors = numpy.sqrt(numpy.mean((found - halve_chroma(expected)) ** 2, axis=(0, 1)))
            bound = bound_jpeg_errors(steps, size, colormap != "gray")
            self.assertTrue((errors <= bound).all(), (colormap, n, errors, bound))

    def test_avi(self):
        self.check_avi("gray")
        self.check_avi("hot")

    def test_refusals(self):
        self.assert_refused("--rotate", "4", "--out", "turn.jpg", word=".gif", code=2)
        self.assert_refused("--rotate", "1", "--out", "turn.gif", code=2)
        self.assert_refused("--rotate", "4", "--interactive", word="--interactive", code=2)
        self.assert_refused("--out", "turn.gif", word=".png", code=2)
        os.symlink("/dev/full", self.path("full.avi"))
        for name in ("no/turn.gif", "no/turn.ogv", "no/turn.avi", "full.avi"):
            result = self.run_program("--rotate", "2", "--size", "16x16", "--out", name)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, rf"^splatmip: .*{name}: .* folder .*\.\n$")


class TestFormats(SplatmipTest):
    def check(self, path):
        """Seen from the front, left is right and the feet are at the bottom."""
        picture, _ = self.draw(path, "--no-timing", "--mode", "preview", "--size", "128x128",
                               "--azimuth", "0", "--elevation", "0", "--output", "a.png")
        self.assertEqual(picture.GetDimensions(), (128, 128, 1))

        def brightest(x, y):
            return max(picture.GetScalarComponentAsDouble(i, j, 0, 0)
                       for i in range(x, x + 62) for j in range(y, y + 50))
        self.assertGreater(brightest(66, 0), 200)
        self.assertLess(brightest(0, 0), 50)
        self.assertLess(brightest(66, 66), 50)

    def test_vti(self):
        self.check(write_vti(self.path("a.vti")))

    def test_vti_direction(self):
        image = make_image(x_of_left=0)
        image.SetDirectionMatrix(-1, 0, 0, 0, -1, 0, 0, 0, 1)
        self.check(write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti")))

    def test_legacy(self):
        self.check(write_vtk(self.path("a.vtk")))

    def test_meta(self):
        self.check(write_meta(self.path("a.mha")))
        self.check(write_meta(self.path("a.mhd")))

    def test_meta_orientation(self):
        data = get_bytes(make_image(x_of_left=0))
        header = f"""ObjectType = Image
NDims = 3
BinaryData = True
BinaryDataByteOrderMSB = False
TransformMatrix = -1 0 0 0 -1 0 0 0 1
Offset = 0 0 0
ElementSpacing = 1.5 1 2
DimSize = {SIZE[0]} {SIZE[1]} {SIZE[2]}
ElementType = MET_SHORT
ElementDataFile = LOCAL
"""
        self.check(write_file(self.path("a.mha"), header.encode() + data))

    def test_nrrd(self):
        self.check(write_nrrd(self.path("a.nrrd")))
        self.check(write_nrrd(self.path("b.nrrd"), encoding="gzip"))
        self.check(write_nrrd(self.path("c.nhdr")))

    def test_nrrd_orientation(self):
        self.check(write_nrrd(self.path("a.nrrd"), space="right-anterior-superior", x_of_left=0))
        self.check(write_nrrd(self.path("b.nrrd"), space="right-anterior-superior",
                              directions="(-1.5,0,0) (0,-1,0) (0,0,2)"))

    def test_nifti(self):
        self.check(write_nifti(self.path("a.nii")))
        self.check(write_nifti(self.path("a.nii.gz")))
        self.check(write_nifti(self.path("A.NII.GZ")))

    def test_dicom(self):
        folder = write_dicom(self.path("series"))
        if HAS_DICOM:
            self.check(folder)
            write_file(os.path.join(folder, "README.txt"), b"Not an image.")
            self.check(folder)
        else:
            self.assert_refused(folder, word="no DICOM reader")

    def test_components(self):
        image = make_image()
        colors = vtk.vtkImageAppendComponents()
        for _ in range(3):
            colors.AddInputData(image)
        colors.Update()
        self.check(write_with(
            vtk.vtkXMLImageDataWriter(), colors.GetOutput(), self.path("a.vti")))


class TestRefusals(SplatmipTest):
    def test_no_data(self):
        self.assert_refused("missing.vti", word="no such file")
        self.assert_refused("missing", word="no such file")
        self.assert_refused(write_file(self.path("empty.nrrd"), b""), word="empty")
        os.makedirs(self.path("folder"))
        self.assert_refused("folder", word="DICOM")

    def test_other_content(self):
        for suffix in ("vti", "vtk", "mha", "mhd", "nrrd", "nhdr", "nii", "nii.gz"):
            self.assert_refused(write_file(self.path("text." + suffix), b"Not a volume.\n" * 99))
        self.assert_refused(write_file(self.path("text.txt"), b"Not a volume."), word="unknown")
        sphere = vtk.vtkSphereSource()
        sphere.Update()
        self.assert_refused(
            write_with(vtk.vtkDataSetWriter(), sphere.GetOutput(), self.path("sphere.vtk")))

    def test_truncated(self):
        files = [write_vti(self.path("a.vti")), write_vtk(self.path("a.vtk")),
                 write_meta(self.path("a.mha")), write_nrrd(self.path("a.nrrd")),
                 write_nrrd(self.path("b.nrrd"), encoding="gzip"),
                 write_nifti(self.path("a.nii")), write_nifti(self.path("a.nii.gz"))]
        for path in files:
            with open(path, "rb") as file:
                data = file.read()
            for part in (0.1, 0.5, 0.9):
                self.assert_refused(write_file(path, data[:int(part * len(data))]))

    def test_truncated_companion(self):
        for path in (write_meta(self.path("a.mhd")), write_nrrd(self.path("a.nhdr"))):
            companion = self.path("a.zraw") if path.endswith(".mhd") else path + ".raw"
            with open(companion, "rb") as file:
                data = file.read()
            self.assert_refused(write_file(companion, data[:len(data) // 2]) and path)
            os.remove(companion)
            self.assert_refused(path)

    def test_truncated_dicom(self):
        folder = write_dicom(self.path("series"))
        for name in os.listdir(folder):
            path = os.path.join(folder, name)
            os.truncate(path, os.path.getsize(path) - 100)
        self.assert_refused(folder)

    def test_damaged_header(self):
        """Headers that VTK 9.1's readers, or vtk-dicom, do not return from."""
        def damage(path, old, new):
            with open(path, "rb") as file:
                data = file.read()
            self.assertIn(old, data)
            self.assert_refused(write_file(path, data.replace(old, new, 1)))
        damage(write_nrrd(self.path("a.nrrd")), b"sizes: 10 12 14", b"sizes: 10 12\0 14")
        damage(write_nrrd(self.path("a.nrrd")), b"sizes: 10 12 14\n", b"")
        damage(write_nrrd(self.path("a.nhdr")), b".raw\n", b".raw")
        damage(write_nrrd(self.path("a.nhdr")), b"a.nhdr.raw", b"a%s%s%s.raw 1 9 0")
        damage(write_meta(self.path("a.mha")), b"NDims = 3", b"NDims = 99999")
        damage(write_nifti(self.path("a.nii")),
               struct.pack("<2H", 4, 16), struct.pack("<2H", 10, 16))

    def test_damaged_dicom(self):
        folder = write_dicom(self.path("series"))
        with open(os.path.join(folder, "001.dcm"), "ab") as file:
            file.write(b"\0" * 8)
        self.assert_refused(folder)

    def test_huge_header(self):
        self.assert_refused(write_file(
            self.path("a.nrrd"), b"NRRD0004\ntype: short\ndimension: 3\n"
            b"sizes: 100000 100000 100000\nencoding: raw\n\nxx"), word="memory")

    def test_no_point_scalars(self):
        image = vtk.vtkImageData()
        image.SetDimensions(*SIZE)
        self.assert_refused(write_with(
            vtk.vtkXMLImageDataWriter(), image, self.path("a.vti")), word="point data")

    def test_no_numbers(self):
        """Of NaN alone there is no picture; a few numbers among a million are found."""
        image = vtk.vtkImageData()
        image.SetDimensions(160, 160, 160)
        image.AllocateScalars(vtk.VTK_FLOAT, 1)
        scalars = image.GetPointData().GetScalars()
        scalars.SetName("intensity")
        scalars.Fill(float("nan"))
        path = write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti"))
        self.assert_refused(path, word="no finite value")
        self.assert_refused(path, "--rotate", "2", "--out", "turn.png", word="no finite value")
        self.assertEqual(os.listdir(self.scratch.name), ["a.vti"])
        scalars.SetValue(160 ** 3 // 2 + 1, 7.0)
        write_with(vtk.vtkXMLImageDataWriter(), image, path)
        _, text = self.draw(path, "--no-timing", "--mode", "preview", "--size", "50x50")
        self.assertIn("level 7\n", text)

    def test_options(self):
        self.assert_refused("--mode", "best", code=2)
        self.assert_refused("--size", "12", code=2)
        self.assert_refused("--window", "-1", code=2)
        self.assert_refused("--output", "picture.jpg", code=2)
        self.assert_refused("--unknown", code=2)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    if "--dicom" in sys.argv:
        sys.argv.remove("--dicom")
        HAS_DICOM = True
    unittest.main()
