# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM files, sound ones and others, for the tests of the program splatmip.

A file is a dict from keyword to value: text, numbers, bytes, or a list of such dicts (a sequence).
"""
import os
import struct

import SplatmipTesting as splatmip

CT_STORAGE = "1.2.840.10008.5.1.4.1.1.2"
ROOT = "1.2.826.0.1.3680043.9.9999"  # of the unique identifiers

ELEMENTS = {
    "SOPClassUID": (0x0008, 0x0016, "UI"), "SOPInstanceUID": (0x0008, 0x0018, "UI"),
    "StudyDate": (0x0008, 0x0020, "DA"), "StudyTime": (0x0008, 0x0030, "TM"),
    "PatientName": (0x0010, 0x0010, "PN"), "PatientID": (0x0010, 0x0020, "LO"),
    "StudyID": (0x0020, 0x0010, "SH"), "Modality": (0x0008, 0x0060, "CS"), "StudyInstanceUID": (0x0020, 0x000D, "UI"),
    "SeriesInstanceUID": (0x0020, 0x000E, "UI"), "InstanceNumber": (0x0020, 0x0013, "IS"),
    "ImagePositionPatient": (0x0020, 0x0032, "DS"),
    "ImageOrientationPatient": (0x0020, 0x0037, "DS"),
    "SamplesPerPixel": (0x0028, 0x0002, "US"),
    "PhotometricInterpretation": (0x0028, 0x0004, "CS"),
    "Rows": (0x0028, 0x0010, "US"), "Columns": (0x0028, 0x0011, "US"),
    "PixelSpacing": (0x0028, 0x0030, "DS"), "NumberOfFrames": (0x0028, 0x0008, "IS"),
    "EchoTime": (0x0018, 0x0081, "DS"), "SpacingBetweenSlices": (0x0018, 0x0088, "DS"),
    "SeriesDescription": (0x0008, 0x103E, "LO"), "SeriesNumber": (0x0020, 0x0011, "IS"),
    "WindowCenter": (0x0028, 0x1050, "DS"), "WindowWidth": (0x0028, 0x1051, "DS"),
    "RescaleIntercept": (0x0028, 0x1052, "DS"), "RescaleSlope": (0x0028, 0x1053, "DS"),
    "SliceVector": (0x0054, 0x0080, "US"), "DetectorInformationSequence": (0x0054, 0x0022, "SQ"),
    "GridFrameOffsetVector": (0x3004, 0x000C, "DS"), "DoseGridScaling": (0x3004, 0x000E, "DS"),
    "SharedFunctionalGroupsSequence": (0x5200, 0x9229, "SQ"),
    "PerFrameFunctionalGroupsSequence": (0x5200, 0x9230, "SQ"),
    "PlanePositionSequence": (0x0020, 0x9113, "SQ"),
    "PlaneOrientationSequence": (0x0020, 0x9116, "SQ"),
    "PixelMeasuresSequence": (0x0028, 0x9110, "SQ"), "BitsAllocated": (0x0028, 0x0100, "US"),
    "BitsStored": (0x0028, 0x0101, "US"), "HighBit": (0x0028, 0x0102, "US"),
    "PixelRepresentation": (0x0028, 0x0103, "US"), "PixelData": (0x7FE0, 0x0010, "OW")}


def encode_value(vr, value):
    if vr == "SQ":
        items = [encode(item) for item in value]
        return b"".join(struct.pack("<HHI", 0xFFFE, 0xE000, len(i)) + i for i in items)
    if vr == "US":
        numbers = value if isinstance(value, (list, tuple)) else (value,)
        return struct.pack(f"<{len(numbers)}H", *numbers)
    if vr in ("DS", "IS") and isinstance(value, (list, tuple)):
        value = "\\".join(f"{number:.10g}" for number in value)
    return value if isinstance(value, bytes) else str(value).encode()


def encode_element(group, element, vr, value):
    """One data element, explicit VR little endian."""
    value = encode_value(vr, value)
    value += (b"\0" if vr in ("UI", "OW", "OB") else b" ") * (len(value) % 2)
    form = "<HH2sxxI" if vr in ("OB", "OW", "SQ") else "<HH2sH"
    return struct.pack(form, group, element, vr.encode(), len(value)) + value


def encode(fields):
    elements = sorted((*ELEMENTS[name], value) for name, value in fields.items())
    return b"".join(encode_element(*element) for element in elements)


def write_object(path, fields):
    meta = b"".join(encode_element(0x0002, *element) for element in [
        (0x0001, "OB", b"\0\1"), (0x0002, "UI", fields["SOPClassUID"]),
        (0x0003, "UI", fields["SOPInstanceUID"]), (0x0010, "UI", "1.2.840.10008.1.2.1")])
    length = encode_element(0x0002, 0x0000, "UL", struct.pack("<I", len(meta)))
    return splatmip.write_file(path, b"\0" * 128 + b"DICM" + length + meta + encode(fields))


def make_slices(image=None):
    """The slices of a CT, from the feet on; rows run to the left, columns to the back."""
    image = image or splatmip.make_image()
    columns, rows, count = image.GetDimensions()
    spacing = image.GetSpacing()
    pixels = splatmip.get_bytes(image)
    size = len(pixels) // count
    return [{
        "SOPClassUID": CT_STORAGE, "SOPInstanceUID": f"{ROOT}.3.{k + 1}", "Modality": "CT",
        "PatientName": "Phantom", "PatientID": "1", "StudyDate": "20260101",
        "StudyTime": "120000", "StudyID": "1", "SeriesNumber": 1,
        "StudyInstanceUID": ROOT + ".1", "SeriesInstanceUID": ROOT + ".2",
        "InstanceNumber": k + 1, "ImagePositionPatient": (0, 0, spacing[2] * k),
        "ImageOrientationPatient": (1, 0, 0, 0, 1, 0), "SamplesPerPixel": 1,
        "PhotometricInterpretation": "MONOCHROME2", "Rows": rows, "Columns": columns,
        "PixelSpacing": (spacing[1], spacing[0]), "BitsAllocated": 16, "BitsStored": 16,
        "HighBit": 15, "PixelRepresentation": 1,
        "PixelData": pixels[k * size:(k + 1) * size]} for k in range(count)]


def name_of(k):
    """The file of slice k: the order of the names is not that of the slices."""
    return f"{997 - k:03}.dcm"


def write_series(folder, slices):
    os.makedirs(folder, exist_ok=True)
    for k, fields in enumerate(slices):
        write_object(os.path.join(folder, name_of(k)), fields)
    return folder


def join_frames(slices, **fields):
    """One object with the slices as frames, whose positions are for the caller to give."""
    frames = {name: value for name, value in slices[0].items() if name != "InstanceNumber"}
    frames.update(NumberOfFrames=len(slices),
                  PixelData=b"".join(fields["PixelData"] for fields in slices))
    frames.update(fields)
    return {name: value for name, value in frames.items() if value is not None}
