"""Single: statements about one actuator, and about none, over what each of them leaves open besides the reading."""

from __future__ import annotations

from typing import Final

import numpy as np

from active_surface.paper.figures import (
    ANY,
    BAND,
    FINE,
    HIGH,
    LOW,
    LOWEST_AREA,
    RADIAL_STARTS,
    STATED_STROKE,
    STATED_THRESHOLD,
    THRESHOLD_WITHIN,
    areas,
    begins,
    checks_of,
    converge,
    curve_answer,
    distances,
    ends_of,
    from_start,
    from_states,
    hills,
    in_range,
    is_third,
    loss_from,
    named_distances,
    one_cycle,
    one_cycle_ends,
    peaks_of_integrals,
    radial_errors,
    shares_around,
    slows_as_stated,
    wave_shares,
    within,
)
from active_surface.paper.loss import first_loss, fits_of
from active_surface.paper.models import DEVICE, PAPER, Bench
from active_surface.paper.parameters import Place
from active_surface.paper.readings.reading import FLAT, SweepSize
from active_surface.paper.share import share_of

Shares = dict[str, dict[str, float]]  # by statement and by what it leaves open: the share that does what the paper says
ONLY: Final = ""  # where a statement leaves nothing open
AREA_STROKES: Final = {
    "80 to 110 um": (80e-6, 95e-6, 110e-6),
    "100 to 200 um": (100e-6, 150e-6, 200e-6),
    "165 to 200 um": (165e-6, 180e-6, 200e-6),
}
CARRYING: Final = {"60 to 100 um": (60e-6, 80e-6, 100e-6), "100 to 200 um": (100e-6, 150e-6, 200e-6)}
CARRIED: Final[dict[str, Place]] = {"(100, 100) um": (100e-6, 100e-6), "(170, 0) um": (170e-6, 0.0)}
ROUND: Final = 1e-6, 1e-6  # how constant the ratio of velocities, and how straight a path is, on a closed form
ROUGHLY, SLOW = (0.1, 1e-3), 0.1  # on a device's elements, whose slopes are rough, and down to which share of the speed
LEAVING: Final = {"two cycles": 2.0, "one cycle": 1.0}
FARS: Final = (150e-6, 200e-6)  # m, beyond which a part has left
CURVE_STROKES: Final = np.array([100e-6, 125e-6, STATED_STROKE, 175e-6, 200e-6])
MAP: Final = np.arange(240.0, 441.0, 20.0)  # Hz, of figure 18 at its stated stroke


def areas_of(bench: Bench, model: str, size: SweepSize) -> Shares:
    """Figures 5 and 6, and the wavelength."""
    factors = np.geomspace(1.0, 50.0, size.frequencies)
    strokes = sorted({stroke for row in AREA_STROKES.values() for stroke in row})
    every = {stroke: areas(bench, model, stroke, factors, size.across) for stroke in strokes}
    results: Shares = {"5": {}, "6": {}, "5, 6 (range)": {}}
    for name, row in AREA_STROKES.items():
        own = [every[stroke] for stroke in row]
        moving = [np.flatnonzero(one.slipping.peak > 0) for one in own]
        onsets = [float(LOWEST_AREA * factors[k[0]]) if len(k) else np.nan for k in moving]
        shapes = hills(LOWEST_AREA * factors, [one.feasible.peak for one in own], [one.lost_area for one in own])
        results["5"][name] = float(np.mean([*begins(onsets), *shapes]))
        results["6"][name] = float(np.mean([300 <= f <= 400 for f in peaks_of_integrals(own)]))
        results["5, 6 (range)"][name] = float(np.mean(in_range(own)[1]))
    return results


def strokes_of(bench: Bench, model: str) -> Shares:
    """Figures 11 to 14, and the wavelength: one cycle at 1.6 kHz."""
    p = bench.parameters
    inside = max(np.hypot(*place) for place in RADIAL_STARTS) < p.radius
    errors = radial_errors(bench, model, *([SLOW] if model == DEVICE else [])) if inside else (np.inf, np.inf)
    results: Shares = {
        name: {ONLY: float(error < bound)}
        for name, error, bound in zip(("11", "12"), errors, ROUGHLY if model == DEVICE else ROUND, strict=True)
    }
    results["13, 14"] = {ONLY: slows_as_stated(bench, model, one_cycle(bench)) if inside else 0.0}
    results["VI-B"] = {
        f"wavelength {name}": float(is_third(share)) for name, share in wave_shares(p.pitch, p.radius).items()
    }
    return results


def carried(benches: dict[str, Bench], model: str, size: SweepSize) -> Shares:
    """Figure 15."""
    frequencies = np.geomspace(100.0, 2000.0, size.frequencies)
    results: dict[str, float] = {}
    for end, bench in benches.items():
        for name, strokes in CARRYING.items():
            every = one_cycle_ends(bench, model, np.array(strokes), frequencies, list(CARRIED.values()), end == FLAT)
            for start, ends in zip(CARRIED, every, strict=True):
                results[f"{name}, from {start}, {end}"] = float(np.mean(checks_of(frequencies, ends)))
    return {"15": results}


def converging(bench: Bench, model: str, size: SweepSize) -> Shares:
    """Figures 17, 19 and 22."""
    low, high = (from_start(bench, model, frequency, size.starts) for frequency in (LOW, HIGH))
    period = 1 / bench.drive(HIGH).frequency
    away = distances(bench, model, max(size.starts // 8, 1))
    fine = named_distances(bench, model, size.starts)
    return {
        "17a": {ONLY: converge(bench, low, LOW).value},
        "17b": {
            f"{name}, beyond {1e6 * far:g} um": share_of(path.leaves_at(far) <= cycles * period for path in high).value
            for name, cycles in LEAVING.items()
            for far in FARS
        },
        "19": {ONLY: converge(bench, from_states(bench, model, size.starts), ANY).value},
        "22": {ONLY: within(away, BAND).value},
        "22 (1 um)": {ONLY: float((away <= FINE).any())},
        "22 (two cases)": {ONLY: min(within(row, FINE).value for row in fine)},
    }


def thresholds_of(bench: Bench, model: str, size: SweepSize) -> tuple[Shares, float]:
    """Figure 18, and the threshold [Hz] itself."""
    ends = ends_of(bench, model, STATED_STROKE, MAP, size.starts)
    level = first_loss(MAP, ends)
    below, above = shares_around(MAP, ends, level)
    count = max(size.starts // 2, 1)
    levels = np.array([
        level
        if stroke == STATED_STROKE
        else loss_from(bench, model, stroke, size.step, count)
        for stroke in CURVE_STROKES.tolist()
    ])  # fmt: skip
    fit = fits_of(CURVE_STROKES, levels, STATED_STROKE)
    return {
        "18": {ONLY: below.value if abs(level - STATED_THRESHOLD) <= THRESHOLD_WITHIN else 0.0},
        "18 (above)": {ONLY: above.value if np.isfinite(level) else 0.0},
        "18 (curve)": {ONLY: curve_answer(fit, size.step, levels).met},
    }, level


def of_one(benches: dict[str, Bench], rim: str, model: str, size: SweepSize) -> tuple[Shares, float]:
    """All of them, and the threshold [Hz]."""
    bench = benches[rim]
    threshold, level = thresholds_of(bench, model, size)
    areas_too = {} if model == PAPER else areas_of(bench, model, size)
    return (
        areas_too
        | strokes_of(bench, model)
        | carried(benches, model, size)
        | converging(bench, model, size)
        | threshold
    ), level
