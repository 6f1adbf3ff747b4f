#!/usr/bin/env python3
"""The planar beam of thesis Eqs. 2.7 to 2.10, without code of polybody: plain Python, no packages.

  tests/long/planar_lrvf.py           prints the eight numbers that docs/validated quotes from this script
  tests/long/planar_lrvf.py --check   also compares them with the rows of docs/validated

Ten linear elements with one Gauss point, consistent mass, generalised-alpha method with rho_inf = 0.8 [Chung & Hulbert
1993]. The first node is prescribed: at the origin, with a linear ramp of its angle to 1.5 rad (arm), or with the angle
zero (cantilever with a moment at its tip).
"""

import math
import sys
from pathlib import Path

LENGTH, ELEMENTS, DENSITY, RHO = 10.0, 10, 7850.0, 0.8
STIFFNESS = {"high": (1e9, 5e8, 8.33e7), "medium": (1e7, 5e6, 8.33e5), "low": (1e6, 5e5, 8.33e4)}  # Table 2.1: EA, GA, EI
L = LENGTH / ELEMENTS
SIZE = 3 * (ELEMENTS + 1)


def element(e, stiffness):
    """Internal force (6) and tangent (6x6) of the strain energy of Eq. 2.9 at the coordinates e = (x, y, angle) of two nodes."""
    EA, GA, EI = stiffness
    dx, dy, angle = (e[3] - e[0]) / L, (e[4] - e[1]) / L, 0.5 * (e[2] + e[5])
    c, s = math.cos(angle), math.sin(angle)
    stretch, shear = c * dx + s * dy, c * dy - s * dx  # Eq. 2.10: 1 + eps_xx and eps_xy
    n, q, m = EA * (stretch - 1.0), GA * shear, EI * (e[5] - e[2]) / L
    # Slopes by p = (x', y', angle, angle'), and the second derivatives of the energy by p.
    rows = [(c, s, shear, 0.0), (-s, c, -stretch, 0.0), (0.0, 0.0, 0.0, 1.0)]
    force = [n * a + q * b + m * k for a, b, k in zip(*rows)]
    tangent = [[EA * rows[0][i] * rows[0][j] + GA * rows[1][i] * rows[1][j] + EI * rows[2][i] * rows[2][j] for j in range(4)]
               for i in range(4)]
    for i, second in ((0, -s * n - c * q), (1, c * n - s * q)):
        tangent[i][2] += second
        tangent[2][i] += second
    tangent[2][2] -= stretch * n + shear * q
    # p = B e, with the entries of row i of B as (column, entry).
    B = [((0, -1 / L), (3, 1 / L)), ((1, -1 / L), (4, 1 / L)), ((2, 0.5), (5, 0.5)), ((2, -1 / L), (5, 1 / L))]
    f, k = [0.0] * 6, [[0.0] * 6 for _ in range(6)]
    for i in range(4):
        for a, x in B[i]:
            f[a] += L * x * force[i]
            for j in range(4):
                for b, y in B[j]:
                    k[a][b] += L * x * y * tangent[i][j]
    return f, k


def mass_times(a):
    """M a with the mass matrix of Eq. 2.8."""
    out = [0.0] * SIZE
    for e in range(ELEMENTS):
        for d in range(3):
            i, j, w = 3 * e + d, 3 * e + 3 + d, DENSITY * L / 6.0 / (12.0 if d == 2 else 1.0)
            out[i] += w * (2.0 * a[i] + a[j])
            out[j] += w * (a[i] + 2.0 * a[j])
    return out


def solve(A, b, first):
    """Solution of A x = b for the unknowns from `first` on, with bandwidth 5 and without pivots; the others are zero."""
    x = b[:]
    for i in range(first, SIZE):
        for r in range(i + 1, min(i + 6, SIZE)):
            w = A[r][i] / A[i][i]
            x[r] -= w * x[i]
            for c in range(i, min(i + 6, SIZE)):
                A[r][c] -= w * A[i][c]
    for i in reversed(range(first, SIZE)):
        x[i] = (x[i] - sum(A[i][c] * x[c] for c in range(i + 1, min(i + 6, SIZE)))) / A[i][i]
    return [0.0] * first + x[first:]


