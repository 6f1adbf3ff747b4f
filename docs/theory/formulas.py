"""Numerical checks of formulas of the theory pages, without code of polybody: differences, integrations, limits and random numbers.

A check is a function with the numbers of its equations in its name, such as eq_9_3_9_4. It calls `same` or `require`.
`faults()` runs all checks; `numbers()` lists the equations that they concern."""

import cmath
import math
import random
import re
from math import cos, exp, log, pi, sin, sqrt

DRAW = random.Random(20)
FOUND = []


def require(holds, what):
    if not holds:
        FOUND.append(what)


def same(a, b, tolerance, what=""):
    """The numbers a and b agree to the tolerance, relative to 1 + |b|."""
    require(abs(a - b) <= tolerance * (1 + abs(b)), f"{what} {a} differs from {b}")


# --- vectors and matrices as lists -----------------------------------------------------------
def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def norm(a):
    return sqrt(dot(a, a))


def add(a, b, s=1.0):
    return [x + s * y for x, y in zip(a, b)]


def times(s, a):
    return [s * x for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def apply(m, x):
    return [dot(row, x) for row in m]


def turned(m):
    return [list(row) for row in zip(*m)]


def product(a, b):
    return [[dot(row, column) for column in zip(*b)] for row in a]


def outer(a, b):
    return [[x * y for y in b] for x in a]


def vector(n=3):
    return [DRAW.uniform(-1, 1) for _ in range(n)]


def unit():
    a = vector()
    return times(1 / norm(a), a)


def rotation(phi):
    """exp of the rotation vector phi, by rows."""
    angle = norm(phi) or 1e-300
    n, s, c = times(1 / angle, phi), sin(angle), 1 - cos(angle)
    skew = [[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]]
    square = product(skew, skew)
    return [[(i == j) + s * skew[i][j] + c * square[i][j] for j in range(3)] for i in range(3)]


def solve(m, b):
    """Solution of m x = b by elimination with pivots."""
    rows, n = [list(map(float, row)) + [y] for row, y in zip(m, b)], len(b)
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(n):
            if i != k:
                rows[i] = add(rows[i], rows[k], -rows[i][k] / rows[k][k])
    return [rows[i][n] / rows[i][i] for i in range(n)]


def slope(f, h=1e-4):
    """df/dx at 0 by differences of fourth order; f returns a number."""
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)


def integral(f, a, b, n=200):
    """Simpson's rule."""
    h = (b - a) / (2 * n)
    return h / 3 * sum((1 if k in (0, 2 * n) else 4 if k % 2 else 2) * f(a + k * h) for k in range(2 * n + 1))


def run(rate, y, h, goes_on):
    """Runge–Kutta steps while goes_on(y); the last step is cut by the secant of goes_on's number, which becomes negative."""
    t = 0.0
    while True:
        k1 = rate(y)
        k2 = rate(add(y, k1, h / 2))
        k3 = rate(add(y, k2, h / 2))
        k4 = rate(add(y, k3, h))
        new = [v + h / 6 * (a + 2 * b + 2 * c + d) for v, a, b, c, d in zip(y, k1, k2, k3, k4)]
        if goes_on(new) < 0:
            part = goes_on(y) / (goes_on(y) - goes_on(new))
            return t + part * h, add(y, add(new, y, -1), part)
        y, t = new, t + h


def root(f, a, b):
    """Zero of f between a and b by bisection."""
    up = f(b) > 0
    for _ in range(200):
        m = 0.5 * (a + b)
        a, b = (a, m) if (f(m) > 0) == up else (m, b)
    return 0.5 * (a + b)


# --- chapters 6 and 7 --------------------------------------------------------------------------
def grows(step, y):
    """True if the state y grows in many linear steps."""
    for _ in range(20000):
        y = step(*y)
        if sum(map(abs, y)) > 1e3:
            return True
    return False


def eq_6_33_6_34_6_37():
    for w2, d in (9.0, 0.8), (9.0, 20.0), (1.0, 0.1):

        def euler(h, x, v):
            v += h * (-w2 * x - d * v)
            return x + h * v, v

        def central(h, x, v, a):
            v += 0.5 * h * a
            x, a = x + h * v, -w2 * (x + h * v) - d * (v + 0.5 * h * a)
            return x, v + 0.5 * h * a, a

        for method, y, limit in (euler, (1.0, 0.5), 4 / (d + sqrt(d * d + 4 * w2))), (central, (1.0, 0.5, 0.2), 2 / (d + sqrt(d * d + w2))):
            for part in 0.99, 1.01:
                require(grows(lambda *y: method(part * limit, *y), y) == (part > 1), f"{method.__name__} at {part} of its limit")


