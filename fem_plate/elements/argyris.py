"""The Argyris triangle: polynomials of degree five, continuous with their gradient.

A triangle's 21 unknowns are value, gradient and second derivatives at each corner and the normal derivative at the
middle of each edge (Argyris, Fried and Scharpf, 1968). Its functions follow from those of one reference triangle by a
21 x 21 matrix that needs no inversion (Dominguez and Sayas, 2008): x = origin + J xi carries values over as they are,
gradients by J^T, second derivatives by J^T H J, and the slope across an edge through the slope along it, which a
quintic's unknowns at the edge's ends determine.
"""

from __future__ import annotations

import numpy as np

from fem_plate.types import FloatArray, IntArray

DEGREE = 5
FUNCTIONS = 21
# Exponents (i, j) of the 21 monomials x^i y^j.
EXPONENTS = np.array([(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)])
# Derivatives by order: [value], [x, y], [xx, xy, yy], [xxx, xxy, xyy, yyy].
DERIVATIVES = [[(order - k, k) for k in range(order + 1)] for order in range(4)]
# The reference triangle, its centroid at the origin; edge k runs from corner k to corner k + 1.
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - 1 / 3
EDGES = ((0, 1), (1, 2), (2, 0))


def monomials(x: FloatArray, y: FloatArray, dx: int = 0, dy: int = 0) -> FloatArray:
    """The derivative d^dx/dx^dx d^dy/dy^dy of every monomial at points of any shape: (..., 21)."""
    return _powers(x, dx)[..., EXPONENTS[:, 0]] * _powers(y, dy)[..., EXPONENTS[:, 1]]


def _powers(x: FloatArray, derivative: int) -> FloatArray:
    """The derivatives of 1, x, ..., x^5: (..., 6)."""
    power = np.zeros((*np.shape(x), DEGREE + 1))
    power[..., derivative] = 1.0
    for k in range(derivative + 1, DEGREE + 1):
        power[..., k] = power[..., k - 1] * x
    factor = np.ones(DEGREE + 1)
    for k in range(derivative):
        factor *= np.arange(DEGREE + 1) - k
    return power * factor


def _reference_coefficients() -> FloatArray:
    """Monomial coefficients (columns) of the reference triangle's functions: (21, 21).

    Its edge unknowns are derivatives along EDGES turned right by 90 degrees.
    """
    rows = [monomials(corner[0], corner[1], *d) for corner in CORNERS for order in range(3) for d in DERIVATIVES[order]]
    for a, b in EDGES:
        along, middle = CORNERS[b] - CORNERS[a], (CORNERS[a] + CORNERS[b]) / 2
        rows.append(along[1] * monomials(middle[0], middle[1], 1, 0) - along[0] * monomials(middle[0], middle[1], 0, 1))
    return np.asarray(np.linalg.inv(np.array(rows)))


REFERENCE = _reference_coefficients()


class Triangles:
    """The geometry of m triangles and their Argyris functions.

    points: (n, 2).  corners: (m, 3), rows of points, counter-clockwise.
    """

    def __init__(self, points: FloatArray, corners: IntArray) -> None:
        self.corners = corners
        self.points = points[corners]  # (m, 3, 2)
        self.centre = self.points.mean(axis=1)
        self.jacobian = np.stack([self.points[:, 1] - self.points[:, 0], self.points[:, 2] - self.points[:, 0]], axis=2)
        self.determinant = np.linalg.det(self.jacobian)
        self.inverse = np.asarray(np.linalg.inv(self.jacobian))  # rows: the gradients of the reference coordinates
        self.normals = self._normals()
        self.transform = self._transform()

    def _normals(self) -> FloatArray:
        """The unit normal along which each edge's unknown counts, (m, 3, 2).

        Both triangles of an edge share it: it points to the right, seen from the lower to the higher point number.
        """
        start, end = np.array(EDGES).T
        along = self.points[:, end] - self.points[:, start]
        along = along * np.where(self.corners[:, start] < self.corners[:, end], 1.0, -1.0)[..., None]
        return np.stack([along[..., 1], -along[..., 0]], axis=-1) / np.linalg.norm(along, axis=-1, keepdims=True)

    def _transform(self) -> FloatArray:
        """The reference unknowns (rows) from the triangle's own (columns): (m, 21, 21)."""
        m, J = len(self.points), self.jacobian
        matrix = np.zeros((m, FUNCTIONS, FUNCTIONS))
        second = np.empty((m, 3, 3))  # J^T H J for H = (xx, xy, yy)
        for row, (p, q) in enumerate(((0, 0), (0, 1), (1, 1))):
            c, d = J[:, :, p], J[:, :, q]
            second[:, row] = np.stack([c[:, 0] * d[:, 0], c[:, 0] * d[:, 1] + c[:, 1] * d[:, 0], c[:, 1] * d[:, 1]], 1)
        for corner in range(3):
            at = 6 * corner
            matrix[:, at, at] = 1.0
            matrix[:, at + 1 : at + 3, at + 1 : at + 3] = J.transpose(0, 2, 1)
            matrix[:, at + 3 : at + 6, at + 3 : at + 6] = second
        for edge, (a, b) in enumerate(EDGES):
            row = 18 + edge
            along = self.points[:, b] - self.points[:, a]
            length = np.sqrt((along**2).sum(axis=1))
            reference = CORNERS[b] - CORNERS[a]
            across = J @ np.array([reference[1], -reference[0]])  # the reference direction, carried over
            matrix[:, row, row] = (across * self.normals[:, edge]).sum(axis=1)
            share = (across * along).sum(axis=1) / length**2  # of the slope along the edge, d/ds for s in [0, 1]
            curved = np.stack([along[:, 0] ** 2, 2 * along[:, 0] * along[:, 1], along[:, 1] ** 2], axis=1) / 32
            for corner, way in ((a, -1.0), (b, 1.0)):
                at = 6 * corner
                matrix[:, row, at] = way * 15 / 8 * share
                matrix[:, row, at + 1 : at + 3] = -7 / 16 * share[:, None] * along
                matrix[:, row, at + 3 : at + 6] = way * share[:, None] * curved
        return matrix

    def reference(self, x: FloatArray, triangle: IntArray) -> FloatArray:
        """Reference coordinates of points x (t, n, 2), n on each of the triangles (t,)."""
        return np.einsum("tij,tnj->tni", self.inverse[triangle], x - self.centre[triangle, None])

    def derivatives(self, x: FloatArray, triangle: IntArray, order: int) -> FloatArray:
        """All derivatives of one order of the 21 functions.

        x: (t, n, 2), n points on each of the triangles (t,).
        Returns (derivatives, t, n, 21) in the order of DERIVATIVES[order].
        """
        u, v = np.moveaxis(self.reference(x, triangle), 2, 0)
        table = np.stack([monomials(u, v, *d) @ REFERENCE for d in DERIVATIVES[order]])
        if order:
            table = np.einsum("tdr,rtnk->dtnk", chain_rule(self.inverse[triangle], order), table, optimize=True)
        return table @ self.transform[triangle]


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
