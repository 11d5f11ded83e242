"""The corrections of a reduced plate over time: one drive for each of its shapes, and for each in-plane motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupling.stretch.newton import FINE, NOT_STABLE
from coupling.stretch.pieces import MAX_HALVINGS, Walk, find_nodes, lay_pieces
from coupling.stretch.response import NO_RESPONSE, Response
from coupling.stretch.schedule import Schedule, schedule_of
from fem_plate.large_deflection import Forms, ReducedPlate
from particle import AnyDrive
from particle.drives import ORDER, QuinticDrive, quintic_drives

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-6
TOLERANCES = (1e-11, 1e-1)  # below is rounding
ROOM = 8  # pieces of an interval that room is made for at first


@dataclass(frozen=True, eq=False)
class Corrections:
    """What the reduced plate does under drives, as drives of its own shapes."""

    drives: list[QuinticDrive]  # n, of the corrections; each `error` is over the largest weighted correction
    in_plane: list[QuinticDrive]  # M, of the in-plane motions, likewise
    error: float  # the largest measured, weighted, over the largest weighted correction
    acceleration_error: float  # the same of second derivatives in time
    in_plane_error: float
    pieces: int  # in time
    equilibria: int  # that were solved
    period: float | None  # s, after which all repeats; None: there was no need or no such period


def correction_drives(
    plate: ReducedPlate,
    drives: Sequence[AnyDrive],
    end: float,
    tolerance: float = TOLERANCE,
    weights: ArrayLike | None = None,
    in_plane_weights: ArrayLike | None = None,
    floor: float = 0.0,
    in_plane_floor: float = 0.0,
    response: Response | None = None,
) -> Corrections:
    """Find the corrections over time as quintics between common breakpoints.

    The quintics have the value and first two derivatives of the corrections at both ends. An interval between two
    breakpoints of the drives is bisected until they meet the equilibrium in the middle of each piece. At a breakpoint
    where a drive's velocity or acceleration jumps, so do the corrections'.

    Parameters
    ----------
    plate : ReducedPlate
        The plate.
    drives : sequence of N drives
        Its drives. Where all that still move repeat with a common period, one period is computed and repeats.
    end : float
        End of the time that is needed, from 0, s.
    tolerance : float
        Largest error, of |c_k| weight_k over the largest of these at any time and any k.
    weights : array (n,), optional
        What a unit of each correction counts, such as its shape's largest height; 1 by default.
    in_plane_weights : array (M,), optional
        The same for in-plane motions, whose errors are compared among themselves.
    floor, in_plane_floor : float
        What errors are at least compared with, weighted: corrections far below need no digits.
    response : Response, optional
        Of the plate to heights; no equilibria are solved then. The drives must stay within these.

    Returns
    -------
    corrections : Corrections
        Drives, and the errors measured; these exceed the tolerance where 1024 pieces in an interval do not suffice.

    Raises
    ------
    ValueError
        An input makes no sense; names each. The corrections do not converge, or the plate is not stable; names the
        time.
    """
    n, m = len(plate.stiffness), len(plate.in_plane)
    scales = [_weights("weights", weights, n), _weights("in_plane_weights", in_plane_weights, m)]
    wrong = [scale for scale in scales if isinstance(scale, str)]
    if len(drives) != plate.drive_count:
        wrong.append(f"Input drives must be one for each of the plate's, {plate.drive_count}; got {len(drives)}")
    if not 0 < end < np.inf:
        wrong.append(f"Input end must be a positive time in s; got {end!r}")
    if not TOLERANCES[0] <= tolerance <= TOLERANCES[1]:
        wrong.append(f"Input tolerance must be in [{TOLERANCES[0]:g}, {TOLERANCES[1]:g}]; got {tolerance!r}")
    for name, least in (("floor", floor), ("in_plane_floor", in_plane_floor)):
        if not 0 <= least < np.inf:
            wrong.append(f"Input {name} must be 0 or positive; got {least!r}")
    if wrong:
        raise ValueError("; ".join(wrong))
    distinct = list(drives if response else dict.fromkeys(drives))  # many of a lattice are equal
    numbers = {drive: k for k, drive in enumerate(distinct)}
    forms = plate.forms if response else plate.forms_of([numbers[drive] for drive in drives])
    times = schedule_of(distinct, float(end))
    scale = np.concatenate([scale for scale in scales if not isinstance(scale, str)])
    nodes, solved = _nodes(forms, response or NO_RESPONSE, times)
    largest = scale * np.abs(nodes[:, :, 0]).max(axis=(0, 1))
    references = np.repeat([max(largest[:n].max(), floor), max(largest[n:].max(initial=0.0), in_plane_floor)], [n, m])
    walk, pieces, more = _pieces(forms, response or NO_RESPONSE, times, nodes, tolerance * references / scale)
    errors = np.divide(walk.errors * scale, references, out=np.zeros(n + m), where=references > 0)
    rows = np.ascontiguousarray(walk.coefficients[:pieces].transpose(1, 0, 2))
    edges = np.append(walk.edges[:pieces], times.edges[-1])
    loop = None if times.loop < 0 else int(np.searchsorted(edges, times.edges[times.loop]))
    found = quintic_drives(
        edges,
        rows,
        loop,
        float(times.table.stroke_time.min()),
        max(drive.frequency for drive in distinct),
        errors,
    )
    fastest = (scale * walk.largest_acceleration)[:n].max()
    return Corrections(
        drives=found[:n],
        in_plane=found[n:],
        error=float(errors[:n].max()),
        acceleration_error=float((scale * walk.acceleration_errors)[:n].max() / fastest) if fastest else 0.0,
        in_plane_error=float(errors[n:].max(initial=0.0)),
        pieces=pieces,
        equilibria=solved + more,
        period=None if loop is None else float(times.edges[-1] - times.edges[times.loop]),
    )


def _weights(name: str, given: ArrayLike | None, count: int) -> FloatArray | str:
    """The weights (count,), or what is wrong with them."""
    weights = np.ones(count) if given is None else np.asarray(given, dtype=float)
    if weights.shape != (count,) or not (np.isfinite(weights) & (weights > 0)).all():
        return f"Input {name} must be {count} positive numbers; got {given!r}"
    return weights


def _nodes(forms: Forms, response: Response, times: Schedule) -> tuple[FloatArray, int]:
    """The nodes of all intervals, and the number of equilibria."""
    nodes = np.zeros((len(times.edges) - 1, 3, 3, len(forms.load) + len(forms.constant) - forms.membranes))
    outcome, time, solved = find_nodes(forms, response, times.table, times.edges, times.loop, nodes)
    if outcome != FINE:
        raise _failure(time, outcome == NOT_STABLE)
    return nodes, solved


def _pieces(
    forms: Forms, response: Response, times: Schedule, nodes: FloatArray, limits: FloatArray
) -> tuple[Walk, int, int]:
    """The pieces, how many there are, and the number of equilibria."""
    width, most = len(limits), 2 << MAX_HALVINGS
    walk = _new_walk(most + ROOM * len(nodes), width)
    k = laid = solved = 0
    while True:
        k, laid, failed, more = lay_pieces(forms, response, times.table, times.edges, nodes, limits, walk, k, laid)
        solved += more
        if failed >= 0:
            raise _failure(failed, False)
        if k == len(nodes):
            return walk, laid, solved
        roomier = _new_walk(2 * len(walk.edges) + most, width)
        roomier.edges[:laid], roomier.coefficients[:laid] = walk.edges[:laid], walk.coefficients[:laid]
        walk = walk._replace(edges=roomier.edges, coefficients=roomier.coefficients)


def _new_walk(room: int, width: int) -> Walk:
    return Walk(np.empty(room), np.empty((room, width, ORDER)), *np.zeros((4, width)))


def _failure(time: float, unstable: bool) -> ValueError:
    if unstable:
        return ValueError(f"The plate is not stable at {time:g} s: its energy is not least there")
    return ValueError(f"The corrections of the plate do not converge at {time:g} s; reduce the strokes")
