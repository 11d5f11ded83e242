"""The true curves of plate rims: a mesh has only their chords, but integrals and parts need the curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.nearest import nearest_on_edges, nearest_on_ellipse, nearest_parameter, on_edges, powers
from meshes.types import FloatArray


@dataclass(frozen=True)
class Circle:
    """A circular boundary.

    Parameters
    ----------
    radius : float
        [m].
    centre : tuple of float
        [m].
    """

    radius: float
    centre: tuple[float, float] = (0.0, 0.0)

    def gap(self, xy: ArrayLike) -> FloatArray:
        """Distance [m] of points (..., 2) from the circle, positive inside."""
        offset = np.asarray(xy, dtype=float) - np.asarray(self.centre)
        return np.asarray(self.radius - np.hypot(offset[..., 0], offset[..., 1]))

    def project(self, xy: ArrayLike) -> FloatArray:
        """The nearest points of the circle to points (..., 2) [m]; for its centre, one of them."""
        offset = np.asarray(xy, dtype=float) - np.asarray(self.centre)
        offset = np.where((offset == 0).all(axis=-1, keepdims=True), (1.0, 0.0), offset)
        distance = np.hypot(offset[..., 0], offset[..., 1])[..., None]
        return np.asarray(self.centre) + self.radius * offset / distance

    def arc(self, start: FloatArray, end: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The shorter arcs between points on the circle.

        Parameters
        ----------
        start, end : (k, 2) array
            [m].
        s : (n,) array
            Parameters, from 0 at the start to 1 at the end, linear in the angle.

        Returns
        -------
        points, tangents : (k, n, 2) array
            Points on the arcs [m] and their derivatives with respect to s.
        """
        return _elliptic_arc((self.radius, self.radius), np.asarray(self.centre), start, end, s)


@dataclass(frozen=True)
class Ellipse:
    """An elliptic boundary around the origin.

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        [m].
    """

    semi_axis_x: float
    semi_axis_y: float

    def gap(self, xy: ArrayLike) -> FloatArray:
        """Distance [m] of points (..., 2) from the ellipse, positive inside."""
        xy = np.asarray(xy, dtype=float)
        distance = np.linalg.norm(self.project(xy) - xy, axis=-1)
        return np.copysign(distance, 1 - np.hypot(xy[..., 0] / self.semi_axis_x, xy[..., 1] / self.semi_axis_y))

    def project(self, xy: ArrayLike) -> FloatArray:
        """The nearest points of the ellipse to points (..., 2) [m]; of several equally near ones, one."""
        xy = np.asarray(xy, dtype=float)
        return nearest_on_ellipse(xy.reshape(-1, 2), (self.semi_axis_x, self.semi_axis_y)).reshape(xy.shape)

    def arc(self, start: FloatArray, end: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The shorter arcs between points on the ellipse.

        Parameters
        ----------
        start, end : (k, 2) array
            [m].
        s : (n,) array
            Parameters, from 0 at the start to 1 at the end, linear in the eccentric angle.

        Returns
        -------
        points, tangents : (k, n, 2) array
            Points on the arcs [m] and their derivatives with respect to s.
        """
        return _elliptic_arc((self.semi_axis_x, self.semi_axis_y), np.zeros(2), start, end, s)


@dataclass(frozen=True, eq=False)
class Parabolas:
    """Quadratic edges, as in second-order meshes.

    Parameters
    ----------
    pieces : (k, 3, 2) array
        Start, middle and end of each edge, its points at parameters 0, 1/2 and 1 [m].
    """

    pieces: FloatArray

    def project(self, xy: ArrayLike) -> FloatArray:
        """The nearest points of the edges to points (..., 2) [m]; of several equally near ones, one."""
        xy = np.asarray(xy, dtype=float)
        return nearest_on_edges(xy.reshape(-1, 2), self.pieces)[0].reshape(xy.shape)

    def arc(self, start: FloatArray, end: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The arcs between points on the same edge.

        Parameters
        ----------
        start, end : (k, 2) array
            [m].
        s : (n,) array
            Parameters, from 0 at the start to 1 at the end, linear in the edge's parameter.

        Returns
        -------
        points, tangents : (k, n, 2) array
            Points on the arcs [m] and their derivatives with respect to s.
        """
        pieces = self.pieces[nearest_on_edges((start + end) / 2, self.pieces)[1]]
        first, last = nearest_parameter(start, pieces), nearest_parameter(end, pieces)
        t = first[:, None] + (last - first)[:, None] * s
        _, slope, bend = powers(pieces)
        derivative = slope[:, None] + 2 * t[..., None] * bend[:, None]
        return on_edges(pieces, t), (last - first)[:, None, None] * derivative


Curve = Circle | Ellipse | Parabolas


def _elliptic_arc(
    axes: tuple[float, float], centre: FloatArray, start: FloatArray, end: FloatArray, s: FloatArray
) -> tuple[FloatArray, FloatArray]:
    # y / b over x / a, scaled so that a circle's angles get no extra rounding.
    first, last = (np.arctan2(p[:, 1] * (axes[0] / axes[1]), p[:, 0]) for p in (start - centre, end - centre))
    sweep = (last - first + np.pi) % (2 * np.pi) - np.pi
    angle = first[:, None] + sweep[:, None] * s
    radial = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    tangent = np.stack([-radial[..., 1], radial[..., 0]], axis=-1)
    return centre + np.asarray(axes) * radial, np.asarray(axes) * sweep[:, None, None] * tangent
