"""Biharmonic functions in the plane with their derivatives, and orthogonal powers: what `goursat` is made of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Jet(NamedTuple):
    """Derivatives of real functions by z and conj(z), each (n, k) (y: conj z); w and zy are real."""

    w: np.ndarray
    z: np.ndarray
    zz: np.ndarray
    zy: np.ndarray
    zzz: np.ndarray
    zzy: np.ndarray


def joined(jets):
    return Jet(*(np.concatenate(parts, axis=1) for parts in zip(*jets, strict=True)))


def analytic_jet(zeta, f):
    """Re(conj(zeta) f), the same of i f, Re(f), Re(i f): jet (n, 4k) of f and its three derivatives (4, n, k)."""
    f = np.concatenate([f, 1j * f], axis=2)
    c, o = zeta.conj()[:, None], np.zeros(f.shape[1:])
    by_phi = Jet((c * f[0]).real, (c * f[1] + f[0].conj()) / 2, c * f[2] / 2, f[1].real, c * f[3] / 2, f[2] / 2)
    return joined([by_phi, Jet(f[0].real, f[1] / 2, f[2] / 2, o, f[3] / 2, o)])


def force_jet(zeta):
    """F = r^2 ln(r) / (8 pi) around each of zeta = z - z_j (n, k); at the force the curvature is -inf."""
    safe = np.where(zeta == 0, 1, zeta)
    log = np.log(np.abs(safe) ** 2)
    c = zeta.conj()
    parts = (
        (zeta * c).real * log,
        c * (log + 1),
        c / safe,
        np.where(zeta == 0, -np.inf, log + 2),
        -c / safe**2,
        1 / safe,
    )
    return Jet(*(part / (16 * np.pi) for part in parts))


def pressure_jet(z):
    """|z|^4 / 64, whose load is 1."""
    z = z[:, None]
    c, r2 = z.conj(), np.abs(z) ** 2
    return Jet(r2**2 / 64, c * r2 / 32, c**2 / 32, r2 / 16, 0 * z, c / 16)


def logarithm_jet(z):
    """ln r^2, x ln r^2, -y ln r^2 and F around a hole's centre."""
    z = z[:, None]
    c, log, o = z.conj(), np.log(np.abs(z) ** 2), np.zeros(z.shape)
    jets = [Jet(log, 1 / z, -1 / z**2, o, 2 / z**3, o), force_jet(z)]
    for a in (1, 1j):
        b = np.conj(a)
        first = (a * log + a + b * c / z) / 2
        second, mixed = (a / z - b * c / z**2) / 2, (b / z).real
        jets.append(Jet((a * z).real * log, first, second, mixed, -a / (2 * z**2) + b * c / z**3, -b / (2 * z**2)))
    return joined(jets)


def times(u, f):
    """Leibniz: derivatives 0 to 3 of the product of u and f, each (4, n)."""
    return np.stack(
        [
            u[0] * f[0],
            u[1] * f[0] + u[0] * f[1],
            u[2] * f[0] + 2 * u[1] * f[1] + u[0] * f[2],
            u[3] * f[0] + 3 * u[2] * f[1] + 3 * u[1] * f[2] + u[0] * f[3],
        ]
    )


def inverse(zeta):
    """1/zeta and its derivatives (4, ...)."""
    return np.stack([1 / zeta, -1 / zeta**2, 2 / zeta**3, -6 / zeta**4])


def powers(u, degree, hessenberg=None):
    """Powers 0 to degree of u (4, n: values and derivatives), orthogonal on the points that made `hessenberg`.

    Returns the functions with their derivatives (4, n, degree + 1) and the Hessenberg matrix.
    """
    new = hessenberg is None
    h = np.zeros((degree + 1, degree), dtype=complex) if new else hessenberg
    q = np.zeros((*u.shape, degree + 1), dtype=complex)
    q[0, :, 0] = 1
    for k in range(degree):
        v = times(u, q[:, :, k])
        for _ in range(2 if new else 1):  # orthogonalised twice
            part = q[0, :, : k + 1].conj().T @ v[0] / u.shape[1] if new else h[: k + 1, k]
            v = v - q[:, :, : k + 1] @ part
            if new:
                h[: k + 1, k] += part
        if new:
            h[k + 1, k] = np.sqrt(np.mean(np.abs(v[0]) ** 2))
        q[:, :, k + 1] = v / h[k + 1, k]
    return q, h
