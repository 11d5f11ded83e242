"""Measures how much each figure of the paper depends on what it leaves open, and writes that into paper-open-points.md.

Takes some minutes.
"""

import re
from pathlib import Path

from paper.pairs import SURFACES
from paper.parameters import QUICK
from paper.sensitivity import (
    LOW_AND_HIGH,
    Row,
    beginnings,
    readings,
    row_of,
    steps_of_the_scheme,
    variants,
)

PAGE = Path(__file__).parent / "paper-open-points.md"
EFFORT = QUICK._replace(starts=20, starts_by_steps=6)
HEAD = (
    "changed", "Q(0)/m, m/s²", "pull-off/m, m/s²", "5: moves from, Hz", "13: m/s²", "17a: converge", "17b: leave",
    "17b: come off", "18: threshold, Hz", "19: converge", "22: within 5 µm",
)  # fmt: skip


def table(head, rows) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace(" um", " µm") for cell in row) + " |" for row in lines)


def percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def said(row: Row) -> list[str]:
    return [
        f"{row.limit:.4g}", f"{row.pull_off:.4g}", "never" if row.moves_from is None else f"{row.moves_from:.0f}",
        "-" if row.deceleration is None else f"{row.deceleration:.2f}", percent(row.converge), percent(row.leave),
        percent(row.come_off), "above "
        "760" if row.threshold > 760 else f"{row.threshold:.0f}", percent(row.all_converge),
        percent(row.in_band),
    ]  # fmt: skip


def sections() -> dict[str, str]:
    parameters = table(HEAD, [[name, *said(row_of(p))] for name, p in variants().items()])
    steps = steps_of_the_scheme(EFFORT.starts_by_steps)
    scheme = table(
        ("step", "17a: converge", "18: threshold, Hz"),
        [[f"{1e6 * step:g} µs", percent(share), f"{hertz:.0f}"] for step, (share, hertz) in steps.items()],
    )
    handover = table(
        ("reading of figure 20", *SURFACES),
        [[name, *map(percent, shares.values())] for name, shares in readings(EFFORT).items()],
    )
    low, high = LOW_AND_HIGH
    neighbours = table(
        (f"start of figure 16: go over at {low:g} and {high:g} Hz", *SURFACES),
        [
            [f"({1e6 * x:g}, {1e6 * y:g}) µm", *(f"{percent(a)}, {percent(b)}" for a, b in shares.values())]
            for (x, y), shares in beginnings(EFFORT).items()
        ],
    )
    return {"parameters": parameters, "scheme": scheme, "figure 20": handover, "figure 16": neighbours}


def main() -> None:
    text = PAGE.read_text()
    for name, content in sections().items():
        marks = f"<!-- measured: {name} -->", "<!-- end -->"
        pattern = re.escape(marks[0]) + ".*?" + re.escape(marks[1])
        text = re.sub(pattern, lambda _: f"{marks[0]}\n\n{content}\n\n{marks[1]}", text, flags=re.DOTALL)  # noqa: B023
    PAGE.write_text(text)


if __name__ == "__main__":
    main()
