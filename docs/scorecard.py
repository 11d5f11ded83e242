"""Write docs/validation.md's tables: published values beside ours. Run: python docs/scorecard.py"""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from generated import write

from fem_plate import Plate, PlateSection
from meshes import disc, rectangle

HERE = Path(__file__).parent
CELLS = 10  # along a side
FACTORS = {  # of what the plate gives, to the published unit, for a section of rigidity 1 where none is given
    "frequency, Hz": 1.0,
    "lambda^2 = omega a^2 sqrt(rho t / D)": 2 * math.pi,
    "lambda^2 = omega a^2 sqrt(rho t / D), a the radius": 2 * math.pi,
    "deflection of the middle over q a^4 / D": 1.0,
    "deflection of the middle over q a^4 / (E t^3)": 12 * (1 - 0.3**2),
}


def ours(table: dict[str, Any]) -> np.ndarray:
    """The values (n,) of a table, by the plate."""
    nu, side = table["poisson_ratio"], table.get("side", 1.0)
    mesh = disc(1.0, 0.15) if table.get("shape") == "disc" else rectangle(side, side, side / CELLS)
    section = PlateSection(
        table.get("youngs_modulus", 12 * (1 - nu**2)), nu, table.get("thickness", 1.0), table.get("density", 1.0)
    )
    supports = {"left": "clamped"} if table["supports"] == "left" else table["supports"]
    plate = Plate(mesh, section, supports)
    factor = FACTORS[table["quantity"]]
    if table.get("load") == "pressure":
        w, _, _ = plate.deflection(np.empty((0, 2)), [], pressure=1.0).evaluate(np.zeros((1, 2)))
        return factor * w
    return factor * plate.frequencies(len(table["published"]))


def lines(table: dict[str, Any]) -> list[str]:
    """A table as Markdown."""
    rows = [
        f"| {published:g} | {value:.6g} | {100 * (published / value - 1):+.2g} % |"
        for published, value in zip(table["published"], ours(table), strict=True)
    ]
    head = [f"| published: {table['quantity']} | ours | published over ours |", "|---:|---:|---:|"]
    remark = [table["remark"], ""] if "remark" in table else []
    source = f"[{table['source']}]({table['address']})."
    return [f"## {table['title']}", "", source, "", *head, *rows, "", *remark]


def main() -> None:
    tables = tomllib.loads((HERE / "published.toml").read_text())["table"]
    write(HERE / "validation.md", "scorecard", [line for table in tables for line in lines(table)][:-1])


if __name__ == "__main__":
    main()
