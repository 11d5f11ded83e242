"""SurfaceMotion: the moving surface w(x, y, t) = sum_i h_i(t) phi_i(x, y), and its record of arrays for kernels.

Each h_i is a drive: one quintic in time between two breakpoints. Each phi_i is the shape of one actuator, or a further
one: on a cell of a background grid one polynomial, and the logarithms r^2 ln(r) around the actuators close by. So a
cell's whole smooth part is one polynomial in x, y, t. A mid-plane that stretches also moves in its plane, by
u(x, y, t) = sum_m g_m(t) U_m(x, y) with drives g_m and polynomials U_m on the same cells; (x, y) is a material point.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Sized
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from particle.drives import AnyDrive, DriveTable, accelerations, drive_table, scaled_table
from particle.surface.at_point import POINT_SIZE, SurfacePoint, sample_surface
from particle.surface.cells import NOWHERE, CellStore
from particle.surface.local import new_local
from particle.surface.record import Surface
from particle.types import FloatArray


class SurfaceState(NamedTuple):
    """The surface at points (n, 2) and one time."""

    w: FloatArray  # (n,) m
    w_t: FloatArray  # (n,) m/s
    w_tt: FloatArray  # (n,) m/s^2
    gradient: FloatArray  # (n, 2)
    gradient_t: FloatArray  # (n, 2) 1/s
    hessian: FloatArray  # (n, 2, 2) 1/m
    gradient_tt: FloatArray  # (n, 2) 1/s^2
    u: FloatArray  # (n, 2) m, the mid-plane's motion in its plane, its base's excluded
    u_t: FloatArray  # (n, 2) m/s
    u_tt: FloatArray  # (n, 2) m/s^2


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceMotion:
    """A moving surface; made by `coupling.surface_motion`, `platform_surface` or `polynomial_surface`."""

    drives: DriveTable  # of its shapes, actuators first, of its shapes in the plane, and of its base where that moves
    store: CellStore  # its cells; those of a large plate are built where a part comes to
    sources: FloatArray  # (J, 2) m, the centres of the logarithms
    size: float  # m, that tolerances refer to
    floor: float = 0.0  # m, radius below which the Hessian of a logarithm grows no more
    overhang: float = math.inf  # a cell's polynomials hold out to this many half widths
    conics: FloatArray = field(default_factory=lambda: np.zeros((0, 4)))  # (k, 4) m, as in `Outline`
    edges: FloatArray = field(default_factory=lambda: np.zeros((0, 3, 2)))  # (m, 3, 2) m, as in `Outline`
    moving_base: bool = False  # whether two more drives carry the base in its plane
    half_thickness: float = 0.0  # m, height over the mid-plane of the face that parts lie on
    in_plane_count: int = 0  # how many drives move the mid-plane in its plane, each its own shape
    turning_base: bool = False  # whether a third drive of the base turns it about the origin [rad]

    @property
    def record(self) -> Surface:
        """The surface for kernels, with the cells that are built so far."""
        return Surface(
            drives=self.drives,
            cells=self.store.cells,
            shape_count=self.shape_count,
            in_plane_count=self.in_plane_count,
            sources=self.sources,
            size=self.size,
            floor=self.floor,
            overhang=self.overhang,
            conics=self.conics,
            edges=self.edges,
            base_drives=self.base_drives,
            unit=float(self.stroke_times.min(initial=1.0)),
        )

    def __repr__(self) -> str:
        cells = int((self.store.cells.cell["first_row"] != NOWHERE).sum())
        error = f"{self.error:.1e}" if cells else "not measured"
        return f"<SurfaceMotion: drives {len(self.drives.delay)}, cells built {cells}, error {error}>"

    @property
    def stroke_times(self) -> FloatArray:
        """The shortest strokes [s] of its actuators and of its base; of all its drives where none of these has one.

        Further shapes, and those in the plane, follow from the strokes of the actuators, which come first.
        """
        times = self.drives.stroke_time
        own = times[: len(self.sources) or self.shape_count]
        strokes = np.concatenate([own, times[len(times) - self.base_drives :]])
        if not np.isfinite(strokes).any():
            strokes = times
        return strokes[np.isfinite(strokes)]

    @property
    def tilts(self) -> bool:
        """Whether it can be anything but level."""
        return bool(self.store.cells.grid[0].highest > 0) or len(self.sources) > 0

    @property
    def base_drives(self) -> int:
        """How many drives move its base."""
        return 2 * self.moving_base + self.turning_base

    @property
    def shape_count(self) -> int:
        """How many drives move shapes up and down."""
        return len(self.drives.delay) - self.in_plane_count - self.base_drives

    @property
    def error(self) -> float:
        """The largest error measured in its cells, relative to each shape's height at its own actuator."""
        return self.store.error

    def driven_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives, sharing its cells.

        Parameters
        ----------
        drives : sequence of drives
            One for each shape: for each actuator, unless the surface has more.
        in_plane_drives : sequence of drives
            One for each shape in the plane.

        Returns
        -------
        surface : SurfaceMotion
            The surface.

        Raises
        ------
        ValueError
            There is not one drive for each shape, or the surface is on a moving base, such as a platform.
        """
        wrong = self.drive_faults({"drives": drives}, {"in_plane_drives": in_plane_drives})
        if wrong:
            raise ValueError("; ".join(wrong))
        return replace(self, drives=drive_table([*drives, *in_plane_drives]))

    def scaled(self, factor: float, stroke: float = 1.0) -> SurfaceMotion:
        """The surface as it moves under drives `factor` times as fast over `stroke` times their heights.

        All its drives run as many times as fast, those of its base too, delays included, as they do on a plate that
        follows its actuators at once. With a plate that stretches the stroke must stay 1; one with inertia takes other
        drives for its modes (`coupling.shared_surface`).
        """
        return replace(self, drives=scaled_table(self.drives, factor, stroke))

    def drive_faults(
        self, given: Mapping[str, Sequence[AnyDrive]], in_plane: Mapping[str, Sequence[AnyDrive]] | None = None
    ) -> list[str]:
        """What is wrong with drives that are to replace its own; given, in_plane: by the name of the input.

        in_plane: for the shapes in the plane; None: there are none.
        """
        if self.moving_base and given:
            return [
                f"Input {next(iter(given))} must stay the surface's own: the drives of a platform, or of another "
                "surface on a moving base, cannot be exchanged; make a surface with the drives wanted"
            ]
        if in_plane is None and self.in_plane_count and given:
            return [
                f"Input {next(iter(given))} must stay the surface's own, as its mid-plane moves in its plane by drives "
                "that follow from them; make a surface with driven_by(drives, in_plane_drives)"
            ]
        kind = "shape" if 0 < len(self.sources) != self.shape_count else "actuator"
        wrong = _miscounts(given, self.shape_count, kind)
        return wrong + _miscounts(in_plane or {}, self.in_plane_count, "shape in the plane")

    def evaluate(self, xy: ArrayLike, time: float) -> SurfaceState:
        """The surface at points and one time.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.
        time : float
            Time, s.

        Returns
        -------
        state : SurfaceState
            Height, velocity, slopes and curvatures at the material points `xy`, and their motion in the plane.

        Raises
        ------
        ValueError
            A point lies beyond the rim, or the time is not finite.
        """
        if not math.isfinite(time):
            raise ValueError(f"Input time of evaluate must be a finite number of seconds; got {time}")
        xy = np.atleast_2d(np.asarray(xy, dtype=float))
        return self.evaluate_along(xy, np.full(len(xy), float(time)))

    def evaluate_along(self, xy: FloatArray, times: FloatArray) -> SurfaceState:
        """The surface at points (n, 2) [m], each at a time (n,) [s] of its own; raises as `evaluate` does."""
        rows = self.samples(xy, times)
        if np.isnan(rows).any():
            beyond = xy[np.isnan(rows).any(axis=1)][0].tolist()
            raise ValueError(f"Input xy of evaluate must lie on the surface; got {beyond} m")
        f: Any = SurfacePoint(*rows.T[:POINT_SIZE])  # of arrays (n,)
        u, v = rows.T[POINT_SIZE:].reshape(2, 5, -1)

        def pair(x: FloatArray, y: FloatArray) -> FloatArray:
            return np.stack([x, y], axis=-1)

        # The derivatives of w itself, from those that hold (-g, 1).P: grad w = F^T g, w_pq = f.w_pq + g.u_pq.
        gradient = pair(f.x_x * f.w_x + f.y_x * f.w_y, f.x_y * f.w_x + f.y_y * f.w_y)
        gradient_t = pair(f.w_xt + f.w_x * f.x_xt + f.w_y * f.y_xt, f.w_yt + f.w_x * f.x_yt + f.w_y * f.y_yt)
        gradient_tt = pair(f.w_xtt + f.w_x * u[3] + f.w_y * v[3], f.w_ytt + f.w_x * u[4] + f.w_y * v[4])
        w_xx, w_xy = f.w_xx + f.w_x * f.x_xx + f.w_y * f.y_xx, f.w_xy + f.w_x * f.x_xy + f.w_y * f.y_xy
        w_yy = f.w_yy + f.w_x * f.x_yy + f.w_y * f.y_yy
        hessian = np.stack([pair(w_xx, w_xy), pair(w_xy, w_yy)], axis=-2)
        moved = pair(u[0], v[0]), pair(u[1], v[1]), pair(u[2], v[2])
        return SurfaceState(f.w, f.w_t, f.w_tt, gradient, gradient_t, hessian, gradient_tt, *moved)

    def samples(self, xy: FloatArray, times: FloatArray) -> FloatArray:
        """The rows (n, 49) of `sample_surface` at points (n, 2) [m] and times (n,) [s]; cells are built as needed."""
        rows, missing = sample_surface(self.record, new_local(self.record), xy, times)
        if missing.any():
            self.store.build(xy[missing])
            rows, _ = sample_surface(self.record, new_local(self.record), xy, times)
        return rows

    def base_acceleration(self, time: float) -> FloatArray:
        """The acceleration (2,) [m/s^2] of its base along x and y at a time [s]; zero where it does not move."""
        if not self.moving_base:
            return np.zeros(2)
        return accelerations(self.drives, time)[-self.base_drives :][:2]


def _miscounts(given: Mapping[str, Sequence[AnyDrive]], count: int, kind: str) -> list[str]:
    """What is wrong where there is not one drive for each of so many."""
    sizes = {name: len(row) if isinstance(row, Sized) else repr(row) for name, row in given.items()}
    one = "one an actuator" if kind == "actuator" else f"one a {kind}"
    return [f"Input {name} must be {one}, {count}; got {n}" for name, n in sizes.items() if n != count]
