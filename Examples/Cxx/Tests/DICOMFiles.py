# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM files, sound ones and others, for the tests of the program splatmip; pydicom writes them.

A file is a dict from keyword to value: text, numbers, bytes, or a list of such dicts (a sequence).
"""
import os
import sys

import SplatmipTesting as splatmip

try:
    import pydicom
except ImportError:
    print("skipped: no pydicom")
    sys.exit(0)

CT_STORAGE = "1.2.840.10008.5.1.4.1.1.2"
ROOT = "1.2.826.0.1.3680043.9.9999"  # of the unique identifiers


def make_dataset(fields):
    dataset = pydicom.Dataset()
    for name, value in fields.items():
        if isinstance(value, (list, tuple)) and value and isinstance(value[0], dict):
            value = [make_dataset(item) for item in value]
        elif pydicom.datadict.dictionary_VR(name) == "DS":
            numbers = value if isinstance(value, (list, tuple)) else (value,)
            value = [f"{number:.10g}" for number in numbers]
        elif isinstance(value, (list, tuple)):
            value = list(value)
        setattr(dataset, name, value)
    return dataset


def write_object(path, fields, syntax=pydicom.uid.ExplicitVRLittleEndian):
    dataset = make_dataset(fields)
    dataset.file_meta = pydicom.dataset.FileMetaDataset()
    dataset.file_meta.TransferSyntaxUID = syntax
    dataset.is_little_endian, dataset.is_implicit_VR = True, False
    dataset.save_as(path, write_like_original=False)
    return path


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
