#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show maximum intensity projections of a volume in a browser, without a GPU, a display or OpenGL.

    python3 web_viewer.py [volume.vti] [--port 8000]

It prints an address to open. The page asks for a picture with all that the picture depends on, and
for the next one when that has arrived: whatever the speed, what is seen is the newest view, and the
server keeps nothing about who looks. While the view moves, pictures are JPEG in the quick mode; when
it rests, PNG in the exact one.
"""
import argparse
import contextlib
import hmac
import http.server
import json
import math
import pathlib
import secrets
import select
import socket
import sys
import threading
import urllib.parse

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkJPEGWriter, vtkPNGWriter
from vtksplattingmip import vtkSplattingMIPProjection

import volume_files

FOLDER = pathlib.Path(__file__).resolve().parent
AORTA = FOLDER.parent / "Data" / "aorta-stent.vti"
MODES = ("preview", "standard", "high", "exact")
MOST_PIXELS = 4096  # along each side
MOST_AREA = 1 << 23  # pixels of a picture
MOST_CONNECTIONS = 64
MOST_REQUESTS = 8  # that wait for their pictures, or get them
HOST_HELP = """the address to listen on. The default, 127.0.0.1, is this machine alone: to look at it from
another one, run "ssh -L PORT:127.0.0.1:PORT THIS_MACHINE" there. With any other, such as 0.0.0.0,
whoever reaches this machine over the network and knows the printed address sees the volume, and
nothing on the way is encrypted"""


class Abandoned(Exception):
    """Nobody waits for the picture any more."""


class Busy(Exception):
    """Too many requests wait."""


class Request:
    """Waits for a picture, or gets it."""

    def __init__(self, name, is_connected):
        self.name = name
        self.is_connected = is_connected
        self.is_superseded = False

    def is_wanted(self):
        return not self.is_superseded and self.is_connected()


class Queue:
    """Requests in their order. The first has its turn, the others wait."""

    def __init__(self):
        self.condition = threading.Condition()
        self.requests = []

    @contextlib.contextmanager
    def turn(self, name, is_connected):
        """Waits for the turn of a new request, which supersedes others of the same name."""
        request = Request(name, is_connected)
        with self.condition:
            for other in self.requests:
                other.is_superseded = other.is_superseded or (name != "" and other.name == name)
            if sum(not other.is_superseded for other in self.requests) >= MOST_REQUESTS:
                raise Busy(f"{MOST_REQUESTS} pictures wait to be made: try again later")
            self.requests.append(request)
            self.condition.notify_all()
        try:
            with self.condition:
                while self.requests[0] is not request and request.is_wanted():
                    self.condition.wait(0.2)
            if not request.is_wanted():
                raise Abandoned
            yield request
        finally:
            with self.condition:
                self.requests.remove(request)
                self.condition.notify_all()


def describe(volume, name):
    """What the page must know before the first picture."""
    bounds = numpy.array(volume.image.GetBounds()).reshape(3, 2)
    voxel = max(volume.image.GetSpacing())
    low, high = volume_files.choose_window(volume)
    return {
        "name": name,
        "size": volume.image.GetDimensions(),
        "center": bounds.mean(axis=1).tolist(),
        "longest": max(float(numpy.ptp(bounds, axis=1).max()), voxel),
        "diagonal": max(volume.image.GetLength(), voxel),
        "window": high - low,
        "level": (low + high) / 2.0,
        "isOriented": volume.is_oriented,
        "unit": "mm" if volume.is_in_mm else "",
        "note": volume.note,
    }


class Viewer:
    """Pictures of one volume, and what is seen at their pixels; one at a time."""

    def __init__(self, volume, name):
        self.queue = Queue()
        self.is_wanted = lambda: True
        self.description = describe(volume, name)
        self.problem = ""
        self.projection = vtkSplattingMIPProjection()
        self.projection.SetInputData(volume.image)
        self.projection.CenterOnVolumeOff()
        self.projection.SetBackgroundValue(math.nan)
        self.projection.AddObserver("ProgressEvent", self.stop_if_unwanted)
        self.projection.AddObserver("ErrorEvent", self.note_problem)

    def stop_if_unwanted(self, *_):
        if not self.is_wanted():
            self.projection.AbortExecuteOn()

    def note_problem(self, projection, event, text):
        self.problem = text.strip().splitlines()[-1].partition("): ")[2]

    note_problem.CallDataType = "string0"

    def project(self, view, size, focal_point, is_wanted, locations=False):
        """The output of the projection, in the turn of a request."""
        projection = self.projection
        projection.SetViewDirection(view["direction"])
        projection.SetViewUp(view["up"])
        projection.SetFocalPoint(focal_point)
        projection.SetOutputSize(size)
        projection.SetOutputSpacing(view["spacing"], view["spacing"])
        projection.SetQualityMode(MODES.index(view["mode"]))
        projection.SetRecordLocations(locations)
        projection.SetSlab(view["thickness"] > 0.0)
        projection.SetSlabThickness(view["thickness"] or 1.0)
        projection.SetSlabCenter(view["focalPoint"] + view["offset"] * view["direction"])
        self.problem, self.is_wanted = "", is_wanted
        projection.Update()
        if projection.GetAbortExecute():
            projection.AbortExecuteOff()
            raise Abandoned
        if self.problem:
            raise ValueError(self.problem)
        return projection.GetOutput()

    def picture(self, view, is_connected):
        """A file, JPEG or PNG, and its type; gray, or black where nothing is seen."""
        with self.queue.turn(view["page"] and view["page"] + " picture", is_connected) as request:
            output = self.project(view, view["size"], view["focalPoint"], request.is_wanted)
            values = vtk_to_numpy(output.GetPointData().GetScalars()).astype(float)
            low = view["level"] - view["window"] / 2.0
            with numpy.errstate(over="ignore"):  # infinite is white or black
                gray = 255.0 / view["window"] * (values - low) + 0.5
            gray = numpy.fmin(numpy.fmax(gray, 0.0), 255.0).astype(numpy.uint8)
            image = vtkImageData()
            image.SetDimensions(*view["size"], 1)
            image.GetPointData().SetScalars(numpy_to_vtk(gray))
            writer = vtkJPEGWriter() if view["kind"] == "jpeg" else vtkPNGWriter()
            writer.SetInputData(image)
            writer.WriteToMemoryOn()
            writer.Write()
            return "image/" + view["kind"], bytes(vtk_to_numpy(writer.GetResult()))

    def pick(self, view, is_connected):
        """Value, place and voxel of what is seen at a pixel, by a picture of this pixel alone."""
        size, (x, y) = view["size"], view["pixel"]
        right = numpy.cross(view["direction"], view["up"])
        point = view["focalPoint"] + view["spacing"] * (
            (x - (size[0] - 1) / 2.0) * right + ((size[1] - 1) / 2.0 - y) * view["up"])
        with self.queue.turn(view["page"] and view["page"] + " pick", is_connected) as request:
            pixel = self.project(view, (1, 1), point, request.is_wanted, locations=True).GetPointData()
            value = pixel.GetScalars().GetTuple1(0)
            if math.isnan(value):
                return {}
            return {
                "value": value,
                "position": pixel.GetArray("Position").GetTuple3(0),
                "voxel": [int(index) for index in pixel.GetArray("Voxel").GetTuple3(0)],
            }


def parse_view(query):
    """What a picture depends on, from a request's query; a ValueError says what is wrong with it."""
    fields = dict(urllib.parse.parse_qsl(query))

    def numbers(name, count, least=-1e12, most=1e12, kind=float):
        try:
            found = [kind(word) for word in fields[name].split(",")]
        except (KeyError, ValueError):
            found = []
        if len(found) != count or not all(least <= number <= most for number in found):
            plural = "s" if count > 1 else ""
            raise ValueError(f"{name} must be {count} number{plural} from {least:g} to {most:g}")
        return found

    def choice(name, names):
        if fields.get(name) not in names:
            raise ValueError(f"{name} must be one of {', '.join(names)}")
        return fields[name]

    direction, up = (numpy.array(numbers(name, 3, -1.0, 1.0)) for name in ("direction", "up"))
    if not numpy.allclose((direction @ direction, up @ up, direction @ up), (1, 1, 0), atol=1e-6):
        raise ValueError("direction and up must have length 1 and be at right angles")
    view = {
        "direction": direction,
        "up": up,
        "focalPoint": numpy.array(numbers("focalPoint", 3)),
        "size": numbers("size", 2, 1, MOST_PIXELS, int),
        "spacing": numbers("spacing", 1, 1e-9)[0],  # world units per pixel
        "window": numbers("window", 1, 1e-30, 1e300)[0],
        "level": numbers("level", 1, -1e300, 1e300)[0],
        "thickness": numbers("thickness", 1, 0.0)[0],  # of the slab; 0 for the whole volume
        "offset": numbers("offset", 1)[0],  # of the slab: how far behind the focal point
        "mode": choice("mode", MODES),
        "kind": choice("kind", ("jpeg", "png")),
        "page": fields.get("page", "")[:64],  # a newer request of a page replaces the one before
    }
    if view["size"][0] * view["size"][1] > MOST_AREA:
        raise ValueError(f"size must be of at most {MOST_AREA} pixels")
    if "pixel" in fields:  # of a pick: column and row from the upper left
        view["pixel"] = numbers("pixel", 2, 0, MOST_PIXELS)
    return view


