"""Figures 15, 17, 19 and 22: one actuator that carries parts away, draws them to itself, or throws them out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from active_surface.paper.bench import MODELS, STAYS, Bench, Path, Place, coming_off
from active_surface.paper.picture import (
    COLOURS,
    GOLD,
    GREEN,
    MICRO,
    MILLI,
    Curve,
    Found,
    Panel,
    dots,
    look,
    ways,
)
from active_surface.paper.statements import BAND, FINE
from active_surface.paper.verdict import Share, share_of

CARRIED: Final = 100.0, 1600.0  # Hz, figure 15
CARRIED_FOR: Final = 20e-3  # s, after which every part has come to rest
CARRIED_FAR: Final = 0.1e-6  # m: a part that goes less far is held by friction
LOW, HIGH, ANY = 300.0, 600.0, 250.0  # Hz, figures 17a, 17b and 19
STROKES_TO_LEAVE: Final = 2  # in which the part of figure 17b is gone: taken as cycles
REACH, FASTEST = 150e-6, 0.02  # m and m/s: the states of figure 19, which the paper does not list
PLACING: Final = np.arange(240.0, 321.0, 10.0)  # Hz, figure 22
STATES: Final[tuple[tuple[Place, Place], ...]] = (
    ((80e-6, 80e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.0, 0.0)),
    ((100e-6, 100e-6), (0.01, 0.01)),
    ((120e-6, 40e-6), (0.0, 0.0)),
    ((60e-6, 100e-6), (0.01, -0.01)),
)
"""Places [m] and velocities [m/s] of figure 22; the paper names the first and the third."""
NAMED: Final = ((0, 250.0), (2, 300.0))  # states and Hz for which it states less than 1 um


def translocation(bench: Bench) -> Found:
    """How far one cycle of one actuator carries the part, over frequency, for several strokes."""
    p = bench.parameters
    frequencies = np.geomspace(*CARRIED, bench.effort.frequencies)
    numbers: dict[str, Any] = {}
    panels = []
    for model in MODELS:
        distance, outcome = carried(bench, model, frequencies)
        first, last, beyond = zip(
            *[window(frequencies, *rows) for rows in zip(distance, outcome, strict=True)], strict=True
        )
        numbers[model] = {"first": first, "last": last, "beyond_the_last": beyond, "grows": grows(distance)}
        curves = []
        for stroke, row, colour in zip(p.carrying, MICRO * moving(distance), COLOURS, strict=False):
            curves.append(Curve(frequencies, row, {"color": colour, "label": f"{MICRO * stroke:.4g} µm"}))
            going = np.flatnonzero(np.isfinite(row))
            ends = np.unique([*going[:1], *going[-1:]]).astype(int)
            curves.append(Curve(frequencies[ends], row[ends], dots("o", colour)))
        panels.append(Panel("frequency [Hz]", "distance [µm]", curves, MODELS[model], legend=False))
    return {"15": numbers}, [panels]


def carried(bench: Bench, model: str, frequencies: FloatArray) -> tuple[FloatArray, NDArray[Any]]:
    """Distances (S, F) [m] from the start after one cycle, nan where the part comes off or leaves, and outcomes."""
    p = bench.parameters
    distance = np.full((len(p.carrying), len(frequencies)), np.nan)
    outcome = np.full(distance.shape, "", dtype=object)
    for (i, k), _ in np.ndenumerate(distance):
        drive = bench.drive(float(frequencies[k]), p.carrying[i], cycles=1)
        (path,) = bench.paths(model, [drive], [p.start], max(CARRIED_FOR, 1 / drive.frequency))
        outcome[i, k] = path.trajectory.outcome.value
        if path.end == STAYS:
            distance[i, k] = path.trajectory.distance
    return distance, outcome


def moving(distance: FloatArray) -> FloatArray:
    """The same (S, F) with nan where the part does not move."""
    return np.where(distance > CARRIED_FAR, distance, np.nan)


def grows(distance: FloatArray) -> float:
    """The share of neighbouring frequencies with motion between which the distance grows; nan: there are none."""
    steps = np.diff(moving(distance), axis=1)
    known = steps[np.isfinite(steps)]
    return float((known > 0).mean()) if len(known) else float("nan")


def window(frequencies: FloatArray, distance: FloatArray, outcome: NDArray[Any]) -> tuple[float, float, str]:
    """The first and the last of frequencies (F,) [Hz] at which a part moves and stays, and what becomes of it beyond.

    nan: there is none.
    """
    going = np.flatnonzero(distance > CARRIED_FAR)
    if not len(going):
        return np.nan, np.nan, "not reached"
    beyond = str(outcome[going[-1] + 1]) if going[-1] + 1 < len(distance) else "not reached"
    return float(frequencies[going[0]]), float(frequencies[going[-1]]), beyond


def convergence(bench: Bench) -> Found:
    """One actuator that goes up and down without end, from the paper's start and from many states."""
    p = bench.parameters
    numbers: dict[str, dict[str, Any]] = {"17a": {}, "17b": {}, "19": {}}
    panels: dict[str, list[Panel]] = {"17a": [], "17b": [], "19": []}
    for model in MODELS:
        count = bench.count(model)
        at_rest, moving_on = (bench.starts(p.start, count), (0.0, 0.0)), states(p.seed, count)
        paths = {
            name: bench.paths(model, [bench.drive(f)], places, velocities=velocities)
            for name, f, (places, velocities) in (("17a", LOW, at_rest), ("17b", HIGH, at_rest), ("19", ANY, moving_on))
        }
        numbers["17a"][model] = converging(bench, paths["17a"], LOW)
        numbers["17b"][model] = leaving(bench, paths["17b"])
        numbers["19"][model] = converging(bench, paths["19"], ANY)
        for name, own in paths.items():
            away = ways(own, lambda rows: MILLI * rows[:, 0], lambda rows: MICRO * np.hypot(*rows[:, 1:].T), 12)
            panels[name].append(
                Panel("time [ms]", "distance [µm]", away, f"figure {name}: {MODELS[model]}",
                      [("y", MICRO * p.far, MICRO * p.far, GOLD)], legend=False)
            )  # fmt: skip
    return numbers, list(panels.values())


