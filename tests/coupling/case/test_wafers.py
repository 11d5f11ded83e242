"""Plates of a case that are cut from a crystal, or lie on an elastic foundation."""

import re

import numpy as np
import pytest

from coupling import Case, InputError
from coupling.report import device
from coupling.scene import build_plate, section_of
from fem_plate import AnisotropicSection

PLATE = {"shape": "disc", "radius": 300e-6, "thickness": 5e-6, "density": 2330.0, "cell_size": 60e-6}
ISOTROPIC = {"youngs_modulus": 169e9, "poisson_ratio": 0.3}


def case_of(**plate):
    return Case(
        plate=PLATE | plate,
        actuators=[{"position": (0.0, 0.0), "stroke": 1e-6, "frequency": 1e3}],
        part={"mass": 2e-9, "position": (1e-4, 0.0)},
        friction={"model": "coulomb", "coefficient": 0.1},
        run={"duration": 1e-3},
    )


def test_a_wafer_is_silicon_unless_its_constants_are_given():
    made = section_of(case_of(wafer="110", wafer_angle="90 deg").plate)
    assert made == AnisotropicSection.cubic((165.7e9, 63.9e9, 79.6e9), 5e-6, 2330.0, "110", np.pi / 2)
    germanium = section_of(case_of(wafer="100", c11="128.9 GPa", c12="48.3 GPa", c44="67.1 GPa").plate)
    assert germanium == AnisotropicSection.cubic((128.9e9, 48.3e9, 67.1e9), 5e-6, 2330.0)
    assert "cut from a (110) wafer" in device(case_of(wafer="110"))


def test_a_foundation_shifts_the_frequencies_of_the_plate():
    first, shifted = (
        build_plate(case_of(**ISOTROPIC, foundation=modulus).plate).frequencies(1)[0] for modulus in (0.0, "1e10 N/m^3")
    )
    assert shifted**2 - first**2 == pytest.approx(1e10 / (2330.0 * 5e-6) / (2 * np.pi) ** 2, rel=1e-8)


@pytest.mark.parametrize(
    ("plate", "messages"),
    [
        ({}, ["youngs_modulus .* is missing; .* or have a wafer", "poisson_ratio .* is missing; .* or have a wafer"]),
        ({"wafer": "100"} | ISOTROPIC, ["youngs_modulus .* must not be given with a wafer", "poisson_ratio"]),
        (ISOTROPIC | {"c11": 1e11}, ["c11 .* must not be given without a wafer"]),
        ({"wafer": "100", "theory": "von-karman"}, ["wafer .* must not be given with theory"]),
        ({"wafer": "100", "c11": 1e9}, ["c12 .* is missing; .* three constants", "c44 .* is missing"]),
        ({"wafer": "100", "c11": 1e9, "c12": 2e9, "c44": 1e9}, [r"c11 .* must be of a stable .* 1e\+09 and 2e\+09 Pa"]),
        (ISOTROPIC | {"theory": "von-karman", "foundation": 1e9}, [r"foundation .* must be 0 with theory"]),
        (ISOTROPIC | {"foundation": "1 GPa"}, ['foundation .* must be a stiffness per area such as "1e10 N/m']),
        (ISOTROPIC | {"foundation": "3 N/m"}, ['foundation .*; got "3 N/m", a stiffness']),
    ],
)
def test_what_does_not_go_together_is_named(plate, messages):
    with pytest.raises(InputError) as refused:
        case_of(**plate)
    for message in messages:
        assert any(re.search(message, line) for line in str(refused.value).splitlines())


def test_a_large_lattice_has_no_foundation():
    with pytest.raises(InputError, match="foundation .* must be 0 with more than 250 actuators"):
        Case(
            plate={"shape": "rectangle", "width": 2e-3, "height": 2e-3, "thickness": 5e-6}
            | ISOTROPIC
            | {"foundation": 1e9},
            lattice={"pitch": 1e-4, "rows": 17, "columns": 17, "stroke": 1e-6, "frequency": 1e3},
            part={"mass": 2e-9, "position": (1e-5, 0.0)},
            friction={"model": "coulomb", "coefficient": 0.1},
            run={"duration": 1e-3},
        )


def test_a_foundation_holds_a_free_plate():
    with pytest.raises(InputError, match="supports .* leave the plate free to move"):
        case_of(**ISOTROPIC, supports="free")
    with pytest.raises(InputError, match="supports .* leave the plate free to move"):
        case_of(**ISOTROPIC, supports="free", foundation=-1e9)
    assert not build_plate(case_of(**ISOTROPIC, supports="free", foundation=1e9).plate).model().rigid.size
