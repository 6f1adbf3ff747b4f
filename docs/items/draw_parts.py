"""Drawings of the ready parts: laws of one coordinate, friction, drives, shapes, wheels, the SE(3) beam and inertias."""

from math import atan, cos, exp, pi, sin, tanh

from sketch import BLUE, GREEN, GREY, INK, ORANGE, RED, Sketch, add

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
DARK = "#2f6fa8"  # body b as a line or a word


def line(s, *points, **style):
    s.path([s.at(p) for p in points], **style)


def arrow(s, p, q, label="", colour=RED, shift=(0.3, 0), width=2.2):
    line(s, p, q, colour=colour, width=width, head=True)
    if label:
        s.text((q[0] + shift[0], q[1] + shift[1]), label, colour)


def block(s, centre, size=(1.2, 0.8), colour=BLUE):
    s.bar((centre[0] - 0.5 * size[0], centre[1]), (centre[0] + 0.5 * size[0], centre[1]), colour, size[1])


def graph(s, origin, size, names, below=0.0, left=0.0):
    """Axes of a diagram; `below` and `left` are their lengths in negative directions."""
    x, y = origin
    line(s, (x - left, y), (x + size[0], y), width=1.4, head=True)
    line(s, (x, y - below), (x, y + size[1]), width=1.4, head=True)
    s.text((x + size[0] + 0.1, y - 0.42), names[0])
    s.text((x + 0.2, y + size[1] + 0.02), names[1], anchor="start")


def plot(s, origin, points, colour=RED, **style):
    line(s, *[(origin[0] + a, origin[1] + b) for a, b in points], colour=colour, width=style.pop("width", 2.4), **style)


def samples(f, begin, end, count=60):
    return [(x, f(x)) for x in (begin + (end - begin) * k / count for k in range(count + 1))]


def spiral(centre, inner, outer, begin, turns, count=90):
    out = []
    for k in range(count + 1):
        a, r = begin + 2 * pi * turns * k / count, inner + (outer - inner) * k / count
        out.append((centre[0] + r * cos(a), centre[1] + r * sin(a)))
    return out


def linear_spring():
    s = Sketch("Linear spring along a coordinate")
    pin = (-1.8, -0.3)
    s.ground((-3.6, 0.5), (-3.6, -1.1))
    line(s, pin, (0.2, -0.3), colour=GREY, dash="6 4")
    line(s, (-3.6, -0.3), *spiral(pin, 1.1, 0.2, pi, -2.5), colour=RED, width=2.0)
    line(s, pin, (pin[0] + 1.5 * cos(0.9), pin[1] + 1.5 * sin(0.9)), colour=BLUE, width=9.0)
    s.pivot(pin, 0.22, BLUE)
    s.pivot(pin, 0.08, INK)
    s.arc(pin, 1.7, 0.0, 0.82)
    s.text((0.05, 0.75), "x", GREEN)
    s.text((-1.8, -1.9), "k, c", RED)
    o = (2.1, -0.1)
    graph(s, o, (1.4, 1.9), ("x", "−Q"), 1.6, 1.5)
    plot(s, o, [(-1.4, -1.3), (1.4, 1.3)])
    plot(s, o, [(-1.4, -0.5), (0, 0), (0.9, 1.7)], ORANGE, dash="6 4")
    s.text((2.85, -1.2), "two slopes", ORANGE, 13)
    return s


def table_spring():
    s = Sketch("Spring by a table")
    s.ground((-3.6, 0.9), (-3.6, -0.9))
    s.spring((-3.6, 0.0), (-1.5, 0.0), 5)
    block(s, (-0.95, 0.0), (1.1, 1.2))
    arrow(s, (-1.5, -1.0), (-0.5, -1.0), "x", GREEN, (0.4, -0.08))
    s.text((-2.55, 0.55), "f", RED)
    o, points = (1.9, -0.1), [(-1.4, -1.7), (-0.7, -0.5), (0, 0), (0.7, 0.5), (1.4, 1.7)]
    graph(s, o, (1.6, 1.9), ("x", "f"), 1.7, 1.5)
    plot(s, o, samples(lambda x: 0.5 * x + 0.365 * x**3, -1.4, 1.4))
    for x, y in points:
        s.pivot((o[0] + x, o[1] + y), 0.09)
    return s


