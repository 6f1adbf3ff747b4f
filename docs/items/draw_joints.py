"""Drawings of the joint geometries. The joint is at the origin; body a is on the left, body b on the right."""

from math import cos, pi, sin

from sketch import BLUE, GREEN, GREY, INK, ORANGE, RED, Sketch, add, circle

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
DARK = "#555555"


def axes(s, at=(0, 0, 0), length=1.35, names=("a₁", "a₂", "a₃"), colour=ORANGE, directions=(X, Y, Z)):
    for axis, name in zip(directions, names):
        if name:
            s.arrow(at, add(at, axis, length), colour, name)


def bodies(s, along=X, near=0.9, size=(1.5, 0.7, 0.5)):
    """Body a behind the joint; returns a function that draws body b in front of it."""
    full = size if along == X else (size[1], size[0], size[2])
    far = near + 0.5 * size[0]
    s.box(add((0, 0, 0), along, -far), full, GREY)
    return lambda: s.box(add((0, 0, 0), along, far), full, BLUE)


def names_of_bodies(s, a=(-2.3, -0.5), b=(2.3, -1.8)):
    s.text(a, "body a", DARK, 14)
    s.text(b, "body b", "#2f6fa8", 14)


def spherical():
    s = Sketch("Spherical joint")
    front = bodies(s)
    s.cylinder((-0.95, 0, 0), (-0.3, 0, 0), 0.2, GREY)
    s.ball((-0.08, 0, 0), 0.46, GREY)
    s.ball((0, 0, 0), 0.34, BLUE)
    s.cylinder((0.25, 0, 0), (0.95, 0, 0), 0.14, BLUE)
    front()
    for axis in (X, Y, Z):
        s.turn(add((0, 0, 0), axis, 1.0), axis, 0.26)
    axes(s)
    names_of_bodies(s)
    return s


def hinge(title):
    s = Sketch(title)
    front = bodies(s)
    s.box((-0.6, 0, -0.32), (0.7, 0.5, 0.2), GREY)
    s.cylinder((0, 0, -0.42), (0, 0, -0.2), 0.36, GREY)
    s.cylinder((0, 0, -0.2), (0, 0, 0.2), 0.36, BLUE)
    s.box((0.6, 0, 0), (0.7, 0.5, 0.36), BLUE)
    s.box((-0.6, 0, 0.32), (0.7, 0.5, 0.2), GREY)
    s.cylinder((0, 0, 0.2), (0, 0, 0.42), 0.36, GREY)
    s.cylinder((0, 0, 0.42), (0, 0, 0.62), 0.12, DARK)
    front()
    names_of_bodies(s)
    return s


def revolute():
    s = hinge("Revolute joint")
    s.turn((0, 0, 1.25), Z, 0.42)
    axes(s, (0, 0, 0.62), 1.35, ("a₁", "a₂", "a₃"))
    return s


def revolute_pin():
    s = hinge("Revolute pin of the thesis")
    s.turn((0, 0, 1.35), Z, 0.36)
    s.arrow((0, 0, 0.62), (0, 0, 1.95), ORANGE, "a₃")
    for z, name in ((-0.9, "r_a"), (0.9, "r_b")):
        s.ball((0, 0, z), 0.07, RED)
        s.text(add((0.55, 0, z), Z, -0.05), name, RED, 14)
    s.curve([(0, 0, -0.9), (0, 0, -0.45)], colour=RED, dash="4 3")
    s.text((-1.3, 1.35), "distance L", RED, 14)
    return s


