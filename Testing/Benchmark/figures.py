#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keeps the figures of the documents true: one recorded run of splatmip-benchmark, and tables made from it.

figures.py record BENCHMARK [OPTION ...]  runs splatmip-benchmark (parallel, then perspective views) with these
                                          options, such as --data=FOLDER, and writes figures.json
figures.py write                          writes the tables of README.md and performance.md anew
figures.py check                          fails where a table is not what `write` would write
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
TOP = FOLDER.parent.parent
RECORD = FOLDER / "figures.json"
DOCUMENTS = [TOP / "README.md", TOP / "Rendering/Documentation/performance.md"]

VOLUMES = {
    "vessels256-uint8": "noise and vessels, 256³ uint8",
    "aorta-int16": "aorta CTA, 128×128×256 int16",
    "lidc0314-int16": "chest CT, 512×512×275 int16",
}
MODES = ["preview", "standard", "high", "exact"]
RAY_CASTERS = ["raycast-nearest", "raycast-linear"]
_V, _M = f"({'|'.join(VOLUMES)})", f"({'|'.join(MODES)})"
_FRAMES = f"frame/{_V}/(300|1024)/({'|'.join(MODES + RAY_CASTERS)})"
CAMERAS = {
    "parallel": ([], [_FRAMES, f"(floor|index)/{_V}", f"(projection|where|first)/{_V}/{_M}",
                      f"cut/{_V}/{_M}/(none|plane|box)", f"recolor/{_V}/1024/{_M}"]),
    "perspective": (["--perspective=30"], [_FRAMES, f"projection/{_V}/{_M}"]),
}


def record(benchmark, options):
    runs = {}
    for camera, (camera_options, names) in CAMERAS.items():
        filters = f"^({'|'.join(names)})/iterations"
        with tempfile.NamedTemporaryFile(suffix=".json") as out:
            subprocess.run([benchmark, "--threads=2", f"--benchmark_filter={filters}",
                            f"--benchmark_out={out.name}", *camera_options, *options], check=True)
            run = json.load(out)
        context = {key: run["context"][key] for key in
                   ("date", "processor", "instruction set", "num_cpus", "VTK", "threads", "OpenGL renderer")}
        # Names end in how often each was measured.
        medians = {re.sub("/iterations.*", "", b["name"]): round(b["median_ms"], 3)
                   for b in run["benchmarks"] if "median_ms" in b}
        runs[camera] = {"context": context, "median_ms": medians}
    RECORD.write_text(json.dumps(runs, indent=1) + "\n")


def number(milliseconds):
    return "-" if milliseconds is None else f"{milliseconds:.{0 if milliseconds >= 100 else 1}f}"


def times(value, unit):
    if value is None or not unit:
        return "-"
    ratio = value / unit
    return f"{ratio:.{0 if ratio >= 10 else 1}f}×"


def table(head, rows):
    lines = ["| " + " | ".join(row) + " |" for row in [head] + rows]
    lines.insert(1, "|---" * len(head) + "|")
    return "\n".join(lines)


class Tables:
    """Each method named in a document's `<!-- figures: NAME -->` makes the table that follows it."""

    def __init__(self, runs):
        self.runs = runs

    def get(self, name, camera="parallel"):
        return self.runs[camera]["median_ms"].get(name)

    def machine(self):
        context = self.runs["parallel"]["context"]
        return ("Recorded on {} with two threads ({}) of an {} ({}), VTK {}, OpenGL by {}.".format(
            context["date"][:10], context["threads"].split("(")[1].rstrip(")"), context["processor"],
            context["instruction set"], context["VTK"], context["OpenGL renderer"].split(" (")[0]))

    def frames(self, camera, windows):
        rows = []
        for volume, title in VOLUMES.items():
            for window in windows:
                name = f"frame/{volume}/{window}/"
                casters = [self.get(name + caster, camera) for caster in RAY_CASTERS]
                row = [title, f"{window}²"]
                for mode in MODES:
                    value = self.get(name + mode, camera)
                    rival = casters[0 if mode == "preview" else 1]
                    row.append(f"{number(value)} ({times(rival, value)})")
                rows.append(row + [" / ".join(number(c) for c in casters)])
        return table(["volume", "window", *MODES, "ray caster, nearest / linear"], rows)

    def overview(self):
        return self.frames("parallel", [1024])

    def parallel(self):
        return self.frames("parallel", [300, 1024])

    def perspective(self):
        return self.frames("perspective", [300, 1024])

    def projections(self):
        rows = []
        for volume, title in VOLUMES.items():
            row = [title, number(self.get(f"floor/{volume}"))]
            for mode in MODES:
                value = self.get(f"projection/{volume}/{mode}")
                across = self.get(f"projection/{volume}/{mode}", "perspective")
                row.append(f"{number(value)} ({times(across, value)})")
            rows.append(row + [number(self.get(f"index/{volume}"))])
        return table(["volume", "memory pass", *MODES, "index"], rows)

    def prices(self):
        rows = []
        for volume, title in VOLUMES.items():
            for mode in MODES:
                plain = self.get(f"projection/{volume}/{mode}")
                uncut = self.get(f"cut/{volume}/{mode}/none")
                cells = [times(self.get(f"cut/{volume}/{mode}/{cut}"), uncut) for cut in ("plane", "box")]
                rows.append([title, mode, *cells, times(self.get(f"where/{volume}/{mode}"), plain)])
        return table(["volume", "mode", "one plane", "box of six planes", "locations"], rows)

    def others(self):
        rows = []
        for volume, title in VOLUMES.items():
            for mode in MODES:
                frame, recolor = (self.get(f"{kind}/{volume}/1024/{mode}") for kind in ("frame", "recolor"))
                rows.append([title, mode, number(self.get(f"first/{volume}/{mode}")),
                             f"{number(recolor)} ({times(recolor, frame)})"])
        return table(["volume", "mode", "first frame, 300²", "other colours, 1024² (of a frame)"], rows)


def written(text, tables):
    """The text with all its tables made anew."""
    def replace(match):
        return f"{match[1]}\n{getattr(tables, match[2])()}\n{match[3]}"
    return re.sub(r"(<!-- figures: (\w+) -->)\n.*?(<!-- end -->)", replace, text, flags=re.DOTALL)


def main(arguments):
    if len(arguments) >= 2 and arguments[0] == "record":
        record(arguments[1], arguments[2:])
    elif arguments not in (["write"], ["check"]):
        sys.exit(__doc__)
    tables = Tables(json.loads(RECORD.read_text()))
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        true = written(text, tables)
        if arguments == ["check"] and text != true:
            sys.exit(f"{document.name}'s tables are not those of figures.json: run {__file__} write")
        if arguments == ["write"]:
            document.write_text(true, encoding="utf-8")


main(sys.argv[1:])
