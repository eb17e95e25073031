# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM series, sound ones and others: what is shown lies where the files say, or nothing is."""
import math
import os
import shutil
import subprocess

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk

import DICOMFiles as dicom
import SplatmipTesting as splatmip


def make_image(values, spacing=(1.5, 1.0, 2.0)):
    """Of an array of slices of rows."""
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(*spacing)
    scalars = numpy_to_vtk(values.ravel(), deep=True)
    scalars.SetName("intensity")
    image.GetPointData().SetScalars(scalars)
    return image


def make_wedge(slices=14):
    """A block whose values rise from the feet to the head: to interpolate it linearly is exact."""
    values = numpy.zeros((slices, 12, 10), numpy.int16)
    values[:, 4:8, 6:9] = 60 * numpy.arange(1, slices + 1)[:, None, None]
    return values


def as_unsigned(fields, values):
    fields.update(PixelRepresentation=0, PixelData=values.astype(numpy.uint16).tobytes())


class DICOMTest(splatmip.SplatmipTest):
    def setUp(self):
        super().setUp()
        self.folder = self.path("series")
        self.slices = dicom.make_slices(make_image(make_wedge()))

    def name(self, k):
        return os.path.join(self.folder, dicom.name_of(k))

    def write(self, slices=None):
        return dicom.write_series(self.folder, self.slices if slices is None else slices)

    def show(self, path, *arguments, azimuth=0, window=840):
        """The front, without the label, and the text; gray 255 is 840, the wedge's largest."""
        pixels, text = self.draw(
            path, "--mode", "high", "--size", "128x128", "--azimuth", str(azimuth), "--elevation",
            "0", "--window", str(window), "--level", str(window / 2), "--output", "a.png",
            "--no-marks", *arguments)
        return pixels[24:, :, 0], text

    def show_expected(self, values=None, spacing=(1.5, 1.0, 2.0), **options):
        image = make_image(make_wedge() if values is None else values, spacing)
        path = splatmip.write_with(
            vtk.vtkXMLImageDataWriter(), image, self.path("expected.vti"))
        return self.show(path, **options)[0]

    def assert_right(self, path, *arguments, **options):
        """The picture is that of the wedge; values are rounded once. Returns the text."""
        pixels, text = self.show(path, *arguments)
        expected = self.show_expected(**options)
        self.assertGreater(expected.max(), 50)
        self.assertLessEqual(abs(pixels - expected).max(), 1)
        return text


