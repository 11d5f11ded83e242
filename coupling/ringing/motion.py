"""A plate that stretches and has mass, over time: its ringing from breakpoint to breakpoint, as drives of its modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from coupling.progress import doing
from coupling.ringing.forces import Ringing, driven_by_powers, new_bench, pieces_between
from coupling.ringing.march import lay_steps, march
from coupling.stretch import FINE, NOT_STABLE, Corrections, Schedule, schedule_of
from coupling.vibration import enter_jump
from particle import AnyDrive
from particle.drives import ORDER, drive_table, quintic_drives
from particle.events import tableau

FloatArray = NDArray[np.float64]

MAX_RADIANS = 1.0  # of the fastest mode in a step, at first
MAX_STEP_ERROR = 1e-9  # of the largest mode
MAX_CHANGE = 1e-6  # of the largest acceleration: what all later passes still change
MIN_LOSS = 1e-2  # of a mode's ringing, in a pass
MAX_BLOCK = 512  # steps that are laid together
MAX_STEPS = 4096  # whose nodes are kept at a time, if they are not made finer
STEP_ORDER, PIECE_ORDER = 6, 4  # of their errors, at least
SPARE = 1.02  # how much finer steps are than these ask for
MAX_FINER, MAX_REFINEMENTS = 2.0, 10  # each, of steps that are too long
MAX_PASSES = 200  # to a steady state; more where damping is low
MIN_DECAY = 40.0  # zeta omega t after which nothing is left of the start
MERGED = 1e-12  # of a period: a breakpoint that is its end
MIN_ACCELERATION = 1e-9  # of the largest acceleration: with all drives at rest, the plate rests, too
FEW_DRIVES = ORDER  # above so many the powers of time stand for drives
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
) -> tuple[Corrections, float]:
    """How modes, corrections and in-plane motions go on under drives, up to an end [s].

    start: q (a,) [m] and q' (a,) [m/s] of the modes that ring, before the first breakpoint.
    limits: (a + n + M,) m/s^2, of the errors of accelerations; the sum of errors over limits is at most 1.
    steady: whether to begin with the period that repeats.
    Returns the corrections, with that sum as their error, and the modes' largest acceleration [m/s^2].
    Raises ValueError where the plate finds no equilibrium, where it takes too many pieces, and with `steady` when the
    motion does not come to repeat with the drives.
    """
    walker = _Walker(ringing, drives, limits)
    state = _State(start[0].copy(), start[1].copy(), _heights_before(drives, steady))
    walker.settle(schedule_of(drives, math.inf if steady else end), end, state, steady)
    return walker.corrections(), walker.largest_acceleration


def _heights_before(drives: Sequence[AnyDrive], steady: bool) -> FloatArray:
    """(N, 2) heights and velocities: at rest, or as they have been going."""
    values = [drive.evaluate(0.0) for drive in drives]
    return np.array([[float(h), float(v) if steady else 0.0] for h, v, _ in values])


@dataclass
class _Mark:
    """The modes at a breakpoint of the last period, and how many rows of pieces and parts came before."""

    q: FloatArray
    q_t: FloatArray
    rows: int
    parts: int


class _Walker:
    """Walks from breakpoint to breakpoint and keeps the pieces."""

    def __init__(self, ringing: Ringing, drives: Sequence[AnyDrive], limits: FloatArray) -> None:
        self._ringing, self._drives, self._limits = ringing, drives, limits
        self._pair, self._table = tableau(8), drive_table(drives)
        self._many = len(drives) > FEW_DRIVES
        self._bench = new_bench(driven_by_powers(ringing, np.zeros((len(drives), ORDER))) if self._many else ringing)
        self._fastest, self._marks = math.sqrt(float(ringing.square.max())), dict[int, _Mark]()
        self._edges, self._rows, self._pieces = [np.zeros(1)], list[FloatArray](), 0
        self._largest = 0.0  # m, of a mode
        self._accelerations: list[float] = []  # m/s^2, the modes' largest in each part
        self._over, self._loop, self._steps, self._finer = 0.0, -1, 0, 1.0

    @property
    def largest_acceleration(self) -> float:
        """Of a mode, m/s^2."""
        return max(self._accelerations, default=0.0)

    def settle(self, schedule: Schedule, end: float, state: _State, steady: bool) -> None:
        """Walk to the end, or until the motion repeats with the drives."""
        edges, loop = schedule.edges, schedule.loop
        if steady and loop > 0:  # what has always been running repeats from 0 on
            period = float(edges[-1] - edges[loop])
            edges, loop = np.append(edges[edges < period * (1 - MERGED)], period), 0
        if loop < 0:
            if steady and self._moves():
                raise ValueError(
                    'Input start must be "rest" for a stretching plate whose drives have no common period; give them '
                    "frequencies in a ratio of small whole numbers"
                )
            self._walk(np.append(edges, end) if edges[-1] < end else edges, 0.0, state, end)
            return
        self._walk(edges[: loop + 1], 0.0, state, end)
        cycle, places, passed = edges[loop:], len(edges) - 1 - loop, 0
        period = float(cycle[-1] - cycle[0])
        while steady or self._edges[-1][-1] < end:
            passes, place = divmod(passed, places)
            now = _Mark(state.q.copy(), state.q_t.copy(), len(self._rows), len(self._accelerations))
            if passes > 0 and (place == 0 or not steady) and self._is_settled(self._marks[place], now, period):
                self._loop = self._marks[place].rows
                break
            if steady and place == 0:
                if passes >= self._most_passes(period):
                    raise ValueError(
                        f"The plate does not come to repeat with its drives within {passes} of their common periods, "
                        "so it has no steady state; raise plate.damping or reduce the strokes"
                    )
                self._edges, self._rows, self._pieces, self._over = [cycle[:1] + passes * period], [], 0, 0.0
                now.rows = 0
            self._marks[place] = now
            self._walk(cycle[place : place + 2], passes * period, state, end)
            passed += 1

    def _moves(self) -> bool:
        """Whether any drive moves."""
        return any(drive.segments().coefficients[:, 1:].any() for drive in self._drives)

    def _most_passes(self, period: float) -> int:
        """Periods [s] in which the start is forgotten, or so many that it never is."""
        decay = 0.5 * float(self._ringing.drag.min()) * period
        return max(MAX_PASSES, math.ceil(MIN_DECAY / decay)) if decay > 0 else MAX_PASSES

    def _walk(self, edges: FloatArray, shift: float, state: _State, end: float) -> None:
        """Walk over breakpoints [s] of the drives; what is kept is later by a shift [s]."""
        for begin, until in pairwise(edges.tolist()):
            self._jump(begin, until, state)
            parts = math.ceil((until - begin) * self._fastest / MAX_RADIANS / MAX_STEPS)
            at_rest = until == end and not pieces_between(self._table, begin, until)[:, 1:].any()
            for first, last in pairwise(np.linspace(begin, until, parts + 1).tolist()):
                self._cross(first, last, shift, state)
                doing("stretching plate: following its ringing", min((last + shift) / end, 1.0))
                if at_rest and self._accelerations[-1] <= MIN_ACCELERATION * self.largest_acceleration:
                    return

    def _jump(self, begin: float, until: float, state: _State) -> None:
        """What the heights' and velocities' jumps make of the modes: the plate's mass does not jump."""
        half, jump = 0.5 * (until - begin), np.zeros(2)
        for i, piece in enumerate(pieces_between(self._table, begin, until)):
            enter_jump(piece, half, state.before[i], jump)
            state.q -= self._ringing.participation[:, i] * jump[0]
            state.q_t -= self._ringing.participation[:, i] * jump[1]

    def _cross(self, begin: float, until: float, shift: float, state: _State) -> None:
        """Walk between two breakpoints [s], in steps fine enough for both motion and pieces."""
        width, own, guess = len(self._limits), len(state.q), self._bench.corrections.copy()
        ringing, pieces = self._ringing, pieces_between(self._table, begin, until)
        if self._many:
            ringing, pieces = driven_by_powers(ringing, pieces), np.eye(ORDER)
        at_first = (until - begin) * self._fastest / MAX_RADIANS
        for _ in range(MAX_REFINEMENTS):
            steps, finer = 2 * math.ceil(self._finer * at_first / 2), MAX_FINER
            nodes = np.zeros((steps + 1, 3, width))
            q, q_t = state.q.copy(), state.q_t.copy()
            self._bench.corrections[:] = guess  # steps that are too long may have led astray
            outcome, error = march(ringing, self._bench, self._pair, pieces, begin, until, q, q_t, nodes)
            largest = max(float(np.abs(nodes[:, 0, :own]).max()), self._largest)
            if outcome == FINE:
                finer = _finer(error, MAX_STEP_ERROR * largest, STEP_ORDER)
            if finer <= 1.0:
                lengths, rows = np.zeros(steps, dtype=np.int64), np.zeros((steps, width, ORDER))
                h = (until - begin) / steps
                laid, over = lay_steps(nodes, h, self._limits, MAX_BLOCK, lengths, rows)
                if over <= 1.0:
                    break
                finer = _finer(over, 1.0, PIECE_ORDER)
            self._finer *= finer
        else:
            what = "is not stable" if outcome == NOT_STABLE else "rings in a way that cannot be followed"
            raise ValueError(f"The stretching plate {what} at {begin + shift:g} s; reduce the strokes")
        state.q, state.q_t, self._largest = q, q_t, largest
        self._accelerations.append(float(np.abs(nodes[:, 2, :own]).max()))
        self._over, self._steps, self._pieces = max(self._over, over), self._steps + steps, self._pieces + laid
        edges = np.asarray(begin + h * np.cumsum(lengths[:laid]), dtype=float)
        edges[-1] = until
        self._edges.append(edges + shift)
        self._rows.append(rows[:laid].copy())
        if self._pieces * width > MAX_PIECES:
            raise ValueError(
                f"The plate's ringing takes {self._pieces} pieces in time so far for each of {width} shapes, more than "
                f"{MAX_PIECES} in all; raise plate.damping, reduce run.duration, or give drives frequencies with a "
                "common period"
            )

    def _is_settled(self, begun: _Mark, now: _Mark, period: float) -> bool:
        """Whether a period ended as it began, as will all later ones together."""
        omega = np.sqrt(self._ringing.square)
        change = omega**2 * np.abs(now.q - begun.q) + omega * np.abs(now.q_t - begun.q_t)
        lost = np.maximum(-np.expm1(-0.5 * self._ringing.drag * period), MIN_LOSS)
        return bool((change / lost).max() <= MAX_CHANGE * max(self._accelerations[begun.parts : now.parts]))

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
            in_plane_error=self._over,
            pieces=len(edges) - 1,
            equilibria=12 * self._steps,
            period=None if loop is None else float(edges[-1] - edges[loop]),
        )


def _finer(error: float, limit: float, order: int) -> float:
    """How many times more steps an error of that order asks for to meet its limit; 1: it does."""
    if error <= limit:
        return 1.0
    return float(min(MAX_FINER, SPARE * (error / limit) ** (1 / order))) if limit > 0 else MAX_FINER
