"""Plates whose stiffness depends on direction, against closed forms and the moduli that are published for silicon."""

import numpy as np
import pytest

import meshes
from fem_plate import AnisotropicSection, Plate, PlateSection
from fem_plate.elements import anisotropic, forms

SILICON = (165.7e9, 63.9e9, 79.6e9)  # Pa (Hopcroft, Nix and Kenny, 2010)
WIDTH, HEIGHT = 1.0, 0.8  # m
SPOTS = np.array([[0.1, 0.05], [-0.2, 0.1], [0.3, -0.25]])
ACTUATORS = np.array([[0.3, 0.1], [-0.2, 0.4], [-0.1, -0.5]])


def wood(angle=0.0):
    """Spruce, along and across its grain."""
    return AnisotropicSection.orthotropic((12e9, 0.8e9), 0.35, 0.7e9, 5e-3, density=600.0, angle=angle)


def turned(xy, angle):
    return xy @ [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]


def navier(load, count):
    """The deflection at SPOTS of a simply supported rectangle, with the load's terms of sin sin."""
    law = wood().law * wood().rigidity
    m, n = np.arange(1, count + 1)[:, None], np.arange(1, count + 1)
    along, across = m / WIDTH, n / HEIGHT
    mixed = 2 * law[0, 2] + law[1, 1]
    stiffness = np.pi**4 * (law[0, 0] * along**4 + mixed * (along * across) ** 2 + law[2, 2] * across**4)
    x, y = (SPOTS + np.array([WIDTH, HEIGHT]) / 2).T
    return np.einsum(
        "mn,mp,np->p", load(m, n) / stiffness, np.sin(np.pi * along * x), np.sin(np.pi * across[:, None] * y)
    )


@pytest.fixture(scope="module")
def rectangle():
    return Plate(meshes.rectangle(WIDTH, HEIGHT, 0.1), wood(), "simply-supported", tolerance=1e-7)


def test_a_simply_supported_rectangle_bends_as_naviers_series_says(rectangle):
    under_pressure = rectangle.pressure(1.0)
    expected = navier(lambda m, n: 16 / (np.pi**2 * m * n) * (m % 2) * (n % 2), 400)
    np.testing.assert_allclose(under_pressure.evaluate(SPOTS)[0], expected, rtol=1e-7)
    place = np.array([0.11, 0.07])
    x, y = place + np.array([WIDTH, HEIGHT]) / 2
    expected = navier(
        lambda m, n: 4 / WIDTH / HEIGHT * np.sin(np.pi * m * x / WIDTH) * np.sin(np.pi * n * y / HEIGHT), 2000
    )
    np.testing.assert_allclose(rectangle.deflection([place], [1.0]).evaluate(SPOTS)[0], expected, rtol=1e-7)


def test_the_frequencies_of_a_simply_supported_rectangle(rectangle):
    law = wood().law * wood().rigidity
    m, n = np.meshgrid(np.arange(1, 8) / WIDTH, np.arange(1, 8) / HEIGHT)
    energy = law[0, 0] * m**4 + (2 * law[0, 2] + law[1, 1]) * (m * n) ** 2 + law[2, 2] * n**4
    expected = np.sort(np.pi / 2 * np.sqrt(energy / (600 * 5e-3)).ravel())[:6]
    modes = rectangle.modes(6)
    error = modes.frequencies / expected - 1
    assert np.abs(error).max() < 3e-6 and (np.abs(error) < 1.1 * modes.error_estimate + 1e-9).all()


def test_a_clamped_ellipse_under_a_pressure():
    a, b, law = 1.0, 0.6, wood().law * wood().rigidity
    plate = Plate(meshes.ellipse(a, b, 0.1), wood())
    x, y = SPOTS.T
    middle = 1 / 8 / (3 * law[0, 0] / a**4 + (2 * law[0, 2] + law[1, 1]) / (a * b) ** 2 + 3 * law[2, 2] / b**4)
    expected = middle * (1 - (x / a) ** 2 - (y / b) ** 2) ** 2
    np.testing.assert_allclose(plate.pressure(1.0).evaluate(SPOTS)[0], expected, rtol=1e-9)


