"""Warnings: the limits of the model and of the numerics that a run passes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from common import count, percent, quantity
from coupling.case import INERTIA, VON_KARMAN
from coupling.outlook import MAX_FREQUENCY
from coupling.part import FLAT, STEEP
from coupling.plate_figures import MAX_SLOPE, MAX_STRAIN
from coupling.summary import PlateSummary, Summary
from particle import Outcome

# The model holds to about a per cent up to these.
MAX_DEFLECTION = 0.2  # of the thickness
MAX_LINEAR_ERROR = 0.01  # of the path: beyond it a run names the theory that has stretching
MAX_CURVATURE = 0.1  # of one over the part's size
MAX_QUASI_STATIC_ERROR = 0.05  # of the acceleration
MAX_QUASI_STATIC_SHARE = 0.01  # of the acceleration: beyond it a run names the line that has inertia
MAX_NUMERICAL_ERROR = 1e-6  # of a unit stroke, of the path
MAX_MODE_ERROR = 1e-2  # of the acceleration of a plate with inertia
MAX_STRETCH_ERROR = 1e-3  # of the deflection of a plate that stretches
MIN_STEPS_PER_CYCLE = 8
MAX_TABLE_ERROR = 0.1  # of the friction limit
MAX_NOISE_PULL = 0.3  # of the friction limit: a normal distribution passes 1 in one of a thousand moments
MAX_AIR = 0.05  # load share and breathing of the air under the part
ESTIMATE = 0.4  # of the load share: the error of the way is about as large below it
GROWTH = 100  # of the error of one step, that is no sign of chaos


def warnings(summary: Summary) -> list[str]:
    """The limits of the model and of the numerics that the run passes."""
    texts = [*_of_numerics(summary), *_of_measurement(summary), *_of_contact(summary), *_of_air(summary)]
    texts += _of_scheme(summary)
    return [*_of_solver(summary), *texts, *_of_model(summary)] if isinstance(summary, PlateSummary) else texts


def about(share: float) -> str:
    """A share that is estimated, from formulas that hold for small ones."""
    return "more than 50 %" if share > 0.5 else f"about {100 * share:.2g} %"


def by_theory(s: PlateSummary) -> str:
    """By which theory a strain is found, where another theory would find another."""
    return " by linear theory" if s.theory == "linear" else ""


def warnings_of_parts(texts: Mapping[str, Sequence[str]]) -> list[str]:
    """The warnings of many parts by their names: each once, with the name of its part unless all have it."""
    found = dict.fromkeys(text for some in texts.values() for text in some)
    having = {text: [name for name, some in texts.items() if text in some] for text in found}
    return [text if len(of) == len(texts) else f"{', '.join(of)}: {text}" for text, of in having.items()]


def _of_numerics(s: Summary) -> Iterator[str]:
    resolved = max(MAX_NUMERICAL_ERROR * s.path_length, GROWTH * s.path_resolution)
    if not s.same_events or s.path_error > resolved:
        yield (
            "The path magnifies small errors: trust the statistics of many starts more than the digits of one."
            if s.scheme == "events"
            else "Fixed steps give the path to few digits; the error falls in proportion to run.time_step."
        )
    if s.frames_per_cycle is not None and s.frames_per_cycle < MIN_STEPS_PER_CYCLE:
        yield (
            f"The result files hold {s.frames_per_cycle:.2g} steps per cycle of the fastest drive: fast motion looks "
            "slow or frozen in them; a larger run.frames shows it."
        )
    if s.energy_balance > MAX_NUMERICAL_ERROR and _jump(s) is None:
        finer = "run.tolerance" if s.scheme == "events" else "run.time_step"
        yield (
            f"The energy ledger closes only to {s.energy_balance:.1e} of its largest entry; "
            + (f"reduce {finer} tenfold." if s.scheme != "paper" else "no step improves that.")
        )


def _of_scheme(s: Summary) -> Iterator[str]:
    if s.scheme == "paper":
        yield (
            'The paper\'s scheme drops terms of the equations of motion: its path is not that of scheme = "events", '
            "however small the step."
        )
    if (jump := _jump(s)) is not None:
        yield (
            f"A drive's velocity jumps at {jump * 1e3:g} ms. Fixed steps leave out the impact, also in the energy "
            'ledger: the part\'s velocity jumps with the surface; scheme = "events" has the impact.'
        )


def _jump(s: Summary) -> float | None:
    """When [s] a drive's velocity jumps, which fixed steps leave out."""
    return None if s.scheme == "events" else s.drive_jump


