# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM: values are those that pydicom finds, and lie where the files say, or nothing is shown."""
import glob
import gzip
import os
import shutil
import subprocess
import zlib

import numpy
import pydicom
from pydicom.pixel_data_handlers.util import apply_modality_lut

import DICOMFiles as dicom
import SplatmipTesting as splatmip
from DICOMFiles import SIZE, make_slices, make_values
from SplatmipTesting import PLACES

RAMP = numpy.arange(1, SIZE[0] + 1)[:, None, None] * make_values(0, 90)[:1]  # linear along z


def shift(*position):
    """Places with another first voxel."""
    return numpy.column_stack((PLACES[:, :3], position))


class DICOMTest(splatmip.SplatmipTest):
    def setUp(self):
        super().setUp()
        self.folder = self.path("series")

    def name(self, k):
        return os.path.join(self.folder, dicom.name_of(k))

    def write(self, slices):
        shutil.rmtree(self.folder, ignore_errors=True)
        return dicom.write_series(self.folder, slices)

    def judge(self, folder):
        """By pydicom, sorted by position."""
        files = [pydicom.dcmread(path) for path in glob.glob(os.path.join(folder, "*"))]
        files.sort(key=lambda file: file.ImagePositionPatient[2])
        return numpy.array([apply_modality_lut(file.pixel_array, file) for file in files])