def eq_6_39_6_40_6_41_6_42_6_43_6_44():
    alike = lambda a, b: agree([a], [b])
    start, u, change = rotation(vector()), vector(), vector()
    inertia, h, chi = [2.0, 3.0, 4.0], 0.3, 0.2
    mean = add(u, change, -chi)  # of the angular velocity, with u = mean + chi change
    first, last = add(mean, change, -0.5), add(mean, change, 0.5)
    momentum = lambda w: [j * x for j, x in zip(inertia, w)]
    c = times(h, u)
    angle = 2 * math.atan(0.5 * norm(c))
    end = product(start, rotation(times(angle / norm(c), c)))
    for x in [1, 0, 0], [0, 1, 0], [0, 0, 1]:  # (1 - c/2) Rᵀ₀ R₁ = 1 + c/2
        y = apply(product(turned(start), end), x)
        alike(add(y, cross(c, y), -0.5), add(x, cross(c, x), 0.5))
    middle = [[0.5 * (a + b) for a, b in zip(*rows)] for rows in zip(start, end)]
    turn = apply(start, c)  # P c
    alike(apply(turned(middle), turn), c)
    for k in range(3):
        alike(add(turned(end)[k], turned(start)[k], -1), cross(turn, turned(middle)[k]))
    force = times(1 / h, add(momentum(change), times(h, cross(u, momentum(mean)))))
    energy = lambda w: 0.5 * dot(w, momentum(w))
    same(energy(last) - energy(first), -chi * dot(change, momentum(change)) + dot(c, force), 1e-12)
    alike(add(apply(end, momentum(last)), apply(start, momentum(first)), -1), times(h, apply(middle, force)))
    phi = vector()
    r = rotation(phi)
    g = times(1 / (1 + r[0][0] + r[1][1] + r[2][2]), [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]])
    quarter = times(1 / (1 + sqrt(1 + dot(g, g))), g)
    alike(times(4 * math.atan(norm(quarter)) / norm(quarter), quarter), phi)


def eq_7_17():
    u, v = vector(4), vector(4)
    a = [[u[i] * u[j] + v[i] * v[j] for j in range(4)] for i in range(4)]  # rank 2
    held = [[a[i][j] + (i == j and i in (0, 1)) for j in range(4)] for i in range(4)]
    for k in 0, 1:
        require(norm(apply(a, solve(held, [float(i == k) for i in range(4)]))) < 1e-9, "Z does not span the null space")
    y = solve(held, apply(a, vector(4)))
    same(abs(y[0]) + abs(y[1]), 0, 1e-9)  # no force in the springs for a load that can be balanced


# --- chapter 9: coordinates, springs, stops ---------------------------------------------------
def eq_9_2_9_3_9_4():
    a, b, wa, wb = rotation(vector()), rotation(vector()), vector(), vector()

    def theta(t):
        x, y = turned(product(rotation(times(t, wa)), a)), turned(product(rotation(times(t, wb)), b))
        return math.atan2(dot(x[1], y[0]), dot(x[0], y[0]))

    ca, cb = turned(a), turned(b)
    p = add(times(dot(ca[0], cb[0]), ca[0]), times(dot(ca[1], cb[0]), ca[1]))
    u = add(ca[2], p, -dot(ca[2], cb[0]) / dot(p, p))
    same(slope(theta), dot(u, add(wb, wa, -1)), 1e-9)


def eq_9_2_9_6_9_7():
    ra, rb, va, vb, wa, a3 = vector(), vector(), vector(), vector(), vector(), unit()
    d = lambda t: add(add(rb, vb, t), add(ra, va, t), -1)
    same(slope(lambda t: dot(apply(rotation(times(t, wa)), a3), d(t))),
         dot(a3, vb) - dot(a3, va) - dot(cross(d(0), a3), wa), 1e-9)
    e = times(1 / norm(d(0)), d(0))
    same(slope(lambda t: norm(d(t))), dot(e, vb) - dot(e, va), 1e-9)


def eq_9_12():
    k, m, x0 = (30.0, 80.0), 1.7, 0.0
    rate = lambda y: [y[1], -(k[0] if y[0] > x0 else k[1]) * y[0] / m]
    first, y = run(rate, [1e-12, 1.0], 1e-4, lambda y: y[0])
    second, y = run(rate, [-1e-12, y[1]], 1e-4, lambda y: -y[0])
    same(first + second, pi * sqrt(m) * (k[0] ** -0.5 + k[1] ** -0.5), 1e-6)


def eq_9_13_9_14():
    for _ in range(50):
        h0, h1, d0, d1 = (DRAW.uniform(0.1, 5) for _ in range(4))
        m = 3 * (h0 + h1) / ((h0 + 2 * h1) / d0 + (2 * h0 + h1) / d1)
        require(m <= 3 * min(d0, d1) * (1 + 1e-12), f"the slope {m} of a table exceeds three chords")
    delta, m0, m1, h, f0 = 0.7, 2.0, 1.9, 0.6, 0.3  # slopes below 3 δ
    f = lambda x: f0 + m0 * x + (3 * delta - 2 * m0 - m1) / h * x**2 + (m0 + m1 - 2 * delta) / h**2 * x**3
    same(f(h), f0 + delta * h, 1e-12)
    same(slope(f), m0, 1e-9)
    same(slope(lambda x: f(h + x)), m1, 1e-9)
    values = [f(h * i / 100) for i in range(101)]
    require(values == sorted(values), "the cubic of a table is not monotone")


def eq_9_17():
    ea, x, length, s_rate = 300.0, 2.4, 2.1, 0.3
    energy = lambda t: ea * (x / (length - s_rate * t) - 1) ** 2 * (length - s_rate * t) / 2
    strain = x / length - 1
    same(slope(energy), ea * strain * (1 + strain / 2) * s_rate, 1e-8)


def impact(force, v, h, ends=lambda d, rate: d):
    """Velocity ratio of a unit mass after an impact with the force(d, rate), which ends when ends(d, rate) becomes negative."""
    _, y = run(lambda y: [y[1], -force(*y)], [0.0, v], h, lambda y: ends(*y) if y[1] < 0 else 1.0)
    return -y[1] / v


