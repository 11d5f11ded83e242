"""Section of the page: what a builder would see, and the same in a few sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from active_surface.paper.models import CLOSED, DEVICE, PLATE
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.builder import LINEAR, Builder
from active_surface.paper.readings.cases import STATEMENTS, best_shares, cases_of
from active_surface.paper.readings.devices import GEOMETRY, DeviceRow
from active_surface.paper.readings.losses import Losses
from active_surface.paper.readings.picture import NAME
from active_surface.paper.readings.plates import DRIVEN, Strained
from active_surface.paper.readings.reading import GRAVITY
from active_surface.paper.readings.single import ROUGHLY, SLOW
from active_surface.paper.readings.sweep import Row
from active_surface.paper.readings.tables import percent, spread, table
from active_surface.paper.readings.windows import CYCLES, HALF, RATIOS, THICKNESS, Passage, Window, Windows
from active_surface.paper.reproduction import FOLDER
from active_surface.paper.share import HARDLY_ANY, NEARLY_ALL

RUBBER: Final = 1e6, 1e3  # Pa and kg/m^3, of silicone, about
BREAKS: Final = 0.01  # strain at which single-crystal silicon breaks, about
PUT: Final = [name for name in STATEMENTS if name not in GEOMETRY]


def section(builder: Builder, linear: Row | None) -> list[str]:
    """The section in Markdown; linear: the reading that has everything but stretching, face and height."""
    p = PARAMETERS
    loads, weighty = builder.inertia, float(p.friction.friction_limit(p.mass * GRAVITY)) / p.mass
    return [
        "## What a builder would see\n",
        "A device is not the paper's surface: its plate stretches as it bends, and its points move in its plane; its "
        "parts lie on the top face, which bending moves more; their mass is higher still; they have weight, and the "
        "plate has mass. The paper "
        f"states neither a thickness nor a modulus. Here {thicknesses(builder)} um (what comes off also with "
        f"{1e6 * THICKNESS:g} um; the other statements take too long there) and {p.youngs_modulus / 1e9:g} GPa, "
        "von Karman's theory, a clamped rim that cannot move, rigid point actuators, gravity, rough contact. The part "
        "has the paper's mass on its square contact: a tile of tungsten, or a block of silicon, whose mass is "
        f"{heights(builder)} um over the face. Shapes do not depend on the modulus, "
        "which sets forces and frequencies alone.\n",
        f"The plate's mass is left out of the tables: with it, at {DRIVEN:g} Hz under a first frequency of "
        f"{loads.first / 1e3:.0f} kHz, a path of {1e6 * loads.length:.1f} um ends {1e9 * loads.apart:.0f} nm "
        f"elsewhere, {loads.apart / loads.length:.0e} of it. This section took {builder.seconds / 60:.0f} minutes, "
        f"{builder.processor / 60:.0f} of processor time.\n",
        *(f"- {one}" for one in summary(builder)),
        "",
        "### What the plate goes through\n",
        "One actuator at full stroke. The strain is the largest at a face, half a thickness and more off the "
        "actuator.\n",
        _plates(builder.plates),
        "### The statements on devices\n",
        "The best share [%] over all else. **Bold**: it holds. 13, 14 ask for 20.9 m/s^2; a part with weight slows "
        f"down by {weighty:.2f} on a surface at rest. 11 and 12 are met to {ROUGHLY[0]:g} of the ratio, down to "
        f"{SLOW:g} of the largest speed, and to {ROUGHLY[1]:g} of the path here, as elements are rough.\n",
        *(f"{k}. {name}" for k, name in enumerate(names(builder, linear), 1)),
        "",
        _statements(builder, linear),
        "### What pulls parts off\n",
        f"Parts at rest around one actuator with the paper's stroke. Accelerations as they come off, medians, of which "
        f"{p.friction.pull_off / p.mass:.0f} m/s^2 suffice: of stroke and weight, of the slope that turns under a "
        "part that slides, of the corner over the actuator (v.H v), and of the heights of face and part. Corner: "
        "share of losses that would not be without it.\n",
        _losses(builder.losses),
        "### Which strokes and frequencies work\n",
        f"Plates of {1e6 * THICKNESS:g} um, {CYCLES} cycles, frequencies a "
        f"quarter of an octave apart from {builder.windows.placing[0].frequency:g} to "
        f"{builder.windows.placing[-1].frequency:.0f} Hz. One actuator: parts at rest 40 to 160 um from it, which "
        "converge as in figure 17. Moves from: the lowest frequency at which friction holds less than half of them; "
        f"loses from: the lowest at which more than {percent(HARDLY_ANY)} % come off or leave.\n",
        f"![Strokes and frequencies that work]({FOLDER}/{NAME})\n",
        "What becomes of the parts, at each stroke and frequency.\n",
        _placing(builder),
        "Two actuators, at the frequencies at which at least half of the parts converge to one: parts at rest in the "
        "region of the one that is to hand them on, which runs so many times faster, or rests. The best share over "
        "those frequencies that converges to the other.\n",
        _passing(builder.windows),
    ]


def summary(builder: Builder) -> list[str]:
    """In a few sentences."""
    return [_strain_said(builder.plates), _statements_said(builder), *_losses_said(builder), *_windows_said(builder)]


def thicknesses(builder: Builder) -> str:
    """Those of the devices, in um."""
    return ", ".join(f"{1e6 * one:g}" for one in sorted({row.device.thickness for row in builder.rows}))


def heights(builder: Builder) -> str:
    """Those of parts' masses, in um."""
    own = sorted({row.device.centre_height for row in builder.rows} - {0.0})
    return " and ".join(f"{1e6 * one:.0f}" for one in own)


