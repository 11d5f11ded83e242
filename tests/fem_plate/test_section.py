"""The plate's section: its rigidity and what it refuses."""

import math

import pytest

from fem_plate import PlateSection


def test_rigidity_is_e_t3_over_12_1_minus_nu2():
    assert PlateSection(169e9, 0.3, 5e-6).rigidity == pytest.approx(169e9 * 125e-18 / 10.92, rel=1e-15)
    assert PlateSection(12.0, 0.0, 2.0).rigidity == 8.0


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
@pytest.mark.parametrize("name", ["youngs_modulus", "thickness", "density"])
def test_a_quantity_that_is_not_positive_is_refused_by_name(name, value):
    fields = {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "thickness": 1.0, "density": 1.0} | {name: value}
    with pytest.raises(ValueError, match=f"^Input {name} of PlateSection must be positive; got {value!r}$"):
        PlateSection(**fields)


@pytest.mark.parametrize("value", [-0.01, 0.5, math.nan])
def test_poissons_ratio_outside_0_to_a_half_is_refused(value):
    with pytest.raises(ValueError, match="^Input poisson_ratio of PlateSection must be in"):
        PlateSection(1.0, value, 1.0)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError) as caught:
        PlateSection(-1.0, 0.7, 0.0, -2.0)
    for name in ("youngs_modulus", "poisson_ratio", "thickness", "density"):
        assert f"Input {name} of PlateSection" in str(caught.value)


def test_density_may_be_left_out():
    assert PlateSection(1.0, 0.3, 1.0).density is None