class Handler(http.server.BaseHTTPRequestHandler):
    """Answers what begins with the token.

    Any web page in the user's browser can send requests to this machine, and so can all of its
    users; but they do not know the token.
    """

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # pictures wait for nothing
    timeout = 60

    def do_GET(self):
        self.server.set_busy(self.connection, True)
        self.answer_request()
        self.server.set_busy(self.connection, False)

    def answer_request(self):
        start = f"/{self.server.token}/"
        place = urllib.parse.urlsplit(self.path[len(start):])
        if not hmac.compare_digest(self.path[:len(start)].encode(), start.encode()):
            words = b"Open the whole address that the viewer has printed, with its last slash.\n"
            return self.answer(403, "text/plain", words)
        try:
            if place.path == "":
                page = (FOLDER / "web_viewer.html").read_bytes()
                return self.answer(200, "text/html; charset=utf-8", page)
            if place.path == "volume":
                return self.answer_json(self.server.viewer.description)
            if place.path == "picture":
                view = parse_view(place.query)
                return self.answer(200, *self.server.viewer.picture(view, self.is_connected))
            if place.path == "pick":
                view = parse_view(place.query + "&kind=png")
                if "pixel" not in view:
                    raise ValueError("pixel must be 2 numbers")
                return self.answer_json(self.server.viewer.pick(view, self.is_connected))
            return self.answer(404, "text/plain", b"There is nothing here.\n")
        except ValueError as error:
            return self.answer(400, "text/plain", f"{error}\n".encode())
        except Busy as error:
            return self.answer(503, "text/plain", f"{error}\n".encode())
        except Abandoned:
            self.close_connection = True

    def is_connected(self):
        """Whether the browser still waits: it hangs up when a newer view makes a picture useless."""
        if not select.select([self.connection], [], [], 0)[0]:
            return True
        try:
            return self.connection.recv(1, socket.MSG_PEEK) != b""
        except OSError:
            return False

    def answer(self, status, content_type, body):
        self.send_response(status)
        self.send_header("Content-Type", content_type)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")  # the address has the token
        self.send_header("Content-Security-Policy",
                         "default-src 'none'; connect-src 'self'; frame-ancestors 'none'; "
                         "script-src 'unsafe-inline'; style-src 'unsafe-inline'")
        self.end_headers()
        self.wfile.write(body)

    def answer_json(self, values):
        self.answer(200, "application/json", json.dumps(values).encode())

    def log_message(self, *_):
        """Says nothing: there are many requests a second, and their addresses have the token."""


