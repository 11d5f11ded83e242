"""Figure 16: two actuators at one frequency, at which the part stays with the first one or goes to the other."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import MICRO, FigureResult, finish
from active_surface.paper.figures.coming_off import length, off_numbers
from active_surface.paper.figures.pairs import JUMPS, Paths, draw_plane, joined, paths_of, reaches
from active_surface.paper.models import Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.share import Share, percents, share_of
from active_surface.paper.verdict import Answer, Verdict

START: Final[Place] = (-50e-6, 15e-6)  # m, that of figure 21: figure 16's is not stated
FREQUENCIES: Final = (250.0, 350.0, 450.0, 550.0, 650.0)  # Hz, the low one first
CYCLES: Final = 10


class Trend(NamedTuple):
    """What becomes of the part over one surface; the tuples by frequency."""

    returns: Share  # at the low frequency: crosses the first actuator and is back with it in the end
    stay: tuple[Share, ...]  # never come into the neighbour's region, and are on the surface in the end
    reach: tuple[Share, ...]  # come into the neighbour's region
    off: tuple[Share, ...]  # come off
    rim: tuple[Share, ...]  # go over the rim
    unknown: tuple[Share, ...]

    @property
    def met(self) -> float:
        """Half for the low frequency's path, half for the contrast between it and all others."""
        low, *high = (share.met for share in self.reach)
        apart = 0.0 if low == 1 or min(high) == 0 else 1.0 if low == 0 and min(high) == 1 else 0.5
        return (self.returns.met + apart) / 2


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Paths at every frequency, from jittered starts."""
    p = bench.parameters
    paths = {frequency: paths_of(bench, effort, [frequency] * 2, START, CYCLES) for frequency in FREQUENCIES}
    drawn = {f: {name: rows[0].drawn(300) for name, rows in both.items()} for f, both in paths.items()}

    def draw(figure: Figure) -> None:
        axes = [figure.add_subplot(2, 3, k + 1) for k in range(len(FREQUENCIES))]
        for one, (frequency, rows) in zip(axes, drawn.items(), strict=True):
            draw_plane(one, rows, p.pitch)
            finish(one, "x [µm]", "y [µm]", f"{frequency:g} Hz", legend=False)
        figure.legend(*axes[0].get_legend_handles_labels(), loc=(0.75, 0.2), frameon=False)

    data: dict[str, Any] = {"frequencies": list(FREQUENCIES), "start": list(START)}
    data |= {f"{f:g} Hz, {name}": rows.tolist() for f, both in drawn.items() for name, rows in both.items()}
    return FigureResult("fig16", "Two actuators at one frequency", (_verdict(paths, p.pitch),), data, draw, (12.5, 6.6),
                 f"Paths from ({MICRO * START[0]:g}, {MICRO * START[1]:g}) um in {CYCLES} cycles; "
                 "crosses: their ends.")  # fmt: skip


def crosses_and_returns(path: Path, pitch: float) -> bool:
    """Whether the part gets beyond actuator 1, as seen from its start, and ends on the surface in its region."""
    beyond = (path.place @ path.place[0] < 0).any()
    return bool(beyond) and path.attached and bool(path.away()[-1] < pitch / 2)


def goes_over(path: Path, pitch: float) -> bool:
    """Whether the part ever comes into the neighbour's region."""
    return reaches(path, (pitch, 0.0), pitch) < np.inf


def trend_of(paths: dict[float, list[Path]], pitch: float) -> Trend:
    """What becomes of parts over one surface, of paths by frequency, the low one first."""
    rows = list(paths.values())
    return Trend(
        share_of(crosses_and_returns(path, pitch) for path in rows[0]),
        tuple(share_of(path.attached and not goes_over(path, pitch) for path in row) for row in rows),
        tuple(share_of(goes_over(path, pitch) for path in row) for row in rows),
        tuple(share_of(path.came_off for path in row) for row in rows),
        tuple(share_of(path.over_rim for path in row) for row in rows),
        tuple(share_of(path.unknown for path in row) for row in rows),
    )


def _verdict(paths: dict[float, Paths], pitch: float) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {"frequencies": list(FREQUENCIES)}
    places = [(0.0, 0.0), (pitch, 0.0)]
    for name in paths[FREQUENCIES[0]]:
        own = {frequency: both[name] for frequency, both in paths.items()}
        trend = trend_of(own, pitch)
        numbers |= {
            f"{what}, {name}": [share.value for share in shares]
            for what, shares in zip(trend._fields[1:], trend[1:], strict=True)
        }
        numbers[f"crosses_and_returns, {name}"] = trend.returns.value
        numbers[f"coming_off, {name}"] = [off_numbers(row, places) for row in own.values()]
        text = (
            f"at {FREQUENCIES[0]:g} Hz {trend.returns} cross and return, {trend.reach[0]} reach the neighbour; at all "
            f"frequencies stay with the first: {percents(trend.stay)}; reach the neighbour: {percents(trend.reach)}; "
            f"come off: {percents(trend.off)}{_where(numbers[f'coming_off, {name}'])}; go over the rim: "
            f"{percents(trend.rim)}"
        )
        answers[name] = Answer(text, trend.met)
    return Verdict(
        "16", "At 250 Hz the part crosses the first actuator and returns to it; at higher frequencies up to 650 Hz it "
        "goes to the neighbour.", joined(answers),
        f"Shares at {', '.join(f'{f:g}' for f in FREQUENCIES)} Hz. An actuator's region is what lies within half a "
        "pitch of it. Crossed: the part was on the other side of the first actuator than at its start; returned: it "
        "ends in its region, on the surface. The trend is met if in the same model few reach the neighbour at the low "
        "frequency and most at every other. "
        f"{JUMPS}The start is not stated; taken as in figure 21.", numbers,
    )  # fmt: skip


def _where(coming_off: list[dict[str, float]]) -> str:
    """How far from the nearest actuator parts come off, in words."""
    medians = [length(one["median_distance"]) if "median_distance" in one else "-" for one in coming_off]
    return "" if set(medians) == {"-"} else f", half of them within {', '.join(medians)} of an actuator"
