"""Kogut and Etsion's contact: reference values, the stable branch, the table that runs use, and what is refused.

Reference forces were computed with two independent quadratures; `tests/validation/test_kogut_etsion_integrals.py`
integrates the equations anew.
"""

import math
import re

import numpy as np
import pytest

from particle import KogutEtsion
from particle.friction.contact import TABLE
from particle.friction.quadrature import lowest

PAPER_MASS = 2e-9  # kg


@pytest.fixture(scope="module", params=["table 1", "unrounded", "paper"])
def contact(request):
    return {
        "table 1": KogutEtsion(),
        "unrounded": KogutEtsion(coefficients="unrounded"),
        "paper": KogutEtsion.paper(),
    }[request.param]


@pytest.fixture(scope="module")
def paper():
    return KogutEtsion.paper()


def test_forces_at_three_sigma_are_the_reference_values():
    reference = [4.4796030043e-4, 2.9682929982e-4, 6.4579278855e-5]
    assert KogutEtsion().forces(3.0) == pytest.approx(reference, rel=1e-10)


def test_forces_keep_the_shape_of_the_separations():
    d = np.array([[1.0, 2.0, 3.0], [2.5, 3.5, 4.0]])
    together = KogutEtsion().forces(d)
    for k, force in enumerate(together):
        assert force.shape == d.shape
        assert force[1, 1] == pytest.approx(KogutEtsion().forces(3.5)[k], rel=1e-13)


def test_the_papers_preset_brakes_its_part_at_20_9_m_s2_and_holds_to_1491(paper):
    assert paper.friction_limit(0.0) / PAPER_MASS == pytest.approx(20.90, abs=0.005)
    assert paper.pull_off / PAPER_MASS == pytest.approx(1491, abs=0.5)
    assert paper == KogutEtsion(plasticity_index=4.9128)


def test_unrounded_coefficients_raise_the_friction_limit_by_39_percent():
    ratio = KogutEtsion(coefficients="unrounded").friction_limit(0.0) / KogutEtsion().friction_limit(0.0)
    assert ratio == pytest.approx(1.39, abs=0.005)


def test_unrounded_coefficients_leave_load_and_adhesion_alone():
    for k in range(2):
        assert KogutEtsion(coefficients="unrounded").forces(2.0)[k] == KogutEtsion().forces(2.0)[k]


def test_the_stable_branch_ends_at_pull_off_and_at_the_peak_of_friction(contact):
    top, off = contact.branch
    d = np.linspace(top, off, 400)
    net, limit = contact.net_load(d), contact.forces(d)[2]
    assert (np.diff(net) < 0).all() and (np.diff(limit) < 0).all()
    assert net[-1] == pytest.approx(-contact.pull_off, rel=1e-10)
    for step in (1e-3, -1e-3):
        assert contact.net_load(off + step) > -contact.pull_off
        # Unrounded, friction grows up to d = 0, where the search ends.
        if contact.coefficients == "printed":
            assert contact.forces(top + step)[2] < contact.forces(top)[2]
        else:
            assert top == pytest.approx(0.0, abs=1e-8)


def loads(contact, count):
    """Net loads over the whole stable branch, both ends among them, dense around pull-off and zero.

    At pull-off a rounding error of the load, e, moves the separation by its root: none but the end is closer than 1e-3.
    """
    low, high = -contact.pull_off, contact.largest_load
    near = low * (1 - np.geomspace(1e-3, 1, count))
    return np.concatenate([[low, 0.0, high], near, high * np.geomspace(1e-6, 1, count)])


def test_separation_is_the_inverse_of_the_net_load(contact):
    net = loads(contact, 2)
    back = contact.net_load(contact.separation(net))
    assert np.abs(back - net).max() < 1e-10 * contact.pull_off + 1e-12 * contact.largest_load


def test_the_table_of_friction_limits_is_exact_to_1e_9(contact):
    net = loads(contact, 4)
    exact = contact.forces(contact.separation(net))[2]
    assert np.abs(contact.friction_limit(net) / exact - 1).max() < 1e-9


def test_the_table_is_as_exact_as_it_says(contact):
    top, off = contact.branch
    d = np.linspace(top, off, 3001)
    load, adhesion, limit = contact.forces(d)
    net = np.clip(load - adhesion, -contact.pull_off, contact.largest_load)
    error = np.abs(contact.friction_limit(net) / limit - 1)[1 + net / contact.pull_off > 1e-9]
    assert contact.table_error / 100 < error.max() < contact.table_error < 2e-9
    assert contact.friction_limit(-contact.pull_off) == pytest.approx(contact.forces(off)[2], rel=1e-12)


def test_the_table_is_twice_continuously_differentiable(contact):
    law = contact.law
    assert law.kind == TABLE
    c, step = law.pieces, law.step
    for order in range(3):
        ends = [np.polyval(np.polyder(c[:, k], order), step) for k in range(c.shape[1] - 1)]
        begins = [np.polyval(np.polyder(c[:, k], order), 0.0) for k in range(1, c.shape[1])]
        scale = np.abs(begins).max()
        assert np.abs(np.subtract(ends, begins)).max() < 1e-9 * scale


