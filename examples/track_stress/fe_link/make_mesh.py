"""Writes link.inp, the mesh of the M113's steel link for CalculiX: 6 x 6 x 1 hexahedra of 20 nodes (C3D20), SI units.

The link is the block of link_bar in examples/m113/links.hpp about the origin: x from the rear pin to the
front pin, y along the pins, z to the wheels. The numbers are those of examples/m113/data.hpp.
"""

from hexahedra import Mesh, middles_of

PITCH, WIDTH, MASS = 0.1524, 2 * 0.1905, 18.024
YOUNG, SHEAR, DENSITY = 200.0e9, 76.9e9, 7800.0
HEIGHT = MASS / (DENSITY * PITCH * WIDTH)
ALONG, ACROSS = 6, 6

mesh = Mesh()
mesh.young, mesh.poisson, mesh.density = YOUNG, YOUNG / (2 * SHEAR) - 1, DENSITY
for i in range(ALONG):
    for j in range(ACROSS):
        x = [PITCH * ((i + k) / ALONG - 0.5) for k in (0, 1)]
        y = [WIDTH * ((j + k) / ACROSS - 0.5) for k in (0, 1)]
        corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
        mesh.add(corners, middles_of(corners), HEIGHT / 2)
mesh.write("link.inp", "steel link of the M113's track")