def universal():
    s = Sketch("Universal joint")
    front = bodies(s, Y)
    for x in (-0.5, 0.5):
        s.box((x, -0.45, 0), (0.14, 1.0, 0.3), GREY)
    s.cylinder((-0.65, 0, 0), (0.65, 0, 0), 0.11, DARK)
    s.cylinder((0, 0, -0.65), (0, 0, 0.65), 0.11, DARK)
    for z in (-0.5, 0.5):
        s.box((0, 0.45, z), (0.3, 1.0, 0.14), BLUE)
    front()
    s.turn((1.0, 0, 0), X, 0.3)
    s.turn((0, 0, 1.1), Z, 0.3)
    s.arrow((0.65, 0, 0), (1.6, 0, 0), ORANGE, "a₁")
    s.arrow((0, 0, 0.65), (0, 0, 1.75), "#2f6fa8", "b₃")
    names_of_bodies(s, (-2.5, 0.6), (2.4, 2.0))
    return s


def sleeve(title, thread=False):
    s = Sketch(title)
    s.cylinder((-2.4, 0, 0), (-1.0, 0, 0), 0.2, BLUE)
    s.cylinder((-1.3, 0, 0), (0.1, 0, 0), 0.42, GREY)
    s.box((-0.6, 0, 0.62), (0.6, 0.5, 0.5), GREY)
    s.cylinder((0.1, 0, 0), (2.3, 0, 0), 0.2, BLUE)
    if thread:
        for k in range(9):
            s.curve(circle((0.3 + 0.16 * k, 0, 0), X, 0.2, -0.4 * pi, 0.5 * pi), colour=INK, width=1.0)
    names_of_bodies(s, (-1.6, 1.2), (2.1, -1.6))
    return s


def cylindrical():
    s = sleeve("Cylindrical joint")
    s.turn((0.9, 0, 0), X, 0.42)
    s.arrow((0.5, 0, 0.85), (1.7, 0, 0.85), GREEN, both=True)
    s.arrow((2.3, 0, 0), (2.9, 0, 0), ORANGE, "a₃")
    return s


def screw():
    s = sleeve("Screw joint", thread=True)
    s.turn((1.9, 0, 0), X, 0.42)
    s.arrow((0.5, 0, 0.85), (1.7, 0, 0.85), GREEN, both=True)
    s.text((1.3, 0.75), "p θ", GREEN)
    s.arrow((2.3, 0, 0), (2.9, 0, 0), ORANGE, "a₃")
    return s


def guide(title):
    s = Sketch(title)
    s.box((-1.7, 0, 0), (1.4, 0.4, 0.4), BLUE)
    s.box((-0.6, 0, 0), (1.3, 0.9, 0.9), GREY)
    s.box((1.15, 0, 0), (2.2, 0.4, 0.4), BLUE)
    names_of_bodies(s, (-1.2, 1.3), (2.1, -1.7))
    s.arrow((2.25, 0, 0), (2.9, 0, 0), ORANGE, "a₃")
    return s


def prismatic():
    s = guide("Prismatic joint")
    s.arrow((0.5, 0, 0.65), (1.7, 0, 0.65), GREEN, both=True)
    return s


def plate(title, thick=0.16):
    s = Sketch(title)
    s.box((0, 0, -0.5 - 0.5 * thick), (3.4, 2.6, thick), GREY)
    return s


def planar_joint():
    s = plate("Planar joint")
    s.box((0.2, 0, -0.2), (1.1, 1.0, 0.6), BLUE)
    s.arrow((0.8, 0, -0.45), (1.6, 0, -0.45), GREEN, both=True)
    s.arrow((0.2, 0.55, -0.45), (0.2, 1.2, -0.45), GREEN, both=True)
    s.turn((0.2, 0, 0.55), Z, 0.4)
    s.arrow((0.2, 0, 0.1), (0.2, 0, 1.2), ORANGE, "a₃")
    names_of_bodies(s, (-2.3, -1.3), (-0.9, 0.7))
    return s


