"""Plates whose thickness varies, against collocation, reciprocity, and another way to the same plate."""

import numpy as np
import pytest
from radial_plates import tapered_disc

import meshes
from fem_plate import AnisotropicSection, Excitation, Plate, PlateSection, VaryingSection
from fem_plate.elements import PlateFunctions

NU = 0.3
UNIT = PlateSection(12 * (1 - NU**2), NU, 1.0, density=1.0)  # rigidity 1 N m
POINTS = np.array([[0.3, 0.1], [-0.2, 0.4]])
SPOTS = np.array([[0.5, 0.2], [0.05, -0.3], [-0.6, 0.1]])
RADII = np.array([0.05, 0.2, 0.5, 0.7])
ON_RADII = np.stack([RADII * np.cos(1.0), RADII * np.sin(1.0)], axis=1)


def domed(x, y):
    return 1 - 0.3 * (x**2 + y**2)


def sloped(x, y):
    return 1 + 0.4 * x - 0.2 * x * y


@pytest.mark.parametrize("support", ["clamped", "simply-supported"])
def test_a_domed_disc_bends_as_collocation_says(support):
    plate = Plate(meshes.disc(1.0, 0.2), VaryingSection(UNIT, domed), support, tolerance=1e-6)

    def growth(r):
        return 3 * (1 - 0.3 * r**2) ** 2 * (-0.6 * r**2)

    for pressure, force in ((1.0, 0.0), (0.0, 1.0)):
        expected = tapered_disc(lambda r: (1 - 0.3 * r**2) ** 3, growth, pressure, force, support, NU)(RADII)
        found = plate.deflection([[0.0, 0.0]], [force], pressure)
        error = np.abs(found.evaluate(ON_RADII)[0] - expected).max() / expected.max()
        assert error < 1e-7 and error < 3 * found.error_estimate


