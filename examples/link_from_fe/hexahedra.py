"""A mesh of hexahedra with 20 nodes (C3D20) for CalculiX: created node by node, written to and read from an input file."""


class Mesh:
    def __init__(self):
        self.nodes = []  # [x, y, z] [m]; CalculiX counts them from 1
        self.elements = []  # 20 indices of nodes: corners below (z < 0), above, edges below, above, edges along z
        self.young = self.poisson = self.density = 0.0  # [Pa], 1, [kg/m3]
        self._place = {}

    def node(self, x, y, z):
        """The node at this position; it is created if it does not exist."""
        key = tuple(round(c, 9) + 0.0 for c in (x, y, z))
        if key not in self._place:
            self._place[key] = len(self.nodes)
            self.nodes.append(list(key))
        return self._place[key]

    def add(self, corners, middles, half_thickness):
        """A hexahedron over a quadrilateral: its corners and the middles of its edges (x, y), counterclockwise."""
        z = half_thickness
        self.elements.append(
            [self.node(*p, -z) for p in corners]
            + [self.node(*p, z) for p in corners]
            + [self.node(*p, -z) for p in middles]
            + [self.node(*p, z) for p in middles]
            + [self.node(*p, 0.0) for p in corners]
        )

    def write(self, file, title):
        with open(file, "w") as out:
            print(f"** Written by make_mesh.py: {title}, SI units.", file=out)
            print("*NODE, NSET=ALL_NODES", file=out)
            for number, (x, y, z) in enumerate(self.nodes, 1):
                print(f"{number}, {x:.9f}, {y:.9f}, {z:.9f}", file=out)
            print("*ELEMENT, TYPE=C3D20, ELSET=LINK", file=out)
            for number, element in enumerate(self.elements, 1):
                print(f"{number}, " + ", ".join(str(i + 1) for i in element[:15]) + ",", file=out)
                print(", ".join(str(i + 1) for i in element[15:]), file=out)
            print(f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{number_of(self.young)}, {number_of(self.poisson)}", file=out)
            print(f"*DENSITY\n{number_of(self.density)}", file=out)
            print("*SOLID SECTION, ELSET=LINK, MATERIAL=STEEL", file=out)

    @classmethod
    def read(cls, file):
        """The mesh of a file that `write` has written."""
        mesh, rows, section = cls(), [], ""
        for line in open(file):
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                section = line.strip("*\n").split(",")[0]
            elif section == "NODE":
                mesh.nodes.append([float(c) for c in line.split(",")[1:]])
            elif section == "ELEMENT":
                rows += [int(c) for c in line.split(",") if c.strip()]
            elif section == "ELASTIC":
                mesh.young, mesh.poisson = map(float, line.split(","))
            elif section == "DENSITY":
                mesh.density = float(line)
        mesh.elements = [[i - 1 for i in rows[at + 1 : at + 21]] for at in range(0, len(rows), 21)]
        return mesh


def number_of(x):
    """A number in CalculiX's format with at most twenty characters: 2.1e11, 7850., 0.3."""
    if x < 1e6:
        text = f"{x:.12g}"
        return text if "." in text else text + "."
    digits, power = f"{x:.12e}".split("e")
    return digits.rstrip("0") + "e" + str(int(power))


def half(a, b):
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


def middles_of(corners):
    """The middles of the edges of a quadrilateral with straight edges."""
    return [half(corners[i], corners[(i + 1) % 4]) for i in range(4)]
