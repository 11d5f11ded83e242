"""What the air under a part does: gauges by which to tell whether a path without a film of air holds.

A part that stands at the gap h over a plate that shakes at f, with the contact's stiffness k_c = -dN/dh and the film's
damping C (`particle.air`), J = int C dh from h on:

    load share     Gamma = 2 pi f C/k_c, how far the load swings in the film and not in the contact
    breathing      k_c b L Gamma/sqrt(1 + Gamma^2)/(m g + pull-off), L the largest change of the plate's lap w under the
                   part and b = int phi r^2 dA/(4 int phi dA): what a plate that bends pumps, over what holds the part
    escape speed   J/m: a plate whose velocity changes by less does not let go of a part in air
    settle time    J/(m g + squeeze), from a flight down to the contact
    drag rate      mu A/(m (h + 2 mfp)) of a slip
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from coupling.case import Case, KogutEtsionCase
from coupling.drives import fastest
from coupling.part import air_of, build_part, footprint_of, gap_under, resting_separation, rough_under, weight_of
from coupling.scene import PlateScene, Scene
from particle import KogutEtsion, Trajectory, simulate
from particle.friction import Contact

ROWS: Final = 4000  # of a path at which the surface is looked at
STEP: Final = 1e-4  # roughnesses, over which the stiffness is found


@dataclass(frozen=True)
class AirFigures:
    """What the air under the part does, and what of it the path includes."""

    pressure: float  # Pa
    gap: float  # m, under the part at rest
    assumed: bool  # whether gap and stiffness are those of rough surfaces of Table 1, as the law states none
    frequency: float | None  # Hz, of the fastest drive; None: a measured motion
    load_share: float | None  # Gamma at that frequency
    breathing: float | None  # of what holds the part
    escape_speed: float  # m/s
    settle_time: float | None  # s; None: nothing presses it down
    drag_rate: float  # 1/s
    velocity_change: float  # m/s, the largest of the surface's vertical velocity under the part
    sag_over_gap: float  # the plate's largest under the part, over that gap
    included: str  # in the path: "nothing", "drag", or with a "film" its load and drag
    largest_gap: float | None  # m, the mean under the part in the path with a film; else None, as is the next
    film_balance: float | None  # the largest gap in the film's energy ledger over the largest of its entries
    end_without: tuple[float, float] | None  # m, of a path without the film
    outcome_without: str | None  # of that path


def air_figures(case: Case, scene: Scene, trajectory: Trajectory, friction: Contact) -> AirFigures | None:
    """The figures of a path; None: the part has no size."""
    footprint = footprint_of(case)
    if footprint is None:
        return None
    air, weight, mass = air_of(case), weight_of(case), case.part.mass
    rough, gap = rough_under(case, footprint), gap_under(case, footprint)
    separation = resting_separation(rough, weight)
    damping, impulse = air.damping(footprint, gap), air.impulse(footprint, gap)
    stiffness = _stiffness(rough, separation)
    frequency = None if scene.fits else fastest(scene.lifts)
    share = None if frequency is None else 2 * math.pi * frequency * damping / stiffness
    bends, velocity, curvature = _changes(scene, trajectory)
    pull_off = friction.pull_off if math.isfinite(friction.pull_off) else rough.pull_off
    pumped = stiffness * footprint.torsion[1] * bends
    without = _without_film(case, scene, friction) if trajectory.gap is not None else None
    return AirFigures(
        pressure=air.pressure,
        gap=gap,
        assumed=not isinstance(case.friction, KogutEtsionCase),
        frequency=frequency,
        load_share=share,
        breathing=None
        if share is None or weight + pull_off <= 0
        else pumped * share / math.hypot(1, share) / (weight + pull_off),
        escape_speed=impulse / mass,
        settle_time=impulse / weight if weight > 0 else None,
        drag_rate=air.drag(footprint.area, gap) / mass,
        velocity_change=velocity,
        sag_over_gap=0.5 * curvature * footprint.reach**2 / gap,
        included="nothing" if case.air is None or air.pressure == 0 else "film" if case.air.film else "drag",
        largest_gap=None if trajectory.gap is None else float(trajectory.gap.max()),
        film_balance=None if trajectory.film_energy is None else trajectory.film_energy.balance,
        end_without=None if without is None else (float(without.position[-1, 0]), float(without.position[-1, 1])),
        outcome_without=None if without is None else without.outcome.value,
    )


def _stiffness(rough: KogutEtsion, separation: float) -> float:
    """-dN/dh [N/m] at a separation [roughnesses]."""
    closer, farther = rough.net_load([separation - STEP, separation + STEP]).tolist()
    return float(closer - farther) / (2 * STEP * rough.roughness)


def _without_film(case: Case, scene: Scene, friction: Contact) -> Trajectory:
    """The path with the drag of the air alone."""
    run, drags = case.run, case.vary({"air.film": False})
    return simulate(
        scene.surface,
        build_part(drags),
        friction,
        run.duration,
        run.gravity,
        run.tolerance,
        after_detachment=run.after_detachment,
        after_tipping=run.after_tipping,
    )


def _changes(scene: Scene, trajectory: Trajectory) -> tuple[float, float, float]:
    """The largest changes, along the path, of lap w [1/m] and w_t [m/s] under the part; the largest curvature [1/m]."""
    rows = np.unique(np.linspace(0, len(trajectory.time) - 1, ROWS).astype(int))
    places, times = trajectory.position[rows], trajectory.time[rows]
    if isinstance(scene, PlateScene):
        on_plate = scene.shapes.outline.gap(places) >= 0  # all but the last of a part that slid over the rim
        places, times = places[on_plate], times[on_plate]
    state = scene.surface.evaluate_along(places, times)
    bend = np.trace(state.hessian, axis1=1, axis2=2)
    return float(np.ptp(bend)), float(np.ptp(state.w_t)), float(np.abs(np.linalg.eigvalsh(state.hessian)).max())
