# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values of DICOM files as pydicom finds them; stacks, times and segmentations."""
import glob
import gzip
import os
import zlib

import numpy
import pydicom
from pydicom.pixel_data_handlers.util import apply_modality_lut

import DICOMFiles as dicom
import SplatmipTesting as splatmip

PLACES = numpy.array([[1.5, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0.0]])
SIZE = (9, 12, 10)  # z, y, x


def make_values(low=0, high=1000, seed=0):
    values = numpy.random.default_rng(seed).integers(low, high, SIZE, numpy.int64)
    values.flat[:2] = low, high - 1
    return values


class ValuesTest(splatmip.SplatmipTest):
    def write(self, codes, name="series", **fields):
        """Slices with these codes[z, y, x]."""
        slices = dicom.make_slices()
        is_signed = fields.get("PixelRepresentation", 1)
        kept = [{**common, **fields, "PixelData": codes[k].astype("<i2" if is_signed else "<u2").tobytes()}
                for k, common in enumerate(slices[:len(codes)])]
        return dicom.write_series(self.path(name), kept)

    def judge(self, folder):
        """By pydicom, sorted by position."""
        files = [pydicom.dcmread(path) for path in glob.glob(os.path.join(folder, "*"))]
        files.sort(key=lambda file: file.ImagePositionPatient[2])
        return numpy.array([apply_modality_lut(file.pixel_array, file) for file in files])


class TestCodes(ValuesTest):
    def test_ranges(self):
        """The type holds all values that are possible."""
        for low, high, is_signed, slope, intercept, largest, name in (
                (-30000, 30001, 1, 3, 0, 90000, "int"), (0, 60001, 0, 1, -1024, 58976, "int"),
                (0, 30001, 1, 1, 10000, 40000, "unsigned short"),
                (0, 4096, 0, 1, -1024, 3071, "short"), (0, 60001, 0, 0.5, 0, 30000, "float")):
            folder = self.write(make_values(low, high), PixelRepresentation=is_signed,
                                RescaleSlope=slope, RescaleIntercept=intercept)
            values = self.judge(folder)
            self.assertEqual(values.max(), largest)
            text = self.assert_volume(folder, values, PLACES)
            self.assertIn(f"voxels, {name}\n", text)

    def test_modality_lut(self):
        table = [(7 * n * n) % 50000 for n in range(200)]
        for first in (0, 20):
            folder = self.write(make_values(0, 256), PixelRepresentation=0, ModalityLUTSequence=[
                {"LUTDescriptor": [200, first, 16], "LUTData": numpy.array(table, "<u2").tobytes(), "ModalityLUTType": "US"}])
            text = self.assert_volume(folder, self.judge(folder), PLACES)
            self.assertIn("those of the file's Modality LUT\n", text)

    def test_bits(self):
        """Codes at other bits than the lowest, with something else in the rest."""
        rest = make_values(0, 16, seed=1)
        for is_signed, low, high in ((0, 0, 4096), (1, -2048, 2048)):
            values = make_values(low, high)
            bits = {"BitsStored": 12, "PixelRepresentation": is_signed}
            folder = self.write(16 * values + rest, HighBit=15, **bits)
            self.assert_volume(folder, values, PLACES)
            folder = self.write((values & 0xFFF) | (rest << 12), HighBit=11, **bits)
            self.assert_volume(folder, values, PLACES)

    def test_real_world_values(self):
        """Where there is no rescaling."""
        world = {"RealWorldValueSlope": 0.25, "RealWorldValueIntercept": -3.0}
        folder = self.write(make_values(), RealWorldValueMappingSequence=[world])
        text = self.assert_volume(folder, 0.25 * make_values() - 3, PLACES)
        self.assertIn("the file's real world values\n", text)
        table = {"RealWorldValueLUTData": [1.0, 2.0]}
        folder = self.write(make_values(), RealWorldValueMappingSequence=[table])
        self.assertIn("is not applied\n", self.assert_volume(folder, make_values(), PLACES))

    def test_photometric(self):
        folder = self.write(make_values(), PhotometricInterpretation="MONOCHROME1")
        text = self.assert_volume(folder, make_values(), PLACES)
        self.assertIn("low values bright (MONOCHROME1), as --colormap inverted", text)
        folder = self.write(make_values(0, 256), PhotometricInterpretation="PALETTE COLOR")
        self.assert_refused(folder, word="indices of a palette (PALETTE COLOR); convert it to RGB")

    def test_mosaic(self):
        folder = self.write(make_values(), ImageType=["ORIGINAL", "PRIMARY", "M", "ND", "MOSAIC"])
        self.assert_refused(folder, word="a mosaic, with the slices of a volume side by side; con")

    def test_padding(self):
        """What is outside a scanner's circle is no value of a minimum or mean."""
        y, x = numpy.mgrid[:12, :10]
        outside = numpy.broadcast_to((y - 5.5) ** 2 + (x - 4.5) ** 2 > 20, SIZE)
        for is_signed, padding, limit in ((1, -2000, None), (0, 0, None), (0, 63536, None),
                                          (0, 65535, 65533), (1, -2000, -1990)):
            codes = make_values(5, 900)
            codes[outside] = padding
            fields = {"PixelPaddingValue": padding, "PixelRepresentation": is_signed,
                      "RescaleSlope": 1, "RescaleIntercept": -1024}
            if limit:
                fields["PixelPaddingRangeLimit"] = limit
                codes[0, outside[0]] = limit
            folder = self.write(codes, **fields)
            values = numpy.where(outside, numpy.nan, codes - 1024).astype(numpy.float32)
            for options in (("--blend", "min"), ("--blend", "mean")):
                self.assert_volume(folder, values, PLACES, options=options)
            if padding > 900:
                self.assert_volume(folder, values, PLACES)
            else:
                self.assertIn("voxels, short", self.assert_volume(folder, codes - 1024, PLACES))


