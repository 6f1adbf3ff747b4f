"""Reference values of tests/cases/wheels_test.cpp and cars_test.cpp: quarter car over a bump, by scipy.

The program shares no code with polybody. The contact point is the foot of the perpendicular from the wheel centre to the
profile, found by Newton's method; the equations of motion are integrated with DOP853 between the grid points.
"""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

G, R, V = 9.81, 0.3, 5.0
M_BODY, M_HUB, M_WHEEL, J = 300.0, 25.0, 15.0, 1.0
K_BODY, C_BODY, K_TYRE, C_TYRE = 2e4, 1.5e3, 2e5, 100.0
C_SLIP, SIGMA, TAU = 5e4, 0.2, 2e-3
SPACING = 0.25
X = SPACING * np.arange(-8, 41)
Z = np.zeros(len(X))
Z[(X > 1.1) & (X < 1.9)] = [0.025, 0.05, 0.025]
slopes = np.gradient(Z, SPACING)  # central differences
ROAD = CubicHermiteSpline(X, Z, slopes)
SLOPE, CURVE = ROAD.derivative(1), ROAD.derivative(2)


def foot(x, z):
    p = x
    for _ in range(50):
        h, s = ROAD(p), SLOPE(p)
        f = (p - x) + (h - z) * s
        step = f / (1 + s * s + (h - z) * CURVE(p))
        p -= step
        if abs(step) < 1e-15:
            break
    return p


def rates(t, y):
    zs, zu, vs, vu, spin, u = y
    x = V * t
    p = foot(x, zu)
    s = SLOPE(p)
    n, e = np.array([-s, 1.0]) / np.hypot(1, s), np.array([1.0, s]) / np.hypot(1, s)
    r = np.hypot(x - p, zu - ROAD(p))
    v = np.array([V, vu])
    load = max(0.0, K_TYRE * (R - r) - C_TYRE * (v @ n)) if r < R else 0.0
    forward = v @ e
    slip = forward - spin * r
    du = -slip - abs(forward) * u / SIGMA
    along = C_SLIP * (u + TAU * du) / SIGMA
    along = np.clip(along, -load, load)  # friction coefficient 1
    pull = K_BODY * (zs - zu - (0.5 + M_BODY * G / K_BODY)) + C_BODY * (vs - vu)
    up = load * n[1] + along * e[1]
    return [vs, vu, -pull / M_BODY - G, (pull + up) / (M_HUB + M_WHEEL) - G, -along * r / J, du]


def quarter_car():
    d = (M_BODY + M_HUB + M_WHEEL) * G / K_TYRE
    y = np.array([R - d + 0.5, R - d, 0.0, 0.0, V / (R - d), 0.0])
    stops = [0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.7, 1.0]
    print("time, z_body, z_wheel, spin")
    t, found = 0.0, {}
    for stop in sorted(set(stops) | set(X[(X > 0) & (X < 5)] / V)):
        # the foot passes grid points near these times; small steps resolve the kink of the curvature
        y = solve_ivp(rates, (t, stop), y, method="DOP853", rtol=1e-11, atol=1e-13, max_step=1e-3).y[:, -1]
        t = stop
        if stop in stops:
            print(f"{{{stop}, {y[0]:.9f}, {y[1]:.9f}, {y[4]:.8f}}}")


quarter_car()
