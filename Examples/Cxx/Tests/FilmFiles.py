# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of films, for the tests of the program splatmip: rows from the top, three colours."""
import ctypes
import ctypes.util

import numpy


class OggPacket(ctypes.Structure):
    _fields_ = [("packet", ctypes.c_char_p), ("bytes", ctypes.c_long), ("first", ctypes.c_long),
                ("last", ctypes.c_long), ("granule", ctypes.c_int64), ("number", ctypes.c_int64)]


class Plane(ctypes.Structure):
    _fields_ = [("width", ctypes.c_int), ("height", ctypes.c_int), ("stride", ctypes.c_int),
                ("data", ctypes.POINTER(ctypes.c_ubyte))]


def read_packets(path):
    """The packets of the one stream of an Ogg file."""
    with open(path, "rb") as file:
        data = file.read()
    place, packet, packets = 0, b"", []
    while place < len(data):
        lengths = data[place + 27:place + 27 + data[place + 26]]
        place += 27 + len(lengths)
        for length in lengths:
            packet += data[place:place + length]
            place += length
            if length < 255:
                packets.append(packet)
                packet = b""
    return packets


def read_theora(path, size):
    """All pictures of a film without subsampling, or None where libtheora is not installed."""
    name = ctypes.util.find_library("theoradec")
    if not name:
        return None
    theora = ctypes.CDLL(name)
    theora.th_decode_alloc.restype = ctypes.c_void_p
    info, comment = (ctypes.create_string_buffer(512) for _ in range(2))  # more than they need
    setup = ctypes.c_void_p()
    theora.th_info_init(info)
    theora.th_comment_init(comment)
    decoder, pictures = None, []
    for number, content in enumerate(read_packets(path)):
        packet = OggPacket(content, len(content), number == 0, 0, -1, number)
        if number < 3:
            assert theora.th_decode_headerin(info, comment, ctypes.byref(setup), ctypes.byref(packet)) > 0
            continue
        decoder = decoder or ctypes.c_void_p(theora.th_decode_alloc(info, setup))
        assert theora.th_decode_packetin(decoder, ctypes.byref(packet), None) >= 0
        planes = (Plane * 3)()
        theora.th_decode_ycbcr_out(decoder, planes)
        y, cb, cr = (numpy.ctypeslib.as_array(plane.data, (plane.height, plane.stride))
                     [:size[1], :size[0]].astype(float) for plane in planes)
        y, cb, cr = 255 * (y - 16) / 219, 255 * (cb - 128) / 224, 255 * (cr - 128) / 224
        pictures.append(numpy.clip(numpy.stack(
            (y + 1.402 * cr, y - (0.114 * 1.772 * cb + 0.299 * 1.402 * cr) / 0.587, y + 1.772 * cb),
            axis=2), 0, 255))
    return pictures