def eq_8_5_9_19():
    k, c, v = 400.0, 18.0, 0.7
    theta = math.acos(c / (2 * sqrt(k)))
    force = lambda d, rate: k * d + c * rate
    same(impact(force, v, 1e-5, force), exp(-2 * theta / math.tan(theta)), 1e-5)
    omega = sqrt(k)
    speed = lambda t: v * exp(-omega * t * cos(theta)) * sin(theta - omega * t * sin(theta)) / sin(theta)
    rate = -omega * v * exp(-omega * 0.03 * cos(theta)) * sin(2 * theta - omega * 0.03 * sin(theta)) / sin(theta)
    same(slope(lambda t: speed(0.03 + t)), rate, 1e-7)
    same(rate + c * speed(0.03) + k * integral(speed, 0, 0.03), 0, 1e-9)


def eq_9_20():
    for e, found in (0.95, 0.951), (0.7, 0.718), (0.5, 0.550), (0.1, 0.253):
        theta = math.acos(-log(e) / sqrt(pi**2 + log(e) ** 2))
        same(exp(-pi / math.tan(theta)), e, 1e-12)
        same(exp(-2 * theta / math.tan(theta)), found, 4e-4)


def eq_8_9_9_21_9_22():
    side = lambda y: y - math.log1p(y)
    departure = lambda y: root(lambda e: side(-e * y) - side(y), 0, (1 - 1e-12) / y if y > 1 else 1.0)
    for e, found in (0.95, 0.952), (0.7, 0.768), (0.5, 0.663), (0.1, 0.516):
        same(departure(1.5 * (1 - e)), found, 4e-4)
    e = departure(0.03)
    same(3 * (1 - e * e) / (2 * (1 + e**3)), 0.03, 1e-3)
    chi, v, k = 0.6, 0.9, 300.0
    same(impact(lambda d, rate: k * max(d, 0) ** 1.5 * (1 + chi * rate), v, 1e-4), departure(chi * v), 1e-6)


def eq_8_33():
    p, eps, length = 0.15, 0.03, 0.08
    share = lambda along: (lambda x: x * x * (3 - 2 * x))((p / 2 + eps - abs(along)) / (2 * eps))
    for along in length, -length:
        x, side = (p / 2 + eps - abs(along)) / (2 * eps), math.copysign(1, along)
        same(slope(lambda r: share(along - r)), 3 * side / eps * x * (1 - x), 1e-6)
    for along in 0.06, 0.09:  # this link and the next one
        same(share(along) + share(along - p), 1, 1e-12)


def eq_8_36_8_37_8_38_8_39():
    n, p, rp, rv, phi, rt = 11, 0.15, 0.02, 0.03, 0.9, 0.275
    pitch_radius = p / (2 * sin(pi / n))
    rc = pitch_radius + rv - rp
    f, t, normal = [rc - rv * cos(phi), rv * sin(phi)], [sin(phi), cos(phi)], [cos(phi), -sin(phi)]
    b = dot(f, t)
    k = add(f, t, sqrt(b * b - dot(f, f) + rt * rt) - b)
    same(norm(k), rt, 1e-12)
    arc = lambda x, y: math.hypot(rc - x, y) - (rv - rp)
    flank = lambda x, y: (rc - x) * cos(phi) + y * sin(phi) - (rv - rp)
    corner = lambda x, y: rp - norm(add([x, y], k, -1))
    tip = lambda x, y: rt + rp - math.hypot(x, y)
    same(arc(pitch_radius, 0), 0, 1e-12, "a pin at the bottom lies on the pitch circle:")
    at_arc, at_corner = [rc - 0.012 * cos(phi), 0.012 * sin(phi)], add(k, normal, 0.8 * rp)
    for first, second, place in (arc, flank, at_arc), (flank, corner, at_corner), (corner, tip, times(1.05, k)):
        same(first(*place), second(*place), 1e-12)
        for axis in (1, 0), (0, 1):
            along = lambda depth: slope(lambda e: depth(*add(place, axis, e)))
            same(along(first), along(second), 1e-6)
    for axis, component in zip(((1, 0), (0, 1)), normal):
        same(slope(lambda e: flank(*add(at_arc, axis, e))), -component, 1e-8)


def eq_9_23():
    k, c, v, onset = 400.0, 2.0, 0.02, 0.05
    e = impact(lambda d, rate: k * d + c * d / onset * rate, v, 1e-4)
    same((1 - e) / (2 * c * v / (3 * k * onset)), 1, 0.01)


def eq_9_24_9_25_9_26():
    n, e = 5, 0.6
    root_of_mass = [vector(n) for _ in range(n)]
    mass = [[dot(x, y) + (i == j) for j, y in enumerate(root_of_mass)] for i, x in enumerate(root_of_mass)]
    rows, g = [vector(n), vector(n)], vector(n)
    saddle = [m + [r[i] for r in rows] for i, m in enumerate(mass)] + [r + [0, 0] for r in rows]
    v = solve(saddle, vector(n) + [0, 0])[:n]  # satisfies G v = 0
    y = solve(saddle, g + [0, 0])[:n]
    impulse = -(1 + e) * dot(g, v) / dot(g, y)
    after = add(v, y, impulse)
    same(dot(g, after), -e * dot(g, v), 1e-10)
    same(dot(rows[0], after), 0, 1e-10)
    energy = lambda x: 0.5 * dot(x, apply(mass, x))
    same(energy(after) - energy(v), -0.5 * (1 - e * e) * dot(g, v) ** 2 / dot(g, y), 1e-10)


def eq_9_27():
    e = 0.5
    same(1 + 2 * sum(e**k for k in range(1, 80)), (1 + e) / (1 - e), 1e-12)