def names(builder: Builder, linear: Row | None) -> list[str]:
    """Of the columns."""
    rows = [row.device.name for row in builder.rows]
    return rows if linear is None else [f"a = {1e6 * linear.reading.radius:g} um, {LINEAR}", *rows]


def columns(builder: Builder, linear: Row | None) -> list[dict[str, float]]:
    """The best shares by statement, of each column."""
    rows = [best_shares(row, DEVICE) for row in builder.rows]
    return rows if linear is None else [best_shares(linear, CLOSED) | best_shares(linear, PLATE), *rows]


def _statements(builder: Builder, linear: Row | None) -> str:
    every = columns(builder, linear)
    rows = [[name, *(_cell(own.get(name)) for own in every)] for name in PUT]
    rows.append(["hold", *(str(sum(own.get(name, 0.0) >= NEARLY_ALL for name in PUT)) for own in every)])
    return table(["figure", *(str(k) for k in range(1, len(every) + 1))], rows)


def _cell(share: float | None) -> str:
    if share is None:
        return "-"
    return f"**{percent(share)}**" if share >= NEARLY_ALL else percent(share)


def _plates(plates: Iterable[Strained]) -> str:
    head = ["a, um", "thickness, um", "stroke, um", "stroke / thickness", "largest slope", "largest strain, %",
            "force, N", "in linear theory, N", "first frequency, kHz"]  # fmt: skip
    return table(head, (
        [f"{1e6 * one.radius:g}", f"{1e6 * one.thickness:g}", f"{1e6 * one.stroke:g}",
         f"{one.stroke / one.thickness:g}", f"{one.slope:.2g}", f"{100 * one.strain:.3g}", f"{one.force:.3g}",
         f"{one.linear:.3g}", f"{one.frequency / 1e3:.0f}"]
        for one in plates
    ))  # fmt: skip


