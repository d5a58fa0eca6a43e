"""Prints what VTK finds in a VRML file, as sample_models does, but for the colours, which VTK keeps in a table
with other things: vtk_figures.py FILE. VTK 9.1 scales, but leaves out a Transform's rotation; the half turn about
x is made up for here. It reads numbers with the C library, all of them as 0 in a process that took over LC_NUMERIC
from a German environment, which Python does not."""

import sys

from vtkmodules.vtkIOImport import vtkVRMLImporter

(path,) = sys.argv[1:]
importer = vtkVRMLImporter()
importer.SetFileName(path)
importer.Read()
actors = importer.GetRenderer().GetActors()
actors.InitTraversal()
points = faces = 0
low, high = [float("inf")] * 3, [float("-inf")] * 3
for _ in range(actors.GetNumberOfItems()):
    actor = actors.GetNextActor()
    mapper = actor.GetMapper()
    mapper.Update()
    points += mapper.GetInput().GetNumberOfPoints()
    faces += mapper.GetInput().GetNumberOfPolys()
    bounds = actor.GetBounds()
    low = [min(a, b) for a, b in zip(low, bounds[0::2])]
    high = [max(a, b) for a, b in zip(high, bounds[1::2])]
print(path, points, faces, "-", low[0], -high[1], -high[2], high[0], -low[1], -low[2])