# --- friction ---------------------------------------------------------------------------------
def eq_8_11_9_29():
    load, limit, v0 = 3.0, 4.0, 1e-3
    v = v0 * load / sqrt(limit**2 - load**2)
    same(limit * v / sqrt(v * v + v0 * v0), load, 1e-12)


def eq_9_30():
    m, fs, v0, c = 2.0, 5.0, 1e-2, 3.0
    force = lambda v: -fs * v / sqrt(v * v + v0 * v0) - c * v
    for part in 0.98, 1.02:
        h, v = part * 2 * m * v0 / (fs + c * v0), 1e-8
        for _ in range(200):
            v += h * force(v) / m
        require((abs(v) < 1e-8) == (part < 1), f"the limit of a step of friction is wrong at {part}")


def eq_9_32_9_33_9_34():
    zs, z1, z2 = 0.02, 0.004, 0.015
    rate = lambda v, z: v * (1 - abs(z) / zs * (1 if v * z > 0 else -1))
    up, _ = run(lambda y: [rate(1, y[0])], [z1], 1e-5, lambda y: z2 - y[0])
    down, _ = run(lambda y: [rate(-1, y[0])], [z2], 1e-5, lambda y: y[0] - z1)
    same((up - down) / (zs * log((zs**2 - z1**2) / (zs**2 - z2**2))), 1, 1e-6)
    first, _ = run(lambda y: [rate(1, y[0])], [0.0], 1e-5, lambda y: z2 - y[0])
    same(zs * (1 - exp(-first / zs)), z2, 1e-8)


def eq_9_35_9_36():
    for _ in range(100):
        zs, zb, z, v = DRAW.uniform(1, 2), DRAW.uniform(0.1, 0.9), DRAW.uniform(-2.5, 2.5), DRAW.uniform(-1, 1)
        middle = 0.5 + 0.5 * sin(pi * (abs(z) - 0.5 * (zs + zb)) / (zs - zb))
        alpha = 0 if abs(z) <= zb or v * z < 0 else 1 if abs(z) >= zs else middle
        rate = v * (1 - alpha * abs(z) / zs * math.copysign(1, v * z))
        same(z * (v - rate), alpha * z * z * abs(v) / zs, 1e-12)
    for at, value in (zb, 0), (zs, 1):
        same(0.5 + 0.5 * sin(pi * (at - 0.5 * (zs + zb)) / (zs - zb)), value, 1e-12)


def eq_9_38_9_41_9_42():
    for _ in range(20):
        s0, s1, eta, limit = (DRAW.uniform(0.2, 3) for _ in range(4))
        z, v = times(2, vector()), times(2, vector())
        star = add(times(s0, z), v, s1 + eta * s0)
        r = times(min(1, limit / norm(star)), star)
        z1 = times(1 / (s1 + eta * s0), add(times(s1, z), r, eta))
        trial = add(times(s0, z1), v, s1)
        for x, y in zip(times(min(1, limit / norm(trial)), trial), r):
            same(x, y, 1e-12)
        for before, rate, after in zip(z, times(1 / s1, add(r, z1, -s0)), z1):
            same(before + eta * rate, after, 1e-12)


def eq_9_43_9_44():
    columns, lam = [vector() for _ in range(5)], vector(5)  # rows of G_b, forces only
    force = lambda l: [sum(l[k] * columns[k][i] for k in range(5)) for i in range(3)]
    f = force(lam)
    for j in range(5):
        moved = lambda t: norm(force([x + t * (k == j) for k, x in enumerate(lam)]))
        same(slope(moved), dot(f, columns[j]) / norm(f), 1e-8)


def eq_9_46():
    m, e, inertia, mu, r, w0 = 2.0, 0.3, 0.5, 0.5, 0.1, 20.0
    beta = mu * r * m * e / inertia
    w = lambda t: w0 / (1 + beta / sqrt(1 - beta**2) * w0 * t)
    rate = slope(lambda t: w(1.3 + t))
    same(inertia * rate, -mu * r * m * e * sqrt(w(1.3) ** 4 + rate**2), 1e-8)
    same(w(2.0), 5.875, 1e-4)


# --- contact shapes ---------------------------------------------------------------------------
def beyond(h, c):
    return [x - max(-a, min(a, x)) for a, x in zip(h, c)]


def eq_9_49_9_50():
    h = [0.3, 0.5, 0.2]
    for _ in range(30):
        c, u = times(1.5, vector()), unit()
        o = beyond(h, c)
        if norm(o) < 0.05 or min(abs(abs(x) - a) for x, a in zip(c, h)) < 0.02:
            continue
        distance = lambda t: norm(beyond(h, add(c, u, t)))
        n, inside = times(1 / norm(o), o), sum(x * x for x, y in zip(u, o) if y != 0)
        same(slope(distance), dot(u, n), 1e-8)
        second = (distance(1e-3) - 2 * distance(0) + distance(-1e-3)) / 1e-6
        same(second, (inside - dot(u, n) ** 2) / norm(o), 1e-3)