def limit():
    s = Sketch("Limit")
    s.ground((-3.6, -0.66), (3.2, -0.66))
    s.ground((3.2, -0.66), (3.2, 1.1))
    block(s, (0.3, -0.16), (1.4, 0.96))
    s.spring((2.0, 0.12), (3.2, 0.12), 4, 0.13)
    s.damper((2.0, -0.36), (3.2, -0.36))
    line(s, (2.0, 0.4), (2.0, -0.56), width=3.0)
    s.text((2.6, 0.48), "k, c", RED)
    for x, name, colour in ((1.0, "x", GREEN), (2.0, "u", INK)):
        line(s, (x, 0.5), (x, 1.65), width=1.0, dash="3 3")
        s.text((x, 1.8), name, colour)
    arrow(s, (1.15, -0.16), (1.62, -0.16), colour=GREEN)
    return s


def backlash():
    s = Sketch("Backlash")
    for side in (-1, 1):
        s.bar((side * 2.2 - 0.35, 0.2), (side * 2.2 + 0.35, 0.2), GREY, 1.7)
    s.bar((-2.55, -0.85), (2.55, -0.85), GREY, 0.5)
    block(s, (0.5, 0.3), (1.5, 1.3))
    arrow(s, (0.5, 0.3), (0.95, 0.3), colour=GREEN)
    s.text((0.3, 0.2), "ξ", GREEN)
    for a, b, name in ((-1.85, -0.25, ""), (1.25, 1.85, "")):
        line(s, (a, 1.35), (b, 1.35), width=1.2)
        for x in (a, b):
            line(s, (x, 1.2), (x, 1.5), width=1.2)
    s.text((-1.05, 1.55), "½ b + ξ")
    s.text((1.6, 1.55), "½ b − ξ")
    s.text((2.2, 0.1), "k, c", RED)
    s.text((-2.2, 0.1), "k, c", RED)
    return s


def impact_at_limit():
    s = Sketch("Impact at a limit")
    s.ground((-3.6, -1.0), (2.9, -1.0))
    s.ground((2.9, -1.0), (2.9, 1.3))
    block(s, (-2.4, -0.5), (1.3, 1.0), "#dbe9f6")
    block(s, (2.25, -0.5), (1.3, 1.0))
    arrow(s, (-1.7, -0.3), (-0.2, -0.3), "ẋ", GREEN, (-0.7, 0.25))
    arrow(s, (1.6, -0.7), (0.7, -0.7), "−e ẋ", GREEN, (0.05, 0.28))
    arrow(s, (2.9, 0.3), (2.0, 0.3), "I", RED, (0.1, 0.22))
    return s


def rope():
    s = Sketch("Rope and winch", origin=(210, 150))
    s.ground((2.2, 2.2), (-2.6, 2.2))
    s.pivot((-1.0, 1.5), 0.55, GREY)
    s.pivot((-1.0, 1.5), 0.1, INK)
    line(s, (-1.0, 1.5), (-1.0, 2.2), width=3.0)
    s.arc((-1.0, 1.5), 0.8, 2.6, 4.2)
    s.text((-2.15, 1.0), "s(t)", GREEN)
    line(s, (-0.45, 1.5), (-0.45, -1.0), width=2.0)
    slack = [(1.5 - 1.65 * t + 1.0 * t * (1 - t) * 2.2, 2.2 - 3.2 * t - 1.6 * t * (1 - t)) for t in (k / 30 for k in range(31))]
    line(s, *slack, colour=ORANGE, width=2.0)
    s.text((2.35, -0.4), "rope: N = 0", ORANGE, 14)
    block(s, (-0.3, -1.45), (1.5, 0.9))
    arrow(s, (-0.45, -0.9), (-0.45, 0.3), "N", RED, (-0.35, -0.25), 2.6)
    s.text((-0.1, 1.0), "L₀ − s", INK, 14, "start")
    return s


