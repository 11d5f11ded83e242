"""Figure 22, and beyond it: how far from the actuator parts come to lie, as a distribution."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import COLOURS, MICRO, FigureResult, finish, look
from active_surface.paper.models import MODELS, Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.share import Share, percents, share_of
from active_surface.paper.verdict import Answer, Verdict

FREQUENCIES: Final = np.arange(240.0, 321.0, 10.0)  # Hz
STATES: Final[tuple[tuple[Place, Place], ...]] = (
    ((80e-6, 80e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.01, 0.01)),
    ((120e-6, 40e-6), (0.0, 0.0)),
    ((60e-6, 100e-6), (0.01, -0.01)),
)
"""Places [m] and velocities [m/s]; the paper names the first and the third."""
BAND, FINE = 5e-6, 1e-6  # m
NAMED: Final = ((0, 250.0), (2, 300.0))  # states and Hz for which it states less than FINE
FEWER_STARTS: Final = 5
TOP: Final = 400.0  # um, where parts that are gone are drawn


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Distances from the actuator, (frequencies, states, starts) in every model; nan: the part is gone."""
    away = {model: distances(bench, model, max(bench.starts_of(model, effort) // FEWER_STARTS, 1)) for model in MODELS}
    named = {model: named_distances(bench, model, bench.starts_of(model, effort)) for model in MODELS}

    def draw(figure: Figure) -> None:
        *panels, right = figure.subplots(1, len(MODELS) + 1)
        for axes, (model, rows) in zip(panels, away.items(), strict=True):
            for k, (place, velocity) in enumerate(STATES):
                moving = f", {velocity[0]:g}, {velocity[1]:g} m/s" if any(velocity) else ", at rest"
                label = f"({MICRO * place[0]:g}, {MICRO * place[1]:g}) µm{moving}"
                across, up = np.repeat(FREQUENCIES + 1.3 * (k - 2), rows.shape[2]), MICRO * rows[:, k].ravel()
                gone = np.isnan(up)
                axes.plot(across[~gone], up[~gone], ".", color=COLOURS[k], markersize=4, label=label)
                axes.plot(across[gone], np.full(gone.sum(), TOP), "x", color=COLOURS[k], markersize=4)
            for k, frequency in NAMED:
                row = int(np.argmin(np.abs(FREQUENCIES - frequency)))
                axes.plot(frequency + 1.3 * (k - 2), MICRO * rows[row, k, 0], "*", color="none",
                          markeredgecolor="black", markersize=11, zorder=5)  # fmt: skip
            axes.axhspan(0, MICRO * BAND, color="#3d8a4e", alpha=0.12)
            axes.set_yscale("symlog", linthresh=1.0)
            axes.set_ylim(0, 1.3 * TOP)
            finish(axes, "frequency [Hz]", "distance from the actuator [µm]" if axes is panels[0] else "",
                   MODELS[model], legend=False)  # fmt: skip
            ends = np.sort(np.where(np.isnan(rows), np.inf, rows).ravel())
            right.plot(MICRO * ends, 100 * np.arange(1, len(ends) + 1) / len(ends), **look(model))
        panels[0].plot([], [], "x", color="black", label="gone")
        panels[0].plot([], [], "*", color="none", markeredgecolor="black", label="the paper's two cases")
        handles, names = panels[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False, fontsize=8)
        right.axvspan(0, MICRO * BAND, color="#3d8a4e", alpha=0.12)
        right.set_xlim(0, 15)
        right.set_ylim(0, 100)
        finish(right, "distance from the actuator [µm]", "share of the parts [%]", "as a distribution")

    data: dict[str, Any] = {"frequencies": FREQUENCIES.tolist(), "states": [list(map(list, state)) for state in STATES]}
    data |= {model: np.where(np.isnan(rows), -1.0, rows).tolist() for model, rows in away.items()}
    verdicts = (_band(bench, away), _fine(away), _named(named))
    return FigureResult("fig22", "Accuracy of placement", verdicts, data, draw, (16.0, 4.8),
                 f"Where parts lie after {bench.parameters.cycles} cycles, 240 to 320 Hz, five states with displaced "
                 "starts; green: the paper's 5 µm; -1 in the data: the part is gone.")  # fmt: skip


def ends(bench: Bench, model: str, states: list[tuple[Place, Place]], frequency: float, count: int) -> FloatArray:
    """Distances [m] from the actuator after the cycles, (states, count); nan: the part is gone."""
    drive = bench.drive(frequency)
    starts = np.concatenate([bench.starts(place, count) for place, _ in states])
    speeds = np.repeat([velocity for _, velocity in states], count, axis=0)
    paths = bench.paths(model, [drive], starts, bench.duration(drive), speeds)
    away = [path.away()[-1] if path.attached else np.nan for path in paths]
    return np.reshape(away, (len(states), count))


def distances(bench: Bench, model: str, count: int) -> FloatArray:
    """Of all states at all frequencies: (frequencies, states, count) [m]."""
    return np.stack([ends(bench, model, list(STATES), frequency, count) for frequency in FREQUENCIES.tolist()])


def named_distances(bench: Bench, model: str, count: int) -> FloatArray:
    """Of the two cases that the paper names: (2, count) [m]."""
    return np.concatenate([ends(bench, model, [STATES[k]], frequency, count) for k, frequency in NAMED])


def within(away: FloatArray, limit: float) -> Share:
    """The share of distances (...) up to a limit [m]; parts that are gone count as farther."""
    return share_of((away <= limit).ravel().tolist())


def _band(bench: Bench, away: dict[str, FloatArray]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {"frequencies": FREQUENCIES.tolist()}
    for model, rows in away.items():
        share, by_frequency = within(rows, BAND), [within(row, BAND) for row in rows]
        kept = rows[np.isfinite(rows)]
        median, percentile_90 = (float(np.percentile(kept, q)) if len(kept) else float("nan") for q in (50, 90))
        numbers[model] = {
            "share": share.value, "by_frequency": [one.value for one in by_frequency], "median": median,
            "percentile_90": percentile_90, "gone": float(np.isnan(rows).mean()), "parts": rows.size,
        }  # fmt: skip
        least, best = min(by_frequency), max(by_frequency)
        answers[model] = Answer(
            f"{share}, by frequency {100 * least.value:.0f} to {100 * best.value:.0f} %",
            float(np.mean([one.met for one in by_frequency])),
            f"of {rows.size} parts, by frequency {percents(by_frequency)}; median {MICRO * median:.1f}, 90 % within "
            f"{MICRO * percentile_90:.1f} um",
        )
    return Verdict(
        "22", "Parts come to lie within 5 um of the actuator, for 240 to 320 Hz and a set of states.", answers,
        f"The paper names two states; here five, displaced by up to {MICRO * bench.parameters.jitter:g} um, "
        f"{bench.parameters.cycles} cycles. Met as far as it is at each of the {len(FREQUENCIES)} frequencies. Parts "
        "stop anywhere within the zone around the actuator where friction holds them, whose size depends on "
        "frequency.", numbers,
    )  # fmt: skip


def _fine(away: dict[str, FloatArray]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in away.items():
        share = within(rows, FINE)
        states = int((rows <= FINE).any(axis=2).sum())
        numbers[model] = {"share": share.value, "combinations": states}
        answers[model] = Answer(
            f"{states} of {rows[..., 0].size} combinations", float(states > 0), f"{share} of the parts"
        )
    return Verdict(
        "22 (1 um)", "For certain combinations of parameters it is less than 1 um.", answers,
        "Combinations of state and frequency. The statement asks for some only.", numbers,
    )  # fmt: skip


def _named(named: dict[str, FloatArray]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, rows in named.items():
        shares = [within(row, FINE) for row in rows]
        numbers[model] = {"shares": [share.value for share in shares], "stated_starts": rows[:, 0].tolist()}
        stated = " and ".join(f"{MICRO * away:.1f}" for away in rows[:, 0].tolist())
        answers[model] = Answer(
            " and ".join(map(str, shares)),
            float(np.mean([share.met for share in shares])),
            f"of {rows.shape[1]} starts; the stated ones {stated} um",
        )
    return Verdict(
        "22 (two cases)", "Less than 1 um from (80, 80) um at 250 Hz, and from (100, 100) um with (0.01, 0.01) m/s at "
        "300 Hz.", answers, "Where in that zone a single part stops is chance to the last micrometre of its start.",
        numbers,
    )  # fmt: skip
