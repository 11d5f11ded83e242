"""One identification, from cases and tracks to fields: this file reads as the pipeline.

parameters -> surfaces -> search -> profiles -> cases, paths, correlation
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np

from active_surface.identification.estimate import Estimate, TrackFit
from active_surface.identification.parameters import FREE, case_with, parameters_of
from active_surface.identification.profiles import profiled, spread_of
from active_surface.identification.result import Identified, case_names, names_of
from active_surface.identification.search import search
from active_surface.identification.track import Track
from active_surface.identification.trials import Loss, Recording, Trials
from coupling import Progress, build_friction, build_surface, follow_part, one_blas_thread, silent
from coupling.case import Case, plain_case
from particle import SurfaceMotion, interruptible


def identify(
    case: Case | Sequence[Case],
    track: Track | Sequence[Track],
    free: str | Sequence[str] = (),
    bounds: Mapping[str, Sequence[Any]] | None = None,
    own: str | Sequence[str] = (),
    loss: Loss = "squares",
    seed: int = 0,
    threads: int | None = None,
    progress: Progress = silent,
) -> Identified:
    """Find the fields of a case, or of several, with which paths are closest to tracks.

    Parameters
    ----------
    case : Case or sequence of Case
        The case of each track, or one for all. Their drives and their plate or platform stay as they are.
    track : Track or sequence of Track
        Where the part was. A track counts by its own noise, the deviation of its residuals.
    free : str or sequence of str
        Places of fields of `part`, `friction` and `air`, as of `Case.vary`: ``"part.squeeze"``,
        ``"friction.coefficient"``.
        All tracks share their values.
    bounds : mapping, optional
        The least and largest value of a field, texts with units or SI; by default a tenth and ten times its value in
        the case, where that is positive and no place or velocity.
    own : str or sequence of str
        Fields that each track has for itself.
    loss : {"squares", "absolute"}
        What is made least: the sum of the squares of the residuals along x and y, or of their sizes, which outliers
        hardly change.
    seed : int
        Of the starts; equal seeds give equal results.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the result is the same for any.
    progress : Progress, optional
        Reports the progress of a stage, for progress bars.

    Returns
    -------
    identified : Identified
        The fields with their 95 % intervals, and the cases with them.

    Raises
    ------
    ValueError
        An input makes no sense, names each; or no case within the bounds can be run.
    KeyboardInterrupt
        Ctrl-C.
    """
    cases = [case] if isinstance(case, Case) else list(case)
    tracks = [track] if isinstance(track, Track) else list(track)
    shared, alone = ([paths] if isinstance(paths, str) else list(paths) for paths in (free, own))
    if loss not in get_args(Loss):
        raise ValueError(f'Input loss of identify must be "squares" or "absolute"; got {loss!r}')
    rows = parameters_of(cases, tracks, shared, alone, bounds or {})
    names = names_of([one.name for one in cases], len(tracks))
    written = case_names(cases, len(tracks), bool(alone))
    # Many small systems: BLAS threads would only wait for each other.
    with one_blas_thread():
        with progress("Solving the plate"):
            surfaces = _surfaces(cases)
        each = len(tracks) // len(cases)  # 1, or all
        many = zip(cases * each, surfaces * each, tracks, rows * each, strict=True)
        trials = Trials([Recording(*one) for one in many], len(shared), loss, threads)
        with progress("Searching from many starts") as tell:
            search(trials, seed, tell)
        with progress("Finding the ends of intervals") as tell:
            intervals = profiled(trials, tell)
        spread = spread_of(trials).covariance
        fits = _fits(trials, names, written * (len(tracks) // len(written)))
    deviation = np.sqrt(np.diag(spread))
    return Identified(
        fits=fits,
        estimates=_estimates(trials, names, intervals),
        correlation=spread / np.outer(deviation, deviation),
        paths=trials.followed,
    )


def _surfaces(cases: Sequence[Case]) -> list[SurfaceMotion]:
    """The surface of each case; cases that differ in part and friction only have one."""
    built: list[tuple[dict[str, Any], SurfaceMotion]] = []
    found = []
    for case in cases:
        tables = {key: table for key, table in plain_case(case).items() if key not in FREE}
        surface = next((surface for known, surface in built if known == tables), None)
        if surface is None:
            surface = interruptible(build_surface, case)
            interruptible(follow_part, case, surface, build_friction(case))  # compiles what paths need
            built.append((tables, surface))
        found.append(surface)
    return found


def _fits(trials: Trials, names: Sequence[str], written: Sequence[str]) -> tuple[TrackFit, ...]:
    """Each track with its case and path at the optimum, where the cases have the names to be written."""
    fits = []
    for number, (case, _, track, parameters) in enumerate(trials.recordings):
        shares = trials.best.shares[trials.columns[number]]
        run = trials.run(number, shares)
        assert run is not None  # as it was followed
        (path,) = trials.paths(number, [run])
        found = case_with(case, parameters, shares).model_copy(update={"name": written[number]})
        fits.append(TrackFit(names[number], found, track, path))
    return tuple(fits)


def _estimates(trials: Trials, names: Sequence[str], intervals: Sequence[tuple[float, float]]) -> tuple[Estimate, ...]:
    """Each parameter with its interval: those shared, then track by track its own."""
    estimates = []
    for number, (share, (first, last)) in enumerate(zip(trials.best.shares, intervals, strict=True)):
        track, slot = np.argwhere(trials.columns == number)[0]
        parameter = trials.recordings[track].parameters[slot]
        of = names[track] if trials.several and slot >= trials.shared else None
        value, low, high = (float(parameter.value(one)) for one in (share, first, last))
        field = parameter.field
        estimates.append(Estimate(field.path, of, field.unit, value, low, high, first <= 0, last >= 1))
    return tuple(estimates)
