"""Conclusions: what a builder would see, in a few sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from active_surface.paper.models import DEVICE
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.builder import Builder
from active_surface.paper.readings.cases import cases_of
from active_surface.paper.readings.devices import PUT, DeviceRow
from active_surface.paper.readings.losses import Losses
from active_surface.paper.readings.plates import Strained
from active_surface.paper.readings.tables import percent, spread
from active_surface.paper.readings.windows import HALF, RATIOS, THICKNESS, Passage, Window
from active_surface.paper.share import NEARLY_ALL

RUBBER: Final = 1e6, 1e3  # Pa and kg/m^3, of silicone, about
BREAKS: Final = 0.01  # strain at which single-crystal silicon breaks, about


def summary(builder: Builder) -> list[str]:
    """In a few sentences."""
    return [_strain_said(builder.plates), _statements_said(builder), *_losses_said(builder), *_windows_said(builder)]


def _strain_said(plates: Sequence[Strained]) -> str:
    full = [one for one in plates if one.stroke == PARAMETERS.stroke]
    strain, force, slope = (
        spread(*_ends(getattr(one, name) * factor for one in full))
        for name, factor in (("strain", 100), ("force", 1), ("slope", 1))
    )
    p = PARAMETERS
    slower = np.sqrt(RUBBER[0] / RUBBER[1] / (p.youngs_modulus / p.density))
    soft = spread(*_ends(slower * one.frequency / 1e3 for one in full), ".2g")
    bear = {one.radius: one.stroke for one in plates if one.strain < BREAKS and one.thickness == THICKNESS}
    said = " and ".join(f"{1e6 * stroke:g} um with a = {1e6 * radius:g} um" for radius, stroke in bear.items())
    breaks = "breaks any stiff plate" if min(one.strain for one in full) > BREAKS else "on stiff plates"
    return (
        f"**The paper's stroke {breaks}.** {1e6 * PARAMETERS.stroke:g} um strain it by {strain} % and "
        f"take {force} N; silicon breaks near {100 * BREAKS:g} %. Slopes of {slope} are beyond von Karman's theory, "
        f"too, so numbers for these strokes show a trend. {1e6 * THICKNESS:g} um of silicon bear {said or 'none'} of "
        f"the smaller strokes tried. Rubber of {RUBBER[0] / 1e6:g} MPa would bear more, but rings: the first frequency "
        f"of the same plates is then {soft} kHz, and their mass counts."
    )


def _ends(values: Iterable[float]) -> tuple[float, float]:
    every = list(values)
    return min(every), max(every)


def _statements_said(builder: Builder) -> str:
    held = {name: _holding(builder.rows, name) for name in PUT}
    count = len(builder.rows)
    kinds = {
        f"hold on all {count} devices": [name for name, own in held.items() if len(own) == count],
        "on some": [name for name, own in held.items() if 0 < len(own) < count],
        "on none": [name for name, own in held.items() if not own],
    }
    said = ", ".join(f"{len(own)} {where} ({'; '.join(own) or '-'})" for where, own in kinds.items())
    return f"**Of {len(PUT)} statements** {said}."


def _holding(rows: Sequence[DeviceRow], name: str) -> list[DeviceRow]:
    return [row for row in rows if any(case.holds for case in cases_of([row], DEVICE, name))]


def _losses_said(builder: Builder) -> list[str]:
    kinds = list(dict.fromkeys(one.name for one in builder.losses))
    own = {name: [one for one in builder.losses if one.name == name] for name in kinds}
    off = {name: sum(one.off for one in rows) / sum(one.parts for one in rows) for name, rows in own.items()}
    gone = [one for one in builder.losses if one.off]
    decided = float(np.average([one.by_corner for one in gone], weights=[one.off for one in gone]))
    enough = float(np.average([one.by_stroke for one in gone], weights=[one.off for one in gone]))
    title = "over the corner, around the top of the stroke" if decided > HALF > enough else "by the stroke itself"
    first, *ladder = kinds
    steps = ", ".join(f"{percent(off[name])} % ({name.split(', ', 1)[1]})" for name in ladder)
    limit = -PARAMETERS.friction.pull_off / PARAMETERS.mass
    shares = "; ".join(
        f"{percent(_mean(rows, 'stroke') / limit)} and {percent(_mean(rows, 'corner') / limit)} % at {frequency:g} Hz"
        for frequency in sorted({one.frequency for one in gone})
        if (rows := [one for one in gone if one.frequency == frequency])
    )
    near = spread(*_ends(1e6 * one.distance for one in gone), ".2g")
    return [
        f"**Parts come off {title}.** The stroke's acceleration is enough in {percent(enough)} % of the losses; in "
        f"{percent(decided)} % the corner over the point actuator decides. Of the pull-off, stroke and corner make "
        f"{shares}. Medians of the distance from the actuator are {near} um; a part is "
        f"{1e6 * PARAMETERS.contact_side:g} um wide and a pin has a size, so a device sees less of that corner than a "
        "point part on a point actuator.",
        "**What stretching, face and height do.** Over all three frequencies "
        f"{percent(off[first])} % come off the linear plate; off the one that stretches: {steps}.",
    ]


def _mean(rows: Sequence[Losses], name: str) -> float:
    """Of a median, each row counting by what comes off."""
    return float(np.average([getattr(one, name) for one in rows], weights=[one.off for one in rows]))


def _windows_said(builder: Builder) -> list[str]:
    placing, passing = builder.windows
    good = [one for one in placing if one.converge >= NEARLY_ALL]
    best = max(placing, key=lambda one: one.converge)
    text = f"**One actuator.** On {1e6 * THICKNESS:g} um of silicon "
    if good:
        text += "nearly all parts converge to one actuator with " + "; ".join(
            _window_said([one for one in good if one[:3] == kind]) for kind in kinds_of(good)
        )
    else:
        text += f"at best {percent(best.converge)} % of the parts converge to one actuator, with {_window_said([best])}"
    strains = {(one.radius, one.thickness, one.stroke): one.strain for one in builder.plates}
    borne = [one for one in placing if strains[one.radius, THICKNESS, one.stroke] < BREAKS]
    if good:
        least = min(good, key=lambda one: strains[one.radius, THICKNESS, one.stroke])
        text += f". The least strain of these is {100 * strains[least.radius, THICKNESS, least.stroke]:.2g} %"
    if borne:
        top = max(borne, key=lambda one: one.converge)
        text += f"; below {100 * BREAKS:g} % at best {percent(top.converge)} % converge, with {_window_said([top])}"
    if not passing:
        return [text + "."]
    both = [max((one for one in passing if one.ratio == ratio), key=lambda one: one.arrive) for ratio in RATIOS]
    said = ", ".join(
        f"{percent(one.arrive)} % where it {f'runs {one.ratio:.3g} times as fast' if one.ratio else 'rests'}"
        for one in both
    )
    return [
        text + ".",
        f"**To the next actuator** come, of parts around the one that is to hand them on, at best {said}.",
    ]


def _window_said(rows: Sequence[Window]) -> str:
    one, frequencies = rows[0], spread(*_ends(row.frequency for row in rows), ".0f")
    return f"{1e6 * one.stroke:g} um at {frequencies} Hz ({one.part}, a = {1e6 * one.radius:g} um)"


def kinds_of(rows: Iterable[Window] | Iterable[Passage]) -> list[tuple[float, str, float]]:
    """Radius, part and stroke of rows, each once."""
    return list(dict.fromkeys((one.radius, one.part, one.stroke) for one in rows))
