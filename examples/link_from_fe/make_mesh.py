"""Writes link.inp, the mesh of the link for CalculiX: 20 hexahedra of 20 nodes (C3D20), SI units.

The link is a plate 0.15 x 0.05 x 0.02 m about the origin, with two holes of radius 0.0125 m through z at x = -0.05 and 0.05.
Each hole has a ring of eight elements, and four elements are between the two rings. Nodes between corners are on the circle
or on the middle of a straight edge.

"""

import math

from hexahedra import Mesh, middles_of

HALF_LENGTH, HALF_WIDTH, HALF_THICKNESS = 0.075, 0.025, 0.01
CENTRE, RADIUS = 0.05, 0.0125


def on_circle(centre, angle):
    return (centre + RADIUS * math.cos(angle), RADIUS * math.sin(angle))


def on_square(centre, eighth):
    """The point of the square around a hole at the given number of eighths of a turn."""
    x, y = math.cos(eighth * math.pi / 4), math.sin(eighth * math.pi / 4)
    scale = HALF_WIDTH / max(abs(x), abs(y))
    return (centre + scale * x, scale * y)


mesh = Mesh()
mesh.young, mesh.poisson, mesh.density = 2.1e11, 0.3, 7850.0
for centre in (-CENTRE, CENTRE):
    for i in range(8):
        turn = math.pi / 4
        corners = [on_circle(centre, i * turn), on_square(centre, i), on_square(centre, i + 1), on_circle(centre, (i + 1) * turn)]
        middles = middles_of(corners)
        middles[3] = on_circle(centre, (i + 0.5) * turn)
        mesh.add(corners, middles, HALF_THICKNESS)
for x in (-HALF_WIDTH, 0.0):
    for y in (-HALF_WIDTH, 0.0):
        w = HALF_WIDTH
        corners = [(x, y), (x + w, y), (x + w, y + w), (x, y + w)]
        mesh.add(corners, middles_of(corners), HALF_THICKNESS)
mesh.write("link.inp", "steel link")