class TestValues(DICOMTest):
    def test_ranges(self):
        """The type holds all values that are possible, 16 bits where those there are fit."""
        for low, high, is_signed, slope, intercept, largest, name in (
                (-30000, 30001, 1, 3, 0, 90000, "int"), (0, 60001, 0, 1, -1024, 58976, "int"),
                (0, 30001, 1, 1, 10000, 40000, "unsigned short"),
                (0, 4096, 0, 1, -1024, 3071, "short"), (0, 60001, 0, 0.5, 0, 30000, "float")):
            folder = self.write(make_slices(make_values(low, high), PixelRepresentation=is_signed,
                                            RescaleSlope=slope, RescaleIntercept=intercept))
            values = self.judge(folder)
            self.assertEqual(values.max(), largest)
            self.assert_volume(folder, values, PLACES, words=f"voxels, {name}\n")

    def test_mixed(self):
        """Slices with slopes of their own, and unsigned pixels among signed ones."""
        slices = make_slices()
        slices[3:5] = make_slices(make_values() // 2 + 5, RescaleSlope=2, RescaleIntercept=-10)[3:5]
        slices[6:] = make_slices(make_values(0, 60000), PixelRepresentation=0)[6:]
        folder = self.write(slices)
        self.assert_volume(folder, self.judge(folder), PLACES)

    def test_elements(self):
        """Elements that change values, or say what they are."""
        table = numpy.array([(7 * n * n) % 50000 for n in range(200)], "<u2")
        def lut(first):
            return {"PixelRepresentation": 0, "ModalityLUTSequence": [
                {"LUTDescriptor": [200, first, 16], "LUTData": table.tobytes(), "ModalityLUTType": "US"}]}
        codes = make_values(0, 256)
        world = [{"RealWorldValueSlope": 0.25, "RealWorldValueIntercept": -3.0}]
        world_table = [{"RealWorldValueLUTData": [1.0, 2.0]}]
        for fields, values, words in (
                (lut(0), table[numpy.clip(codes, 0, 199)], "those of the file's Modality LUT\n"),
                (lut(20), table[numpy.clip(codes - 20, 0, 199)], "those of the file's Modality LUT\n"),
                ({"RealWorldValueMappingSequence": world}, 0.25 * codes - 3, "real world values\n"),
                ({"RealWorldValueMappingSequence": world_table}, codes, "is not applied\n"),
                ({"PhotometricInterpretation": "MONOCHROME1"}, codes, "(MONOCHROME1): --colormap inverted")):
            folder = self.write(make_slices(codes, **fields))
            if "ModalityLUTSequence" in fields:
                self.assertTrue((values == self.judge(folder)).all())
            self.assert_volume(folder, values, PLACES, words=words)
        for fields, words in (
                ({"PhotometricInterpretation": "PALETTE COLOR"}, "a palette (PALETTE COLOR); convert it to RGB"),
                ({"ImageType": ["ORIGINAL", "PRIMARY", "M", "ND", "MOSAIC"]}, "a mosaic, with the slices of a")):
            self.assert_refused(self.write(make_slices(**fields)), words=words)

    def test_bits(self):
        """Codes at other bits than the lowest, with something else in the rest."""
        rest = make_values(0, 16, seed=1)
        for is_signed, low, high in ((0, 0, 4096), (1, -2048, 2048)):
            values = make_values(low, high)
            for codes, high_bit in ((16 * values + rest, 15), ((values & 0xFFF) | (rest << 12), 11)):
                folder = self.write(make_slices(codes, HighBit=high_bit, BitsStored=12,
                                                PixelRepresentation=is_signed))
                self.assert_volume(folder, values, PLACES)

    def test_padding(self):
        """What is outside a scanner's circle is no value of a minimum or mean."""
        y, x = numpy.mgrid[:12, :10]
        outside = numpy.broadcast_to((y - 5.5) ** 2 + (x - 4.5) ** 2 > 20, SIZE)
        for is_signed, padding, limit in ((1, -2000, None), (0, 0, None), (0, 63536, None),
                                          (0, 65535, 65533), (1, -2000, -1990)):
            codes = make_values(5, 900)
            codes[outside] = padding
            codes[0, outside[0]] = limit or padding
            fields = {"PixelPaddingValue": padding, "PixelPaddingRangeLimit": limit,
                      "PixelRepresentation": is_signed, "RescaleSlope": 1, "RescaleIntercept": -1024}
            folder = self.write(make_slices(codes, **fields))
            values = numpy.where(outside, numpy.nan, codes - 1024).astype(numpy.float32)
            for options in (("--blend", "min"), ("--blend", "mean")):
                self.assert_volume(folder, values, PLACES, options=options)
            if padding > 900:
                self.assert_volume(folder, values, PLACES)
            else:
                self.assert_volume(folder, codes - 1024, PLACES, words="voxels, short")

    def test_window(self):
        """The file's, in its values, where all slices agree."""
        slices = make_slices(RescaleSlope=2, RescaleIntercept=-100, WindowWidth=[300, 7], WindowCenter=[150, 9])
        self.assertIn("shown with window 300, level 150\n", self.run_well(self.write(slices), *splatmip.SMALL))
        slices[3]["WindowWidth"] = 301
        self.assertNotIn("window 30", self.run_well(self.write(slices), *splatmip.SMALL))

    def test_components(self):
        colors = make_values(0, 256)[..., None] // numpy.array([2, 1, 3])
        rgb = {"SamplesPerPixel": 3, "PhotometricInterpretation": "RGB", "BitsAllocated": 8,
               "BitsStored": 8, "HighBit": 7, "PixelRepresentation": 0}
        slices = [{**fields, "PixelData": page.astype("u1").tobytes()}
                  for page, fields in zip(colors, make_slices(**rgb))]
        for words, n in (((), 0), (("--component", "2"), 1), (("--component", "3"), 2)):
            self.assert_volume(self.write(slices), colors[..., n].astype("u1"), PLACES, *words,
                               words="of 3 (--component")
        self.assert_refused(self.write([*make_slices()[:5], *slices[5:]]), words=": this picture has ")


class TestStacks(DICOMTest):
    def test_places(self):
        """Any orientation; within a tenth of a slice places are even; a gantry may tilt."""
        def place(position, **fields):
            slices = make_slices()
            for k, each in enumerate(slices):
                each.update(ImagePositionPatient=position(k), **fields)
            return slices
        turned = numpy.array([[0, 0, -2, 7], [1.5, 0, 0, 8], [0, 1, 0, 9.0]])
        tilted = numpy.array([[1.5, 0, 0, 0], [0, 1, 0.5, 0], [0, 0, 2, 0.0]])
        for slices, places in (
                (place(lambda k: (12, -34, 56 + 2 * k)), shift(12, -34, 56)),
                (place(lambda k: (7 - 2 * k, 8, 9), ImageOrientationPatient=(0, 1, 0, 0, 0, 1)), turned),
                (place(lambda k: (0, 0.5 * k, 2 * k)), tilted),
                (place(lambda k: (0, 0, 2 * k + (0, 0.15, -0.15)[k % 8 % 3])), PLACES)):
            text = self.assert_volume(self.write(slices), make_values(), places)
            self.assertEqual(len(text.splitlines()), 4, text)
        splatmip.write_file(self.path("series/README.txt"), b"Not an image.")
        self.assert_volume(self.folder, make_values(), places)

    def test_uneven(self):
        """What is missing is interpolated, and told in the text and in the picture."""
        whole, _ = self.draw(self.write(make_slices(RAMP)), "--mode", "high", "--output", "a.png")
        for missing, words in (((3, 4), "2 mm (between {0} at (0, 0, 0) mm and {1} at (0, 0, 2) mm) to 6 mm apart "
                                "(between {2} at (0, 0, 4) mm and {5} at (0, 0, 10) mm) and were interpolated to 2"),
                               ((5, 7), "to 4 mm apart (between {4} at (0, 0, 8) mm and {6} at")):
            self.write(make_slices(RAMP))
            for k in missing:
                os.remove(self.name(k))
            words = words.format(*(self.name(k) for k in range(SIZE[0])))
            self.assert_volume(self.folder, RAMP.astype(numpy.float32), PLACES, words=words)
        for words in (("--output", "a.png"), ("--rotate", "2", "--output", "a.png")):
            self.run_well(self.folder, "--mode", "high", *words)
        for name in ("a.png", "a-00000.png"):
            told = splatmip.read_picture(self.path(name))
            self.assertEqual(told[:60, :200].max(), 255)
        self.assertGreater((splatmip.read_picture(self.path("a.png"))[:60, :200] != whole[:60, :200]).sum(), 100)

    def test_refused(self):
        """Slices that are no volume; the error names them."""
        def change(k, **fields):
            slices = make_slices()
            slices[k].update(fields)
            return slices
        for slices, words in (
                (change(3, ImagePositionPatient=(0, 0, 4.05)), "too uneven to interpolate"),
                (change(3, ImagePositionPatient=(0, 0, 4.05)), f"(between {self.name(2)} at (0, 0, 4) mm and"),
                (change(5, ImagePositionPatient=(0, 3, 10)), f"{self.name(5)} at (0, 3, 10) mm: this slice is "
                                                             "shifted sideways by 3 mm"),
                (change(0, ImagePositionPatient=(0, 3, 0)), f"the line from {self.name(0)} at (0, 3, 0) mm"),
                (change(8, ImagePositionPatient=(0, 3, 16)), f"to {self.name(8)} at (0, 3, 16) mm;"),
                (change(4, ImagePositionPatient=None), f"{self.name(4)}: this picture has no position"),
                (change(4, PixelSpacing=None), f"{self.name(4)}: this slice has no pixel size"),
                (change(7, ImagePositionPatient=(0, 0, 12)),
                 f"{self.name(6)}: there are 2 slices at the place of {self.name(7)} at (0, 0, 12) mm, and 1 slice")):
            self.assert_refused(self.write(slices), words=words)

    def test_scout(self):
        """Of several stacks the largest is shown, and a note describes the others."""
        for fields, words in (({"ImageOrientationPatient": (1, 0, 0, 0, 0, -1)}, "whose axes differ by 90 degrees;"),
                              ({"PixelSpacing": (2, 1.5)}, "10 x 12 pixels of 1.5 x 2 mm,"),
                              ({"Rows": 10, "Columns": 12}, "12 x 10 pixels of 1.5 x 1 mm,")):
            scout = {**make_slices()[0], "SOPInstanceUID": dicom.ROOT + ".7", **fields}
            text = self.assert_volume(self.write([*make_slices(), scout]), make_values(), PLACES, words=words)
            self.assertIn("only the largest stack is shown; 1 of 10 slices do not fit, such as "
                          f"{self.name(9)} at (0, 0, 0) mm with ", text)

    def test_copies(self):
        self.write(make_slices())
        for k in range(4):
            shutil.copy(self.name(k), self.path(f"series/copy-{k}.dcm"))
        self.assert_volume(self.folder, make_values(), PLACES, words="4 files are copies of others and were left")

    def test_times(self):
        """Two values at each place belong together by what all places share, else by their ranks."""
        def make(n, **functions):
            slices = make_slices(make_values(seed=n))
            for k, fields in enumerate(slices):
                fields.update({name: function(k) for name, function in functions.items()},
                              SOPInstanceUID=f"{dicom.ROOT}.7.{n}.{k}")
            return slices
        for first, second, words in (
                ({"EchoTime": lambda k: 9}, {"EchoTime": lambda k: 10}, ", echo time 10\n"),
                ({"AcquisitionTime": lambda k: f"1200{3 * k:02}.5"},
                 {"AcquisitionTime": lambda k: f"1201{3 * k:02}.25"}, ", by the order of acquisition time at each"),
                ({}, {"InstanceNumber": lambda k: 100 - k}, ", by the order of instance number at each place")):
            self.write(make(1, **second) + make(0, **first))
            self.assert_volume(self.folder, make_values(), PLACES, words="volume 1 of 2 (--frame chooses)")
            self.assert_volume(self.folder, make_values(seed=1), PLACES, "--frame", "2", words=words)
        self.assert_refused(self.folder, "--frame", "3", words="there is no volume 3 here, only 2")
        os.remove(self.name(4))
        self.assert_refused(self.folder, words=" slices at the place of ")
        self.assert_refused(self.write(make(0) + make(1)), words="and no element distinguishes them")


class TestFrames(DICOMTest):
    def write_frames(self, slices=None, **fields):
        return self.write([dicom.join_frames(slices or make_slices(), **fields)])

    def test_offsets(self):
        """Doses: offsets from the position, or the patient's z. Nuclear medicine: numbers of slices."""
        detector = [{"ImagePositionPatient": (0, 0, 16), "ImageOrientationPatient": (1, 0, 0, 0, 1, 0)}]
        for fields, places, scale in (
                ({"DoseGridScaling": 0.001, "Modality": "RTDOSE",
                  "GridFrameOffsetVector": [2 * k for k in range(9)]}, PLACES, 0.001),
                ({"ImagePositionPatient": (0, 0, 30), "GridFrameOffsetVector": [30 + 2 * k for k in range(9)]},
                 shift(0, 0, 30), 1),
                ({"ImagePositionPatient": None, "ImageOrientationPatient": None, "SpacingBetweenSlices": -2,
                  "SliceVector": list(range(9, 0, -1)), "DetectorInformationSequence": detector}, PLACES, 1)):
            self.assert_volume(self.write_frames(**fields), scale * make_values(), places)
        self.write_frames(ImageOrientationPatient=(1, 0, 0, 0, -1, 0), ImagePositionPatient=(0, 0, 30),
                          GridFrameOffsetVector=[30 + 2 * k for k in range(9)])  # the normal is to the feet
        falling = numpy.array([[1.5, 0, 0, 0], [0, -1, 0, 0], [0, 0, -2, 46.0]])
        self.assert_volume(self.folder, make_values()[::-1], falling)
        self.assert_refused(self.write_frames(), words="its 9 frames have no positions")

    def test_enhanced(self):
        """Frames in any order, each with a position; at the same place an index counts times."""
        order = [5, 0, 2, 8, 4, 6, 7, 1, 3]
        positions = [(0, 0, 2 * k) for k in order]
        folder = self.write_frames(make_slices(make_values()[order]), **dicom.place_frames(positions))
        self.assert_volume(folder, make_values(), PLACES)
        pages = numpy.stack([make_values(seed=n) for n in (1, 0)], 1).reshape(-1, *SIZE[1:])
        positions = [(0, 0, 2 * (n // 2)) for n in range(len(pages))]
        index = [{"DimensionIndexValues": [1, n // 2 + 1, 12 - n % 2]} for n in range(len(pages))]
        self.write_frames(make_slices(pages), **dicom.place_frames(positions, ("FrameContentSequence", index)))
        for frame, seed in (("1", 0), ("2", 1)):
            self.assert_volume(folder, make_values(seed=seed), PLACES, "--frame", frame,
                               words="by the order of dimension index at each place")


class TestSegments(DICOMTest):
    NUMBERS = (2, 5)

    def write_segments(self, kind="BINARY", overlap=False, shift=0, every=1):
        """Two segments in slices 2 to 7 of 9, without the frames that are empty."""
        volume = numpy.zeros((len(self.NUMBERS), *SIZE), bool)
        volume[0, 2:4, 2:6, 1:4] = volume[0, 7, 2:6, 1:4] = True
        volume[1, 3:6, 5:11, 5 - 3 * overlap:9] = True
        volume[:, numpy.arange(SIZE[0]) % every > 0] = False
        places = [(n, int(k)) for n, k in numpy.argwhere(volume.any(axis=(2, 3)))[::-1]]
        pixels = numpy.array([volume[n, k] for n, k in places])
        bits = 1 if kind == "BINARY" else 8
        groups = dicom.place_frames(
            [(shift * (k == 3), 0, 2 * k) for _, k in places],
            ("SegmentIdentificationSequence", [{"ReferencedSegmentNumber": self.NUMBERS[n]} for n, _ in places]))
        path = dicom.write_object(self.path("seg/seg.dcm"), {
            **make_slices()[0], **groups, "SOPClassUID": "1.2.840.10008.5.1.4.1.1.66.4", "Modality": "SEG",
            "SegmentationType": kind, "NumberOfFrames": len(pixels), "MaximumFractionalValue": 255,
            "PixelRepresentation": 0, "BitsAllocated": bits, "BitsStored": bits, "HighBit": bits - 1,
            "PixelData": numpy.packbits(pixels.ravel(), bitorder="little").tobytes() if kind == "BINARY" else
                         numpy.where(pixels, 200, 90).astype(numpy.uint8).tobytes(),
            "SegmentSequence": [{"SegmentNumber": n, "SegmentLabel": f"part {n}"} for n in self.NUMBERS]})
        if kind == "BINARY":
            self.assertTrue((pydicom.dcmread(path).pixel_array == pixels).all())
        return path, volume[:, 2:8]

    def test_volume(self):
        places = shift(0, 0, 4)
        for settings, words in (({}, "segments 2 (part 2) or 5 (part 5) (--label chooses)\n"),
                                ({"kind": "FRACTIONAL"}, ""), ({"overlap": True}, "the highest number was taken\n")):
            path, volume = self.write_segments(**settings)
            labels = numpy.maximum(2 * volume[0], 5 * volume[1]).astype(numpy.uint16)
            self.assert_volume(path, labels, places, words=words)
            for n, number in enumerate(self.NUMBERS):
                self.assert_volume(path, numpy.uint16(number * volume[n]), places, "--label", number)
        path, volume = self.write_segments(every=2)  # no frames are as near as slices are
        self.assert_volume(path, numpy.uint16(2 * volume[0] + 5 * volume[1])[:3], places)
        for words, error in ((("--frame", "2"), "no volume 2 here, only 1"),
                             (("--label", "3"), "no segment 3 here, only 2 (part 2) or 5")):
            self.assert_refused(path, *words, words=error)
        path, _ = self.write_segments(shift=3)
        self.assert_refused(path, words="is shifted sideways by 3 mm")

    def test_mask(self):
        """It has fewer slices than the volume."""
        path, volume = self.write_segments(overlap=True)
        folder = self.write(make_slices())
        for label, shown in (("2", volume[0]), ("5", volume[1])):
            whole = numpy.pad(shown, ((2, 1), (0, 0), (0, 0)))
            values = numpy.where(whole, make_values(), numpy.nan).astype(numpy.float32)
            self.assert_volume(folder, values, PLACES, "--mask", path, "--label", label,
                               words="the mask has other voxels than the volume: the nearest were taken\n")


class TestFiles(DICOMTest):
    TEST_DATA = os.path.join(os.path.dirname(pydicom.__file__), "data", "test_files")

    def convert(self, tool, *arguments):
        if not shutil.which(tool):
            self.skipTest("skipped: no " + tool)
        subprocess.run([tool, *arguments], check=True, capture_output=True)

    def test_choice(self):
        """The largest series, that of a file, or that of a number; also of a DICOMDIR."""
        scout = make_slices(make_values(seed=3)[:3], SeriesInstanceUID=dicom.ROOT + ".7",
                            SeriesDescription="Sc\x1bout\xe4", SpecificCharacterSet="ISO_IR 100")
        for k, fields in enumerate(scout):
            fields["SOPInstanceUID"] = f"{dicom.ROOT}.8.{k}"
        study = self.path("study")
        dicom.write_series(self.path("study/deep/in/scout"), scout)
        dicom.write_series(self.path("study/ct"), make_slices(SeriesDescription="Thorax", SeriesNumber=2))
        small = make_values(seed=3)[:3]
        for arguments, values, words in (((), make_values(), '2: CT "Thorax", 9 files, shown here'),
                                         (("--series", "1"), small, '1: CT "Sc?out\u00e4", 3 files, shown here')):
            text = self.assert_volume(study, values, PLACES, *arguments, words=words)
            self.assertEqual(text.count("shown here"), 1)
        self.assert_refused(study, "--series", "3", words="no series 3 among 2")
        for k in range(3):
            os.rename(self.path("study/deep/in/scout/" + dicom.name_of(k)), self.path(f"study/ct/IM{k}"))
        self.assert_volume(self.path("study/ct/" + dicom.name_of(0)), make_values(), PLACES, words="9 files, shown")
        self.assert_volume(self.path("study/ct/IM0"), small, PLACES, words="3 files, shown")
        for k in range(SIZE[0]):
            os.rename(self.path("study/ct/" + dicom.name_of(k)), self.path(f"study/ct/CT{k}"))
        self.convert("gdcmgendir", "-i", self.path("study/ct"), "-o", self.path("study/ct/DICOMDIR"))
        self.assert_volume(self.path("study/ct/DICOMDIR"), make_values(), PLACES, words="9 files, shown here")

    def test_compressed(self):
        """What GDCM compresses without loss gives the same values."""
        self.write(make_slices())
        for option, syntax in (("--rle", b"1.2.840.10008.1.2.5\0"), ("--jpeg", b"1.2.840.10008.1.2.4.70"),
                               ("--jpegls", b"1.2.840.10008.1.2.4.80"), ("--j2k", b"1.2.840.10008.1.2.4.90")):
            os.makedirs(self.path(option))
            for name in os.listdir(self.folder):
                self.convert("gdcmconv", option, os.path.join(self.folder, name), self.path(f"{option}/{name}"))
            self.assertIn(syntax, splatmip.read_file(self.path(f"{option}/{dicom.name_of(0)}"))[:1000])
            self.assert_volume(self.path(option), make_values(), PLACES)

    def test_damaged(self):
        for k, change in ((3, lambda data: data[:-100]), (4, lambda data: data + b"\0" * 8)):
            self.write(make_slices())
            splatmip.write_file(self.name(k), change(splatmip.read_file(self.name(k))))
            self.assert_refused(self.folder, words=self.name(k) + ": damaged")

    def test_wrapped(self):
        """Files that are DICOM, but cannot be read as they are, are named with advice."""
        self.write(make_slices()[:1])
        path, data = self.name(0), splatmip.read_file(self.name(0))
        start = 144 + int.from_bytes(data[140:144], "little")  # behind group 2
        packer = zlib.compressobj(wbits=-15)
        deflated = (data[:start].replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.1.2.1.99") +
                    packer.compress(data[start:]) + packer.flush())
        for content, words in ((gzip.compress(data), "is compressed by gzip; unpack it with gunzip"),
                               (data[start:], "looks like DICOM without a header; convert it with DCMTK's dcmc"),
                               (deflated, "is deflated DICOM; convert it")):
            splatmip.write_file(path, content)
            for name in (self.folder, path):
                self.assert_refused(name, words=f"{dicom.name_of(0)} {words}")
        for name, words in (("image_dfl", "is deflated DICOM"), ("ExplVR_LitEndNoMeta", "DICOM without a header"),
                            ("ExplVR_BigEndNoMeta", "DICOM without a header")):
            if os.path.exists(os.path.join(self.TEST_DATA, name + ".dcm")):
                self.assert_refused(os.path.join(self.TEST_DATA, name + ".dcm"), words=words)

    def test_real_files(self):
        """Test data of pydicom, as pydicom reads them."""
        found = 0
        for name in ("CT_small", "MR_small", "MR_small_RLE", "MR_small_bigendian", "MR_small_expb",
                     "MR_small_implicit", "MR_small_jpeg_ls_lossless", "MR_small_jp2klossless",
                     "MR_small_padded", "rtdose", "rtdose_rle", "rtdose_expb"):
            path = os.path.join(self.TEST_DATA, name + ".dcm")
            if not os.path.exists(path):
                continue
            os.makedirs(self.path(name))
            os.symlink(path, self.path(f"{name}/a.dcm"))
            plain = name.split("_jp")[0].replace("_RLE", "").replace("_rle", "").replace("_padded", "")
            file = pydicom.dcmread(path.replace(name, plain))  # pydicom needs others to decompress
            values = apply_modality_lut(file.pixel_array, file)
            values = values * float(file.get("DoseGridScaling", 1))
            axes = numpy.array(file.ImageOrientationPatient, float).reshape(2, 3)
            offsets = file.get("GridFrameOffsetVector") or [0, float(file.get("SliceThickness") or 1)]
            step = float(file.get("SpacingBetweenSlices", offsets[1] - offsets[0]))
            places = numpy.column_stack((axes[0] * file.PixelSpacing[1], axes[1] * file.PixelSpacing[0],
                                         numpy.cross(*axes) * step, numpy.array(file.ImagePositionPatient, float)))
            self.assert_volume(self.path(name), values.reshape(-1, *values.shape[-2:]), places)
            found += 1
        if not found:
            self.skipTest("skipped: no test data of pydicom")


if __name__ == "__main__":
    splatmip.main()