def test_the_friction_limit_never_falls(contact):
    net = contact.pull_off * (np.geomspace(1e-12, 1 + contact.largest_load / contact.pull_off, 100_000) - 1)
    limit = contact.friction_limit(np.minimum(net, contact.largest_load))
    assert (np.diff(limit) > -1e-14 * limit[1:]).all()


def test_a_law_beyond_its_ends_goes_on_without_a_jump(contact):
    """An integrator tries steps beyond the ends before it locates them."""
    from particle.friction.contact import friction_limit

    low, high = contact.friction_limit([-contact.pull_off, contact.largest_load])
    assert friction_limit(contact.law, -2 * contact.pull_off) == low
    assert friction_limit(contact.law, contact.largest_load * (1 + 1e-9)) == pytest.approx(high, rel=1e-6)


def test_no_blow_rubs_by_a_coefficient(contact):
    assert contact.law.impact_coefficient == 0.0


def test_a_minimum_is_found_to_rounding():
    assert lowest(lambda x: np.cosh(x - 0.7), 0.5, 1.0) == pytest.approx(0.7, abs=1e-12)
    assert lowest(lambda x: np.exp(x), 0.5, 1.0) == 0.5
    assert lowest(lambda x: -np.exp(x), 0.5, 1.0) == 1.0


def test_separation_and_friction_limit_keep_the_shape_of_the_loads(paper):
    assert paper.separation(np.zeros((2, 1))).shape == paper.friction_limit(np.zeros((2, 1))).shape == (2, 1)
    assert paper.separation(0.0).shape == paper.friction_limit(0.0).shape == ()


@pytest.mark.parametrize("ask", ["separation", "friction_limit"])
def test_a_load_above_the_peak_of_friction_is_refused_with_both_numbers(paper, ask):
    load = 1.01 * paper.largest_load
    message = f"at most {paper.largest_load:.6g} N, where the friction law ends; got {load:.6g} N"
    with pytest.raises(ValueError, match=re.escape(message)):
        getattr(paper, ask)([0.0, load])


def test_forces_scale_with_the_contact_area():
    for one, ten in zip(KogutEtsion().forces(2.2), KogutEtsion(contact_area=1e-7).forces(2.2), strict=True):
        assert ten == pytest.approx(10 * one, rel=1e-14)


def test_adhesion_is_in_proportion_to_its_energy_and_leaves_load_and_friction_alone():
    one, two = KogutEtsion().forces(2.2), KogutEtsion(adhesion_energy=2.0).forces(2.2)
    assert np.array(two) == pytest.approx(np.array(one) * [1, 2, 1], rel=1e-14)


POSITIVE = [
    "roughness", "contact_area", "hardness", "adhesion_energy", "plasticity_index", "asperity_beta",
    "intermolecular_distance",
]  # fmt: skip


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
@pytest.mark.parametrize("name", POSITIVE)
def test_a_parameter_that_is_not_positive_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=f"^Input {name} of KogutEtsion must be positive; got {value!r}"):
        KogutEtsion(**{name: value})


@pytest.mark.parametrize(
    "wrong, says",
    [
        ({"poisson_ratio": 0.5}, "Input poisson_ratio of KogutEtsion must be in [0, 0.5); got 0.5"),
        ({"poisson_ratio": -0.1}, "Input poisson_ratio of KogutEtsion must be in [0, 0.5); got -0.1"),
        ({"poisson_ratio": math.nan}, "Input poisson_ratio of KogutEtsion must be in [0, 0.5); got nan"),
        ({"asperity_beta": 0.0192}, "Input asperity_beta of KogutEtsion must exceed 0.01928; got 0.0192"),
        ({"coefficients": "exact"}, "Input coefficients of KogutEtsion must be one of ['printed', 'unrounded']"),
    ],
)
def test_other_wrong_parameters_are_refused_by_name(wrong, says):
    with pytest.raises(ValueError, match="^" + re.escape(says)):
        KogutEtsion(**wrong)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError) as caught:
        KogutEtsion(roughness=-1.0, hardness=0.0, poisson_ratio=2.0, coefficients="x")
    for name in ("roughness", "hardness", "poisson_ratio", "coefficients"):
        assert f"Input {name} of KogutEtsion" in str(caught.value)


@pytest.mark.parametrize("wrong", [{"adhesion_energy": 1e3}, {"plasticity_index": 50.0}, {"hardness": 1e3}], ids=str)
def test_parameters_that_leave_no_stable_branch_are_refused_where_they_are_used(wrong):
    contact = KogutEtsion(**wrong)
    with pytest.raises(ValueError, match="^Inputs of KogutEtsion must give a .*pull-off force"):
        _ = contact.pull_off
