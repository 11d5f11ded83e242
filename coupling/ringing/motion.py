"""A plate that stretches and has mass, over time: its ringing from breakpoint to breakpoint, as drives of its modes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coupling.ringing.forces import Ringing, new_bench
from coupling.ringing.march import march
from coupling.ringing.pieces import lay_steps
from coupling.stretch import FINE, Corrections, Schedule, schedule_of
from coupling.vibration import enter_jump
from particle import AnyDrive
from particle.drives import ORDER, drive_piece, drive_table, quintic_drives
from particle.events import tableau

FloatArray = NDArray[np.float64]

RADIANS = 2.0  # of the fastest mode in a step, at first
STEP_ERROR = 1e-9  # of the largest coordinate
SETTLED = 1e-6  # of the largest acceleration: what all later passes still change
LEAST_LOST = 1e-2  # of a mode's ringing, in a pass
BLOCK = 512  # steps that are laid together
MOST_STEPS = 4096  # whose nodes are held at a time, if they are not halved
MAX_HALVINGS = 6  # of the steps
MAX_PASSES = 200  # to a steady state
MAX_PIECES = 20_000_000  # of all shapes: about 2 GB


@dataclass
class _State:
    """Where the modes are, and the drives before a breakpoint."""

    q: FloatArray  # (a,) m
    q_t: FloatArray  # (a,) m/s
    before: FloatArray  # (N, 2) m and m/s


def ringing_corrections(
    ringing: Ringing,
    drives: Sequence[AnyDrive],
    end: float,
    start: tuple[FloatArray, FloatArray],
    limits: FloatArray,
    steady: bool = False,
    tell: Callable[[float], None] = lambda share: None,
) -> Corrections:
    """How modes and in-plane motions go on under drives, up to an end [s].

    start: q (a,) [m] and q' (a,) [m/s] of the modes that ring, before the first breakpoint.
    limits: (a + n + M,) m/s^2, what accelerations may be off by.
    steady: whether to begin with the pass that repeats.
    tell: takes the share of the time that is done.
    Raises ValueError where the plate finds no equilibrium, where it takes too many pieces, and with `steady` when the
    motion does not come to repeat with the drives.
    """
    walker = _Walker(ringing, drives, limits)
    state = _State(start[0].copy(), start[1].copy(), _heights_before(drives, steady))
    schedule = schedule_of(drives, math.inf if steady else end)
    walker.settle(schedule, end, state, steady, tell)
    return walker.corrections()


def _heights_before(drives: Sequence[AnyDrive], steady: bool) -> FloatArray:
    """(N, 2) m and m/s: at rest, or as they have been going."""
    values = [drive.evaluate(0.0) for drive in drives]
    return np.array([[float(h), float(v) if steady else 0.0] for h, v, _ in values])


@dataclass
class _Mark:
    """The modes at a breakpoint of the last pass, and how many rows of pieces came before."""

    q: FloatArray
    q_t: FloatArray
    rows: int


class _Walker:
    """Walks from breakpoint to breakpoint and keeps the pieces."""

    def __init__(self, ringing: Ringing, drives: Sequence[AnyDrive], limits: FloatArray) -> None:
        self._ringing, self._drives, self._limits = ringing, drives, limits
        self._bench, self._pair, self._table = new_bench(ringing), tableau(8), drive_table(drives)
        self._edges: list[FloatArray] = [np.zeros(1)]
        self._rows: list[FloatArray] = []
        self._largest = np.zeros((2, len(limits)))  # of values and accelerations
        self._over, self._loop, self._steps = 0.0, -1, 0
        self._fastest, self._marks = math.sqrt(float(ringing.square.max())), dict[int, _Mark]()

    def settle(
        self, schedule: Schedule, end: float, state: _State, steady: bool, tell: Callable[[float], None]
    ) -> None:
        """Walk to the end, or until the motion repeats with the drives."""
        edges, loop = schedule.edges, schedule.loop
        if loop < 0:
            if steady:
                raise ValueError(
                    'Input start must be "rest" for a stretching plate whose drives have no common period; give them '
                    "frequencies in a ratio of small whole numbers"
                )
            self._walk(np.append(edges, end) if edges[-1] < end else edges, state, end, tell)
            return
        self._walk(edges[: loop + 1], state, end, tell)
        cycle, places, passed = edges[loop:], len(edges) - 1 - loop, 0
        period = float(cycle[-1] - cycle[0])
        while steady or self._edges[-1][-1] < end:
            passes, place = divmod(passed, places)
            now = _Mark(state.q.copy(), state.q_t.copy(), len(self._rows))
            if passes > 0 and (place == 0 or not steady) and self._is_settled(self._marks[place], now, period):
                self._loop = self._marks[place].rows
                break
            if steady and place == 0:
                if passes == MAX_PASSES:
                    raise ValueError(
                        f'Input start must not be "steady" here: after {MAX_PASSES} common periods of the drives the '
                        "plate still does something else in each; give it more damping"
                    )
                self._edges, self._rows, self._over = [cycle[:1] + passes * period], [], 0.0  # what led there
                now.rows = 0
            self._marks[place] = now
            self._walk(cycle[place : place + 2] + passes * period, state, end, tell)
            passed += 1

    def _walk(self, edges: FloatArray, state: _State, end: float, tell: Callable[[float], None]) -> None:
        for begin, until in zip(edges[:-1], edges[1:], strict=True):
            self._jump(begin, until, state)
            parts = math.ceil((until - begin) * self._fastest / RADIANS / MOST_STEPS)
            for first, last in pairwise(np.linspace(begin, until, parts + 1).tolist()):
                self._cross(first, last, state)
                tell(min(last / end, 1.0))

    def _jump(self, begin: float, until: float, state: _State) -> None:
        """What the heights' and velocities' jumps make of the modes: the plate's mass does not jump."""
        half, piece, jump = 0.5 * (until - begin), np.zeros(ORDER), np.zeros(2)
        for i in range(len(self._drives)):
            drive_piece(self._table, i, begin + half, half, piece)
            enter_jump(piece, half, state.before[i], jump)
            state.q -= self._ringing.participation[:, i] * jump[0]
            state.q_t -= self._ringing.participation[:, i] * jump[1]

    def _cross(self, begin: float, until: float, state: _State) -> None:
        """Walk between two breakpoints [s], in steps fine enough for both motion and pieces."""
        width, steps = len(self._limits), 2 * math.ceil((until - begin) * self._fastest / RADIANS / 2)
        for _ in range(MAX_HALVINGS):
            nodes = np.zeros((steps + 1, 3, width))
            q, q_t = state.q.copy(), state.q_t.copy()
            outcome, error = march(self._ringing, self._bench, self._pair, self._table, begin, until, q, q_t, nodes)
            if outcome == FINE and error <= STEP_ERROR * max(np.abs(nodes[:, 0]).max(), self._largest[0].max()):
                lengths, rows = np.zeros(steps, dtype=np.int64), np.zeros((steps, width, ORDER))
                h = (until - begin) / steps
                laid, over = lay_steps(nodes, h, self._limits, BLOCK, lengths, rows)
                if over <= 1.0:
                    break
            steps *= 2
        else:
            raise ValueError(
                f"The ringing of the stretching plate cannot be followed at {begin:g} s; reduce the strokes"
            )
        state.q, state.q_t = q, q_t
        edges = np.asarray(begin + h * np.cumsum(lengths[:laid]), dtype=float)
        self._keep(edges, until, rows[:laid], nodes, over)

    def _keep(self, edges: FloatArray, until: float, rows: FloatArray, nodes: FloatArray, over: float) -> None:
        edges[-1] = until
        self._edges.append(edges)
        self._rows.append(rows)
        for k, order in enumerate((0, 2)):
            self._largest[k] = np.maximum(self._largest[k], np.abs(nodes[:, order]).max(axis=0))
        self._over = max(self._over, over)
        self._steps += len(nodes) - 1
        if (pieces := sum(map(len, self._rows))) * len(self._limits) > MAX_PIECES:
            raise ValueError(
                f"The plate's ringing takes more than {pieces} pieces in time for each of {len(self._limits)} shapes, "
                f"{MAX_PIECES} in all; raise plate.damping, reduce run.duration, or give drives frequencies with a "
                "common period"
            )

    def _is_settled(self, begun: _Mark, now: _Mark, period: float) -> bool:
        """Whether a period ended as it began, as will all later ones together."""
        omega = np.sqrt(self._ringing.square)
        change = omega**2 * np.abs(now.q - begun.q) + omega * np.abs(now.q_t - begun.q_t)
        lost = np.maximum(-np.expm1(-0.5 * self._ringing.drag * period), LEAST_LOST)
        return bool((change / lost).max() <= SETTLED * self._largest[1, : len(omega)].max())

    def corrections(self) -> Corrections:
        """The pieces as drives."""
        ringing, edges = self._ringing, np.concatenate(self._edges)
        edges = edges - edges[0]
        rows = np.ascontiguousarray(np.concatenate(self._rows).transpose(1, 0, 2))
        modes = len(ringing.square) + len(ringing.forms.load)
        loop = None if self._loop < 0 else sum(map(len, self._rows[: self._loop]))
        swing = math.pi / self._fastest
        found = quintic_drives(
            edges,
            rows,
            loop,
            min(swing, *(drive.stroke_time for drive in self._drives)),
            max(drive.frequency for drive in self._drives),
            np.zeros(len(rows)),
        )
        return Corrections(
            drives=found[:modes],
            in_plane=found[modes:],
            error=self._over,
            acceleration_error=self._over,
            in_plane_error=0.0,
            pieces=len(edges) - 1,
            equilibria=13 * self._steps,
            period=None if loop is None else float(edges[-1] - edges[loop]),
        )
