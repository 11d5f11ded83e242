"""Leaps: a whole path estimated from a few periods of the drives, between which the part goes on at its drift."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from coupling import build_drives, follow_part
from coupling.case import Case, common_period
from particle import AnyDrive, State, SurfaceMotion, Trajectory
from particle.friction import Contact

LEAPS: Final = 5  # over a whole path, where none is halved
BEFORE, BETWEEN, AFTER = 3, 2, 2  # periods that are followed at the start, after each leap and at the end
BENT: Final = 0.25  # of a leap: a longer correction is not small
NOTHING: Final = 1e-9  # m, and one so short is
MANY: Final = 12  # periods of the drives in a run: with fewer in common they count as having none in common
SURE, UNSURE = 0.25, 3.0  # of all corrections: the error, with a common period of the drives and without
LEAST: Final = 0.03  # of the distance: the error at least
LOOSE: Final = 1e-7  # the tolerance of pieces, at least: at 1e-6 a drift may be a tenth off
ROUNDING: Final = 1e-9  # of a time


class Course(NamedTuple):
    """When drives repeat themselves."""

    begin: float  # s, from when on
    period: float  # s
    periods: int  # until the run or the first drive ends
    common: bool  # whether all drives have the period; else it is the longest of theirs

    @classmethod
    def of(cls, drives: Sequence[AnyDrive], duration: float) -> Course:
        """The course of drives in a run so long [s]; of drives that rest, no period."""
        moving = [(one.delay, one.segments()) for one in drives if one.segments().coefficients[:, 1:].any()]
        begin = max((delay + pieces.lead_time for delay, pieces in moving), default=0.0)
        end = min([duration, *(delay + pieces.duration for delay, pieces in moving)])
        spans, period = [pieces.span for _, pieces in moving] or [math.inf], 0.0
        for span in spans:
            period = common_period(period or None, span) if period < math.inf else period
        common = MANY * period <= end - begin
        period = period if common else max(spans)
        return cls(begin, period, int((end - begin) / period * (1 + ROUNDING)), common)


@dataclass(frozen=True, eq=False)
class Leaped:
    """A path with leaps; of its arrays those of time, position, velocity and heading are whole."""

    path: Trajectory
    followed: int  # periods of the drives
    periods: int  # of them in all
    error: float  # m, of its end, estimated


class _Piece(NamedTuple):
    path: Trajectory
    rows: FloatArray  # (n, 6) time, x, y, heading, and the velocity along x and y
    drift: FloatArray | None  # (3,) x, y and heading in its last period; None: it ended early


def leaped(case: Case, surface: SurfaceMotion, law: Contact) -> Leaped | None:
    """Estimate the path of a case; None where the drives have few periods, or the part may fly.

    A leap carries the part by the integral over its periods of the line through the last two displacements in a
    period, the first by its only one; the displacement found after it makes the line a parabola, which corrects the
    leap. Without a common period the last displacement carries the part, and a line corrects it. A leap after which
    the part is lost is halved, and so is one whose correction is not small where drives have a common period. The error
    is a share of the corrections' lengths, or of the distance.
    """
    course, run = Course.of(build_drives(case), case.run.duration), case.run
    if course.periods < MANY or run.scheme != "events" or run.after_detachment == "fly":
        return None

    def moment(periods: int) -> float:
        return course.begin + periods * course.period

    now, last = BEFORE, course.periods - AFTER
    passed = longest = (last - now) // LEAPS
    order = 2 if course.common else 1
    piece = _piece(case, surface, law, (0.0, moment(now)), course.period)
    rows, error, followed = [piece.rows], 0.0, now
    drifts = [] if piece.drift is None else [(now - 0.5, piece.drift)]
    while now < last and piece.drift is not None:
        passed = max(min(passed, last - now - BETWEEN), 0)
        begin, end, drift = now + passed, min(now + passed + BETWEEN, last), piece.drift
        carried = _carried(drifts[-order:], now, begin)
        found: _Piece | None = None
        change = np.zeros(3)
        with suppress(ValueError):  # of a leap over the rim
            found = _piece(_at(case, piece, carried), surface, law, (moment(begin), moment(end)), course.period)
            if found.drift is not None:
                drifts.append((end - 0.5, found.drift))
                change = _carried(drifts[-order - 1 :], now, begin) - carried
        length = float(np.hypot(*change[:2]))
        bent = course.common and length > BENT * passed * float(np.hypot(*drift[:2])) + NOTHING
        if passed and (found is None or found.drift is None or bent):
            drifts = [one for one in drifts if one[0] < now]
            passed //= 2
            continue
        assert found is not None
        found.rows[:, 1:4] += change
        if passed:
            rows += [_slide(piece.rows[-1], drift / course.period), _slide(found.rows[0], drift / course.period)]
        rows.append(found.rows)
        piece, now, passed = found, end, min(2 * passed + 1, longest)
        error, followed = error + length, followed + end - begin
    if piece.drift is not None:
        piece = _piece(_at(case, piece), surface, law, (moment(last), run.duration), course.period)
        rows.append(piece.rows)
        followed += AFTER
    whole = np.concatenate(rows)
    heading = None if piece.path.heading is None else whole[:, 3]
    path = replace(piece.path, time=whole[:, 0], position=whole[:, 1:3], velocity=whole[:, 4:], heading=heading)
    error *= SURE if course.common else UNSURE
    return Leaped(path, followed, course.periods, max(error, LEAST * path.distance))


def _carried(drifts: Sequence[tuple[float, FloatArray]], begin: int, end: int) -> FloatArray:
    """What a part is carried by (3,) over periods, where it drifts as the polynomial through (period, drift)."""
    periods = np.array([period for period, _ in drifts]) - begin
    powers = np.arange(1, len(drifts) + 1)
    weights = np.linalg.solve(periods ** (powers[:, None] - 1), (end - begin) ** powers / powers)
    return weights @ np.array([drift for _, drift in drifts])


def _piece(case: Case, surface: SurfaceMotion, law: Contact, times: tuple[float, float], period: float) -> _Piece:
    """The path from one time to another [s], of a part that is where the case has it."""
    begin, duration = times[0], times[1] - times[0]
    drives = surface.drives._replace(delay=surface.drives.delay - begin)
    run = case.run.model_copy(update={"duration": duration, "tolerance": max(case.run.tolerance, LOOSE)})
    path = follow_part(case.model_copy(update={"run": run}), replace(surface, drives=drives), law)
    heading = np.zeros(len(path.time)) if path.heading is None else path.heading
    rows = np.column_stack([path.time + begin, path.position, heading, path.velocity])
    if path.time[-1] < duration * (1 - ROUNDING):
        return _Piece(path, rows, None)
    before = path.at([max(duration - period, 0.0)])
    turn = 0.0 if before.heading is None else heading[-1] - before.heading[0]
    return _Piece(path, rows, np.array([*(path.position[-1] - before.position[0]), turn]))


def _at(case: Case, piece: _Piece, carried: FloatArray | float = 0.0) -> Case:
    """The case with its part as it is at the end of a piece, and carried on from there (3,) [m, m, rad]."""
    x, y, heading = (piece.rows[-1, 1:4] + carried).tolist()
    path, moves = piece.path, float(piece.path.state[-1] != State.STICK)
    update: dict[str, object] = {"position": (x, y), "velocity": tuple((moves * path.velocity[-1]).tolist())}
    if path.heading is not None and path.spin is not None:
        update |= {"heading": heading, "spin": moves * float(path.spin[-1])}
    return case.model_copy(update={"part": case.part.model_copy(update=update)})


def _slide(row: FloatArray, velocity: FloatArray) -> FloatArray:
    """A row (1, 6) as another, where the part goes on at a steady velocity (3,)."""
    return np.array([[*row[:4], *velocity[:2]]])
