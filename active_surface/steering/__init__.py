"""Steering: the drives that bring a part to a target, or over way-points."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Aimed",
    "Followed",
    "Objective",
    "Planned",
    "Route",
    "Settings",
    "Task",
    "aim",
    "follow_plan",
    "objective",
    "plan",
    "read_route",
    "read_task",
]
