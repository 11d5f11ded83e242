"""Parts with a face against a free rigid body on stiff springs, point by point."""

from dataclasses import replace

import numpy as np
import pytest
from spring_body import CASES
from spring_body import Body as SpringBody

from particle import Body, CoulombAdhesion, Footprint, polynomial_surface, simulate

pytestmark = [pytest.mark.slow, pytest.mark.compiled]


def test_a_long_part_slides_and_turns_on_a_saddle_as_on_springs():
    """Friction that leans with each point's own normal, not with the face's, is the difference."""
    case, springs = CASES["C"], SpringBody("C", om=1e5, eps=1e-7)
    there = springs.run()
    end = springs.coords(there.y[:, -1], there.t[-1])
    x, y, heading = case["start"]
    part = Body(
        Footprint.rectangle(*case["face"]),
        case["thickness"],
        density=case["density"],
        position=(x, y),
        heading=heading,
        velocity=tuple(case["rate"][:2]),
        spin=case["rate"][2],
    )
    shape = case["surface"]
    saddle = polynomial_surface([[0, 0, shape["qy"]], [0, 0, 0], [shape["qx"], 0, 0]], size=1e-3)
    path = simulate(replace(saddle, half_thickness=case["zk"]), part, CoulombAdhesion(case["mu"]), case["end"])
    assert np.hypot(*(path.position[-1] - end[:2])) < 4e-4 * path.path_length
    assert abs(path.heading[-1] - end[2]) < 2e-3 * abs(end[2] - heading)
