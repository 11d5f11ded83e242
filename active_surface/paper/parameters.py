"""Parameters: the one set with which every figure is reproduced, and how much work that may be."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from fem_plate import PlateSection
from particle import KogutEtsion
from particle.friction import Contact

Place = tuple[float, float]  # m


@dataclass(frozen=True)
class Parameters:
    """What the paper states, and what it leaves open (docs/paper-open-points.md): one set for all figures.

    What one figure alone needs and the paper does not state stands beside its computation.
    """

    radius: float = 300e-6  # m, a of equation (2); left open
    pitch: float = 150e-6  # m, between two actuators
    stroke: float = 150e-6  # m
    strokes: tuple[float, ...] = (100e-6, 200e-6)  # m, least and largest of figure 18
    slipping: tuple[float, ...] = (80e-6, 95e-6, 110e-6)  # m, strokes of figures 5 and 6; left open
    carrying: tuple[float, ...] = (60e-6, 70e-6, 80e-6, 90e-6, 100e-6)  # m, strokes of figure 15; left open
    mass: float = 2e-9  # kg
    gravity: float = 0.0  # m/s^2; the paper's forces have no weight
    friction: Contact = field(default_factory=KogutEtsion.paper)
    start: Place = (100e-6, 100e-6)  # figure 17, and wherever none is given
    cycles: int = 30  # how long continuous drives run
    time_step: float = 2e-6  # s, of the paper's scheme; left open
    tolerance: float = 1e-8  # of the located events
    jitter: float = 1e-6  # m, by which starts are displaced at most along x and along y: places are given in um
    near: float = 30e-6  # m: a part has converged that spends the last five cycles so close to the actuator
    far: float = 200e-6  # m: it has left the actuator's region when it gets farther than that, or over the rim
    youngs_modulus: float = 169e9  # Pa; with rigid actuators and a clamped rim neither it nor the thickness counts
    poisson_ratio: float = 0.3  # of the plate
    thickness: float = 5e-6  # m
    density: float = 2330.0  # kg/m^3, of the plate; counts with inertia alone
    contact_side: float = 100e-6  # m, of the part's square contact
    seed: int = 4

    @property
    def section(self) -> PlateSection:
        """Of the plate."""
        return PlateSection(self.youngs_modulus, self.poisson_ratio, self.thickness, self.density)


PARAMETERS = Parameters()


class Effort(NamedTuple):
    """How many starts, frequencies and places are looked at."""

    name: str
    starts: int  # jittered starts with located events
    starts_by_steps: int  # with the paper's scheme, whose paths take a hundred times longer
    frequencies: int  # of figures 5, 6 and 15
    step: float  # Hz, between frequencies of figure 18
    strokes: int  # of figure 18
    across: int  # places along the plate, figures 5 and 6
    pitches: int  # of the dead zones
    candidates: int  # frequencies tried there


QUICK = Effort("quick", 60, 36, 40, 20.0, 5, 50, 11, 6)
FULL = Effort("full", 400, 100, 80, 10.0, 9, 120, 11, 12)
TINY = Effort("tiny", 2, 1, 3, 200.0, 2, 12, 1, 1)  # for tests: shows that it runs, and nothing else
