"""The micropart: contact and friction laws, drives, the moving surface as arrays, and the integrator."""

from particle.drive import Drive
from particle.friction import ConstantFriction, CoulombAdhesion
from particle.kogut_etsion import KogutEtsion
from particle.simulate import Micropart, simulate
from particle.surface import SurfaceMotion, SurfaceState, polynomial_surface
from particle.trajectory import Energy, Event, EventKind, Outcome, Samples, State, Trajectory

__all__ = [
    "ConstantFriction",
    "CoulombAdhesion",
    "Drive",
    "Energy",
    "Event",
    "EventKind",
    "KogutEtsion",
    "Micropart",
    "Outcome",
    "Samples",
    "State",
    "SurfaceMotion",
    "SurfaceState",
    "Trajectory",
    "polynomial_surface",
    "simulate",
]
