"""Stress of the M113's steel link at named nodes of its surface, linear in the displacements of all nodes.

  stress_operator.py load              writes load.inp: a static load case for CalculiX
  stress_operator.py write OUTPUT_DIR  writes link.stress.mtx, link.stress_nodes.txt and link.reference_load.txt

sigma = D B(xi_node) u of each element that shares the node, averaged over these; xx, yy, zz, xy, yz, zx [Pa]. Reads
link.inp in the working directory; `write` also load.dat and load.frd, which CalculiX made of load.inp. It checks the
operator before it writes: against states of uniform strain and pure bending, and against CalculiX's stresses of the
load case.
"""

import sys
from pathlib import Path

from hexahedra import Mesh

# Points of evaluation: fractions of pitch, width and height from the centre. The block has no bores; the eye around a
# pin of 20 mm radius ends at a third of the pitch.
SPOTS = {
    "middle, wheel side": (0, 0, 0.5),
    "middle, ground side": (0, 0, -0.5),
    "middle edge, wheel side": (0, 0.5, 0.5),
    "outer third, wheel side": (0, 1 / 3, 0.5),
    "third, wheel side": (1 / 6, 0, 0.5),
    "third, ground side": (1 / 6, 0, -0.5),
    "front eye, wheel side": (1 / 3, 0, 0.5),
    "front eye edge, ground side": (1 / 3, -0.5, -0.5),
    "rear eye, wheel side": (-1 / 3, 0, 0.5),
}

# Natural coordinates of the 20 nodes, in CalculiX's order.
CORNERS = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
SIDES = [(0, -1), (1, 0), (0, 1), (-1, 0)]
PLACES = [(*p, z) for at, zs in ((CORNERS, (-1, 1)), (SIDES, (-1, 1)), (CORNERS, (0,))) for z in zs for p in at]

GAUSS = [(-(0.6**0.5), 5 / 9), (0.0, 8 / 9), (0.6**0.5, 5 / 9)]
PULL, LIFT = 100.0e3, 20.0e3  # forces on the front face along x and z [N]
UNEVEN = 0.5  # the pull at y is its mean times 1 + UNEVEN 2y/width


def shape(i, at):
    """Shape function i of the quadratic serendipity hexahedron, and its derivatives."""
    place = PLACES[i]
    f = [1 + p * c if p else 1 - c * c for p, c in zip(place, at)]
    d = [p if p else -2 * c for p, c in zip(place, at)]
    product = f[0] * f[1] * f[2]
    slopes = [d[0] * f[1] * f[2], f[0] * d[1] * f[2], f[0] * f[1] * d[2]]
    if 0 in place:
        return product / 4, [s / 4 for s in slopes]
    rest = sum(p * c for p, c in zip(place, at)) - 2
    return product * rest / 8, [(s * rest + product * p) / 8 for s, p in zip(slopes, place)]


def inverse(m):
    """The inverse of a 3 x 3 matrix."""

    def cofactor(i, j):
        a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
        return m[a][c] * m[b][d] - m[a][d] * m[b][c]

    minor = [[cofactor(j, i) for j in range(3)] for i in range(3)]
    determinant = sum(m[0][i] * minor[i][0] for i in range(3))
    return [[c / determinant for c in row] for row in minor]


class Stress:
    """The operator of a mesh of one isotropic material."""

    def __init__(self, mesh):
        self.mesh = mesh
        self.shear = mesh.young / (2 * (1 + mesh.poisson))
        self.lame = mesh.young * mesh.poisson / ((1 + mesh.poisson) * (1 - 2 * mesh.poisson))

    def in_element(self, element, at):
        """Six rows {column: Pa/m} of D B at natural coordinates."""
        natural = [shape(i, at)[1] for i in range(20)]
        places = [self.mesh.nodes[n] for n in element]
        jacobian = [[sum(d[a] * r[c] for d, r in zip(natural, places)) for c in range(3)] for a in range(3)]
        turn = inverse(jacobian)
        rows = [{} for _ in range(6)]
        for i, n in enumerate(element):
            g = [sum(turn[c][a] * natural[i][a] for a in range(3)) for c in range(3)]
            for c in range(3):
                for row in range(3):
                    rows[row][3 * n + c] = self.lame * g[c] + (2 * self.shear * g[c] if row == c else 0)
            for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 3):
                rows[row][3 * n + a] = self.shear * g[b]
                rows[row][3 * n + b] = self.shear * g[a]
        return rows

    def at_node(self, node):
        """Six rows of the mean over the elements that share the node."""
        shares = [e for e in self.mesh.elements if node in e]
        mean = [{} for _ in range(6)]
        for element in shares:
            for into, row in zip(mean, self.in_element(element, PLACES[element.index(node)])):
                for column, value in row.items():
                    into[column] = into.get(column, 0) + value / len(shares)
        return mean


