"""The Argyris triangle: polynomials of degree five, continuous with their gradient.

A triangle's 21 unknowns are value, gradient and second derivatives at each corner and the normal derivative at the
middle of each edge (Argyris, Fried and Scharpf, 1968). The basis is found for all triangles at once, by inverting one
21 x 21 matrix each on monomials centred on the triangle and scaled by its size, which keeps that inversion harmless.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import DiscreteField, MeshTri
from skfem.element import Element
from skfem.refdom import RefTri

FloatArray = NDArray[np.float64]

DEGREE = 5
# Exponents (i, j) of the 21 monomials x^i y^j.
EXPONENTS = np.array([(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)])
# Derivatives by order: [value], [x, y], [xx, xy, yy], [xxx, xxy, xyy, yyy].
DERIVATIVES = [[(order - k, k) for k in range(order + 1)] for order in range(4)]


def monomials(x: FloatArray, y: FloatArray, dx: int = 0, dy: int = 0) -> FloatArray:
    """The derivative d^dx/dx^dx d^dy/dy^dy of every monomial at points of any shape: (..., 21)."""
    return _powers(x, dx)[..., EXPONENTS[:, 0]] * _powers(y, dy)[..., EXPONENTS[:, 1]]


def _powers(x: FloatArray, derivative: int) -> FloatArray:
    """The derivatives of 1, x, ..., x^5: (..., 6)."""
    power = np.arange(DEGREE + 1)
    factor = np.prod([np.maximum(power - k, 0) for k in range(derivative)], axis=0) if derivative else 1.0
    return np.asarray(factor * np.asarray(x)[..., None] ** np.maximum(power - derivative, 0))


class ArgyrisBasis:
    """The basis polynomials of all triangles of one mesh.

    coefficients: (m, 21, 21); [t, :, k] are the monomial coefficients of basis function k on triangle t, in the
    coordinates (x - centre[t]) / size[t].
    """

    def __init__(self, mesh: MeshTri) -> None:
        corners = mesh.p[:, mesh.t].transpose(2, 1, 0)  # (m, 3, 2)
        self.centre = corners.mean(axis=1)
        self.size = np.sqrt(((corners - self.centre[:, None]) ** 2).sum(axis=2).max(axis=1))
        self.coefficients = np.linalg.inv(self._unknowns(mesh, corners))

    def _unknowns(self, mesh: MeshTri, corners: FloatArray) -> FloatArray:
        """The unknowns (rows) of the monomials (columns): (m, 21, 21)."""
        local = (corners - self.centre[:, None]) / self.size[:, None, None]
        rows = []
        for corner in range(3):
            x, y = local[:, corner].T
            for order in range(3):
                rows += [monomials(x, y, *d) / self.size[:, None] ** order for d in DERIVATIVES[order]]
        edges = mesh.p[:, mesh.facets[:, mesh.t2f]].transpose(3, 2, 1, 0)  # (m, 3 edges, 2 ends, 2)
        # An edge's ends come sorted by number, so both its triangles see the same normal.
        along = edges[:, :, 1] - edges[:, :, 0]
        normal = np.stack([along[..., 1], -along[..., 0]], axis=-1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        middle = (edges.mean(axis=2) - self.centre[:, None]) / self.size[:, None, None]
        for edge in range(3):
            x, y = middle[:, edge].T
            slope = normal[:, edge, :1] * monomials(x, y, 1, 0) + normal[:, edge, 1:] * monomials(x, y, 0, 1)
            rows.append(slope / self.size[:, None])
        return np.stack(rows, axis=1)

    def evaluate(self, x: FloatArray, triangle: NDArray[np.int64], order: int) -> FloatArray:
        """All derivatives of one order of the 21 basis functions.

        x: (t, n, 2) points, n on each of the triangles (t,).  Returns (derivatives, t, n, 21) in the sequence of
        DERIVATIVES[order].
        """
        size = self.size[triangle, None]
        u, v = ((x - self.centre[triangle, None]) / size[..., None]).transpose(2, 0, 1)
        coefficients = self.coefficients[triangle]
        return np.stack([monomials(u, v, *d) @ coefficients for d in DERIVATIVES[order]]) / size[..., None] ** order


class ElementArgyris(Element):
    """The Argyris triangle for scikit-fem, bound to one mesh; `derivatives` says how many orders forms may use.

    All 21 functions are evaluated together on the first request and kept for the following twenty.
    """

    nodal_dofs = 6
    facet_dofs = 1
    maxdeg = DEGREE
    dofnames = ["u", "u_x", "u_y", "u_xx", "u_xy", "u_yy", "u_n"]  # noqa: RUF012
    refdom = RefTri

    def __init__(self, basis: ArgyrisBasis, derivatives: int = 2) -> None:
        self.polynomials = basis
        self.derivatives = derivatives
        self._points: FloatArray | None = None
        self._tables: list[FloatArray] = []

    def gbasis(self, mapping: Any, X: FloatArray, i: int, tind: Any = None) -> tuple[DiscreteField, ...]:
        """Basis function `i` at the reference points X, as scikit-fem asks for it."""
        if i == 0 or self._points is not X:
            triangle = np.arange(len(self.polynomials.size)) if tind is None else np.asarray(tind)
            x = mapping.F(X, tind=tind).transpose(1, 2, 0)
            self._tables = [self.polynomials.evaluate(x, triangle, k) for k in range(self.derivatives + 1)]
            self._points = X
        value, grad, *higher = [table[..., i] for table in self._tables]
        fields: dict[str, FloatArray] = {}
        if higher:
            xx, xy, yy = higher[0]
            fields["hess"] = np.array([[xx, xy], [xy, yy]])
        if len(higher) > 1:
            xxx, xxy, xyy, yyy = higher[1]
            fields["grad3"] = np.array([[[xxx, xxy], [xxy, xyy]], [[xxy, xyy], [xyy, yyy]]])
        return (DiscreteField(value=value[0], grad=grad, **fields),)
