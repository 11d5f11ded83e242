"""One identification, from case and track to fields: this file reads as the pipeline.

parameters -> surface -> search -> profiles -> case, path, correlation
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np
from threadpoolctl import threadpool_limits

from active_surface.identification.parameters import Parameter, case_with, free_parameters
from active_surface.identification.profiles import covariance, profiled
from active_surface.identification.result import Estimate, Identified
from active_surface.identification.search import search
from active_surface.identification.track import Track
from active_surface.identification.trials import Loss, Trials
from coupling import Progress, build_friction, build_part, build_surface, follow_part, silent
from coupling.case import Case
from particle import interruptible


def identify(
    case: Case,
    track: Track,
    free: str | Sequence[str],
    bounds: Mapping[str, Sequence[Any]] | None = None,
    loss: Loss = "squares",
    seed: int = 0,
    threads: int | None = None,
    progress: Progress = silent,
) -> Identified:
    """Find the fields of a case with which its path is closest to a track.

    Parameters
    ----------
    case : Case
        The case. Its drives and its plate or platform stay as they are.
    track : Track
        Where the part was.
    free : str or sequence of str
        Places of fields of `part` and `friction`, as of `Case.vary`: ``"part.squeeze"``, ``"friction.coefficient"``.
    bounds : mapping, optional
        The least and largest value of a field, texts with units or SI; by default a tenth and ten times its value in
        the case, where that is positive and no place or velocity.
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
        The fields with their 95 % intervals, and the case with them.

    Raises
    ------
    ValueError
        An input makes no sense, names each; or no case within the bounds can be run.
    KeyboardInterrupt
        Ctrl-C.
    """
    free = [free] if isinstance(free, str) else list(free)
    parameters = _checked(case, track, free, bounds or {}, loss)
    name = f"{case.name}_identified"
    # Many small systems: BLAS threads would only wait for each other.
    with threadpool_limits(limits=1, user_api="blas"):
        with progress("Solving the plate"):
            surface = interruptible(build_surface, case)
            interruptible(follow_part, case, surface, build_friction(case))  # compiles what paths need
        trials = Trials(case, surface, track, parameters, loss, threads)
        with progress("Searching from many starts") as tell:
            search(trials, seed, tell)
        with progress("Finding the ends of intervals") as tell:
            intervals = profiled(trials, tell)
        spread, best = covariance(trials), trials.best
        found = case_with(case, parameters, best.shares).model_copy(update={"name": name})
        (path,) = trials.paths([(build_part(found), build_friction(found))])
    deviation = np.sqrt(np.diag(spread))
    return Identified(
        case=found,
        track=track,
        trajectory=path,
        estimates=tuple(
            _estimate(parameter, float(share), *ends)
            for parameter, share, ends in zip(parameters, best.shares, intervals, strict=True)
        ),
        correlation=spread / np.outer(deviation, deviation),
        residuals=best.residuals,
        paths=len(trials.all),
    )


def _checked(
    case: Case, track: Track, free: Sequence[str], bounds: Mapping[str, Sequence[Any]], loss: str
) -> list[Parameter]:
    """The parameters; ValueError with all that is wrong."""
    wrong, parameters = [], []
    try:
        parameters = free_parameters(case, free, bounds)
    except ValueError as error:
        wrong.append(str(error))
    if case.run.scheme != "events":
        wrong.append(f'Input case of identify must have run.scheme = "events"; got "{case.run.scheme}"')
    if track.time[-1] > case.run.duration:
        wrong.append(
            f"Input track of identify must end within the run's duration, {case.run.duration:g} s; "
            f"got {track.time[-1]:g} s"
        )
    if (measured := int(np.isfinite(track.position).sum())) <= len({*free}) or track.time[-1] <= 0:
        wrong.append(
            f"Input track of identify must have more places than free fields, {len({*free})}, and later ones than 0 s; "
            f"got {measured} until {track.time[-1]:g} s"
        )
    if loss not in get_args(Loss):
        wrong.append(f'Input loss of identify must be "squares" or "absolute"; got {loss!r}')
    if wrong:
        raise ValueError("\n".join(wrong))
    return parameters


def _estimate(parameter: Parameter, share: float, low: float, high: float) -> Estimate:
    """A field whose value and interval are at shares of its bounds."""
    value, least, most = (float(parameter.value(one)) for one in (share, low, high))
    field = parameter.field
    return Estimate(field.path, field.unit, value, least, most, low <= 0, high >= 1)
