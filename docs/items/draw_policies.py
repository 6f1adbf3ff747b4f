"""Drawings of the policies: the enforcement of a pin between body a (grey) and body b (blue)."""

from sketch import BLUE, GREEN, GREY, INK, ORANGE, RED, Sketch


def two_bars(title, gap=0.0):
    s = Sketch(title)
    s.bar((-3.0, -0.3), (-gap, 0), GREY)
    s.bar((gap, 0), (3.0, 0.6), BLUE)
    return s


def constraint():
    s = two_bars("Constraint")
    s.pivot((0, 0), 0.15)
    for direction, name in ((1.1, "λ"), (-1.1, "−λ")):
        s.path([s.at((0, 0.3 * direction)), s.at((0, direction))], colour=RED, width=2.2, head=True)
        s.text((0.35, direction), name, RED)
    return s


def springs(title, names):
    s = Sketch(title)
    s.bar((-3.2, -0.6), (-1.0, -0.6), GREY)
    s.bar((1.0, 0.4), (3.2, 0.8), BLUE)
    s.bar((-1.0, -1.4), (-1.0, 1.2), GREY, 0.2)
    s.bar((1.0, -1.4), (1.0, 1.2), BLUE, 0.2)
    s.spring((-0.9, 0.6), (0.9, 0.6))
    s.damper((-0.9, -0.1), (0.9, -0.1))
    s.spring((-0.9, -0.9), (0.9, -0.9), 4)
    s.text((0, 0.95), names[0], RED)
    s.text((0, -0.6), names[1], RED)
    s.text((0, -1.4), names[2], RED)
    return s


def bushing():
    s = Sketch("Bushing")
    s.bar((-3.2, -0.3), (-1.0, 0), GREY, 0.4)
    for radius, colour in ((1.15, GREY), (0.95, ORANGE), (0.45, BLUE)):
        s.pivot((0, 0), radius, colour)
    s.bar((0.2, 0.05), (3.2, 0.5), BLUE, 0.3)
    s.text((0, 0.58), "K, C", INK, 14)
    return s


def nonlinear_bushing():
    s = Sketch("Nonlinear bushing")
    s.path([s.at((-2.6, 0)), s.at((2.6, 0))], head=True)
    s.path([s.at((0, -2)), s.at((0, 2))], head=True)
    s.path([s.at((x / 20, 0.35 * x / 20 + 0.16 * (x / 20) ** 3)) for x in range(-43, 44)], colour=BLUE, width=2.4)
    s.text((2.9, -0.35), "xᵢ")
    s.text((-0.4, 1.9), "fᵢ")
    return s


def cable(s, points, colour):
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = points
    curve = []
    for k in range(31):
        t = k / 30
        b = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        curve.append((b[0] * x0 + b[1] * x1 + b[2] * x2 + b[3] * x3, b[0] * y0 + b[1] * y1 + b[2] * y2 + b[3] * y3))
    s.path([s.at(p) for p in curve], colour=colour, width=6.0)


def ancf_linear():
    s = Sketch("Elimination of ANCF coordinates")
    cable(s, ((-3.2, -0.6), (-2.2, 0.6), (-1.0, 0.0), (0, 0.4)), GREY)
    cable(s, ((0, 0.4), (1.0, 0.8), (2.0, 0.9), (3.1, -0.3)), BLUE)
    for p in ((-3.2, -0.6), (0, 0.4), (3.1, -0.3)):
        s.pivot(p, 0.11)
    s.path([s.at((0, 0.4)), s.at((1.1, 0.84))], colour=RED, head=True)
    s.text((0.6, 1.15), "r′", RED)
    s.text((0, -0.35), "shared: r, r′", RED, 14)
    return s


def joint_coordinates():
    s = Sketch("Joint coordinates", origin=(90, 60))
    points = [(0, 0), (1.8, -1.0), (3.9, -0.7), (5.4, -1.9)]
    colours = [GREY, BLUE, BLUE]
    s.ground((-0.6, 0.25), (0.6, 0.25), -0.16)
    for p, q, colour in zip(points, points[1:], colours):
        s.bar(p, q, colour)
    for k, p in enumerate(points[:3]):
        s.pivot(p, 0.14)
        s.text((p[0] + 0.1, p[1] - 0.75), f"u{'₁₂₃'[k]}", GREEN)
        s.arc(p, 0.45, -2.2, -0.3)
    return s


DRAWINGS = {
    "constraint": constraint,
    "penalty": lambda: springs("Penalty", ("k", "c", "k")),
    "penalty_per_equation": lambda: springs("Penalty for each equation", ("k₁", "c₁", "k₂")),
    "bushing": bushing,
    "nonlinear_bushing": nonlinear_bushing,
    "ancf_linear": ancf_linear,
    "joint_coordinates": joint_coordinates,
}