def eq_9_51_9_52_9_53():
    h, half, taper, m0 = [0.3, 0.2, 0.1], 0.25, 0.01, [0.05, 0.05, 0.35]
    kappa, turn, move = taper / (2 * half**2), times(0.1, vector()), vector()

    def least(t, u0, s_k):
        u, m = apply(rotation(times(t, turn)), u0), add(m0, move, t)
        f = lambda s: norm(beyond(h, add(m, u, s))) + 0.5 * kappa * (s - s_k) ** 2
        a, b = -half, half
        for _ in range(100):
            p, q = a + (b - a) * 0.381966, b - (b - a) * 0.381966
            a, b = (a, q) if f(p) < f(q) else (p, b)
        return f(0.5 * (a + b)), 0.5 * (a + b)

    inside = 0
    for u0, s_k in [(u, s) for u in ([0.6, 0.64, 0.48], [0.8, 0.5999, 0.01]) for s in (-half, half)]:
        s = least(0, u0, s_k)[1]
        o = beyond(h, add(m0, u0, s))
        n = times(1 / norm(o), o)
        same(slope(lambda t: least(t, u0, s_k)[0], 1e-3), dot(n, add(move, cross(turn, u0), s)), 1e-6)
        if abs(s) < half * (1 - 1e-6):
            inside += 1
            same(dot(u0, n) + kappa * (s - s_k), 0, 1e-8)
    require(inside > 0, "no minimum lies inside of the segment")


# --- tyres and wheels --------------------------------------------------------------------------
def magic(x, b, c, d, e):
    return d * sin(c * math.atan(b * x - e * (b * x - math.atan(b * x))))


def eq_9_58():
    b, c, d, e = 10.5, 1.3, 0.9, -0.7
    same(slope(lambda x: magic(x, b, c, d, e), 1e-5), b * c * d, 1e-6)
    same(magic(1e9, b, c, d, e), d * sin(pi * c / 2), 1e-6)
    same(max(magic(i / 1e4, b, c, d, e) for i in range(20000)), d, 1e-6)


def eq_9_59_9_60():
    x, y = (10.0, 1.9, 1.0, 0.97), (10.5, 1.3, 0.9, -0.7)
    a, b = x[0] * x[1], y[0] * y[1]
    for _ in range(200):
        sx, sy = DRAW.uniform(-1, 1), DRAW.uniform(-1, 1)
        k = math.hypot(a * sx, b * sy)
        fx, fy = sx * magic(k / a, *x) / (k / a), sy * magic(k / b, *y) / (k / b)
        require((fx / x[2]) ** 2 + (fy / y[2]) ** 2 <= 1 + 1e-12, f"the forces at the slips {sx}, {sy} leave the ellipse")


def depth(a, n, height, big, small):
    m = add(n, a, -dot(n, a))
    e = times(1 / norm(m), m)
    d = (big - small) * dot(e, n) + small - height
    return d, add(times(-(big - small), e), n, d - small)


def eq_9_61_9_62():
    n, a, big, small, height = [0.0, 0.0, 1.0], unit(), 0.3, 0.08, 0.25
    v, w = vector(), vector()
    d, rho = depth(a, n, height, big, small)
    same(height + dot(n, rho), 0, 1e-12)  # the contact point lies in the plane
    rate = slope(lambda t: depth(apply(rotation(times(t, w)), a), n, height + t * v[2], big, small)[0])
    same(rate, -dot(n, add(v, cross(w, rho))), 1e-8)
    m = add(n, a, -dot(n, a))
    lowest = min(add(times(big - small, [cos(t) * p + sin(t) * q for p, q in zip(times(1 / norm(m), m), cross(a, times(1 / norm(m), m)))]),
                     n, -small)[2] for t in (2 * pi * i / 20000 for i in range(20000)))
    same(lowest + height, -d, 1e-6)


def eq_9_63():
    wave = lambda x: (0.05 * sin(2 * x), 0.1 * cos(2 * x))

    def contact(p, cx, cz, radius=0.4):  # x of the contact point of the plane that is tangent at p
        h, h1 = wave(p)
        up = 1 / sqrt(1 + h1 * h1)
        n = (-h1 * up, up)
        d = radius - ((cx - p) * n[0] + (cz - h) * n[1])
        return cx + (d - radius) * n[0]

    def place(cx, cz):
        p = cx
        for _ in range(30):
            p -= (p - contact(p, cx, cz)) / (1 - slope(lambda t: contact(p + t, cx, cz)))
        return p

    p = place(0.3, 0.41)
    h, h1 = wave(p)
    same((0.3 - p) + h1 * (0.41 - h), 0, 1e-9)  # the normal at p passes through the centre
    fixed, own = slope(lambda t: contact(p, 0.3 + t, 0.41)), slope(lambda t: contact(p + t, 0.3, 0.41))
    same(slope(lambda t: place(0.3 + t, 0.41)), fixed / (1 - own), 1e-7)


def eq_9_64():
    length, ends = 0.7, [1.1, -0.4, 0.6, 0.9]  # value, slope, value, slope
    shape = lambda q: [1 - 3 * q**2 + 2 * q**3, length * (q - 2 * q**2 + q**3), 3 * q**2 - 2 * q**3, length * (q**3 - q**2)]
    for at, k in (0, 0), (1, 2):
        same(dot(shape(at), ends), ends[k], 1e-12)
        same(slope(lambda x: dot(shape(at + x / length), ends)), ends[k + 1], 1e-8)


def eq_9_66_9_67_9_68():
    sigma, vx, vs, ahead = 0.4, 12.0, 0.6, 0.9
    _, y = run(lambda y: [-vs - vx * y[0] / sigma, vx], [0.0, 0.0], 1e-4, lambda y: ahead - y[1])
    same(y[0] / sigma, -vs / vx * (1 - exp(-ahead / sigma)), 1e-7)
    rise = lambda x: max(0, min(1, x)) ** 2 * (3 - 2 * max(0, min(1, x)))

    def relaxed(u, v0=1.0, parked=0.2):  # locked wheel at the speed vs
        p = rise((2 * vs**2 / v0**2 - 1) / 3)
        bound = 2 * p + (1 - p) * parked
        return -vs - (p * vs + rise(10 * abs(u / sigma) / bound - 9) * vs / bound) * u / sigma, bound

    _, y = run(lambda y: [relaxed(y[0])[0], 1.0], [0.0, 0.0], 1e-3, lambda y: 5 - y[1])
    same(-y[0] / sigma, relaxed(y[0])[1], 1e-3)  # slides at the bound of the slip
    require(rise((2.0**2 - 1) / 3) == 1, "the weight of the speed is not one at twice the low speed")


