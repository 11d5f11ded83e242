"""The Argyris triangle: polynomials of degree five or more, continuous with their gradient.

A triangle's 21 unknowns of degree five are value, gradient and second derivatives at each corner and the normal
derivative at the middle of each edge (Argyris, Fried and Scharpf, 1968). Each degree more adds a value and a slope to
each edge, and what no other triangle has; of a quintic these are 0. The functions follow from those of one reference
triangle by a matrix that needs no inversion (Dominguez and Sayas, 2008): x = origin + J xi carries values over as they
are, gradients by J^T, second derivatives by J^T H J, and the slope across an edge through the slope along it, which the
unknowns of the edge determine.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import factorial

import numpy as np

from fem_plate.elements.rim import DEGREE, unit_gauss
from fem_plate.types import FloatArray, IntArray

# Derivatives by order: [value], [x, y], [xx, xy, yy], [xxx, xxy, xyy, yyy].
DERIVATIVES = [[(order - k, k) for k in range(order + 1)] for order in range(4)]
# The reference triangle, its centroid at the origin; edge k runs from corner k to corner k + 1.
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - 1 / 3
EDGES = ((0, 1), (1, 2), (2, 0))
CORNER = 6  # unknowns of a corner


@lru_cache
def exponents(degree: int) -> IntArray:
    """Those of the three barycentric coordinates in each of Bernstein's polynomials of a degree, (n, 3)."""
    return np.array([(degree - j - k, j, k) for j in range(degree + 1) for k in range(degree + 1 - j)])


def polynomials(x: FloatArray, y: FloatArray, dx: int = 0, dy: int = 0, degree: int = DEGREE) -> FloatArray:
    """The derivative d^dx/dx^dx d^dy/dy^dy of Bernstein's polynomials at points of any shape: (..., n).

    On the reference triangle these are positive and sum up to 1, so that their sums keep their digits.
    """
    powers = exponents(degree)
    table = np.array([factorial(degree) / np.prod([factorial(k) for k in row]) for row in powers.tolist()])
    for coordinate, power in zip((1 / 3 - x - y, x + 1 / 3, y + 1 / 3), powers.T, strict=True):
        own = np.ones((*np.shape(x), degree + 1))
        own[..., 1:] = np.asarray(coordinate)[..., None]
        table = table * np.multiply.accumulate(own, axis=-1)[..., power]
    along_x, along_y = _from_lower(degree)[1]
    for _ in range(dx):
        table = table @ along_x
    for _ in range(dy):
        table = table @ along_y
    return table


@lru_cache
def _from_lower(degree: int) -> tuple[FloatArray, FloatArray]:
    """Bernstein's polynomials of the degree below as sums of those of a degree, (n, lower), and the latter's slopes.

    These are along x and y, of each polynomial (columns) as sums of them all, (2, n, n).
    """
    row = {tuple(power): k for k, power in enumerate(exponents(degree).tolist())}
    lower = exponents(degree - 1)
    raised, lowered = np.zeros((len(row), len(lower))), np.zeros((3, len(lower), len(row)))
    for column, power in enumerate(lower):
        for k, unit in enumerate(np.eye(3, dtype=np.int64)):
            above = row[tuple((power + unit).tolist())]
            raised[above, column], lowered[k, column, above] = (power[k] + 1) / degree, degree
    return raised, raised @ (lowered[1:] - lowered[0])


