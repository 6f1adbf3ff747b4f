"""Drawings of the force elements."""

from math import cos, sin

from sketch import BLUE, GREEN, GREY, INK, ORANGE, RED, Sketch


def body(s, centre=(0, 0), size=(1.6, 1.0), colour=BLUE):
    s.bar((centre[0] - 0.5 * size[0], centre[1]), (centre[0] + 0.5 * size[0], centre[1]), colour, size[1])


def arrow(s, p, q, label="", colour=RED, shift=(0.3, 0)):
    s.path([s.at(p), s.at(q)], colour=colour, width=2.4, head=True)
    if label:
        s.text((q[0] + shift[0], q[1] + shift[1]), label, colour)


def wall(s, x=-3.2):
    s.ground((x, -0.9), (x, 0.9))


def gravity():
    s = Sketch("Gravity")
    body(s, (0, 0.5))
    arrow(s, (0, 0.5), (0, -1.2), "m g")
    s.pivot((0, 0.5), 0.08, INK)
    return s


def point_force():
    s = Sketch("Point force")
    s.bar((-2.4, -0.8), (1.0, 0.2), BLUE, 0.5)
    s.pivot((0.9, 0.17), 0.1, INK)
    arrow(s, (0.9, 0.17), (0.9, 1.7), "dead", shift=(0.5, -0.2))
    arrow(s, (0.9, 0.17), (0.43, 1.6), "follower", ORANGE, (-0.75, -0.2))
    return s


def point_moment():
    s = Sketch("Point moment")
    s.bar((-2.2, -0.4), (1.4, 0.4), BLUE, 0.5)
    s.pivot((1.2, 0.36), 0.1, INK)
    s.arc((1.2, 0.36), 0.8, -1.2, 2.2, RED)
    s.text((2.25, 0.9), "M", RED)
    return s


def distributed_force():
    s = Sketch("Distributed force", origin=(210, 160))
    s.ground((-2.8, -0.8), (-2.8, 0.8))
    s.bar((-2.8, 0), (2.8, 0), BLUE, 0.4)
    for k in range(9):
        x = -1.6 + 0.5 * k
        arrow(s, (x, 1.4), (x, 0.4))
    s.path([s.at((-1.6, 1.4)), s.at((2.4, 1.4))], colour=RED)
    s.text((2.8, 1.3), "q", RED)
    s.text((0.4, -0.7), "from … to", INK, 14)
    return s


def spring_damper():
    s = Sketch("Spring and damper")
    wall(s)
    body(s, (2.2, 0))
    s.spring((-3.2, 0.3), (1.4, 0.3))
    s.damper((-3.2, -0.35), (1.4, -0.35))
    s.text((-0.9, 0.7), "k, l₀", RED)
    s.text((-0.9, -0.95), "c", RED)
    return s


def axial_spring():
    s = Sketch("Axial spring")
    s.bar((-3.4, -0.3), (-2.4, -0.3), GREY, 1.4)
    s.path([s.at((-2.4, -0.3)), s.at((3.4, -0.3))], colour=ORANGE, dash="6 4", head=True)
    s.text((3.5, -0.7), "e", ORANGE)
    s.spring((-2.4, -0.3), (0.8, -0.3), 8)
    body(s, (1.6, 0.2))
    s.text((-0.8, 0.2), "k, c, P", RED)
    s.path([s.at((-2.4, -1.4)), s.at((0.8, -1.4))], colour=INK, head=True)
    s.text((-0.8, -1.75), "s")
    return s


def maxwell_element():
    s = Sketch("Maxwell element")
    wall(s)
    body(s, (2.4, 0))
    s.spring((-3.2, 0), (-0.9, 0), 5)
    s.damper((-0.9, 0), (1.6, 0))
    s.pivot((-0.9, 0), 0.08, INK)
    s.text((-2.05, 0.5), "k", RED)
    s.text((0.35, 0.55), "c", RED)
    s.path([s.at((-0.9, -0.8)), s.at((1.6, -0.8))], colour=GREEN, head=True)
    s.text((0.35, -1.2), "z", GREEN)
    return s


def user_force():
    s = Sketch("User force")
    body(s, (-1.8, 0.4))
    s.bar((0.4, 0.4), (3.2, 0.4), "#f3f3f3", 1.2)
    s.text((1.8, 0.3), "w(r, A, ṙ, ω, t)")
    s.path([s.at((-0.9, 0.7)), s.at((0.2, 0.7))], head=True)
    s.path([s.at((0.4, 0.1)), s.at((-0.7, 0.1))], colour=RED, head=True)
    s.text((-0.3, 1.0), "frames", INK, 13)
    s.text((-0.3, -0.35), "wrenches", RED, 13)
    return s


def contact():
    s = Sketch("Contact", origin=(210, 150))
    s.ground((-2.8, -0.8), (2.8, -0.8))
    s.pivot((0, 0.35), 1.2, BLUE)
    arrow(s, (0, -0.8), (0, 0.9), "N", shift=(0.35, -0.1))
    arrow(s, (0, -0.8), (-1.3, -0.8), "F_t", shift=(-0.1, 0.3))
    s.path([s.at((0.4, 1.8)), s.at((1.5, 1.8))], colour=GREEN, head=True)
    s.text((1.95, 1.7), "v", GREEN)
    s.path([s.at((1.6, -0.85)), s.at((1.6, -0.8))], colour=INK)
    return s


def contact_group():
    s = Sketch("Contact group", origin=(210, 150))
    s.ground((-3.2, -1.0), (3.2, -1.0))
    s.pivot((-0.9, 0.35), 0.9, GREY)
    for k in range(7):
        x = -2.7 + 0.9 * k
        s.bar((x - 0.38, -0.75), (x + 0.38, -0.75), BLUE, 0.36)
        s.pivot((x, -0.95), 0.06, RED)
    for angle in (-0.7, 0.0, 0.7):
        s.pivot((-0.9 + 0.9 * sin(angle), 0.35 - 0.9 * cos(angle)), 0.06, RED)
    s.text((1.8, 0.0), "many: links", "#2f6fa8", 14)
    s.text((0.9, 0.9), "partner: wheel", "#555555", 14)
    s.text((1.6, -1.75), "partner: ground", "#555555", 14)
    return s


def contact_set():
    s = Sketch("Contact set", origin=(210, 150))
    s.ground((-3.2, -1.2), (3.2, -1.2))
    balls = [(-1.6, -0.6, 0.6), (-0.4, -0.6, 0.6), (0.7, -0.7, 0.5), (-1.0, 0.44, 0.6), (0.25, 0.3, 0.45)]
    for x, y, r in balls:
        s.pivot((x, y), r, BLUE)
    for a, b in [(0, 1), (1, 2), (0, 3), (1, 3), (1, 4), (2, 4)]:
        (xa, ya, ra), (xb, yb, rb) = balls[a], balls[b]
        part = ra / (ra + rb)
        s.pivot((xa + part * (xb - xa), ya + part * (yb - ya)), 0.06, RED)
    for x, _, _ in balls[:3]:
        s.pivot((x, -1.2), 0.06, RED)
    s.text((2.2, 0.3), "members: balls", "#2f6fa8", 14)
    s.text((2.0, -1.75), "member: plane", "#555555", 14)
    return s


DRAWINGS = {
    name: globals()[name]
    for name in [
        "gravity", "point_force", "point_moment", "distributed_force", "spring_damper", "axial_spring", "maxwell_element", "user_force", "contact",
        "contact_group", "contact_set",
    ]
}
