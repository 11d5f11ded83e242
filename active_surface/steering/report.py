"""Results in words and in numbers: what the commands print."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from active_surface.steering.following import Progress
from active_surface.steering.knobs import KEYS, Stop
from active_surface.steering.paths import settled
from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.robustness import DEFAULT_TEXT, Scatter, disturbance_text
from active_surface.steering.task import Route, Task
from common import joined
from coupling.case import ActuatorCase, amplitude, quoted

MICRO, MILLI = 1e6, 1e3
WIDER = 2.0  # times a bound: what a hint proposes


def figures(result: Aimed) -> dict[str, Any]:
    """The figures of an aim by name, in SI units."""
    return {
        "target": result.task.target,
        "end_position": result.trajectory.position[-1].tolist(),
        "heading": result.task.heading,
        "end_heading": None if result.trajectory.heading is None else float(result.trajectory.heading[-1]),
        "heading_missed": result.turn_left,
        "outcome": result.trajectory.outcome.value,
        "distance": result.distance,
        "reached": result.reached,
        "interrupted": result.interrupted,
        "paths": result.paths,
        "at_bounds": [
            {"actuator": k, "key": stop.knob.key, "bound": stop.bound}
            for stop in result.stops
            for k in stop.knob.actuators
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
    task, first = result.task, result.legs[0]
    distance = _verdict(result.distance, task.settings.tolerance)
    if result.distance <= task.settings.tolerance and not result.reached:
        distance += ", but the part has not come to a final rest"
    heading = [] if result.turn_left is None else [("heading", _heading(result))]
    rows = [("target", point(task.target)), ("distance", f"{distance}; {_paths(result)}"), *heading, _outcome(result)]
    for number, leg in enumerate(result.legs):
        if len(result.legs) > 1:
            rows.append((f"leg {number}", f"from {leg.start * MILLI:g} ms on"))
        rows += [(f"actuator {k}", _drive(leg.actuators[k])) for k in leg.movers]
    others = any(amplitude(one) for k, one in enumerate(first.actuators) if k not in first.movers)
    rows += [("others", "driven as in the case")] if others and len(result.legs) == 1 else []
    if (time := result.case.run.duration) > task.case.run.duration:
        own = f"the case's {task.case.run.duration * MILLI:g} ms, in which the part does not get that far"
        rows.append(("time", f"{time * MILLI:.4g} ms in place of {own}"))
    rows += [] if result.reached else [("hint", text) for text in (*hints(result.stops, result), *_idle(task))]
    if result.reached and result.scatter and result.scatter.lost and not (task.settings.quantile or task.settings.cvar):
        lost = f"{result.scatter.lost} of {len(result.scatter.distance)} disturbed runs lose the part"
        rows.append(("hint", f"{lost}; --robust 0.9 looks for drives with which it stays"))
    return rows + _last_lines(result)


def hints(stops: Sequence[Stop], result: SteeringResult) -> list[str]:
    """What may bring a part nearer that has missed: wider bounds for what stood at one, or more time or paths."""
    groups: dict[tuple[str, bool], list[Stop]] = {}
    for stop in stops:
        groups.setdefault((stop.knob.key, stop.highest), []).append(stop)
    texts = []
    for (key, highest), group in groups.items():
        numbers = [str(k) for k in sorted({k for stop in group for k in stop.knob.actuators})]
        low, high = min(stop.knob.low for stop in group), max(stop.knob.high for stop in group)
        if highest:
            high *= WIDER
        else:
            low *= WIDER if low < 0 else 1 / WIDER
        ends = _value(key, low), _value(key, high)
        wider = f"{key} = [{', '.join(ends if key == 'cycles' else map(quoted, ends))}] in [aim]"
        wider = f'--frequency "{":".join(ends)}"' if key == "frequency" else wider
        which = f"{'largest' if highest else 'smallest'} {'number of cycles' if key == 'cycles' else key}"
        values = joined(sorted({_value(key, stop.bound) for stop in group}))
        who, own = ("actuators", "their") if len(numbers) > 1 else ("actuator", "its")
        texts.append(f"{who} {joined(numbers)} stood at {own} {which}, {values}; {wider} allows more")
    if not settled(result.trajectory):
        texts.append("the part is not at rest for good when the run ends: a longer duration leaves it time to stop")
    elif result.interrupted:
        texts.append("Ctrl-C ended the search early; without it more drives are tried")
    elif not texts:
        more = f"paths = {2 * result.paths} in [aim] tries more"
        texts.append(f"none of the drives tried brings the part nearer; {more}, and `plan` goes there in steps")
    return texts


def _idle(task: Task) -> list[str]:
    """Which actuators the search does not drive, as they have no stroke to lessen."""
    idle = [str(k) for k, one in enumerate(task.case.actuators) if not (amplitude(one) or task.settings.stroke)]
    if not idle:
        return []
    who, them = ("actuators", "them") if len(idle) > 1 else ("actuator", "it")
    return [f"{who} {joined(idle)} stayed at rest, as the case gives {them} no stroke"]


def _value(key: str, value: float) -> str:
    """A value of a knob in words."""
    if key == "cycles":
        return f"{value:.0f}"
    factor, unit = {"stroke": (MICRO, "um"), "delay": (MILLI, "ms"), "frequency": (1.0, "Hz")}[key]
    return f"{value * factor:g} {unit}"


def ended(route: Route, progress: Progress) -> tuple[bool, dict[str, Any], list[tuple[str, str]]]:
    """Whether a plan that was followed to its end met every way-point; its figures, and rows to print."""
    tolerance = route.settings.tolerance
    distances = route.distances(progress.ends)
    complete = all(distance <= tolerance for distance in distances)
    rows = [
        (f"way-point {k}", f"{point(target)}: {_verdict(distance, tolerance, ' off')}")
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
    route, tolerance, rows = result.route, result.settings.tolerance, []
    legs = zip(route.through, result.arrivals, result.distances, result.stops, strict=False)
    for k, (target, time, distance, stops) in enumerate(legs):
        verdict = _verdict(distance, tolerance, " off")
        rows.append((f"leg {k}", f"{point(target)} by {time * MILLI:g} ms: {verdict}"))
        rows += [("hint", text) for text in hints(stops, result)] if distance > tolerance else []
    if result.failure:
        label, _, reason = result.failure.partition(": ")
        rows.append((label, reason))
    count = f"{sum(result.reached)} of {len(route.through)} way-points within {tolerance * MICRO:g} um"
    return [*rows, ("reached", f"{count}; {_paths(result)}"), _outcome(result), *_last_lines(result)]


def _common(result: SteeringResult) -> dict[str, Any]:
    return {
        "scatter": None if result.scatter is None else result.scatter.as_dict(),
        "warnings": list(result.warnings),
        "files": [str(file) for file in result.files],
    }


def _last_lines(result: SteeringResult) -> list[tuple[str, str]]:
    scatter = "not looked for, after Ctrl-C"
    if result.scatter is not None:
        text = disturbance_text(result.settings.disturbances)
        scatter = scatter_line(result.scatter, text, result.settings.cvar)
    rows = [("scatter", scatter), *(("wrote", str(file)) for file in result.files)]
    return rows + [("warning", text) for text in result.warnings]


def _paths(result: SteeringResult) -> str:
    return f"{result.paths} path{'s' * (result.paths != 1)}{', stopped by Ctrl-C' * result.interrupted}"


def _outcome(result: SteeringResult) -> tuple[str, str]:
    return "outcome", f"{result.trajectory.outcome}. {result.trajectory.sentence}"


def _verdict(distance: float, tolerance: float, off: str = "") -> str:
    """How far from a target [m] the part ends; whether that is a miss."""
    away, of = f"{distance * MICRO:.4f} um", f"within the {tolerance * MICRO:g} um tolerance"
    return f"{away}{off}, {of}" if distance <= tolerance else f"missed by {away}, not {of}"


def _heading(result: Aimed) -> str:
    """The heading that is reached, that of the target, and what of it is missed."""
    turn, left, path = result.task.turn, result.turn_left, result.trajectory.heading
    assert turn is not None and left is not None and path is not None
    reached, missed = math.degrees(path[-1]), math.degrees(left)
    length = f"{abs(left) * turn.gyration * MICRO:.4f} um of the distance"
    return f"{reached:.4f} deg, off {math.degrees(turn.heading):g} deg by {missed:.4f} deg, {length}"


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