def point_in_plane():
    s = plate("Point in plane")
    s.ball((0.2, 0, -0.42), 0.12, BLUE)
    s.cylinder((0.2, 0, -0.35), (0.2, 0, 0.2), 0.08, BLUE)
    s.box((0.2, 0, 0.5), (1.3, 0.7, 0.6), BLUE)
    s.arrow((0.4, 0, -0.45), (1.5, 0, -0.45), GREEN, both=True)
    s.arrow((0.2, 0.2, -0.45), (0.2, 1.2, -0.45), GREEN, both=True)
    s.arrow((-1.2, -0.6, -0.5), (-1.2, -0.6, 0.5), ORANGE, "a₃")
    s.turn((0.2, 0, 1.2), Z, 0.3)
    names_of_bodies(s, (-2.3, -1.3), (1.7, 1.5))
    return s


def point_on_line():
    s = Sketch("Point on line")
    s.box((-2.0, 0, 0), (0.7, 0.7, 0.6), GREY)
    s.cylinder((-1.65, 0, 0), (2.2, 0, 0), 0.09, GREY)
    s.box((0.3, 0, 1.0), (1.3, 0.7, 0.6), BLUE)
    s.cylinder((0.3, 0, 0.1), (0.3, 0, 0.7), 0.08, BLUE)
    s.ball((0.3, 0, 0), 0.17, BLUE)
    s.arrow((0.6, 0, -0.3), (1.7, 0, -0.3), GREEN, both=True)
    s.turn((0.3, 0, 1.7), Z, 0.3)
    s.arrow((2.2, 0, 0), (2.9, 0, 0), ORANGE, "a₃")
    names_of_bodies(s, (-2.6, 1.5), (1.9, 1.5))
    return s


def two_boxes(title, gap=1.0):
    s = Sketch(title)
    front = bodies(s, X, gap)
    front()
    names_of_bodies(s)
    return s


def constant_orientation():
    s = two_boxes("Constant orientation")
    axes(s, (-1.65, 0, 0.25), 0.9)
    axes(s, (1.65, 0, 0.25), 0.9, ("b₁", "b₂", "b₃"), "#2f6fa8")
    for axis in (X, Y, Z):
        s.arrow((0.1, 0, 0), add((0.1, 0, 0), axis, 0.6), GREEN, both=True)
    return s


def rotors(title, direction):
    s = Sketch(title)
    s.cylinder((-1.5, 0, -0.35), (-1.5, 0, 0.35), 0.7, GREY)
    s.arrow((-1.5, 0, 0.35), (-1.5, 0, 1.5), ORANGE, "a₃" if direction == Z else "u")
    begin, end = add((1.4, 0, 0), direction, -0.35), add((1.4, 0, 0), direction, 0.35)
    s.cylinder(begin, end, 0.7, BLUE)
    s.arrow(end, add(end, direction, 1.15), "#2f6fa8", "b₃" if direction == Z else "w")
    names_of_bodies(s, (-2.6, -0.7), (2.6, -1.9))
    return s


def parallel_axes():
    return rotors("Parallel axes", Z)


def perpendicular_axes():
    return rotors("Perpendicular axes", (0, -1, 0))


def weld():
    s = Sketch("Weld")
    s.box((-0.95, 0, 0), (1.9, 0.8, 0.6), GREY)
    s.box((0.95, 0, 0), (1.9, 0.8, 0.6), BLUE)
    s.curve([(0, -0.4, -0.3), (0, -0.4, 0.3), (0, 0.4, 0.3)], colour=INK, width=5.0)
    names_of_bodies(s)
    axes(s, (0, 0, 0.3), 1.1)
    return s


def relative_coordinates():
    s = Sketch("Relative coordinates")
    a, b = (-1.6, 0, -0.2), (1.2, 0.4, 0.3)
    axes(s, a, 1.1)
    turned = ((0.9, 0.35, -0.2), (-0.3, 0.92, 0.2), (0.28, -0.15, 0.95))
    axes(s, b, 1.1, ("b₁", "b₂", "b₃"), "#2f6fa8", turned)
    s.arrow(a, b, RED, "")
    s.text((-0.1, -0.45), "d", RED)
    s.turn(add(b, turned[2], 0.75), turned[2], 0.26)
    s.text((1.9, 1.9), "ψ", GREEN)
    s.ball(a, 0.08, GREY)
    s.ball(b, 0.08, BLUE)
    return s


