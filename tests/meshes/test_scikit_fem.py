"""Meshes to scikit-fem and back: places, names, curved rims, and areas by its own quadrature."""

import numpy as np
import pytest
from skfem import Basis, ElementTriP1, Functional, MeshQuad, MeshTri1, MeshTri2

from fem_plate import Plate, PlateSection
from meshes import PlateMesh, annulus, disc, from_skfem, rectangle

SECTION = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)


@Functional
def one(w):
    return 1.0 + 0 * w.x[0]


def area(mesh):
    return one.assemble(Basis(mesh, ElementTriP1(), intorder=8))


def test_straight_meshes_go_there_and_back_unchanged():
    mesh = rectangle(2.0, 1.4, 0.3)
    there = mesh.to_skfem()
    assert type(there) is MeshTri1 and area(there) == pytest.approx(2.8, rel=1e-14)
    assert np.abs(there.p[0, there.facets[:, there.boundaries["left"]]] + 1.0).max() < 1e-15
    back = from_skfem(there)
    assert (back.points == mesh.points).all() and set(back.boundaries) == set(mesh.boundaries)
    assert {frozenset(cell) for cell in back.triangles.tolist()} == {frozenset(c) for c in mesh.triangles.tolist()}
    plates = [Plate(one, SECTION, {"left": "clamped"}).frequencies(3) for one in (mesh, back)]
    assert plates[0] == pytest.approx(plates[1], rel=1e-9)


def test_curved_rims_keep_their_middles():
    mesh = annulus(0.4, 1.0, 0.2)
    there = mesh.to_skfem()
    assert type(there) is MeshTri2
    gap = area(there) / (np.pi * (1 - 0.4**2)) - 1
    assert 1e-9 < abs(gap) < 1e-4  # parabolas are not circles, chords would miss a hundredth
    back = from_skfem(there)
    assert set(back.boundaries) == {"inner", "outer"}
    middles = np.concatenate(list(back.middles.values()))
    radius = np.hypot(*middles.T)
    assert np.minimum(abs(radius - 1), abs(radius - 0.4)).max() < 1e-12
    found, truth = (Plate(one, SECTION, "clamped").frequencies(2) for one in (back, mesh))
    assert found == pytest.approx(truth, rel=1e-3) and (found != truth).all()


def test_a_mesh_that_names_nothing_has_a_rim_and_another_unit():
    back = from_skfem(MeshTri1.init_circle(3), unit=1e-3)
    assert list(back.boundaries) == ["rim"] and back.size == pytest.approx(1e-3, rel=1e-12)


def test_what_is_no_plate_is_named():
    with pytest.raises(
        ValueError, match=r"mesh of from_skfem must be a plane mesh[^\n]*\n  the type MeshQuad1, not MeshTri1"
    ):
        from_skfem(MeshQuad())
    part = MeshTri1.init_sqsymmetric().with_boundaries({"left": lambda x: x[0] == 0})
    with pytest.raises(ValueError, match=r"an unnamed boundary: 6 edges, .*; name them with `with_boundaries`"):
        from_skfem(part)
    assert isinstance(from_skfem(disc(1.0, 0.5).to_skfem()), PlateMesh)
