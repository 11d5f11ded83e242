"""Forms of scikit-fem in a plate's energy, against the plates that have the same energy in another way."""

import numpy as np
import pytest
from skfem import BilinearForm, LinearForm
from skfem.helpers import dd, ddot, div, dot, grad, trace

import meshes
from fem_plate import AnisotropicSection, Plate, PlateSection
from fem_plate.elements.energy import form_coefficients

UNIT = PlateSection(12 * (1 - 0.3**2), 0.3, 1.0, density=1.0)  # rigidity 1 N m
POINTS = np.array([[0.3, 0.1], [-0.2, 0.4]])
SPOTS = np.array([[0.5, 0.2], [0.05, -0.3], [-0.6, 0.1]])


def of_bending(rigidity, nu):
    @BilinearForm
    def bending(u, v, _):
        return rigidity * ((1 - nu) * ddot(dd(u), dd(v)) + nu * trace(dd(u)) * trace(dd(v)))

    return bending


@BilinearForm
def pull(u, v, _):
    return 50.0 * dot(grad(u), grad(v))


def test_bending_is_read_as_the_law_of_the_section():
    xy = SPOTS.copy()
    own = form_coefficients(of_bending(2.0, 0.25), xy, "form")
    assert not own[:, :3].any() and not own[:, :, :3].any()
    np.testing.assert_allclose(own[:, 3:, 3:], np.broadcast_to(2 * PlateSection(1.0, 0.25, 1.0).law, (3, 3, 3)))


@pytest.mark.parametrize("support", ["clamped", "simply-supported", "free"])
def test_a_form_of_bending_is_another_material(support):
    """Poisson's ratios and rigidities that add up to those of the expected plate."""
    mesh, points = meshes.rectangle(2.0, 1.4, 0.3), np.array([[0.3, 0.1], [-0.2, 0.4], [-0.5, -0.3]])
    made = Plate(mesh, UNIT, support, forms=[of_bending(1.0, 0.1)])
    expected = Plate(mesh, PlateSection(24 * (1 - 0.2**2), 0.2, 1.0, density=1.0), support)
    ours, other = made.influence(points), expected.influence(points)
    # Singular exponents at corners follow from the section's ratio: the cells differ a little.
    np.testing.assert_allclose(ours.values(SPOTS), other.values(SPOTS), atol=3e-6)
    np.testing.assert_allclose(made.frequencies(3), expected.frequencies(3), rtol=1e-6)


def test_a_form_of_a_membrane_is_the_tension():
    mesh, support = meshes.disc(1.0, 0.2), "simply-supported"
    expected = Plate(mesh, UNIT, support, tolerance=1e-8, tension=50.0).influence(POINTS)
    found = Plate(mesh, UNIT, support, tolerance=1e-6, forms=[pull]).influence(POINTS)
    error = np.abs(found.values(SPOTS) - expected.values(SPOTS)).max()
    assert error < 1e-6 and error < 3 * found.error_estimate


def test_a_wooden_rectangle_under_a_tension_bends_as_naviers_series_says():
    wood, tension, place = AnisotropicSection.orthotropic((12.0, 2.0), 0.3, 1.5, 1.0), 20.0, np.array([0.31, 0.17])
    plate = Plate(meshes.rectangle(2.0, 1.4, 0.15), wood, "simply-supported", tension=tension)
    law, sides = wood.law * wood.rigidity, np.array([2.0, 1.4])
    m, n = np.pi * np.arange(1, 1501)[:, None] / sides[0], np.pi * np.arange(1, 1501) / sides[1]
    stiffness = law[0, 0] * m**4 + (2 * law[0, 2] + law[1, 1]) * (m * n) ** 2 + law[2, 2] * n**4
    stiffness += tension * (m**2 + n**2)
    (x, y), at = (SPOTS + sides / 2).T, place + sides / 2
    load = 4 / sides.prod() * np.sin(m * at[0]) * np.sin(n * at[1])
    expected = np.einsum("mn,mp,np->p", load / stiffness, np.sin(m * x), np.sin(n[:, None] * y))
    found = plate.deflection([place], [1.0])
    error = np.abs(found.evaluate(SPOTS)[0] - expected).max() / np.abs(expected).max()
    assert error < 1e-5 and error < 3 * found.error_estimate


