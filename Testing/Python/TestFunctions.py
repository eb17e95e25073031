# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""mip() from NumPy to NumPy, without a display; what help() and type checkers see of the package."""

import ast
import importlib
import multiprocessing
import os
import pathlib
import pydoc
import threading
import time
import unittest

import numpy
import vtksplattingmip
from vtksplattingmip import mip

TYPES = ("?", "b", "B", "h", "H", "i", "I", "q", "Q", "e", "f", "d", ">i2", ">f4")
CLASSES = {
    "vtkImagingSplattingMIP": ["vtkSplattingMIPProjection", "vtkSplattingMIPReslice"],
    "vtkRenderingSplattingMIP": [
        "vtkSplattingMIPGPUVolumeRayCastMapper",
        "vtkSplattingMIPVolumeMapper",
    ],
}


RANDOM = numpy.random.default_rng(int(os.environ.get("SPLATTINGMIP_TEST_SEED", "1")))


def noise(type_="h", shape=(9, 8, 7)):
    volume = RANDOM.integers(0, 100, shape)
    return (volume > 70 if type_ == "?" else volume).astype(type_)


class TestMip(unittest.TestCase):
    def test_along_axes(self):
        volume = noise()
        for axis in range(-3, 3):
            for mode in ("preview", "exact"):
                numpy.testing.assert_array_equal(mip(volume, direction=axis, mode=mode), volume.max(axis))
                numpy.testing.assert_array_equal(
                    mip(volume, direction=axis, mode=mode, blend="minimum"), volume.min(axis)
                )
                signed = 3 * volume - 151  # no two values are equally far from 0
                high, low = signed.max(axis), signed.min(axis)
                numpy.testing.assert_array_equal(
                    mip(signed, direction=axis, mode=mode, blend="signed"),
                    numpy.where(-low > high, low, high),
                )
            mean = mip(volume, direction=axis, mode="preview", blend="mean")
            numpy.testing.assert_allclose(mean, volume.mean(axis), rtol=1e-5)
            self.assertEqual(mean.dtype, numpy.float32)

    def test_types(self):
        for type_ in TYPES:
            volume = noise(type_)
            found = mip(volume)
            self.assertEqual(found.dtype, volume.dtype.newbyteorder("="))
            # An exact maximum is off by at most a millionth of the data's range.
            error = numpy.abs(found.astype(float) - volume.max(0)).max()
            self.assertLessEqual(error, 1e-4 if volume.dtype.kind == "f" else 0)

    def test_limits_of_integers(self):
        """The largest 64-bit integers have no float."""
        for type_ in ("int8", "uint8", "int64", "uint64"):
            limits = numpy.iinfo(type_)
            for value in (limits.min, limits.max):
                volume = numpy.full((3, 4, 5), value, type_)
                numpy.testing.assert_array_equal(mip(volume), volume[0])

    def test_memory_layouts(self):
        volume = noise()
        for view in (volume[::-1, ::2], numpy.asfortranarray(volume), volume.transpose(2, 0, 1), volume.tolist()):
            numpy.testing.assert_array_equal(mip(view), numpy.max(view, 0))
        self.assertTrue(mip(volume).flags.owndata)

    def test_spacing(self):
        volume = noise()
        for axis in range(3):
            numpy.testing.assert_array_equal(
                mip(volume, (3.0, 2.0, 0.5), axis, "exact"), volume.max(axis)
            )
        halves = mip(volume, pixel_spacing=0.5, mode="exact")
        self.assertEqual(halves.shape, (15, 13))
        numpy.testing.assert_array_equal(halves[::2, ::2], volume.max(0))
        self.assertEqual(mip(volume, shape=(30, 40)).shape, (30, 40))

    def test_directions(self):
        """A dot is seen where the view takes it."""
        volume = numpy.zeros((5, 5, 5), numpy.uint8)
        volume[0, 4, 2] = 200
        for direction, up, place in (
            ((1, 0, 0), None, (4, 2)),
            ((-1, 0, 0), None, (4, 2)),
            ((0, 0, 1), None, (0, 4)),
            ((0, 0, -1), None, (0, 0)),
            ((0, -1, 0), None, (0, 2)),
            ((0, -1, 0), (1, 0, 0), (4, 2)),
            ((1, 0, 0), (0, 0, 1), (2, 4)),
        ):
            picture = mip(volume, direction=direction, up=up)
            self.assertEqual(numpy.unravel_index(picture.argmax(), picture.shape), place)
        oblique = mip(volume, direction=(1, 1, 0.3))
        self.assertEqual(oblique.dtype, numpy.uint8)
        self.assertGreater(min(oblique.shape), 5)

    def test_turn(self):
        volume = noise("B", (6, 7, 8))
        turn = mip(volume, direction=1, views=4, mode="preview")
        self.assertEqual(turn.shape[0], 4)
        self.assertEqual(turn.dtype, numpy.uint8)
        self.assertGreater(min(view.max() for view in turn), 0.8 * volume.max())
        # Seen from the opposite sides, the picture is mirrored.
        numpy.testing.assert_array_equal(turn[0], turn[2][:, ::-1])

    def test_background(self):
        volume = noise("f") + 7
        around = {"pixel_spacing": 1.0, "shape": (20, 20)}
        self.assertEqual(mip(volume, **around)[0, 0], volume.min())
        self.assertEqual(mip(volume, blend="minimum", **around)[0, 0], volume.max())
        self.assertEqual(mip(volume, background=-5, **around)[0, 0], -5)
        volume[:, 3, 4] = numpy.nan
        self.assertEqual(mip(volume)[3, 4], numpy.nanmin(volume))

    def test_errors(self):
        volume = noise()
        for error, arguments in (
            (ValueError, {"array": volume[0]}),
            (ValueError, {"array": volume[:0]}),
            (TypeError, {"array": volume.astype(complex)}),
            (ValueError, {"mode": "best"}),
            (ValueError, {"blend": "sum"}),
            (ValueError, {"direction": 3}),
            (ValueError, {"direction": (0, 0, 0)}),
            (ValueError, {"direction": (1, 0, 0), "up": (2, 0, 0)}),
            (ValueError, {"pixel_spacing": 0}),
            (ValueError, {"spacing": (0, 1, 1), "pixel_spacing": 1}),
            (ValueError, {"shape": (0, 5)}),
            (ValueError, {"shape": (5, 10**6)}),
            (ValueError, {"array": noise("B"), "background": -1}),
            (ValueError, {"background": numpy.nan}),
            (MemoryError, {"shape": (16384, 16384), "views": 9000, "mode": "preview"}),
        ):
            with self.assertRaises(error) as caught:
                mip(**{"array": volume, **arguments})
            self.assertRegex(str(caught.exception), r"^\w.*\.$")

    def test_other_threads_run(self):
        """A thread that counts goes on counting during a projection."""
        volume = noise("B", (160, 160, 160))
        counts, ended = [], threading.Event()

        def count():
            while not ended.wait(0.0005):
                counts.append(time.perf_counter())

        thread = threading.Thread(target=count, daemon=True)
        thread.start()
        start = time.perf_counter()
        mip(volume, direction=(1, 0.4, 0.3), shape=(700, 700))
        end = time.perf_counter()
        ended.set()
        thread.join()
        middle = [start + 0.2 * (end - start) < at < start + 0.8 * (end - start) for at in counts]
        self.assertGreater(sum(middle), 3)

    def test_concurrent_calls(self):
        volume = noise("H", (40, 50, 60))
        expected = mip(volume, direction=(1, 0.4, 0.3))
        found = []
        threads = [
            threading.Thread(target=lambda: found.append(mip(volume, direction=(1, 0.4, 0.3))))
            for _ in range(4)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), 4)
        for picture in found:
            numpy.testing.assert_array_equal(picture, expected)

    def test_forked_process(self):
        """Threads do not survive a fork. A child computes on one where we chose the threads."""
        tools = vtksplattingmip._vtk_module("vtkCommonCore").vtkSMPTools
        if tools.GetBackend() != "Sequential":
            self.skipTest("the program chose the threads")
        volume = noise("H", (40, 50, 60))
        expected = mip(volume)
        context = multiprocessing.get_context("fork")
        results = context.Queue()
        child = context.Process(target=lambda: results.put(mip(volume)))
        child.start()
        numpy.testing.assert_array_equal(results.get(timeout=60), expected)
        child.join()


