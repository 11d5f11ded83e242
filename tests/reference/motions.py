"""Motions of parts for tests of single kernels."""

from __future__ import annotations

from particle.events.mechanics.motion import Motion, as_numbers
from particle.records import new_records


def motion(*numbers: float) -> Motion:
    """A motion with the first of its numbers given: x, y, v_x, v_y, work, dissipated, z, v_z."""
    motions = new_records(Motion)
    as_numbers(motions)[0, : len(numbers)] = numbers
    return motions[0]
