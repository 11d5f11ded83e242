"""The micropart: contact and friction laws, drives, the moving surface as arrays, and the integrator."""

from particle.batch import Interrupted, simulate_many
from particle.drive import AnyDrive, Drive
from particle.drive_points import HermiteDrive, TableDrive
from particle.drive_schedule import Segment, SegmentDrive
from particle.friction import ConstantFriction, CoulombAdhesion
from particle.friction_table import FrictionTable
from particle.kogut_etsion import KogutEtsion
from particle.micropart import Micropart
from particle.simulate import simulate
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
    "Interrupted",
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
    "simulate_many",
]
