# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Inputs that a projection can be made of, and those that get one sentence instead of a picture."""

import numpy
from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData, vtkRectilinearGrid
from vtkmodules.vtkIOXML import vtkXMLRectilinearGridWriter

import Stage


class TestInput(Stage.Test):
    def setUp(self):
        super().setUp()
        self.volume = Stage.noise(1)
        self.view = Stage.new_view()
        Stage.look(self.view, "from +z")
        self.addCleanup(vtkOutputWindow.SetInstance, vtkOutputWindow.GetInstance())
        self.listen()

    def listen(self):
        """From now on."""
        self.said = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self.said)

    def assertShowsVolume(self):
        self.assertShows(self.volume.max(axis=0), self.view)

    def assertRefuses(self, sentence):
        """Nothing is shown, and the sentence is said once."""
        for _ in range(2):
            self.assertEqual(Stage.picture(self.view).max(), 0)
        self.assertEqual(self.said.GetOutput().count(sentence), 1, self.said.GetOutput())
        self.assertEqual(self.said.GetOutput().count("ERROR"), 1, self.said.GetOutput())
        self.listen()

    def assertSaysNothing(self):
        self.assertEqual(self.said.GetOutput(), "")

    def test_rectilinear_grid(self):
        grid = vtkRectilinearGrid()
        grid.SetDimensions(Stage.DIMENSIONS)
        for axis, size in zip("XYZ", Stage.DIMENSIONS):
            coordinates = Stage.numpy_to_vtk(numpy.arange(size, dtype=float), deep=True)
            getattr(grid, f"Set{axis}Coordinates")(coordinates)
        array = Stage.numpy_to_vtk(self.volume.ravel(), deep=True)
        array.SetName("scalars")
        grid.GetPointData().AddArray(array)
        writer = vtkXMLRectilinearGridWriter()
        writer.SetDataModeToBinary()
        writer.SetFileName(Stage.path("grid.vtr"))
        writer.SetInputData(grid)
        writer.Write()
        Stage.show(simple.XMLRectilinearGridReader(FileName=[Stage.path("grid.vtr")]), self.view)
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_composite_data(self):
        data = Stage.image(scalars=self.volume)
        first, second = Stage.open_images("first", data), Stage.open_images("second", data)
        group = simple.GroupDatasets(Input=[first])
        display = Stage.show(group, self.view)
        self.assertShowsVolume()
        self.assertSaysNothing()
        group.Input = [first, second]
        self.assertRefuses("one image at a time, but its input has 2")
        group.Input = [second]
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_no_points_then_some(self):
        producer = simple.TrivialProducer()
        producer.GetClientSideObject().SetOutput(Stage.image(scalars=self.volume))
        Stage.show(producer, self.view)
        self.assertShowsVolume()
        producer.GetClientSideObject().SetOutput(vtkImageData())
        producer.MarkModified(producer)
        self.assertEqual(Stage.picture(self.view).max(), 0)
        producer.GetClientSideObject().SetOutput(Stage.image(scalars=self.volume))
        producer.MarkModified(producer)
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_no_array(self):
        producer = simple.TrivialProducer()
        producer.GetClientSideObject().SetOutput(Stage.image(scalars=self.volume))
        display = Stage.show(producer, self.view, array=None)
        Stage.picture(self.view)
        bare = vtkImageData()
        bare.SetDimensions(Stage.DIMENSIONS)
        producer.GetClientSideObject().SetOutput(bare)
        producer.MarkModified(producer)
        self.assertRefuses("The input has no array that Splatting MIP could show.")

    def test_input_of_another_kind(self):
        producer = simple.TrivialProducer()
        producer.GetClientSideObject().SetOutput(Stage.image(scalars=self.volume))
        Stage.show(producer, self.view)
        Stage.picture(self.view)
        producer.GetClientSideObject().SetOutput(vtkPolyData())
        producer.MarkModified(producer)
        Stage.picture(self.view)
        self.assertIn("vtkPolyData", self.said.GetOutput())
        self.listen()
        producer.GetClientSideObject().SetOutput(Stage.image(scalars=self.volume))
        producer.MarkModified(producer)
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_missing_array(self):
        display = Stage.show(
            Stage.open_images("volume", Stage.image(scalars=self.volume)), self.view
        )
        display.ColorArrayName = ["POINTS", "nothing"]
        self.assertRefuses('The input has no array "nothing": choose another one.')
        display.ColorArrayName = ["POINTS", "scalars"]
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_too_many_components(self):
        tensors = numpy.repeat(self.volume[:, :, :, None], 9, axis=3)
        Stage.show(
            Stage.open_images("tensors", Stage.image(tensors=tensors)), self.view, "tensors"
        )
        colors = simple.GetColorTransferFunction("tensors")
        colors.VectorMode = "Component"
        colors.VectorComponent = 4
        self.assertRefuses("Splatting MIP shows one of the first four components")
        colors.VectorComponent = 3
        self.assertShowsVolume()
        self.assertSaysNothing()

    def test_opacity_array_problems(self):
        display = Stage.show(
            Stage.open_images("volume", Stage.image(scalars=self.volume)), self.view
        )
        display.MIPUseSeparateOpacityArray = 1
        self.listen()
        display.MIPOpacityArrayName = ["POINTS", "nothing"]
        Stage.picture(self.view)
        self.assertIn('There is no array "nothing" to take opacity from', self.said.GetOutput())
        self.listen()
        display.MIPOpacityArrayName = ["POINTS", "scalars"]
        simple.ColorBy(display, None)
        Stage.picture(self.view)
        self.assertIn("needs an array to colour by", self.said.GetOutput())
        self.listen()
        display.MIPUseSeparateOpacityArray = 0
        simple.ColorBy(display, ("POINTS", "scalars"))
        self.assertShowsVolume()
        self.assertSaysNothing()


Stage.main()