class TestPackage(unittest.TestCase):
    def test_help(self):
        text = pydoc.plain(pydoc.render_doc(vtksplattingmip))
        for name in vtksplattingmip.__all__:
            self.assertIn(name, text)
        self.assertIn("array.max(axis=n)", text)
        self.assertRegex(vtksplattingmip.__version__, r"^\d+\.\d+\.\d+")

    def test_stubs(self):
        """The stubs have the classes' methods and constants, with docstrings."""
        folder = pathlib.Path(vtksplattingmip.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        ast.parse((folder / "__init__.pyi").read_text())
        for module, names in CLASSES.items():
            for name in names:
                getattr(vtksplattingmip, name)
            classes = {
                node.name: node
                for node in ast.parse((folder / f"{module}.pyi").read_text()).body
                if isinstance(node, ast.ClassDef)
            }
            self.assertLessEqual(set(names), set(classes))
            for name, node in classes.items():
                wrapped = getattr(importlib.import_module(f"vtksplattingmip.{module}"), name)
                self.assertEqual(
                    {
                        part.name if hasattr(part, "name") else part.target.id
                        for part in node.body
                        if not isinstance(part, ast.Expr)
                    }
                    - {"__init__"},
                    {key for key in vars(wrapped) if not key.startswith("__")},
                )
                self.assertGreater(len(ast.get_docstring(node)), 500)
        methods = {part.name: part for part in classes["vtkSplattingMIPVolumeMapper"].body if hasattr(part, "name")}
        self.assertEqual(ast.unparse(methods["PickValue"].args), "self, x: int, y: int, /")
        self.assertEqual(ast.unparse(methods["PickValue"].returns), "float")
        self.assertTrue(ast.get_docstring(methods["GetLastRenderUsedRayCasting"]))

    def test_snake_case(self):
        """Properties have the names that this VTK generates, if it does."""
        projection = vtksplattingmip.vtkSplattingMIPProjection()
        if not hasattr(vtksplattingmip._vtk_module("vtkCommonDataModel").vtkImageData(), "spacing"):
            self.skipTest("this VTK generates none")
        projection.output_size = 30, 40
        self.assertEqual(projection.GetOutputSize(), (30, 40))


if __name__ == "__main__":
    unittest.main()
