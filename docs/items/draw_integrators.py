"""Drawings of the integrators: spectral radius of a step for the equation ẍ + ω² x = 0."""

from math import log10, sqrt

from sketch import BLUE, GREY, INK, ORANGE, RED, SCALE, Sketch

LEFT, RIGHT, BOTTOM, TOP = 55, 395, 215, 25  # of the diagram [pixels]
HIGHEST = 1.2  # spectral radius at the upper edge


def roots(coefficients):
    """Roots of a polynomial by Durand and Kerner; the first coefficient is that of the highest power."""
    scaled = [c / coefficients[0] for c in coefficients[1:]]
    found = [(0.4 + 0.9j) ** k for k in range(len(scaled))]
    for _ in range(200):
        for i, z in enumerate(found):
            value, below = 1.0, 1.0
            for c in scaled:
                value = value * z + c
            for j, other in enumerate(found):
                below *= z - other if j != i else 1.0
            found[i] = z - value / below
    return found


def alpha_method(alpha_m, alpha_f, gamma, beta):
    """Spectral radius of the generalised-α family over x = ωh, from its amplification matrix for (q, h v, h² a)."""

    def radius(x):
        w, below = x * x, 1.0 - alpha_m + (1.0 - alpha_f) * x * x * beta
        # h² a₁ = e · (q, h v, h² a)
        e = (-w / below, -(1.0 - alpha_f) * w / below, -((1.0 - alpha_f) * w * (0.5 - beta) + alpha_m) / below)
        m = [[1.0 + beta * e[0], 1.0 + beta * e[1], 0.5 - beta + beta * e[2]], [gamma * e[0], 1.0 + gamma * e[1], 1.0 - gamma + gamma * e[2]], list(e)]
        trace = m[0][0] + m[1][1] + m[2][2]
        minors = sum(m[i][i] * m[j][j] - m[i][j] * m[j][i] for i, j in ((0, 1), (0, 2), (1, 2)))
        det = sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
        return max(abs(z) for z in roots([1.0, -trace, minors, -det]))

    return radius


def generalised_alpha(rho):
    m, f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 - m + f
    return alpha_method(m, f, gamma, 0.25 * (gamma + 0.5) ** 2)


def hht(alpha):
    return alpha_method(0.0, -alpha, 0.5 - alpha, 0.25 * (1.0 - alpha) ** 2)


def newmark(gamma):
    return alpha_method(0.0, 0.0, gamma, 0.25 * (gamma + 0.5) ** 2)


def polynomial(*c):
    return lambda x: abs(sum(a * (1j * x) ** k for k, a in enumerate(c)))


def radau(x):
    z = 1j * x
    return abs((1 + 2 * z / 5 + z * z / 20) / (1 - 3 * z / 5 + 3 * z * z / 20 - z**3 / 60))


def decaying(rho):
    chi = 0.5 * (1.0 - rho) / (1.0 + rho)
    return lambda x: abs((1 + (0.5 - chi) * 1j * x) / (1 - (0.5 + chi) * 1j * x))


def leapfrog(x):
    """The larger root of z² − (2 − x²) z + 1."""
    half = 0.5 * (2.0 - x * x)
    return 1.0 if x <= 2.0 else abs(half) + sqrt(half * half - 1.0)


def diagram(title, curves, limit=None):
    """`curves`: (function of ωh, label, colour). `limit`: the largest stable ωh."""
    s = Sketch(title)
    across = lambda x: LEFT + (RIGHT - LEFT) * (log10(x) + 2.0) / 4.0
    up = lambda y: BOTTOM - (BOTTOM - TOP) * min(y, HIGHEST) / HIGHEST
    label = lambda x, y, words, colour=INK, anchor="middle", size=13: s.text(((x - s.origin[0]) / SCALE, (s.origin[1] - y) / SCALE), words, colour, size, anchor)
    for y in (0.0, 0.5, 1.0):
        s.path([(LEFT, up(y)), (RIGHT, up(y))], colour=GREY, width=1.0)
        label(LEFT - 8, up(y) + 4, f"{y:g}", anchor="end")
    for k in range(-2, 3):
        s.path([(across(10.0**k), BOTTOM), (across(10.0**k), BOTTOM + 5)], width=1.0)
        label(across(10.0**k), BOTTOM + 20, f"{10.0**k:g}")
    s.path([(LEFT, TOP), (LEFT, BOTTOM), (RIGHT, BOTTOM)], width=1.2)
    label(0.5 * (LEFT + RIGHT), BOTTOM + 38, "ωh")
    label(LEFT - 40, TOP - 8, "spectral radius", anchor="start")
    if limit:
        s.path([(across(limit), TOP), (across(limit), BOTTOM)], colour=RED, dash="5 4")
        label(across(limit) + 6, BOTTOM - 12, f"limit {limit:.2f}", RED, "start")
    for row, (curve, words, colour) in enumerate(curves):
        points = []
        for k in range(161):
            x = 10.0 ** (-2.0 + 4.0 * k / 160)
            y = curve(x)
            points.append((round(across(x), 1), round(up(y), 1)))
            if y > HIGHEST:
                break
        s.path(points, colour=colour, width=2.4)
        label(LEFT + 12, BOTTOM - 14 - 20 * (len(curves) - 1 - row), words, colour, "start")
    return s


