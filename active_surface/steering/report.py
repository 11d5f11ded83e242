"""Results in words and in numbers: what the commands print."""

from __future__ import annotations

import math
from typing import Any

from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.scatter import Scatter
from coupling.case import ActuatorCase

MICRO, MILLI = 1e6, 1e3
KEYS = ("frequency", "stroke", "delay", "cycles")


def figures(result: Aimed) -> dict[str, Any]:
    """The figures of an aim by name, in SI units."""
    return {
        "target": result.task.target,
        "end_position": result.trajectory.position[-1].tolist(),
        "outcome": result.trajectory.outcome.value,
        "distance": result.distance,
        "reached": result.reached,
        "interrupted": result.interrupted,
        "paths": result.paths,
        "legs": [
            {
                "start": leg.start,
                "drives": {str(k): {key: getattr(leg.actuators[k], key) for key in KEYS} for k in leg.movers},
            }
            for leg in result.legs
        ],
        **_common(result),
    }


def lines(result: Aimed) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    verdict = _verdict(result.distance, result.task.settings.tolerance)
    if result.distance <= result.task.settings.tolerance and not result.reached:
        verdict += ", but it does not rest there for good"
    how = ", stopped by Ctrl-C" if result.interrupted else ""
    rows = [
        ("target", point(result.task.target)),
        (
            "distance",
            f"{result.distance * MICRO:.4f} um, {verdict}; {result.paths} paths{how}",
        ),
        ("outcome", f"{result.trajectory.outcome}. {result.trajectory.sentence}"),
    ]
    for number, leg in enumerate(result.legs):
        if len(result.legs) > 1:
            rows.append((f"leg {number}", f"from {leg.start * MILLI:g} ms on"))
        rows += [(f"actuator {k}", _drive(leg.actuators[k])) for k in leg.movers]
    return rows + _last_lines(result)


def plan_figures(result: Planned) -> dict[str, Any]:
    """The figures of a plan by name, in SI units."""
    legs = zip(result.route.through, result.arrivals, result.distances, result.reached, strict=False)
    return {
        "legs": [
            {"target": target, "arrival": time, "distance": distance, "reached": reached}
            for target, time, distance, reached in legs
        ],
        "complete": result.complete,
        "failure": result.failure,
        "outcome": result.trajectory.outcome.value,
        "interrupted": result.interrupted,
        "paths": result.paths,
        **_common(result),
    }


def plan_lines(result: Planned) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    rows = []
    for k, (time, distance) in enumerate(zip(result.arrivals, result.distances, strict=True)):
        where = f"{point(result.route.through[k])} by {time * MILLI:g} ms, but for {distance * MICRO:.4f} um"
        where += f", {_verdict(distance, result.route.settings.tolerance)}"
        rows.append((f"leg {k}", where))
    if result.failure:
        label, _, reason = result.failure.partition(": ")
        rows.append((label, reason))
    tolerance = f"{result.route.settings.tolerance * MICRO:g} um"
    count = f"{sum(result.reached)} of {len(result.route.through)} way-points within {tolerance}; {result.paths} paths"
    rows.append(("reached", count + (", stopped by Ctrl-C" if result.interrupted else "")))
    rows.append(("outcome", f"{result.trajectory.outcome}. {result.trajectory.sentence}"))
    return rows + _last_lines(result)


def _common(result: SteeringResult) -> dict[str, Any]:
    return {
        "scatter": None if result.scatter is None else result.scatter.as_dict(),
        "warnings": list(result.warnings),
        "files": [str(file) for file in result.files],
    }


def _last_lines(result: SteeringResult) -> list[tuple[str, str]]:
    scatter = "not looked for, after Ctrl-C" if result.scatter is None else scatter_line(result.scatter)
    warnings = [("warning", text) for text in result.warnings]
    return [("scatter", scatter), *(("wrote", str(file)) for file in result.files), *warnings]


def _verdict(distance: float, tolerance: float) -> str:
    return f"{'within' if distance <= tolerance else 'not within'} the {tolerance * MICRO:g} um tolerance"


def point(place: tuple[float, float]) -> str:
    """A place [m] in words."""
    return f"({place[0] * MICRO:g}, {place[1] * MICRO:g}) um"


def scatter_line(scatter: Scatter) -> str:
    """How far disturbed runs end from the target, in words: of shares without lost ones."""
    shares = {"half": 0.5, "90 %": 0.9, "all": 1.0}
    result = {name: scatter.quantile(share) * MICRO for name, share in shares.items()}
    within = ", ".join(f"{name} within {away:.3g} um" for name, away in result.items() if math.isfinite(away))
    parts = [f"{within} of the target"] if within else []
    parts += [f"{scatter.lost} lost"] if scatter.lost else []
    count = len(scatter.distance)
    return f"{'; '.join(parts)} ({count} runs with friction and strokes up to 1 %, starts up to 1 um off)"


def _drive(actuator: ActuatorCase) -> str:
    delay = f" after {actuator.delay * MILLI:g} ms" if actuator.delay else ""
    cycles = f"{actuator.cycles} cycle{'' if actuator.cycles == 1 else 's'}"
    return f"{cycles} of {(actuator.stroke or 0) * MICRO:g} um at {actuator.frequency:g} Hz{delay}"