@pytest.mark.parametrize(
    "support",
    [pytest.param("clamped", marks=pytest.mark.slow), pytest.param("simply-supported", marks=pytest.mark.slow), "free"],
)
def test_a_disc_with_its_material_turned_is_the_turned_disc(support):
    mesh, angle = meshes.disc(1.0, 0.2), 0.5
    straight = Plate(mesh, wood(), support, tolerance=1e-8)
    other = Plate(mesh, wood(angle), support, tolerance=1e-8)
    places = np.array([[0.6, 0.2], [0.05, -0.3]])
    shapes, turned_shapes = straight.influence(ACTUATORS), other.influence(turned(ACTUATORS, angle))
    np.testing.assert_allclose(shapes.values(places), turned_shapes.values(turned(places, angle)), atol=3e-8)
    np.testing.assert_allclose(shapes.values(ACTUATORS), np.eye(3), atol=1e-9)


@pytest.mark.slow
def test_balanced_forces_on_a_free_plate_leave_no_mean_deflection_or_slope():
    mesh, angle = meshes.disc(1.0, 0.2), 0.5
    points = np.array([[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]])
    results = []
    for section, places, spots in ((wood(), points, SPOTS), (wood(angle), turned(points, angle), turned(SPOTS, angle))):
        deflection = Plate(mesh, section, "free", tolerance=1e-8).deflection(places, [1, 1, -1, -1])
        results.append(deflection.evaluate(spots)[0])
        xy, weights = deflection.model.space.quadrature
        assert abs(weights @ deflection.functions.values(xy)[:, 0]) < 1e-6 * np.abs(results[-1]).max()
    np.testing.assert_allclose(*results, rtol=1e-6)


def test_an_isotropic_stiffness_gives_the_isotropic_plate():
    nu, modulus, thickness = 0.3, 169e9, 5e-6
    stiffness = modulus / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    section, isotropic = AnisotropicSection(stiffness, thickness), PlateSection(modulus, nu, thickness)
    assert section.rigidity == pytest.approx(isotropic.rigidity, rel=1e-14)
    assert section.poisson_ratio == pytest.approx(nu)
    mesh = meshes.disc(3e-4, 6e-5)
    ours, other = (Plate(mesh, one).influence(3e-4 * ACTUATORS) for one in (section, isotropic))
    np.testing.assert_allclose(ours.values(2e-4 * SPOTS), other.values(2e-4 * SPOTS), atol=1e-11)
    np.testing.assert_allclose(ours.stiffness, other.stiffness, rtol=1e-9)


@pytest.mark.slow
def test_patches_serve_anisotropic_plates():
    mesh = meshes.rectangle(2.0, 0.2, 0.05)
    x, y = np.meshgrid(np.linspace(-0.95, 0.95, 39), [-0.05, 0.0, 0.05])
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    plate = Plate(mesh, AnisotropicSection.cubic(SILICON, 1e-3, angle=0.3))
    whole, patched = plate.influence(points), plate.influence(points, truncation=1e-3)
    assert len(patched.tiles) > 1
    spots = np.random.default_rng(0).uniform([-0.98, -0.08], [0.98, 0.08], (50, 2))
    np.testing.assert_allclose(patched.values(spots), whole.values(spots), atol=3e-3)


@pytest.mark.parametrize(
    ("wafer", "moduli", "ratio"),
    [("100", (169.1e9, 169.1e9), 0.0622), ("110", (169.1e9, 130.1e9), 0.3617), ("111", (169.1e9, 169.1e9), 0.2618)],
)
def test_silicon_has_the_published_moduli(wafer, moduli, ratio):
    compliance = np.linalg.inv(AnisotropicSection.cubic(SILICON, 1e-6, wafer=wafer).stiffness)
    np.testing.assert_allclose(1 / compliance.diagonal()[:2], moduli, rtol=1e-3)
    assert -compliance[0, 1] / compliance[0, 0] == pytest.approx(ratio, abs=5e-4)


