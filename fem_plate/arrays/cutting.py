"""Patches cut out of a plate: rectangles with a mesh of their own where they can be, else parts of its mesh."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.elements import CLAMPED, MeshGrading, SingularCorner, corner_rows, grade_mesh
from fem_plate.types import FloatArray
from meshes import Outline, PlateMesh, rectangle

CELL = 1.0  # pitches, the largest cell: the estimated error of shapes is then 4e-6
FINER_CELL = 0.8  # pitches: 5e-7, in twice the time
CUT = "cut"  # the boundary along which a patch is cut out; it is clamped
SIDES = {"left": (0, 0), "right": (1, 0), "bottom": (0, 1), "top": (1, 1)}  # row and axis of a box


class Turn(NamedTuple):
    """A patch seen another way round: what runs along axis k, times its sign, runs along `axes[k]` of the patch."""

    axes: list[int]
    signs: FloatArray  # (2,) of 1 and -1

    @property
    def is_none(self) -> bool:
        """Whether the patch is seen as it is."""
        return self.axes == [0, 1] and bool((self.signs > 0).all())

    def of(self, xy: FloatArray) -> FloatArray:
        """Points (n, 2) in the patch's coordinates, from those of the one that sees it."""
        return (xy * self.signs)[:, self.axes]


def turns(mirrored: bool, swapped: bool) -> list[Turn]:
    """How a patch may be seen: as it is, and mirrored, and with its axes swapped."""
    signs = itertools.product((1.0, -1.0), repeat=2) if mirrored else [(1.0, 1.0)]
    axes = [[0, 1], [1, 0]] if swapped else [[0, 1]]
    return [Turn(along, np.array(sign)) for along, sign in itertools.product(axes, signs)]


@dataclass(frozen=True, eq=False)
class Cut:
    """Where a patch lies."""

    origin: FloatArray  # (2,) m
    box: FloatArray  # (2, 2) m, from the origin
    edge: FloatArray  # (n, 2) m, from the origin: closely spaced points along the cut
    name: bytes  # differs for patches with equal boxes and actuators that are not alike
    sides: Mapping[str, str]  # of a rectangle, the boundary on each side; empty for a part of the plate's mesh

    def seen(self, turn: Turn) -> bytes:
        """The name of a rectangle seen another way round."""
        if turn.is_none:
            return self.name
        left, right, bottom, top = self.name.split(b",")
        pairs = [[left, right][:: int(turn.signs[0])], [bottom, top][:: int(turn.signs[1])]]
        return b",".join(name for axis in turn.axes for name in pairs[axis])