class TestGeometry(DICOMTest):
    def test_sound(self):
        text = self.assert_right(self.write())
        self.assertEqual(len(text.splitlines()), 4, text)
        splatmip.write_file(self.path("series/README.txt"), b"Not an image.")
        self.assert_right(self.folder)

    def test_origin(self):
        for fields in self.slices:
            place = fields["ImagePositionPatient"]
            fields["ImagePositionPatient"] = (12, -34, 56 + place[2])
        self.assert_center(self.write(), [18.75, -28.5, 69])

    def test_missing(self):
        """What is missing is interpolated, and told in the text and in the picture."""
        whole, _ = self.draw(self.write(), "--mode", "high", "--output", "a.png")
        for k in (5, 6, 7):
            os.remove(self.name(k))
        text = self.assert_right(self.folder)
        self.assertIn("10 x 12 x 14", text)
        self.assertIn(f"3 slices are missing and were interpolated: 3 between {self.name(4)} at "
                      f"(0, 0, 8) mm and {self.name(8)} at (0, 0, 16) mm\n", text)
        told, _ = self.draw(self.folder, "--mode", "high", "--output", "a.png")
        self.assertGreater((told[:60, :200] != whole[:60, :200]).sum(), 100)
        self.run_program(self.folder, "--rotate", "2", "--size", "400x600", "--out", "t.png")
        turned = splatmip.read_picture(vtk.vtkPNGReader(), self.path("t-00000.png"))
        self.assertEqual(turned[:60, :200].max(), 255)

    def test_changed_spacing(self):
        self.slices = self.slices[:7] + self.slices[8::2]
        text = self.assert_right(self.write(), values=make_wedge(13))
        self.assertIn("the slices are 2 to 4 mm apart and were interpolated to 2 mm; their "
                      f"distance changes from 2 to 4 mm at {self.name(6)}", text)

    def test_rounded_positions(self):
        """Places within a tenth of a slice are even: nothing is interpolated."""
        for k, fields in enumerate(self.slices[1:-1], 1):
            fields["ImagePositionPatient"] = (0, 0, 2 * k + (0.15, -0.15)[k % 2])
        text = self.assert_right(self.write())
        self.assertNotIn("interpolated", text)

    def test_too_uneven(self):
        self.slices[3]["ImagePositionPatient"] = (0, 0, 4.05)
        self.assert_refused(self.write(), word="too uneven")
        self.assert_refused(self.folder, word=f"{self.name(2)}: this slice, at (0, 0, 4) mm")
        self.assert_refused(self.folder, word=f"{self.name(3)} at (0, 0, 4.05) mm")

    def test_shifted(self):
        for k in (0, 6, 13):
            slices = dicom.make_slices(make_image(make_wedge()))
            slices[k]["ImagePositionPatient"] = (0, 3, 2 * k)
            other = dicom.name_of(k) if k else dicom.name_of(1)
            self.assert_refused(self.write(slices), word="is shifted sideways by 3 mm")
            self.assert_refused(self.folder, word=other)

    def test_no_position(self):
        self.slices[4].pop("ImagePositionPatient")
        self.assert_refused(self.write(), word=f"{self.name(4)}: this picture has no position")
        self.slices[4]["ImagePositionPatient"] = (0, 0, 8)
        self.slices[4].pop("PixelSpacing")
        self.assert_refused(self.write(), word=f"{self.name(4)}: this slice does not say how large")

    def test_tilt(self):
        """Each slice lies a row further back: the same block, sheared."""
        block = numpy.zeros((14, 12, 10), numpy.int16)
        block[:, 4:8, 6:9] = 840
        slices = dicom.make_slices(make_image(block))
        upright = numpy.zeros((14, 25, 10), numpy.int16)
        for k, fields in enumerate(slices):
            fields["ImagePositionPatient"] = (0, k, 2 * k)
            upright[k, k:k + 12] = block[k]
        pixels, _ = self.show(self.write(slices), azimuth=90)
        path = splatmip.write_with(
            vtk.vtkXMLImageDataWriter(), make_image(upright), self.path("upright.vti"))
        expected, _ = self.show(path, azimuth=90)
        for half in (slice(None, 52), slice(52, None)):
            found, wanted = numpy.argwhere(pixels[half] > 127), numpy.argwhere(expected[half] > 127)
            self.assertGreater(len(wanted), 200)
            # A row is 4.1 pixels; the upright one is a staircase, at most half a row off.
            self.assertLess(abs(found.mean(0) - wanted.mean(0)).max(), 2)

    def test_oblique(self):
        """A stack that runs from the left to the right shows the block from the left."""
        for k, fields in enumerate(self.slices):
            fields["ImagePositionPatient"] = (-2 * k, 0, 0)
            fields["ImageOrientationPatient"] = (0, 1, 0, 0, 0, 1)
        pixels, _ = self.show(self.write())
        values = make_wedge().transpose(1, 2, 0)[:, :, ::-1]  # z, y, x from the right on
        expected = self.show_expected(values, (2.0, 1.5, 1.0))
        self.assertLessEqual(abs(pixels - expected).max(), 1)


