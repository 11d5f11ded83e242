"""Friction laws: constant, Coulomb with adhesion, and what they refuse."""

import math

import pytest

from particle import ConstantFriction, CoulombAdhesion
from particle.friction import friction_limit


@pytest.mark.parametrize("load", [-1.0, 0.0, 3.0])
def test_constant_friction_does_not_depend_on_the_load(load):
    assert friction_limit(ConstantFriction(2.5).law, load) == 2.5


def test_a_constant_contact_never_comes_off():
    assert ConstantFriction(1.0).pull_off == ConstantFriction(1.0).law.pull_off == math.inf


@pytest.mark.parametrize("load, limit", [(4.0, 1.5), (0.0, 0.3), (-1.0, 0.0), (-5.0, 0.0)])
def test_coulomb_friction_is_in_proportion_to_load_and_adhesion(load, limit):
    assert friction_limit(CoulombAdhesion(0.3, adhesion=1.0).law, load) == pytest.approx(limit, abs=1e-15)


def test_a_coulomb_contact_comes_off_at_its_adhesion():
    law = CoulombAdhesion(0.3, adhesion=2e-6)
    assert law.pull_off == law.law.pull_off == 2e-6
    assert CoulombAdhesion(0.3).pull_off == 0.0


def test_a_static_coefficient_is_kept_as_a_ratio():
    assert CoulombAdhesion(0.2, static_coefficient=0.5).law.static_ratio == pytest.approx(2.5)
    assert CoulombAdhesion(0.2).law.static_ratio == 1.0
    assert CoulombAdhesion(0.0).law.static_ratio == 1.0


@pytest.mark.parametrize(
    "make, says",
    [
        (lambda: ConstantFriction(-1.0), "Input limit of ConstantFriction"),
        (lambda: ConstantFriction(math.nan), "Input limit of ConstantFriction"),
        (lambda: CoulombAdhesion(-0.1), "Input coefficient of CoulombAdhesion"),
        (lambda: CoulombAdhesion(math.nan), "Input coefficient of CoulombAdhesion"),
        (lambda: CoulombAdhesion(0.1, adhesion=-1.0), "Input adhesion of CoulombAdhesion"),
        (lambda: CoulombAdhesion(0.3, static_coefficient=0.2), "Input static_coefficient of CoulombAdhesion"),
        (lambda: CoulombAdhesion(0.0, static_coefficient=0.2), "Input static_coefficient of CoulombAdhesion"),
    ],
)
def test_a_wrong_number_is_refused_by_name(make, says):
    with pytest.raises(ValueError, match=f"^{says} must be .*; got "):
        make()
