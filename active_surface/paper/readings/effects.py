"""Effects: how many statements change with one choice that readings share, all else equal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from active_surface.paper.models import CLOSED, PAPER
from active_surface.paper.readings.cases import STATEMENTS, met
from active_surface.paper.readings.reading import CONSTANT, GRAVITY, Reading
from active_surface.paper.readings.sweep import Row, Sweep
from active_surface.paper.readings.tables import table

CHANGES: Final[dict[str, Callable[[Reading], Reading]]] = {
    "gravity in place of none": lambda one: one._replace(gravity=GRAVITY),
    "constant friction in place of rough contact": lambda one: one._replace(law=CONSTANT),
}


def effects(sweep: Sweep) -> list[str]:
    """The section in Markdown."""
    rows = []
    for said, change in CHANGES.items():
        pairs = pairs_of(sweep, change)
        if not pairs:
            continue
        cells = []
        for model in (PAPER, CLOSED):
            gained, gone = differences(pairs, model)
            cells += [f"{len(gained)}: {_by_statement(gained)}", f"{len(gone)}: {_by_statement(gone)}"]
        rows.append([f"{said}, {len(pairs)} pairs", *cells])
    if not rows:
        return []
    return [
        "## What gravity and the contact change\n",
        "Pairs of readings that differ in one choice: which statements come to hold, and which no longer do, and in "
        f"how many pairs, of {len(STATEMENTS)} statements in each.\n",
        table(
            ["changed", "paper's scheme, gained", "paper's scheme, lost", "our equations, gained",
             "our equations, lost"], rows,
        ),
    ]  # fmt: skip


def pairs_of(sweep: Sweep, change: Callable[[Reading], Reading]) -> list[tuple[Row, Row]]:
    """Rows before and after a change."""
    rows = {row.reading: row for row in sweep.rows}
    return [
        (row, rows[change(reading)])
        for reading, row in rows.items()
        if change(reading) != reading and change(reading) in rows
    ]


def differences(pairs: list[tuple[Row, Row]], model: str) -> tuple[list[str], list[str]]:
    """Statements that come to hold and that no longer do, once for each pair."""
    gained, gone = [], []
    for before, after in pairs:
        held, holds = set(met(before, model)), set(met(after, model))
        gained += sorted(holds - held)
        gone += sorted(held - holds)
    return gained, gone


def _by_statement(names: list[str]) -> str:
    counts = {name: names.count(name) for name in STATEMENTS if name in names}
    return "; ".join(f"{name} ({count})" for name, count in counts.items()) or "-"
