"""Two: statements about two actuators, over how profiles are put together, where they end, starts and cycles."""

from __future__ import annotations

from typing import Final

import numpy as np

from active_surface.paper.figures import (
    HANDOVERS,
    LATE,
    OSCILLATIONS,
    SIXTEEN,
    Handover,
    anywhere,
    arrives,
    cycles_until_there,
    settled,
    trend_of,
)
from active_surface.paper.models import DEVICE, PLATE, Bench
from active_surface.paper.parameters import Place
from active_surface.paper.profiles import NEAREST, SUPERPOSED
from active_surface.paper.readings.reading import RIM, SweepSize
from active_surface.paper.readings.single import Shares
from active_surface.paper.share import share_of

BEGINNINGS: Final[dict[str, Place]] = {
    "(-100, 0) um": (-100e-6, 0.0),
    "(-50, 15) um": (-50e-6, 15e-6),
    "(100, 0) um": (100e-6, 0.0),
}
"""Of figure 16, in which no part comes near the rim."""
CYCLES: Final = {"one cycle": 1, "ten cycles": 10}
TWENTY: Final = {
    "450 Hz at (150, 0)": HANDOVERS["20"],
    "450 Hz at (0, 0)": Handover((450.0, 300.0), (100e-6, 0.0)),
    "450 Hz at (0, 0), from (-100, 0)": Handover((450.0, 300.0), (-100e-6, 0.0)),
}
"""Readings of figure 20."""
FEWER: Final = 2  # times fewer starts in figure 16, whose readings are many


def of_two(benches: dict[str, Bench], model: str, size: SweepSize) -> Shares:
    """All of them."""
    results: Shares = {}
    solid = model in (PLATE, DEVICE)
    ways = [(RIM, SUPERPOSED)] if solid else [(end, way) for end in benches for way in (NEAREST, SUPERPOSED)]
    for end, way in ways:
        name = "" if solid else f"{way}, {end}"
        for statement, shares in _own(benches[end], model, way, size).items():
            own = {", ".join(filter(None, (choice, name))): share for choice, share in shares.items()}
            results.setdefault(statement, {}).update(own)
    return results


def _own(bench: Bench, model: str, way: str, size: SweepSize) -> Shares:
    results: Shares = {"20": {}, "20 (five cycles)": {}}
    if not bench.margin:
        results["16"] = _sixteen(bench, model, way, max(size.starts // FEWER, 1))
    for name, one in (TWENTY | {"": HANDOVERS["21"]}).items():
        drives = [bench.drive(frequency) for frequency in one.frequencies]
        paths = bench.paths(model, drives, bench.starts(one.start, size.starts), bench.duration(*drives), actuators=way)
        share = share_of(arrives(bench, one, path) for path in paths).value
        if not name:
            results["21"] = {"": share}
            continue
        results["20"][name] = share
        cycles = np.array([cycles_until_there(bench, one, path) for path in paths])
        results["20 (five cycles)"][name] = float((np.abs(cycles - OSCILLATIONS) <= LATE).mean())
    everywhere = anywhere(bench, model, way, 2 * size.starts)
    results["VI-C (anywhere)"] = {"": share_of(arrives(bench, HANDOVERS["20"], path) for path in everywhere).value}
    return results


def _sixteen(bench: Bench, model: str, way: str, count: int) -> dict[str, float]:
    """The least share that does what figure 16 says at one of its frequencies."""
    results = {}
    for said, cycles in CYCLES.items():
        for name, start in BEGINNINGS.items():
            paths = {}
            for frequency in SIXTEEN:
                drives = [bench.drive(frequency, cycles=cycles)] * 2
                starts = bench.starts(start, count)
                duration = settled(bench, frequency, cycles)
                paths[frequency] = bench.paths(model, drives, starts, duration, actuators=way)
            trend = trend_of(paths, bench.parameters.pitch)
            low, *high = (share.value for share in trend.reach)
            results[f"{said} from {name}"] = min(trend.returns.value, 1 - low, *high)
    return results
