"""Losses: what becomes of parts around one actuator, and what pulls them off, term by term of the normal force."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.paper.models import Bench
from active_surface.paper.path import Path

FREQUENCIES: Final = (300.0, 450.0, 600.0)  # Hz
NEAREST, FARTHEST = 40e-6, 160e-6  # m from the actuator: parts at rest, as of figure 18


class Losses(NamedTuple):
    """Parts around one actuator. Accelerations [m/s^2] are medians as parts come off; negative ones pull."""

    name: str
    frequency: float  # Hz
    parts: int
    converge: int
    leave: int  # get far away, or over the rim
    off: int
    distance: float  # m from the actuator, the median
    speed: float  # m/s, the median
    stroke: float  # w_tt and gravity
    turning: float  # 2 v.grad w_t
    corner: float  # v.H v
    height: float  # what face and part are over the mid-plane, and steep slopes
    by_corner: float  # share of losses that would not be, but for v.H v
    by_stroke: float  # share of losses for which w_tt and gravity are enough


def losses_of(name: str, bench: Bench, model: str, starts: int) -> list[Losses]:
    """One row a frequency."""
    return [_losses(name, bench, model, frequency, starts) for frequency in FREQUENCIES]


def _losses(name: str, bench: Bench, model: str, frequency: float, starts: int) -> Losses:
    drive = bench.drive(frequency)
    duration = bench.duration(drive)
    places = np.column_stack([np.linspace(NEAREST, FARTHEST, starts), np.zeros(starts)])
    paths = bench.paths(model, [drive], places, duration)
    off = [path for path in paths if path.came_off]
    p = bench.parameters
    converge = sum(path.converged(1 / drive.frequency, p.near) for path in paths)
    leave = sum(not path.came_off and path.lost(p.far) for path in paths)
    if not off:
        nan = float("nan")
        return Losses(name, frequency, starts, converge, leave, 0, nan, nan, nan, nan, nan, nan, nan, nan)
    terms = normal_terms(bench, model, frequency, off)
    away, speed = np.array([path.off_at((0.0, 0.0)) for path in off]).T
    limit = -p.friction.pull_off / p.mass
    corner = terms.sum(axis=1) - terms[:, 2] > limit
    stroke = terms[:, 0] <= limit
    medians = np.median([away, speed, *terms.T], axis=1).tolist()
    return Losses(
        name, frequency, starts, converge, leave, len(off), *(*medians, float(corner.mean()), float(stroke.mean()))
    )


def normal_terms(bench: Bench, model: str, frequency: float, off: Sequence[Path]) -> FloatArray:
    """What makes the normal force over the mass as each part comes off: stroke, turning, corner and height, (n, 4)."""
    p = bench.parameters
    surface = bench.surface(model, [bench.drive(frequency)], bench.duration(bench.drive(frequency)))
    rows = []
    for path in off:
        last = path.trajectory.at([path.time[-1]])
        state = surface.evaluate(last.position, float(last.time[0]))
        v = last.velocity[0]
        known = [
            float(state.w_tt[0]) + p.gravity,
            2 * float(v @ state.gradient_t[0]),
            float(v @ state.hessian[0] @ v),
        ]
        rows.append([*known, float(last.normal_force[0]) / p.mass - sum(known)])
    return np.array(rows)