def _of_measurement(s: Summary) -> Iterator[str]:
    gaps = {fit.longest_step: fit.gaps for fit in s.motion_fits if fit.gaps}
    for longest, gaps_of_it in gaps.items():
        yield (
            f"The measured motion has {count(gaps_of_it, 'gap')}, up to {longest * 1e3:.3g} ms without a sample: "
            "there it is as smooth as elsewhere, and an impact stays unseen."
        )
    for name in dict.fromkeys(name for fit in s.motion_fits for name in fit.ignored):
        yield f'The column "{name}" of the measured motion is ignored: it is no position, velocity or acceleration.'


def _of_contact(s: Summary) -> Iterator[str]:
    if s.contact_error > MAX_TABLE_ERROR:
        yield (
            f"The friction table is good to {100 * s.contact_error:.2g} % only, by its own points: add points between "
            "those that are, or smooth them."
        )
    if s.noise_pull is not None and s.noise_pull > MAX_NOISE_PULL:
        noise = max(fit.noise for fit in s.motion_fits)
        yield (
            f"Noise of {noise * 1e6:.2g} um in the measured motion alone pulls the part by {s.noise_pull:.2g} times "
            "the friction limit (root mean square): without plate.smoothing, or with a larger one, less noise is left."
        )
    if s.load_unbounded and s.margins.smallest_load < 0:
        yield (
            f"The normal force falls to {quantity(s.margins.smallest_load, 'N')}: the plate pulls at the part. A "
            'constant limit holds it whatever the pull; model = "coulomb" with its adhesion lets it come off.'
        )


def _of_air(s: Summary) -> Iterator[str]:
    air = s.air
    if air is None:
        return
    if air.included == "film":
        if air.sag_over_gap > FLAT and not (isinstance(s, PlateSummary) and s.local_contact):
            yield (
                f"The plate sags under the part by up to {air.sag_over_gap:.2g} times the gap of the film, and "
                f"asperities are taken to meet a plane; that holds up to about {FLAT}, and far above it at most for "
                "the direction of the way."
                + (' model = "kogut-etsion" with local_contact = true follows the bend.' if s.turned is None else "")
            )
        return
    at, face = f"At {quantity(air.pressure, 'Pa', 4)} ", s.turned is not None
    remedy = f" [air] with film = true includes it{' under a rectangle or disc without local_contact' * face}."
    remedy = remedy if s.scheme == "events" else ""
    if air.load_share is not None and air.load_share > MAX_AIR:
        off = about(air.load_share) if air.load_share <= ESTIMATE else "about the whole way"
        yield (
            f"{at}a film of air under the part carries {air.load_share:.2g} times as much of the load's swing as the "
            f"contact, and friction lags: expect the way to be off by {off}.{remedy}"
        )
    if air.breathing is not None and air.breathing > MAX_AIR:
        off = f"changes its way by {about(air.breathing)}" if air.breathing <= ESTIMATE else "can reverse its way"
        yield (
            f"{at}the plate, as it bends, pumps air under the part with up to {air.breathing:.2g} times the force that "
            f"holds it, which {off}.{remedy}"
        )
    if s.outcome == Outcome.DETACHED and air.settle_time is not None and air.velocity_change < air.escape_speed:
        yield (
            f"{at}the part would not come off: air holds it on a plate slower than "
            f"{quantity(air.escape_speed, 'm/s')}, and this one changes its velocity by "
            f"{quantity(air.velocity_change, 'm/s')}. That it comes off holds in a vacuum."
        )