def distance():
    s = two_boxes("Distance", 1.5)
    a, b = (-1.5, 0, 0), (1.5, 0, 0)
    s.cylinder(a, b, 0.05, DARK)
    s.ball(a, 0.12, RED)
    s.ball(b, 0.12, RED)
    s.text((0.1, 0.25), "L", RED)
    return s


def wheel(s, centre, radius, teeth, colour, phase=0.0, depth=0.12):
    points = []
    for k in range(2 * teeth):
        for turn in (0.25, 0.75):
            angle = phase + pi * (k + turn - 0.5) / teeth
            r = radius + (0.5 if k % 2 == 0 else -0.5) * depth
            points.append((centre[0] + r * cos(angle), centre[1] + r * sin(angle)))
    s.path([s.at(p) for p in points], fill=colour, closed=True, width=1.2)


def gear():
    s = Sketch("Gear", origin=(130, 120))
    a, b = (0.0, 0.0), (2.85, 0.0)
    wheel(s, a, 1.6, 20, GREY)
    wheel(s, b, 1.25, 16, BLUE, pi / 16)
    s.path([s.at(a), s.at(b)], colour=ORANGE, dash="6 4")
    s.pivot(a)
    s.pivot(b)
    s.arc(a, 0.8, 0.0, 1.2)
    s.arc(b, 0.7, pi, pi - 1.2)
    s.text((0.45, 0.95), "ψ_a", GREEN)
    s.text((2.6, 0.85), "ψ_b", GREEN)
    s.text((0, -2.05), "N_a teeth", DARK, 14)
    s.text((2.85, -2.05), "N_b teeth", "#2f6fa8", 14)
    return s


def rack_and_pinion():
    s = Sketch("Rack and pinion", origin=(190, 110))
    wheel(s, (0, 0), 1.2, 15, BLUE)
    teeth = [(-3.0, -1.6)]
    for k in range(12):
        teeth += [(-3 + 0.5 * k, -1.26), (-3 + 0.5 * k + 0.25, -1.26), (-3 + 0.5 * k + 0.25, -1.14), (-3 + 0.5 * k + 0.5, -1.14)]
    s.path([s.at(p) for p in teeth + [(3.0, -1.6)]], fill=GREY, closed=True, width=1.2)
    s.pivot((0, 0))
    s.arc((0, 0), 0.75, 2.2, 0.6)
    s.text((0, 0.4), "θ", GREEN)
    s.path([s.at((0, 0)), s.at((0.98, -0.7))], colour=ORANGE)
    s.text((0.75, -0.25), "R", ORANGE)
    s.path([s.at((-0.4, -2.0)), s.at((1.2, -2.0))], colour=ORANGE, head=True)
    s.text((1.75, -2.05), "a₁", ORANGE)
    s.text((-2.3, -2.1), "body a: rack", DARK, 14)
    s.text((2.4, 0.9), "body b: pinion", "#2f6fa8", 14)
    return s


def rolling_disc():
    s = plate("Rolling disc", 0.12)
    s.cylinder((0, 0.08, 0.4), (0, -0.08, 0.4), 0.9, BLUE)
    s.arrow((0, -0.08, 0.4), (0, -0.9, 0.4), ORANGE, "b₃")
    s.ball((0, 0, -0.5), 0.07, RED)
    s.arrow((0.2, 0, -0.5), (1.4, 0, -0.5), GREEN)
    s.text((0, -1.0), "no slip", RED, 14)
    s.turn((0, 0.1, 0.4), (0, -1, 0), 0.6, begin=2.6, end=0.2)
    names_of_bodies(s, (-2.3, -1.3), (1.6, 1.3))
    return s