class Reference:
    """The functions of one degree on the reference triangle: those of degree five, and more that add to them.

    An edge has p - 5 unknowns of its values, their products with Legendre's polynomials of degree 6 to p; the slope at
    its middle; and p - 5 more of its slopes, their products with those of degree 5 to p - 1.
    """

    def __init__(self, degree: int) -> None:
        self.degree, self.count = degree, len(exponents(degree))
        self.more = degree - DEGREE  # unknowns of an edge's values
        self.on_edge = 2 * self.more + 1
        self.own = self.count - 3 * (CORNER + self.on_edge)  # unknowns that no other triangle has
        # What an edge that is seen from its other end multiplies its unknowns by.
        self.turned = (-1.0) ** np.array([*range(DEGREE + 1, degree + 1), 0, *range(DEGREE, degree)])
        s, weights = unit_gauss(degree + 1)
        moments = weights[:, None] * np.polynomial.legendre.legvander(2 * s - 1, degree)
        self._s = np.append(s, 0.5)
        self._of_values = np.pad(moments[:, DEGREE + 1 :].T, ((0, 0), (0, 1)))
        self._of_slopes = np.pad(moments[:, DEGREE:degree].T, ((1, 0), (0, 1)))
        self._of_slopes[0, -1] = 1.0
        quintics = np.eye(21)
        for k in range(DEGREE + 1, degree + 1):
            quintics = _from_lower(k)[0] @ quintics
        orders = [d for order in DERIVATIVES[:3] for d in order]
        rows = [polynomials(x, y, dx, dy, degree)[None] for x, y in CORNERS for dx, dy in orders]
        for a, b in EDGES:
            along = CORNERS[b] - CORNERS[a]
            points = CORNERS[a] + self._s[:, None] * along
            u, v = points.T
            value, x, y = (polynomials(u, v, dx, dy, degree) for dx, dy in orders[:3])
            rows += [self._of_values @ value, self._of_slopes @ (along[1] * x - along[0] * y)]  # turned right
        # Inside, what quintics leave of the coefficients of what vanishes with its gradient on all edges.
        rest = np.eye(self.count) - quintics @ np.linalg.pinv(quintics)
        rows.append(rest[exponents(degree).min(axis=1) >= 2])
        self.functions = np.linalg.inv(np.concatenate(rows))  # columns of coefficients
        if self.more:
            of_quintics = [*range(3 * CORNER), *(3 * CORNER + self.more + self.on_edge * np.arange(3))]
            self.functions[:, of_quintics] = quintics @ reference(DEGREE).functions  # to rounding
        along_x, along_y = _from_lower(degree)[1]
        power = np.linalg.matrix_power
        self._tables = [
            np.concatenate([power(along_x, dx) @ power(along_y, dy) @ self.functions for dx, dy in order], axis=1)
            for order in DERIVATIVES
        ]

    def derivatives(self, x: FloatArray, y: FloatArray, order: int) -> FloatArray:
        """All derivatives of one order at points of any shape, (..., derivatives, n)."""
        table = polynomials(x, y, degree=self.degree) @ self._tables[order]
        return np.asarray(table.reshape(*np.shape(x), order + 1, self.count))

    @cached_property
    def along(self) -> FloatArray:
        """The unknowns of an edge's slopes from those of its values, for the slope along it: (more + 1, 6 + more).

        These are value, slope and second derivative along the edge at its start and its end, and those between.
        """
        points = CORNERS[0] + self._s[:, None] * (CORNERS[1] - CORNERS[0])
        own = [0, 1, 3, 6, 7, 9, *range(3 * CORNER, 3 * CORNER + self.more)]
        return np.asarray(self._of_slopes @ self.derivatives(points[:, 0], points[:, 1], 1)[:, 0, own])


reference = lru_cache(Reference)


