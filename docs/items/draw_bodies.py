"""Drawings of the bodies."""

from math import cos, pi, sin

from sketch import BLUE, GREEN, GREY, INK, ORANGE, RED, Sketch, add, circle

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def rigid():
    s = Sketch("Rigid body in space")
    s.box((0, 0, 0), (2.4, 1.4, 0.9), BLUE)
    for axis in (X, Y, Z):
        s.arrow((0, 0, 0.45), add((0, 0, 0.45), axis, 1.6), ORANGE)
    s.turn((0, 0, 1.5), Z, 0.4)
    s.text((0.9, 2.1), "ω", GREEN)
    s.arrow((-1.8, -1.8, -1.2), (0, 0, 0.45), INK)
    s.text((-1.5, -0.55), "r")
    return s


def planar_rigid():
    s = Sketch("Rigid body in the plane", origin=(80, 200))
    s.path([s.at((0, 0)), s.at((1.2, 0))], head=True)
    s.path([s.at((0, 0)), s.at((0, 1.2))], head=True)
    outline = [(2.2, 0.6), (4.8, 1.0), (5.3, 2.2), (4.2, 3.0), (2.4, 2.3)]
    s.path([s.at(p) for p in outline], fill=BLUE, closed=True, width=1.4)
    s.path([s.at((0, 0)), s.at((3.7, 1.8))], head=True)
    s.text((1.7, 1.2), "r")
    s.arc((3.7, 1.8), 0.6, 0.2, 3.8)
    s.text((4.7, 1.9), "θ", GREEN)
    return s


def hermite(p, dp, q, dq, count=24):
    out = []
    for k in range(count + 1):
        t = k / count
        h = (1 - 3 * t * t + 2 * t**3, t - 2 * t * t + t**3, 3 * t * t - 2 * t**3, t**3 - t * t)
        out.append(tuple(h[0] * a + h[1] * b + h[2] * c + h[3] * d for a, b, c, d in zip(p, dp, q, dq)))
    return out


NODES = [((-3.0, -0.8), (2.2, 2.4)), ((0.0, 0.3), (2.6, -1.0)), ((3.0, 0.5), (1.6, 2.4))]


def ancf_cable():
    s = Sketch("ANCF cable")
    for (p, dp), (q, dq) in zip(NODES, NODES[1:]):
        s.path([s.at(x) for x in hermite(p, dp, q, dq)], colour=BLUE, width=7.0)
    for p, dp in NODES:
        s.path([s.at(p), s.at((p[0] + 0.45 * dp[0], p[1] + 0.45 * dp[1]))], colour=RED, width=2.2, head=True)
        s.pivot(p, 0.12)
    s.text((-2.9, -1.35), "r₁", INK)
    s.text((-1.6, 0.5), "r₁′", RED)
    return s


def in_space(s, draw_section):
    """A curved beam in space: `draw_section(point, tangent, k)` draws a section."""
    nodes = [(-2.2, -0.6, -0.4), (-0.8, 0.3, 0.1), (0.8, 0.2, 0.5), (2.2, -0.7, 0.5)]
    slopes = [(1.6, 0.9, 0.6), (1.6, 0.3, 0.5), (1.6, -0.5, 0.3), (1.6, -1.0, -0.2)]
    for k in range(3):
        s.curve(hermite(nodes[k], slopes[k], nodes[k + 1], slopes[k + 1]), colour=BLUE, width=5.0)
    for k, (p, t) in enumerate(zip(nodes, slopes)):
        draw_section(p, t, k)


def ancf_beam():
    s = Sketch("ANCF beam")

    def section(p, t, k):
        s.arrow(p, add(p, (-0.2 + 0.1 * k, 0.9, 0.1), 0.75), RED, "r_y" if k == 3 else "")
        s.arrow(p, add(p, (-0.1, -0.1 * k, 1.0), 0.75), GREEN, "r_z" if k == 3 else "")
        s.ball(p, 0.09, "#ffffff")

    in_space(s, section)
    return s


