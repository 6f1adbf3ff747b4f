"""Converts the output of CalculiX to files for polybody's read_structure:  to_matrix_market.py OUTPUT_DIR

Reads link.inp, matrices.{sti,mas,dof} and frequencies.dat in the working directory; writes link.stiffness.mtx, link.mass.mtx,
link.nodes.txt and link.reference.txt. Displacements are ordered by node, x y z for each.

"""

import sys
from pathlib import Path

from hexahedra import Mesh

out = Path(sys.argv[1])

nodes = Mesh.read("link.inp").nodes

# Line k of the .dof file: the node and direction of row k, as node.direction.
row = []
for line in open("matrices.dof"):
    node, direction = line.strip().split(".")
    row.append(3 * (int(node) - 1) + int(direction))
assert sorted(row) == list(range(1, 3 * len(nodes) + 1)), "every node needs its three displacements"


def convert(source, name, unit):
    entries = []
    for line in open(source):
        i, j, value = line.split()
        i, j = row[int(i) - 1], row[int(j) - 1]
        entries.append((min(i, j), max(i, j), float(value)))  # column, row: the lower triangle
    largest = max(abs(e[2]) for e in entries)
    entries = sorted(e for e in entries if abs(e[2]) > 1e-15 * largest)  # smaller entries are round-off
    with open(out / name, "w") as file:
        print("%%MatrixMarket matrix coordinate real symmetric", file=file)
        print(f"% {name}: {unit}, of link.inp by CalculiX 2.20; see make_matrices.sh", file=file)
        print(len(row), len(row), len(entries), file=file)
        for j, i, value in entries:
            print(i, j, f"{value:.12g}", file=file)


convert("matrices.sti", "link.stiffness.mtx", "N/m")
convert("matrices.mas", "link.mass.mtx", "kg")

with open(out / "link.nodes.txt", "w") as file:
    print("# x y z [m] of each node of link.inp", file=file)
    for node in nodes:
        print(*(f"{c:.9g}" for c in node), file=file)

# CalculiX's own results: angular frequencies (third column), and at the end of the file mass and moments of inertia.
rows = [line.split() for line in open("frequencies.dat")]
frequencies = [float(r[2]) for r in rows if len(r) == 5 and r[0].isdigit()]
total = next(r for r in reversed(rows) if len(r) == 7 and r[0] == "TOTAL")
with open(out / "link.reference.txt", "w") as file:
    print("# By CalculiX 2.20 itself: ccx -i frequencies", file=file)
    print("# mass [kg], moments of inertia about x, y, z through the origin [kg m^2]", file=file)
    print(float(total[1]), *(float(c) for c in total[4:]), file=file)
    print("# angular frequencies of the free link [rad/s]; the first six are rigid", file=file)
    print(*frequencies, sep="\n", file=file)
