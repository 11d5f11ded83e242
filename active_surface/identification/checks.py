"""Checks: whether cases, tracks and fields make an identification."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import get_args

import numpy as np

from active_surface.identification.parameters import Bounds, parameters_of
from active_surface.identification.track import Track
from active_surface.identification.trials import Loss
from active_surface.parameter import Parameter
from coupling.case import Case


def checked(
    cases: Sequence[Case],
    tracks: Sequence[Track | None],
    free: Sequence[str],
    own: Sequence[str],
    bounds: Bounds,
    loss: str = "squares",
) -> list[list[Parameter]]:
    """For each case its parameters; ValueError with all that is wrong.

    tracks: None is one that could not be read, of which nothing more is said.
    """
    wrong = list(_counts(cases, tracks))
    try:
        rows = parameters_of(cases, free, own, bounds)
    except ValueError as error:
        wrong.append(str(error))
    for case in cases:
        if case.run.scheme != "events":
            which = f"case {case.name}" if len(cases) > 1 else "case"
            wrong.append(f'Input {which} of identify must have run.scheme = "events"; got "{case.run.scheme}"')
    for number, track in enumerate(tracks):
        if track:
            of = f" of track {number}" if len(tracks) > 1 else ""
            beside = cases[number % len(cases)] if len(cases) in (1, len(tracks)) else None
            wrong += [f"Input track of identify {mistake}{of}" for mistake in _mistakes(track, beside, {*free, *own})]
    if loss not in get_args(Loss):
        wrong.append(f'Input loss of identify must be "squares" or "absolute"; got {loss!r}')
    if wrong:
        raise ValueError("\n".join(wrong))
    return rows


def _counts(cases: Sequence[Case], tracks: Sequence[Track | None]) -> Iterator[str]:
    """Yield what is wrong with the numbers of cases and tracks."""
    if not cases or not tracks:
        yield f"Inputs case and track of identify must be at least one of each; got {len(cases)} and {len(tracks)}"
    elif len(cases) not in (1, len(tracks)):
        of = f"{len(tracks)} track{'s' * (len(tracks) > 1)} for {len(cases)} cases"
        yield f"Input track of identify must be one for each case, or all of one case; got {of}"


def _mistakes(track: Track, case: Case | None, fields: set[str]) -> Iterator[str]:
    """Yield what is wrong with a track of a case."""
    end, measured = float(track.time[-1]), int(np.isfinite(track.position).sum())
    if case and end > case.run.duration:
        yield f"must end within the run's duration, {case.run.duration:g} s; got {end:g} s"
    if measured <= len(fields) or end <= 0:
        yield (
            f"must have more places than free fields, {len(fields)}, and later ones than 0 s; "
            f"got {measured} until {end:g} s"
        )
