"""Paths of the paper's part made by hand, and one that comes off."""

from types import SimpleNamespace

import numpy as np

from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.path import Path
from particle import EventKind

PITCH, PERIOD = PARAMETERS.pitch, 1 / 300.0  # m, s


def path(*places, outcome="moving", duration=30 * PERIOD, events=()):
    """A path over places in um, evenly spaced in time; it stays at the last one for the last half of the time."""
    rows = np.array([*places, places[-1]], dtype=float) * 1e-6
    times = np.append(np.linspace(0, duration / 2, len(places)), duration)
    trajectory = SimpleNamespace(time=times, position=rows, outcome=SimpleNamespace(value=outcome), events=events)
    return Path(trajectory, np.zeros(2))


def lost_at(x, y, speed=0.2):
    event = SimpleNamespace(kind=EventKind.DETACHES, position=(x, y), speed=speed)
    return path((100, 0), (1e6 * x, 1e6 * y), outcome="detached", events=(event,))
