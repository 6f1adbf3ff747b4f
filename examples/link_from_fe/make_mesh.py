"""Writes link.inp, the mesh of the link for CalculiX: 20 hexahedra of 20 nodes (C3D20), SI units.

The link is a plate 0.15 x 0.05 x 0.02 m about the origin, with two holes of radius 0.0125 m through z at x = -0.05 and 0.05.
Each hole has a ring of eight elements; four stand between the two rings. Nodes between corners lie on the circle or on the
middle of a straight edge.
"""

import math

HALF_LENGTH, HALF_WIDTH, HALF_THICKNESS = 0.075, 0.025, 0.01
CENTRE, RADIUS = 0.05, 0.0125

# CalculiX: corners below (z < 0), corners above, edges below, edges above, edges along z.
FACE_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))

nodes = {}  # (x, y, z) rounded -> number
order = []
elements = []


def node(x, y, z):
    key = tuple(round(c, 9) + 0.0 for c in (x, y, z))
    if key not in nodes:
        nodes[key] = len(order) + 1
        order.append(key)
    return nodes[key]


def add(corners, middles):
    """A hexahedron over a quadrilateral: its corners and the middles of its edges (x, y), counterclockwise."""
    z = HALF_THICKNESS
    elements.append(
        [node(*p, -z) for p in corners]
        + [node(*p, z) for p in corners]
        + [node(*p, -z) for p in middles]
        + [node(*p, z) for p in middles]
        + [node(*p, 0.0) for p in corners]
    )


def half(a, b):
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


def on_circle(centre, angle):
    return (centre + RADIUS * math.cos(angle), RADIUS * math.sin(angle))


def on_square(centre, eighth):
    """The point of the square around a hole at so many eighths of a turn."""
    x, y = math.cos(eighth * math.pi / 4), math.sin(eighth * math.pi / 4)
    scale = HALF_WIDTH / max(abs(x), abs(y))
    return (centre + scale * x, scale * y)


for centre in (-CENTRE, CENTRE):
    for i in range(8):
        turn = math.pi / 4
        corners = [on_circle(centre, i * turn), on_square(centre, i), on_square(centre, i + 1), on_circle(centre, (i + 1) * turn)]
        middles = [half(corners[a], corners[b]) for a, b in FACE_EDGES]
        middles[3] = on_circle(centre, (i + 0.5) * turn)
        add(corners, middles)
for x in (-HALF_WIDTH, 0.0):
    for y in (-HALF_WIDTH, 0.0):
        w = HALF_WIDTH
        corners = [(x, y), (x + w, y), (x + w, y + w), (x, y + w)]
        add(corners, [half(corners[a], corners[b]) for a, b in FACE_EDGES])

with open("link.inp", "w") as out:
    print("** Written by make_mesh.py: steel link, SI units.", file=out)
    print("*NODE, NSET=ALL_NODES", file=out)
    for number, (x, y, z) in enumerate(order, 1):
        print(f"{number}, {x:.9f}, {y:.9f}, {z:.9f}", file=out)
    print("*ELEMENT, TYPE=C3D20, ELSET=LINK", file=out)
    for number, element in enumerate(elements, 1):
        print(f"{number}, " + ", ".join(map(str, element[:15])) + ",", file=out)
        print(", ".join(map(str, element[15:])), file=out)
    print("*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850.\n*SOLID SECTION, ELSET=LINK, MATERIAL=STEEL", file=out)
