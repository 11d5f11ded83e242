"""Measures how much each figure of the paper depends on what it leaves open, and writes that into paper-open-points.md.

Takes some minutes.
"""

import math
import re
from pathlib import Path

from active_surface.paper import PARAMETERS, QUICK
from active_surface.paper.figures import SURFACES
from active_surface.paper.figures.coming_off import PLACES, SPEED, bending_pull, length
from active_surface.paper.sensitivity import (
    LOW_AND_HIGH,
    Row,
    beginnings,
    readings,
    row_of,
    steps_of_the_scheme,
    variants,
)
from active_surface.paper.share import percents
from active_surface.paper.split import Split

PAGE = Path(__file__).parent / "paper-open-points.md"
EFFORT = QUICK._replace(starts=20, starts_by_steps=12)
HEAD = (
    "changed", "Q(0)/m, m/s²", "pull-off/m, m/s²", "5: moves from, Hz", "13: m/s²", "17a: converge", "17b: leave",
    "17b: come off", "18: threshold, Hz (tells)", "19: converge", "22: within 5 µm",
)  # fmt: skip


def table(head, rows) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(
        "| " + " | ".join(str(cell).replace(" um", " µm").replace("m/s^2", "m/s²") for cell in row) + " |"
        for row in lines
    )


def told(split: Split) -> str:
    return "none" if math.isnan(split.frequency) else f"{split.frequency:.0f} ({100 * split.predicted:.0f} %)"


def number(value: float, form: str, none: str) -> str:
    return none if math.isnan(value) else format(value, form)


def said(row: Row) -> list[object]:
    return [
        f"{row.limit:.4g}", f"{row.pull_off:.4g}", number(row.moves_from, ".0f", "never"),
        number(row.deceleration, ".2f", "-"), row.converge, row.leave, row.come_off, told(row.threshold),
        row.all_converge, row.in_band,
    ]  # fmt: skip


def sections() -> dict[str, str]:
    pulls = zip(PLACES, bending_pull(PARAMETERS, PLACES).tolist(), strict=True)
    bending = table(
        (f"distance from the actuator, at {SPEED:g} m/s and full stroke", "v.H v, m/s²"),
        [[length(away), f"{pull:.0f}"] for away, pull in pulls],
    )
    parameters = table(HEAD, [[name, *said(row_of(p))] for name, p in variants().items()])
    steps = steps_of_the_scheme(EFFORT.starts_by_steps)
    scheme = table(
        ("step", "17a: converge", "18: threshold, Hz (tells)"),
        [[f"{1e6 * step:g} µs", share, told(split)] for step, (share, split) in steps.items()],
    )
    handover = table(
        ("reading of figure 20", *SURFACES),
        [[name, *shares.values()] for name, shares in readings(EFFORT).items()],
    )
    low, high = LOW_AND_HIGH
    neighbours = table(
        (f"start of figure 16, at {low:g} and {high:g} Hz", *SURFACES),
        [
            [name, *(f"{percents(one.reach)}; {percents(one.off)}" for one in trends.values())]
            for name, trends in beginnings(EFFORT).items()
        ],
    )
    return {
        "bending": bending, "parameters": parameters, "scheme": scheme, "figure 20": handover, "figure 16": neighbours,
    }  # fmt: skip


def main() -> None:
    text = PAGE.read_text()
    for name, content in sections().items():
        marks = f"<!-- measured: {name} -->", "<!-- end -->"
        pattern = re.escape(marks[0]) + ".*?" + re.escape(marks[1])
        text = re.sub(pattern, lambda _: f"{marks[0]}\n\n{content}\n\n{marks[1]}", text, flags=re.DOTALL)  # noqa: B023
    PAGE.write_text(text)


if __name__ == "__main__":
    main()