def dry_friction():
    s = Sketch("Dry friction")
    s.ground((-3.7, -0.7), (-0.9, -0.7))
    block(s, (-2.3, -0.2), (1.5, 1.0))
    arrow(s, (-1.7, 0.65), (-0.7, 0.65), "v", GREEN, (0.35, -0.08))
    arrow(s, (-2.0, -0.64), (-3.15, -0.64), "Q", RED, (-0.3, 0.25))
    o = (1.8, -0.1)
    graph(s, o, (1.8, 1.8), ("v", "−Q"), 1.7, 1.5)
    curve = lambda v: (0.9 + 0.5 * exp(-((v / 0.5) ** 2))) * tanh(v / 0.07) + 0.1 * v
    plot(s, o, samples(curve, -1.5, 1.6, 120))
    line(s, (o[0] - 0.08, o[1] + 1.4), (o[0] + 0.35, o[1] + 1.4), width=1.0, dash="3 3")
    s.text((o[0] - 0.35, o[1] + 1.3), "F_s", INK, 14)
    s.text((o[0] + 1.2, o[1] + 0.6), "F_c + c v", INK, 14)
    return s


def bristles(s, y, begin, count, lean, colour=INK):
    for k in range(count):
        x = begin + 0.42 * k
        line(s, (x, y), (x + 0.35 * lean, y + 0.3), (x + lean, y + 0.6), colour=colour, width=1.8)


def lugre_friction():
    s = Sketch("LuGre friction")
    s.ground((-2.9, -0.9), (2.9, -0.9))
    bristles(s, -0.9, -1.9, 8, 0.45)
    block(s, (0.0, 0.25), (4.0, 1.1))
    arrow(s, (2.1, 0.45), (3.2, 0.45), "v", GREEN, (0.35, -0.1))
    arrow(s, (-2.1, 0.1), (-3.1, 0.1), "Q", RED, (-0.4, -0.1))
    line(s, (1.04, -1.45), (1.49, -1.45), colour=ORANGE, width=2.0, head=True)
    line(s, (1.04, -1.3), (1.04, -1.6), width=1.0)
    s.text((1.4, -2.0), "z", ORANGE)
    s.text((0.0, 0.15), "σ₀, σ₁", INK)
    return s


def bearing_friction():
    s = Sketch("Friction that follows the reaction", origin=(200, 130))
    s.pivot((0, 0), 1.9, GREY)
    s.pivot((0, 0), 1.3, "#ffffff")
    s.pivot((0, -0.12), 1.17, BLUE)
    s.pivot((0, -0.12), 0.07, INK)
    line(s, (0, -0.12), (-1.0, 0.48), width=1.4, head=False)
    s.text((-0.6, -0.05), "r")
    s.arc((0, -0.12), 0.75, -0.5, 1.4)
    s.text((0.4, 0.0), "v", GREEN)
    arrow(s, (0, -2.3), (0, -1.4), "", RED)
    s.text((0.3, -2.2), "F", RED)
    arrow(s, (0.1, -1.2), (-1.0, -1.2), "", RED)
    s.text((2.7, -1.3), "μ |F|", RED)
    line(s, (2.2, -1.2), (0.5, -1.2), colour=RED, width=1.0, dash="3 3")
    return s


def bristle_friction():
    s = Sketch("Friction with a bristle", origin=(210, 150))
    s.ground((-3.2, -1.0), (3.2, -1.0))
    block(s, (0.25, 0.55), (3.5, 1.3))
    for x in (-0.8, 1.4):
        s.pivot((x, -0.1), 0.09, RED)
        s.spring((x, -0.45), (x - 1.2, -0.45), 4, 0.12)
        line(s, (x, -0.1), (x, -0.45), width=1.8)
        s.bar((x - 1.4, -0.72), (x - 1.05, -0.72), ORANGE, 0.5)
        arrow(s, (x, 0.0), (x, 0.7), "N", RED, (-0.3, -0.15))
    s.text((-2.75, -0.75), "μ N", ORANGE)
    arrow(s, (2.1, 0.6), (3.1, 0.6), "v", GREEN, (0.35, -0.1))
    s.text((0.8, -1.7), "deflection z: σ₀, σ₁", INK, 14)
    return s


