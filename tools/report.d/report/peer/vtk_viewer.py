"""VTK: triangles shaded, or each face in a colour that encodes its number."""

import time

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from .turn import turned


class VtkViewer:
    """An off-screen window; one sample a pixel."""

    def __init__(self, size):
        start = time.perf_counter()
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(1, 1, 1)
        self.window.AddRenderer(self.renderer)
        self.mapper, self.actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
        self.actor.SetMapper(self.mapper)
        self.made_s = time.perf_counter() - start

    def load(self, triangles):
        """Points, corners, numbers of faces."""
        points, corners, numbers = (numpy.array(values) for values in triangles)
        self.data = vtk.vtkPolyData()
        held = vtk.vtkPoints()
        held.SetDataTypeToDouble()
        held.SetData(numpy_to_vtk(points, deep=True))
        self.data.SetPoints(held)
        cells = vtk.vtkCellArray()
        offsets = numpy.arange(0, 3 * len(corners) + 1, 3, dtype=numpy.int64)
        cells.SetData(
            numpy_to_vtkIdTypeArray(offsets, deep=True),
            numpy_to_vtkIdTypeArray(corners.astype(numpy.int64).ravel(), deep=True),
        )
        self.data.SetPolys(cells)
        code = numbers + 1
        bytes_ = numpy.stack([code & 255, code >> 8 & 255, code >> 16 & 255], -1).astype(numpy.uint8)
        self.colours = numpy_to_vtk(bytes_, deep=True)

    def look(self, camera):
        held = self.renderer.GetActiveCamera()
        held.SetPosition(*camera["eye"])
        held.SetFocalPoint(*camera["target"])
        held.SetViewUp(*camera["up"])
        held.SetViewAngle(camera["fovy"])
        self.renderer.ResetCameraClippingRange()
        self.window.Render()

    def shown(self, camera, turn):
        """Seconds to the first frame, milliseconds of one that turns, and of one that stands."""
        start = time.perf_counter()
        self.mapper.SetInputData(self.data)
        self.renderer.AddActor(self.actor)
        self.look(camera)
        first = time.perf_counter() - start
        frames = {"turning_ms": turned(self.look, turn), "standing_ms": turned(self.look, [camera] * len(turn))}
        self.renderer.RemoveActor(self.actor)
        return {"first_s": self.made_s + first, **frames}

    def faces(self, camera):
        """The number of the face at each pixel's centre, -1 where there is none; row 0 on top."""
        data = vtk.vtkPolyData()
        data.ShallowCopy(self.data)
        data.GetCellData().SetScalars(self.colours)
        mapper, actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
        mapper.SetInputData(data)
        mapper.SetColorModeToDirectScalars()
        mapper.SetScalarModeToUseCellData()
        actor.SetMapper(mapper)
        actor.GetProperty().LightingOff()
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.AddActor(actor)
        self.look(camera)
        image = vtk.vtkWindowToImageFilter()
        image.SetInput(self.window)
        image.SetInputBufferTypeToRGB()
        image.ReadFrontBufferOff()
        image.Update()
        drawn = image.GetOutput()
        width, height, _ = drawn.GetDimensions()
        pixels = vtk_to_numpy(drawn.GetPointData().GetScalars()).reshape(height, width, 3)[::-1].astype(numpy.int32)
        self.renderer.RemoveActor(actor)
        self.renderer.SetBackground(1, 1, 1)
        return pixels[..., 0] + 256 * pixels[..., 1] + 65536 * pixels[..., 2] - 1
