"""Figures 16, 20 and 21: two actuators at one frequency or two, and where the part goes.

Over added profiles, over the nearest actuator's alone, which jump half-way between the actuators, and over a plate.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from active_surface.paper.bench import CLOSED, OVER, PAPER, PLATE, STAYS, Bench, Path, Place, coming_off
from active_surface.paper.picture import GREY, MICRO, Curve, Found, Panel, dots, ways
from active_surface.paper.profiles import NEAREST, SUPERPOSED
from active_surface.paper.verdict import Share, share_of
from particle import Drive

SURFACES: Final[dict[str, tuple[str, str]]] = {
    "paper, nearest": (PAPER, NEAREST),
    "paper, superposed": (PAPER, SUPERPOSED),
    "closed, nearest": (CLOSED, NEAREST),
    "closed, superposed": (CLOSED, SUPERPOSED),
    "plate": (PLATE, SUPERPOSED),
}
"""Models and how the closed forms are put together."""
START: Final[Place] = (-100e-6, 0.0)  # m, of figure 16; left open
SIXTEEN: Final = (250.0, 350.0, 450.0, 550.0, 650.0)  # Hz, the low one first
CYCLES: Final = 1  # left open
SETTLED: Final = 5.0  # periods in which the part then comes to rest
AROUND: Final = 100e-6  # m beyond the actuators, from where parts are placed anywhere
OSCILLATIONS, LATE = 5.0, 1.0  # of the fast actuator, after which figure 20's part is with the slow one
Paths = dict[str, list[Path]]  # by name of SURFACES


class Handover(NamedTuple):
    """Which actuator has which frequency, and where the part begins."""

    frequencies: tuple[float, float]  # Hz, at (0, 0) and at (pitch, 0)
    start: Place  # m

    def target(self, pitch: float) -> Place:
        """Where [m] the slow actuator is."""
        return int(np.argmin(self.frequencies)) * pitch, 0.0


HANDOVERS: Final = {
    "20": Handover((300.0, 450.0), (100e-6, 0.0)),
    "21": Handover((400.0, 300.0), (-50e-6, 15e-6)),
}


def paths_of(bench: Bench, drives: Sequence[Drive], start: Place | None, duration: float | None = None) -> Paths:
    """Paths by surface from jittered starts, or from anywhere; drives of the actuators at (0, 0) and (pitch, 0)."""
    found = {}
    for name, (model, actuators) in SURFACES.items():
        count = bench.count(model)
        starts: ArrayLike = anywhere(bench, count) if start is None else bench.starts(start, count)
        found[name] = bench.paths(model, drives, starts, duration, ground=bench.ground(model, actuators))
    return found


def anywhere(bench: Bench, count: int) -> ArrayLike:
    """Places (count, 2) [m] drawn around both actuators; the same ones in every model."""
    p = bench.parameters
    return np.random.default_rng(p.seed).uniform([-AROUND, -AROUND], [p.pitch + AROUND, AROUND], (count, 2))


def neighbours(bench: Bench) -> Found:
    """Two actuators at one frequency, at which the part stays with the first one or goes to the other."""
    p = bench.parameters
    paths = {}
    for frequency in SIXTEEN:
        drives = [bench.drive(frequency, cycles=CYCLES)] * 2
        paths[frequency] = paths_of(bench, drives, START, (CYCLES + SETTLED) / frequency)
    numbers: dict[str, Any] = {}
    panels = []
    for name in SURFACES:
        own = {frequency: both[name] for frequency, both in paths.items()}
        off = [coming_off(row, [(0.0, 0.0), (p.pitch, 0.0)]) for row in own.values()]
        numbers[name] = {"frequencies": SIXTEEN, **trend_of(own, p.pitch), "coming_off": off}
        lines = [("y", MICRO * place, MICRO * place, GREY) for place in (0.0, p.pitch / 2, p.pitch)]
        panels.append([
            Panel("time [cycles]", f"{name}\nx [µm]", _across(row, f), f"{f:g} Hz", lines, legend=False)
            for f, row in own.items()
        ])  # fmt: skip
    waves: dict[str, Any] = {PAPER: {"2 a": p.pitch / (2 * p.radius), "a": p.pitch / p.radius}}
    return {"VI-B": waves, "16": numbers}, panels


def _across(paths: list[Path], frequency: float) -> list[Curve]:
    return ways(paths, lambda rows: frequency * rows[:, 0], lambda rows: MICRO * rows[:, 1])


def crosses_and_returns(path: Path, pitch: float) -> bool:
    """Whether the part gets beyond actuator 1, as seen from its start, and ends on the surface in its region."""
    beyond = (path.place @ path.place[0] < 0).any()
    return bool(beyond) and path.end == STAYS and bool(path.away()[-1] < pitch / 2)


def goes_over(path: Path, pitch: float) -> bool:
    """Whether the part ever comes into the neighbour's region."""
    return path.reaches((pitch, 0.0), pitch / 2) < np.inf


