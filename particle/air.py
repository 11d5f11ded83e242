"""The air under the flat face of a part: how it resists a change of the gap, and a slip.

Reynolds' equation of a thin film, with the flow of a rarefied gas, for a gap h under a face of area A:

    d(p h)/dt = div(h^3 p Qbar/(12 mu) grad p),    p = p_a at the rim
    Qbar = 1 + 9.638 Kn^1.159,    Kn = mfp/h,    mfp = mu/p_a sqrt(pi R T/(2 M))

A slow change of the gap then meets the force -C dh/dt, and a slip u the force -mu A/(h + 2 mfp) u,

    C = 12 mu/(h^3 Qbar) int phi dA,    -laplace(phi) = 1,    phi = 0 at the rim.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.checks import not_negative, positive, refuse
from particle.footprint import Footprint

GAS_CONSTANT, MOLAR_MASS = 8.314462618, 0.0289647  # J/(mol K), and of dry air, kg/mol
VISCOSITY, WARM, SUTHERLAND = 1.82e-5, 293.15, 110.4  # Pa s, at that temperature, K; of Sutherland's law, K
RAREFIED, POWER = 9.638, 1.159  # of the flow by the Knudsen number
NODES = 48  # of an integral over gaps


@dataclass(frozen=True)
class Air:
    """The air around a part.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    pressure: float = 101325.0  # Pa; 0 in a vacuum
    temperature: float = 293.15  # K
    bow: float = 0.0  # m, what a part that is not flat, or stands on feet, adds to its gap

    def __post_init__(self) -> None:
        refuse(
            "Air",
            [
                (not_negative(self.pressure), "pressure", "0 or a positive pressure in Pa", self.pressure),
                (positive(self.temperature), "temperature", "positive, in K", self.temperature),
                (not_negative(self.bow), "bow", "0 or a positive length in m", self.bow),
            ],
        )

    @property
    def viscosity(self) -> float:
        """Pa s, by Sutherland's law."""
        warmth = self.temperature / WARM
        return VISCOSITY * warmth**1.5 * (WARM + SUTHERLAND) / (self.temperature + SUTHERLAND)

    @property
    def mean_free_path(self) -> float:
        """m; inf in a vacuum."""
        if self.pressure == 0:
            return math.inf
        thermal = math.sqrt(math.pi * GAS_CONSTANT * self.temperature / (2 * MOLAR_MASS))
        return self.viscosity / self.pressure * thermal

    def flow_factor(self, gap: float) -> float:
        """Qbar, by how much more a rarefied gas flows through a gap [m] than a dense one; inf in a vacuum.

        As good as the linearised BGK equation to 1 % near Kn = 0.7.
        """
        return 1 + RAREFIED * (self.mean_free_path / gap) ** POWER

    def damping(self, footprint: Footprint, gap: float) -> float:
        """C [N s/m] of a level face at a gap [m]."""
        return 12 * self.viscosity * footprint.torsion[0] / (gap**3 * self.flow_factor(gap))

    def drag(self, area: float, gap: float) -> float:
        """mu A/(h + 2 mfp) [N s/m], the force against a slip over its velocity, at a gap [m]."""
        return self.viscosity * area / (gap + 2 * self.mean_free_path)

    def impulse(self, footprint: Footprint, gap: float) -> float:
        """J = int C dh [N s] from a gap [m] on: what it takes to pull the face off, and what slows its landing."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        share = (nodes + 1) / 2  # of the gap over a wider one
        dampings = [self.damping(footprint, gap / s) for s in share.tolist()]
        return float(weights / 2 @ (np.array(dampings) / share**2)) * gap
