"""Argyris functions on a mesh: their matrices up to the true rim, and their values at points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix
from scipy.spatial import cKDTree

from fem_plate.elements import forms
from fem_plate.elements.argyris import DEGREE, Triangles
from fem_plate.elements.assembly import number_entities, numbered, sum_up
from fem_plate.elements.corners import Copies, continuity, split
from fem_plate.elements.relative import Relative, relative
from fem_plate.elements.rim import rim_quadrature
from fem_plate.types import BoolArray, FloatArray, IntArray
from meshes import PlateMesh

CHUNK = 100_000  # points times functions evaluated at a time, to bound memory
QUADRATURE = 6  # points along each side of a triangle, for integrands that are not polynomials, at degree five
BEYOND = 0.1  # of a triangle: points up to this far beyond the mesh, as between chord and rim, count as on it
# How many of the closest triangles are searched for a point: more while it is not this deep inside the best one. A
# point that is clearly inside one triangle is in no other.
SEARCHES = ((3, 1e-9), (12, -1e-9), (200, -0.02), (2000, -np.inf))


class PlateSpace:
    """Argyris functions on a mesh whose lengths are divided by the plate's size.

    supports: of every boundary.  free_corners: rows of mesh points where second derivatives may jump.
    """

    def __init__(
        self, mesh: PlateMesh, supports: Mapping[str, str], free_corners: Sequence[int] = (), degree: int = DEGREE
    ) -> None:
        self.triangles = Triangles(mesh.points / mesh.size, mesh.triangles, degree)
        self._side = QUADRATURE + degree - DEGREE
        self.middle = (mesh.points.min(axis=0) + mesh.points.max(axis=0)) / 2 / mesh.size
        self.rim, self.slivers = rim_quadrature(mesh, supports, degree)
        corners, copies = split(mesh.triangles, list(free_corners), len(mesh.points))
        self._entities, self._first = number_entities(mesh.triangles, corners, self.triangles.functions)
        local, within = numbered(self._entities, self._first)
        self.dofs = self._first[self._entities][:, local] + within
        self._points = len(mesh.points)
        self._others = int(self._first[-1]) - 6 * (self._points + len(copies))  # unknowns that no point has
        self.unknowns = int(self._first[-1])
        self._relative: Relative | None = None
        if len(free_corners):
            self._join(mesh, copies, free_corners)

    def _join(self, mesh: PlateMesh, copies: Copies, corners: Sequence[int]) -> None:
        """Express the unknowns of every triangle by independent ones, counted from the corners they are close to."""
        joined = continuity(mesh.points, copies, self._others)
        self.unknowns = joined.shape[1]
        # The other unknowns follow those of points; the copies of points are not independent.
        of_points = (6 * mesh.triangles[:, :, None] + np.arange(6)).reshape(-1, 18)
        dofs = np.concatenate([of_points, self.dofs[:, 18:] - 6 * len(copies)], axis=1)
        places = mesh.points[list(corners)] / mesh.size
        self._relative = relative(self.triangles, dofs, corners, places, self.unknowns)
        self._absolute, self._bent = joined @ self._relative.absolute, joined @ self._relative.bent

    def stiffness(self, law: FloatArray, tension: float = 0.0) -> csc_matrix:
        """The symmetric matrix of a plate under a dimensionless tension, see `forms`.

        The rigid motions that the supports allow have no energy where there is no tension.
        """
        bending = self._bending(law)
        return bending + tension * self.stretching() if tension else bending

    def stretching(self) -> csc_matrix:
        """The symmetric matrix that a unit tension adds to the stiffness."""
        matrices = forms.stretching(self.triangles)
        triangle, points, weights = self.slivers
        np.add.at(matrices, triangle, forms.stretching_at(self.triangles.derivatives(points, triangle, 1), weights))
        value, gradient = (self.triangles.derivatives(self.rim.points, self.rim.triangle, k) for k in range(2))
        traces, used = np.concatenate([value, gradient]), slice(forms.GRADIENT.stop)
        coupling = forms.rim_tension_forms(self.rim)[0][..., used, used]
        np.add.at(matrices, self.rim.triangle, self.at_rim(traces, coupling))
        return self.assembled(matrices)

    def _bending(self, law: FloatArray) -> csc_matrix:
        """The matrix of int M(v):H(q) - R(v; q) - R(q; v) + S(v; q)."""
        traces, (coupling, _) = self.traces(law), forms.rim_forms(self.rim)
        return self.of_bending(self.bending_inside(law), self.at_rim(traces, coupling))

    def bending_inside(self, law: FloatArray) -> FloatArray:
        """int M(v):H(q) on triangles and up to the true rim, (m, i, i)."""
        matrices = forms.bending(self.triangles, law)
        triangle, points, weights = self.slivers
        hessian = self.triangles.derivatives(points, triangle, 2)
        np.add.at(matrices, triangle, forms.bending_at(hessian, weights, law))
        return matrices

    def at_rim(self, traces: FloatArray, coupling: FloatArray) -> FloatArray:
        """The matrices (k, i, i) of the rim's edges: traces (6, k, n, i), coupled by (k, n, 6, 6)."""
        return np.asarray(np.einsum("ckni,kncd,dknj->kij", traces, coupling, traces, optimize=True))  # c: q, d: v

    def of_bending(self, matrices: FloatArray, at_rim: FloatArray) -> csc_matrix:
        """The sum of what bends in triangles, (m, i, i), and of what the rim adds, (k, i, i)."""
        if self._relative is None:
            np.add.at(matrices, self.rim.triangle, at_rim)
            return self.assembled(matrices)
        at_corners = np.where(self._relative.inside[:, None, None], matrices, 0.0)
        matrices -= at_corners
        np.add.at(matrices, self.rim.triangle, at_rim)
        bent = sum_up(at_corners, self._entities, self._first)
        return (self._bent.T @ bent @ self._bent + self.assembled(matrices)).tocsc()

    def assemble_load(self, loads: FloatArray, triangle: IntArray) -> FloatArray:
        """The sum of loads (t, i, k) on functions of triangles (t,), in the independent unknowns, (unknowns, k)."""
        total = np.zeros((self.all_count, loads.shape[-1]))
        np.add.at(total, self.dofs[triangle], loads)
        return np.asarray(self.to_independent(total))

    def load_at(self, triangle: IntArray, points: FloatArray, loads: FloatArray) -> FloatArray:
        """The sum of q times loads (t, n, k) at points (t, n, 2) of triangles (t,), (unknowns, k)."""
        values = self.triangles.derivatives(points, triangle, 0)[0]
        return self.assemble_load(values.transpose(0, 2, 1) @ loads, triangle)

    def mass(self) -> csc_matrix:
        """The matrix of int v q."""
        matrices = forms.mass(self.triangles)
        triangle, points, weights = self.slivers
        np.add.at(matrices, triangle, forms.mass_at(self.triangles.derivatives(points, triangle, 0)[0], weights))
        return self.assembled(matrices)

    def assembled(self, matrices: FloatArray) -> csc_matrix:
        """The sum of element matrices (m, i, i), in the independent unknowns."""
        return self.to_independent(self.to_independent(sum_up(matrices, self._entities, self._first)).T).tocsc()

    def assembled_shared(self, matrices: FloatArray) -> csc_matrix:
        """The same without the unknowns that triangles have alone, on a space without free corners."""
        shared = self._entities[:, :6]
        return sum_up(matrices, shared, self._first[: int(shared.max()) + 2])

    def to_independent(self, matrix: csc_matrix) -> csc_matrix:
        """Sum the rows of every triangle's own unknowns into those of the independent ones."""
        return matrix if self._relative is None else self._absolute.T @ matrix

    @property
    def all_count(self) -> int:
        """How many unknowns the triangles have together, the dependent ones included."""
        return int(self._first[-1])

    def element_dofs(self, unknowns: FloatArray) -> FloatArray:
        """The unknowns of every triangle's own points from the independent ones (unknowns, ...)."""
        return unknowns if self._relative is None else np.asarray(self._absolute @ unknowns)

    def traces(self, law: FloatArray) -> FloatArray:
        """The rim's channels of the triangles' functions, (6, k, n, i)."""
        derivatives = [self.triangles.derivatives(self.rim.points, self.rim.triangle, k) for k in range(4)]
        return forms.rim_traces(derivatives, self.rim.normal, law)

    def load(self, law: FloatArray, tension: float = 0.0) -> csc_matrix:
        """The matrix (unknowns, 6 points) of the right side of `forms` for the traces (6, points) of g."""
        return self.rim_load(self.traces(law), self.couplings(tension)[1])

    def rim_load(self, traces: FloatArray, coupling: FloatArray) -> csc_matrix:
        """The same for traces (6, k, n, i) of the triangles' functions, coupled by (k, n, 6, 6) with those of g."""
        data = np.einsum("ckni,kncd->dkni", traces, coupling, optimize=True)  # (6, k, n, i)
        columns = np.arange(data[..., 0].size).reshape(data.shape[:3])
        rows = np.broadcast_to(self.dofs[self.rim.triangle][:, None], data.shape)
        columns = np.broadcast_to(columns[..., None], data.shape)
        shape = (self._first[-1], columns[..., 0].size)
        matrix = coo_matrix((data.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsc()
        matrix.eliminate_zeros()
        return self.to_independent(matrix)

    def couplings(self, tension: float) -> tuple[FloatArray, FloatArray]:
        """What couples the rim's channels on the left and on the right side of `forms`, (k, n, 6, 6) each."""
        left, right = forms.rim_forms(self.rim)
        if tension:
            of_left, of_right = forms.rim_tension_forms(self.rim)
            left, right = left + tension * of_left, right + tension * of_right
        return left, right

    def misfit(
        self, tables: FloatArray, couplings: tuple[FloatArray, FloatArray], traces: FloatArray, local: FloatArray
    ) -> FloatArray:
        """What loads the rim's channels (6, k, n, f) where unknowns (k, i, f) are to follow traces (6 points, f).

        tables: (6, k, n, i), the traces of the triangles' functions.
        """
        left, right = couplings
        given = traces.reshape(*tables.shape[:3], -1)
        loads = np.einsum("kncd,dknf->cknf", left, given - tables @ local)
        return np.asarray(loads + np.einsum("kncd,dknf->cknf", right - left, given))

    def point_values(self, xy: FloatArray, triangle: IntArray | None = None) -> csc_matrix:
        """The matrix (n, unknowns) whose product with a function's unknowns is its value at points (n, 2).

        triangle: (n,), that of each point where they are known.
        """
        triangle = self.triangle_of(xy) if triangle is None else triangle
        data = self.triangles.derivatives(xy[:, None], triangle, 0)[0, :, 0]
        columns = self.dofs[triangle]
        rows = np.broadcast_to(np.arange(len(xy))[:, None], columns.shape)
        matrix = coo_matrix((data.ravel(), (columns.ravel(), rows.ravel())), shape=(self._first[-1], len(xy))).tocsc()
        return self.to_independent(matrix).T.tocsc()

    def evaluate(self, xy: FloatArray, unknowns: FloatArray, orders: int) -> list[FloatArray]:
        """Functions given by their unknowns (unknowns, k) at points (n, 2).

        Returns the first `orders` of value (n, k), gradient (n, k, 2) and Hessian (n, k, 2, 2). A rim triangle's
        polynomial continues beyond its chord, as in the integrals.
        """
        n, k = len(xy), unknowns.shape[1]
        unknowns = self.element_dofs(unknowns)
        results = [np.empty((n, k, *[2] * order)) for order in range(orders)]
        step = max(1, CHUNK // k)
        for start in range(0, n, step):
            part = slice(start, start + step)
            triangle, of_triangle = self._at(xy[part], unknowns)
            for order, result in enumerate(results):
                table = self.triangles.of_reference(xy[part, None], triangle, order)[:, :, 0]
                values = [row[:, None] @ of_triangle for row in table]  # (n, 1, k) each
                for axes in np.ndindex(*result.shape[2:]):
                    result[(part, slice(None), *axes)] = values[sum(axes)][:, 0]
        return results

    def laplacians(self, xy: FloatArray, unknowns: FloatArray) -> FloatArray:
        """The Laplacians (n, k) of functions given by their unknowns (unknowns, k) at points (n, 2), as `evaluate`."""
        result = np.empty((len(xy), unknowns.shape[1]))
        unknowns = self.element_dofs(unknowns)
        step = max(1, CHUNK // result.shape[1])
        for start in range(0, len(xy), step):
            part = slice(start, start + step)
            triangle, of_triangle = self._at(xy[part], unknowns)
            xx, _, yy = self.triangles.of_reference(xy[part, None], triangle, 2)
            result[part] = ((xx + yy) @ of_triangle)[:, 0]
        return result

    def _at(self, xy: FloatArray, unknowns: FloatArray) -> tuple[IntArray, FloatArray]:
        """The triangle of each point (n, 2), and functions' reference unknowns there, (n, functions, k)."""
        triangle = self.triangle_of(xy)
        used, row = np.unique(triangle, return_inverse=True)
        return triangle, (self.triangles.transform[used] @ unknowns[self.dofs[used]])[row]

    def linear(self) -> FloatArray:
        """The unknowns of 1, x and y, (unknowns, 3)."""
        functions = np.zeros((self._first[-1], 3))
        functions[self.dofs] = self.triangles.linear
        if self._relative is None:
            return functions
        # Independent are the mesh's unknowns, but those of copies, and the jumps, which vanish for these functions.
        points, others = functions[: 6 * self._points], functions[-self._others :]
        jumps = np.zeros((self._absolute.shape[1] - len(points) - len(others), 3))
        independent = np.concatenate([points, others, jumps])
        independent[self._relative.planes] = 0.0
        return independent

    def cells(self, step: int, chosen: IntArray | None = None) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
        """Triangles (t,), quadrature points (t, n, 2) and weights (t, n), `step` at a time, and then the slivers."""
        triangles = self.triangles
        xy, weights = forms.triangle_quadrature(self._side)
        rows = np.arange(len(triangles.centre)) if chosen is None else chosen
        for start in range(0, len(rows), step):
            triangle = rows[start : start + step]
            points = np.einsum("mij,nj->mni", triangles.jacobian[triangle], xy) + triangles.centre[triangle, None]
            yield triangle, points, triangles.determinant[triangle, None] * weights
        if len(self.slivers.triangle):
            yield self.slivers

    @cached_property
    def quadrature(self) -> tuple[FloatArray, FloatArray]:
        """Points (n, 2) and weights (n,) over the plate, up to its true rim."""
        xy, weights = forms.triangle_quadrature(self._side)
        inside = self.triangles.centre[:, None] + np.einsum("mij,nj->mni", self.triangles.jacobian, xy)
        area = self.triangles.determinant[:, None] * weights
        points = np.concatenate([inside.reshape(-1, 2), self.slivers.points.reshape(-1, 2)])
        return points, np.concatenate([area.ravel(), self.slivers.weights.ravel()])

    @property
    def quadrature_triangles(self) -> IntArray:
        """The triangle of each point of `quadrature`, (n,)."""
        inside = np.repeat(np.arange(len(self.triangles.centre)), self._side**2)
        return np.concatenate([inside, np.repeat(self.slivers.triangle, self.slivers.points.shape[1])])

    @property
    def points(self) -> FloatArray:
        """The mesh's points, (n, 2)."""
        return np.unique(self.triangles.points.reshape(-1, 2), axis=0)

    @property
    def samples(self) -> FloatArray:
        """Where functions are compared, (n, 2): the mesh's points; above degree five the middles of its cells, too.

        At the mesh's points functions of a high degree are better than elsewhere, by a factor of 30.
        """
        high = self.triangles.functions.degree > DEGREE
        return np.concatenate([self.points, self.triangles.centre]) if high else self.points

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.triangles.centre)

    def holds(self, xy: FloatArray) -> BoolArray:
        """Whether points (n, 2) lie in the mesh or just beyond it, (n,)."""
        return self._find(xy)[1] > -BEYOND

    def triangle_of(self, xy: FloatArray) -> IntArray:
        """The triangle of each point (n, 2), the closest one for a point between a chord and the rim."""
        return self._find(xy)[0]

    def _find(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        """The triangle of each point (n, 2) and the smallest of its barycentric coordinates there."""
        triangle, inside = np.empty(len(xy), dtype=np.int64), np.empty(len(xy))
        missing = np.arange(len(xy))
        for closest, depth in SEARCHES:
            count = min(closest, len(self.triangles.centre))
            _, candidates = self._tree.query(xy[missing], k=range(1, count + 1))
            x = self.triangles.reference(xy[missing].repeat(count, 0)[:, None], candidates.reshape(-1)) + 1 / 3
            u, v = x.reshape(-1, count, 2).transpose(2, 0, 1)
            smallest = np.minimum(np.minimum(u, v), 1 - u - v)
            best = np.argmax(smallest, axis=1)
            triangle[missing] = candidates[np.arange(len(missing)), best]
            inside[missing] = smallest.max(axis=1)
            missing = missing[inside[missing] < depth]
            if not missing.size:
                break
        return triangle, inside
