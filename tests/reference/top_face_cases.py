"""Parts on the top face: cases for the package and for `motion_oracle`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import top_face
from motion_cases import Strokes, breakpoints, limit_of, ratio_of
from motion_oracle import trace
from motion_problem import Height, Path, Problem
from motion_surfaces import still, up_down
from numpy.polynomial.polynomial import polyval2d

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    KogutEtsion,
    Micropart,
    Trajectory,
    polynomial_surface,
    simulate,
)
from particle.friction import Contact
from particle.surface import SurfaceMotion

MASS, G = 2e-9, 9.80665
DOWN = (0.0, 0.0, -G)


@dataclass(frozen=True)
class Case:
    """A part of `mass`, with the contact and the centre of mass at these heights over the mid-plane."""

    contact: float  # m, half the plate's thickness
    centre: float  # m
    start: tuple[float, float]
    law: Contact
    duration: float
    strokes: Strokes  # of the actuators, or of a base along x and y
    gravity: tuple[float, float, float] = DOWN
    velocity: tuple[float, float] = (0.0, 0.0)
    squeeze: float = 0.0
    mass: float = MASS
    flies: bool = False
    strains: Strokes = ()

    def at(self, contact: float, centre: float) -> Case:
        """The same with other heights."""
        return replace(self, contact=contact, centre=centre)

    def heights(self) -> list[Height]:
        return [up_down(*stroke) for stroke in self.strokes]

    def drives(self) -> list[Drive]:
        return [Drive(stroke, f, delay=delay) for stroke, f, delay in self.strokes]

    def base(self) -> list[Height]:
        return [still, still]

    def height(self) -> top_face.Jets:
        raise NotImplementedError

    def in_plane(self) -> list[top_face.Jets]:
        """The mid-plane's motion in its plane, along x and y."""
        return []

    def package(self) -> SurfaceMotion:
        raise NotImplementedError

    def gap(self, x: float, y: float) -> float:
        return 1.0

    def trace(self) -> Path:
        """The oracle's path."""
        problem = Problem(
            top_face.top_face(self.height(), self.contact, self.centre, self.base(), self.in_plane()),
            self.mass,
            limit_of(self.law),
            breakpoints([*self.strokes, *self.strains], self.duration),
            self.gravity,
            self.squeeze,
            self.law.pull_off,
            ratio_of(self.law),
            self.gap,
            0.5 / max(f for _, f, _ in self.strokes),
            self.flies,
            self.law.coefficient if isinstance(self.law, CoulombAdhesion) else 0.0,
        )
        return trace(problem, self.start, self.velocity, self.duration)

    def simulate(self, tolerance: float) -> Trajectory:
        """The package's path."""
        surface = replace(self.package(), half_thickness=self.contact)
        over = self.centre - self.contact
        part = Micropart(self.mass, self.start, self.velocity, squeeze=self.squeeze, centre_height=over)
        after = "fly" if self.flies else "stop"
        return simulate(
            surface, part, self.law, self.duration, self.gravity, tolerance=tolerance, after_detachment=after
        )


class StretchedDisc(DiscShapes):
    """A disc whose mid-plane moves in its plane by polynomials (M, 2, I, J) in places over the radius."""

    def __init__(self, points: list[list[float]], radius: float, stretch: np.ndarray) -> None:
        super().__init__(points, radius)
        self.stretch = stretch

    def in_plane_values(self, xy: np.ndarray) -> np.ndarray:
        x, y = (xy / self.size).T
        return np.moveaxis(np.array([[polyval2d(x, y, c) for c in pair] for pair in self.stretch]), 2, 0)

    def in_plane_heights(self) -> np.ndarray:
        return np.ones(len(self.stretch))


@dataclass(frozen=True)
class Disc(Case):
    """On a clamped disc."""

    actuators: Sequence[Sequence[float]] = ((0.0, 0.0),)
    radius: float = 300e-6
    strains: Strokes = ()  # of the drives of shapes in the plane, over the radius
    stretch: np.ndarray | None = None  # these shapes, polynomials (M, 2, I, J) in places over the radius

    def in_plane_heights(self) -> list[Height]:
        return [up_down(strain * self.radius, f, delay) for strain, f, delay in self.strains]

    def in_plane(self) -> list[top_face.Jets]:
        if self.stretch is None:
            return []
        return [top_face.driven(self.stretch[:, axis], self.radius, self.in_plane_heights()) for axis in range(2)]

    def height(self) -> top_face.Jets:
        return top_face.boggio(self.actuators, self.radius, self.heights())

    def package(self) -> SurfaceMotion:
        points = [list(place) for place in self.actuators]
        if self.stretch is None:
            return surface_motion(DiscShapes(points, self.radius), self.drives(), 1e-11)
        in_plane = [Drive(strain * self.radius, f, delay=delay) for strain, f, delay in self.strains]
        shapes = StretchedDisc(points, self.radius, self.stretch)
        return surface_motion(shapes, self.drives(), 1e-11, in_plane_drives=in_plane)

    def gap(self, x: float, y: float) -> float:
        return self.radius - math.hypot(x, y)