def _losses(losses: Iterable[Losses]) -> str:
    head = ["surface and part", "Hz", "come off, %", "distance from the actuator, um", "speed, m/s", "stroke",
            "turning", "corner", "heights", "corner decides, %"]  # fmt: skip
    return table(head, (
        [one.name, f"{one.frequency:g}", percent(one.off / one.parts), *(
            [f"{1e6 * one.distance:.2g}", f"{one.speed:.2g}", f"{one.stroke:.0f}", f"{one.turning:.0f}",
             f"{one.corner:.0f}", f"{one.height:.0f}", percent(one.by_corner)]
            if one.off else ["-"] * 7)]
        for one in losses
    ))  # fmt: skip


def _placing(builder: Builder) -> str:
    head = ["a, um", "part", "stroke, um", "strain, %", "moves from, Hz", "loses from, Hz", "converge at best, %",
            "at, Hz", "then from the actuator, um"]  # fmt: skip
    strains = {(one.radius, one.thickness, one.stroke): one.strain for one in builder.plates}
    rows = []
    for radius, part, stroke in _kinds(builder.windows.placing):
        own = [one for one in builder.windows.placing if one[:3] == (radius, part, stroke)]
        best = max(own, key=lambda one: one.converge)
        there = [f"{best.frequency:.0f}", f"{1e6 * best.away:.1f}"] if best.converge else ["-", "-"]
        rows.append([
            f"{1e6 * radius:g}", part, f"{1e6 * stroke:g}", f"{100 * strains[radius, THICKNESS, stroke]:.2g}",
            _first(one.frequency for one in own if one.held < HALF and one.lost < 1),
            _first(one.frequency for one in own if one.lost > HARDLY_ANY),
            _cell(best.converge), *there,
        ])  # fmt: skip
    return table(head, rows)


def _passing(windows: Windows) -> str:
    head = ["a, um", "part", "stroke, um", *(f"{one:.3g} times, %" if one else "rests, %" for one in RATIOS)]
    rows = []
    for radius, part, stroke in _kinds(windows.passing):
        own = [one for one in windows.passing if one[:3] == (radius, part, stroke)]
        best = [max(one.arrive for one in own if one.ratio == ratio) for ratio in RATIOS]
        rows.append([f"{1e6 * radius:g}", part, f"{1e6 * stroke:g}", *map(_cell, best)])
    return table(head, rows)


def _kinds(rows: Iterable[Window] | Iterable[Passage]) -> list[tuple[float, str, float]]:
    return list(dict.fromkeys((one.radius, one.part, one.stroke) for one in rows))


def _first(frequencies: Iterable[float]) -> str:
    return next((f"{one:.0f}" for one in frequencies), "-")


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
    title = "over the corner, on the stroke's way down" if decided > HALF > enough else "by the stroke itself"
    first, *ladder = kinds
    steps = ", ".join(f"{percent(off[name])} % ({name.split(', ', 1)[1]})" for name in ladder)
    return [
        f"**Parts come off {title}.** The downward stroke alone is enough in "
        f"{percent(enough)} % of the losses; in {percent(decided)} % the corner over the point actuator decides, "
        f"within a median of {spread(*_ends(1e6 * one.distance for one in gone), '.1g')} um of it. A part is "
        f"{1e6 * PARAMETERS.contact_side:g} um wide and a pin has a size: the model's point part on a point actuator "
        "sees that corner, a device less of it.",
        f"**What stretching, face and height do.** Over all three frequencies "
        f"{percent(off[first])} % come off the linear plate; off the one that stretches: {steps}.",
    ]


def _windows_said(builder: Builder) -> list[str]:
    placing, passing = builder.windows
    good = [one for one in placing if one.converge >= NEARLY_ALL]
    best = max(placing, key=lambda one: one.converge)
    text = f"**One actuator.** On {1e6 * THICKNESS:g} um of silicon "
    if good:
        text += "nearly all parts converge to one actuator with " + "; ".join(
            _window_said([one for one in good if one[:3] == kind]) for kind in _kinds(good)
        )
    else:
        text += f"at best {percent(best.converge)} % of the parts converge to one actuator, with {_window_said([best])}"
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
