"""Body: a part with a face."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from particle.air import Air
from particle.body.face import Face
from particle.checks import finite, not_negative, positive, refuse
from particle.footprint import Footprint
from particle.types import FloatArray

PRESSURES = ("linear", "uniform")
FAR_POINTS = 6, 4  # of the rules for friction that turns little and hardly, a side


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid part with a flat face that lies on the surface; (x, y) is the point of the mid-plane under its origin.

    Of mass and density one is given; the other follows for a block of uniform thickness, as does the inertia.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    footprint: Footprint
    thickness: float  # m
    mass: float = math.nan  # kg
    density: float = math.nan  # kg/m^3
    position: tuple[float, float] = field(kw_only=True)  # m
    heading: float = 0.0  # rad, of its own x over the plate's, counter-clockwise
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    spin: float = 0.0  # rad/s, the rate of the heading
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along its normal
    centre_height: float | None = None  # m, of its centre of mass over its face; by default half the thickness
    inertia: ArrayLike | None = None  # kg m^2, (3,) or (3, 3) about the centre of mass; by default that of the block
    pressure: str = "linear"  # under the face: "linear" bears its moments, "uniform" is the same everywhere
    drag: float = 0.0  # N s/m, of the air under it: a force against its slip (`Air.drag`)
    film: Air | None = None  # of a film under it, which bears load and has a drag of its own, in place of `drag`

    def __post_init__(self) -> None:
        numbers = {"heading": (self.heading, "rad"), "spin": (self.spin, "rad/s")}
        pairs = {name: getattr(self, name) for name in ("position", "velocity")}
        refuse(
            "Body",
            [
                (isinstance(self.footprint, Footprint), "footprint", "a Footprint", self.footprint),
                (positive(self.thickness), "thickness", "positive, in m", self.thickness),
                *(
                    (finite(value), name, f"a finite number, in {unit}", value)
                    for name, (value, unit) in numbers.items()
                ),
                (not_negative(self.squeeze), "squeeze", "0 or a positive force in N", self.squeeze),
                (not_negative(self.drag), "drag", "0 or a positive drag in N s/m", self.drag),
                (self.pressure in PRESSURES, "pressure", "'linear' or 'uniform'", self.pressure),
                *((_is_pair(value), name, "two finite numbers", value) for name, value in pairs.items()),
            ],
        )
        known = self.footprint.radius > 0 or self.footprint.is_rectangle
        film = self.film is None or (known and isinstance(self.film, Air) and self.film.pressure > 0)
        refuse("Body", [(film, "film", "None, or an Air of a positive pressure under a rectangle or disc", self.film)])
        volume = self.footprint.area * self.thickness
        masses = {name: value for name in ("mass", "density") if not _missing(value := getattr(self, name))}
        wanted = "given, or its density in its place, but not both"
        refuse("Body", [(len(masses) == 1, "mass", wanted, " and ".join(masses) or "neither")])
        name, value = masses.popitem()
        refuse("Body", [(positive(value), name, "positive", value)])
        mass = value if name == "mass" else value * volume
        height = self.thickness / 2 if self.centre_height is None else self.centre_height
        refuse("Body", [(not_negative(height), "centre_height", "0 or a positive length in m", height)])
        given = _block(self.footprint, self.thickness, mass) if self.inertia is None else _matrix(self.inertia)
        wanted = "three positive moments or a symmetric, positive 3 x 3 matrix, in kg m^2"
        good = np.allclose(given, given.T, rtol=1e-9) and (np.linalg.eigvalsh(given) > 0).all()
        refuse("Body", [(bool(good), "inertia", wanted, self.inertia)])
        found = {"mass": mass, "density": mass / volume, "centre_height": float(height), "inertia": given}
        for name, value in found.items():
            object.__setattr__(self, name, value)

    def face(self, points: int, tips: bool) -> Face:
        """Its numbers for kernels, with averages over the face exact up to the degree 2 points - 1."""
        footprint = self.footprint
        places, weights = footprint.averaging(points)
        rules = [footprint.averaging(count) for count in FAR_POINTS]
        far, farther = (np.column_stack([xy, footprint.area * share]) for xy, share in rules)
        fine, fine_weights = footprint.rule(32)
        return Face(
            places=places,
            weights=weights,
            unmoments=np.asarray(np.linalg.inv(footprint.second_moments), dtype=float),
            corners=footprint.corners,
            hull=footprint.hull,
            radius=float(footprint.radius),
            area=footprint.area,
            reach=footprint.reach,
            arm=float(fine_weights @ np.hypot(*fine.T)),
            far=far,
            farther=farther,
            inertia=np.array(self.inertia, dtype=float),
            linear=self.pressure == "linear",
            tips=tips,
        )


def _missing(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _is_pair(value: Any) -> bool:
    return np.shape(value) == (2,) and all(finite(part) for part in value)


def _matrix(inertia: ArrayLike) -> FloatArray:
    """The matrix of three moments, or of a matrix; of zeros where it is neither."""
    try:
        values = np.array(inertia, dtype=float)
    except (TypeError, ValueError):
        return np.zeros((3, 3))
    values = np.diag(values) if values.shape == (3,) else values
    return values if values.shape == (3, 3) and np.isfinite(values).all() else np.zeros((3, 3))


def _block(footprint: Footprint, thickness: float, mass: float) -> FloatArray:
    """The inertia (3, 3) [kg m^2] of a block of uniform thickness about its centre: m (tr J 1 - J), J its moments."""
    moments = np.zeros((3, 3))
    moments[:2, :2], moments[2, 2] = footprint.second_moments, thickness**2 / 12
    return mass * (np.trace(moments) * np.eye(3) - moments)
