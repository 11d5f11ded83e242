"""Kirchhoff plates of rigidity 1 by Goursat's representation and least squares on the rim: an independent oracle.

    w = sum_j P_j F(z - z_j) + q |z|^4 / 64 + v,   F = r^2 ln(r) / (8 pi),   v = Re(conj(z) phi(z) + chi(z))

phi and chi are analytic: polynomials and powers of 1/(z - hole), both orthogonalised on the rim (Brubeck, Nakatsukasa &
Trefethen, "Vandermonde with Arnoldi", SIAM Review 2021), simple poles clustered outside every joint of two pieces with
tapered spacing (Brubeck & Trefethen, "Lightning Stokes solver", SIAM J. Sci. Comput. 2022), and for every hole the four
real functions r^2 ln r, x ln r, y ln r, ln r: the only logarithms that leave w single-valued. Lengths should be of
order 1.

Clamped, simply supported and mixed rims, free corners that turn left; at a simply supported or mixed joint with a
singularity as strong as r^(3/2) or r^(4/3) the digits come slowly: watch `residual`.

The rim is a list of loops of pieces that keep the plate on their left: the outer loop first, counterclockwise, then the
holes, clockwise. A plate whose whole rim is free needs balanced loads, and its w is known up to a rigid motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from goursat_basis import Jet, analytic_jet, force_jet, inverse, joined, logarithm_jet, powers, pressure_jet
from goursat_rim import FREE, Rim, joints
from scipy.linalg import lstsq, null_space


class Basis:
    """The functions that v is a sum of, orthogonal on the rim points z (n,) where they can be."""

    def __init__(self, loops, z, degree, poles):
        self.centre = (z.real.max() + z.real.min() + 1j * (z.imag.max() + z.imag.min())) / 2
        self.size = np.abs(z - self.centre).max()
        self.degree = degree
        self.holes = []
        for loop in loops[1:]:
            rim = np.concatenate([piece.at(np.linspace(0, 1, 400, endpoint=False))[0] for piece in loop])
            middle = (rim.real.max() + rim.real.min() + 1j * (rim.imag.max() + rim.imag.min())) / 2
            self.holes.append((middle, np.abs(rim - middle).min()))
        self.hessenberg = [powers(u, degree)[1] for u in self._arguments(z)]
        # Tapered: distances exp(-4 (sqrt(n) - sqrt(k))) of the shorter piece at the joint.
        self.distances = np.exp(-4 * (np.sqrt(poles) - np.sqrt(np.arange(1, poles + 1))))
        self.joints = [j for i, loop in enumerate(loops) for j in joints(loop, 0.5 if i else 1.0)]

    def _arguments(self, z):
        """(z - centre) / size, and size / (z - centre) for each hole, with derivatives (4, n)."""
        one = np.ones(z.shape, dtype=complex)
        yield np.stack([(z - self.centre) / self.size, one / self.size, 0 * one, 0 * one])
        for centre, size in self.holes:
            yield size * inverse(z - centre)

    def jet(self, z):
        jets = []
        centres = [self.centre, *(centre for centre, _ in self.holes)]
        for c, u, h in zip(centres, self._arguments(z), self.hessenberg, strict=True):
            jets.append(analytic_jet(z - c, powers(u, self.degree, h)[0]))
        jets += [logarithm_jet(z - c) for c in centres[1:]]
        for corner, outward, length in self.joints:
            d = length * self.distances
            jets.append(analytic_jet(z - corner, d * inverse((z - corner)[:, None] - outward * d)))
        return joined(jets)


@dataclass(frozen=True)
class Solution:
    """A deflected plate: deflection times rigidity under the given loads, and the largest boundary residual."""

    basis: Basis
    coefficients: np.ndarray  # (k,)
    points: np.ndarray  # (N,) complex, where the forces act
    forces: np.ndarray  # (N,)
    pressure: float
    rigid: np.ndarray  # (3,) of 1, x, y
    residual: float  # of w and, made lengths by half the plate's width, of slope, moment and shear

    def evaluate(self, xy):
        """w (n,), gradient (n, 2) and Hessian (n, 2, 2) at xy (n, 2); the Hessian is -inf or nan at a force."""
        xy = np.asarray(xy, dtype=float)
        z = xy @ [1, 1j]
        acting = self.forces != 0
        jets = self.basis.jet(z), loads(z, self.points[acting])
        strengths = self.coefficients, np.append(self.forces[acting], self.pressure)
        w, slope, zz, zy = (sum(j[i] @ s for j, s in zip(jets, strengths, strict=True)) for i in range(4))
        gradient = 2 * np.stack([slope.real, -slope.imag], axis=1) + self.rigid[1:]
        hessian = 2 * np.stack([zz.real + zy.real, -zz.imag, -zz.imag, zy.real - zz.real], axis=1)
        return w.real + self.rigid[0] + xy @ self.rigid[1:], gradient, hessian.reshape(-1, 2, 2)


def loads(z, points):
    """Jet of the singular part of each force, then of the pressure: (n, N + 1)."""
    return joined([force_jet(z[:, None] - points), pressure_jet(z)])


def solve(loops, points=(), forces=(), pressure=0.0, nu=0.3, degree=30, poles=30):
    """The plate under forces (N,) at points (N, 2) and a uniform pressure.

    degree: of phi and chi.  poles: at each joint.  Double both and compare: the change is the error.
    """
    return _solve(loops, points, np.append(forces, pressure)[:, None], nu, degree, poles)[0]


def influence(loops, points, nu=0.3, degree=30, poles=30):
    """For each of the points (N, 2) the plate that is raised by 1 there and held at 0 at the other points."""
    xy = np.asarray(points, dtype=float)
    rigid = np.column_stack([np.ones(len(xy)), xy])
    free = all(piece.support == FREE for loop in loops for piece in loop)
    balanced = null_space(rigid.T) if free else np.eye(len(xy))
    loaded = _solve(loops, xy, np.vstack([balanced, np.zeros(balanced.shape[1])]), nu, degree, poles)
    heights = [s.evaluate(xy)[0] for s in loaded] + (list(rigid.T) if free else [])
    share = np.linalg.solve(np.stack(heights, axis=1), np.eye(len(xy)))
    modes, k = share[len(loaded) :] if free else np.zeros((3, len(xy))), len(loaded)

    def mixed(name, i):
        return sum(getattr(s, name) * c for s, c in zip(loaded, share[:k, i], strict=True))

    residual = [sum(s.residual * abs(c) for s, c in zip(loaded, share[:k, i], strict=True)) for i in range(len(xy))]
    return [
        Solution(loaded[0].basis, mixed("coefficients", i), loaded[0].points, mixed("forces", i), 0.0, modes[:, i], r)
        for i, r in enumerate(residual)
    ]


def _solve(loops, points, strengths, nu, degree, poles):
    points = np.reshape(points, (-1, 2)).astype(float) @ [1, 1j]
    depth = 4 * (np.sqrt(poles) - 1) + 3
    rim, fine = (Rim(loops, nu, f * (8 * degree + 5 * poles) + f, depth) for f in (1, 2))
    basis = Basis(loops, rim.z, degree, poles)
    matrix, right = rim.rows(basis.jet(rim.z)), -rim.rows(loads(rim.z, points)) @ strengths
    # Columns that are 0 but for rounding (phi = i z is one) must not be blown up; columns may depend on each other.
    scale = np.maximum(np.linalg.norm(matrix, axis=0), 1e-2)
    found = lstsq(matrix / scale, right, cond=1e-14, lapack_driver="gelsy")[0] / scale[:, None]
    left = fine.rows(Jet(*(part @ found for part in basis.jet(fine.z)))) + fine.rows(loads(fine.z, points)) @ strengths
    return [
        Solution(basis, c, points, s[:-1], s[-1], np.zeros(3), float(np.abs(r).max()))
        for c, s, r in zip(found.T, strengths.T, left.T, strict=True)
    ]