def adams():
    s = Sketch("Adams predictor and corrector", origin=(70, 190))
    rate = lambda t: 0.9 + 0.9 * t - 0.13 * t * t
    s.path([s.at((0, 0)), s.at((6.4, 0))], head=True)
    s.path([s.at((0, 0)), s.at((0, 3.1))], head=True)
    s.text((6.6, -0.35), "t")
    s.text((-0.4, 3.0), "ẏ")
    known = [0.6, 1.7, 2.8, 3.9]
    s.path([s.at((0.2 + 0.05 * k, rate(0.2 + 0.05 * k))) for k in range(75)], colour=BLUE, width=2.4)
    s.path([s.at((3.95 + 0.05 * k, rate(3.95 + 0.05 * k) - 0.04 * k * k * 0.05)) for k in range(22)], colour=BLUE, dash="6 4", width=2.0)
    for t, name in zip(known, ("t₋₃", "t₋₂", "t₋₁", "t₀")):
        s.pivot((t, rate(t)), 0.09, BLUE)
        s.text((t, -0.35), name)
    s.pivot((5.0, rate(5.0) - 0.9), 0.09, "#ffffff")
    s.pivot((5.0, rate(5.0) - 0.35), 0.09, ORANGE)
    s.text((5.0, -0.35), "t₁")
    s.text((5.25, rate(5.0) - 1.2), "predictor", INK, 13, "start")
    s.text((5.25, rate(5.0) - 0.3), "corrector", ORANGE, 13, "start")
    return s


def on_alpha(title, *curves):
    colours = [BLUE, ORANGE, "#009e73"]
    return lambda: diagram(title, [(curve, words, colour) for (curve, words), colour in zip(curves, colours)])


RK4 = polynomial(1, 1, 1 / 2, 1 / 6, 1 / 24)
DP5 = polynomial(1, 1, 1 / 2, 1 / 6, 1 / 24, 1 / 120, 1 / 600)
DRAWINGS = {
    "generalised_alpha": on_alpha("Generalised-α", *[(generalised_alpha(r), f"ρ∞ = {r:g}") for r in (0.9, 0.8, 0.5)]),
    "hht_alpha": on_alpha("HHT-α", *[(hht(a), f"α = −{-a:g}") for a in (-0.05, -0.1, -0.3)]),
    "newmark": on_alpha("Newmark", (newmark(0.5), "γ = 0.5"), (newmark(0.6), "γ = 0.6"), (newmark(0.9), "γ = 0.9")),
    "trapezoidal": on_alpha("Trapezoidal rule", (newmark(0.5), "trapezoidal rule")),
    "radau": on_alpha("Radau IIA", (radau, "Radau IIA, order 5")),
    "energy_momentum": on_alpha("Energy–momentum method", (decaying(1.0), "energy–momentum method")),
    "energy_decaying": on_alpha("Energy-decaying method", *[(decaying(r), f"ρ∞ = {r:g}") for r in (0.9, 0.5, 0.0)]),
    "runge_kutta4": lambda: diagram("Runge–Kutta method", [(RK4, "Runge–Kutta, order 4", BLUE)], 2.8284),
    "dormand_prince": lambda: diagram("Dormand–Prince method", [(DP5, "Dormand–Prince, order 5", BLUE)]),
    "adams_bashforth_moulton": adams,
    "central_difference": lambda: diagram("Central difference method", [(leapfrog, "central difference", BLUE)], 2.0),
    "symplectic_euler": lambda: diagram("Symplectic Euler method", [(leapfrog, "symplectic Euler", BLUE)], 2.0),
    "rattle": lambda: diagram("Rattle", [(leapfrog, "Rattle", BLUE)], 2.0),
}
