"""One step of a sliding part."""

import math

import numba
import numpy as np
import pytest

from particle import ConstantFriction, polynomial_surface
from particle.events.mechanics.equations import Part
from particle.events.memory import new_memory
from particle.events.request import Request
from particle.events.sliding import contact_end
from particle.events.sliding.slide import slide
from particle.events.tableau import pairs_for
from particle.modes import Mode, Verdict
from particle.surface.span import enter


@pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="compiled kernels cannot be replaced")
def test_a_step_that_is_cut_a_little_does_not_become_as_long_as_the_span_again(monkeypatch):
    """It was tried at the whole span for ever where the cut left more than nine tenths."""
    cuts = [0.95, 0.97]

    def excursion(*_):
        return cuts.pop() if cuts else 1.0

    monkeypatch.setattr(contact_end, "first_excursion", excursion)
    surface, pairs = polynomial_surface([[0.0]]).record, pairs_for(1e-9)
    part = Part(1.0, 9.81, 0.0, 0.0, 0.0, ConstantFriction(1.0).law)
    start = np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    times = {"begin": 0.0, "until": 1.0, "first_step": 0.02, "duration": 1.0, "stroke_time": 1.0}
    flags = {"flies": False, "jumps": False, "centre_height": 0.0, "bridged": (0.0, 0.0)}
    request = Request(part, start, Mode.SLIDING, tolerance=1e-9, force=1.0, **times, **flags)
    memory = new_memory(surface, pairs, np.zeros(1, dtype=np.int64))
    motion, now = memory.motion[0], memory.now[0]
    enter(surface, memory.local, 0.0, 0.0, 0.0, 1.0)
    motion.v_x, now.mode, now.h, now.span_end = 5.0, Mode.SLIDING, math.inf, 1.0
    slide(surface, request, pairs, memory)
    assert (now.mode, now.verdict) == (Mode.SLIDING, Verdict.GOES_ON)
    assert now.time == pytest.approx(0.95 * 0.97, rel=1e-15)
    assert motion.x == pytest.approx(5.0 * now.time - 0.5 * now.time**2, rel=1e-14)
