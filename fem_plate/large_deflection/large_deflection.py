"""LargeDeflection: a plate with actuators that bends and stretches (von Karman), and the cells that it needs."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.deflection import MAX_UNKNOWNS, refined
from fem_plate.elements import CLAMPED, FREE, rigid_motions, rim_quadrature
from fem_plate.graded import GradedPlate
from fem_plate.inputs import check_held, one_per_point
from fem_plate.large_deflection.discrete import DiscretePlate, level_of
from fem_plate.large_deflection.membrane import AIRY, PLANE_STRESS
from fem_plate.large_deflection.state import DeflectedPlate
from fem_plate.sections import PlateSection
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
        plate: GradedPlate,
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
        return refined(lambda halvings: self.solved(strokes, pressure, level, halvings), plate.tolerance, plate.gain)

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


def _motions(plate: GradedPlate, points: FloatArray) -> FloatArray:
    """The rigid motions that the supports allow, at points (N, 2) [m]: (N, r)."""
    rigid = rigid_motions(rim_quadrature(plate.mesh, plate.supports)[0])
    return np.column_stack([np.ones(len(points)), points / plate.mesh.size]) @ rigid


def airy_applies(plate: GradedPlate, movable: Mapping[str, bool]) -> bool:
    """Whether there are no holes and the whole rim is held alike; also clamped, if it is movable.

    Where a rim both slopes and moves, the stress function's test functions do not vanish there as they should.
    """
    kinds, supports = set(movable.values()), set(plate.supports.values())
    return len(kinds) == 1 and (kinds == {False} or supports == {CLAMPED}) and not _has_holes(plate)


def _has_holes(plate: GradedPlate) -> bool:
    """By Euler's formula: a plate without holes has one point and one triangle more than edges."""
    mesh = plate.mesh
    edges = len(np.unique(edge_numbers(sides(mesh.triangles), len(mesh.points))))
    return len(np.unique(mesh.triangles)) - edges + len(mesh.triangles) != 1


IMMOVABLE, MOVABLE = "immovable", "movable"
KINDS = (IMMOVABLE, MOVABLE)


def check_stretches(plate: GradedPlate, caller: str) -> None:
    """ValueError, for `caller`, unless a plate is uniform, isotropic and without a tension."""
    wrong = []
    if plate.tension:
        wrong.append(f"Input tension of Plate must be 0 for {caller}; got {plate.tension!r} N/m")
    if not isinstance(plate.section, PlateSection):
        kind = type(plate.section).__name__
        wrong.append(f"Input section of Plate must be a PlateSection for {caller}; got a {kind}")
    if callable(plate.foundation) or plate.foundation:
        wrong.append(f"Input foundation of Plate must be 0 for {caller}; got {plate.foundation!r}")
    if plate.forms:
        wrong.append(f"Input forms of Plate must be empty for {caller}; got {len(plate.forms)}")
    if wrong:
        raise ValueError("; ".join(wrong))


def movable_by_boundary(in_plane_supports: str | Mapping[str, str], supports: Mapping[str, str]) -> dict[str, bool]:
    """Whether each boundary is free to move in the plane.

    One name counts for all boundaries that `supports` hold, and free ones can move. Those that a mapping leaves out can
    move, too. Raises ValueError, naming every unknown support and boundary.
    """
    if isinstance(in_plane_supports, str):
        given = {name: in_plane_supports if held != FREE else MOVABLE for name, held in supports.items()}
        kinds = {"the rim": in_plane_supports}
    elif isinstance(in_plane_supports, Mapping):
        given = kinds = dict(in_plane_supports)
    else:
        raise ValueError(
            "Input in_plane_supports of large_deflection must be one name or a mapping from boundaries; got "
            f"{in_plane_supports!r}"
        )
    names = ", ".join(map(repr, supports))
    mistakes = [f"boundary {name!r} is not one of the mesh's, {names}" for name in given if name not in supports]
    mistakes += [
        f"the support of {name!r} must be {IMMOVABLE!r} or {MOVABLE!r}; got {kind!r}"
        for name, kind in kinds.items()
        if kind not in KINDS
    ]
    if mistakes:
        raise ValueError("Input in_plane_supports of large_deflection: " + "; ".join(mistakes))
    return {name: given.get(name, MOVABLE) == MOVABLE for name in supports}


def fine_enough(large: LargeDeflection, heights: FloatArray) -> tuple[DiscretePlate, float]:
    """The plate on the largest cells that meet its tolerance at heights (N,) [m, or N], and the error that they leave.

    The error is that of w, over the largest: the difference from cells of half the size. Without a tolerance cells stay
    as they are, but those around actuators and at the rim.
    """
    coarse, tolerance = _on_own_cells(large, heights), large.plate.tolerance
    while True:
        fine = large.solved(heights, 0.0, coarse.discrete.level, coarse.discrete.halvings + 1)
        error = fine.difference(coarse)
        if tolerance is None or error <= tolerance or 4 * fine.unknowns > MAX_UNKNOWNS:
            return coarse.discrete, error
        coarse = fine


def _on_own_cells(large: LargeDeflection, heights: FloatArray) -> DeflectedPlate:
    """The plate at some heights on its own cells, but those around actuators and at the rim."""
    thickness = large.plate.section.thickness
    level = level_of(float(np.abs(heights[np.isinf(large.stiffness)]).max(initial=0.0)) / thickness)
    while True:
        state = large.solved(heights, 0.0, level, 0)
        needed = level_of(state.largest / thickness)
        if needed <= level:
            return state
        level = needed