def servo():
    s = Sketch("Servo")
    pin = (-2.9, -1.0)
    tip = lambda a, r: (pin[0] + r * cos(a), pin[1] + r * sin(a))
    s.ground((-3.6, -1.5), (-2.2, -1.5))
    line(s, (-2.9, -1.5), pin, width=6.0, colour=GREY)
    line(s, pin, tip(1.2, 2.9), colour=ORANGE, width=3.0, dash="7 5")
    s.bar(pin, tip(0.45, 2.4), BLUE, 0.36)
    s.pivot(pin, 0.16)
    s.text(tip(1.2, 3.15), "r(t)", ORANGE)
    s.text(tip(0.38, 2.75), "x", DARK)
    s.arc(pin, 1.5, 0.6, 1.02, RED)
    s.text((-1.5, 0.42), "Q", RED)
    o = (1.85, -0.1)
    graph(s, o, (1.5, 1.7), ("r − x", "Q"), 1.5, 1.5)
    plot(s, o, [(-1.4, -1.0), (-0.6, -1.0), (0.6, 1.0), (1.4, 1.0)])
    line(s, (o[0], o[1] + 1.0), (o[0] + 0.6, o[1] + 1.0), width=1.0, dash="3 3")
    s.text((o[0] - 0.62, o[1] + 0.92), "Q_max", INK, 14)
    return s


def box(s, centre, words, size=(0.9, 0.56)):
    block(s, centre, size, "#f3f3f3")
    s.text((centre[0], centre[1] - 0.1), words)


def pid_servo():
    s = Sketch("PID servo", origin=(213, 125))
    s.text((-3.65, 0.1), "r − x", GREEN)
    line(s, (-3.2, 0.0), (-2.7, 0.0))
    line(s, (-2.7, 1.2), (-2.7, -1.2))
    for y, name in ((1.2, "k_p"), (0.0, "k_d d/dt"), (-1.2, "k_i")):
        box(s, (-1.7, y), name, (1.3, 0.6))
        line(s, (-2.7, y), (-2.52, y), head=True)
    line(s, (-1.05, 1.2), (0.9, 1.2), (0.9, 0.42), head=True)
    line(s, (-1.05, 0.0), (0.5, 0.0), head=True)
    s.pivot((0.9, 0.0), 0.22)
    s.text((0.9, -0.1), "+", INK, 16)
    s.pivot((-0.55, -1.2), 0.18)
    s.text((-0.55, -1.3), "+", INK, 16)
    line(s, (-1.05, -1.2), (-0.9, -1.2), head=True)
    box(s, (0.45, -1.2), "∫", (0.7, 0.6))
    line(s, (-0.37, -1.2), (-0.08, -1.2), head=True)
    line(s, (0.8, -1.2), (0.9, -1.2), (0.9, -0.4), head=True)
    s.text((1.15, -0.95), "I", INK)
    line(s, (1.12, 0.0), (1.75, 0.0), head=True)
    s.text((1.5, 0.22), "Q₀", INK)
    block(s, (2.4, 0.0), (0.9, 0.8), "#f3f3f3")
    line(s, (2.05, -0.25), (2.25, -0.25), (2.55, 0.25), (2.75, 0.25), colour=RED, width=2.2)
    line(s, (2.85, 0.0), (3.4, 0.0), colour=RED, width=2.2, head=True)
    s.text((3.8, -0.1), "Q", RED)
    line(s, (3.15, 0.0), (3.15, -2.0), (2.6, -2.0), colour=ORANGE, width=1.6)
    line(s, (1.4, 0.0), (1.4, -1.75), (1.7, -1.75), colour=ORANGE, width=1.6)
    box(s, (2.15, -1.95), "1/T", (0.9, 0.6))
    line(s, (1.7, -2.15), (-0.55, -2.15), (-0.55, -1.58), colour=ORANGE, width=1.6, head=True)
    s.text((0.6, -2.02), "(Q − Q₀)/T", ORANGE, 13)
    return s


def rate_limited():
    s = Sketch("Bounded rate of the force", origin=(80, 215))
    graph(s, (0, 0), (5.6, 3.4), ("t", "force"))
    line(s, (0.0, 0.0), (0.6, 0.0), (0.6, 2.6), (5.2, 2.6), colour=ORANGE, width=2.0, dash="7 5")
    ramp = [(0.6 + 0.1 * k, 0.1 * k * 0.9) for k in range(25)]
    q, x = ramp[-1][1], ramp[-1][0]
    tail = [(x + 0.1 * k, 2.6 - (2.6 - q) * exp(-0.1 * k * 0.9 / (2.6 - q))) for k in range(1, 23)]
    line(s, *ramp, *tail, colour=RED, width=2.6)
    s.text((1.4, 2.8), "Q", ORANGE)
    s.text((4.4, 2.05), "q", RED)
    line(s, (1.5, 0.81), (2.3, 0.81), (2.3, 1.53), width=1.0, dash="3 3")
    s.text((2.45, 1.0), "q̇ ≤ q̇_max", INK, 14, "start")
    return s


