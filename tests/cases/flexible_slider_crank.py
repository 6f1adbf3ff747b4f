"""Reference values of case D8: a slider-crank with a flexible coupler. Requires NumPy and SciPy; the tests do not run it.

  flexible_slider_crank.py [SEGMENTS...]    default: 8 16 32

Two models share no method with polybody.

finite_segments  The coupler is a chain of N rigid segments of length l with pins and torsion springs EI/l between them.
    The coordinates are the N absolute angles. The crank pin has the motion of the crank, and one multiplier keeps the
    slider on its axis. Angles are of any size. The error is of order 1/N^2; two chains give the limit by Richardson's
    extrapolation. The coupler has no axial strain and no shear. The neglected strain P/EA is 6e-5 at the largest
    axial force P, 1.4 kN, and P is 0.3 of Euler's load. The shear deformation pi^2 EI / (GA L^2) is 7e-4 of that of
    bending.
moving_chord  The coupler is a simply supported Euler-Bernoulli beam in the axes of its chord, with K sine modes q_k:
    m_k q_k'' + (k_k - mu L w^2 / 2) q_k = -mu (a_y s_k + w' x_k),    s_k = int sin, x_k = int x sin,
    where a_y is the transverse acceleration of the crank pin minus gravity, and w the angular velocity of the chord
    of the rigid mechanism. Axial forces have no effect on it. It is the limit of a floating frame without stiffening.

Result: the peak of the deflection of the middle from the chord is 5.58144 mm. It changes by 3e-7 m (5e-5 of the
peak) from the pair N = 8, 16 to the pair N = 16, 32, so its error is about 2e-8 m. Without axial forces it is
6.16115 mm, with an error below 1e-9 m for K = 10.
"""
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import cho_factor, cho_solve

CRANK, ROD, HEIGHT, WIDTH, DENSITY, YOUNG = 0.1, 0.4, 0.006, 0.02, 7800.0, 2e11
SLIDER, GRAVITY, SPEED, DURATION, END = 0.5, 9.81, 150.0, 0.1, 0.2
MU = DENSITY * HEIGHT * WIDTH
EI = YOUNG * WIDTH * HEIGHT**3 / 12
ROTARY = DENSITY * WIDTH * HEIGHT**3 / 12  # rotary inertia per length


def drive(t):
    """Angle of the crank with its rate and acceleration."""
    if t >= DURATION:
        return SPEED * (t - 0.5 * DURATION), SPEED, 0.0
    w = 2 * np.pi / DURATION
    k = SPEED / DURATION
    return k * (0.5 * t * t + (np.cos(w * t) - 1) / w**2), k * (t - np.sin(w * t) / w), k * (1 - np.cos(w * t))


def crank_pin(t):
    """Position, velocity and acceleration of the crank pin."""
    a, w, e = drive(t)
    along, across = np.array([np.cos(a), np.sin(a)]), np.array([-np.sin(a), np.cos(a)])
    return CRANK * along, CRANK * w * across, CRANK * (e * across - w * w * along)