# --- chapter 10 --------------------------------------------------------------------------------
def inertia_of(points):
    """Mass, centre and tensor of (mass, position)."""
    mass = sum(m for m, _ in points)
    centre = [sum(m * x[i] for m, x in points) / mass for i in range(3)]
    return mass, centre, about(points, centre)


def about(points, at):
    tensor = [[0.0] * 3 for _ in range(3)]
    for m, x in points:
        d = add(x, at, -1)
        tensor = [[tensor[i][j] + m * ((i == j) * dot(d, d) - d[i] * d[j]) for j in range(3)] for i in range(3)]
    return tensor


def agree(a, b, tolerance=1e-10):
    for row, other in zip(a, b):
        for x, y in zip(row, other):
            same(x, y, tolerance)


def eq_10_1_10_2_10_3():
    cloud = lambda: [(DRAW.uniform(0.5, 2), vector()) for _ in range(6)]
    first, second, r, axes = cloud(), cloud(), vector(), rotation(vector())
    m, c, j = inertia_of(first)
    d = add(r, c, -1)
    point = [[m * ((i == k) * dot(d, d) - d[i] * d[k]) for k in range(3)] for i in range(3)]
    agree([add(x, y) for x, y in zip(j, point)], about(first, r))
    moved = inertia_of([(w, add(r, apply(axes, x))) for w, x in first])
    agree(product(product(axes, j), turned(axes)), moved[2])
    agree([add(r, apply(axes, c))], [moved[1]])
    mb, cb, jb = inertia_of(second)
    d, share = add(cb, c, -1), m * mb / (m + mb)
    joined = [[j[i][k] + jb[i][k] + share * ((i == k) * dot(d, d) - d[i] * d[k]) for k in range(3)] for i in range(3)]
    agree(joined, inertia_of(first + second)[2])


def eq_10_4_10_5():
    m, r, s, length = 3.0, 0.5, 0.3, 1.2
    area = pi * (r**2 - s**2)
    x2 = m / area * integral(lambda q: pi * q**3, s, r)  # ∫ x² over a ring is half the polar moment
    same(x2, m * (r**2 + s**2) / 4, 1e-10)
    same(m / length * integral(lambda z: z * z, -length / 2, length / 2), m * length**2 / 12, 1e-10)
    same(m / (4 / 3 * pi * r**3) * integral(lambda z: z * z * pi * (r * r - z * z), -r, r), m * r * r / 5, 1e-10)


BOX = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def eq_10_6_10_7_10_8_10_9():
    edges, move, axes = [0.4, 0.7, 1.1], vector(), rotation(vector())
    place = lambda x: add(move, apply(axes, [a * (b - 0.5) for a, b in zip(edges, x)]))
    volume, first, second, area = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)], [0.0] * 3
    for face in FACES:
        p = [place(BOX[i]) for i in face]
        d, s = dot(p[0], cross(p[1], p[2])), add(add(p[0], p[1]), p[2])
        volume, first = volume + d / 6, add(first, s, d / 24)
        for a in (*p, s):
            second = [add(x, y, d / 120) for x, y in zip(second, outer(a, a))]
        area = add(area, cross(add(p[1], p[0], -1), add(p[2], p[0], -1)))
    require(norm(area) < 1e-12, "the vector area of a closed mesh is not zero")
    same(volume, edges[0] * edges[1] * edges[2], 1e-12)
    c = times(1 / volume, first)
    agree([c], [move])
    central = [add(x, y, -volume) for x, y in zip(second, outer(c, c))]
    trace = sum(central[i][i] for i in range(3))
    tensor = [[(i == j) * trace - central[i][j] for j in range(3)] for i in range(3)]
    squares = [volume * e * e / 12 for e in edges]
    principal = [[(i == j) * (sum(squares) - squares[i]) for j in range(3)] for i in range(3)]
    agree(tensor, product(product(axes, principal), turned(axes)))


def eq_10_10():
    roll, pitch, yaw = 0.4, -0.7, 1.9
    r = product(product(rotation([0, 0, yaw]), rotation([0, pitch, 0])), rotation([roll, 0, 0]))
    same(r[2][0], -sin(pitch), 1e-12)
    same(r[0][1], cos(yaw) * sin(pitch) * sin(roll) - sin(yaw) * cos(roll), 1e-12)


def eq_10_16_10_17():
    young, density, area, h = 2e11, 7800.0, 1e-4, 0.01
    for mass, factor in (density * area * h, sqrt(0.5)), (2 / 3 * density * area * h, sqrt(0.75)):
        same(0.5 * h * sqrt(2 * young * area / h / mass), factor * sqrt(young / density), 1e-12)
    speed = lambda l, m, k: 0.5 * l * sqrt(k / m)  # the same body in millimetres, tonnes, N/mm
    same(speed(0.01e3, 2e-3, 5e3) * 1e-3 * sqrt(1e3 / 1e3), speed(0.01, 2.0, 5e6), 1e-12)


