"""Device: the paper's actuators under one plate that stretches, made as a case file would have it."""

from __future__ import annotations

from active_surface.arrays import FloatArray
from active_surface.paper.parameters import Parameters
from coupling import Case, StretchedSurface, shared_surface
from particle import Drive

SURFACE_TOLERANCE = 1e-6
LOWEST = 100.0  # Hz, of all drives over it: paths last for the cycles of the slowest one


def device_case(p: Parameters, points: FloatArray, stroke: float, inertia: bool = False) -> Case:
    """A clamped disc that cannot move in its plane at its rim, on actuators at points (n, 2) [m] with a stroke [m]."""
    return Case(
        plate={
            "shape": "disc", "radius": p.radius, "supports": "clamped", "youngs_modulus": p.youngs_modulus,
            "poisson_ratio": p.poisson_ratio, "thickness": p.thickness, "density": p.density, "theory": "von-karman",
            "inertia": inertia,
        },
        actuators=[{"position": (x, y), "stroke": stroke, "frequency": LOWEST} for x, y in points.tolist()],
        part={"mass": p.mass, "centre_height": p.centre_height, "position": (0.0, 0.0)},
        friction={"model": "coulomb", "coefficient": 0.1},
        run={"duration": p.cycles / LOWEST, "surface_tolerance": SURFACE_TOLERANCE},
    )  # fmt: skip


def device_surface(p: Parameters, points: FloatArray) -> StretchedSurface:
    """The surface for all heights up to the largest stroke: of figure 18 over one actuator, of the paper over more."""
    stroke = p.strokes[-1] if len(points) == 1 else p.stroke
    case = device_case(p, points, stroke)
    drives = [Drive(stroke, LOWEST)] * len(points)
    surface = shared_surface(case, [drives], case.run.duration)
    assert isinstance(surface, StretchedSurface)
    return surface
