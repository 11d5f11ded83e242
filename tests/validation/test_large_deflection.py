"""Von Karman plates: digits, orders, the error estimate and bounds, against second discretisations.

References: collocation in one dimension (axisymmetric_plates), Ritz's method with polynomials on a square
(stretching_square), and where a number has no source, another implementation of the same equations.
"""

import axisymmetric_plates as radial
import free_disc_backbone
import numpy as np
import pytest
from stretching_square import pressed_square

from fem_plate import Plate, PlateSection, backbone
from fem_plate.large_deflection.discrete import level_of
from meshes import annulus, disc, ellipse, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
E = UNIT.youngs_modulus
C, S = "clamped", "simply-supported"
CENTRE = [(0.0, 0.0)]
TWO = [(0.3, 0.1), (-0.25, -0.35)]
RADII = np.linspace(0.02, 0.98, 1500)


@pytest.fixture(scope="module")
def clamped():
    return Plate(disc(1.0, 0.15), UNIT)


def test_the_second_discretisation_has_the_known_digits():
    """Ratios of the reaction to the linear one, and centres under pressure over E t^4 / a^4."""
    gain = [radial.disc(height=h).force / (16 * np.pi * h) for h in (0.5, 1.0, 5.0, 10.0, 30.0)]
    assert gain == pytest.approx([1.109784, 1.424334, 8.85669, 28.3243, 217.26], rel=2e-5)
    gain = [radial.disc(height=h, movable=True).force / (16 * np.pi * h) for h in (0.5, 1.0)]
    assert gain == pytest.approx([1.0498406, 1.1943955], rel=1e-7)
    for movable, known in (
        (False, [0.168034, 0.322835, 0.679603, 1.051955]),
        (True, [0.169723, 0.334372, 0.770150, 1.308985]),
    ):
        centre = [radial.disc(pressure=E * q, movable=movable).w[0] for q in (1, 2, 5, 10)]
        assert centre == pytest.approx(known, rel=4e-6)


@pytest.mark.parametrize(
    "height, bound", [(1.0, 1e-7), (5.0, 1e-5), (10.0, 1e-4), pytest.param(30.0, 1e-4, marks=pytest.mark.slow)]
)
def test_reactions_of_the_immovable_disc(clamped, height, bound):
    state = clamped.large_deflection(CENTRE).solve([height])
    assert state.reactions == pytest.approx([radial.disc(height=height).force], rel=bound)


def test_reactions_of_the_movable_disc(clamped):
    height = 1.0
    state = clamped.large_deflection(CENTRE, "movable").solve([height])
    assert state.reactions == pytest.approx([radial.disc(height=height, movable=True).force], rel=1e-7)


@pytest.mark.parametrize("in_plane, load", [("immovable", 2.0), ("immovable", 10.0), ("movable", 5.0)])
def test_pressure(clamped, in_plane, load):
    expected = radial.disc(pressure=E * load, movable=in_plane == "movable").w[0]
    state = clamped.large_deflection([], in_plane).solve([], E * load)
    assert state.evaluate(CENTRE)[0] == pytest.approx([expected], rel=2e-6)


def test_two_actuators(clamped):
    state = clamped.large_deflection(TWO).solve([1.0, -0.6])
    assert state.reactions == pytest.approx([135.01462, -113.52870], rel=2e-7)


@pytest.mark.parametrize("height, expected", [(0.0, 22.736774), (1.0, 24.81147), (5.0, 50.522)])
def test_frequencies_with_the_centre_held(clamped, height, expected):
    state = clamped.large_deflection(CENTRE).solve([height])
    frequencies = 2 * np.pi * clamped.modes(4, CENTRE, deflected=state).frequencies
    # The only mode that keeps the disc's symmetry is the only one that is not repeated.
    alone = [f for f in frequencies[:3] if np.sort(np.abs(frequencies - f))[1] > 1e-3 * f]
    assert alone == pytest.approx([expected], rel=1e-4)


def errors(large, height, expected, halvings):
    """Of w, gradient and reaction, relative to the largest."""
    state = large.solved(np.array([height]), 0.0, 0, halvings)
    angle = 40 * RADII  # all around
    outwards = np.column_stack([np.cos(angle), np.sin(angle)])
    w, gradient, _ = state.evaluate(RADII[:, None] * outwards)
    slope = radial.at_radii(expected, expected.slope, RADII)
    return [
        np.abs(w - radial.at_radii(expected, expected.w, RADII)).max() / height,
        np.abs((gradient * outwards).sum(axis=1) - slope).max() / np.abs(expected.slope).max(),
        abs(state.reactions[0] / expected.force - 1),
    ]


