"""Friction laws: constant, Coulomb with adhesion, and what they refuse."""

import math
import re

import numpy as np
import pytest

from particle import ConstantFriction, CoulombAdhesion, FrictionTable, KogutEtsion
from particle.friction import ScaledFriction, friction_limit


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


CONTACTS = [
    ConstantFriction(2e-8),
    CoulombAdhesion(0.3, adhesion=1e-6),
    KogutEtsion.paper(),
    FrictionTable([-1e-6, 0.0, 1e-5], [0.0, 1e-8, 5e-8]),
]


@pytest.mark.parametrize("contact", CONTACTS, ids=lambda contact: type(contact).__name__)
def test_all_laws_answer_the_same_questions(contact):
    loads = np.array([[-9e-7, 0.0, 2e-7], [1e-6, 3e-6, 9e-6]])
    limits = contact.friction_limit(loads)
    assert limits.shape == loads.shape
    assert contact.friction_limit(1e-6).shape == ()
    assert limits.ravel().tolist() == [friction_limit(contact.law, load) for load in loads.ravel().tolist()]
    assert (np.diff(limits.ravel()) >= 0).all() and (limits >= 0).all()
    assert (contact.pull_off, contact.largest_load) == (contact.law.pull_off, contact.law.largest_load)
    assert 0 <= contact.table_error < 1
    with pytest.raises(ValueError, match="^Input net_load must be .*; got nan N$"):
        contact.friction_limit([0.0, math.nan])


@pytest.mark.parametrize("contact", CONTACTS[1:], ids=lambda contact: type(contact).__name__)
def test_a_load_below_pull_off_is_refused_with_both_numbers(contact):
    load = -1.5 * contact.pull_off
    message = f"Input net_load must be at least minus the pull-off force, {-contact.pull_off:.6g} N; got {load:.6g} N"
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        contact.friction_limit([0.0, load])


@pytest.mark.parametrize("contact", CONTACTS, ids=lambda contact: type(contact).__name__)
def test_the_impact_coefficient_is_the_limit_of_friction_over_load(contact):
    expected = 0.3 if isinstance(contact, CoulombAdhesion) else 0.0
    assert contact.law.impact_coefficient == expected
    if contact.largest_load == math.inf:
        assert contact.friction_limit(1e9) / 1e9 == pytest.approx(expected, abs=1e-15)


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


@pytest.mark.parametrize("contact", CONTACTS, ids=lambda contact: type(contact).__name__)
@pytest.mark.parametrize("factor", [0.5, 1.01, 3.0])
def test_a_scaled_law_has_so_many_times_the_limit_and_the_same_pull_off(contact, factor):
    scaled = ScaledFriction(contact, factor)
    loads = np.linspace(-0.9 * min(contact.pull_off, 1e-6), min(contact.largest_load, 4e-6), 50)
    assert scaled.friction_limit(loads) == pytest.approx(factor * contact.friction_limit(loads), rel=1e-12, abs=0)
    assert scaled.law.impact_coefficient == pytest.approx(factor * contact.law.impact_coefficient, rel=1e-15)
    assert (scaled.pull_off, scaled.largest_load) == (contact.pull_off, contact.largest_load)
    assert scaled.law.pull_off == contact.law.pull_off and scaled.law.static_ratio == contact.law.static_ratio


@pytest.mark.parametrize("factor", [0.0, -1.0, math.inf, math.nan])
def test_a_law_is_scaled_by_positive_factors_only(factor):
    with pytest.raises(ValueError, match="^Input factor of ScaledFriction must be positive; got"):
        ScaledFriction(ConstantFriction(1.0), factor)