def states(seed: int, count: int) -> tuple[FloatArray, FloatArray]:
    """Places (count, 2) [m] around the actuator and velocities (count, 2) [m/s]: figure 19."""
    numbers = np.random.default_rng(seed).random((count, 4))
    angle, turn = 2 * np.pi * numbers[:, 1], 2 * np.pi * numbers[:, 3]
    away, speed = REACH * np.sqrt(numbers[:, 0]), FASTEST * numbers[:, 2]
    return (
        np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1),
        np.stack([speed * np.cos(turn), speed * np.sin(turn)], axis=1),
    )


def converging(bench: Bench, paths: list[Path], frequency: float) -> dict[str, Any]:
    """The share of parts that converge, of parts that are lost, and whether the first one converges."""
    p = bench.parameters
    does = [path.converged(1 / frequency, p.near) for path in paths]
    lost = share_of(path.lost(p.far) and not own for path, own in zip(paths, does, strict=True))
    return {"share": share_of(does), "lost": lost, "stated_start_converges": does[0], "starts": len(paths)}


def leaving(bench: Bench, paths: list[Path]) -> dict[str, Any]:
    """The share of figure 17b's parts that leave, in two cycles, and where parts come off."""
    times = np.array([path.leaves_at(bench.parameters.far) for path in paths])
    return {
        "share": share_of(np.isfinite(times)),
        "share_in_two": share_of(times <= STROKES_TO_LEAVE / HIGH),
        "cycles_of_the_stated_start": times[0] * HIGH,
        "coming_off": coming_off(paths, [(0.0, 0.0)]),
        "starts": len(paths),
    }


def accuracy(bench: Bench) -> Found:
    """How far from the actuator parts come to lie, as a distribution; nan: the part is gone."""
    numbers: dict[str, dict[str, Any]] = {"22": {}, "22 (1 um)": {}, "22 (two cases)": {}}
    panels, distributions = [], []
    for model in MODELS:
        count = max(bench.count(model) // 5, 1)  # fewer than elsewhere, as each is followed at every frequency
        rows = np.stack([_placed(bench, model, STATES, frequency, count) for frequency in PLACING.tolist()])
        named = [_placed(bench, model, [STATES[k]], f, bench.count(model))[0] for k, f in NAMED]
        numbers["22"][model] = placing(rows)
        combinations = {"share": within(rows, FINE), "combinations": int((rows <= FINE).any(axis=2).sum())}
        numbers["22 (1 um)"][model] = combinations | {"of": rows[..., 0].size}
        shares = [within(row, FINE) for row in named]
        numbers["22 (two cases)"][model] = {"shares": shares, "stated_starts": [float(row[0]) for row in named]}
        curves = []
        for k, (place, velocity) in enumerate(STATES):
            moving = f", {velocity[0]:g}, {velocity[1]:g} m/s" if any(velocity) else ", at rest"
            label = f"({MICRO * place[0]:g}, {MICRO * place[1]:g}) µm{moving}"
            across = np.repeat(PLACING + 1.3 * (k - 2), count)
            curves.append(Curve(across, MICRO * rows[:, k].ravel(), dots(".", COLOURS[k], label)))
        share = 100 * np.mean(np.isnan(rows))
        panels.append(
            Panel("frequency [Hz]", "distance from the actuator [µm]", curves, f"{MODELS[model]}; {share:.0f} % gone",
                  [("y", 0.0, MICRO * BAND, GREEN)], False, {"yscale": "symlog", "ylim": (0, 500)})
        )  # fmt: skip
        ends = np.sort(np.where(np.isnan(rows), np.inf, rows).ravel())
        distributions.append(Curve(MICRO * ends, 100 * np.arange(1, len(ends) + 1) / len(ends), look(model)))
    panels.append(
        Panel("distance from the actuator [µm]", "share of the parts [%]", distributions, "as a distribution",
              [("x", 0.0, MICRO * BAND, GREEN)], settings={"xlim": (0, 15), "ylim": (0, 100)})
    )  # fmt: skip
    return numbers, [panels]


def _placed(
    bench: Bench, model: str, states: Sequence[tuple[Place, Place]], frequency: float, count: int
) -> FloatArray:
    """Distances [m] from the actuator after the cycles, (states, count); nan: the part is gone."""
    starts = np.concatenate([bench.starts(place, count) for place, _ in states])
    speeds = np.repeat([velocity for _, velocity in states], count, axis=0)
    paths = bench.paths(model, [bench.drive(frequency)], starts, velocities=speeds)
    return np.reshape([path.away()[-1] if path.end == STAYS else np.nan for path in paths], (len(states), count))


def within(away: FloatArray, limit: float) -> Share:
    """The share of distances (...) up to a limit [m]; parts that are gone count as farther."""
    return share_of((away <= limit).ravel().tolist())


def placing(away: FloatArray) -> dict[str, Any]:
    """What distances (frequencies, states, starts) [m] say of figure 22's 5 um."""
    kept = away[np.isfinite(away)]
    median, percentile_90 = (float(np.percentile(kept, q)) if len(kept) else float("nan") for q in (50, 90))
    return {
        "share": within(away, BAND), "by_frequency": [within(row, BAND) for row in away], "median": median,
        "percentile_90": percentile_90, "gone": float(np.isnan(away).mean()), "parts": away.size,
    }  # fmt: skip