@dataclass(frozen=True)
class Polynomial(Case):
    """On a polynomial, on a base that moves in its plane."""

    coefficients: np.ndarray | None = None
    stretch: np.ndarray | None = None  # of the mid-plane in its plane, (2, I, J, K)

    def in_plane(self) -> list[top_face.Jets]:
        return [] if self.stretch is None else [top_face.polynomial(along) for along in self.stretch]

    def base(self) -> list[Height]:
        return self.heights()

    def height(self) -> top_face.Jets:
        return top_face.polynomial(self.coefficients)

    def package(self) -> SurfaceMotion:
        return polynomial_surface(self.coefficients, self.drives(), in_plane=self.stretch)


PAIR = ((75e-6, 10e-6), (-75e-6, 10e-6))
STROKES = ((150e-6, 300, 0.0), (90e-6, 450, 0.4e-3))
BOWL = np.array([[0.0, 0.05, 0.9], [0.0, 0.2, 0.0], [0.6, 0.0, 0.0]])
SWAYS = np.zeros((3, 3, 4))  # a bowl that rises, tilts and flattens
SWAYS[:, :, 0] = BOWL
SWAYS[0, 0, 2:], SWAYS[1, 0, 1:3], SWAYS[0, 2, 1] = (0.5, -0.4), (0.2, -0.3), -0.4
BASE = ((0.3, 1.6, 0.0), (-0.2, 2.5, 0.1))

CASES = {
    "one actuator": Disc(
        50e-6, 50e-6, (300e-6, 200e-6), ConstantFriction(8e-9), 5e-3, ((15e-6, 2000, 0.0),), radius=1e-3
    ),
    "two actuators": Disc(
        50e-6,
        80e-6,
        (100e-6, -100e-6),
        ConstantFriction(4e-8),
        5e-3,
        ((40e-6, 440, 0.0), (-30e-6, 600, 0.2e-3)),
        actuators=((300e-6, 100e-6), (-250e-6, -350e-6)),
        radius=1e-3,
    ),
    "steep": Disc(
        5e-6,
        15e-6,
        (45e-6, -10e-6),
        ConstantFriction(4e-8),
        5e-3,
        ((50e-6, 400, 0.0),),
        actuators=((10e-6, 5e-6),),
        radius=100e-6,
    ),
    "rough and squeezed": Disc(
        10e-6, 30e-6, (100e-6, 100e-6), KogutEtsion.paper(), 3e-3, STROKES, squeeze=2e-7, actuators=PAIR
    ),
    "static friction": Disc(
        10e-6,
        57e-6,
        (60e-6, -40e-6),
        CoulombAdhesion(0.2, 8e-7, static_coefficient=0.26),
        8e-3,
        STROKES,
        actuators=PAIR,
    ),
    "steep bowl on a base": Polynomial(
        0.02, 0.07, (0.1, 0.0), CoulombAdhesion(0.6, 20.0), 1.0, BASE, mass=1.0, coefficients=BOWL
    ),
    "tilted, squeezed, on a base": Polynomial(
        0.03,
        0.08,
        (0.3, 0.2),
        CoulombAdhesion(0.2, 15.0),
        1.5,
        BASE,
        (1.0, 0.5, -9.0),
        squeeze=2.0,
        mass=1.0,
        coefficients=SWAYS,
    ),
    "flight": Disc(
        10e-6,
        30e-6,
        (60e-6, -40e-6),
        CoulombAdhesion(0.05, 2e-8),
        5e-3,
        ((40e-6, 400, 0.0), (30e-6, 550, 0.2e-3)),
        squeeze=1e-7,
        flies=True,
        actuators=PAIR,
    ),
}

# Shapes in the plane of a disc, over its radius: (1 - r^2) (x, y), (1 - r^2) (1/2 + y, x) and (x y, 0.3 - y^2).
IN_PLANE = np.zeros((3, 2, 4, 4))
IN_PLANE[0, 0, [1, 3, 1], [0, 0, 2]] = IN_PLANE[0, 1, [0, 0, 2], [1, 3, 1]] = 1.0, -1.0, -1.0
IN_PLANE[1, 0, [0, 2, 0, 0, 2, 0], [0, 0, 2, 1, 1, 3]] = 0.5, -0.5, -0.5, 1.0, -1.0, -1.0
IN_PLANE[1, 1, [1, 3, 1], [0, 0, 2]] = 1.0, -1.0, -1.0
IN_PLANE[2, 0, 1, 1], IN_PLANE[2, 1, 0, [0, 2]] = 1.0, (0.3, -1.0)
WARPS = np.zeros((2, 3, 3, 4))  # of a bowl, over time
WARPS[0, 1, 0, 1:], WARPS[1, 0, 1, 1:] = (0.5, -0.8, 0.6), (-0.4, 0.9, -0.5)
WARPS[0, 0, 2, 2], WARPS[1, 1, 1, 3], WARPS[0, 0, 0, 2:], WARPS[1, 0, 0, 2] = 0.7, -0.6, (0.3, -0.2), 0.25


def stretched(case: Case, strain: float) -> Case:
    """The same with a mid-plane that moves in its plane, by such gradients of u."""
    if isinstance(case, Polynomial):
        return replace(case, stretch=strain * WARPS)
    f = max(f for _, f, _ in case.strokes)
    strains = ((strain, f, 0.0), (-strain, f / 2, 0.1 / f), (strain / 2, 1.5 * f, 0.3 / f))
    return replace(case, stretch=IN_PLANE, strains=strains)


STRAIN = 5e-3
for _name in ("two actuators", "static friction", "tilted, squeezed, on a base", "flight"):
    CASES[f"{_name}, stretched"] = stretched(CASES[_name], STRAIN)
