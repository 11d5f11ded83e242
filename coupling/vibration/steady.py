"""Steady states: drives that have always been running, and how modes move under them when nothing else is left."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from common import quantity_text
from coupling.stretch import schedule_of
from coupling.vibration.oscillators import Course, Oscillators, follow
from particle import AnyDrive
from particle.drives import QuinticDrive, begun_at, drive_table

FloatArray = NDArray[np.float64]

MERGED = 1e-12  # of a period: a breakpoint that is its end
RESONANT = 1e-9  # of a mode's state: less of it that a period takes away is none


def always_running(drive: AnyDrive) -> AnyDrive:
    """The drive as if its pass had always been repeating: its delay shifts it in its period.

    Raises ValueError when it does not repeat without end.
    """
    pieces = drive.segments()
    if not pieces.coefficients[:, 1:].any():
        return drive  # it rests
    if math.isfinite(pieces.repeats):
        raise ValueError('Input start must not be "steady" with a drive that ends')
    since = drive.delay + pieces.lead_time
    if since == 0:
        return drive
    cycle = tuple(part[pieces.lead :] for part in pieces[:3])
    running = begun_at(-since / pieces.span % 1.0, (cycle[0], cycle[1], cycle[2]), math.inf)
    return QuinticDrive(running, drive.stroke_time, drive.frequency, drive.error)


def steady_state(oscillators: Oscillators, drives: Sequence[AnyDrive]) -> tuple[FloatArray, FloatArray]:
    """The modes' state (n, 2) [m, m/s] and that of the drives (N, 2) just before 0, under drives that always run.

    Raises ValueError when a mode without damping resonates.
    """
    state, before = np.zeros((len(oscillators.omega), 2)), np.zeros((len(drives), 2))
    for k, drive in enumerate(drives):
        if not drive.segments().coefficients[:, 1:].any():
            before[k, 0] = drive.evaluate(0.0)[0]
            continue
        own = oscillators._replace(participation=np.ascontiguousarray(oscillators.participation[:, k : k + 1]))
        response, before[k] = _of_one(own, drive)
        state += response
    return state, before


def _of_one(oscillators: Oscillators, drive: AnyDrive) -> tuple[FloatArray, FloatArray]:
    """The same under one drive that moves: its state after a period is that before it."""
    edges = _one_period(drive)
    n, table, last = len(oscillators.omega), drive_table([drive]), np.zeros((1, 2))
    course = Course(edges, np.zeros((len(edges) - 1, n, 4)), np.zeros((len(edges) - 1, n, 2)))
    follow(oscillators, table, course, last, np.zeros((n, 2)))
    added, before = np.zeros((n, 2)), last.copy()
    follow(oscillators, table, course, last, added)
    remaining = np.eye(2) - _over(oscillators, edges[-1] - edges[0])
    singular = np.linalg.svd(_in_lengths(remaining, oscillators.omega), compute_uv=False)[:, -1]
    if (stuck := singular < RESONANT).any():
        frequency = oscillators.omega[np.argmax(stuck)] / (2 * math.pi)
        raise ValueError(
            f'Input start must not be "steady" where a mode without damping resonates, as that of '
            f"{quantity_text(float(frequency), 'Hz', 6)} does; give it damping"
        )
    return np.asarray(np.linalg.solve(remaining, added[:, :, None])[:, :, 0]), before[0]


def _one_period(drive: AnyDrive) -> FloatArray:
    """Its breakpoints from 0 to its period [s], also where it begins within a pass."""
    schedule = schedule_of([drive], math.inf)
    edges, period = schedule.edges, drive.segments().span
    if schedule.loop == 0:
        return edges
    return np.append(edges[edges < period * (1 - MERGED)], period)


def _over(oscillators: Oscillators, time: float) -> FloatArray:
    """What a time [s] makes of free states [m, m/s]: matrices (n, 2, 2)."""
    omega, decay = oscillators.omega, oscillators.damping * oscillators.omega
    turn = omega * np.sqrt(1 - oscillators.damping**2)
    left, cosine, sine = np.exp(-decay * time), np.cos(turn * time), np.sin(turn * time) / turn
    rows = [[cosine + decay * sine, sine], [-(omega**2) * sine, cosine - decay * sine]]
    return np.asarray((left * np.array(rows)).transpose(2, 0, 1))


def _in_lengths(matrices: FloatArray, omega: FloatArray) -> FloatArray:
    """Matrices (n, 2, 2) of states in m and m/s for states in m, velocities over omega."""
    unit = np.stack([np.ones_like(omega), omega], axis=1)
    return np.asarray(matrices * unit[:, None, :] / unit[:, :, None])
