"""Cases of discs that vibrate, and how far their surfaces are from the series of `radial_vibration`."""

import numpy as np
from radial_vibration import RadialDisc

from coupling.case import ActuatorCase, Case, ConstantCase, PartCase, RunCase
from fem_plate import PlateSection

E, NU, DENSITY, THICKNESS, RADIUS = 169e9, 0.3, 2330.0, 5e-6, 300e-6
RIGIDITY = E * THICKNESS**3 / 12 / (1 - NU**2)
UNIT = np.sqrt(RIGIDITY / (DENSITY * THICKNESS)) / RADIUS**2  # rad/s
PLATE = {
    "shape": "disc",
    "radius": RADIUS,
    "youngs_modulus": E,
    "poisson_ratio": NU,
    "thickness": THICKNESS,
    "density": DENSITY,
    "inertia": True,
}
R = np.array([0.3, 0.6])
CENTRE = (0.0, 0.0)
DISC = RadialDisc()
FIRST = DISC.k[0] ** 2 * UNIT / (2 * np.pi)  # Hz
UNIT_SECTION = PlateSection(12 * (1 - NU**2), NU, 1.0, 1.0)


def case_of(actuators, duration, plate=(), **run):
    return Case(
        plate=PLATE | dict(plate),
        actuators=actuators if isinstance(actuators, list) else [actuators],
        part=PartCase(mass=2e-9, position=(90e-6, 0.0)),
        friction=ConstantCase(limit=1e-8),
        run=RunCase(duration=duration, **run),
        name="ringing",
    )


def on_radii(radii=R):
    """Points there, in different directions."""
    angle = 0.7 * np.arange(len(radii))
    return RADIUS * radii[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def off(surface, pieces, times, disc=DISC, ratio=0.02, radii=R):
    """The largest errors of w and w_tt over the largest of these."""
    found = [surface.evaluate(on_radii(radii), time) for time in times]
    truth = np.array([disc.motion(pieces, radii, time, UNIT, ratio)[[0, 2]] for time in times])
    values = np.array([[state.w, state.w_tt] for state in found])
    return np.abs(values - truth).max(axis=(0, 2)) / np.abs(truth).max(axis=(0, 2))


def up_down(frequency, stroke=1e-6, **further):
    return ActuatorCase(position=CENTRE, stroke=stroke, frequency=frequency, **further)
