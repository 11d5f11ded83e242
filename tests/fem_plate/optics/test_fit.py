"""Fits to measured influence functions: what made them comes back, with uncertainties that hold."""

from dataclasses import replace

import numpy as np
import pytest
from astropy.io import fits

from fem_plate import Plate, fit_influence, read_influence, save_influence
from meshes import disc

RADIUS, PITCH = 300e-6, 100e-6
POINTS = PITCH * np.array([[x, y] for y in (-1, 0, 1) for x in (-1, 0, 1)])
STIFFNESS, TENSION = 250.0, 300.0


@pytest.fixture(scope="module")
def untold(section):
    """The plate, whose tension is not known."""
    return Plate(disc(RADIUS, RADIUS / 4), section)


@pytest.fixture(scope="module")
def shapes(section):
    return Plate(disc(RADIUS, RADIUS / 4), section, tension=TENSION).influence(POINTS, STIFFNESS)


def measured(shapes, folder, layout, across=41, noise=0.0):
    save_influence(folder / "x.fits", shapes, across, layout)
    read = read_influence(folder / "x.fits")
    errors = np.random.default_rng(7).standard_normal(read.values.shape)
    return replace(read, values=read.values + noise * np.nanmax(read.values) * errors)


@pytest.mark.parametrize("layout", ["proper", "compass", "specula"])
def test_stiffness_and_tension_come_back(shapes, untold, tmp_path, layout):
    fit = fit_influence(measured(shapes, tmp_path, layout), untold, POINTS)
    assert fit.stiffness == pytest.approx(STIFFNESS, rel=1e-5) and fit.tension == pytest.approx(TENSION, rel=1e-5)
    assert fit.residual < 1e-6 and not fit.rigid
    peak = shapes.own_heights()[4]
    assert fit.gain == (pytest.approx(1 / peak, rel=1e-5) if layout == "proper" else 1)


def test_uncertainties_hold_what_noise_does(shapes, untold, tmp_path):
    fit = fit_influence(measured(shapes, tmp_path, "specula", noise=0.01), untold, POINTS)
    assert fit.residual == pytest.approx(0.01, rel=0.05)
    assert abs(fit.stiffness - STIFFNESS) < 4 * fit.stiffness_error < 0.02 * STIFFNESS
    assert abs(fit.tension - TENSION) < 4 * fit.tension_error < 0.04 * TENSION


@pytest.mark.slow
def test_one_function_is_fitted_as_well_as_its_noise_allows(section, shapes, untold, tmp_path):
    """Cramer and Rao's bound by central differences about the truth, gain and all: errors are it, fits scatter so."""
    exact, values = measured(shapes, tmp_path, "proper"), {}
    level = 0.01 * np.nanmax(exact.values)
    xy = POINTS[exact.actuators[0]] + exact.offsets
    on = untold.mesh.outline.gap(xy) > 0
    for stiffness, tension in [(1, 1), (1 - 1e-3, 1), (1 + 1e-3, 1), (1, 1 - 1e-3), (1, 1 + 1e-3)]:
        plate = Plate(untold.mesh, section, tension=tension * TENSION)
        found = plate.influence(POINTS, stiffness * STIFFNESS).values(xy[on])[:, exact.actuators[0]]
        values[stiffness, tension] = found / found.max()
    slopes = [
        (values[1 + 1e-3, 1] - values[1 - 1e-3, 1]) / 2e-3,
        (values[1, 1 + 1e-3] - values[1, 1 - 1e-3]) / 2e-3,
        values[1, 1],
    ]
    bound = level * np.sqrt(np.diag(np.linalg.inv(np.array(slopes) @ np.array(slopes).T)))[:2]
    fits = []
    for seed in range(4):
        errors = np.random.default_rng(seed).standard_normal(exact.values.shape)
        noisy = replace(exact, values=exact.values + level * errors)
        fits.append(fit_influence(noisy, untold, POINTS, STIFFNESS))
        assert fits[-1].stiffness_error / STIFFNESS == pytest.approx(bound[0], rel=0.2)
        assert fits[-1].tension_error / TENSION == pytest.approx(bound[1], rel=0.2)
    off = np.array([(fit.stiffness / STIFFNESS - 1, fit.tension / TENSION - 1) for fit in fits])
    assert (np.sqrt(np.mean((off / bound) ** 2, axis=0)) < 2).all()


