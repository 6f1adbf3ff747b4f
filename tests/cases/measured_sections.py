#!/usr/bin/env python3
"""Frequencies of the composite cantilever and of the twisted blade of measured_sections_test.cpp.

Cantilever: linear beam with a 6x6 stiffness and mass: strains (u' + x-axis cross terms, theta'), one spectral element of order p on
Gauss-Lobatto points, integrated by 2p Gauss points. Frequencies [rad/s] are printed for p = 12 and 16, in SI units; the mass
matrix may be offset from the axis.

Blade: inextensible Euler-Bernoulli beam of unit mass and length, whose principal axes (EI_y = 1, EI_z = 4) rotate by 45 degrees from
root to tip, in rotation about z; Ritz method in x^2 times Legendre polynomials.
"""

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import eigh

INCH, POUND = 0.0254, 4.4482216152605
STIFFNESS = 1e3 * np.array([
    [1368.17, 0, 0, 0, 0, 0], [0, 88.56, 0, 0, 0, 0], [0, 0, 38.78, 0, 0, 0],
    [0, 0, 0, 16.96, 17.61, -0.351], [0, 0, 0, 17.61, 59.12, -0.370], [0, 0, 0, -0.351, -0.370, 141.47]])
MASS = np.diag([8.538e-2, 8.538e-2, 8.538e-2, 1.4433e-2, 0.40972e-2, 1.0336e-2])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def moved(form, r):
    """The form of screws at the axis, for a form of screws at the point r of the section."""
    change = np.eye(6)
    change[:3, 3:] = -skew(r)
    return change.T @ form @ change


def frequencies(stiffness, mass, length, p):
    nodes = np.concatenate(([-1.0], legendre.Legendre.basis(p).deriv().roots(), [1.0]))
    points, weights = legendre.leggauss(2 * p)
    n = p + 1
    basis = np.linalg.inv(legendre.legvander(nodes, p))
    k, m = np.zeros((6 * n, 6 * n)), np.zeros((6 * n, 6 * n))
    for x, w in zip(points, weights):
        value = legendre.legvander([x], p)[0] @ basis
        slope = np.array([legendre.Legendre.basis(j).deriv()(x) for j in range(p + 1)]) @ basis * 2.0 / length
        b, shape = np.zeros((6, 6 * n)), np.zeros((6, 6 * n))
        for i in range(n):
            b[:, 6 * i:6 * i + 6] = slope[i] * np.eye(6)
            b[:3, 6 * i + 3:6 * i + 6] += value[i] * skew([1, 0, 0])  # gamma = u' + e_x x theta
            shape[:, 6 * i:6 * i + 6] = value[i] * np.eye(6)
        k += 0.5 * length * w * b.T @ stiffness @ b
        m += 0.5 * length * w * shape.T @ mass @ shape
    return np.sqrt(eigh(k[6:, 6:], m[6:, 6:], eigvals_only=True)[:6])


si = np.diag([1, 1, 1, INCH, INCH, INCH])
stiffness = POUND * si @ STIFFNESS @ si
mass = POUND / INCH**2 * si @ MASS @ si  # lb s^2/in per inch
for r in ([0, 0, 0], [0, 0.3 * INCH, -0.2 * INCH]):
    for p in (12, 16):
        print(r, p, np.array2string(frequencies(stiffness, moved(mass, np.array(r)), 10 * INCH, p), precision=9))


def blade_frequencies(omega, twist, count):
    points, weights = legendre.leggauss(40)
    x, w = 0.5 * (points + 1.0), 0.5 * weights
    shapes = [np.polynomial.Polynomial([0, 0, 1]) * legendre.Legendre.basis(k, domain=[0, 1]).convert(kind=np.polynomial.Polynomial)
              for k in range(count)]
    value, slope, bend = (np.array([f.deriv(d)(x) if d else f(x) for f in shapes]) for d in range(3))
    zero = np.zeros_like(value)
    v, vx, vxx = np.vstack([value, zero]), np.vstack([slope, zero]), np.vstack([bend, zero])
    u, ux, uxx = np.vstack([zero, value]), np.vstack([zero, slope]), np.vstack([zero, bend])
    c, s, pull = np.cos(twist * x), np.sin(twist * x), 0.5 * omega**2 * (1.0 - x**2)
    about_y, about_z = -c * uxx + s * vxx, s * uxx + c * vxx

    def product(a, b, weight=1.0):
        return (a * (w * weight)) @ b.T

    k = product(about_y, about_y, 1.0) + product(about_z, about_z, 4.0)
    k += product(vx, vx, pull) + product(ux, ux, pull) - omega**2 * product(v, v)
    return np.sqrt(eigh(k, product(v, v) + product(u, u), eigvals_only=True)[:6])


for omega in (0.0, 4.0, 8.0):
    for count in (10, 12):
        print(omega, count, np.array2string(blade_frequencies(omega, 0.25 * np.pi, count), precision=8))