# --- chapter 11 --------------------------------------------------------------------------------
def eq_11_1_11_2():
    points = [(DRAW.uniform(0.5, 2), vector(), vector()) for _ in range(5)]
    scalar = lambda f, g: sum(m * dot(f(x, v), g(x, v)) for m, x, v in points)
    e = [[float(i == j) for j in range(3)] for i in range(3)]
    u = lambda i: (lambda x, v: e[i])
    w = lambda i: (lambda x, v: cross(e[i], x))
    mass, centre, _ = inertia_of([(m, x) for m, x, _ in points])
    same(scalar(u(0), u(0)), mass, 1e-12)
    found = [scalar(w(2), u(1)), -scalar(w(2), u(0)), scalar(w(1), u(0))]
    agree([found], [times(mass, centre)])
    angular = [scalar(w(i), lambda x, v: v) for i in range(3)]
    agree([angular], [[sum(m * cross(x, v)[i] for m, x, v in points) for i in range(3)]])


def eq_11_7():
    h, n = 0.01, 150
    power = lambda t: exp(-t) * cos(3 * t)
    rule = h * sum(0.5 * (power(k * h) + power((k + 1) * h)) for k in range(n))
    rise = slope(lambda t: power(n * h + t)) - slope(power)
    same((rule - integral(power, 0, n * h, 2000)) / (h * h / 12 * rise), 1, 1e-3)


def eq_11_8():
    k, a, b = [vector() for _ in range(3)], vector(), vector()
    k = [[k[i][j] + k[j][i] for j in range(3)] for i in range(3)]
    energy = lambda r: 0.5 * dot(r, apply(k, r))
    same(0.5 * dot(add(apply(k, a), apply(k, b)), add(b, a, -1)), energy(b) - energy(a), 1e-12)


def eq_11_9_11_10():
    omega, a = vector(), rotation(vector())
    w = lambda t: apply(turned(product(rotation(times(t, omega)), a)), omega)  # body axes: constant
    for i in range(3):
        same(slope(lambda t: w(t)[i]), 0, 1e-9)
    r = vector()
    velocity = lambda t: cross(omega, apply(rotation(times(t, omega)), r))
    agree([[slope(lambda t: velocity(t)[i]) for i in range(3)]], [cross(omega, cross(omega, r))], 1e-8)


def eq_11_11():
    w, spin = 3.0, 1.2
    for rate in w + spin, w - spin:
        diagonal, coriolis = w * w - spin * spin - rate * rate, 2j * spin * rate
        same(abs(diagonal * diagonal + coriolis * coriolis), 0, 1e-12)


def eq_7_24_11_12():
    m, d, k, tau = 2.0, 0.9, 50.0, 1.7
    mass, damping = tau * tau * m, tau * d
    q = mass + damping + k
    y, z = (mass + damping) / q, mass / q
    half, det = (-y - z) / 2, y * z + z * (1 - y)  # of [[-y, -z], [1 - y, -z]]
    for mu in half + cmath.sqrt(half * half - det), half - cmath.sqrt(half * half - det):
        s = tau * (1 + 1 / mu)
        same(abs(m * s * s + d * s + k), 0, 1e-9)


def eq_11_16():
    r, nu, p = 0.8, 0.3, 5.0
    inertia, rho = pi * r**4 / 4, (1 - 2 * nu) / (3 + 2 * nu)
    factor = (3 + 2 * nu) / (8 * (1 + nu)) * p / inertia
    shear = lambda y, z: (factor * (r * r - y * y - rho * z * z), -factor * 2 * (1 + 2 * nu) / (3 + 2 * nu) * y * z)
    ring = lambda s: s * integral(lambda t: shear(s * cos(t), s * sin(t))[0], 0, 2 * pi, 40)
    same(integral(ring, 0, r, 40), p, 1e-9)
    for t in 0.3, 1.1, 2.9:
        tau = shear(r * cos(t), r * sin(t))
        same(tau[0] * cos(t) + tau[1] * sin(t), 0, 1e-12)


def eq_11_18():
    g, r, acc, w, alpha, a, u = vector(), vector(), vector(), vector(), vector(), rotation(vector()), vector()
    skew = lambda x: [[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]]
    b = apply(turned(a), add(acc, g, -1))
    gradient = [add(x, y) for x, y in zip(skew(alpha), product(skew(w), skew(w)))]

    def place(t):  # body rates w + alpha t to second order
        turn = add(times(t, w), alpha, t * t / 2)
        return add(add(r, acc, t * t / 2), apply(product(a, rotation(turn)), u))

    h = 1e-3
    second = [(x - 2 * y + z) / h**2 for x, y, z in zip(place(h), place(0), place(-h))]
    agree([apply(turned(a), add(second, g, -1))], [add(b, apply(gradient, u))], 1e-5)


def fourier(x, k):
    return sum(v * cmath.exp(-2j * pi * k * i / len(x)) for i, v in enumerate(x))


