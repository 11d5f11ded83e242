"""What was found in words and in numbers: what the commands print."""

from __future__ import annotations

import math
from typing import Any

from active_surface.steering.aimed import Aimed
from active_surface.steering.found import Found
from active_surface.steering.planned import Planned
from active_surface.steering.scatter import Scatter
from coupling.case import ActuatorCase

MICRO, MILLI = 1e6, 1e3
KEYS = ("frequency", "stroke", "delay", "cycles")


def figures(found: Aimed) -> dict[str, Any]:
    """The figures of an aim by name, in SI units."""
    return {
        "target": found.task.target,
        "end_position": found.trajectory.position[-1].tolist(),
        "outcome": found.trajectory.outcome.value,
        "distance": found.distance,
        "reached": found.reached,
        "interrupted": found.interrupted,
        "paths": found.paths,
        "legs": [
            {
                "start": leg.start,
                "drives": {str(k): {key: getattr(leg.actuators[k], key) for key in KEYS} for k in leg.movers},
            }
            for leg in found.legs
        ],
        **_common(found),
    }


def lines(found: Aimed) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    verdict = _verdict(found.distance, found.task.settings.tolerance)
    if found.distance <= found.task.settings.tolerance and not found.reached:
        verdict += ", but it does not rest there for good"
    how = ", stopped by Ctrl-C" if found.interrupted else ""
    rows = [
        ("target", point(found.task.target)),
        (
            "distance",
            f"{found.distance * MICRO:.4f} um, {verdict}; {found.paths} paths{how}",
        ),
        ("outcome", f"{found.trajectory.outcome}. {found.trajectory.sentence}"),
    ]
    for number, leg in enumerate(found.legs, 1):
        if len(found.legs) > 1:
            rows.append((f"leg {number}", f"from {leg.start * MILLI:g} ms on"))
        rows += [(f"actuator {k}", _drive(leg.actuators[k])) for k in leg.movers]
    return rows + _last_lines(found)


def plan_figures(found: Planned) -> dict[str, Any]:
    """The figures of a plan by name, in SI units."""
    legs = zip(found.route.through, found.arrivals, found.distances, found.reached, strict=False)
    return {
        "legs": [
            {"target": target, "arrival": time, "distance": distance, "reached": reached}
            for target, time, distance, reached in legs
        ],
        "complete": found.complete,
        "failure": found.failure,
        "outcome": found.trajectory.outcome.value,
        "interrupted": found.interrupted,
        "paths": found.paths,
        **_common(found),
    }


def plan_lines(found: Planned) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    rows = []
    for k, (time, distance) in enumerate(zip(found.arrivals, found.distances, strict=True)):
        where = f"{point(found.route.through[k])} by {time * MILLI:g} ms, but for {distance * MICRO:.4f} um"
        where += f", {_verdict(distance, found.route.settings.tolerance)}"
        rows.append((f"leg {k + 1}", where))
    if found.failure:
        label, _, said = found.failure.partition(": ")
        rows.append((label, said))
    tolerance = f"{found.route.settings.tolerance * MICRO:g} um"
    count = f"{sum(found.reached)} of {len(found.route.through)} way-points within {tolerance}; {found.paths} paths"
    rows.append(("found", count + (", stopped by Ctrl-C" if found.interrupted else "")))
    rows.append(("outcome", f"{found.trajectory.outcome}. {found.trajectory.sentence}"))
    return rows + _last_lines(found)


def _common(found: Found) -> dict[str, Any]:
    return {
        "scatter": None if found.scatter is None else found.scatter.as_dict(),
        "warnings": list(found.warnings),
        "files": [str(file) for file in found.files],
    }


def _last_lines(found: Found) -> list[tuple[str, str]]:
    scatter = "not looked for, after Ctrl-C" if found.scatter is None else scatter_line(found.scatter)
    warnings = [("warning", said) for said in found.warnings]
    return [("scatter", scatter), *(("wrote", str(file)) for file in found.files), *warnings]


def _verdict(distance: float, tolerance: float) -> str:
    return f"{'within' if distance <= tolerance else 'not within'} the {tolerance * MICRO:g} um wanted"


def point(place: tuple[float, float]) -> str:
    """A place [m] in words."""
    return f"({place[0] * MICRO:g}, {place[1] * MICRO:g}) um"


def scatter_line(scatter: Scatter) -> str:
    """How far disturbed runs end from the target, in words: of shares without lost ones."""
    shares = {"half": 0.5, "90 %": 0.9, "all": 1.0}
    found = {name: scatter.quantile(share) * MICRO for name, share in shares.items()}
    within = ", ".join(f"{name} within {away:.3g} um" for name, away in found.items() if math.isfinite(away))
    said = [f"{within} of the target"] if within else []
    said += [f"{scatter.lost} lost"] if scatter.lost else []
    count = len(scatter.distance)
    return f"{'; '.join(said)} ({count} runs with friction and strokes up to 1 %, starts up to 1 um off)"


def _drive(actuator: ActuatorCase) -> str:
    delay = f" after {actuator.delay * MILLI:g} ms" if actuator.delay else ""
    cycles = f"{actuator.cycles} cycle{'' if actuator.cycles == 1 else 's'}"
    return f"{cycles} of {(actuator.stroke or 0) * MICRO:g} um at {actuator.frequency:g} Hz{delay}"