class Server(http.server.ThreadingHTTPServer):
    """Requests of all who know the token. A connection too many closes the one that has been idle for
    longest."""

    request_queue_size = MOST_CONNECTIONS

    def __init__(self, host, port, viewer):
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self.viewer = viewer
        self.lock = threading.Lock()
        self.connections = {}  # whether each is busy, the one that has been used last at the end
        self.token = secrets.token_urlsafe(16)
        super().__init__((host, port), Handler)

    def set_busy(self, connection, is_busy):
        with self.lock:
            if self.connections.pop(connection, None) is not None:
                self.connections[connection] = is_busy

    def process_request(self, request, client_address):
        with self.lock:
            idle = next((connection for connection, is_busy in self.connections.items() if not is_busy), None)
            if len(self.connections) >= MOST_CONNECTIONS and idle:
                del self.connections[idle]
                with contextlib.suppress(OSError):
                    idle.shutdown(socket.SHUT_RDWR)  # which ends its thread
            has_room = len(self.connections) < MOST_CONNECTIONS
            if has_room:
                self.connections[request] = False
        if has_room:
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def shutdown_request(self, request):
        with self.lock:
            self.connections.pop(request, None)
        super().shutdown_request(request)

    def handle_error(self, request, client_address):
        """A browser that hangs up is no fault."""
        if not isinstance(sys.exc_info()[1], (ConnectionError, TimeoutError)):
            super().handle_error(request, client_address)


def parse_arguments():
    parser = argparse.ArgumentParser(description="Maximum intensity projections in a browser")
    parser.add_argument("volume", nargs="?", default=AORTA, type=pathlib.Path,
                        help=f"a file that ends in {', '.join(volume_files.READERS)}")
    parser.add_argument("--host", default="127.0.0.1", help=HOST_HELP)
    parser.add_argument("--port", type=int, default=0, help="default: any that is free")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    try:
        volume = volume_files.read_volume(arguments.volume)
        viewer = Viewer(volume, arguments.volume.name)
    except volume_files.VolumeError as error:
        sys.exit(f"web_viewer.py: {error}")
    try:
        server = Server(arguments.host, arguments.port, viewer)
    except (OSError, OverflowError) as error:
        sys.exit(f"web_viewer.py: cannot listen on {arguments.host}, port {arguments.port}: {error}")
    host, port = server.server_address[:2]
    print("Window {window:g}, level {level:g}:".format(**viewer.description), "the file's own." if volume.window else
          "from the median of the values to the one that one voxel in 2000 exceeds.")
    if volume.note:
        print(f"Note: {volume.note}.")
    if host in ("127.0.0.1", "::1"):
        print("Only this machine can connect, and who knows the address below.")
    else:
        print("Whoever reaches this machine over the network and knows the address below sees the\n"
              "volume, and nothing on the way is encrypted.")
    if host in ("0.0.0.0", "::"):
        host = socket.gethostname()
    host = f"[{host}]" if ":" in host else host
    print(f"Open http://{host}:{port}/{server.token}/ (Ctrl-C ends)", flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
