"""Page: where each statement of the paper holds, over all readings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.paper.models import CLOSED, DEVICE, MODELS, PAPER
from active_surface.paper.readings.builder import Builder
from active_surface.paper.readings.builder_page import section
from active_surface.paper.readings.cases import STATEMENTS, Case, best_row, cases_of, cell, met, where
from active_surface.paper.readings.effects import effects
from active_surface.paper.readings.reading import GRAVITY, INDEX, LAWS, TIME_STEP, Reading
from active_surface.paper.readings.sensitivity import Sensitivity, Variant
from active_surface.paper.readings.sweep import Row, Sweep
from active_surface.paper.readings.tables import percent, table
from active_surface.paper.share import NEARLY_ALL

VARIED: Final = ("13, 14", "17a", "17b", "18", "18 (above)", "19", "22")  # where one thing changes


def page_of_readings(sweep: Sweep, sensitivity: Sensitivity | None = None, builder: Builder | None = None) -> str:
    """The page in Markdown."""
    best = best_row(sweep)
    head = [
        "# The paper over its readings\n",
        "The paper does not state all that its figures rest on. A *reading* settles it. This page has, for each of the "
        "paper's statements, the readings by which it holds; [the paper, figure by figure](paper.md) shows one of "
        "them.\n",
        f"Written by `active-surface reproduce readings --output docs`; the sweep's {len(sweep.rows)} readings took "
        f"{sweep.seconds / 60:.0f} minutes on two cores that others used as well, {sweep.processor / 60:.0f} of "
        "processor time.\n",
        _axes(sweep),
        "## Where each statement holds\n",
        _main_table(sweep, builder),
        "Statements 3, 4 and 13, 14 with Table 1 need none of these choices: see [the "
        "paper](paper.md#verdicts). In 5 and "
        "6 the paper's scheme is ours, as the part rests. The plate is asked where there are two actuators; "
        "with one it "
        "does what the closed form does." + (" Devices: [below](#what-a-builder-would-see)." if builder else "") + "\n",
        "## By radius\n",
        "The best share [%] over all else: the paper's scheme / our equations. **Bold**: it holds.\n",
        _radius_table(sweep),
        _finding(sweep),
        "## The best single reading\n",
        f"**{best.reading.name}**: {len(met(best, PAPER))} of {len(STATEMENTS)} statements hold in the paper's scheme, "
        f"{len(met(best, CLOSED))} in our equations. The next ones:\n",
        _ranking(sweep),
        *effects(sweep),
        *(_sensitivity(sensitivity) if sensitivity else ()),
        *(section(builder, _weighty(sweep, builder)) if builder else ()),
    ]
    return "\n".join(head).replace(" um", " µm").replace(" us ", " µs ").replace("m/s^2", "m/s²").rstrip() + "\n"


def _axes(sweep: Sweep) -> str:
    radii = sorted({row.reading.radius for row in sweep.rows})
    lines = [
        f"- the radius a of the profile: {', '.join(f'{1e6 * radius:g}' for radius in radii)} um",
        f"- gravity: none, as in the paper's forces, or {GRAVITY} m/s^2",
        f"- what stands for the paper's 20.9 m/s^2, which Table 1 does not give: {' or '.join(LAWS)} (without "
        "pull-off)\n",
        f"These {len(sweep.rows)} are combined. Statement by statement there are besides, with each of them:\n",
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
        "starts (5, 6, 11 to 15, 18's curve) it is the share of what is stated. The paper's scheme takes steps "
        f"of {1e6 * TIME_STEP:g} us here.\n",
    ])  # fmt: skip


def _main_table(sweep: Sweep, builder: Builder | None) -> str:
    rows = []
    for name, text in STATEMENTS.items():
        every = {model: cases_of(sweep.rows, model, name) for model in MODELS}
        cells = [cell(cases) for cases in every.values()]
        said = []
        for model, cases in every.items():
            holding = [case for case in cases if case.holds]
            if holding and len(holding) < len(cases) and (text_of := where(holding, cases)) not in said:
                said.append(text_of if model == PAPER else f"{'ours' if model == CLOSED else 'plate'}: {text_of}")
        if builder:
            cells.append(cell([case for row in builder.rows for case in cases_of([row], DEVICE, name)]))
        rows.append([name, text, *cells, ". ".join(said) or "-"])
    return table(["figure", "the paper", *MODELS.values(), *(["a device"] if builder else []), "where"], rows)


def _weighty(sweep: Sweep, builder: Builder) -> Row | None:
    """The reading that has what the first device has, but for stretching."""
    same = Reading(builder.rows[0].device.radius, GRAVITY, INDEX)
    return next((row for row in sweep.rows if row.reading == same), None)


def _sensitivity(own: Sensitivity) -> list[str]:
    head = [f"{name}, %" for name in VARIED]
    contact = [
        [one.name, f"{one.limit:.4g}", f"{one.pull_off:.4g}", _level(one.threshold), *_best(one)] for one in own.contact
    ]
    steps = [[one.name, _level(one.threshold), *_best(one)] for one in own.steps]
    left = [
        [f"{1e6 * one.far:g}", *(percent(share) for row in own.left if row.far == one.far for share in row[2:])]
        for one in own.left
        if one.model == PAPER
    ]
    return [
        "## How much the contact matters\n",
        "One thing changed at a time from the reading of [the figures](paper.md): our equations on the closed form of "
        "one actuator.\n",
        table(["changed", "Q(0)/m, m/s^2", "pull-off/m, m/s^2", "threshold of 18, Hz", *head], contact),
        "## How much the scheme's step matters\n",
        "From the same reading, in the paper's scheme, whose step it does not mention.\n",
        table(["step", "threshold of 18, Hz", *head], steps),
        "## When a part has left\n",
        "Figure 17b by the distance from the actuator that counts as left: the share [%] that leaves at all, and in "
        "two cycles.\n",
        table(
            ["beyond, um", "paper's scheme", "in two", "our equations", "in two"],
            left,
        ),
    ]


def _best(one: Variant) -> list[str]:
    return [percent(max(one.shares[name].values())) for name in VARIED]


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
