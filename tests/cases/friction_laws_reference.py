"""Reference values of joint friction: tests/unit/forces/friction_laws_test.cpp. Requires NumPy and SciPy; the tests do not
run it.

The parameters are those of the stick-slip example of Canudas de Wit, Olsson, Astrom & Lischinsky 1995: m = 1 kg, spring of
2 N/m drawn at 0.1 m/s, F_c = 1 N, F_s = 1.5 N, v_s = 1e-3 m/s, c = 0.4 N s/m, sigma_0 = 1e5 N/m, sigma_1 = sqrt(1e5) N s/m.
LSODA and Radau with relative tolerances of 1e-11 agree in the printed digits.
"""
import numpy as np
from scipy.integrate import solve_ivp

FC, FS, VS, C, S0, S1 = 1.0, 1.5, 1e-3, 0.4, 1e5, np.sqrt(1e5)


def rate(v, z, share):
    """Rate of the bristle: LuGre for share = 0, otherwise elasto-plastic after Dupont et al. 2002."""
    steady = (FC + (FS - FC) * np.exp(-((v / VS) ** 2))) / S0
    if share == 0.0:
        return v - abs(v) * z / steady
    elastic = share * FC / S0
    if abs(z) <= elastic or z * v < 0.0:
        return v
    if abs(z) >= steady:
        return v * (1 - abs(z) / steady)
    alpha = 0.5 + 0.5 * np.sin(np.pi * (abs(z) - 0.5 * (steady + elastic)) / (steady - elastic))
    return v * (1 - alpha * abs(z) / steady)


def friction(v, z, share):
    return S0 * z + S1 * rate(v, z, share) + C * v


def solve(f, times, y0):
    runs = [solve_ivp(f, (0, times[-1]), y0, method=m, t_eval=times, rtol=r, atol=1e-14, max_step=1e-2)
            for m, r in (("LSODA", 1e-11), ("Radau", 1e-10))]
    return runs[0].y, np.abs(runs[0].y - runs[1].y).max()


def loop(share):
    """Friction in the motion x = A sin t, A = 1.2e-5 m, at multiples of pi/4 over two periods."""
    a = 1.2e-5
    times = np.arange(1, 17) * np.pi / 4
    y, apart = solve(lambda t, y: [rate(a * np.cos(t), y[0], share)], times, [0.0])
    return [float(friction(a * np.cos(t), z, share)) for t, z in zip(times, y[0])], S0 * apart


def stick_slip(share):
    """Position of the mass at multiples of 5 s."""
    times = np.arange(1, 5) * 5.0

    def f(t, y):
        x, v, z = y
        return [v, 2.0 * (0.1 * t - x) - friction(v, z, share), rate(v, z, share)]

    y, apart = solve(f, times, [0.0, 0.0, 0.0])
    return [float(x) for x in y[0]], apart


for name, share in (("LuGre", 0.0), ("elasto-plastic, share 0.8", 0.8)):
    for what, run in (("loop", loop), ("stick-slip", stick_slip)):
        values, apart = run(share)
        print(name, what, [f"{x:.10g}" for x in values], f"methods differ by {apart:.1e}")
