"""Compare published values with ours: single values in benchmarks/PUBLISHED.md, one row per source in docs/accuracy.md.

Run `python docs/scorecard.py` to write both; with --check it writes nothing, and fails if either page differs.
"""

from __future__ import annotations

import math
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from generated import write
from scipy.optimize import brentq
from scorecard_motion import impacts, impacts_in_steps, transport

from fem_plate import Plate, PlateSection
from meshes import disc, rectangle

HERE = Path(__file__).parent
SINGLE, SUMMARY = HERE.parent / "benchmarks/PUBLISHED.md", HERE / "accuracy.md"
CELLS = 10  # along a side
ACROSS = 9  # actuators along a mirror
HEAD, RULE = "| source | values | largest difference | reason, where known |", "|---|---:|---:|---|"
FACTORS = {  # of what the plate gives, to the published unit, for a section of rigidity 1 where none is given
    "frequency, Hz": 1.0,
    "lambda^2 = omega a^2 sqrt(rho t / D)": 2 * math.pi,
    "lambda^2 = omega a^2 sqrt(rho t / D), a the radius": 2 * math.pi,
    "deflection of the middle over q a^4 / D": 1.0,
    "deflection of the middle over q a^4 / (E t^3)": 12 * (1 - 0.3**2),
}


def ours(table: dict[str, Any]) -> np.ndarray:
    """Our values (n,) of a table."""
    return KINDS[table.get("kind", "plate")](table)


def of_plate(table: dict[str, Any]) -> np.ndarray:
    """Frequencies, or the middle under pressure."""
    nu = table["poisson_ratio"]
    section = PlateSection(
        table.get("youngs_modulus", 12 * (1 - nu**2)), nu, table.get("thickness", 1.0), table.get("density", 1.0)
    )
    supports = {"left": "clamped"} if table["supports"] == "left" else table["supports"]
    plate = Plate(_mesh(table), section, supports)
    factor = FACTORS[table["quantity"]]
    if table.get("load") == "pressure":
        w, _, _ = plate.deflection(np.empty((0, 2)), [], pressure=1.0).evaluate(np.zeros((1, 2)))
        return factor * w
    return factor * plate.frequencies(len(table["published"]))


def of_large_deflection(table: dict[str, Any]) -> np.ndarray:
    """The middle over the thickness, under pressures q a^4 / (E t^4)."""
    plate = Plate(_mesh(table), PlateSection(1.0, table["poisson_ratio"], 1.0, 1.0), table["supports"])
    large = plate.large_deflection(np.empty((0, 2)))
    return np.concatenate([large.solve([], pressure=q).evaluate(np.zeros((1, 2)))[0] for q in table["cases"]])


def of_mirror(table: dict[str, Any]) -> np.ndarray:
    """A free plate on springs, a pitch apart, whose stiffness gives the first of the published values."""
    row = np.arange(ACROSS) - ACROSS // 2.0
    points = np.stack(np.meshgrid(row, row), axis=-1).reshape(-1, 2)
    plate = Plate(rectangle(ACROSS, ACROSS, 1.0), PlateSection(12 * (1 - 0.3**2), 0.3, 1.0, 1.0), "free")

    def coupling(logarithm: float) -> np.ndarray:
        w = plate.influence(points, stiffness=10**logarithm).evaluate([[0.0, 0.0], *table["cases"]])[0]
        middle = w[:, len(points) // 2]
        return middle[1:] / middle[0]

    return coupling(brentq(lambda x: coupling(x)[0] - table["published"][0], 1.0, 2.3, xtol=1e-6))


def of_transport(table: dict[str, Any]) -> np.ndarray:
    """Mean speeds up a wall [mm/s], by its slipping accelerations."""
    friction = table["friction"]
    return np.array([transport(table["sticking"], case, friction, table["frequency"]) for case in table["cases"]])


def of_impacts(table: dict[str, Any]) -> np.ndarray:
    """How far a point hops [um], the same for every step of the published scheme."""
    return np.full(len(table["cases"]), impacts(table["friction"]))


KINDS = {
    "plate": of_plate,
    "large deflection": of_large_deflection,
    "mirror": of_mirror,
    "transport": of_transport,
    "impacts": of_impacts,
}


def published(table: dict[str, Any]) -> list[float]:
    """The published values; those of a published formula or scheme are computed here."""
    if table.get("kind") == "impacts":
        return [impacts_in_steps(case, table["friction"]) for case in table["cases"]]
    if "published" in table:
        return table["published"]  # type: ignore[no-any-return]
    up, back, half = table["sticking"], table["friction"] + 1, 1e3 * 9.81 * table["sticking"] / (2 * table["frequency"])
    return [half * (1 / (1 + up / case) - 1 / (1 + up / back)) for case in table["cases"]]


def lines(table: dict[str, Any], pairs: list[tuple[float, float]]) -> list[str]:
    """A table of single values as Markdown, from pairs of published values and ours."""
    share = of_the_peak(table)
    cases = [f"| {_text(case)} " for case in table["cases"]] if "cases" in table else [""] * len(pairs)
    rows = [
        f"{case}| {theirs:.6g} | {value:.{'4f' if share else '6g'}} | {_off(theirs, value, share)} |"
        for case, (theirs, value) in zip(cases, pairs, strict=True)
    ]
    head = f"| published: {table['quantity']} | ours | published {'less' if share else 'over'} ours |"
    head = f"| {table['case']} {head}" if "cases" in table else head
    rule = "|---:" * (head.count("|") - 1) + "|"
    remark = [table["remark"], ""] if "remark" in table else []
    source = f"[{table['source']}]({table['address']})."
    return [f"## {table['title']}", "", source, "", head, rule, *rows, "", *remark]


def row(table: dict[str, Any], pairs: list[tuple[float, float]]) -> str:
    """The row of a table in the summary: its largest difference, and the reason for it."""
    share = of_the_peak(table)
    theirs, value = max(pairs, key=lambda pair: abs(pair[0] - pair[1] if share else pair[0] / pair[1] - 1))
    cells = [f"[{table['title']}]({table['address']})", len(pairs), _off(theirs, value, share), table.get("reason", "")]
    return f"| {' | '.join(map(str, cells))} |"


def of_the_peak(table: dict[str, Any]) -> bool:
    """Whether values are compared by their share of the peak, which is 1: those of a mirror."""
    return table.get("kind") == "mirror"


def _mesh(table: dict[str, Any]) -> Any:
    side = table.get("side", 1.0)
    return disc(1.0, 0.15) if table.get("shape") == "disc" else rectangle(side, side, side / CELLS)


def _off(theirs: float, value: float, share: bool) -> str:
    return f"{100 * (theirs - value):+.2f} % of the peak" if share else f"{100 * (theirs / value - 1):+.2g} %"


def _text(case: Any) -> str:
    return ", ".join(f"{x:g}" for x in case) if isinstance(case, list) else f"{case:g}"


def main() -> None:
    tables = tomllib.loads((HERE / "published.toml").read_text())["table"]
    compared = [(table, list(zip(published(table), ours(table).tolist(), strict=True))) for table in tables]
    pages = {
        SINGLE: [line for table, pairs in compared for line in lines(table, pairs)][:-1],
        SUMMARY: [HEAD, RULE, *(row(table, pairs) for table, pairs in compared)],
    }
    for page, rows in pages.items():
        if "--check" not in sys.argv:
            write(page, "scorecard", rows)
        elif "\n".join(rows) not in page.read_text():
            other = [line for line in rows if line not in page.read_text()]
            sys.exit(f"{page} differs from what scorecard.py writes: {other}")


if __name__ == "__main__":
    main()