def times(rows, u):
    return [sum(value * u[column] for column, value in row.items()) for row in rows]


def largest_difference(a, b):
    return max(abs(x - y) for one, other in zip(a, b) for x, y in zip(one, other))


def field(mesh, displacement):
    return [c for node in mesh.nodes for c in displacement(*node)]


def check_exact_states(stress, operator):
    """Six states of uniform strain, and pure bending about y, which quadratic elements represent exactly."""
    mesh, strain = stress.mesh, 1e-3
    for k, (a, b) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        u = field(mesh, lambda *r: [strain / 2 * (r[b] * (c == a) + r[a] * (c == b)) for c in range(3)])
        own = stress.shear * (2 if k < 3 else 1)
        exact = [strain * (stress.lame * (k < 3 and row < 3) + own * (row == k)) for row in range(6)]
        difference = largest_difference(at_spots(operator, u), [exact] * len(operator))
        report("uniform strain", difference / (strain * mesh.young), 1e-9)
    nu = mesh.poisson
    u = field(mesh, lambda x, y, z: (x * z, -nu * y * z, -(x * x + nu * (z * z - y * y)) / 2))
    exact = [[mesh.young * mesh.nodes[n][2], 0, 0, 0, 0, 0] for n in spot_nodes(mesh)]
    report("pure bending", largest_difference(at_spots(operator, u), exact) / (0.02 * mesh.young), 1e-7)


def report(what, difference, allowed):
    print(f"{what}: {difference:.2e} of the largest stress, allowed {allowed:g}")
    assert difference <= allowed, what


def spot_nodes(mesh):
    """The nodes of SPOTS."""
    size = [2 * max(node[c] for node in mesh.nodes) for c in range(3)]
    at = {tuple(round(c, 7) + 0.0 for c in node): n for n, node in enumerate(mesh.nodes)}
    return [at[tuple(round(f * s, 7) + 0.0 for f, s in zip(spot, size))] for spot in SPOTS.values()]


def front_loads(mesh):
    """Nodal forces {column: N} on the front face by the elements' shape functions: a pull that is linear in y, and a uniform lift."""
    front, width = max(n[0] for n in mesh.nodes), 2 * max(n[1] for n in mesh.nodes)
    loads = {}
    for element in mesh.elements:
        if all(abs(mesh.nodes[n][0] - front) > 1e-6 for n in element):
            continue
        ys = [mesh.nodes[n][1] for n in element]
        share = (max(ys) - min(ys)) / width / 4
        for eta, w in GAUSS:
            for zeta, v in GAUSS:
                values = [shape(i, (1, eta, zeta))[0] for i in range(20)]
                y = sum(value * mesh.nodes[n][1] for value, n in zip(values, element))
                for c, force in ((0, PULL * (1 + UNEVEN * 2 * y / width)), (2, LIFT)):
                    for value, n in zip(values, element):
                        if abs(value) > 1e-12:
                            loads[3 * n + c] = loads.get(3 * n + c, 0) + share * w * v * value * force
    return loads


def write_load(mesh):
    rear = min(n[0] for n in mesh.nodes)
    with open("load.inp", "w") as out:
        print("** Written by stress_operator.py: the rear face is clamped; pull and lift on the front face.", file=out)
        print("*INCLUDE, INPUT=link.inp\n*BOUNDARY", file=out)
        for n, node in enumerate(mesh.nodes, 1):
            if abs(node[0] - rear) < 1e-6:
                print(f"{n}, 1, 3", file=out)
        print("*STEP\n*STATIC\n*CLOAD", file=out)
        for column, force in sorted(front_loads(mesh).items()):
            print(f"{column // 3 + 1}, {column % 3 + 1}, {force:.10g}", file=out)
        print("*NODE PRINT, NSET=ALL_NODES\nU\n*EL PRINT, ELSET=LINK\nS\n*EL FILE\nS\n*END STEP", file=out)


