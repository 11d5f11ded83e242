"""Scratch memory and result of one Runge-Kutta step."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Counts, Motion, as_numbers
from particle.events.tableau import Pairs
from particle.jit import jit_no_arrays
from particle.records import Record, new_records
from particle.surface import LocalSurface, SurfacePoint, surface_at
from particle.types import FloatArray


class Seen(Record):
    """The start of a step: its distance from the rim, and the surface where the step before ended."""

    gap: float  # m
    time: float  # s, for which the rest holds
    x: float  # m
    y: float  # m
    cell: int
    w: float
    w_t: float
    w_tt: float
    w_x: float
    w_y: float
    w_xt: float
    w_yt: float
    w_xx: float
    w_xy: float
    w_yy: float
    w_xtt: float
    w_ytt: float
    w_xxt: float
    w_xyt: float
    w_yyt: float
    w_xxx: float
    w_xxy: float
    w_xyy: float
    w_yyy: float
    base_px: float
    base_py: float
    base_vx: float
    base_vy: float
    base_ax: float
    base_ay: float
    x_x: float
    x_y: float
    y_x: float
    y_y: float
    x_xt: float
    x_yt: float
    y_xt: float
    y_yt: float
    x_xx: float
    x_xy: float
    x_yy: float
    y_xx: float
    y_xy: float
    y_yy: float


class Step(NamedTuple):
    """Scratch memory and result of a step. Names with `_numbers` are the same memory without names."""

    rates: NDArray[Motion]  # (stages + 1,)
    rate_numbers: FloatArray  # (stages + 1, SIZE)
    stage: NDArray[Motion]  # (1,)
    stage_numbers: FloatArray  # (1, SIZE)
    end: NDArray[Motion]  # (1,)
    plane: NDArray[Motion]  # (1,) the motion at the start, its velocity in the plane's coordinates
    loads: FloatArray  # (stages + 1,) N, normal force at each stage
    margins: FloatArray  # (stages + 1,) how far each stage is from the end of contact
    seen: NDArray[Seen]  # (1,)


def new_step(pairs: Pairs) -> Step:
    stages = len(pairs.long.c)
    rates, stage, seen = new_records(Motion, stages), new_records(Motion), new_records(Seen)
    seen[0].time = math.nan
    return Step(
        rates=rates,
        rate_numbers=as_numbers(rates),
        stage=stage,
        stage_numbers=as_numbers(stage),
        end=new_records(Motion),
        plane=new_records(Motion),
        loads=np.zeros(stages),
        margins=np.zeros(stages),
        seen=seen,
    )


@jit_no_arrays
def surface_at_start(local: LocalSurface, step: Step, counts: Counts, time: float, motion: Motion) -> SurfacePoint:
    """The surface where a step starts; the step before may have evaluated it at its end."""
    s: Seen = step.seen[0]
    if s.time == time and s.x == motion.x and s.y == motion.y and s.cell == local.frame[0].cell:
        return SurfacePoint(
            *(s.w, s.w_t, s.w_tt, s.w_x, s.w_y, s.w_xt, s.w_yt, s.w_xx, s.w_xy, s.w_yy, s.w_xtt, s.w_ytt),
            *(s.w_xxt, s.w_xyt, s.w_yyt, s.w_xxx, s.w_xxy, s.w_xyy, s.w_yyy),
            *(s.base_px, s.base_py, s.base_vx, s.base_vy, s.base_ax, s.base_ay),
            *(s.x_x, s.x_y, s.y_x, s.y_y, s.x_xt, s.x_yt, s.y_xt, s.y_yt),
            *(s.x_xx, s.x_xy, s.x_yy, s.y_xx, s.y_xy, s.y_yy),
        )
    counts.evaluations += 1
    return surface_at(local, motion.x, motion.y, time)


@jit_no_arrays
def keep_surface(local: LocalSurface, step: Step, time: float, f: SurfacePoint) -> None:
    """Keep the surface at the end of a step that ends at a time [s]."""
    s: Seen = step.seen[0]
    s.time, s.x, s.y, s.cell = time, step.stage[0].x, step.stage[0].y, local.frame[0].cell
    s.w, s.w_t, s.w_tt, s.w_x, s.w_y, s.w_xt, s.w_yt = f.w, f.w_t, f.w_tt, f.w_x, f.w_y, f.w_xt, f.w_yt
    s.w_xx, s.w_xy, s.w_yy, s.base_px, s.base_py = f.w_xx, f.w_xy, f.w_yy, f.base_px, f.base_py
    s.w_xtt, s.w_ytt, s.w_xxt, s.w_xyt, s.w_yyt = f.w_xtt, f.w_ytt, f.w_xxt, f.w_xyt, f.w_yyt
    s.w_xxx, s.w_xxy, s.w_xyy, s.w_yyy = f.w_xxx, f.w_xxy, f.w_xyy, f.w_yyy
    s.base_vx, s.base_vy, s.base_ax, s.base_ay = f.base_vx, f.base_vy, f.base_ax, f.base_ay
    s.x_x, s.x_y, s.y_x, s.y_y, s.x_xt, s.x_yt, s.y_xt, s.y_yt = (
        f.x_x,
        f.x_y,
        f.y_x,
        f.y_y,
        f.x_xt,
        f.x_yt,
        f.y_xt,
        f.y_yt,
    )
    s.x_xx, s.x_xy, s.x_yy, s.y_xx, s.y_xy, s.y_yy = f.x_xx, f.x_xy, f.x_yy, f.y_xx, f.y_xy, f.y_yy
