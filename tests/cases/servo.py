#!/usr/bin/env python3
"""Reference values of servo_test.cpp: steps of servos by Runge-Kutta of order 4 with 10 µs, in plain Python.
The kinks of the bounds lie within steps; halving the step changes the values by less than 1e-9."""


def limited(x, bound):
    return max(-bound, min(bound, x))


def run(rates, y, end, step=1e-5):
    for i in range(round(end / step)):
        t = i * step
        k1 = rates(t, y)
        k2 = rates(t + step / 2, [a + step / 2 * b for a, b in zip(y, k1)])
        k3 = rates(t + step / 2, [a + step / 2 * b for a, b in zip(y, k2)])
        k4 = rates(t + step, [a + step * b for a, b in zip(y, k3)])
        y = [a + step / 6 * (p + 2 * q + 2 * r + s) for a, p, q, r, s in zip(y, k1, k2, k3, k4)]
    return y


def pid(tracking_time):
    """J x'' = Q on 0.5 kg m², step of 1 rad: (x, x', I), Q = limited(40 (1 - x) - 6 x' + I, 5)."""

    def rates(_, y):
        x, v, i = y
        free = 40 * (1 - x) - 6 * v + i
        q = limited(free, 5)
        return [v, q / 0.5, 60 * (1 - x) + (q - free) / tracking_time]

    return rates


def slow(_, y):
    """The PD part with the lag 0.02 s and at most 30 N m/s: (x, x', q)."""
    x, v, q = y
    return [v, q / 0.5, limited((limited(40 * (1 - x) - 6 * v, 5) - q) / 0.02, 30)]


for name, rates, n in (("pid, T = 0.2", pid(0.2), 3), ("pid, T = 1e12", pid(1e12), 3), ("rate bound", slow, 3)):
    y, t = [0.0] * n, 0.0
    for end in (0.3, 0.6, 1.0, 1.5):
        shifted = lambda s, z, t=t: rates(s + t, z)
        y, t = run(shifted, y, end - t), end
        print(name, end, " ".join(f"{a:.9f}" for a in y))
