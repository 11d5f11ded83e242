"""Plate: a mesh, a section and its supports, ready to be loaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_plate import vibration
from fem_plate.arrays import CELL, FINER_CELL, Array, Cutter, PatchedShapes, Tell, spacing
from fem_plate.deflection import Deflection
from fem_plate.elements import Estimated, Fineness, PlateModel, by_boundary, corner_rows, graded, singular_corners
from fem_plate.influence import MOST_DENSE, InfluenceShapes, check_points
from fem_plate.section import PlateSection
from fem_plate.vibration import Modes
from meshes import PlateMesh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]
Answer = TypeVar("Answer", bound=Estimated)

PATCH_FINENESS = 0.16  # of the half width, eight cells: shapes at the rim are then good to 1e-6
TRUNCATION = 1e-6  # of unit shapes, where they are found on patches
MOST_UNKNOWNS = 100_000  # refinement to a tolerance stops here
REFINEMENT_GAIN = 2.0**5  # halving the cells divides the error of w by this at least (observed: 2^5.5 and more)


class Plate:
    """A Kirchhoff-Love plate.

    Parameters
    ----------
    mesh : PlateMesh
        Its outline.
    section : PlateSection
        Its material and thickness.
    supports : str or dict of str to str
        `"clamped"`, `"simply-supported"` or `"free"`, for the whole rim or by boundary. Boundaries left out are free.
    tolerance : float, optional
        Shapes and deflections are refined until their error estimate, relative to the largest deflection, meets it,
        or until 100 000 unknowns; `error_estimate` states what was reached. Shapes on patches get somewhat finer
        cells. Modes ignore it.

    Raises
    ------
    ValueError
        A support or boundary is not known, or the tolerance is not positive; names each.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        section: PlateSection,
        supports: str | Mapping[str, str] = "clamped",
        tolerance: float | None = None,
    ) -> None:
        if tolerance is not None and not tolerance > 0:
            raise ValueError(f"Input tolerance of Plate must be greater than 0; got {tolerance!r}")
        self.supports = by_boundary(supports, mesh.boundaries)
        self.mesh = mesh
        self.section = section
        self.tolerance = tolerance
        self._fineness = Fineness.of(mesh)
        self._corners = singular_corners(mesh, self.supports, section.poisson_ratio)
        self._last: tuple[bytes, PlateModel] | None = None

    def model(self, points: FloatArray | None = None, halvings: int = 0) -> PlateModel:
        """The plate on cells graded towards its corners and for actuators at points (N, 2) [m], halved some times."""
        mesh = self.mesh
        for _ in range(halvings):
            mesh = mesh.refined()
        mesh = graded(mesh, self._fineness.halved(halvings), self._corners, points)
        key = mesh.points.tobytes()
        if self._last is None or self._last[0] != key:
            rows = corner_rows(mesh, self._corners)
            self._last = key, PlateModel(mesh, self.supports, self.section.poisson_ratio, rows)
        return self._last[1]

    def influence(
        self,
        points: ArrayLike,
        stiffness: ArrayLike | None = None,
        truncation: float | None = None,
        tell: Tell = lambda done, of: None,
    ) -> InfluenceShapes | PatchedShapes:
        """The influence shapes of actuators.

        Parameters
        ----------
        points : array (N, 2)
            Places of the actuators, m.
        stiffness : float or array (N,), optional
            Stiffness of springs in series with the actuators, N/m. inf (the default) is a rigid actuator, 0 one that
            floats and is driven by a force.
        truncation : float, optional
            With one, shapes are solved on patches and end where they are below it. More than 2 000 actuators are
            always solved so, with 1e-6 by default.
        tell : callable
            Called with the number of finished tiles of patches, and of all.

        Returns
        -------
        shapes : InfluenceShapes or PatchedShapes
            The shapes.

        Raises
        ------
        ValueError
            A point is not inside the rim or coincides with another, a stiffness is below 0 (names each), or supports
            and actuators leave the plate a rigid motion.
        """
        points = _places(points, "points of influence")
        springs = np.full(len(points), np.inf)
        if stiffness is not None:
            springs = _one_each(stiffness, points, "stiffness of influence")
            if not np.all(springs >= 0):
                row = int(np.flatnonzero(~(springs >= 0))[0])
                raise ValueError(
                    f"Input stiffness of influence must be 0 or more; got {springs[row]} N/m for point {row + 1}"
                )
        check_points("influence", points, self.mesh.outline.gap(points), self.mesh.size)
        rigidity = self.section.rigidity
        if truncation is not None or len(points) > MOST_DENSE:
            return self._patched(points, springs, TRUNCATION if truncation is None else truncation, tell)
        return self._estimated(points, lambda model: InfluenceShapes(model, points, rigidity, springs))

    def deflection(self, points: ArrayLike, forces: ArrayLike, pressure: float = 0.0) -> Deflection:
        """The plate under point forces and a uniform pressure, positive up.

        Where supports leave the plate a rigid motion, the answer is the one without mean deflection and slope.

        Parameters
        ----------
        points : array (N, 2)
            Places of the forces, m.
        forces : array (N,)
            Forces, N.
        pressure : float
            Pressure, Pa.

        Returns
        -------
        deflection : Deflection
            The deflected plate.

        Raises
        ------
        ValueError
            As for `influence`; there is not one force a point; or the loads on a plate that can move rigidly do not
            balance.
        """
        points = _places(points, "points of deflection")
        loads = _one_each(forces, points, "forces of deflection")
        if not (np.isfinite(loads).all() and np.isfinite(pressure)):
            raise ValueError("Input forces and pressure of deflection must be finite; got some that are not")
        if points.size:
            check_points("deflection", points, self.mesh.outline.gap(points), self.mesh.size)
        rigidity = self.section.rigidity
        return self._estimated(points, lambda model: Deflection(model, points, loads, float(pressure), rigidity))

    def pressure(self, load: float) -> Deflection:
        """The plate under a uniform pressure [Pa], positive up; raises as `deflection` does."""
        return self.deflection(np.empty((0, 2)), np.empty(0), load)

    def frequencies(self, count: int, held: ArrayLike | None = None, stiffness: ArrayLike | None = None) -> FloatArray:
        """The lowest natural frequencies (count,) [Hz], ascending, repeated ones repeated; raises as `modes` does."""
        return self.modes(count, held, stiffness).frequencies

    def modes(self, count: int, held: ArrayLike | None = None, stiffness: ArrayLike | None = None) -> Modes:
        """The lowest modes of vibration, without motions in which nothing bends and no spring yields.

        Parameters
        ----------
        count : int
            Number of modes.
        held : array (N, 2), optional
            Points that actuators hold still, m.
        stiffness : float or array (N,), optional
            Stiffness of springs between those and the plate, N/m; inf (the default) is a rigid hold.

        Returns
        -------
        modes : Modes
            The modes.

        Raises
        ------
        ValueError
            The section has no density, the count or a stiffness is not positive, a held point is not inside the rim
            or coincides with another, or there are more than 2 000 of them.
        """
        density = self.section.density
        if density is None:
            raise ValueError("Input density of PlateSection must be given for frequencies; got None")
        points = _places([] if held is None else held, "held of modes")
        if len(points) > MOST_DENSE:
            raise ValueError(f"Input held of modes must be at most {MOST_DENSE} points; got {len(points)}")
        if points.size:
            check_points("modes", points, self.mesh.outline.gap(points), self.mesh.size)
        springs = np.full(len(points), np.inf)
        if stiffness is not None:
            springs = _one_each(stiffness, points, "stiffness of modes")
            if not np.all(springs > 0):
                row = int(np.flatnonzero(~(springs > 0))[0])
                raise ValueError(
                    f"Input stiffness of modes must be positive; got {springs[row]} N/m for point {row + 1}"
                )
        model = self.model(points)
        most = model.unknowns // 2
        if not (isinstance(count, int | np.integer) and 1 <= count < most):
            raise ValueError(f"Input count of modes must be a whole number from 1 to {most - 1}; got {count!r}")
        inertia = density * self.section.thickness * self.mesh.size**4
        rigidity = self.section.rigidity
        give = rigidity / self.mesh.size**2 / springs
        return vibration.modes(model, points, give, count, rigidity / inertia)

    def __repr__(self) -> str:
        width, height = np.ptp(self.mesh.outline.box, axis=0)
        rims = ", ".join(f"{name} {support}" for name, support in self.supports.items())
        return f"Plate of {width:.4g} m x {height:.4g} m, {self.section.thickness:.4g} m thick; {rims}"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the rim by its supports and the mesh, into axes in m or new ones."""
        from fem_plate.pictures import draw_cells  # here, because matplotlib is loaded for pictures only
        from meshes import plotted

        return plotted(lambda axes: draw_cells(self, axes), axes)

    def _repr_html_(self) -> str:
        from meshes import notebook_html

        return notebook_html(self)

    def _patched(self, points: FloatArray, springs: FloatArray, truncation: float, tell: Tell) -> PatchedShapes:
        pitch, rigidity = spacing(points), self.section.rigidity
        most = PATCH_FINENESS * self._fineness.half_width
        fine = replace(self._fineness, cell=min(self._fineness.cell, most))
        cell = CELL if self.tolerance is None else FINER_CELL
        cutter = Cutter(self.mesh, self.supports, fine, self._corners, points, pitch, cell)
        array = Array(cutter, points, springs, rigidity, self.section.poisson_ratio)
        return PatchedShapes(array, truncation, self.mesh.size, self.mesh.outline, tell)

    def _estimated(self, points: FloatArray, answer: Callable[[PlateModel], Answer]) -> Answer:
        """An answer that can estimate its error, refined to the tolerance where there is one."""
        result = answer(self.model(points))
        result.refine = lambda: answer(self.model(points, 1))
        if self.tolerance is None:
            return result
        change, halvings = np.inf, 0
        while 4 * result.unknowns < MOST_UNKNOWNS and (not halvings or result.error_estimate > self.tolerance):
            halvings += 1
            coarse, result = result, answer(self.model(points, halvings))
            before, change = change, result.difference(coarse)
            result.error_estimate = change * max(change / before, 1 / REFINEMENT_GAIN)
            if change > before / 2:
                # Halving gains no more: what is left is rounding, or the estimates were too hopeful.
                coarse.error_estimate, result.error_estimate = before, change
                return coarse if before < change else result
        return result


def _places(points: ArrayLike, name: str) -> FloatArray:
    """Points as an array (N, 2)."""
    array = np.asarray(points, dtype=float)
    if array.size and (array.ndim not in (1, 2) or array.shape[-1] != 2):
        raise ValueError(f"Input {name} must have shape (N, 2); got {array.shape}")
    return array.reshape(-1, 2)


def _one_each(values: ArrayLike, points: FloatArray, name: str) -> FloatArray:
    """One number for each point, (N,), from one or N."""
    array = np.asarray(values, dtype=float)
    if array.shape not in ((), (len(points),)) or len(points) == 0 < array.size:
        raise ValueError(f"Input {name} must be one a point, {len(points)}; got shape {array.shape}")
    return np.broadcast_to(array, len(points)).copy()
