"""Tipping of a part that sticks to a shaken platform, against the balance of its moments."""

import numpy as np
import pytest

from coupling import build_friction, run_case
from coupling.case import Case, CoulombCase, KogutEtsionCase, TableCase
from coupling.part import tipping_of
from particle import KogutEtsion

MASS, SIZE, HEIGHT, G = 2e-9, 100e-6, 80e-6, 9.80665
STROKE, FREQUENCY = 4e-6, 100.0
FORCE = MASS * STROKE * (2 * np.pi * FREQUENCY) ** 2 / 2  # N, largest: x = stroke (1 - cos) / 2
LAWS = {
    "no adhesion": (CoulombCase(coefficient=5.0), 0.0),
    "Coulomb": (CoulombCase(coefficient=5.0, adhesion=3e-8), 3e-8),
    "measured": (TableCase(loads=(-2e-8, 0.0, 1e-7), limits=(1e-8, 2e-8, 3e-8)), 2e-8),
    "constant": ({"model": "constant", "limit": 1e-6}, 0.0),
}


def on_a_platform(friction, **part):
    return Case(
        plate={"shape": "platform", "motion": {"x": {"stroke": STROKE, "frequency": FREQUENCY, "cycle": "cosine"}}},
        part={"mass": MASS, "position": (0.0, 0.0), "centre_height": HEIGHT, "size": SIZE} | part,
        friction=friction,
        run={"duration": 0.02},
    )


def tipping(case):
    result = run_case(case)
    return tipping_of(case, result.trajectory.contact_at(np.linspace(0, 0.02, 401)), build_friction(case))


@pytest.mark.parametrize("law", LAWS)
def test_the_pressing_force_is_weight_and_adhesion(law):
    friction, adhesion = LAWS[law]
    expected = FORCE * HEIGHT / (MASS * G + adhesion) / (SIZE / 2)
    assert tipping(on_a_platform(friction)) == pytest.approx(expected, rel=1e-3)


def test_a_rough_contact_adheres_as_its_separation_has_it():
    rough = KogutEtsion.paper()
    _, adhesion, _ = rough.forces(rough.separation([MASS * G]))
    expected = FORCE * HEIGHT / (MASS * G + float(adhesion[0])) / (SIZE / 2)
    assert adhesion[0] > 0
    assert tipping(on_a_platform(KogutEtsionCase(preset="paper"))) == pytest.approx(expected, rel=1e-3)


def test_a_part_without_height_or_size_has_none():
    assert tipping(on_a_platform(CoulombCase(coefficient=5.0), centre_height=0.0)) == 0.0
    assert tipping(on_a_platform(CoulombCase(coefficient=5.0), size=None)) is None