@pytest.mark.parametrize(
    ("wafer", "frequency", "stiffness", "shape"),
    [("100", -8.5, -16.4, (-0.6, 0.5)), ("110", -2.2, -4.6, (-2.4, 2.7)), ("111", -1.1, -2.2, (0.0, 0.0))],
)
def test_the_table_of_silicon_wafers(wafer, frequency, stiffness, shape):
    """As docs/plate.md has it: percent of what the isotropic plate of 169 GPa and 0.3 has."""
    mesh, angle = meshes.disc(300e-6, 50e-6), np.linspace(0, np.pi, 17)
    ring = 150e-6 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    sections = AnisotropicSection.cubic(SILICON, 5e-6, 2330, wafer), PlateSection(169e9, 0.3, 5e-6, 2330)
    plates = [Plate(mesh, section) for section in sections]
    (first, isotropic_first), shapes = (p.frequencies(1) for p in plates), [p.influence([[0.0, 0.0]]) for p in plates]
    ours, isotropic = (one.values(ring) for one in shapes)
    assert 100 * (first / isotropic_first - 1) == pytest.approx(frequency, abs=0.06)
    assert 100 * (shapes[0].stiffness / shapes[1].stiffness - 1) == pytest.approx(stiffness, abs=0.06)
    change = 100 * (ours / isotropic - 1)
    assert (change.min(), change.max()) == pytest.approx(shape, abs=0.06)


def test_a_quarter_turn_from_the_flat_is_the_crystals_axis():
    compliance = np.linalg.inv(AnisotropicSection.cubic(SILICON, 1e-6, angle=np.pi / 4).stiffness)
    assert 1 / compliance[0, 0] == pytest.approx(130.1e9, rel=1e-3)  # along <100>


LAWS = [wood().law, wood(0.4).law, AnisotropicSection.cubic(SILICON, 1e-6, angle=0.2).law]


@pytest.mark.parametrize("law", LAWS)
def test_the_infinite_plate_carries_a_unit_load_and_none_elsewhere(law):
    plate, xy, source, step = anisotropic.AnisotropicPlate(law), SPOTS, np.zeros(2), 1e-3
    derivatives = plate.point_derivatives(xy, source)

    def difference(order, axis):
        h = step * np.eye(2)[axis]
        ends = [plate.point_derivatives(xy + k * h, source)[order] for k in (-2, -1, 1, 2)]
        return (ends[0] - 8 * ends[1] + 8 * ends[2] - ends[3]) / 12 / step

    for order in range(3):
        found = np.concatenate([difference(order, 0), difference(order, 1)[-1:]])
        np.testing.assert_allclose(found, derivatives[order + 1], rtol=1e-6, atol=1e-6)
    fourth = [*difference(3, 0), difference(3, 1)[-1]]
    factors = [law[0, 0], 2 * law[0, 1], 2 * law[0, 2] + law[1, 1], 2 * law[1, 2], law[2, 2]]
    assert np.abs(sum(f * d for f, d in zip(factors, fourth, strict=True))).max() < 1e-5 * np.abs(fourth).max()
    angle = 2 * np.pi * np.arange(400) / 400
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)[None]
    shear = forms.rim_traces(plate.point_derivatives(circle, source), circle, law)[forms.SHEAR]
    assert shear.mean() * 2 * np.pi == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("section", [wood(0.4), PlateSection(169e9, 0.3, 5e-6)], ids=["wood", "isotropic"])
