"""The moments at which a page shows its run: stored steps, and between them the events, each at its own time."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray, IntArray
from coupling.pictures import samples_of
from coupling.results import SavedRun

MAX_MOMENTS: Final = 1000  # of a page; of more steps, as many evenly spread as leave room for the events
MAX_EVENTS: Final = 300  # that are shown
NEIGHBOURS: Final = 4  # stored steps, through which heights at an event are a cubic in time
BATCH: Final = 64  # moments whose steps are read together


class Moments(NamedTuple):
    """The part at k moments, and which steps give the surface there."""

    time: FloatArray  # (k,) s
    position: FloatArray  # (k, 3) m
    velocity: FloatArray  # (k, 2) m/s
    state: IntArray  # (k,)
    heading: FloatArray | None  # (k,) rad, of a part with a face
    normal_force: FloatArray  # (k,) N
    friction_force: FloatArray  # (k,) N
    at_event: BoolArray  # (k,) whether it lies between the steps
    steps: IntArray  # (k, NEIGHBOURS) of the run
    weights: FloatArray  # (k, NEIGHBOURS) of the surfaces at these


def moments_of(run: SavedRun) -> Moments:
    """The moments of a run; at an event the part is as the integrator's row has it."""
    times = np.array([event.time for event in run.events[:MAX_EVENTS]])
    times = np.unique(times[(times < run.time[-1]) & ~np.isin(times, run.time)])
    room = max(MAX_MOMENTS - len(times), 2)
    steps = np.unique(np.linspace(0, len(run.time) - 1, min(len(run.time), room)).astype(np.int64))
    rows = np.searchsorted(run.rows.time, times, side="right") - 1  # the last of a moment is that after the event
    order = np.argsort(np.concatenate([run.time[steps], times]), kind="stable")
    around, weights = _around(run.time, times)

    def both(stored: FloatArray | IntArray, found: FloatArray | IntArray) -> FloatArray:
        return np.concatenate([stored[steps], found[rows]])[order]

    alone = np.zeros((len(steps), NEIGHBOURS))
    alone[:, 0] = 1.0
    return Moments(
        time=np.concatenate([run.time[steps], times])[order],
        position=both(run.position, np.column_stack([run.rows.position, run.rows.height])),
        velocity=both(run.velocity[:, :2], run.rows.velocity),
        state=both(run.state, run.rows.state).astype(np.int64),
        heading=None if run.heading is None or run.rows.heading is None else both(run.heading, run.rows.heading),
        normal_force=both(run.normal_force, run.rows.normal_force),
        friction_force=both(run.friction_force, run.rows.friction_force),
        at_event=order >= len(steps),
        steps=np.concatenate([np.repeat(steps[:, None], NEIGHBOURS, axis=1), around])[order],
        weights=np.concatenate([alone, weights])[order],
    )


def beside(run: SavedRun, moments: Moments) -> Moments:
    """The same moments with place, state and heading of another part over the same surface."""
    known, rows = samples_of(run), run.rows
    x, y, z = (np.interp(moments.time, known.time, values) for values in (*known.position.T, known.height))
    return moments._replace(
        position=np.column_stack([x, y, z]),
        state=known.state[np.searchsorted(known.time, moments.time, side="right") - 1],
        heading=None if rows.heading is None else np.interp(moments.time, rows.time, rows.heading),
    )


def heights_at(run: SavedRun, moments: Moments, points: IntArray) -> FloatArray:
    """The deflections (k, n) [m] of points at the moments."""
    heights = np.empty((len(moments.time), len(points)))
    for start in range(0, len(heights), BATCH):
        some = slice(start, start + BATCH)
        steps, places = np.unique(moments.steps[some], return_inverse=True)
        stored = run.plate_field("deflection", steps)[:, points]
        mixing = np.zeros((len(heights[some]), len(steps)))
        np.add.at(mixing, (np.arange(len(mixing))[:, None], places.reshape(len(mixing), -1)), moments.weights[some])
        heights[some] = mixing @ stored
    return heights


def _around(stored: FloatArray, times: FloatArray) -> tuple[IntArray, FloatArray]:
    """The steps (k, NEIGHBOURS) around each time, and the weights of Lagrange's polynomial through these."""
    count = min(NEIGHBOURS, len(stored))
    first = np.clip(np.searchsorted(stored, times) - count // 2, 0, len(stored) - count)
    steps = np.minimum(first[:, None] + np.arange(NEIGHBOURS), len(stored) - 1)
    weights = np.zeros(steps.shape)
    nodes = stored[steps]
    for k in range(count):
        others = [j for j in range(count) if j != k]
        weights[:, k] = np.prod([(times - nodes[:, j]) / (nodes[:, k] - nodes[:, j]) for j in others], axis=0)
    return steps, weights