def test_the_collocation_is_that_of_a_uniform_disc():
    found = tapered_disc(np.ones_like, np.zeros_like, 0.0, 1.0, "clamped", NU)(RADII)
    expected = (1 - RADII**2 + 2 * RADII**2 * np.log(RADII)) / (16 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


WOOD = AnisotropicSection.orthotropic((12.0, 2.0), 0.3, 1.5, 1.0, angle=0.4)


@pytest.mark.parametrize(
    "support, section",
    [("clamped", UNIT), ("free", WOOD), pytest.param("simply-supported", WOOD, marks=pytest.mark.slow)],
)
def test_compliance_is_symmetric_and_converges(support, section):
    """The known parts at two forces have different laws; only their sums with the elements' are symmetric."""
    plate, values = Plate(meshes.disc(1.0, 0.4), VaryingSection(section, sloped), support), []
    for halvings in range(3):
        model = plate.model(POINTS, halvings)
        responses = model.under_forces(POINTS)
        functions = PlateFunctions(
            model.space, responses, POINTS, np.eye(2), np.zeros((3, 2)), np.zeros(2), model.infinite
        )
        green = functions.values(POINTS)
        values.append(functions.values(SPOTS) / green[0, 0])
    assert abs(green[0, 1] - green[1, 0]) < 3e-9 * abs(green[0, 0])
    first, second = (np.abs(one - other).max() for one, other in zip(values[:-1], values[1:], strict=True))
    assert second < 2e-6 and second < first / 10


@pytest.mark.parametrize(
    ("mesh", "supports"),
    [
        (meshes.disc(1.0, 0.3), "clamped"),
        (meshes.rectangle(2.0, 1.4, 0.3), {"left": "simply-supported", "right": "clamped"}),  # free edges end at held
    ],
    ids=["disc", "rectangle"],
)
def test_twice_the_thickness_is_a_stiffer_uniform_plate(mesh, supports):
    varying = Plate(mesh, VaryingSection(UNIT, lambda x, y: 2.0), supports)
    uniform = Plate(mesh, PlateSection(UNIT.youngs_modulus, NU, 2.0, density=1.0), supports)
    ours, other = (plate.influence(POINTS, stiffness=[np.inf, 30.0]) for plate in (varying, uniform))
    np.testing.assert_allclose(ours.values(SPOTS), other.values(SPOTS), atol=1e-11)
    np.testing.assert_allclose(ours.stiffness, other.stiffness, rtol=1e-9)
    np.testing.assert_allclose(varying.frequencies(3, POINTS), uniform.frequencies(3, POINTS), rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("support", ["clamped", "simply-supported"])
def test_a_force_off_the_centre_does_the_work_that_betti_says(support):
    """The volume under a unit force is the deflection at its place under a unit pressure, which has no known part."""
    wood = AnisotropicSection.orthotropic((12.0, 2.0), 0.3, 1.5, 1.0, angle=0.4)
    plate = Plate(meshes.disc(1.0, 0.15), VaryingSection(wood, sloped), support, tension=5.0, foundation=100.0)
    for place in POINTS:
        shape = plate.deflection([place], [1.0])
        points, weights = shape.model.space.quadrature
        volume = weights @ shape.functions.values(points)[:, 0]
        assert volume == pytest.approx(plate.pressure(1.0).evaluate([place])[0][0], rel=1e-5)


def test_what_vibrates_is_heavier_where_it_is_thicker():
    """The modes that actuators excite are among those of the held plate, and the shapes' shares make them whole."""
    shapes = Plate(meshes.disc(1.0, 0.25), VaryingSection(UNIT, sloped)).influence(POINTS)
    excitation = Excitation(shapes, 1.0, 1.0)
    for _ in range(5):
        excitation.grow()
    found = excitation.modes().frequencies[:2]
    expected = Plate(meshes.disc(1.0, 0.25), VaryingSection(UNIT, sloped)).frequencies(2, POINTS)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_modes_of_a_tapered_strip_are_orthogonal_in_its_mass():
    plate = Plate(meshes.rectangle(2.0, 0.8, 0.2), VaryingSection(UNIT, sloped), {"left": "clamped"})
    modes = plate.modes(3)
    points, weights = modes.model.space.quadrature
    values = modes.functions.values(points)
    gram = values.T @ (modes.model.masses(points, weights)[:, None] * values)
    scale = np.sqrt(np.diag(gram))
    np.testing.assert_allclose(gram / scale / scale[:, None], np.eye(3), atol=1e-6)
    assert modes.error_estimate.max() < 1e-5


def test_a_wedge_shaped_cantilever_has_kirchhoffs_frequency():
    """A beam whose depth falls linearly to (nearly) nothing: 5.315 sqrt(E I / (m L^4)) (Kirchhoff, 1879)."""
    length, width, tip = 1.0, 0.05, 2e-3
    beam = PlateSection(12.0, 0.0, 1.0, density=1.0)  # E I = 1 a unit of width at the root
    section = VaryingSection(beam, lambda x, y: np.maximum(0.5 * length - x, 0.0) / length * (1 - tip) + tip)
    plate = Plate(meshes.rectangle(length, width, 0.05), section, {"left": "clamped"})
    assert 2 * np.pi * plate.frequencies(1)[0] == pytest.approx(5.315, rel=5e-3)


def test_where_a_thickness_is_none_is_named():
    with pytest.raises(ValueError, match=r"thickness_at .* must be positive on the plate; got -.* m at \("):
        Plate(meshes.disc(1.0, 0.4), VaryingSection(UNIT, lambda x, y: x))
    with pytest.raises(ValueError, match="must return one real number for each point"):
        Plate(meshes.disc(1.0, 0.4), VaryingSection(UNIT, lambda x, y: np.ones(3)))
    with pytest.raises(ValueError, match="section of VaryingSection must be a PlateSection or AnisotropicSection"):
        VaryingSection(VaryingSection(UNIT, domed), domed)


def test_what_general_plates_cannot_do_is_refused():
    plate = Plate(meshes.disc(1.0, 0.4), VaryingSection(UNIT, domed))
    with pytest.raises(ValueError, match="must be at most 2000, without a truncation"):
        plate.influence(POINTS, truncation=1e-3)
    with pytest.raises(ValueError, match="must be a PlateSection for large_deflection; got a VaryingSection"):
        plate.large_deflection(POINTS)
