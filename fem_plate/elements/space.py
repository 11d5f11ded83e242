"""The discrete plate: Argyris functions on a mesh, its matrices up to the true rim, and evaluation at points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix
from scipy.spatial import cKDTree

from fem_plate.elements import forms
from fem_plate.elements.argyris import Triangles
from fem_plate.elements.assembly import sum_up
from fem_plate.elements.corners import Copies, continuity, split
from fem_plate.elements.relative import Relative, relative
from fem_plate.elements.rim import rim_of
from meshes import PlateMesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

CHUNK = 100_000  # points times functions evaluated at once, to bound memory
QUADRATURE = 6  # points a side of a triangle, where integrands are not polynomials
BEYOND = 0.1  # of a triangle: points this far beyond the mesh still count as on it, as between chord and rim
# Triangles searched for a point, first few and then more, while it lies further beyond the nearest than this.
NEAREST = ((12, 1e-9), (200, 0.02), (2000, np.inf))


class PlateSpace:
    """Argyris functions on a mesh whose lengths are divided by the plate's size.

    supports: that of every boundary.  free_corners: rows of mesh points where second derivatives may jump.
    """

    def __init__(self, mesh: PlateMesh, supports: Mapping[str, str], free_corners: Sequence[int] = ()) -> None:
        self.triangles = Triangles(mesh.points / mesh.size, mesh.triangles)
        self.middle = (mesh.points.min(axis=0) + mesh.points.max(axis=0)) / 2 / mesh.size
        self.rim, self.slivers = rim_of(mesh, supports)
        corners, copies = split(mesh.triangles, list(free_corners), len(mesh.points))
        self._entities, self._first = _entities(mesh.triangles, corners)
        points, edges = self._first[self._entities[:, :3]], self._first[self._entities[:, 3:]]
        self.dofs = np.concatenate([(points[:, :, None] + np.arange(6)).reshape(-1, 18), edges], axis=1)
        self._points = len(mesh.points)
        self._edges = int(self._first[-1]) - 6 * (self._points + len(copies))
        self.unknowns = int(self._first[-1])
        self._relative: Relative | None = None
        if len(free_corners):
            self._join(mesh.points, mesh.triangles, copies, free_corners)

    def _join(self, xy: FloatArray, triangles: IntArray, copies: Copies, corners: Sequence[int]) -> None:
        """Express the unknowns of every triangle by independent ones, near corners counted from these."""
        joined = continuity(xy, copies, self._edges)
        self.unknowns = joined.shape[1]
        # An edge's unknown comes behind those of points, which have copies, and of points, which have none.
        edges = self.dofs[:, 18:] - 6 * len(copies)
        self._relative = relative(self.triangles, triangles, edges, corners, self.unknowns)
        self._absolute, self._bent = joined @ self._relative.absolute, joined @ self._relative.bent

    def stiffness(self, poisson_ratio: float) -> csc_matrix:
        """The symmetric matrix of the bending energy and the supports; what rigid motions are left have no energy."""
        matrices = forms.bending(self.triangles, poisson_ratio)
        sliver, (triangle, points, weights) = self.triangles, self.slivers
        np.add.at(
            matrices,
            triangle,
            forms.bending_at(sliver.derivatives(points, triangle, 2), weights, poisson_ratio),
        )
        coupling, _ = forms.rim_forms(self.rim)
        traces = self._traces(poisson_ratio)
        at_rim = np.einsum("ckni,kncd,dknj->kij", traces, coupling, traces, optimize=True)
        if self._relative is None:
            np.add.at(matrices, self.rim.triangle, at_rim)
            return self._assemble(matrices)
        near = np.where(self._relative.inside[:, None, None], matrices, 0.0)
        matrices -= near
        np.add.at(matrices, self.rim.triangle, at_rim)
        bent = sum_up(near, self._entities, self._first)
        return (self._bent.T @ bent @ self._bent + self._assemble(matrices)).tocsc()

    def mass(self) -> csc_matrix:
        """The matrix of int v q."""
        matrices = forms.mass(self.triangles)
        triangle, points, weights = self.slivers
        np.add.at(matrices, triangle, forms.mass_at(self.triangles.derivatives(points, triangle, 0)[0], weights))
        return self._assemble(matrices)

    def _assemble(self, matrices: FloatArray) -> csc_matrix:
        return self._to_independent(self._to_independent(sum_up(matrices, self._entities, self._first)).T).tocsc()

    def _to_independent(self, matrix: csc_matrix) -> csc_matrix:
        """Rows for the unknowns of every triangle summed up for those that are independent."""
        return matrix if self._relative is None else self._absolute.T @ matrix

    def all_unknowns(self, unknowns: FloatArray) -> FloatArray:
        """Those of every triangle's own points, from the independent ones (unknowns, ...)."""
        return unknowns if self._relative is None else np.asarray(self._absolute @ unknowns)

    def _traces(self, poisson_ratio: float) -> FloatArray:
        derivatives = [self.triangles.derivatives(self.rim.points, self.rim.triangle, k) for k in range(4)]
        return forms.rim_traces(derivatives, self.rim.normal, poisson_ratio)

    def load(self, poisson_ratio: float) -> csc_matrix:
        """The matrix (unknowns, 6 points) that turns the traces (6, points) of given rim data into a right side."""
        traces, (_, coupling) = self._traces(poisson_ratio), forms.rim_forms(self.rim)
        data = np.einsum("ckni,kncd->dkni", traces, coupling, optimize=True)  # (6, k, n, 21)
        columns = np.arange(data[..., 0].size).reshape(data.shape[:3])
        rows = np.broadcast_to(self.dofs[self.rim.triangle][:, None], data.shape)
        columns = np.broadcast_to(columns[..., None], data.shape)
        shape = (self._first[-1], columns[..., 0].size)
        matrix = coo_matrix((data.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsc()
        matrix.eliminate_zeros()
        return self._to_independent(matrix)

    def point_values(self, xy: FloatArray) -> csc_matrix:
        """The matrix (n, unknowns) whose product with a function's unknowns is its value at points (n, 2)."""
        triangle = self._locate(xy)
        data = self.triangles.derivatives(xy[:, None], triangle, 0)[0, :, 0]
        columns = self.dofs[triangle]
        rows = np.broadcast_to(np.arange(len(xy))[:, None], columns.shape)
        matrix = coo_matrix((data.ravel(), (columns.ravel(), rows.ravel())), shape=(self._first[-1], len(xy))).tocsc()
        return self._to_independent(matrix).T.tocsc()

    def evaluate(self, xy: FloatArray, unknowns: FloatArray, orders: int) -> list[FloatArray]:
        """Functions given by their unknowns (unknowns, k) at points (n, 2).

        Returns the first `orders` of value (n, k), gradient (n, k, 2), Hessian (n, k, 2, 2). Beyond a rim triangle's
        chord its polynomial goes on, as in the integrals.
        """
        n, k = len(xy), unknowns.shape[1]
        unknowns = self.all_unknowns(unknowns)
        fields = [np.empty((n, k, *[2] * order)) for order in range(orders)]
        step = max(1, CHUNK // k)
        for start in range(0, n, step):
            part = slice(start, start + step)
            triangle = self._locate(xy[part])
            local = unknowns[self.dofs[triangle]]  # (n, 21, k)
            for order, into in enumerate(fields):
                table = self.triangles.derivatives(xy[part, None], triangle, order)[:, :, 0]
                values = [row[:, None] @ local for row in table]  # (n, 1, k) each
                for place in np.ndindex(*into.shape[2:]):
                    into[(part, slice(None), *place)] = values[sum(place)][:, 0]
        return fields

    def laplacians(self, xy: FloatArray, unknowns: FloatArray) -> FloatArray:
        """The Laplacians (n, k) of functions given by their unknowns (unknowns, k) at points (n, 2), as `evaluate`."""
        found = np.empty((len(xy), unknowns.shape[1]))
        unknowns = self.all_unknowns(unknowns)
        step = max(1, CHUNK // found.shape[1])
        for start in range(0, len(xy), step):
            part = slice(start, start + step)
            triangle = self._locate(xy[part])
            xx, _, yy = self.triangles.derivatives(xy[part, None], triangle, 2)
            found[part] = ((xx + yy) @ unknowns[self.dofs[triangle]])[:, 0]
        return found

    def linear(self) -> FloatArray:
        """The unknowns of 1, x and y, (unknowns, 3)."""
        functions = np.zeros((self._first[-1], 3))
        corners = self.dofs[:, [0, 6, 12]]
        functions[corners] = np.concatenate([np.ones((*corners.shape, 1)), self.triangles.points], axis=2)
        functions[corners + 1, 1] = 1.0
        functions[corners + 2, 2] = 1.0
        functions[self.dofs[:, 18:], 1:] = self.triangles.normals
        if self._relative is None:
            return functions
        # Independent are those of the mesh's points and edges, then the jumps, of which these functions have none.
        points, edges = functions[: 6 * self._points], functions[-self._edges :]
        jumps = np.zeros((self.unknowns - len(points) - len(edges), 3))
        independent = np.concatenate([points, edges, jumps])
        independent[self._relative.planes] = 0.0
        return independent

    @cached_property
    def quadrature(self) -> tuple[FloatArray, FloatArray]:
        """Points (n, 2) and weights (n,) over the plate, up to its true rim."""
        xy, weights = forms.square(QUADRATURE)
        inside = self.triangles.centre[:, None] + np.einsum("mij,nj->mni", self.triangles.jacobian, xy)
        area = self.triangles.determinant[:, None] * weights
        points = np.concatenate([inside.reshape(-1, 2), self.slivers.points.reshape(-1, 2)])
        return points, np.concatenate([area.ravel(), self.slivers.weights.ravel()])

    @property
    def points(self) -> FloatArray:
        """The mesh's points, (n, 2)."""
        return np.unique(self.triangles.points.reshape(-1, 2), axis=0)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.triangles.centre)

    def holds(self, xy: FloatArray) -> NDArray[np.bool_]:
        """Whether points (n, 2) lie in the mesh or hardly beyond it, (n,)."""
        return self._find(xy)[1] > -BEYOND

    def _locate(self, xy: FloatArray) -> IntArray:
        """The triangle that holds each point (n, 2), or the nearest one for a point between a chord and the rim."""
        return self._find(xy)[0]

    def _find(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        """The triangle of each point (n, 2) and the smallest of the barycentric coordinates there."""
        found, inside = np.empty(len(xy), dtype=np.int64), np.empty(len(xy))
        missing = np.arange(len(xy))
        for nearest, beyond in NEAREST:
            count = min(nearest, len(self.triangles.centre))
            _, candidates = self._tree.query(xy[missing], k=range(1, count + 1))
            x = self.triangles.reference(xy[missing].repeat(count, 0)[:, None], candidates.reshape(-1)) + 1 / 3
            u, v = x.reshape(-1, count, 2).transpose(2, 0, 1)
            smallest = np.minimum(np.minimum(u, v), 1 - u - v)
            best = np.argmax(smallest, axis=1)
            found[missing] = candidates[np.arange(len(missing)), best]
            inside[missing] = smallest.max(axis=1)
            missing = missing[inside[missing] < -beyond]
            if not missing.size:
                break
        return found, inside


def _entities(points: IntArray, corners: IntArray) -> tuple[IntArray, IntArray]:
    """What carries the unknowns of each triangle, its corners and then its edges (m, 6), and their first unknowns.

    points: (m, 3), the mesh points of each triangle, which tell edges apart.  corners: (m, 3), numbered from 0.
    """
    sides = np.sort(np.stack([points, np.roll(points, -1, axis=1)], axis=2), axis=2)
    edges, edge = np.unique(sides[..., 0] * (points.max() + 1) + sides[..., 1], return_inverse=True)
    count = int(corners.max()) + 1
    entities = np.concatenate([corners, count + edge.reshape(-1, 3)], axis=1)
    first = np.concatenate([6 * np.arange(count), 6 * count + np.arange(len(edges) + 1)])
    return entities, first
