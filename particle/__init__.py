"""The micropart: contact and friction laws, drives, the moving surface as arrays, and the integrator."""

from particle.drive import Drive
from particle.forces import contact_forces
from particle.friction import ConstantFriction, CoulombAdhesion
from particle.friction_table import FrictionTable
from particle.kogut_etsion import KogutEtsion
from particle.simulate import Micropart, simulate
from particle.surface import SurfaceMotion, SurfaceState, polynomial_surface
from particle.trajectory import Event, EventKind, Outcome, State, Trajectory

__all__ = [
    "ConstantFriction",
    "CoulombAdhesion",
    "Drive",
    "Event",
    "EventKind",
    "FrictionTable",
    "KogutEtsion",
    "Micropart",
    "Outcome",
    "State",
    "SurfaceMotion",
    "SurfaceState",
    "Trajectory",
    "contact_forces",
    "polynomial_surface",
    "simulate",
]
