#!/usr/bin/python3
"""Contours a sphere through the pipeline of Python's vtk; fails unless it is closed and in place."""

from shape3d_zmc_vtk import vtkZeroCrossingMarchingCubes
from vtkmodules.vtkCommonDataModel import vtkSphere
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkImagingHybrid import vtkSampleFunction

sphere = vtkSphere()
sphere.SetRadius(0.75)
samples = vtkSampleFunction()
samples.SetImplicitFunction(sphere)
samples.SetSampleDimensions(41, 42, 43)
samples.SetModelBounds(-1, 1, -1, 1, -1, 1)

contour = vtkZeroCrossingMarchingCubes()
assert isinstance(contour, vtkPolyDataAlgorithm)
assert contour.GetInside() == contour.INSIDE_ABOVE
contour.SetInputConnection(samples.GetOutputPort())
contour.SetValue(0, 0.0)
contour.SetInsideToBelow()

borders = vtkFeatureEdges()
borders.SetInputConnection(contour.GetOutputPort())
borders.FeatureEdgesOff()
borders.Update()
assert borders.GetOutput().GetNumberOfLines() == 0, "border or non-manifold edges"

mesh = contour.GetOutput()
vertices, triangles = mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()
assert triangles > 1000 and 2 * vertices - triangles == 4, (vertices, triangles)
normals = mesh.GetPointData().GetNormals()
for v in range(0, vertices, 7):
    point, normal = mesh.GetPoint(v), normals.GetTuple3(v)
    radius = sum(x * x for x in point) ** 0.5
    assert abs(radius - 0.75) < 1e-3, (v, point)
    assert sum(x * n for x, n in zip(point, normal)) > 0.99 * radius, (v, point, normal)
print(vertices, "vertices,", triangles, "triangles")