def dc_motor():
    s = Sketch("Direct-current motor")
    line(s, (-3.4, 0.9), (-3.4, 0.35))
    line(s, (-3.4, -0.35), (-3.4, -1.1), (0.0, -1.1), (0.0, -0.75))
    s.pivot((-3.4, 0.0), 0.35)
    s.text((-3.4, -0.1), "U")
    line(s, (-3.4, 0.9), (-2.9, 0.9))
    s.bar((-2.9, 0.9), (-2.0, 0.9), "#ffffff", 0.36)
    line(s, (-2.0, 0.9), (-1.6, 0.9))
    for k in range(4):
        line(s, *[(-1.45 + 0.3 * k - 0.15 * cos(a), 0.9 + 0.18 * sin(a)) for a in (pi * j / 12 for j in range(13))], width=1.8)
    line(s, (-0.4, 0.9), (0.0, 0.9), (0.0, 0.45))
    s.text((-2.45, 1.3), "R")
    s.text((-1.0, 1.3), "L")
    line(s, (-2.6, -1.1), (-2.9, -1.1), colour=ORANGE, width=2.0, head=True)
    s.text((-2.5, -1.6), "i", ORANGE)
    s.pivot((0.0, -0.15), 0.6, "#f3f3f3")
    s.text((0.0, -0.25), "M, K", INK, 14)
    line(s, (0.6, -0.15), (1.3, -0.15), width=5.0, colour=GREY)
    s.bar((1.3, -0.15), (1.6, -0.15), GREY, 0.6)
    s.bar((1.3, 0.85), (1.6, 0.85), BLUE, 1.4)
    line(s, (1.6, 0.85), (2.6, 0.85), width=5.0, colour=DARK)
    s.text((2.0, -0.25), "n", INK)
    s.arc((2.6, 0.85), 0.5, -1.3, 1.9, RED)
    s.text((3.5, 0.75), "Q, ẋ", RED)
    return s


def torque_speed_curve():
    s = Sketch("Torque over speed", origin=(90, 205))
    graph(s, (0, 0), (5.3, 3.2), ("ẋ", "Q"))
    shape = lambda x: 2.0 + 0.75 * sin(0.75 * x) - 0.03 * x**3
    plot(s, (0, 0), samples(shape, 0.0, 4.4))
    plot(s, (0, 0), samples(lambda x: 0.5 * shape(x), 0.0, 4.4), ORANGE, dash="7 5")
    for x in (0.0, 1.1, 2.2, 3.3, 4.4):
        s.pivot((x, shape(x)), 0.08)
    s.text((3.5, 2.55), "u = 1: M(ẋ)", RED, 14)
    s.text((1.6, 0.8), "u = 0.5", ORANGE, 14)
    return s


def belt_and_pulley():
    s = Sketch("Belt over pulleys", origin=(210, 140))
    a, ra, b, rb = (-2.3, 0.0), 0.7, (1.9, 0.0), 1.2
    lean = (rb - ra) / (b[0] - a[0])  # sine of the slope of a span
    up = (-lean, (1 - lean * lean) ** 0.5)
    for side, width in ((1, 4.0), (-1, 2.0)):
        line(s, (a[0] + ra * up[0], side * ra * up[1]), (b[0] + rb * up[0], side * rb * up[1]), width=width, colour=INK)
    s.pivot(a, ra, GREY)
    s.pivot(b, rb, BLUE)
    for p in (a, b):
        s.pivot(p, 0.09, INK)
    s.arc(a, 0.42, 0.4, 3.4, GREEN)
    s.arc(b, 0.75, 0.4, 3.4, GREEN)
    s.text((a[0], -0.42), "ω₁", GREEN, 14)
    s.text((b[0], -0.5), "ω₂", GREEN, 14)
    s.text((a[0] - 1.1, -0.1), "R₁")
    s.text((b[0] + 1.6, -0.1), "R₂")
    arrow(s, (-0.9, -0.86 - 0.3), (0.3, -1.0 - 0.3), colour=ORANGE, width=1.8)
    s.text((-0.3, -1.75), "slack", INK, 14)
    s.text((-0.3, 1.4), "tight", INK, 14)
    return s


