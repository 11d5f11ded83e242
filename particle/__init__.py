"""The micropart: contact and friction laws, drives, the moving surface as arrays, and the integrator."""

from particle.drive import AnyDrive, Drive
from particle.drive_points import HermiteDrive, TableDrive
from particle.drive_schedule import Segment, SegmentDrive
from particle.friction import ConstantFriction, CoulombAdhesion
from particle.friction_table import FrictionTable
from particle.kogut_etsion import KogutEtsion
from particle.simulate import Micropart, simulate
from particle.surface import SurfaceMotion, SurfaceState, platform_surface, polynomial_surface
from particle.trajectory import Energy, Event, EventKind, Outcome, Samples, State, Trajectory

__all__ = [
    "AnyDrive",
    "ConstantFriction",
    "CoulombAdhesion",
    "Drive",
    "Energy",
    "Event",
    "EventKind",
    "FrictionTable",
    "HermiteDrive",
    "KogutEtsion",
    "Micropart",
    "Outcome",
    "Samples",
    "Segment",
    "SegmentDrive",
    "State",
    "SurfaceMotion",
    "SurfaceState",
    "TableDrive",
    "Trajectory",
    "platform_surface",
    "polynomial_surface",
    "simulate",
]