class TestDuplicates(DICOMTest):
    def test_copies(self):
        self.write()
        for k in range(9):
            shutil.copy(self.name(k), self.path(f"series/copy-{k}.dcm"))
        text = self.assert_right(self.folder)
        self.assertIn("9 files are copies of others and were left out, such as ", text)

    def test_same_place(self):
        self.slices[7]["ImagePositionPatient"] = (0, 0, 12)
        self.assert_refused(self.write(), word="there are 2 slices at (0, 0, 12) mm, another is ")
        for k in (6, 7):
            self.assert_refused(self.folder, word=self.name(k))

    def test_volumes(self):
        """Two echoes, of which the second is half as bright."""
        def make(time):
            slices = dicom.make_slices(make_image(make_wedge() // (1 if time == 9 else 2)))
            for k, fields in enumerate(slices):
                fields.update(EchoTime=time, InstanceNumber=1000 - 20 * time + k,
                              SOPInstanceUID=f"{dicom.ROOT}.3.{time}.{k}")
            return slices
        text = self.assert_right(self.write(make(10) + make(9)))
        self.assertIn("volume 1 of 2 (--frame chooses), echo time 9\n", text)
        text = self.assert_right(self.folder, "--frame", "2", values=make_wedge() // 2)
        self.assertIn("volume 2 of 2 (--frame chooses), echo time 10\n", text)
        self.assert_refused(self.folder, "--frame", "3", word="there is no volume 3 here, only 2")
        os.remove(self.name(4))
        self.assert_refused(self.folder, word="there are 1 slice at (0, 0, 8) mm, and 2 at most")
        for fields in self.slices:
            fields["SOPInstanceUID"] += ".9"
        self.assert_refused(
            self.write(dicom.make_slices() + self.slices), word="nothing says which belong")


class TestValues(DICOMTest):
    def test_mixed_representations(self):
        """Unsigned pixels among signed ones, above what these can be."""
        values = make_wedge() * 70.0
        for k, fields in enumerate(self.slices):
            if k >= 6:
                as_unsigned(fields, values[k])
            else:
                fields["PixelData"] = values[k].astype(numpy.int16).tobytes()
        pixels, _ = self.show(self.write(), window=58800)
        self.assertLessEqual(abs(pixels - self.show_expected()).max(), 1)

    def test_mixed_slopes(self):
        for k in (3, 8, 13):
            half = make_wedge()[k] // 2 + 5
            self.slices[k].update(RescaleSlope=2, RescaleIntercept=-10, PixelData=half.tobytes())
        self.assert_right(self.write())

    def test_window(self):
        """The file's, in its values, where all slices agree."""
        for fields in self.slices:
            fields.update(RescaleSlope=2, RescaleIntercept=-100, WindowWidth=[300, 7],
                          WindowCenter=[150, 9])
        _, text = self.draw(self.write(), "--output", "a.png")
        self.assertIn("shown with window 300, level 150\n", text)
        _, text = self.draw(self.folder, "--output", "a.png", "--level", "99")
        self.assertIn("shown with window 300, level 99\n", text)
        self.slices[3]["WindowWidth"] = 301
        _, text = self.draw(self.write(), "--output", "a.png")
        self.assertNotIn("window 30", text)

    def test_other_samples(self):
        self.slices[5].update(SamplesPerPixel=3, PhotometricInterpretation="RGB",
                              BitsAllocated=8, BitsStored=8, HighBit=7,
                              PixelData=bytes(10 * 12 * 3))
        self.assert_refused(self.write(), word=f"{self.name(5)}: ")


class TestFrames(DICOMTest):
    def write_frames(self, **fields):
        return self.write([dicom.join_frames(self.slices, **fields)])

    def test_dose(self):
        """Offsets from the position, or the patient's z; values are doses."""
        for start in (0, 30):
            folder = self.write_frames(
                Modality="RTDOSE", DoseGridScaling=0.001, ImagePositionPatient=(0, 0, start),
                GridFrameOffsetVector=[start + 2 * k for k in range(14)])
            pixels, _ = self.show(folder, window=0.84)
            self.assertLessEqual(abs(pixels - self.show_expected()).max(), 1)

    def test_dose_from_the_head(self):
        """The patient's z counts where the normal points to the feet."""
        folder = self.write_frames(
            ImageOrientationPatient=(1, 0, 0, 0, -1, 0), ImagePositionPatient=(0, 0, 30),
            GridFrameOffsetVector=[30 + 2 * k for k in range(14)])
        self.assert_right(folder)

    def test_uneven_dose(self):
        offsets = [2 * k for k in range(14)]
        offsets[13] = 30
        folder = self.write_frames(GridFrameOffsetVector=offsets)
        _, text = self.show(folder)
        self.assertIn("10 x 12 x 16", text)
        self.assertIn(f"{self.name(0)}, frame 13 at (0, 0, 24) mm", text)

    def test_nuclear_medicine(self):
        detector = {name: self.slices[-1][name]
                    for name in ("ImagePositionPatient", "ImageOrientationPatient")}
        folder = self.write_frames(
            ImagePositionPatient=None, ImageOrientationPatient=None, SpacingBetweenSlices=-2,
            SliceVector=list(range(14, 0, -1)), DetectorInformationSequence=[detector])
        self.assert_right(folder)

    def test_enhanced(self):
        """Frames in any order, each with a position."""
        order = [5, 0, 13, 2, 11, 4, 9, 6, 7, 8, 1, 10, 3, 12]
        slices = self.slices
        self.slices = [slices[k] for k in order]
        shared = {name: slices[0][name] for name in ("ImageOrientationPatient",)}
        folder = self.write_frames(
            ImagePositionPatient=None, ImageOrientationPatient=None, PixelSpacing=None,
            SharedFunctionalGroupsSequence=[
                {"PlaneOrientationSequence": [shared],
                 "PixelMeasuresSequence": [{"PixelSpacing": (1, 1.5)}]}],
            PerFrameFunctionalGroupsSequence=[
                {"PlanePositionSequence": [
                    {"ImagePositionPatient": slices[k]["ImagePositionPatient"]}]}
                for k in order])
        self.assert_right(folder)

    def test_film(self):
        self.assert_refused(self.write_frames(), word="where its 14 frames lie")


class TestChoice(DICOMTest):
    def setUp(self):
        super().setUp()
        self.study = self.path("study")
        scout = dicom.make_slices(make_image(make_wedge(3)))
        for k, fields in enumerate(scout):
            fields.update(SeriesInstanceUID=dicom.ROOT + ".7", SeriesDescription="Scout",
                          SOPInstanceUID=f"{dicom.ROOT}.8.{k}", SeriesNumber=1)
        for fields in self.slices:
            fields.update(SeriesDescription="Thorax", SeriesNumber=2)
        dicom.write_series(self.path("study/deep/in/scout"), scout)
        dicom.write_series(self.path("study/ct"), self.slices)

    def assert_chosen(self, path, text, *arguments, values=None):
        found = self.assert_right(path, *arguments, values=values)
        self.assertIn(text, found)
        self.assertEqual(found.count("shown here"), 1)

    def test_series(self):
        """The largest, unless one is named."""
        self.assert_chosen(self.study, '2: CT "Thorax", 14 files, shown here')
        self.assert_chosen(self.study, '1: CT "Scout", 3 files, shown here', "--series", "1",
                           values=make_wedge(3))
        self.assert_refused(self.study, "--series", "3", word="no series 3 among 2")

    def test_file(self):
        """A file stands for its series."""
        scout = self.path("study/deep/in/scout")
        for name in os.listdir(scout):
            os.rename(os.path.join(scout, name), self.path("study/ct/s" + name[:-4]))
        self.assert_chosen(self.path("study/ct/" + dicom.name_of(0)), '"Thorax", 14 files, shown')
        self.assert_chosen(self.path("study/ct/s" + dicom.name_of(0)[:-4]),
                           '"Scout", 3 files, shown', values=make_wedge(3))

    def test_dicomdir(self):
        tool = shutil.which("gdcmgendir")
        if not tool:
            splatmip.LOOKS.add("input DICOMDIR")  # TestSplatmipComplete.py need not say it again
            self.skipTest("no gdcmgendir")
        flat = self.path("flat")
        os.makedirs(flat)
        for k, folder in enumerate(("deep/in/scout", "ct")):
            for name in os.listdir(os.path.join(self.study, folder)):
                shutil.copy(os.path.join(self.study, folder, name),
                            os.path.join(flat, f"IM{k}{name[:-4]}"))
        subprocess.run([tool, "-i", flat, "-o", os.path.join(flat, "DICOMDIR")], check=True,
                       capture_output=True)
        self.assert_chosen(os.path.join(flat, "DICOMDIR"), "14 files, shown here")


class TestPixels(DICOMTest):
    """Other pixels in files of the same geometry."""

    def test_compressed(self):
        """What GDCM compresses without loss gives the same picture."""
        tool = shutil.which("gdcmconv")
        if not tool:
            self.skipTest("no gdcmconv")
        self.write()
        names = sorted(os.listdir(self.folder))
        for option, syntax in (("--rle", b"1.2.840.10008.1.2.5\0"),
                               ("--jpeg", b"1.2.840.10008.1.2.4.70"),
                               ("--jpegls", b"1.2.840.10008.1.2.4.80"),
                               ("--j2k", b"1.2.840.10008.1.2.4.90")):
            folder = self.path(option)
            os.makedirs(folder)
            for name in names:
                subprocess.run([tool, option, os.path.join(self.folder, name),
                                os.path.join(folder, name)], check=True, capture_output=True)
            with open(os.path.join(folder, names[0]), "rb") as file:
                self.assertIn(syntax, file.read(1000))
            self.assert_right(folder)

    def test_components(self):
        """Of colours one is shown: the wedge is in the second, of which the others are half."""
        wedge = (make_wedge() // 4).astype(numpy.uint8)
        for k, fields in enumerate(self.slices):
            pixels = numpy.stack((wedge[k] // 2, wedge[k], wedge[k] // 2), axis=-1)
            fields.update(SamplesPerPixel=3, PhotometricInterpretation="RGB", BitsAllocated=8,
                          BitsStored=8, HighBit=7, PixelRepresentation=0,
                          PixelData=pixels.tobytes())
        self.write()
        expected = self.show_expected(wedge.astype(numpy.int16), window=210)
        for words, factor in (((), 0.5), (("--component", "2"), 1.0), (("--component", "3"), 0.5)):
            pixels, text = self.show(self.folder, *words, window=factor * 210)
            self.assertLessEqual(abs(pixels - expected).max(), 3)  # of halves that are rounded
            self.assertRegex(text, r"component \d of 3 \(--component")
        self.assert_refused(self.folder, "--component", "4", word="no component 4 here, only 3")


class TestDamage(DICOMTest):
    def test_truncated(self):
        self.write()
        for name in os.listdir(self.folder):
            path = os.path.join(self.folder, name)
            os.truncate(path, os.path.getsize(path) - 100)
        self.assert_refused(self.folder)

    def test_one_truncated(self):
        self.write()
        os.truncate(self.name(3), os.path.getsize(self.name(3)) - 100)
        self.assert_refused(self.folder, word=self.name(3) + ": damaged")

    def test_bytes_behind(self):
        """Bytes behind the pixels that vtk-dicom does not return from."""
        self.write()
        with open(self.name(4), "ab") as file:
            file.write(b"\0" * 8)
        self.assert_refused(self.folder, word=self.name(4) + ": damaged")


if __name__ == "__main__":
    splatmip.main()