@pytest.mark.parametrize("support", [C, S])
@pytest.mark.slow
def test_orders_of_the_disc(support):
    """w and gradient over two halvings: r^4 ln r around the actuator has no more. The reaction is near its rounding."""
    plate, height = Plate(disc(1.0, 0.5), UNIT, support), 2.0
    large, expected = plate.large_deflection(CENTRE), radial.disc(height=height, support=support)
    coarse, fine = (np.array(errors(large, height, expected, k)) for k in (1, 3))
    order = np.log2(coarse / fine) / 2
    print(support, coarse, fine, order)
    assert (order > ORDERS).all()
    assert fine[2] < 1e-8


@pytest.mark.parametrize(
    "clamped_sides, membrane", [(True, "airy"), pytest.param(False, "plane-stress", marks=pytest.mark.slow)]
)
def test_the_square_against_ritz(clamped_sides, membrane):
    """Both geometries are exact there: the energy's errors fall together with those of w."""
    pressure = 100.0 if clamped_sides else 50.0
    middle, bending, stretching = pressed_square(pressure, clamped_sides)
    assert pressed_square(pressure, clamped_sides, count=8)[0] == pytest.approx(middle, rel=1e-7)
    large = Plate(rectangle(2.0, 2.0, 0.5), UNIT, C if clamped_sides else S).large_deflection([], membrane=membrane)
    off = []
    for halvings in (0, 2):
        state = large.solved(np.zeros(0), pressure, 0, halvings)
        off.append(abs(state.evaluate(CENTRE)[0][0] / middle - 1))
    assert off[1] < 5e-7
    assert off[1] < off[0] / 50
    assert state.energy == pytest.approx(bending + stretching, rel=5e-7)
    assert state.stretching_energy == pytest.approx(stretching, rel=5e-7)


ORDERS = [3.3, 2.1, 1.5]  # of w, gradient and reaction
LAYOUTS = {
    "a disc at 5 t": (disc(1.0, 0.3), C, TWO, [5.2, -3.0], {}, 0.0),
    "near the rim": (disc(1.0, 0.3), C, [(0.85, 0.1), (-0.2, 0.3)], [1.0, -0.5], {}, 0.0),
    "springs": (disc(1.0, 0.3), C, TWO, [3.0, 2.0], {"stiffness": [20.0, 200.0]}, 0.0),
    "a movable square": (rectangle(1.0, 1.0, 0.2), S, [(0.1, 0.2)], [2.0], {"in_plane_supports": "movable"}, 0.0),
    "an annulus": (annulus(0.4, 1.0, 0.25), C, [(0.7, 0.0), (0.0, -0.6)], [2.0, 1.0], {}, 0.0),
    "an ellipse": (ellipse(1.0, 0.6, 0.25), C, [(0.3, 0.1)], [1.0], {"in_plane_supports": "movable"}, 100.0),
    "a cantilever": (rectangle(1.0, 0.5, 0.2), {"left": C}, [(0.2, 0.1)], [1.5], {}, 0.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_error_estimate_is_honest(layout):
    """Within a factor of five of the error, by cells halved twice more."""
    mesh, supports, points, heights, options, pressure = LAYOUTS[layout]
    large = Plate(mesh, UNIT, supports).large_deflection(points, **options)
    state = large.solve(heights, pressure)
    rigid = np.isinf(large.stiffness)
    level = level_of(max(state.largest, np.abs(np.array(heights)[rigid]).max(initial=0.0)))
    estimate = state.error_estimate
    error = large.solved(np.array(heights, dtype=float), pressure, level, 2).difference(state)
    print(f"{layout}: estimate {estimate:.1e}, error {error:.1e}")
    assert error / 5 < estimate < 5 * error


def test_backbone_of_the_free_disc():
    """Against Bessel functions; the two modes before it have nodal diameters."""
    squared, kappa = free_disc_backbone.backbone(0.3)
    plate = Plate(disc(1.0, 0.25), UNIT, "free")
    assert 2 * np.pi * plate.frequencies(3)[2] == pytest.approx(squared, rel=1e-6)
    found = backbone(plate, 3)[2]
    print(f"kappa {found:.6f}, {kappa:.6f}")
    assert found == pytest.approx(kappa, rel=1e-4)
