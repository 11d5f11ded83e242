"""The rim of a Kirchhoff plate: its pieces, its joints, and the conditions that `goursat` meets there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import expit

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"
# Of w, slopes along and across, moment, shear. The slope along follows from w, and makes w small next to a corner.
CONDITIONS = {CLAMPED: (0, 1, 2), SIMPLY_SUPPORTED: (0, 1, 3), FREE: (3, 4)}


@dataclass(frozen=True)
class Piece:
    """A straight segment from `start` to `end`, both complex, under one support."""

    start: complex
    end: complex
    support: str = CLAMPED

    def at(self, t):
        """Point, first and second derivative by t, each (n,) complex, at t (n,) from 0 to 1."""
        step = self.end - self.start
        return self.start + step * t, np.full(t.shape, step), np.zeros(t.shape, dtype=complex)


@dataclass(frozen=True)
class Arc:
    """centre + a cos(s) + i b sin(s), s from first to last [rad]: an arc of an axis-parallel ellipse, or all of it."""

    centre: complex
    semi_axes: tuple[float, float]
    support: str = CLAMPED
    first: float = 0.0
    last: float = 2 * np.pi

    def at(self, t):
        (a, b), turn = self.semi_axes, self.last - self.first
        s = self.first + turn * t
        bent = a * np.cos(s) + 1j * b * np.sin(s)
        return self.centre + bent, turn * (-a * np.sin(s) + 1j * b * np.cos(s)), -(turn**2) * bent


def polygon(corners, supports=CLAMPED):
    """Loop of segments through the corners (n,) complex; the i-th support belongs to the side after the i-th corner."""
    supports = [supports] * len(corners) if isinstance(supports, str) else supports
    return [Piece(c, d, s) for c, d, s in zip(corners, [*corners[1:], corners[0]], supports, strict=True)]


def joints(loop, scale=1.0):
    """Corner, unit vector outwards along the bisector and length of the poles' row, at each joint of the loop."""
    ends, found = np.array([0.0, 1.0]), []
    for before, after in zip([loop[-1], *loop[:-1]], loop, strict=True):
        if before is after:
            continue  # one closed smooth piece
        (a, d, _), (c, e, _) = before.at(ends), after.at(ends)
        outward = -1j * (d[1] / abs(d[1]) + e[0] / abs(e[0]))
        reach = min(abs(a[1] - a[0]), abs(c[1] - c[0]))
        found.append((c[0], outward / abs(outward), scale * reach))
    return found


class Rim:
    """Points of the rim and the conditions there, as rows that are made from any jet.

    count: points on a piece.  depth: the points next to a joint are exp(-depth) of the piece away from it.
    """

    def __init__(self, loops, nu, count, depth):
        self.nu, self.twists, self.slopes = nu, [], []
        rows, u, ends = [], np.linspace(-depth, depth, count), np.array([0.0, 1.0])
        for loop in loops:
            first = count * len(rows)
            for i, piece in enumerate(loop):
                smooth = len(loop) == 1
                z, d, dd = piece.at(np.arange(count) / count if smooth else expit(u))
                applies = np.tile(np.isin(range(5), CONDITIONS[piece.support])[:, None], count)
                curvature = (d.conj() * dd).imag / np.abs(d) ** 3
                free = [FREE == piece.support == loop[j % len(loop)].support for j in (i - 1, i + 1)]
                near = 1.0 if smooth else 4 * expit(u) * expit(-u)
                bent = (1.0 if smooth or free[0] else expit(u)) * (1.0 if smooth or free[1] else expit(-u))
                rows.append((z, -1j * d / np.abs(d), curvature, near + 0 * u, bent + 0 * u, applies.T))
                if not smooth:
                    start, end = first + i * count, first + ((i - 1) % len(loop) + 1) * count - 1
                    turn = np.angle(d[0] / loop[i - 1].at(ends)[1][1])
                    self._joint((loop[i - 1].support, piece.support), turn, start, end, count)
        z, normal, curvature, near, bent, applies = map(np.concatenate, zip(*rows, strict=True))
        self.z, self.applies, self.size = z, applies.T, np.ptp(z.real) / 2
        self.normal, self.curvature, self.near, self.bent = (a[:, None] for a in (normal, curvature, near, bent))

    def _joint(self, supports, turn, start, end, count):
        """What holds at the joint itself: no concentrated shear on a free corner, and a continuous slope.

        Without the second, the conditions also admit solutions of infinite energy.
        """
        if supports == (FREE, FREE):
            if turn < -0.1:
                raise ValueError(f"Input loops of Rim must turn left at a free corner; got a turn by {turn} rad")
            self.twists.append((start, end))
        held = CLAMPED in supports or (FREE not in supports and abs(turn) > 0.1)  # the slope is 0 there
        self.slopes.append((start, None if held else start + 1 + count // 50))

    def rows(self, jet):
        """What must vanish of a jet on `self.z`, (m, k): w, slopes along and across, moment, shear, then the joints.

        Next to a joint moment and shear may grow without bound: they are weighed down by the distance and its square,
        the weights that keep every row's influence on w alike; next to a free corner by 1 and the distance.
        """
        n, nu, size = self.normal, self.nu, self.size
        slope, bend, mean = 2 * jet.z * n, 2 * (jet.zz * n**2).real, 2 * jet.zy.real
        twist = 2 * (jet.zzy * n - jet.zzz * n**3).real - 2 * self.curvature * bend
        moment, shear = (1 - nu) * bend + (1 + nu) * mean, 8 * (jet.zzy * n).real + (1 - nu) * twist
        values = (
            jet.w.real,
            -slope.imag * size,
            slope.real * size,
            moment * size**2 * self.bent,
            shear * size**3 * self.bent * self.near,
        )
        found = [value[applies] for value, applies in zip(values, self.applies, strict=True)]
        corner = -2 * (jet.zz * n**2).imag * size**2
        found += [corner[[i]] - corner[[j]] for i, j in self.twists]
        for i, j in self.slopes:
            step = (jet.z[[i]] - (0 if j is None else jet.z[[j]])) * size
            found += [step.real, step.imag]
        if not self.applies[0].any():  # a free plate: it rests on the tangent plane of the first point
            found += [jet.w[:1].real, jet.z[:1].real * size, jet.z[:1].imag * size]
        return np.concatenate(found)
