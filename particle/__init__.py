"""The micropart: contact and friction laws, drives, the moving surface as arrays, and the integrator."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Air",
    "AnyDrive",
    "Body",
    "ConstantFriction",
    "ContactSamples",
    "CoulombAdhesion",
    "Drive",
    "Energy",
    "Event",
    "EventKind",
    "FaceLaw",
    "Film",
    "FilmEnergy",
    "Footprint",
    "FrictionTable",
    "HermiteDrive",
    "Interrupted",
    "KogutEtsion",
    "LocalContact",
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
