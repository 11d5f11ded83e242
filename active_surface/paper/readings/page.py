"""Page: where each statement of the paper holds, over all readings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from active_surface.paper.models import CLOSED, MODELS, PAPER
from active_surface.paper.readings.cases import STATEMENTS, Case, best_row, cases_of, cell, met, where
from active_surface.paper.readings.contact import Variant
from active_surface.paper.readings.reading import HEAVY, LAWS
from active_surface.paper.readings.sweep import Sweep
from active_surface.paper.share import NEARLY_ALL

VARIED: Final = ("13, 14", "17a", "17b", "18", "18 (above)", "19", "22")  # by the contact


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """In Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in lines) + "\n"


def page_of_readings(sweep: Sweep, variants: Sequence[Variant] = ()) -> str:
    """The page in Markdown; variants: of the contact."""
    best = best_row(sweep)
    head = [
        "# The paper over its readings\n",
        "The paper does not state all that its figures rest on. A *reading* settles it. This page has, for each of the "
        "paper's statements, the readings by which it holds; [the paper, figure by figure](paper.md) shows one of "
        "them.\n",
        "Written by `active-surface reproduce readings --output docs`; the sweep's readings took "
        f"{sweep.seconds / 60:.0f} minutes in all, on two cores that others used as well.\n",
        _axes(sweep),
        "## Where each statement holds\n",
        _main_table(sweep),
        "Statements 3, 4 and 13, 14 with Table 1 need none of these choices: see [the "
        "paper](paper.md#verdicts). In 5 and "
        "6 the paper's scheme is ours, as the part rests. The plate is asked where there are two actuators; "
        "with one it "
        "does what the closed form does.\n",
        "## By radius\n",
        "The best share [%] over all else: the paper's scheme / our equations. **Bold**: it holds.\n",
        _radius_table(sweep),
        _finding(sweep),
        "## The best single reading\n",
        f"**{best.reading.name}**: {len(met(best, PAPER))} of {len(STATEMENTS)} statements hold in the paper's scheme, "
        f"{len(met(best, CLOSED))} in our equations. The next ones:\n",
        _ranking(sweep),
        *_variants(variants),
    ]
    return "\n".join(head).replace(" um", " µm").replace("m/s^2", "m/s²").rstrip() + "\n"


def _axes(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    lines = [
        f"- the radius a of the profile: {', '.join(f'{1e6 * radius:g}' for radius in radii)} um",
        f"- gravity: none, as in the paper's forces; with a = {1e6 * HEAVY[0]:g} um also {HEAVY[1]} m/s^2",
        f"- what stands for the paper's 20.9 m/s^2, which Table 1 does not give: {' or '.join(LAWS)} (without "
        "pull-off; in "
        "the paper's scheme the first alone)",
        "- where the surface ends: at the profiles' rim, or flat beyond it (15, 20, 21, anywhere)",
        "- how two profiles are put together: added, or the nearest alone",
        "- strokes (5, 6, 15), cycles (16, 17b), starts (15, 16), how far a part is that has left (17b), "
        "which actuator is "
        "where (20)",
    ]
    return "\n".join([
        *lines,
        "",
        f"The share is that of {sweep.size.starts} starts that do what the paper says, at the worst frequency "
        "where there "
        f"are several; a statement holds by a reading if at least {100 * NEARLY_ALL:.0f} % do. For statements without "
        "starts (5, 6, 11 to 15, 18's curve) it is the share of what is stated. The paper's scheme takes steps of 5 µs "
        "here.\n",
    ])  # fmt: skip


def _main_table(sweep: Sweep) -> str:
    rows = []
    for name, text in STATEMENTS.items():
        every = {model: cases_of(sweep.rows, model, name) for model in MODELS}
        cells = [cell(cases) for cases in every.values()]
        said = []
        for model, cases in every.items():
            holding = [case for case in cases if case.holds]
            if holding and len(holding) < len(cases) and (text_of := where(holding, cases)) not in said:
                said.append(text_of if model == PAPER else f"{'ours' if model == CLOSED else 'plate'}: {text_of}")
        rows.append([name, text, *cells, ". ".join(said) or "-"])
    return table(["figure", "the paper", *MODELS.values(), "where"], rows)


def _variants(variants: Sequence[Variant]) -> list[str]:
    rows = []
    for one in variants:
        shares = [max(one.shares[name].values()) for name in VARIED]
        level = _level(one.threshold)
        rows.append([one.name, f"{one.limit:.4g}", f"{one.pull_off:.4g}", level, *(f"{100 * s:.0f}" for s in shares)])
    head = ["changed", "Q(0)/m, m/s^2", "pull-off/m, m/s^2", "threshold of 18, Hz", *(f"{name}, %" for name in VARIED)]
    return [
        "## How much the contact matters\n",
        "One thing changed at a time from the reading of [the figures](paper.md): our equations on the closed form of "
        "one actuator.\n",
        table(head, rows),
    ]


def _radius_table(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    rows = []
    for name in STATEMENTS:
        cells = []
        for radius in radii:
            own = [row for row in sweep.rows if row.reading.radius == radius]
            both = [_percent(cases_of(own, model, name)) for model in (PAPER, CLOSED)]
            cells.append(" / ".join(both))
        rows.append([name, *cells])
    return table(["figure", *(f"a = {1e6 * radius:g} um" for radius in radii)], rows)


def _percent(cases: Sequence[Case]) -> str:
    if not cases:
        return "-"
    best = max(cases, key=lambda case: case.share)
    text = f"{100 * best.share:.0f}"
    return f"**{text}**" if best.holds else text


def _finding(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    held: dict[float, set[str]] = {}
    for radius in radii:
        own = [row for row in sweep.rows if row.reading.radius == radius]
        held[radius] = {name for name in STATEMENTS if any(case.holds for case in cases_of(own, PAPER, name))}
    anywhere = set().union(*held.values())
    full = [radius for radius in radii if held[radius] == anywhere]
    most = max(radii, key=lambda radius: len(held[radius]))
    never = [name for name in STATEMENTS if name not in anywhere]
    text = f"In the paper's scheme {len(anywhere)} of {len(STATEMENTS)} statements hold by some reading"
    text += f"; by none do {_list(never)}. " if never else ". "
    if full:
        return text + f"a = {1e6 * full[0]:g} um meets all of those.\n"
    lacking = [name for name in STATEMENTS if name in anywhere - held[most]]
    text += f"**No single radius meets them all**: at most {len(held[most])}, by a = {1e6 * most:g} um, where "
    return text + f"{_list(lacking)} fail.\n"


def _list(names: Sequence[str]) -> str:
    return "; ".join(names)


def _ranking(sweep: Sweep) -> str:
    order = sorted(sweep.rows, key=lambda row: (-len(met(row, PAPER)), -len(met(row, CLOSED))))
    rows = [
        [
            row.reading.name,
            str(len(met(row, PAPER))),
            str(len(met(row, CLOSED))),
            _level(row.thresholds[PAPER]),
        ]
        for row in order[:6]
        if PAPER in row.shares
    ]
    return table(
        ["reading", "hold, paper's scheme", "hold, our equations", "threshold of figure 18, paper's scheme, Hz"], rows
    )


def _level(frequency: float) -> str:
    return "none" if np.isnan(frequency) else f"{frequency:.0f}"