def _of_solver(s: PlateSummary) -> Iterator[str]:
    if s.plate_error > MAX_NUMERICAL_ERROR:
        yield (
            f"The plate's shapes are accurate to {s.plate_error:.1e} of a stroke only; take smaller cells, or move "
            "actuators away from the rim."
        )
    if s.vibration and s.vibration.mode_error > MAX_MODE_ERROR:
        yield (
            f"The plate's acceleration is accurate to {s.vibration.mode_error:.1e} of its largest only, as a drive "
            "whose velocity or acceleration jumps excites modes without end; a ramp avoids that."
        )
    if s.stretch_error and (worst := s.stretch_error.largest) > MAX_STRETCH_ERROR:
        yield (
            f"The plate that stretches is accurate to {worst:.1e} of its deflection only; "
            + ("take smaller cells." if worst == s.stretch_error.mesh else "reduce the strokes.")
        )
    if s.surface_error > max(MAX_NUMERICAL_ERROR, s.plate_error, s.vibration.mode_error if s.vibration else 0.0):
        yield (
            f"The fitted surface follows the plate's shapes to {s.surface_error:.1e} of a stroke only, as happens at "
            "re-entrant corners, where supports change, in narrow slots, and at actuators near the rim."
        )


def _of_model(s: PlateSummary) -> Iterator[str]:
    if s.linear_path_error is not None and s.deflection_over_thickness > MAX_DEFLECTION:
        far = s.can_stretch and s.linear_path_error > MAX_LINEAR_ERROR
        remedy = f" {VON_KARMAN} in [plate] lets the plate stretch." if far else ""
        yield (
            f"The plate deflects by {s.deflection_over_thickness:.3g} times its thickness; small-deflection theory "
            f"holds to about {MAX_DEFLECTION}. Expect a path error of {about(s.linear_path_error)}.{remedy}"
        )
    if s.largest_slope > MAX_SLOPE:
        remedy = "; smaller strokes or a wider plate reduce it" if s.theory == "von-karman" else ""
        yield (
            f"The surface is as steep as {s.largest_slope:.2g}; small-slope theory holds to about {MAX_SLOPE}{remedy}."
        )
    if s.largest_strain is not None and s.largest_strain > MAX_STRAIN:
        yield (
            f"The plate is strained by {percent(s.largest_strain)}{by_theory(s)}; silicon breaks near 1 %, "
            f"where {100 * MAX_STRAIN:g} % is prudent, and metals yield below that."
        )
    if s.quasi_static_error is not None and s.quasi_static_error > MAX_QUASI_STATIC_ERROR:
        yield (
            f"The drive is at {s.drive_over_first:.2g} of the plate's first frequency; the quasi-static model holds up "
            f"to about {MAX_FREQUENCY}. Expect an acceleration error of {about(s.quasi_static_error)}."
            + (f" {INERTIA} in [plate] has the plate vibrate." if s.can_vibrate else "")
        )
    if s.plate_rings:
        yield (
            "A drive's velocity or acceleration jumps, as at the end of a sine or cosine, or at its start after a "
            "delay; a ramp avoids both. The plate then rings, by as much as its acceleration jumps, until damping ends "
            "it. The quasi-static model leaves that out" + (f"; {INERTIA} in [plate] has it." if s.can_vibrate else ".")
        )
    if s.tips:
        yield (
            f"The centre of pressure shifts by {s.tipping:.2g} times half the part's size: a part this high tips over, "
            "which the model leaves out."
        )
    if s.part_curvature is not None and s.part_curvature > MAX_CURVATURE:
        yield (
            f"Part size times curvature reaches {s.part_curvature:.2g}; the point-part model holds up to about "
            f"{MAX_CURVATURE}."
        )
    sag = s.part_sag_over_roughness
    if sag is not None and s.local_contact and sag > STEEP:
        yield (
            f"The plate sags under the part by up to {sag:.2g} times the roughness; above {STEEP} a local contact is "
            "exact to some per cent only."
        )
    elif sag is not None and not s.local_contact and sag > FLAT:
        bent = "On a plate bent as much only a few asperities touch."
        if s.bent_friction is not None and s.bent_pull_off is not None:
            friction = f"{s.bent_friction:.2g} times the friction at zero load"
            bent = f"Bent as much, it has {friction} and {s.bent_pull_off:.2g} times the pull-off force."
        yield (
            f"The plate sags under the part by up to {sag:.2g} times the roughness; the contact "
            f"is that of flat faces, which holds up to about {FLAT}. {bent}"
        )
