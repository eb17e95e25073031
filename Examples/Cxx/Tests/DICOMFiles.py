# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM files, sound ones and others, for the tests of the program splatmip; pydicom writes them.

A file is a dict from keyword to value: text, numbers, bytes, or a list of such dicts (a sequence).
"""
import os

import numpy
import pydicom

ROOT = "1.2.826.0.1.3680043.9.9999"  # of the unique identifiers
SIZE = (9, 12, 10)  # z, y, x


def make_values(low=0, high=1000, seed=0):
    values = numpy.random.default_rng(seed).integers(low, high, SIZE, numpy.int64)
    values.flat[:2] = low, high - 1
    return values


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


def write_object(path, fields):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    dataset = make_dataset({name: value for name, value in fields.items() if value is not None})
    dataset.file_meta = pydicom.dataset.FileMetaDataset()
    dataset.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
    dataset.is_little_endian, dataset.is_implicit_VR = True, False
    dataset.save_as(path, write_like_original=False)
    return path


def encode(codes, fields):
    is_signed = fields.get("PixelRepresentation", 1)
    return numpy.ascontiguousarray(codes).astype("<i2" if is_signed else "<u2").tobytes()


def make_slices(codes=None, **fields):
    """The slices of a CT, from the feet on; rows run to the left, columns to the back. The voxels
    have 1.5 x 1 x 2 mm."""
    codes = make_values() if codes is None else codes
    return [{
        "SOPClassUID": "1.2.840.10008.5.1.4.1.1.2", "SOPInstanceUID": f"{ROOT}.3.{k + 1}",
        "Modality": "CT", "PatientName": "Phantom", "PatientID": "1", "StudyDate": "20260101",
        "StudyTime": "120000", "StudyID": "1", "SeriesNumber": 1,
        "StudyInstanceUID": ROOT + ".1", "SeriesInstanceUID": ROOT + ".2",
        "InstanceNumber": k + 1, "ImagePositionPatient": (0, 0, 2 * k),
        "ImageOrientationPatient": (1, 0, 0, 0, 1, 0), "SamplesPerPixel": 1,
        "PhotometricInterpretation": "MONOCHROME2", "Rows": page.shape[0],
        "Columns": page.shape[1], "PixelSpacing": (1, 1.5), "BitsAllocated": 16,
        "BitsStored": 16, "HighBit": 15, "PixelRepresentation": 1,
        "PixelData": encode(page, fields), **fields} for k, page in enumerate(codes)]


def name_of(k):
    """The file of slice k: the order of the names is not that of the slices."""
    return f"{997 - k:03}.dcm"


def write_series(folder, slices):
    for k, fields in enumerate(slices):
        write_object(os.path.join(folder, name_of(k)), fields)
    return folder


def join_frames(slices, **fields):
    """One object with the slices as frames, whose positions are for the caller to give."""
    pixels = b"".join(page["PixelData"] for page in slices)
    return {**slices[0], "InstanceNumber": None, "NumberOfFrames": len(slices),
            "PixelData": pixels, **fields}


def place_frames(positions, *groups):
    """Fields of an enhanced object: functional groups with a position of each frame, and others."""
    shared = {"PlaneOrientationSequence": [{"ImageOrientationPatient": (1, 0, 0, 0, 1, 0)}],
              "PixelMeasuresSequence": [{"PixelSpacing": (1, 1.5), "SliceThickness": 2}]}
    frames = [{"PlanePositionSequence": [{"ImagePositionPatient": position}]} for position in positions]
    for name, items in groups:
        for frame, item in zip(frames, items):
            frame[name] = [item]
    return {"ImagePositionPatient": None, "ImageOrientationPatient": None, "PixelSpacing": None,
            "SharedFunctionalGroupsSequence": [shared], "PerFrameFunctionalGroupsSequence": frames}