def read_results():
    """CalculiX's displacements (of all nodes), stresses at the integration points, stresses at the nodes."""
    u, points, nodal, section = [], [], [], ""
    for line in open("load.dat"):
        words = line.split()
        if words and words[0] in ("displacements", "stresses"):
            section = words[0]
        elif words and section == "displacements":
            u += map(float, words[1:])
        elif words and section == "stresses":
            points.append([float(c) for c in words[2:8]])
    for line in open("load.frd"):
        if line.startswith(" -4"):
            section = line.split()[1]
        elif line.startswith(" -1") and section == "STRESS":
            nodal.append([float(line[at : at + 12]) for at in range(13, 85, 12)])
    # CalculiX writes xx, yy, zz, xy, yz, zx to the .frd file and xx, yy, zz, xy, xz, yz to the .dat file.
    return u, [p[:4] + [p[5], p[4]] for p in points], nodal


def check_load_case(stress, operator):
    """CalculiX's own stresses: at the integration points, and extrapolated from these to the nodes."""
    mesh = stress.mesh
    u, points, nodal = read_results()
    assert len(u) == 3 * len(mesh.nodes) and len(nodal) == len(mesh.nodes) and len(points) == 27 * len(mesh.elements)
    places = [(xi, eta, zeta) for zeta, _ in GAUSS for eta, _ in GAUSS for xi, _ in GAUSS]
    mine = [times(stress.in_element(e, at), u) for e in mesh.elements for at in places]
    largest = max(abs(c) for p in points for c in p)
    report("integration points", largest_difference(mine, points) / largest, 1e-4)
    at_nodes = [nodal[n] for n in spot_nodes(mesh)]
    largest = max(abs(c) for p in at_nodes for c in p)
    report("named nodes", largest_difference(at_spots(operator, u), at_nodes) / largest, 1e-4)
    return u, at_nodes


def at_spots(operator, u):
    return [times(rows, u) for rows in operator]


def write_operator(out, mesh, operator):
    largest = max(abs(v) for rows in operator for row in rows for v in row.values())
    entries = [
        (6 * k + row + 1, column + 1, value)
        for k, rows in enumerate(operator)
        for row, values in enumerate(rows)
        for column, value in sorted(values.items())
        if abs(value) > 1e-13 * largest  # smaller entries are round-off
    ]
    with open(out / "link.stress.mtx", "w") as file:
        print("%%MatrixMarket matrix coordinate real general", file=file)
        print("% Pa/m: xx, yy, zz, xy, yz, zx of each node of link.stress_nodes.txt; by stress_operator.py", file=file)
        print(6 * len(operator), 3 * len(mesh.nodes), len(entries), file=file)
        for row, column, value in entries:
            print(row, column, f"{value:.12g}", file=file)
    with open(out / "link.stress_nodes.txt", "w") as file:
        print("# node (of link.nodes.txt, from 0) and name, in the order of the rows of link.stress.mtx", file=file)
        for name, n in zip(SPOTS, spot_nodes(mesh)):
            print(n, name, file=file)


def write_reference(out, u, nodal):
    with open(out / "link.reference_load.txt", "w") as file:
        print("# By CalculiX 2.20 itself: ccx -i load. The rear face is clamped; on the front face", file=file)
        print("# the pull [N] along x, 1 + (third number) 2y/width of its mean, and the lift [N] along z", file=file)
        print(f"{PULL:g} {LIFT:g} {UNEVEN:g}", file=file)
        print("# displacement of each node [m]", file=file)
        for at in range(0, len(u), 3):
            print(*(f"{c:.6e}" for c in u[at : at + 3]), file=file)
        print("# stress at each named node, extrapolated from integration points: xx yy zz xy yz zx [Pa]", file=file)
        for row in nodal:
            print(*(f"{c:.5e}" for c in row), file=file)


def main():
    mesh = Mesh.read("link.inp")
    if sys.argv[1] == "load":
        write_load(mesh)
        return
    stress = Stress(mesh)
    operator = [stress.at_node(n) for n in spot_nodes(mesh)]
    check_exact_states(stress, operator)
    u, nodal = check_load_case(stress, operator)
    write_operator(Path(sys.argv[2]), mesh, operator)
    write_reference(Path(sys.argv[2]), u, nodal)


main()
