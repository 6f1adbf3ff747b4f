"""Sketches of mechanisms as SVG: solids, arrows and curves in a parallel projection of space.

World axes: x to the right and towards the reader, y to the right and away from the reader, z up. Lengths are in units of the
drawing; one unit is 52 pixels.

"""

from math import cos, hypot, pi, sin, sqrt

GREY, BLUE, ORANGE, GREEN, RED, INK = "#b9bfc6", "#5b9bd5", "#e69f00", "#009e73", "#d55e00", "#333333"
SCALE = 52.0
RIGHT = (cos(pi / 6), cos(pi / 6), 0.0)  # direction of the picture's horizontal axis in world axes
UP = (-0.5 * sin(pi / 6), 0.5 * sin(pi / 6), 0.9)
TOWARDS = (1.0, -1.0, 0.8)  # direction to the reader


def add(p, q, s=1.0):
    return tuple(a + s * b for a, b in zip(p, q))


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def unit(p):
    n = sqrt(dot(p, p))
    return tuple(a / n for a in p)


def across(axis):
    """Two unit vectors perpendicular to `axis` and to each other."""
    axis = unit(axis)
    first = unit(cross((0, 0, 1) if abs(axis[2]) < 0.9 else (1, 0, 0), axis))
    return first, cross(axis, first)


def circle(centre, axis, radius, begin=0.0, end=2.0 * pi, count=48):
    u, w = across(axis)
    angles = [begin + (end - begin) * k / count for k in range(count + 1)]
    return [add(add(centre, u, radius * cos(a)), w, radius * sin(a)) for a in angles]


def hull(points):
    """Convex hull of points of the picture."""
    points = sorted(set(points))

    def half(ordered):
        out = []
        for p in ordered:
            while len(out) >= 2 and (out[-1][0] - out[-2][0]) * (p[1] - out[-2][1]) <= (out[-1][1] - out[-2][1]) * (p[0] - out[-2][0]):
                out.pop()
            out.append(p)
        return out[:-1]

    return half(points) + half(points[::-1])


