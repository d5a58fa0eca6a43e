"""Prints what view3dscene's converter finds in a VRML file, as sample_models does: x3d_figures.py CONVERTER FILE.
Whatever the converter says on its standard error goes there too."""

import math
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

converter, path = sys.argv[1:]
converted = subprocess.run([converter, "--encoding", "xml", path], stdout=subprocess.PIPE, check=True)
scene = ElementTree.fromstring(converted.stdout).find("Scene")


def numbers(element, attribute):
    return [float(text) for text in element.get(attribute).split()] if element is not None else []


def triples(values):
    return list(zip(values[0::3], values[1::3], values[2::3]))


transform = scene.find("Transform")
scale = numbers(transform, "scale")
x_axis, y_axis, z_axis, angle = numbers(transform, "rotation")
if (x_axis, y_axis, z_axis) != (1, 0, 0):
    sys.exit("the rotation is about another axis")
cosine, sine = math.cos(angle), math.sin(angle)

points = triples(numbers(transform.find(".//Coordinate"), "point"))
colors = triples(numbers(transform.find(".//Color"), "color"))
faces = transform.find(".//IndexedFaceSet")
indices = faces.get("coordIndex").split() if faces is not None else []

scaled = [[factor * value for factor, value in zip(scale, point)] for point in points]
world = [(x, cosine * y - sine * z, sine * y + cosine * z) for x, y, z in scaled]
print(path, len(points), indices.count("-1"), len(colors), *map(min, zip(*world)), *map(max, zip(*world)))
