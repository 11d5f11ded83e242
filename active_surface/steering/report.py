"""Results in words and in numbers: what the commands print."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from active_surface.steering.following import Progress
from active_surface.steering.knobs import Stop
from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.robustness import DEFAULT_TEXT, Scatter, disturbance_text
from active_surface.steering.task import Route
from coupling.case import ActuatorCase, amplitude
from coupling.report import joined

MICRO, MILLI = 1e6, 1e3
WIDER = 2.0  # times a bound: what a hint proposes
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
        "at_bounds": [
            {
                "actuator": stop.knob.actuator,
                "key": stop.knob.key,
                "bound": stop.bound,
            }
            for stop in result.stops
        ],
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
    others = [
        k
        for k, actuator in enumerate(result.legs[0].actuators if len(result.legs) == 1 else ())
        if k not in result.legs[0].movers and amplitude(actuator)
    ]
    rows += [("others", "driven as in the case")] if others else []
    rows += [] if result.reached else [("hint", text) for text in hints(result.stops)]
    return rows + _last_lines(result)


def hints(stops: Sequence[Stop]) -> list[str]:
    """What stood at a bound of the search, and the line of an aim file that widens it."""
    groups: dict[tuple[str, bool], list[Stop]] = {}
    for stop in stops:
        groups.setdefault((stop.knob.key, stop.highest), []).append(stop)
    texts = []
    for (key, highest), group in groups.items():
        numbers = sorted({stop.knob.actuator for stop in group})
        low, high = min(stop.knob.low for stop in group), max(stop.knob.high for stop in group)
        values = sorted({_value(key, stop.knob.high if highest else stop.knob.low) for stop in group})
        own = "its" if len(numbers) == 1 else "their"
        which = {"cycles": "largest number of cycles"}.get(key, f"{'largest' if highest else 'smallest'} {key}")
        wider = [_value(key, low if highest else low * WIDER ** (-1 if low > 0 else 1)), _value(key, high * WIDER)]
        wider[1] = wider[1] if highest else _value(key, high)
        bounds = ", ".join(text if key == "cycles" else f'"{text}"' for text in wider)
        who = f"actuator{'s' * (len(numbers) > 1)} {joined([str(k) for k in numbers])}"
        texts.append(f"{who} stood at {own} {which}, {joined(values)}; {key} = [{bounds}] in [aim] widens it")
    return texts


def _value(key: str, value: float) -> str:
    """A value of a knob in words."""
    if key == "cycles":
        return f"{value:.0f}"
    factor, unit = {"stroke": (MICRO, "um"), "delay": (MILLI, "ms"), "frequency": (1.0, "Hz")}[key]
    return f"{value * factor:g} {unit}"


def ended(route: Route, progress: Progress) -> tuple[bool, dict[str, Any], list[tuple[str, str]]]:
    """Whether a plan that was followed to its end met every way-point; its figures, and rows to print."""
    tolerance = route.settings.tolerance
    distances = [math.dist(end, target) for end, target in zip(progress.ends, route.through, strict=True)]
    complete = all(distance <= tolerance for distance in distances)
    rows = [
        (f"way-point {k}", f"{point(target)}: {distance * MICRO:.4f} um off, {_verdict(distance, tolerance)}")
        for k, (target, distance) in enumerate(zip(route.through, distances, strict=True))
    ]
    rows.append(("plan", "at its end: no way-point is left"))
    return complete, {"measured": progress.place, "distances": distances, "complete": complete}, rows


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
        where = f"{point(result.route.through[k])} by {time * MILLI:g} ms: {distance * MICRO:.4f} um off"
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
    text = disturbance_text(result.settings.disturbances)
    scatter = (
        "not looked for, after Ctrl-C"
        if result.scatter is None
        else scatter_line(result.scatter, text, result.settings.cvar)
    )
    warnings = [("warning", text) for text in result.warnings]
    return [("scatter", scatter), *(("wrote", str(file)) for file in result.files), *warnings]


def _verdict(distance: float, tolerance: float) -> str:
    return f"{'within' if distance <= tolerance else 'not within'} the {tolerance * MICRO:g} um tolerance"


def point(place: tuple[float, float]) -> str:
    """A place [m] in words."""
    return f"({place[0] * MICRO:g}, {place[1] * MICRO:g}) um"


def scatter_line(scatter: Scatter, disturbances: str = DEFAULT_TEXT, cvar: float | None = None) -> str:
    """How far runs with disturbances end from the target, in words: of shares without lost ones."""
    shares = {"half": 0.5, "90 %": 0.9, "all": 1.0}
    result = {name: scatter.quantile(share) * MICRO for name, share in shares.items()}
    within = ", ".join(f"{name} within {away:.3g} um" for name, away in result.items() if math.isfinite(away))
    parts = [f"{within} of the target"] if within else []
    if cvar is not None and math.isfinite(tail := scatter.cvar(cvar)):
        parts.append(f"the worst {100 * (1 - cvar):.3g} % {tail * MICRO:.3g} um off on average")
    parts += [f"{scatter.lost} lost"] if scatter.lost else []
    count = len(scatter.distance)
    return f"{'; '.join(parts)} ({count} runs with {disturbances})"


def _drive(actuator: ActuatorCase) -> str:
    delay = f" after {actuator.delay * MILLI:g} ms" if actuator.delay else ""
    cycles = f"{actuator.cycles} cycle{'' if actuator.cycles == 1 else 's'}"
    return f"{cycles} of {(actuator.stroke or 0) * MICRO:g} um at {actuator.frequency:g} Hz{delay}"
