"""What was found in words and in numbers: what the commands print."""

from __future__ import annotations

from typing import Any

from coupling.drive_case import ActuatorCase
from steering.aimed import Aimed
from steering.planning import Planned
from steering.scatter import Scatter

MICRO, MILLI = 1e6, 1e3


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
        "drives": {
            str(k): {key: getattr(found.case.actuators[k], key) for key in ("frequency", "stroke", "delay", "cycles")}
            for k in found.task.movers
        },
        "scatter": found.scatter.as_dict(),
        "files": [str(file) for file in found.files],
    }


def lines(found: Aimed) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    tolerance = found.task.settings.tolerance * MICRO
    verdict = "within" if found.reached else "not within"
    how = ", stopped by Ctrl-C" if found.interrupted else ""
    rows = [
        ("target", point(found.task.target)),
        (
            "distance",
            f"{found.distance * MICRO:.4f} um, {verdict} the {tolerance:g} um wanted; {found.paths} paths{how}",
        ),
        ("outcome", f"{found.trajectory.outcome}. {found.trajectory.sentence}"),
    ]
    for k in found.task.movers:
        rows.append((f"actuator {k}", _drive(found.case.actuators[k])))
    return [*rows, ("scatter", scatter_line(found.scatter)), *(("wrote", str(file)) for file in found.files)]


def plan_figures(found: Planned) -> dict[str, Any]:
    """The figures of a plan by name, in SI units."""
    legs = zip(found.route.through, found.arrivals, found.distances, strict=False)
    return {
        "legs": [{"target": target, "arrival": time, "distance": distance} for target, time, distance in legs],
        "complete": found.complete,
        "outcome": found.trajectory.outcome.value,
        "interrupted": found.interrupted,
        "paths": found.paths,
        "scatter": found.scatter.as_dict(),
        "files": [str(file) for file in found.files],
    }


def plan_lines(found: Planned) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    rows = []
    for k, (time, distance) in enumerate(zip(found.arrivals, found.distances, strict=True)):
        where = f"{point(found.route.through[k])} by {time * MILLI:g} ms, but for {distance * MICRO:.4f} um"
        rows.append((f"leg {k + 1}", where))
    count = f"{len(found.arrivals)} of {len(found.route.through)} legs; {found.paths} paths"
    rows.append(("found", count + (", stopped by Ctrl-C" if found.interrupted else "")))
    rows.append(("outcome", f"{found.trajectory.outcome}. {found.trajectory.sentence}"))
    return [*rows, ("scatter", scatter_line(found.scatter)), *(("wrote", str(file)) for file in found.files)]


def point(place: tuple[float, float]) -> str:
    """A place [m] in words."""
    return f"({place[0] * MICRO:g}, {place[1] * MICRO:g}) um"


def scatter_line(scatter: Scatter) -> str:
    """How far disturbed runs end from the target, in words."""
    half, most, worst = (scatter.quantile(share) * MICRO for share in (0.5, 0.9, 1.0))
    lost = f"; {scatter.lost} lost" if scatter.lost else ""
    return (
        f"half within {half:.3g} um, 90 % within {most:.3g} um, all within {worst:.3g} um of the target{lost} "
        f"({len(scatter.distance)} runs with friction and strokes up to 1 %, starts up to 1 um off)"
    )


def _drive(actuator: ActuatorCase) -> str:
    delay = f" after {actuator.delay * MILLI:g} ms" if actuator.delay else ""
    cycles = f"{actuator.cycles} cycle{'' if actuator.cycles == 1 else 's'}"
    return f"{cycles} of {(actuator.stroke or 0) * MICRO:g} um at {actuator.frequency:g} Hz{delay}"