def eq_11_20_11_21_11_22_11_23():
    n = 128
    hann = [0.5 * (1 - cos(2 * pi * i / n)) for i in range(n)]
    amplitude = lambda f, k: 2 * abs(fourier([w * cos(2 * pi * f * i / n + 0.4) for i, w in enumerate(hann)], k)) / sum(hann)
    same(amplitude(20, 20), 1, 1e-12)
    same(amplitude(20.5, 20), 8 / (3 * pi), 1e-3)
    same(2 * integral(lambda x: sin(pi * x) ** 2 * cos(pi * (x - 0.5)), 0, 1), 8 / (3 * pi), 1e-9)
    share = lambda f: 1 if f <= 10 else 0.5 * (1 + cos(pi * (f - 10) / 4)) if f < 14 else 0
    x = [cos(2 * pi * 3 * i / n + 0.3) + cos(2 * pi * 12 * i / n) + cos(2 * pi * 30 * i / n) for i in range(n)]
    terms = [fourier(x, k) / n for k in range(n)]
    for i in 0, 17, 90:
        y = sum(share(min(k, n - k)) * c * cmath.exp(2j * pi * k * i / n) for k, c in enumerate(terms)).real
        same(y, cos(2 * pi * 3 * i / n + 0.3) + 0.5 * cos(2 * pi * 12 * i / n), 1e-10)


def eq_11_25():
    cycles, points = {}, []
    count = lambda a, b, n: cycles.__setitem__(abs(a - b), cycles.get(abs(a - b), 0) + n)
    for s in -2, 1, -3, 5, -1, 3, -4, 4, -2:  # example of ASTM E1049-85, Fig. 6
        points.append(s)
        while len(points) > 2 and abs(points[-1] - points[-2]) >= abs(points[-2] - points[-3]):
            if len(points) == 3:
                count(points[0], points[1], 0.5)
                points.pop(0)
            else:
                count(points[-3], points[-2], 1)
                del points[-3:-1]
    for a, b in zip(points, points[1:]):
        count(a, b, 0.5)
    require(cycles == {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}, f"rainflow counts {cycles}")
    same(sum(cycles.values()), 4, 1e-12)  # half of the eight ranges


def eq_11_26_11_27():
    ranges, counts, m, s0, n0 = [90.0, 40.0, 130.0], [1, 2.5, 0.5], 3.0, 71.0, 2e6
    damage = lambda s, n: sum(c / (n0 * (s0 / r) ** m) for r, c in zip(s, n))
    equivalent = (sum(c * r**m for r, c in zip(ranges, counts)) / sum(counts)) ** (1 / m)
    same(damage([equivalent], [sum(counts)]) / damage(ranges, counts), 1, 1e-12)
    same(damage([1.01 * r for r in ranges], counts) / damage(ranges, counts), 1.01**m, 1e-12)


def eq_11_28():
    most = max((x + 1) * x * (1 - x) * (2 - x) for x in (i / 1000 for i in range(1001)))
    same(most / 24, 3 / 128, 1e-12)


def eq_11_29_11_30_11_31_11_32():
    p, q, truth = 2.3, 1.7, 4.0
    y = lambda n, h: truth + 0.8 * n**-p - 0.5 * h**q
    sizes = [1 / 5, 1 / 12, 1 / 20]
    d1, d2 = (abs(y(1 / a, 0.1) - y(1 / b, 0.1)) for a, b in zip(sizes, sizes[1:]))
    ratio = lambda k: (sizes[0] ** k - sizes[1] ** k) / (sizes[1] ** k - sizes[2] ** k)
    same(root(lambda k: ratio(k) - d1 / d2, 0.05, 20), p, 1e-9)
    limit = y(20, 0.1) + (y(20, 0.1) - y(12, 0.1)) / ((20 / 12) ** p - 1) + (y(20, 0.1) - y(20, 0.2)) / (2**q - 1)
    same(limit, truth, 1e-12)
    sequence = lambda s: 1 + s**2 + 0.7 * s**4  # the error bar covers the error of the limit
    values = [sequence(0.5**k) for k in range(2, 6)]
    growth = [(a - z) / (b - a) for z, a, b in zip(values, values[1:], values[2:])]  # r^p
    limits = [b + (b - a) / (g - 1) for a, b, g in zip(values[1:], values[2:], growth)]
    bound = abs(limits[1] - limits[0]) / min(growth[1] - 1, 3)
    require(abs(limits[1] - 1) <= bound, f"the error bar {bound} does not cover the error {abs(limits[1] - 1)}")


def eq_11_35_11_36():
    curvature = lambda s: [0.4 + 0.2 * s, 0.9 - 0.3 * s, 0.5 + 0.6 * s]

    def tangents(count, h):
        axes, out = rotation([0.3, 0.2, -0.1]), []
        for k in range(count):
            out.append([row[0] for row in axes])
            axes = product(axes, rotation(times(h, curvature((k + 0.5) * h))))
        return out

    h, k = 1e-3, 500
    t = tangents(2 * k, h)
    first = times(1 / (2 * h), add(t[k + 1], t[k - 1], -1))
    second = times(1 / h**2, add(add(t[k + 1], t[k], -2), t[k - 1]))
    s = k * h
    _, k2, k3 = curvature(s)
    same(norm(first), math.hypot(k2, k3), 1e-5)
    expected = curvature(s)[0] + (k2 * 0.6 + k3 * 0.3) / (k2**2 + k3**2)
    same(dot(t[k], cross(first, second)) / dot(first, first), expected, 1e-4)


def checks():
    return {name: f for name, f in globals().items() if name.startswith("eq_")}


def numbers():
    """Numbers of the equations with a check."""
    return sorted({f"{a}.{b}" for name in checks() for a, b in re.findall(r"(\d+)_(\d+)(?=_|$)", name.removeprefix("eq_"))},
                  key=lambda number: tuple(map(int, number.split("."))))


def faults():
    """Messages of failed checks."""
    out = []
    for name, check in checks().items():
        FOUND.clear()
        check()
        out += [f"formulas.py, {name}: {found.strip()}" for found in FOUND]
    return out
