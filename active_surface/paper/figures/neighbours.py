"""Figure 16: two actuators at one frequency, at which the part stays with the first one or goes to the other."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import MICRO, FigureResult, finish
from active_surface.paper.figures.coming_off import length, off_numbers
from active_surface.paper.figures.pairs import JUMPS, SURFACES, Paths, draw_x, joined, legend, paths_of, reaches
from active_surface.paper.models import PAPER, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.share import Share, percents, share_of
from active_surface.paper.verdict import Answer, Verdict

START: Final[Place] = (-100e-6, 0.0)  # m; left open
SIXTEEN: Final = (250.0, 350.0, 450.0, 550.0, 650.0)  # Hz, the low one first
CYCLES: Final = 1  # left open
SETTLED: Final = 5.0  # periods in which the part then comes to rest
THIRD, WITHIN = 0.33, 0.01  # of the wavelength, that the pitch is, and how near counts


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
    paths = {}
    for frequency in SIXTEEN:
        drives = [bench.drive(frequency, cycles=CYCLES)] * 2
        paths[frequency] = paths_of(bench, effort, drives, START, settled(bench, frequency, CYCLES))

    def draw(figure: Figure) -> None:
        axes = figure.subplots(len(SURFACES), len(SIXTEEN), sharex=True, sharey=True)
        for i, name in enumerate(SURFACES):
            for k, frequency in enumerate(SIXTEEN):
                draw_x(axes[i, k], paths[frequency][name], p.pitch, frequency)
                finish(
                    axes[i, k],
                    "time [cycles]" if i == len(SURFACES) - 1 else "",
                    f"{name}\nx [µm]" if k == 0 else "",
                    f"{frequency:g} Hz" if i == 0 else "",
                    legend=False,
                )
        legend(figure, slow=False)

    data: dict[str, Any] = {"frequencies": list(SIXTEEN), "start": list(START)}
    data |= {
        f"{f:g} Hz, {name}": rows[0].drawn(300).tolist() for f, both in paths.items() for name, rows in both.items()
    }
    verdicts = (_third(p.pitch, p.radius), _verdict(paths, p.pitch))
    return FigureResult("fig16", "Two actuators at one frequency", verdicts, data, draw, (14.0, 10.0),
                 f"Paths from ({MICRO * START[0]:g}, {MICRO * START[1]:g}) um in {CYCLES} cycle, and how all "
                 "starts end.")  # fmt: skip


def wave_shares(pitch: float, radius: float) -> dict[str, float]:
    """The pitch over what may be meant by the deformation's wavelength."""
    return {"2 a": pitch / (2 * radius), "a": pitch / radius}


def is_third(share: float) -> bool:
    """Whether that is what the paper states."""
    return abs(share - THIRD) <= WITHIN


def _third(pitch: float, radius: float) -> Verdict:
    shares = wave_shares(pitch, radius)
    met = any(is_third(share) for share in shares.values())
    text = ", ".join(f"{100 * share:.0f} % of {name}" for name, share in shares.items())
    return Verdict(
        "VI-B", "Actuators 150 um apart stand at about 33 % of the deformation's wavelength.",
        {PAPER: Answer(text, float(met))},
        "Which length of the profile is its wavelength is not said. 33 % want 455 um: the diameter of a "
        "profile with a = "
        f"{MICRO * pitch / THIRD / 2:.0f} um, or the radius of one with a = {MICRO * pitch / THIRD:.0f} um.",
        {"shares": shares},
    )  # fmt: skip


def settled(bench: Bench, frequency: float, cycles: int) -> float:
    """How long [s] so many cycles at a frequency [Hz] take, until the part has come to rest."""
    return (cycles + SETTLED) / bench.drive(frequency).frequency


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
    numbers: dict[str, Any] = {"frequencies": list(SIXTEEN)}
    places = [(0.0, 0.0), (pitch, 0.0)]
    for name in paths[SIXTEEN[0]]:
        own = {frequency: both[name] for frequency, both in paths.items()}
        trend = trend_of(own, pitch)
        numbers |= {
            f"{what}, {name}": [share.value for share in shares]
            for what, shares in zip(trend._fields[1:], trend[1:], strict=True)
        }
        numbers[f"crosses_and_returns, {name}"] = trend.returns.value
        numbers[f"coming_off, {name}"] = [off_numbers(row, places) for row in own.values()]
        more = (
            f"stay with the first {percents(trend.stay)}; come off {percents(trend.off)}"
            f"{_where(numbers[f'coming_off, {name}'])}; go over the rim {percents(trend.rim)}"
        )
        text = f"{100 * trend.returns.value:.0f} % return, {percents(trend.reach)} go over"
        answers[name] = Answer(text, trend.met, more)
    return Verdict(
        "16", "At 250 Hz the part crosses the first actuator and returns to it; at higher frequencies up to 650 Hz it "
        "goes to the neighbour.", joined(answers),
        f"Shares at {', '.join(f'{f:g}' for f in SIXTEEN)} Hz. An actuator's region is what lies within half a "
        "pitch of it. Crossed: the part was on the other side of the first actuator than at its start; returned: it "
        "ends in its region, on the surface. The trend is met if in the same model few reach the neighbour at the low "
        "frequency and most at every other. "
        f"{JUMPS}The start and the number of cycles are not stated: ({MICRO * START[0]:g}, "
        f"{MICRO * START[1]:g}) um and "
        f"{CYCLES}.", numbers,
    )  # fmt: skip


def _where(coming_off: list[dict[str, float]]) -> str:
    """How far from the nearest actuator parts come off, in words."""
    medians = [length(one["median_distance"]) if "median_distance" in one else "-" for one in coming_off]
    return "" if set(medians) == {"-"} else f", half of them within {', '.join(medians)} of an actuator"