class TestStacks(ValuesTest):
    def add(self, fields, name, **more):
        more = {"SOPInstanceUID": f"{dicom.ROOT}.7.{len(os.listdir(self.path('series')))}", **more}
        dicom.write_object(self.path("series/" + name), {**fields, **more})

    def test_scout(self):
        """Of several stacks the largest is shown, and the others are told of."""
        folder = self.write(make_values())
        scout = dicom.make_slices()[0]
        for fields, word in (({"ImageOrientationPatient": (1, 0, 0, 0, 0, -1)}, "is turned by 90 de"),
                             ({"PixelSpacing": (2, 1.5)}, "has pixels of 1.5 x 2 mm, not 1.5 x 1"),
                             ({"Rows": 10, "Columns": 12}, "has 12 x 10 pixels, not 10 x 12")):
            self.add(scout, "scout.dcm", **fields)
            text = self.assert_volume(folder, make_values(), PLACES)
            self.assertRegex(text, r"only the largest stack is shown; 1 of 10 slices do not fit, such "
                             rf"as .*scout\.dcm at \(0, 0, 0\) mm, which {word}")

    def check_times(self, **second):
        """Two values at each place, of which the second has these fields, functions of the slice."""
        folder = self.write(make_values())
        for k, fields in enumerate(dicom.make_slices()[:SIZE[0]]):
            self.add(fields, f"second-{k}.dcm", PixelData=make_values(seed=1)[k].astype("<i2").tobytes(),
                     **{name: value(k) for name, value in second.items()})
        for frame, seed in (("1", 0), ("2", 1)):
            text = self.assert_volume(folder, make_values(seed=seed), PLACES, "--frame", frame)
        return text

    def test_times_differ(self):
        """Each slice has times of its own: they are ranked at each place."""
        folder = self.write(make_values())
        for k, name in enumerate(sorted(os.listdir(folder), reverse=True)):
            path = os.path.join(folder, name)
            file = pydicom.dcmread(path)
            file.AcquisitionTime = f"1200{3 * k:02}.5"
            file.save_as(path)
        for k, fields in enumerate(dicom.make_slices()[:SIZE[0]]):
            self.add(fields, f"second-{k}.dcm", PixelData=make_values(seed=1)[k].astype("<i2").tobytes(),
                     AcquisitionTime=f"1201{3 * k:02}.25")
        for frame, seed in (("1", 0), ("2", 1)):
            text = self.assert_volume(folder, make_values(seed=seed), PLACES, "--frame", frame)
        self.assertIn("volume 2 of 2 (--frame chooses), by the order of acquisition time at each", text)

    def test_instance_number(self):
        text = self.check_times(InstanceNumber=lambda k: 100 - k)
        self.assertIn("by the order of instance number at each place", text)

    def test_dimension_index(self):
        """Frames of one object: the index of the place differs, that of the time tells."""
        slices = [fields for k, fields in enumerate(dicom.make_slices()[:SIZE[0]]) for _ in range(2)]
        stack = numpy.stack([make_values(seed=n) for n in (1, 0)], 1).reshape(-1, *SIZE[1:])
        groups = [{"PlanePositionSequence": [{"ImagePositionPatient": fields["ImagePositionPatient"]}],
                   "FrameContentSequence": [{"DimensionIndexValues": [1, n // 2 + 1, 12 - n % 2]}]}
                  for n, fields in enumerate(slices)]
        shared = {"PlaneOrientationSequence": [{"ImageOrientationPatient": (1, 0, 0, 0, 1, 0)}],
                  "PixelMeasuresSequence": [{"PixelSpacing": (1, 1.5)}]}
        os.makedirs(self.path("series"))
        dicom.write_object(self.path("series/a.dcm"), dicom.join_frames(
            slices, PixelData=stack.astype("<i2").tobytes(), ImagePositionPatient=None,
            ImageOrientationPatient=None, PixelSpacing=None, SharedFunctionalGroupsSequence=[shared],
            PerFrameFunctionalGroupsSequence=groups))
        for frame, seed in (("1", 0), ("2", 1)):
            text = self.assert_volume(self.path("series"), make_values(seed=seed), PLACES,
                                      "--frame", frame)
        self.assertIn("by the order of dimension index at each place", text)


class TestSegments(ValuesTest):
    NUMBERS = (2, 5)

    def write_segments(self, kind="BINARY", overlap=False, shift=0, every=1):
        """Two segments in slices 2 to 7 of 9, without the frames that are empty."""
        volume = numpy.zeros((len(self.NUMBERS), *SIZE), bool)
        volume[0, 2:4, 2:6, 1:4] = volume[0, 7, 2:6, 1:4] = True
        volume[1, 3:6, 5:11, 5 - 3 * overlap:9] = True
        volume[:, numpy.arange(SIZE[0]) % every > 0] = False
        groups, pixels = [], []
        for n, k in numpy.argwhere(volume.any(axis=(2, 3)))[::-1]:
            groups.append({"PlanePositionSequence": [{"ImagePositionPatient": (
                shift * int(k), 0, 2 * int(k))}],
                           "SegmentIdentificationSequence": [
                               {"ReferencedSegmentNumber": self.NUMBERS[n]}]})
            pixels.append(volume[n, k])
        bits = numpy.packbits(numpy.array(pixels).ravel(), bitorder="little").tobytes()
        weak = numpy.where(pixels, 200, 90).astype(numpy.uint8).tobytes()
        fields = {name: value for name, value in dicom.make_slices()[0].items() if name not in (
            "ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "InstanceNumber")}
        fields.update(
            SOPClassUID="1.2.840.10008.5.1.4.1.1.66.4", Modality="SEG", SegmentationType=kind,
            NumberOfFrames=len(pixels), PixelRepresentation=0,
            PixelData=bits if kind == "BINARY" else weak, MaximumFractionalValue=255,
            BitsAllocated=1 if kind == "BINARY" else 8, BitsStored=1 if kind == "BINARY" else 8,
            HighBit=0 if kind == "BINARY" else 7,
            SegmentSequence=[{"SegmentNumber": n, "SegmentLabel": f"part {n}"} for n in self.NUMBERS],
            SharedFunctionalGroupsSequence=[{
                "PlaneOrientationSequence": [{"ImageOrientationPatient": (1, 0, 0, 0, 1, 0)}],
                "PixelMeasuresSequence": [{"PixelSpacing": (1, 1.5), "SliceThickness": 2}]}],
            PerFrameFunctionalGroupsSequence=groups)
        os.makedirs(self.path("seg"), exist_ok=True)
        path = dicom.write_object(self.path("seg/seg.dcm"), fields)
        if kind == "BINARY":
            self.assertTrue((pydicom.dcmread(path).pixel_array == pixels).all())
        return path, volume[:, 2:8]

    def test_volume(self):
        places = PLACES.copy()
        places[2, 3] = 4
        for kind in ("BINARY", "FRACTIONAL"):
            path, volume = self.write_segments(kind)
            labels = numpy.uint16(2 * volume[0] + 5 * volume[1])
            text = self.assert_volume(path, labels, places)
            self.assertIn("segments 2 (part 2) or 5 (part 5) (--label chooses)\n", text)
            for n, number in enumerate(self.NUMBERS):
                self.assert_volume(path, numpy.uint16(number * volume[n]), places,
                                   "--label", str(number))
        self.assert_refused(path, "--frame", "2", word="no volume 2 here, only 1")
        self.assert_refused(path, "--label", "3", word="no segment 3 here, only 2 (part 2) or 5")
        path, volume = self.write_segments(every=2)  # no frames are as near as slices are
        labels = numpy.uint16(2 * volume[0] + 5 * volume[1])[:3]
        self.assertEqual(list(labels.any(axis=(1, 2))), [True, False, True])
        self.assert_volume(path, labels, places)
        path, _ = self.write_segments(shift=1)
        self.assert_refused(path, word="its frames are not evenly above each other")
        path, volume = self.write_segments(overlap=True)
        labels = numpy.uint16(numpy.where(volume[1], 5, 2 * volume[0]))
        text = self.assert_volume(path, labels, places)
        self.assertIn("segments overlap: the highest number was taken\n", text)
        self.assert_volume(path, numpy.uint16(2 * volume[0]), places, "--label", "2")

    def test_mask(self):
        """It has fewer slices than the volume."""
        path, volume = self.write_segments(overlap=True)
        folder = self.write(make_values())
        for label, shown in (("2", volume[0]), ("5", volume[1])):
            values = make_values().astype(numpy.float32)
            whole = numpy.zeros(SIZE, bool)
            whole[2:8] = shown
            values[~whole] = numpy.nan
            text = self.assert_volume(folder, values, PLACES, "--mask", path, "--label", label)
            self.assertIn("the mask has other voxels than the volume: 10 x 12 x 6 voxels", text)


class TestWrappings(ValuesTest):
    FILES = os.path.join(os.path.dirname(pydicom.__file__), "data", "test_files")

    def test_wrapped(self):
        """What is DICOM, but cannot be read as it is, is named with advice."""
        folder = self.write(make_values()[:1])
        path = os.path.join(folder, dicom.name_of(0))
        with open(path, "rb") as file:
            data = file.read()
        start = 144 + int.from_bytes(data[140:144], "little")  # behind group 2
        packer = zlib.compressobj(wbits=-15)
        for content, word in (
                (gzip.compress(data), "is compressed by gzip; unpack it with gunzip"),
                (data[start:], "looks like DICOM without a header; convert it with DCMTK's dcmconv"),
                (data[:start].replace(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.1.2.1.99") +
                 packer.compress(data[start:]) + packer.flush(), "is deflated DICOM; convert it")):
            splatmip.write_file(path, content)
            self.assert_refused(folder, word=f"{dicom.name_of(0)} {word}")
            self.assert_refused(path, word=f"{dicom.name_of(0)} {word}")
        for name, word in (("image_dfl", "is deflated DICOM"), ("ExplVR_LitEndNoMeta", "DICOM without a header"),
                           ("ExplVR_BigEndNoMeta", "DICOM without a header")):
            self.assert_refused(os.path.join(self.FILES, name + ".dcm"), word=word)

    def test_real_files(self):
        """Test data of pydicom, as pydicom reads them."""
        found = 0
        for name in ("CT_small", "MR_small", "MR_small_RLE", "MR_small_bigendian", "MR_small_expb",
                     "MR_small_implicit", "MR_small_jpeg_ls_lossless", "MR_small_jp2klossless",
                     "MR_small_padded", "rtdose", "rtdose_rle", "rtdose_expb"):
            path = os.path.join(self.FILES, name + ".dcm")
            if not os.path.exists(path):
                continue
            os.makedirs(self.path(name))
            os.symlink(path, self.path(f"{name}/a.dcm"))
            plain = name.split("_jp")[0].replace("_RLE", "").replace("_rle", "").replace("_padded", "")
            file = pydicom.dcmread(path.replace(name, plain))  # pydicom needs others to decompress
            values = apply_modality_lut(file.pixel_array, file)
            if "DoseGridScaling" in file:
                values = values * float(file.DoseGridScaling)
            values = values.reshape(-1, *values.shape[-2:])
            axes = numpy.array(file.ImageOrientationPatient, float).reshape(2, 3)
            offsets = file.get("GridFrameOffsetVector") or [0, float(file.get("SliceThickness") or 1)]
            step = float(file.get("SpacingBetweenSlices", offsets[1] - offsets[0]))
            steps = [axes[0] * file.PixelSpacing[1], axes[1] * file.PixelSpacing[0],
                     numpy.cross(*axes) * step]
            places = numpy.column_stack((*steps, numpy.array(file.ImagePositionPatient, float)))
            self.assert_volume(self.path(name), values, places)
            found += 1
        if not found:
            self.skipTest("skipped: no test data of pydicom")


if __name__ == "__main__":
    splatmip.main()