def finite_segments(n, times, tolerance=1e-9):
    """Deflection of the middle from the chord and position of the slider at `times`, for an even number n."""
    l = ROD / n
    centres = np.tril(np.ones((n, n)), -1) + 0.5 * np.eye(n)  # mass centres, in segments
    mass = MU * l**3 * centres.T @ centres
    first = MU * l**2 * centres.sum(axis=0)
    inertia = MU * l**3 / 12 + ROTARY * l
    springs = EI / l * (np.diag(np.r_[1.0, 2.0 * np.ones(n - 2), 1.0]) - np.eye(n, k=1) - np.eye(n, k=-1))

    def rates(t, y):
        a, w = y[:n], y[n:]
        c, s = np.cos(a), np.sin(a)
        at, moving, pin = crank_pin(t)
        m = mass * (np.outer(c, c) + np.outer(s, s)) + inertia * np.eye(n) + SLIDER * l * l * np.outer(s, s)
        ax, ay = -c * w * w, -s * w * w  # accelerations of the directions at zero angular acceleration
        f = -springs @ a + s * (mass @ ax) - c * (mass @ ay)
        f += first * (s * pin[0] - c * (pin[1] + GRAVITY)) + SLIDER * l * s * (pin[0] + l * ax.sum())
        # The slider remains on its axis: at_y + l sum(s) = 0. The feedback only removes rounding errors.
        gap, gap_rate = at[1] + l * s.sum(), moving[1] + l * c @ w
        wanted = -(pin[1] + l * ay.sum()) - 2 * 2e3 * gap_rate - 2e3**2 * gap
        factor = cho_factor(m)
        by_force, by_guide = cho_solve(factor, f), cho_solve(factor, l * c)
        guide = (wanted - l * c @ by_force) / (l * c @ by_guide)
        return np.r_[w, by_force + by_guide * guide]

    y = solve_ivp(rates, (0, END), np.zeros(2 * n), method="DOP853", t_eval=times, rtol=tolerance, atol=0.01 * tolerance)
    assert y.success
    c, s = np.cos(y.y[:n]), np.sin(y.y[:n])
    end, middle = l * np.array([c.sum(0), s.sum(0)]), l * np.array([c[: n // 2].sum(0), s[: n // 2].sum(0)])
    chord = np.hypot(*end)
    slider = np.array([crank_pin(t)[0][0] for t in times]) + end[0]
    return (end[0] * middle[1] - end[1] * middle[0]) / chord, slider


def chord_of_rigid_rod(t):
    """Angle of the rod of the rigid mechanism with its rate and acceleration."""
    r, v, a = crank_pin(t)
    s = -r[1] / ROD
    p = np.arcsin(s)
    w = -v[1] / ROD / np.cos(p)
    return p, w, (-a[1] / ROD + s * w * w) / np.cos(p)


def moving_chord(modes, times, tolerance=1e-10):
    """Deflection of the middle from the chord without the effect of axial forces."""
    i = np.arange(1, modes + 1)
    b = i * np.pi / ROD
    mass, stiffness = 0.5 * ROD * (MU + ROTARY * b**2), 0.5 * ROD * EI * b**4
    total, moment = np.where(i % 2 == 1, 2 / b, 0.0), np.where(i % 2 == 1, ROD / b, -ROD / b)

    def rates(t, y):
        q, v = y[:modes], y[modes:]
        p, w, e = chord_of_rigid_rod(t)
        a = crank_pin(t)[2]
        across = -np.sin(p) * a[0] + np.cos(p) * (a[1] + GRAVITY)
        return np.r_[v, (-MU * (across * total + e * moment) + (0.5 * ROD * MU * w * w - stiffness) * q) / mass]

    y = solve_ivp(rates, (0, END), np.zeros(2 * modes), method="DOP853", t_eval=times, rtol=tolerance, atol=1e-13)
    assert y.success
    return np.sin(i * np.pi / 2) @ y.y[:modes]


if __name__ == "__main__":
    times = np.linspace(0, END, 401)
    sizes = [int(x) for x in sys.argv[1:]] or [8, 16, 32]
    chains = [finite_segments(n, times) for n in sizes]
    limits = [[(4 * fine - coarse) / 3 for coarse, fine in zip(*pair)] for pair in zip(chains, chains[1:])]
    for n, (bend, slider) in zip(sizes, chains):
        print(f"{n} segments: peak {1e3 * abs(bend).max():.5f} mm, slider {slider[-1]:.8f} m")
    for n, (bend, slider) in zip(sizes[1:], limits):
        print(f"limit by {n}: peak {1e3 * abs(bend).max():.5f} mm, slider {slider[-1]:.8f} m")
    for before, after in zip(limits, limits[1:]):
        print("change of the limit:", *(abs(x - y).max() for x, y in zip(before, after)))
    for modes in (3, 6, 10):
        linear = moving_chord(modes, times)
        print(f"{modes} modes, without axial forces: peak {1e3 * abs(linear).max():.5f} mm")
    print("time [s], deflection [mm], the same without axial forces [mm], slider [m]")
    for j in range(20, 401, 20):
        print(f"{{{times[j]:.2f}, {1e3 * limits[-1][0][j]:.4f}, {1e3 * linear[j]:.4f}, {limits[-1][1][j]:.7f}}},")