@pytest.mark.slow
def test_one_per_cent_of_noise_leaves_a_thousandth(shapes, untold, tmp_path):
    """With 125 000 pixels: what 1 % of noise tells of each is good to 3e-4 and 6e-4."""
    near = Plate(untold.mesh, untold.section, tension=0.9 * TENSION)
    fit = fit_influence(measured(shapes, tmp_path, "specula", 401, 0.01), near, POINTS, 0.9 * STIFFNESS)
    assert fit.stiffness == pytest.approx(STIFFNESS, rel=1e-3) and fit.stiffness_error < 4e-4 * STIFFNESS
    assert fit.tension == pytest.approx(TENSION, rel=1e-3) and fit.tension_error < 8e-4 * TENSION


def test_either_can_be_kept(shapes, untold, tmp_path):
    read = measured(shapes, tmp_path, "specula", 21)
    fit = fit_influence(read, untold, POINTS, STIFFNESS, ["tension"])
    assert fit.tension == pytest.approx(TENSION, rel=1e-5) and fit.stiffness == pytest.approx(STIFFNESS, rel=1e-14)
    assert fit.stiffness_error is None and fit.correlation is None
    pulled = Plate(untold.mesh, untold.section, tension=TENSION)
    fit = fit_influence(read, pulled, POINTS, fitted=["stiffness"])
    assert fit.stiffness == pytest.approx(STIFFNESS, rel=1e-5) and (fit.tension, fit.tension_error) == (TENSION, None)


def test_a_plain_image_in_any_unit_is_that_of_an_actuator(shapes, untold, tmp_path):
    offset = 6e-6 * np.arange(-60, 61)
    xy = np.stack(np.meshgrid(POINTS[3, 0] + offset, POINTS[3, 1] + offset), axis=-1)
    on = shapes.outline.gap(xy.reshape(-1, 2)).reshape(xy.shape[:2]) > 0
    image = np.zeros(on.shape)
    image[on] = 12.5 * shapes.evaluate(xy[on])[0][:, 3]
    fits.PrimaryHDU(image.astype(np.float32)).writeto(tmp_path / "image.fits")
    fit = fit_influence(read_influence(tmp_path / "image.fits", 6e-6), untold, POINTS, actuator=3)
    assert fit.gain == pytest.approx(12.5, rel=1e-4) and fit.functions == 1
    assert fit.stiffness == pytest.approx(STIFFNESS, rel=1e-4) and fit.tension == pytest.approx(TENSION, rel=1e-4)


def test_rigid_actuators_are_told(untold, tmp_path):
    fit = fit_influence(
        measured(untold.influence(POINTS), tmp_path, "specula", 21), untold, POINTS, fitted=["stiffness"]
    )
    assert fit.rigid


def test_one_actuator_with_a_unit_of_its_own_tells_no_stiffness(section, untold, tmp_path):
    shapes = untold.influence(POINTS[4:5], STIFFNESS)
    read = replace(measured(shapes, tmp_path, "specula", 21), scaled=False)
    with pytest.raises(
        ValueError, match='^Input fitted of fit_influence must be "tension" alone for functions in a unit'
    ):
        fit_influence(read, untold, POINTS[4:5])
    assert abs(fit_influence(read, untold, POINTS[4:5], fitted=["tension"]).tension) < 1e-2


@pytest.mark.parametrize(
    ("options", "wrong"),
    [
        ({"fitted": []}, "Input fitted .* must be some of stiffness, tension"),
        (
            {"fitted": ["mass"], "stiffness": -1.0},
            "Input fitted .*; Input stiffness .* must be positive and finite; got",
        ),
        ({"actuator": 2}, "Input actuator .* must not be given where functions have numbers"),
        ({"points": POINTS[:4]}, "must have functions of the plate's actuators; got one of number 8 with 4 actuators"),
    ],
)
def test_what_cannot_be_fitted_is_refused(shapes, untold, tmp_path, options, wrong):
    with pytest.raises(ValueError, match=wrong):
        fit_influence(measured(shapes, tmp_path, "specula", 11), untold, **({"points": POINTS} | options))


def test_pixels_beside_the_plate_are_refused(shapes, untold, tmp_path):
    read = measured(shapes, tmp_path, "specula", 11)
    with pytest.raises(
        ValueError, match="must have 10 values on the plate or more; got 9, as the functions are 0.6 m wide"
    ):
        fit_influence(replace(read, offsets=1.1e3 * read.offsets), untold, POINTS)