def test_a_tension_along_one_axis_bends_a_strip_as_a_beam():
    """A strip held at two ends: w'' = (p - ...) by the beam's closed form under a tension, at Poisson's ratio 0."""

    @BilinearForm
    def along(u, v, _):
        return 30.0 * grad(u)[0] * grad(v)[0]

    beam = PlateSection(12.0, 0.0, 1.0)
    mesh = meshes.rectangle(1.0, 0.2, 0.1)
    plate = Plate(mesh, beam, {"left": "clamped", "right": "clamped"}, forms=[along], tolerance=1e-8)
    b = np.sqrt(30.0)
    x = np.array([0.0, 0.1, -0.3])
    expected = ((0.25 - x**2) / 2 - (np.cosh(b / 2) - np.cosh(b * x)) / (2 * b * np.sinh(b / 2))) / b**2
    found = plate.pressure(1.0).evaluate(np.stack([x, 0 * x], axis=1))[0]
    np.testing.assert_allclose(found, expected, rtol=1e-7)


def test_a_form_may_depend_on_places():
    @BilinearForm
    def winkler(u, v, w):
        return 500 * (1 + w.x[0]) * u * v

    mesh = meshes.disc(1.0, 0.3)
    ours = Plate(mesh, UNIT, forms=[winkler]).influence(POINTS)
    other = Plate(mesh, UNIT, foundation=lambda x, y: 500 * (1 + x)).influence(POINTS)
    np.testing.assert_allclose(ours.values(SPOTS), other.values(SPOTS), atol=1e-12)


def test_invalid_forms_are_named():
    mesh = meshes.disc(1.0, 0.5)

    def refused(form, text):
        with pytest.raises(ValueError, match=text):
            Plate(mesh, UNIT, forms=[pull, form])

    refused(BilinearForm(lambda u, v, w: u * grad(v)[0]), r"forms\[1\] of Plate must be symmetric in u and v")
    refused(BilinearForm(lambda u, v, w: w.n[0] * u * v), r"forms\[1\] .* and w.x alone: .*'n'")
    refused(BilinearForm(lambda u, v, w: u * v + 1), r"forms\[1\] of Plate must be linear in u and in v")
    refused(BilinearForm(lambda u, v, w: u * u * v * v), r"forms\[1\] of Plate must be linear in u and in v")
    refused(BilinearForm(lambda u, v, w: 1j * u * v), r"forms\[1\] of Plate must be real")
    refused(BilinearForm(lambda u, v, w: u * v / (w.x[0] - w.x[0])), r"forms\[1\] of Plate must be finite")
    refused(of_bending(-1.01, 0.3), "must leave it a positive bending stiffness; it has none at")
    refused("bending", r"forms\[1\] of Plate must be a skfem.BilinearForm; got 'bending'")
    refused(LinearForm(lambda v, w: v), r"forms\[1\] of Plate must be a form of u, v")
    refused(BilinearForm(lambda u, v, w: div(u) * v), r"forms\[1\]")


@pytest.mark.parametrize("distance", [1e-2, 1e-4])
def test_the_estimate_counts_rounding_of_close_actuators(distance):
    points = np.array([[0.2, 0.1], [0.2 + distance, 0.1]])
    expected = Plate(meshes.disc(1.0, 0.3), UNIT, tolerance=1e-7).influence(points)
    found = Plate(meshes.disc(1.0, 0.3), UNIT, foundation=1e-6, tolerance=1e-7).influence(points)
    error = np.abs(found.values(SPOTS) - expected.values(SPOTS)).max() / np.abs(expected.values(SPOTS)).max()
    assert error < 3 * found.error_estimate
