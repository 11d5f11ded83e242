"""Section of the page: what a builder would see, and the same in a few sentences."""

from __future__ import annotations

from collections.abc import Iterable

from active_surface.paper.models import CLOSED, DEVICE, PLATE
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.builder import LINEAR, Builder
from active_surface.paper.readings.cases import best_shares
from active_surface.paper.readings.conclusions import kinds_of, summary
from active_surface.paper.readings.devices import PUT
from active_surface.paper.readings.losses import Losses
from active_surface.paper.readings.picture import NAME
from active_surface.paper.readings.plates import DRIVEN, Strained
from active_surface.paper.readings.reading import GRAVITY
from active_surface.paper.readings.single import ROUGHLY, SLOW
from active_surface.paper.readings.sweep import Row
from active_surface.paper.readings.tables import percent, table
from active_surface.paper.readings.windows import CYCLES, HALF, RATIOS, THICKNESS, Windows
from active_surface.paper.reproduction import FOLDER
from active_surface.paper.share import HARDLY_ANY, NEARLY_ALL


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
        "Parts at rest around one actuator with the paper's stroke: which converge as in figure 17, which leave as in "
        "17b, and which come off; the others are held, go to and fro, or are not followed. "
        "Accelerations as they come off, medians, of which "
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


def thicknesses(builder: Builder) -> str:
    """Those of the devices, in um."""
    return " and ".join(f"{1e6 * one:g}" for one in sorted({row.device.thickness for row in builder.rows}))


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
    head = ["surface and part", "Hz", "converge, %", "leave, %", "come off, %", "distance from the actuator, um",
            "speed, m/s", "stroke", "turning", "corner", "heights", "corner decides, %"]  # fmt: skip
    rows = []
    for one in losses:
        shares = [percent(count / one.parts) for count in (one.converge, one.leave, one.off)]
        pulls = ["-"] * 7
        if one.off:
            terms = one.stroke, one.turning, one.corner, one.height
            pulls = [f"{1e6 * one.distance:.2g}", f"{one.speed:.2g}", *(f"{round(term)}" for term in terms)]
            pulls.append(percent(one.by_corner))
        rows.append([one.name, f"{one.frequency:g}", *shares, *pulls])
    return table(head, rows)


def _placing(builder: Builder) -> str:
    head = ["a, um", "part", "stroke, um", "strain, %", "moves from, Hz", "loses from, Hz", "converge at best, %",
            "at, Hz", "then from the actuator, um"]  # fmt: skip
    strains = {(one.radius, one.thickness, one.stroke): one.strain for one in builder.plates}
    rows = []
    for radius, part, stroke in kinds_of(builder.windows.placing):
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
    for radius, part, stroke in kinds_of(windows.passing):
        own = [one for one in windows.passing if one[:3] == (radius, part, stroke)]
        best = [max(one.arrive for one in own if one.ratio == ratio) for ratio in RATIOS]
        rows.append([f"{1e6 * radius:g}", part, f"{1e6 * stroke:g}", *map(_cell, best)])
    return table(head, rows)


def _first(frequencies: Iterable[float]) -> str:
    return next((f"{one:.0f}" for one in frequencies), "-")