class Sketch:
    """A picture of `width` times `height` pixels with the world's origin at `origin` [pixels]."""

    def __init__(self, title, width=420, height=260, origin=None):
        self.title, self.width, self.height = title, width, height
        self.origin = origin or (0.5 * width, 0.55 * height)
        self.parts = []

    def at(self, p):
        if len(p) == 2:  # a point of the picture in units from the origin, y up
            return round(self.origin[0] + SCALE * p[0], 1), round(self.origin[1] - SCALE * p[1], 1)
        return round(self.origin[0] + SCALE * dot(p, RIGHT), 1), round(self.origin[1] - SCALE * dot(p, UP), 1)

    def path(self, points, colour=INK, width=1.6, fill="none", dash="", closed=False, head=False):
        text = " ".join(f"{x:g},{y:g}" for x, y in points)
        extra = f' stroke-dasharray="{dash}"' if dash else ""
        shape = "polygon" if closed else "polyline"
        self.parts.append(f'<{shape} points="{text}" fill="{fill}" stroke="{colour}" stroke-width="{width:g}"{extra}/>')
        if head:
            (x0, y0), (x1, y1) = points[-2], points[-1]
            n = hypot(x1 - x0, y1 - y0) or 1.0
            ex, ey = (x1 - x0) / n, (y1 - y0) / n
            tip = [(x1 + 9 * ex, y1 + 9 * ey), (x1 - 4.5 * ey, y1 + 4.5 * ex), (x1 + 4.5 * ey, y1 - 4.5 * ex)]
            text = " ".join(f"{x:.1f},{y:.1f}" for x, y in tip)
            self.parts.append(f'<polygon points="{text}" fill="{colour}"/>')

    def curve(self, points, **style):
        self.path([self.at(p) for p in points], **style)

    def solid(self, points, colour):
        self.path(hull([self.at(p) for p in points]), fill=colour, closed=True, width=1.2)

    def text(self, p, words, colour=INK, size=15, anchor="middle"):
        x, y = self.at(p)
        self.parts.append(f'<text x="{x:g}" y="{y:g}" font-size="{size}" fill="{colour}" text-anchor="{anchor}" '
                          f'paint-order="stroke" stroke="#ffffff" stroke-width="3">{words}</text>')

    def box(self, centre, size, colour, axes=((1, 0, 0), (0, 1, 0), (0, 0, 1))):
        """Box with three visible faces. `size` are full lengths along `axes`."""
        half = [0.5 * s for s in size]
        corner = lambda *signs: add(add(add(centre, axes[0], signs[0] * half[0]), axes[1], signs[1] * half[1]), axes[2], signs[2] * half[2])
        for i, shade in zip(range(3), (0.82, 0.68, 1.0)):
            side = 1 if dot(axes[i], TOWARDS) > 0 else -1
            face = []
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                signs = [0, 0, 0]
                signs[i], signs[(i + 1) % 3], signs[(i + 2) % 3] = side, a, b
                face.append(self.at(corner(*signs)))
            self.path(face, fill=shaded(colour, shade), closed=True, width=1.0)

    def cylinder(self, begin, end, radius, colour):
        axis = add(end, begin, -1.0)
        caps = [circle(begin, axis, radius), circle(end, axis, radius)]
        self.solid(caps[0] + caps[1], shaded(colour, 0.82))
        self.path([self.at(p) for p in caps[1 if dot(axis, TOWARDS) > 0 else 0]], fill=colour, closed=True, width=1.0)

    def ball(self, centre, radius, colour):
        x, y = self.at(centre)
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="{SCALE * radius:g}" fill="{colour}" stroke="{INK}" stroke-width="1.2"/>')

    def arrow(self, begin, end, colour=INK, label="", both=False, width=1.8):
        self.curve([begin, end], colour=colour, width=width, head=True)
        if both:
            self.curve([end, begin], colour=colour, width=width, head=True)
        if label:
            way = add(end, begin, -1.0)
            self.text(add(end, way, 0.4 / max(sqrt(dot(way, way)), 1e-9)), label, colour)

    def turn(self, centre, axis, radius, colour=GREEN, begin=0.3, end=5.2):
        """Arrow along an arc about `axis`."""
        self.curve(circle(centre, axis, radius, begin, end), colour=colour, width=2.0, head=True)

    def spring(self, begin, end, coils=6, radius=0.16, colour=INK):
        """Zigzag between two points of space or of the picture."""
        (x0, y0), (x1, y1) = self.at(begin), self.at(end)
        ex, ey, n, r = x1 - x0, y1 - y0, 2 * coils, SCALE * radius
        length = hypot(ex, ey)
        points = [(x0, y0), (x0 + 0.1 * ex, y0 + 0.1 * ey)]
        for k in range(n):
            s, side = 0.1 + 0.8 * (k + 0.5) / n, r if k % 2 else -r
            points.append((round(x0 + s * ex - side * ey / length, 1), round(y0 + s * ey + side * ex / length, 1)))
        self.path(points + [(x0 + 0.9 * ex, y0 + 0.9 * ey), (x1, y1)], colour=colour)

    def damper(self, begin, end, colour=INK):
        """Cylinder with a piston between two points."""
        (x0, y0), (x1, y1) = self.at(begin), self.at(end)
        length = hypot(x1 - x0, y1 - y0)
        ex, ey = (x1 - x0) / length, (y1 - y0) / length
        place = lambda s, side: (round(x0 + s * length * ex - side * ey, 1), round(y0 + s * length * ey + side * ex, 1))
        self.path([(x0, y0), place(0.35, 0)], colour=colour)
        self.path([place(0.65, 8), place(0.35, 8), place(0.35, -8), place(0.65, -8)], colour=colour)
        self.path([place(0.55, 6), place(0.55, -6)], colour=colour, width=2.4)
        self.path([place(0.55, 0), (x1, y1)], colour=colour)

    def ground(self, begin, end, hatch=0.16):
        """Hatched line between two points of the picture."""
        (x0, y0), (x1, y1) = self.at(begin), self.at(end)
        length = hypot(x1 - x0, y1 - y0)
        ex, ey, h = (x1 - x0) / length, (y1 - y0) / length, SCALE * hatch
        self.path([(x0, y0), (x1, y1)], width=2.0)
        for k in range(int(length / 10)):
            x, y = x0 + (10 * k + 6) * ex, y0 + (10 * k + 6) * ey
            self.path([(round(x, 1), round(y, 1)), (round(x - h * ex - h * ey, 1), round(y - h * ey + h * ex, 1))], width=1.0)

    def bar(self, p, q, colour, width=0.32):
        """Rectangle about the line between two points of the picture."""
        (x0, y0), (x1, y1) = p, q
        n = hypot(x1 - x0, y1 - y0)
        ex, ey = 0.5 * width * (x1 - x0) / n, 0.5 * width * (y1 - y0) / n
        corners = ((x0 - ey, y0 + ex), (x1 - ey, y1 + ex), (x1 + ey, y1 - ex), (x0 + ey, y0 - ex))
        self.path([self.at(c) for c in corners], fill=colour, closed=True, width=1.2)

    def pivot(self, p, size=0.12, colour="#ffffff"):
        x, y = self.at(p)
        self.parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="{SCALE * size:g}" fill="{colour}" stroke="{INK}" stroke-width="1.4"/>')

    def arc(self, centre, radius, begin, end, colour=GREEN, head=True):
        """Arc in the picture, from the angle `begin` to the angle `end`."""
        angles = [begin + (end - begin) * k / 30 for k in range(31)]
        self.path([self.at((centre[0] + radius * cos(a), centre[1] + radius * sin(a))) for a in angles], colour=colour, width=2.0, head=head)

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" '
                f'height="{self.height}" font-family="Helvetica, Arial, sans-serif" stroke-linejoin="round" stroke-linecap="round">')
        back = f'<rect width="{self.width}" height="{self.height}" fill="#ffffff"/>'
        return "\n".join([head, f"<title>{self.title}</title>", back, *self.parts, "</svg>"]) + "\n"


def shaded(colour, factor):
    """A colour #rrggbb multiplied by a factor."""
    return "#" + "".join(f"{round(factor * int(colour[k:k + 2], 16)):02x}" for k in (1, 3, 5))