def differential():
    s = Sketch("Open differential", origin=(210, 135))
    s.bar((-1.5, 1.25), (1.5, 1.25), GREY, 0.3)
    for side in (-1, 1):
        s.bar((side * 1.5, 1.4), (side * 1.5, 0.14), GREY, 0.3)
        s.bar((side * 0.55, 0.0), (side * 3.2, 0.0), BLUE, 0.22)
        line(s, (side * 0.55, 0.75), (side * 0.95, 0.55), (side * 0.95, -0.55), (side * 0.55, -0.75), fill=BLUE, closed=True)
    line(s, (-0.5, 0.8), (-0.3, 1.02), (0.3, 1.02), (0.5, 0.8), fill="#f3f3f3", closed=True)
    line(s, (-0.5, -0.8), (-0.3, -1.02), (0.3, -1.02), (0.5, -0.8), fill="#f3f3f3", closed=True)
    line(s, (0, 1.02), (0, 1.1), width=6.0, colour=GREY)
    s.text((-3.0, 0.4), "ω_l", GREEN)
    s.text((3.0, 0.4), "ω_r", GREEN)
    s.text((0.0, 1.6), "carrier: M, ω_c", INK, 14)
    s.text((-2.3, -0.55), "½ M", RED)
    s.text((2.3, -0.55), "½ M", RED)
    s.text((0.0, -1.7), "ω_l + ω_r = 2 ω_c", GREEN, 14)
    return s


def floor(s, size=3.0, z=0.0):
    s.path([s.at(p) for p in ((-size, -size, z), (size, -size, z), (size, size, z), (-size, size, z))], fill="#f3f3f3", closed=True, width=1.0)


def capsule(s, begin, end, radius, colour):
    s.ball(begin, radius, colour)
    s.cylinder(begin, end, radius, colour)
    s.ball(end, radius, colour)


def box_on_plane():
    s = Sketch("Box on a plane", origin=(210, 130))
    floor(s, 1.9)
    s.box((0, -0.35, 0.45), (2.0, 1.2, 0.9), BLUE)
    for p in ((-1.0, -0.95, 0.0), (1.0, -0.95, 0.0), (1.0, 0.25, 0.0)):
        s.ball(p, 0.08, RED)
        s.arrow(add(p, (0, 0, -1.0)), add(p, (0, 0, -0.25)), RED)
    s.text((0.2, -2.0), "N₁", RED)
    return s


def box_on_box():
    s = Sketch("Box on a box", origin=(210, 145))
    s.box((0, 0, -0.35), (3.2, 2.6, 0.7), GREY)
    s.box((0.1, -0.1, 0.45), (1.5, 1.2, 0.9), BLUE)
    corners = ((-0.65, -0.7, 0.0), (0.85, -0.7, 0.0), (0.85, 0.5, 0.0))
    for p in corners:
        s.ball(p, 0.08, RED)
    s.text((1.7, 1.2), "a", DARK)
    s.text((2.9, 0.1), "b", "#555555")
    return s


def compound():
    s = Sketch("Compound of shapes", origin=(210, 140))
    floor(s, 2.0)
    s.box((0, 0.75, 0.1), (3.0, 0.2, 0.2), BLUE)
    s.box((0, 0.0, 0.55), (2.2, 1.7, 0.25), "#dbe9f6")
    s.box((0, -0.75, 0.1), (3.0, 0.2, 0.2), BLUE)
    capsule(s, (1.35, -0.5, 0.5), (1.35, 0.5, 0.5), 0.18, ORANGE)
    for p in ((-1.5, -0.85, 0.0), (1.5, -0.85, 0.0), (1.5, 0.65, 0.0)):
        s.ball(p, 0.07, RED)
    return s


def wheel():
    s = Sketch("Wheel with a tyre", origin=(190, 130))
    s.ground((-3.2, -1.5), (2.2, -1.5))
    s.pivot((0, 0), 1.75, "#555555")
    s.pivot((0, 0), 1.2, "#ffffff")
    s.pivot((0, 0), 0.5, BLUE)
    s.pivot((0, 0), 0.09, INK)
    s.arc((0, 0), 0.85, 2.6, 0.6)
    s.text((-1.0, -0.1), "Ω", GREEN)
    line(s, (0, 0), (2.1, 0), colour=GREEN, width=2.2, head=True)
    s.text((2.65, -0.1), "V_x", GREEN)
    arrow(s, (0, -1.5), (0, -0.65), "N", RED, (0.32, -0.05))
    arrow(s, (0, -1.5), (1.3, -1.5), "F_x", RED, (0.55, 0.2))
    for y, begin in ((-1.5, 2.2), (-1.75, 0.0)):
        line(s, (begin, y), (3.2, y), width=1.0, dash="3 3")
    line(s, (3.0, -1.0), (3.0, -1.33), width=1.2, head=True)
    line(s, (3.0, -2.25), (3.0, -1.92), width=1.2, head=True)
    s.text((3.3, -1.2), "d")
    return s