def knife_edge():
    s = plate("Knife edge", 0.12)
    s.solid([(-0.8, 0, -0.5), (0.8, 0, -0.5), (0.8, 0, 0.3), (-0.8, 0, 0.3)], BLUE)
    s.arrow((0.9, 0, -0.5), (1.7, 0, -0.5), GREEN, "v", both=False)
    s.arrow((0, 0, -0.5), (0, -0.9, -0.5), RED)
    s.text((-0.5, -1.5), "velocity 0", RED, 14)
    s.turn((0, 0, 0.75), Z, 0.35)
    names_of_bodies(s, (-2.3, -1.3), (1.4, 1.2))
    return s


def prescribed_angle():
    s = hinge("Prescribed angle")
    s.turn((0, 0, 1.15), Z, 0.5, RED)
    s.text((0.95, 1.35), "ψ(t)", RED)
    s.arrow((0, 0, 0.62), (0, 0, 1.95), ORANGE, "a₃")
    return s


def prescribed_distance():
    s = two_boxes("Prescribed distance", 1.5)
    s.cylinder((-1.5, 0, 0), (0.2, 0, 0), 0.2, DARK)
    s.cylinder((0.2, 0, 0), (1.5, 0, 0), 0.09, GREY)
    s.ball((-1.5, 0, 0), 0.14, RED)
    s.ball((1.5, 0, 0), 0.14, RED)
    s.text((0.3, 0.5), "L + x(t)", RED)
    return s


def prescribed_translation():
    s = guide("Prescribed translation")
    s.arrow((0.1, 0, 0.75), (1.7, 0, 0.75), RED)
    s.text((1.3, 0.75), "s(t)", RED)
    return s


def planar_revolute():
    s = Sketch("Revolute joint in the plane")
    s.bar((-2.6, -0.6), (0, 0), GREY)
    s.bar((0, 0), (2.4, 0.9), BLUE)
    s.pivot((0, 0), 0.16)
    s.arc((0, 0), 0.9, -0.6, 1.1)
    names_of_bodies(s, (-2.2, -1.3), (2.2, 0.1))
    return s


def planar_prismatic():
    s = Sketch("Prismatic joint in the plane")
    for y in (-0.42, 0.42):
        s.bar((-1.4, y), (0.6, y), GREY, 0.3)
    s.bar((-2.4, 0), (2.6, 0), BLUE, 0.5)
    s.path([s.at((0.9, 0.65)), s.at((2.3, 0.65))], colour=GREEN, head=True)
    s.path([s.at((2.3, 0.65)), s.at((0.9, 0.65))], colour=GREEN, head=True)
    s.path([s.at((2.6, 0)), s.at((3.1, 0))], colour=ORANGE, head=True)
    s.text((3.5, -0.1), "a₁", ORANGE)
    names_of_bodies(s, (-0.5, -1.1), (2.0, -0.8))
    return s


def planar_weld():
    s = Sketch("Weld in the plane")
    s.bar((-2.6, 0), (0, 0), GREY, 0.5)
    s.bar((0, 0), (2.6, 0), BLUE, 0.5)
    s.path([s.at((0, -0.25)), s.at((0, 0.25))], width=6.0)
    names_of_bodies(s, (-1.6, -0.8), (1.6, -0.8))
    return s


DRAWINGS = {
    name: globals()[name]
    for name in [
        "spherical", "revolute", "revolute_pin", "universal", "cylindrical", "prismatic", "screw", "planar_joint", "point_on_line",
        "point_in_plane", "constant_orientation", "parallel_axes", "perpendicular_axes", "weld", "relative_coordinates", "distance", "gear",
        "rack_and_pinion", "rolling_disc", "knife_edge", "prescribed_angle", "prescribed_distance", "prescribed_translation", "planar_revolute",
        "planar_prismatic", "planar_weld",
    ]
}
