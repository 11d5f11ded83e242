"""Supports: their names, what they prescribe, and the rigid motions that they leave."""

import numpy as np
import pytest

from fem_plate import Plate
from fem_plate.elements.rim import by_boundary, prescribed, rigid_motions, rim_quadrature
from meshes import annulus, disc, rectangle

BOUNDARIES = {"left": None, "right": None, "top": None}


def test_one_name_counts_for_every_boundary():
    assert by_boundary("free", BOUNDARIES) == {"left": "free", "right": "free", "top": "free"}


def test_boundaries_that_a_mapping_leaves_out_are_free():
    found = by_boundary({"right": "simply-supported"}, BOUNDARIES)
    assert found == {"left": "free", "right": "simply-supported", "top": "free"}
    assert set(by_boundary({}, BOUNDARIES).values()) == {"free"}


@pytest.mark.parametrize("supports", ["Clamped", "", "hinged"])
def test_an_unknown_kind_is_refused_with_the_known_ones(section, supports):
    with pytest.raises(ValueError) as caught:
        Plate(disc(1.0, 0.5), section, supports)
    expected = f"the support of 'rim' must be one of 'clamped', 'simply-supported', 'free'; got {supports!r}"
    assert str(caught.value) == f"Input supports of Plate: {expected}"


def test_an_unknown_boundary_is_refused_with_the_known_ones(section):
    with pytest.raises(ValueError) as caught:
        Plate(annulus(0.5, 1.0, 0.5), section, {"rim": "clamped"})
    assert str(caught.value) == "Input supports of Plate: boundary 'rim' is not one of the mesh's, 'inner', 'outer'"


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError) as caught:
        by_boundary({"rim": "clamped", "left": "glued", "top": "free", "edge": "loose"}, BOUNDARIES)
    text = str(caught.value)
    for part in ("boundary 'rim'", "boundary 'edge'", "of 'left' must be", "got 'glued'", "got 'loose'"):
        assert part in text
    assert "of 'top'" not in text and "'right' must" not in text


def test_what_each_support_prescribes():
    normal = np.array([[[0.6, 0.8], [0.0, -1.0]]])
    slope, value = prescribed("clamped", normal)
    assert (slope == np.eye(2)).all() and (value == 1).all() and value.shape == (1, 2)
    slope, value = prescribed("free", normal)
    assert not slope.any() and not value.any() and slope.shape == (1, 2, 2, 2)
    slope, value = prescribed("simply-supported", normal)
    assert slope[0, 0] == pytest.approx(np.array([[0.64, -0.48], [-0.48, 0.36]])) and (value == 1).all()
    assert slope[0, 1] == pytest.approx(np.array([[1.0, 0.0], [0.0, 0.0]]))


RIGID = [
    (disc(1.0, 0.5), {"rim": "clamped"}, 0),
    (disc(1.0, 0.5), {"rim": "simply-supported"}, 0),
    (disc(1.0, 0.5), {}, 3),
    (annulus(0.4, 1.0, 0.6), {"inner": "clamped"}, 0),
    (annulus(0.4, 1.0, 0.6), {}, 3),
    (rectangle(2.0, 1.0, 0.5), {"left": "clamped"}, 0),
    (rectangle(2.0, 1.0, 0.5), {"left": "simply-supported"}, 1),
    (rectangle(2.0, 1.0, 0.5), {"left": "simply-supported", "right": "simply-supported"}, 0),
    (rectangle(2.0, 1.0, 0.5), {"left": "simply-supported", "top": "simply-supported"}, 0),
]


@pytest.mark.parametrize("mesh, supports, count", RIGID)
def test_rigid_motions_that_the_supports_leave(mesh, supports, count):
    rim, _ = rim_quadrature(mesh, by_boundary(supports, mesh.boundaries))
    assert rigid_motions(rim).shape == (3, count)


def test_a_simply_supported_side_is_a_hinge():
    mesh = rectangle(2.0, 1.0, 0.5)
    rim, _ = rim_quadrature(mesh, by_boundary({"left": "simply-supported"}, mesh.boundaries))
    (motion,) = rigid_motions(rim).T
    assert motion / motion[1] == pytest.approx([1.0, 1.0, 0.0], abs=1e-14)  # 1 + x, in units of half the width