class Triangles:
    """The geometry of m triangles and their Argyris functions, n of each.

    points: (n, 2).  corners: (m, 3), rows of points, counter-clockwise.
    """

    def __init__(self, points: FloatArray, corners: IntArray, degree: int = DEGREE) -> None:
        self.functions = reference(degree)
        self.corners = corners
        self.points = points[corners]  # (m, 3, 2)
        self.centre = self.points.mean(axis=1)
        self.jacobian = np.stack([self.points[:, 1] - self.points[:, 0], self.points[:, 2] - self.points[:, 0]], axis=2)
        self.determinant = np.linalg.det(self.jacobian)
        self.inverse = np.asarray(np.linalg.inv(self.jacobian))  # rows: the gradients of the reference coordinates
        start, end = np.array(EDGES).T
        # An edge's unknowns count from its lower to its higher point number, for both of its triangles.
        self._forward = corners[:, start] < corners[:, end]
        self.normals = self._normals()
        self.transform = self._transform()

    def _normals(self) -> FloatArray:
        """The unit normal along which each edge's slopes count, (m, 3, 2), to the right of the way they count."""
        start, end = np.array(EDGES).T
        along = self.points[:, end] - self.points[:, start]
        along = along * np.where(self._forward, 1.0, -1.0)[..., None]
        return np.stack([along[..., 1], -along[..., 0]], axis=-1) / np.linalg.norm(along, axis=-1, keepdims=True)

    def _transform(self) -> FloatArray:
        """The reference unknowns (rows) from the triangle's own (columns): (m, n, n)."""
        m, J, functions = len(self.points), self.jacobian, self.functions
        matrix = np.zeros((m, functions.count, functions.count))
        second = np.empty((m, 3, 3))  # J^T H J for H = (xx, xy, yy)
        for row, (p, q) in enumerate(((0, 0), (0, 1), (1, 1))):
            c, d = J[:, :, p], J[:, :, q]
            second[:, row] = np.stack([c[:, 0] * d[:, 0], c[:, 0] * d[:, 1] + c[:, 1] * d[:, 0], c[:, 1] * d[:, 1]], 1)
        for corner in range(3):
            at = CORNER * corner
            matrix[:, at, at] = 1.0
            matrix[:, at + 1 : at + 3, at + 1 : at + 3] = J.transpose(0, 2, 1)
            matrix[:, at + 3 : at + 6, at + 3 : at + 6] = second
        own = np.arange(functions.count - functions.own, functions.count)
        matrix[:, own, own] = 1.0
        for edge, (a, b) in enumerate(EDGES):
            first = 3 * CORNER + edge * functions.on_edge
            values, slopes = np.split(np.arange(first, first + functions.on_edge), [functions.more])
            turned = np.where(self._forward[:, edge, None], 1.0, functions.turned)
            along = self.points[:, b] - self.points[:, a]
            reference_along = CORNERS[b] - CORNERS[a]
            across = J @ np.array([reference_along[1], -reference_along[0]])  # the reference direction, carried over
            # Of the slope along the edge, d/ds for s in [0, 1].
            share = ((across * along).sum(axis=1) / (along**2).sum(axis=1))[:, None, None] * functions.along
            curved = np.stack([along[:, 0] ** 2, 2 * along[:, 0] * along[:, 1], along[:, 1] ** 2], axis=1)
            for corner, of_end in ((a, share[..., :3]), (b, share[..., 3:6])):
                at = CORNER * corner
                matrix[:, slopes, at] = of_end[..., 0]
                matrix[:, slopes, at + 1 : at + 3] = of_end[..., 1, None] * along[:, None]
                matrix[:, slopes, at + 3 : at + 6] = of_end[..., 2, None] * curved[:, None]
            matrix[:, values, values] = turned[:, : functions.more]
            matrix[:, slopes[:, None], values] = share[..., 6:] * turned[:, None, : functions.more]
            normal = (across * self.normals[:, edge]).sum(axis=1)
            matrix[:, slopes, slopes] = normal[:, None] * turned[:, functions.more :]
        return matrix

    @cached_property
    def linear(self) -> FloatArray:
        """The unknowns of 1, x and y, (m, n, 3)."""
        functions = self.functions
        found = np.zeros((len(self.points), functions.count, 3))
        found[:, : 3 * CORNER : CORNER, 0], found[:, : 3 * CORNER : CORNER, 1:] = 1.0, self.points
        found[:, 1 : 3 * CORNER : CORNER, 1] = found[:, 2 : 3 * CORNER : CORNER, 2] = 1.0
        middles = 3 * CORNER + functions.more + functions.on_edge * np.arange(3)
        found[:, middles, 1:] = self.normals
        return found

    def reference(self, x: FloatArray, triangle: IntArray) -> FloatArray:
        """Reference coordinates of points x (t, n, 2), n on each of the triangles (t,)."""
        return np.einsum("tij,tnj->tni", self.inverse[triangle], x - self.centre[triangle, None])

    def derivatives(self, x: FloatArray, triangle: IntArray, order: int) -> FloatArray:
        """All derivatives of one order of the triangles' functions.

        x: (t, n, 2), n points on each of the triangles (t,).
        Returns (derivatives, t, n, functions) in the order of DERIVATIVES[order].
        """
        return self.of_reference(x, triangle, order) @ self.transform[triangle]

    def of_reference(self, x: FloatArray, triangle: IntArray, order: int) -> FloatArray:
        """The same derivatives of the reference triangle's functions; times `transform` they are `derivatives`."""
        u, v = np.moveaxis(self.reference(x, triangle), 2, 0)
        table = self.functions.derivatives(u, v, order)
        if not order:
            return table[None, :, :, 0]
        return np.asarray(np.einsum("tdr,tnrk->dtnk", chain_rule(self.inverse[triangle], order), table, optimize=True))


def chain_rule(inverse: FloatArray, order: int) -> FloatArray:
    """Derivatives in x (rows) from those in the reference coordinates (columns): (t, order + 1, order + 1).

    inverse: (t, 2, 2), d xi / d x.
    """
    chain = np.zeros((len(inverse), order + 1, order + 1))
    for row, (dx, dy) in enumerate(DERIVATIVES[order]):
        # (xi_x d_xi + eta_x d_eta)^dx (xi_y d_xi + eta_y d_eta)^dy, multiplied out in powers of d_eta.
        product = np.zeros((len(inverse), order + 1))
        product[:, 0] = 1.0
        for axis in [0] * dx + [1] * dy:
            shifted = np.roll(product, 1, axis=1)
            shifted[:, 0] = 0.0
            product = product * inverse[:, 0, axis, None] + shifted * inverse[:, 1, axis, None]
        chain[:, row] = product
    return chain