def lrvf():
    s = Sketch("Geometrically exact beam")

    def section(p, t, k):
        s.path([s.at(x) for x in circle(p, t, 0.42)], fill="#dbe9f6", colour="#2f6fa8", closed=True, width=1.4)
        s.arrow(p, add(p, t, 0.45), ORANGE)
        s.arrow(p, add(p, (0.0, 0.1 * k, 1.0), 0.75), ORANGE, "R(s)" if k == 3 else "")
        s.ball(p, 0.07, "#ffffff")

    in_space(s, section)
    return s


def ffr():
    s = Sketch("Floating frame", origin=(60, 190))
    s.path([s.at((0, 0)), s.at((1.2, 0))], head=True)
    s.path([s.at((0, 0)), s.at((0, 1.2))], head=True)
    along, up, base = (cos(0.3), sin(0.3)), (-sin(0.3), cos(0.3)), (1.6, 0.5)
    place = lambda x, y: (base[0] + x * along[0] + y * up[0], base[1] + x * along[1] + y * up[1])
    s.path([s.at(place(0, 0)), s.at(place(4.6, 0))], colour=GREY, dash="7 5", width=5.0)
    s.path([s.at(place(0.1 * k, 0.35 * (1.0 - cos(0.1 * k * pi / 4.6)) * 1.6)) for k in range(47)], colour=BLUE, width=7.0)
    s.path([s.at(place(0, 0)), s.at(place(1.3, 0))], colour=ORANGE, width=2.2, head=True)
    s.path([s.at(place(0, 0)), s.at(place(0, 1.3))], colour=ORANGE, width=2.2, head=True)
    s.path([s.at(place(4.4, 0.05)), s.at(place(4.4, 0.85))], colour=RED, width=2.0, head=True)
    s.text(place(5.35, 0.4), "Φ q_f", RED)
    s.text((1.1, 1.7), "A", ORANGE)
    return s


def variable_mass():
    s = Sketch("Variable mass")
    s.bar((-1.0, 0), (1.8, 0), BLUE, 0.9)
    s.path([s.at((1.8, 0.45)), s.at((2.8, 0)), s.at((1.8, -0.45))], fill=BLUE, closed=True)
    s.path([s.at((-1.0, 0.3)), s.at((-1.5, 0.5)), s.at((-1.5, -0.5)), s.at((-1.0, -0.3))], fill=GREY, closed=True)
    for y in (-0.4, 0.0, 0.4):
        s.path([s.at((-1.6, 0.6 * y)), s.at((-2.7, y))], colour=RED, width=2.0, head=True)
    s.text((-3.2, -0.1), "u", RED)
    s.text((0.4, -0.12), "m(t)", INK, 16)
    return s


def with_sliders():
    s = Sketch("Slider on a cable")
    for (p, dp), (q, dq) in zip(NODES, NODES[1:]):
        s.path([s.at(x) for x in hermite(p, dp, q, dq)], colour=BLUE, width=7.0)
    for p, _ in NODES:
        s.pivot(p, 0.1)
    bead = hermite(*NODES[0], *NODES[1])[15]
    s.pivot(bead, 0.26, ORANGE)
    s.path([s.at(x) for x in [(a, b - 0.55) for a, b in hermite(*NODES[0], *NODES[1])[:16]]], colour=INK, head=True)
    s.text((-1.6, -0.85), "s")
    s.path([s.at(bead), s.at((bead[0] + 0.3, bead[1] - 1.4))], colour=RED, width=2.2, head=True)
    s.text((bead[0] + 0.65, bead[1] - 1.3), "f", RED)
    return s


DRAWINGS = {name: globals()[name] for name in ["rigid", "planar_rigid", "ancf_cable", "ancf_beam", "lrvf", "ffr", "variable_mass", "with_sliders"]}
