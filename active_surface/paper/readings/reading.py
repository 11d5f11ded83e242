"""Reading: a set of choices that the paper leaves open and that hold for all of its figures."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Final, NamedTuple

from active_surface.paper.models import Bench, Ground
from active_surface.paper.parameters import PARAMETERS, Parameters
from particle import ConstantFriction, KogutEtsion
from particle.friction import Contact

RADII: Final = (210e-6, 227e-6, 260e-6, 300e-6, 310e-6, 350e-6, 400e-6, 455e-6)  # m
GRAVITY: Final = 9.80665  # m/s^2; the paper's forces have none
INDEX, CONSTANT = "rough contact", "constant friction"
LAWS: Final[dict[str, Contact]] = {INDEX: KogutEtsion.paper(), CONSTANT: ConstantFriction(20.9 * PARAMETERS.mass)}
"""What stands for the paper's 20.9 m/s^2, which Table 1 does not give: another plasticity index, or that itself."""
RIM, FLAT = "ends at the rim", "flat beyond"
MARGIN: Final = 1e-3  # m, of what is flat
TIME_STEP: Final = 5e-6  # s, of the paper's scheme, as its paths are many
TOLERANCE: Final = 1e-7  # of located events


class Reading(NamedTuple):
    """What one sweep varies; what single statements need besides is varied with them."""

    radius: float  # m
    gravity: float  # m/s^2
    law: str  # of LAWS

    @property
    def name(self) -> str:
        """In words."""
        return f"a = {1e6 * self.radius:g} um, {'gravity' if self.gravity else 'no gravity'}, {self.law}"

    def parameters(self, base: Parameters = PARAMETERS) -> Parameters:
        """The parameters of all figures."""
        return replace(
            base, radius=self.radius, gravity=self.gravity, friction=LAWS[self.law], time_step=TIME_STEP,
            tolerance=TOLERANCE,
        )  # fmt: skip


class SweepSize(NamedTuple):
    """How much work a sweep is."""

    readings: tuple[Reading, ...]
    starts: int  # of each statement
    step: float  # Hz, between frequencies of figure 18
    frequencies: int  # of figures 5, 6 and 15
    across: int  # places of figures 5 and 6


READINGS: Final = tuple(Reading(*one) for one in product(RADII, (0.0, GRAVITY), LAWS))


def benches_of(reading: Reading, grounds: dict[str, dict[tuple[str, str], Ground]]) -> dict[str, Bench]:
    """A bench for each place where the surface ends; grounds of the same radius are shared by readings."""
    p = reading.parameters()
    return {
        end: Bench(p, margin, grounds.setdefault(f"{reading.radius}, {end}", {}))
        for end, margin in ((RIM, 0.0), (FLAT, MARGIN))
    }