def trend_of(paths: dict[float, list[Path]], pitch: float) -> dict[str, Share | list[Share]]:
    """What becomes of parts over one surface, of paths by frequency, the low one first.

    "returns": the share that crosses the first actuator at the low frequency and is back with it in the end. By
    frequency: "reach" come into the neighbour's region, "rim" go over the rim.
    """
    rows = list(paths.values())
    return {
        "returns": share_of(crosses_and_returns(path, pitch) for path in rows[0]),
        "reach": [share_of(goes_over(path, pitch) for path in row) for row in rows],
        "rim": [share_of(path.end == OVER for path in row) for row in rows],
    }


def handover(bench: Bench) -> Found:
    """From an actuator with a high frequency to its neighbour with a low one: both figures, and starts anywhere."""
    p = bench.parameters
    places = [(0.0, 0.0), (p.pitch, 0.0)]
    numbers: dict[str, dict[str, Any]] = {name: {} for name in ("20", "20 (five cycles)", "21", "VI-C (anywhere)")}
    panels = []
    for figure, one, start in (
        *((name, one, one.start) for name, one in HANDOVERS.items()),
        ("VI-C (anywhere)", HANDOVERS["20"], None),
    ):
        drives = [bench.drive(frequency) for frequency in one.frequencies]
        row = []
        for name, paths in paths_of(bench, drives, start).items():
            does = [arrives(bench, one, path) for path in paths]
            numbers[figure][name] = {
                "share": share_of(does),
                "over_the_rim": share_of(path.end == OVER for path in paths),
                "coming_off": coming_off(paths, places),
                "first_start_arrives": does[0],
                "starts": len(paths),
            }
            if figure == "20":
                numbers["20 (five cycles)"][name] = five_cycles(bench, paths)
            title = f"{figure}, {name}\n{share_of(does)} arrive"
            row.append(Panel("x [µm]", "y [µm]", _plane(paths, one, p.pitch), title, legend=False, settings={
                "xlim": (-MICRO * p.radius - 20, MICRO * (p.pitch + p.radius) + 20),
                "ylim": (-MICRO * p.radius - 20, MICRO * p.radius + 20), "aspect": "equal",
            }))  # fmt: skip
        panels.append(row)
    return numbers, panels


def _plane(paths: list[Path], one: Handover, pitch: float) -> list[Curve]:
    slow = one.target(pitch)[0]
    triangles = [
        Curve([MICRO * place], [0], dots("^", "black", label, 9, markerfacecolor=face))
        for place, label, face in ((slow, "the slow one", "#b8862d"), (pitch - slow, "the fast one", "white"))
    ]
    return [*triangles, *ways(paths, lambda rows: MICRO * rows[:, 1], lambda rows: MICRO * rows[:, 2])]


def arrives(bench: Bench, one: Handover, path: Path) -> bool:
    """Whether a part converges to the slow actuator."""
    p = bench.parameters
    return path.converged(1 / min(one.frequencies), p.near, one.target(p.pitch))


def cycles_until_there(bench: Bench, one: Handover, path: Path) -> float:
    """How many cycles the fast actuator has made when the part comes into the slow one's region; inf: it never does."""
    pitch = bench.parameters.pitch
    return path.reaches(one.target(pitch), pitch / 2) * max(one.frequencies)


def five_cycles(bench: Bench, paths: list[Path]) -> dict[str, Any]:
    """The shares of figure 20's parts that are in the slow one's region after five cycles, and that ever get there."""
    cycles = np.array([cycles_until_there(bench, HANDOVERS["20"], path) for path in paths])
    return {
        "share": share_of(np.abs(cycles - OSCILLATIONS) <= LATE),
        "get_there": share_of(np.isfinite(cycles)),
        "cycles_of_the_stated_start": float(cycles[0]),
    }