def test_the_means_of_the_infinite_plates_response_are_those_of_quadrature(section):
    model = Plate(meshes.disc(1.0, 0.4), section, "free").model()
    source = np.array([0.3, -0.2])
    angle = 2 * np.pi * np.arange(200) / 200
    ray = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    along = ray @ source
    end = -along + np.sqrt(along**2 + 1 - source @ source)  # of each ray, on the rim
    nodes, weights = np.polynomial.legendre.leggauss(40)
    distance = end[:, None] * (1 + nodes) / 2
    xy = (source + distance[..., None] * ray[:, None]).reshape(-1, 2)
    area = (np.pi / 100 * end[:, None] / 2 * weights * distance).reshape(-1)
    expected = (area * model.infinite.point_value(xy, source[None])[:, 0]) @ model.motions(xy)
    np.testing.assert_allclose(model._known_means(source[None])[:, 0], expected, atol=1e-7 * np.abs(expected).max())


def test_close_roots_and_far_ones_give_the_same(monkeypatch):
    law = AnisotropicSection.orthotropic((10e9, 9.5e9), 0.3, 3.76e9, 1e-3).law
    by_integral = anisotropic.AnisotropicPlate(law)
    assert len(anisotropic._terms(law.tobytes())) > 2
    expected = by_integral.point_derivatives(SPOTS, np.zeros(2))
    anisotropic._terms.cache_clear()
    monkeypatch.setattr(anisotropic, "CLOSE", 0.0)
    assert len(anisotropic._terms(law.tobytes())) == 2
    for one, other in zip(expected, by_integral.point_derivatives(SPOTS, np.zeros(2)), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12 * np.abs(other).max())
    anisotropic._terms.cache_clear()


def test_laplacians_are_bounded_at_a_source_and_exact_beyond_the_floor():
    plate = anisotropic.AnisotropicPlate(wood().law)
    source, floor = np.zeros((1, 2)), 0.05
    _, _, hessian = plate.point_load(SPOTS, source)
    expected = hessian[:, 0, 0, 0] + hessian[:, 0, 1, 1]
    np.testing.assert_allclose(plate.point_laplacian(SPOTS, source, floor)[:, 0], expected, rtol=1e-12)
    edge = floor * np.array([[0.6, 0.8]])
    inside, outside = (plate.point_laplacian(f * edge, source, floor)[0, 0] for f in (1 - 1e-9, 1 + 1e-9))
    assert inside == pytest.approx(outside, rel=1e-7)
    assert np.isfinite(plate.point_laplacian(source, source, floor)).all()
    value, gradient, hessian = plate.point_load(source, source)
    assert value == 0 and (gradient == 0).all() and (hessian[0, 0].diagonal() == -np.inf).all()


def test_mistakes_are_named_together():
    with pytest.raises(ValueError, match="thickness .* must be positive.*density .* must be positive.*symmetric"):
        AnisotropicSection(np.diag([1.0, 2.0, 3.0]) + np.eye(3, k=1), -1.0, 0.0)
    with pytest.raises(ValueError, match="must be positive definite"):
        AnisotropicSection(np.diag([1.0, -2.0, 3.0]), 1.0)
    with pytest.raises(ValueError, match=r"youngs_moduli\[1\].*positive.*; .*shear_modulus"):
        AnisotropicSection.orthotropic((1.0, 0.0), 0.3, -1.0, 1e-3)
    with pytest.raises(ValueError, match="poisson_ratio .* between -1 and 1"):
        AnisotropicSection.orthotropic((1.0, 1.0), 1.5, 1.0, 1e-3)
    with pytest.raises(ValueError, match="wafer .* one of '100', '110', '111'; got '123'"):
        AnisotropicSection.cubic(SILICON, 1e-6, wafer="123")
    with pytest.raises(ValueError, match="c44 > 0, c11 > "):
        AnisotropicSection.cubic((1e9, 2e9, 1e9), 1e-6)


def test_what_anisotropic_plates_cannot_do_is_refused():
    mesh = meshes.disc(1.0, 0.5)
    with pytest.raises(ValueError, match="must be a PlateSection for large_deflection"):
        Plate(mesh, wood()).large_deflection([[0.0, 0.0]])
    with pytest.warns(UserWarning, match="6 simply supported corners over 90 degrees"):
        Plate(meshes.regular_polygon(6, 1.0, 0.4), wood(), "simply-supported")
