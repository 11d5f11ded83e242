"""The parameters of an identification: free fields of cases, with bounds; and whether tracks can determine any."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.track import Track
from active_surface.parameter import Parameter
from coupling.case import Case, Field, find_field, quoted

FACTOR: Final = 10.0  # either way, of usual bounds
FREE: Final = ("part", "friction", "air")  # tables whose fields one moving surface serves
PLACES: Final = ("part.position.", "part.velocity.", "part.heading", "part.spin")  # of which a factor says nothing
EXAMPLES: Final = {"N": '"1 nN", "1 uN"', "m": '"0 um", "100 um"', "kg": '"1e-10 kg", "1e-8 kg"'}

Bounds = Mapping[str, Sequence[Any]]


def _check(cases: Sequence[Case], tracks: Sequence[Track], fields: Sequence[str]) -> None:
    """Raise ValueError unless paths of the cases can be fitted to the tracks."""
    if not cases or not tracks:
        counts = f"{len(cases)} and {len(tracks)}"
        raise ValueError(f"Inputs case and track of identify must be at least one of each; got {counts}")
    if len(cases) not in (1, len(tracks)):
        counts = f"{len(tracks)} track{'s' * (len(tracks) > 1)} for {len(cases)} cases"
        raise ValueError(f"Input track of identify must be one for each case, or all of one case; got {counts}")
    for number, track in enumerate(tracks):
        case, end = cases[number % len(cases)], float(track.time[-1])
        which = f"track[{number}] of identify" if len(tracks) > 1 else "track of identify"
        which = f"track of identify in {track.name}" if track.name else which
        if case.run.scheme != "events":
            raise ValueError(
                f'Input case {case.name} of identify must have run.scheme = "events"; got "{case.run.scheme}"'
            )
        if end > case.run.duration:
            raise ValueError(
                f"Input {which} must end within the run's duration, {case.run.duration:g} s; got {end:g} s"
            )
        if track.heading is not None and case.part.face is None:
            without = f"the part of case {case.name} has no footprint, and a point does not turn"
            raise ValueError(f"Input {which} must have no heading: {without}")
        measured = int(track.measured.sum())
        if measured <= len(fields) or end <= 0:
            raise ValueError(
                f"Input {which} must have more places than free fields, {len(fields)}, and later ones than 0 s; "
                f"got {measured} until {end:g} s"
            )


def parameters_of(
    cases: Sequence[Case], tracks: Sequence[Track], free: Sequence[str], own: Sequence[str], bounds: Bounds
) -> list[list[Parameter]]:
    """For each case its parameters: shared ones, with the same bounds for all, then own ones.

    Raises ValueError for the first mistake in the tracks, the parameters' paths and their bounds.
    """
    paths = [*free, *own]
    _check(cases, tracks, paths)
    if not paths:
        raise ValueError("Input free of identify must name at least one field, such as friction.coefficient")
    if twice := [path for path in paths if paths.count(path) > 1]:
        raise ValueError(f"Inputs free and own of identify must name each field once; got {twice[0]} twice")
    if others := [path for path in bounds if path not in paths]:
        raise ValueError(f"Input bounds of identify must be of free fields; got {others[0]}")
    kinds = ["free"] * len(free) + ["own"] * len(own)
    columns = [
        [_parameter(case, kind, path, bounds.get(path)) for case in cases]
        for kind, path in zip(kinds, paths, strict=True)
    ]
    for column in columns[: len(free)]:
        low, high = min(one.low for one in column), max(one.high for one in column)
        column[:] = [replace(one, low=low, high=high, logarithmic=low > 0) for one in column]
    return [list(row) for row in zip(*columns, strict=True)]


def _parameter(case: Case, kind: str, path: str, bounds: Sequence[Any] | None) -> Parameter:
    name = f"{kind} of identify"
    try:
        field = find_field(case, None, path)
        if field.locations[0][0] not in FREE:
            raise ValueError(
                f"must be fields of [part], [friction] or [air], which leave the surface as it is; got {path}"
            )
        if field.kind != "number":
            raise ValueError(f"must be numbers; got {path}, a {field.kind}")
        name = f"bounds of identify for {path}"
        low, high = _usual(field) if bounds is None else _read(field, bounds)
        if not low < high:
            raise ValueError(f"must increase; got {low:g} and {high:g} in SI units")
    except ValueError as error:
        raise ValueError(f"Input {name} {error} (case {case.name})") from None
    return Parameter(field, low, high, logarithmic=low > 0)


def _usual(field: Field) -> tuple[float, float]:
    """A tenth and ten times what the case has, or the nearest factors that the field may have."""
    base = field.base
    if field.path.startswith(PLACES) or not isinstance(base, (int, float)) or base <= 0:
        without = "places, headings, their rates and fields without a positive value have none by default"
        raise ValueError(f"must be given, such as {_example(field)}: {without}")
    low, high = (
        next(value for share in np.linspace(1, 0, 21) if _allowed(field, value := float(base * factor**share)))
        for factor in (1 / FACTOR, FACTOR)
    )
    return low, high


def _allowed(field: Field, value: float) -> bool:
    try:
        field.read(value, in_si=True)
    except ValueError:
        return False
    return True


def _read(field: Field, bounds: Sequence[Any]) -> tuple[float, float]:
    """Bounds as they were given, texts with units or numbers in SI units."""
    if np.shape(bounds) != (2,):
        raise ValueError(f"must be two values, such as {_example(field)}; got {quoted(bounds)}")
    low, high = (_number(field, one) for one in bounds)
    return low, high


def _number(field: Field, value: Any) -> float:
    if isinstance(value, str) and field.unit == "1":
        try:
            value = float(value)
        except ValueError:
            raise ValueError(f"must be two plain numbers; got {quoted(value)}") from None
    return float(field.read(value, in_si=not isinstance(value, str)))


def _example(field: Field) -> str:
    return EXAMPLES.get(field.unit, "0.1, 0.9")


def case_with(case: Case, parameters: Sequence[Parameter], shares: FloatArray) -> Case:
    """The case with parameters at shares (n,) of their bounds; ValueError where its tables contradict."""
    return case.vary({one.field.path: float(one.value(share)) for one, share in zip(parameters, shares, strict=True)})
