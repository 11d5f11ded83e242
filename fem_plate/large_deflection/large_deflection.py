"""LargeDeflection: a plate with actuators that bends and stretches (von Karman)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import CLAMPED, rigid_motions, rim_quadrature
from fem_plate.estimated import refined
from fem_plate.given_plate import GivenPlate
from fem_plate.inputs import check_held, one_per_point
from fem_plate.large_deflection.membranes import AIRY, PLANE_STRESS
from fem_plate.large_deflection.solution import DiscretePlate, level_of
from fem_plate.large_deflection.state import DeflectedPlate
from fem_plate.types import FloatArray
from meshes import edge_numbers, sides


class LargeDeflection:
    """A plate with actuators, in von Karman's theory; made by `Plate.large_deflection`.

    Attributes
    ----------
    points : (N, 2) array
        Places of the actuators [m].
    stiffness : (N,) array
        Their stiffness [N/m]; inf is rigid, 0 a force.
    movable : dict of str to bool
        Whether each boundary is free to move in the plane.
    membrane : str
        "airy" or "plane-stress": how stretching is computed.
    """

    def __init__(
        self,
        plate: GivenPlate,
        points: FloatArray,
        stiffness: FloatArray,
        movable: Mapping[str, bool],
        membrane: str | None,
    ) -> None:
        self.plate, self.points, self.stiffness, self.movable = plate, points, stiffness, dict(movable)
        check_held("large_deflection", _motions(plate, points), stiffness > 0)
        by_airy = airy_applies(plate, movable)
        if membrane not in (None, AIRY, PLANE_STRESS) or (membrane == AIRY and not by_airy):
            raise ValueError(
                f"Input membrane of large_deflection must be {PLANE_STRESS!r} or, on plates without holes whose rim is "
                f"immovable, or movable and clamped, {AIRY!r}; got {membrane!r}"
            )
        self.membrane = membrane or (AIRY if by_airy else PLANE_STRESS)
        self._discrete: dict[tuple[int, int], DiscretePlate] = {}

    def solve(self, heights: ArrayLike, pressure: float = 0.0) -> DeflectedPlate:
        """The plate in equilibrium.

        Parameters
        ----------
        heights : (N,) array_like
            Strokes of the actuators [m]; of those that are forces, in N.
        pressure : float
            Uniform pressure, positive up [Pa].

        Returns
        -------
        state : DeflectedPlate
            Its shape, its membrane and its reactions.

        Raises
        ------
        ValueError
            There is not one height for each actuator, or a load is not finite.
        NotConverged
            Newton's method ended without an equilibrium.
        """
        strokes = one_per_point(heights, len(self.points), "heights of solve")
        if not (np.isfinite(strokes).all() and np.isfinite(pressure)):
            raise ValueError("Input heights and pressure of solve must be finite; got some that are not")
        thickness = self.plate.section.thickness
        level = level_of(float(np.abs(strokes[np.isinf(self.stiffness)]).max(initial=0.0)) / thickness)
        while True:
            state = self._refined(strokes, pressure, level)
            needed = level_of(state.largest / thickness)
            if needed <= level:
                return state
            level = needed

    def _refined(self, strokes: FloatArray, pressure: float, level: int) -> DeflectedPlate:
        plate = self.plate
        return refined(
            lambda halvings: self.solved(strokes, pressure, level, halvings), plate.tolerance, plate.fineness.gain
        )

    def solved(self, strokes: FloatArray, pressure: float, level: int, halvings: int) -> DeflectedPlate:
        """The plate in equilibrium on cells of a level of fineness, halved."""
        discrete = self.discrete(level, halvings)
        solution = discrete.equilibrium.solve(discrete.loads(strokes, pressure))
        return DeflectedPlate(discrete, solution.state, solution.forces)

    def discrete(self, level: int, halvings: int) -> DiscretePlate:
        """The plate on cells of a level of fineness (see `cells`), halved."""
        key = level, halvings
        if key not in self._discrete:
            self._discrete = {
                key: DiscretePlate(self.plate, self.points, self.stiffness, self.movable, self.membrane, *key)
            }
        return self._discrete[key]


def _motions(plate: GivenPlate, points: FloatArray) -> FloatArray:
    """The rigid motions that the supports allow, at points (N, 2) [m]: (N, r)."""
    rigid = rigid_motions(rim_quadrature(plate.mesh, plate.supports)[0])
    return np.column_stack([np.ones(len(points)), points / plate.mesh.size]) @ rigid


def airy_applies(plate: GivenPlate, movable: Mapping[str, bool]) -> bool:
    """Whether there are no holes and the whole rim is held alike; also clamped, if it is movable.

    Where a rim both slopes and moves, the stress function's test functions do not vanish there as they should.
    """
    kinds, supports = set(movable.values()), set(plate.supports.values())
    return len(kinds) == 1 and (kinds == {False} or supports == {CLAMPED}) and not _has_holes(plate)


def _has_holes(plate: GivenPlate) -> bool:
    """By Euler's formula: a plate without holes has one point and one triangle more than edges."""
    mesh = plate.mesh
    edges = len(np.unique(edge_numbers(sides(mesh.triangles), len(mesh.points))))
    return len(np.unique(mesh.triangles)) - edges + len(mesh.triangles) != 1