def motion(stiffness, angle, moment, step, end):
    """The coordinates at each step. `angle` is the angle of the first node as a function of time [rad], `moment` acts at the tip [N m]."""
    am, af = (2 * RHO - 1) / (RHO + 1), RHO / (RHO + 1)
    gamma = 0.5 - am + af
    beta = 0.25 * (gamma + 0.5) ** 2
    weight = (1 - am) / ((1 - af) * beta * step**2)
    identity = [[0.0] * SIZE for _ in range(SIZE)]
    for k in range(SIZE):
        for i, value in enumerate(mass_times([1.0 if i == k else 0.0 for i in range(SIZE)])):
            identity[i][k] = value
    mass, load = identity, [0.0] * (SIZE - 1) + [moment]
    q = [x for node in range(ELEMENTS + 1) for x in (node * L, 0.0, 0.0)]
    v = [0.0, 0.0, (angle(step) - angle(0.0)) / step] + [0.0] * (SIZE - 3)
    v[3:] = solve([row[:] for row in mass], [-x for x in mass_times(v)], 3)[3:]  # least kinetic energy at this rate of the drive
    true = solve([row[:] for row in mass], load[:], 3)
    a = true[:]
    for n in range(1, round(end / step) + 1):
        start = [x + step * w + step**2 * (0.5 - beta) * b for x, w, b in zip(q, v, a)]
        new = [x + step**2 * beta * b for x, b in zip(start, a)]
        new[:3] = 0.0, 0.0, angle(n * step)
        for _ in range(20):
            a1 = [(x - y) / (step**2 * beta) for x, y in zip(new, start)]
            true1 = [((1 - am) * x + am * y - af * z) / (1 - af) for x, y, z in zip(a1, a, true)]
            residual = [p - i for p, i in zip(load, mass_times(true1))]
            matrix = [[weight * x for x in row] for row in mass]
            for e in range(ELEMENTS):
                f, k = element(new[3 * e:3 * e + 6], stiffness)
                for i in range(6):
                    residual[3 * e + i] -= f[i]
                    for j in range(6):
                        matrix[3 * e + i][3 * e + j] += k[i][j]
            correction = solve(matrix, residual, 3)
            new = [x + d for x, d in zip(new, correction)]
            if max(map(abs, correction)) < 1e-11:
                break
        a1 = [(x - y) / (step**2 * beta) for x, y in zip(new, start)]
        true = [((1 - am) * x + am * y - af * z) / (1 - af) for x, y, z in zip(a1, a, true)]
        v = [w + step * ((1 - gamma) * x + gamma * y) for w, x, y in zip(v, a, a1)]
        q, a = new, a1
        yield q


def rotation_nodes(q):
    """Nodes of the curve r0 + integral of t1 ds (Eq. 2.2) of the linear angles."""
    x, y = q[0], q[1]
    nodes = [(x, y)]
    for e in range(ELEMENTS):
        first, last = q[3 * e + 2], q[3 * e + 5]
        middle, half = 0.5 * (first + last), 0.5 * (last - first)
        chord = L * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
        x, y = x + chord * math.cos(middle), y + chord * math.sin(middle)
        nodes.append((x, y))
    return nodes


def largest_gap(stiffness, ramp):
    """Largest distance of a node between the position mesh and the rotation mesh during the ramp [m]."""
    return max(math.dist(q[3 * i:3 * i + 2], node) for q in motion(STIFFNESS[stiffness], lambda t: 1.5 * min(t / ramp, 1.0), 0.0, 5e-3, ramp)
               for i, node in enumerate(rotation_nodes(q)))


def results():
    """{(quantity, formulation): number}, with the names of docs/validated."""
    out = {("largest gap of the meshes [m]", f"Lrvf, {name} stiffness, {ramp:g} s"): largest_gap(name, ramp)
           for name, ramp in (("high", 10.0), ("low", 4.5), ("medium", 4.5), ("medium", 10.0))}
    *_, last = motion(STIFFNESS["low"], lambda t: 0.0, 30e3, 1e-3, 2.0)
    for mesh, tip in (("position", last[-3:-1]), ("rotation", rotation_nodes(last)[-1])):
        for axis, value in zip("xy", tip):
            out[f"{axis} of the tip at 2 s, {mesh} mesh [m]", "Lrvf, low stiffness, 30 kN m, h = 1e-3 s"] = value
    return out


def main():
    found, wrong = results(), 0
    rows = {}
    for page in (Path(__file__).resolve().parents[2] / "docs/validated").glob("*.md"):
        for line in page.read_text().splitlines():
            if line.startswith("| ") and "planar_lrvf.py" in line:
                _, what, formulation, reference = (cell.strip() for cell in line.strip("|").split(" | ")[:4])
                rows[what, formulation] = reference
    for key, value in found.items():
        print(f"{key[0]}, {key[1]}: {value:.6g}")
        if "--check" in sys.argv and f"{value:.6g}" != rows.get(key):
            print(f"  but docs/validated has {rows.get(key)}.")
            wrong += 1
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
