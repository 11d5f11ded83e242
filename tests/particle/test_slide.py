"""One step of a sliding part."""

import math

import numba
import numpy as np
import pytest

from particle import ConstantFriction, polynomial_surface
from particle.events import slide
from particle.events.equations import Part
from particle.events.record import SLIDING
from particle.events.runge_kutta import new_step, pairs_for
from particle.surface.local import new_local
from particle.surface.span import enter


@pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="compiled kernels cannot be replaced")
def test_a_step_that_is_cut_a_little_does_not_become_as_long_as_the_span_again(monkeypatch):
    """It was tried at the whole span for ever where the cut left more than nine tenths."""
    cuts = [0.95, 0.97]

    def excursion(*_):
        return cuts.pop() if cuts else 1.0

    monkeypatch.setattr(slide, "first_excursion", excursion)
    surface, pairs = polynomial_surface([[0.0]]).record, pairs_for(1e-9)
    part = Part(1.0, 9.81, 0.0, 0.0, 0.0, ConstantFriction(1.0).law)
    request = slide.Request(part, np.array([0.0, 0.0, 5.0, 0.0]), 1.0, 1e-9, 1.0, 1.0, False, False, False, (0.0, 0.0))
    local, step, count = new_local(surface), new_step(pairs), np.zeros(3, dtype=np.int64)
    enter(surface, local, 0.0, 0.0, 0.0, 1.0)
    state = np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    mode, time, _, verdict = slide.slide(
        surface, local, request, pairs, step, count, SLIDING, 0.0, math.inf, 1.0, state
    )
    assert (mode, verdict) == (SLIDING, slide.GOES_ON)
    assert time == pytest.approx(0.95 * 0.97, rel=1e-15)
    assert state[0] == pytest.approx(5.0 * time - 0.5 * time**2, rel=1e-14)