def magic_formula():
    s = Sketch("Magic Formula", origin=(80, 200))
    graph(s, (0, 0), (5.6, 3.2), ("κ", "F_x"))
    curve = lambda x: 2.4 * sin(1.75 * atan(1.1 * x - 0.2 * (1.1 * x - atan(1.1 * x))))
    plot(s, (0, 0), samples(curve, 0.0, 5.2))
    plot(s, (0, 0), [(0, 0), (2.4 / 4.62, 2.4), (5.2, 2.4)], ORANGE, dash="7 5")
    s.text((-0.55, 2.3), "D N", INK, 14)
    s.text((3.7, 1.2), "MagicFormula", RED, 14)
    s.text((3.9, 2.62), "LinearTyre", ORANGE, 14)
    s.text((0.6, 0.75), "B C D N", INK, 14, "start")
    return s


def se3_beam():
    s = Sketch("Geometrically exact beam on SE(3)", origin=(60, 200))
    at, turn, frames = (0.2, 0.3), -0.2, []
    arcs = ((0.5, 1.9), (-0.4, 1.9), (0.35, 1.9))  # curvature and length of each element
    for bend, length in arcs:
        frames.append((at, turn))
        r = 1.0 / bend
        centre = (at[0] - r * sin(turn), at[1] + r * cos(turn))
        points = [(centre[0] + r * sin(turn + bend * length * k / 24), centre[1] - r * cos(turn + bend * length * k / 24)) for k in range(25)]
        line(s, *points, colour=BLUE, width=6.0)
        at, turn = points[-1], turn + bend * length
    frames.append((at, turn))
    for k, (p, a) in enumerate(frames):
        line(s, p, (p[0] + 0.7 * cos(a), p[1] + 0.7 * sin(a)), colour=ORANGE, width=2.2, head=True)
        line(s, p, (p[0] - 0.7 * sin(a), p[1] + 0.7 * cos(a)), colour=ORANGE, width=2.2, head=True)
        s.pivot(p, 0.1)
    s.text((frames[1][0][0] + 0.25, frames[1][0][1] - 0.45), "H₁", ORANGE)
    s.text((frames[2][0][0] + 0.25, frames[2][0][1] - 0.5), "H₂", ORANGE)
    s.text((3.15, 0.7), "exp(ξ d)", DARK)
    return s


def inertia():
    s = Sketch("Inertia of parts", origin=(200, 140))
    along = lambda t: (0.9 * t - 0.9, 0.45 * t - 0.9, 0.0)
    s.cylinder(along(0.0), along(3.0), 0.28, BLUE)
    s.ball(along(3.5), 0.62, BLUE)
    for axis in (X, Y, Z):
        s.arrow(along(0.0), add(along(0.0), axis, 1.1), ORANGE)
    s.ball(along(0.0), 0.07, INK)
    s.curve([along(2.5), along(0.15)], colour=RED, width=2.0, head=True)
    s.ball(along(2.5), 0.09, "#ffffff")
    s.text(add(along(-0.35), (0, 0, 0.1)), "P")
    s.text(add(along(2.5), (0, 0, 0.45)), "c")
    s.text(add(along(1.7), (0, 0, -0.7)), "d = P − c", RED, 14)
    return s


DRAWINGS = {
    name: globals()[name]
    for name in [
        "linear_spring", "table_spring", "limit", "backlash", "impact_at_limit", "rope", "dry_friction", "lugre_friction", "bearing_friction",
        "bristle_friction", "servo", "pid_servo", "rate_limited", "dc_motor", "torque_speed_curve", "belt_and_pulley", "differential",
        "box_on_plane", "box_on_box", "compound", "wheel", "magic_formula", "se3_beam", "inertia",
    ]
}