class Cutter:
    """Cuts patches out of a plate for an array of actuators.

    fine, corners: as in `grade_mesh`.  points: (N, 2) m.  pitch: (2,) m.  cell: pitches, the largest cell.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        supports: Mapping[str, str],
        fine: MeshGrading,
        corners: list[SingularCorner],
        points: FloatArray,
        pitch: FloatArray,
        cell: float = CELL,
    ) -> None:
        self.plate, self.supports = _without_cuts(mesh, supports)
        self.fine, self.corners = fine, corners
        self.points, self.pitch = points, np.minimum(pitch, mesh.size)
        self.cell = min(cell * float(self.pitch.min()), fine.cell)
        self._sides = _rectangle_sides(self.plate)

    def halved(self) -> Cutter:
        """The same with cells of half the size."""
        cell = self.cell / float(self.pitch.min()) / 2
        return Cutter(self.plate, self.supports, self.fine.halved(), self.corners, self.points, self.pitch, cell)

    def cut(self, middle: FloatArray, reach: FloatArray) -> Cut:
        """The patch around `middle` (2,) [m] that reaches `reach` (2,) [m] along x and y, as far as there is plate."""
        whole = np.stack([middle - reach, middle + reach])
        limits = self.plate.outline.box
        box = np.clip(whole, limits[0], limits[1])
        if self._sides or self._inside(box):
            # A side short of the plate's is a cut, unless less than half a cell of plate is left beyond it.
            beyond = np.array([box[0] - limits[0], limits[1] - box[1]])
            box = np.where(beyond < 0.5 * self.cell, limits, box)
            names = {
                side: self._sides.get(side, CUT) if beyond[row, axis] < 0.5 * self.cell else CUT
                for side, (row, axis) in SIDES.items()
            }
            kinds = ",".join(self.supports.get(name, CUT) for name in names.values())
            return Cut(middle, box - middle, self._edge(box - middle, names), kinds.encode(), names)
        part = self._part(box)
        edges = part.points[part.boundaries[CUT]] if CUT in part.boundaries else np.empty((0, 2, 2))
        along = np.linspace(0, 1, 11)[:, None, None]
        edge = (edges[:, 0] + along * (edges[:, 1] - edges[:, 0])).reshape(-1, 2)
        return Cut(np.zeros(2), box, edge, middle.tobytes(), {})

    def mesh(self, cut: Cut, actuators: FloatArray) -> tuple[PlateMesh, dict[str, str], list[int]]:
        """A patch's mesh around its origin, its supports, and the rows of its points at singular corners.

        actuators: (n, 2) m from the origin, for which the cells at the plate's rim are graded.
        """
        if not cut.sides:
            part = self._part(cut.box)
            corners = [c for c in self.corners if (part.points == c.point).all(axis=1).any()]
            return part, self._supports(part), corner_rows(part, corners)
        width, height = cut.box[1] - cut.box[0]
        plain = rectangle(width, height, self.cell)
        boundaries: dict[str, list] = {}
        for side, name in cut.sides.items():
            boundaries.setdefault(name, []).append(plain.boundaries[side])
        outline = self.plate.outline
        shift = cut.origin
        moved = Outline(outline.conics - np.array([*shift, 0.0, 0.0]), outline.edges - shift)
        mesh = PlateMesh(
            plain.points + cut.box.mean(axis=0),
            plain.triangles,
            {name: np.concatenate(edges) for name, edges in boundaries.items()},
            {},
            moved,
        )
        corners = [replace(c, point=c.point - shift) for c in self._corners_in(cut.box + shift)]
        touches = set(cut.sides.values()) != {CUT}
        mesh = grade_mesh(mesh, self.fine, corners, actuators if touches else None)
        return mesh, self._supports(mesh), corner_rows(mesh, corners)

    def _supports(self, mesh: PlateMesh) -> dict[str, str]:
        return {name: self.supports.get(name, CLAMPED) for name in mesh.boundaries}

    def _corners_in(self, box: FloatArray) -> list[SingularCorner]:
        slack = 1e-6 * self.cell
        return [c for c in self.corners if ((c.point > box[0] - slack) & (c.point < box[1] + slack)).all()]

    def _inside(self, box: FloatArray) -> bool:
        """Whether the rim stays clear of a box."""
        count = np.ceil((box[1] - box[0]) / self.cell).astype(int) + 1
        x, y = (np.linspace(box[0, axis], box[1, axis], count[axis]) for axis in range(2))
        grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        return bool(np.all(self.plate.outline.gap(grid) > self.cell))

    def _edge(self, box: FloatArray, names: Mapping[str, str]) -> FloatArray:
        points = [np.empty((0, 2))]
        for side, (row, axis) in SIDES.items():
            if names[side] == CUT:
                start, end = box[:, 1 - axis]
                other = np.linspace(start, end, math.ceil(4 * (end - start) / self.cell) + 1)
                here = np.full_like(other, box[row, axis])
                points.append(np.stack([here, other] if axis == 0 else [other, here], axis=1))
        return np.concatenate(points)

    def _part(self, box: FloatArray) -> PlateMesh:
        # Every triangle that may reach into the box, so that the part holds all actuators there.
        corners = self._fine_mesh.points[self._fine_mesh.triangles]
        return self._fine_mesh.part(((corners.max(axis=1) > box[0]) & (corners.min(axis=1) < box[1])).all(axis=1))

    @cached_property
    def _fine_mesh(self) -> PlateMesh:
        """The plate's mesh with cells as small as patches need."""
        mesh, tree = self.plate, cKDTree(self.points)
        while True:
            centre = mesh.points[mesh.triangles].mean(axis=1)
            distance, _ = tree.query(centre)
            large = mesh.cell_sizes > np.maximum(1.5 * self.cell, distance / 2)
            if not large.any():
                break
            mesh = mesh.refined(large)
        return grade_mesh(mesh, self.fine, self.corners, self.points)


def _without_cuts(mesh: PlateMesh, supports: Mapping[str, str]) -> tuple[PlateMesh, dict[str, str]]:
    """The plate and its supports, with boundaries renamed that are called as cuts are."""
    names = {name: name + "'" if name.startswith(CUT) else name for name in mesh.boundaries}
    boundaries = {names[name]: edges for name, edges in mesh.boundaries.items()}
    curves = {names[name]: curve for name, curve in mesh.curves.items()}
    renamed = replace(mesh, boundaries=boundaries, curves=curves)
    return renamed, {names[name]: support for name, support in supports.items()}


def _rectangle_sides(mesh: PlateMesh) -> dict[str, str]:
    """The boundary on each side of a plate that is a rectangle along x and y; empty for any other plate."""
    outline, box = mesh.outline, mesh.outline.box
    if len(outline.conics) or len(outline.edges) != 4:
        return {}
    sides: dict[str, str] = {}
    for name, pairs in mesh.boundaries.items():
        ends = mesh.points[pairs]
        for side, (row, axis) in SIDES.items():
            on = (np.abs(ends[..., axis] - box[row, axis]) < 1e-9 * mesh.size).all(axis=1)
            if on.any():
                if side in sides:
                    return {}
                sides[side] = name
    straight = np.abs(outline.edges - box[0]) < 1e-9 * mesh.size
    opposite = np.abs(outline.edges - box[1]) < 1e-9 * mesh.size
    along = (straight | opposite).all(axis=1).any(axis=1)
    return sides if len(sides) == 4 and along.all() else {}
