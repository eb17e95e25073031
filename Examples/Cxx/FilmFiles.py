# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of films, for the tests of the program splatmip: rows from the top, three colours."""
import ctypes
import ctypes.util
import struct

import numpy


def unpack_gif(data, least):
    """The codes of GIF's LZW, which starts with codes of so many bits."""
    clear, end = 1 << least, (1 << least) + 1
    table, width, held, bits, before = [], 0, 0, 0, b""
    out = bytearray()
    for byte in data:
        held |= byte << bits
        bits += 8
        while bits >= max(width, least + 1):
            width = max(width, least + 1)
            code = held & ((1 << width) - 1)
            held >>= width
            bits -= width
            if code == clear:
                table = [bytes([n]) for n in range(clear)] + [b"", b""]
                width, before = least + 1, b""
                continue
            if code == end:
                return bytes(out)
            entry = table[code] if code < len(table) else before + before[:1]
            if before and len(table) < 4096:
                table.append(before + entry[:1])
            out += entry
            before = entry
            if len(table) == 1 << width and width < 12:
                width += 1
    return bytes(out)


def read_blocks(data, place):
    """Blocks, each behind its length, up to an empty one; and where that ends."""
    content = bytearray()
    while data[place]:
        content += data[place + 1:place + 1 + data[place]]
        place += 1 + data[place]
    return bytes(content), place + 1


def read_gif(path):
    """All pictures of a GIF with one table of 256 colours."""
    with open(path, "rb") as file:
        data = file.read()
    width, height = struct.unpack_from("<HH", data, 6)
    colors = numpy.frombuffer(data, numpy.uint8, 768, 13).reshape(256, 3)
    place, pictures = 13 + 768, []
    while data[place] != 0x3B:
        if data[place] == 0x21:
            _, place = read_blocks(data, place + 2)
            continue
        least = data[place + 10]
        content, place = read_blocks(data, place + 11)
        indices = numpy.frombuffer(unpack_gif(content, least), numpy.uint8)
        pictures.append(colors[indices].reshape(height, width, 3).astype(float))
    return pictures


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
