"""Influence functions as FITS files: what other programs read in them is what the plate does."""

import logging

import numpy as np
import pytest
from astropy.io import fits

from fem_plate import Plate, VaryingSection, read_influence, save_influence
from meshes import annulus, disc, rectangle

RADIUS, PITCH = 300e-6, 90e-6
POINTS = PITCH * np.array([[x, y] for y in (-1, 0, 1) for x in (-1, 0, 1)])
LAYOUTS = ["proper", "compass", "specula"]


@pytest.fixture(scope="module")
def shapes(section):
    """Off every axis, with unlike springs, so that x and y cannot be taken for each other."""
    plate = Plate(disc(RADIUS, RADIUS / 4), section, tension=300.0)
    springs = np.linspace(100.0, 900.0, len(POINTS))
    return plate.influence(POINTS + [7e-6, -19e-6], springs)


def saved(shapes, folder, layout, across=41, **options):
    path = folder / f"{layout}.fits"
    save_influence(path, shapes, across, layout, **options)
    return path


def pixel_centres(shapes, across):
    low, high = shapes.outline.box
    step = (high - low).max() / across
    return [middle + step * (np.arange(across) - (across - 1) / 2) for middle in (low + high) / 2]


def exact(shapes, x, y, actuator):
    """A function on a grid [y, x], 0 off the plate."""
    xy = np.stack(np.meshgrid(x, y), axis=-1)
    on = shapes.outline.gap(xy.reshape(-1, 2)).reshape(xy.shape[:2]) >= 0
    values = np.zeros(on.shape)
    values[on] = shapes.evaluate(xy[on])[0][:, actuator]
    return values


def test_the_keys_of_proper_give_pixels_and_pitch(shapes, tmp_path):
    """As `prop_dm` and FALCO read: image [y, x], its middle pixel the actuator, a whole number of pixels a pitch."""
    path = saved(shapes, tmp_path, "proper", actuator=5)
    header, image = fits.getheader(path), np.squeeze(fits.getdata(path))
    assert header["P2PDX_M"] == header["P2PDY_M"] == header["P2PD_M"] and header["C2CDX_M"] == header["C2CD_M"]
    per_pitch = header["C2CDX_M"] / header["P2PDX_M"]
    assert per_pitch == pytest.approx(round(per_pitch), abs=1e-9) and header["C2CDX_M"] == pytest.approx(PITCH)
    n = len(image)
    assert image.shape == (n, n) and n % 2 == 1 and header["CX_PIX"] == n // 2
    assert image[n // 2, n // 2] == image.max() == pytest.approx(1, abs=1e-7)
    at = header["P2PDX_M"] * (np.arange(n) - n // 2)
    x, y = shapes.points[5]
    assert np.abs(header["PEAK"] * image - exact(shapes, x + at, y + at, 5)).max() < 1e-7
    assert fits.getdata(path, "MASK").sum() == np.count_nonzero(image)


@pytest.mark.filterwarnings("ignore")
def test_hcipy_pokes_our_function(shapes, tmp_path, monkeypatch):
    """Its influence functions of a Xinetics mirror, made of our file in place of its own."""
    import hcipy  # here, as its warnings are not ours
    from hcipy.optics import deformable_mirror

    path = saved(shapes, tmp_path, "proper", actuator=5)
    monkeypatch.setattr(
        deformable_mirror, "files", lambda package: type("Folder", (), {"joinpath": lambda self, name: path})()
    )
    n = np.squeeze(fits.getdata(path)).shape[0]
    pupil = hcipy.make_uniform_grid([n, n], PITCH / 10 * np.array([n, n]))
    mode = hcipy.make_xinetics_influence_functions(pupil, 1, PITCH)[0]
    x, y = shapes.points[5]
    expected = exact(shapes, x + pupil.separated_coords[0], y + pupil.separated_coords[1], 5)
    assert np.abs(mode.shaped - expected / expected.max()).max() < 1e-7


def test_compass_reads_stamps_where_they_lie(shapes, tmp_path):
    """As `init_custom_dm` reads version 1.2: stamp [i, j, actuator], at pixels i + I1 along x and j + J1 along y."""
    with fits.open(saved(shapes, tmp_path, "compass")) as hdus:
        header = hdus[0].header
        (i1, j1), (xpos, ypos), influ = hdus["I1_J1"].data, hdus["XPOS_YPOS"].data, hdus["INFLU"].data
        mask = hdus["MASK"].data
    assert header["VERSION"] >= 1.2 and header["PUPM"] == pytest.approx(2 * RADIUS)
    assert header["PITCHM"] == pytest.approx(PITCH) and influ.shape[0] == influ.shape[1]
    x, y = (header["PIXSIZE"] * (np.arange(41) - header[key]) for key in ("XCENTER", "YCENTER"))
    size, count = influ.shape[1:]
    assert count == 9 and header["PIXSIZE"] * (xpos - header["XCENTER"]) == pytest.approx(shapes.points[:, 0])
    assert header["PIXSIZE"] * (ypos - header["YCENTER"]) == pytest.approx(shapes.points[:, 1])
    for k in range(count):
        stamp = exact(shapes, x[i1[k] : i1[k] + size], y[j1[k] : j1[k] + size], k)
        assert np.abs(influ[:, :, k].T - stamp).max() < 1e-7
        whole = exact(shapes, x, y, k)
        whole[j1[k] : j1[k] + size, i1[k] : i1[k] + size] = 0
        assert np.abs(whole).max() < 1e-6
    gap = shapes.outline.gap(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)).reshape(41, 41)
    assert (mask == (gap >= 0)).all()


def test_specula_reads_functions_at_the_pixels_of_a_mask(shapes, tmp_path):
    """As `IFunc.restore` and `ifunc_2d_to_3d` read: the second and third HDU, pixels in the order of `where(mask)`."""
    with fits.open(saved(shapes, tmp_path, "specula")) as hdus:
        assert [hdu.name for hdu in hdus][1:3] == ["INFLUENCE_FUNCTION", "MASK_INF_FUNC"]
        functions, mask = hdus[1].data.T, hdus[2].data
        assert hdus[0].header["VERSION"] == 1
    x, y = pixel_centres(shapes, 41)
    for k, values in enumerate(functions):
        image = np.zeros(mask.shape)
        image[np.where(mask)] = values
        assert np.abs(image - exact(shapes, x, y, k)).max() < 1e-7


@pytest.mark.filterwarnings("ignore")
def test_specula_restores_our_functions(shapes, tmp_path):
    specula = pytest.importorskip("specula")
    logging.disable(logging.CRITICAL)
    specula.init(-1, precision=0)
    logging.disable(logging.NOTSET)
    from specula.data_objects.ifunc import IFunc

    cube = IFunc.restore(saved(shapes, tmp_path, "specula")).ifunc_2d_to_3d(normalize=False)
    x, y = pixel_centres(shapes, 41)
    for k in range(9):
        assert np.abs(cube[:, :, k] - exact(shapes, x, y, k)).max() < 1e-7


@pytest.mark.parametrize("layout", LAYOUTS)
def test_our_own_reader_finds_the_pixels_again(shapes, tmp_path, layout):
    measured = read_influence(saved(shapes, tmp_path, layout, across=30))
    assert measured.layout == layout and measured.scaled == (layout != "proper")
    assert measured.actuators.tolist() == ([4] if layout == "proper" else list(range(9)))
    xy = measured.offsets + (shapes.points[4] if layout == "proper" else shapes.outline.box.mean(axis=0))
    on = shapes.outline.gap(xy) > 0
    peaks = shapes.own_heights()
    for row, k in enumerate(measured.actuators):
        known = on & np.isfinite(measured.values[row])
        expected = shapes.evaluate(xy[known])[0][:, k] / (peaks[k] if layout == "proper" else 1)
        assert known.sum() > 50 and np.abs(measured.values[row][known] - expected).max() < 1e-7


@pytest.mark.parametrize("layout", LAYOUTS)
def test_tension_springs_and_dead_actuators_are_stated(shapes, tmp_path, layout):
    dead = [1, 6]
    path = saved(shapes, tmp_path, layout, dead=dead)
    header, table = fits.getheader(path), fits.getdata(path, "ACTUATORS")
    assert header["TENSION"] == 300.0 and header.comments["TENSION"].startswith("[N/m]")
    assert (table["STIFFNESS"] == shapes.springs).all() and np.flatnonzero(table["DEAD"]).tolist() == dead
    assert table["PEAK"] == pytest.approx(shapes.own_heights())
    if layout != "proper":
        alive = np.setdiff1d(range(9), dead)
        assert read_influence(path).actuators.tolist() == alive.tolist()


def test_rectangles_and_holes_have_square_images_with_0_off_the_plate(section, tmp_path):
    for mesh in (rectangle(600e-6, 300e-6, 100e-6), annulus(60e-6, RADIUS, RADIUS / 5)):
        shapes = Plate(mesh, section).influence([[100e-6, 40e-6], [-120e-6, 60e-6]])
        x, y = pixel_centres(shapes, 31)
        mask = fits.getdata(saved(shapes, tmp_path, "specula", 31), "MASK_INF_FUNC")
        xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        assert mask.shape == (31, 31) and (mask.ravel() == (shapes.outline.gap(xy) >= 0)).all()
        assert np.isfinite(fits.getdata(saved(shapes, tmp_path, "compass", 31), "INFLU")).all()


def test_floating_actuators_are_in_metres_per_newton(section, tmp_path):
    plate = Plate(disc(RADIUS, RADIUS / 4), section)
    for stiffness, unit in ((0.0, "m/N"), (np.inf, "m/m")):
        path = saved(plate.influence(POINTS[:3], stiffness), tmp_path, "specula", 11)
        assert fits.getheader(path)["BUNIT"] == unit and read_influence(path).scaled == (unit == "m/m")


@pytest.mark.parametrize(
    ("name", "options", "wrong"),
    [
        ("x.fits", {}, "Input layout of save_influence must be proper, compass or specula for a FITS file; got None"),
        ("x.fits", {"layout": "yao"}, "Input layout of save_influence must be .* or specula; got 'yao'"),
        ("x.npz", {"layout": "compass"}, "Input path of save_influence must end in .fits with a layout; got"),
        (
            "x.fits",
            {"layout": "compass", "dead": [9]},
            "Input dead of save_influence must be actuators from 0 to 8; got",
        ),
        ("x.fits", {"layout": "compass", "dead": range(9)}, "Input dead .* must leave an actuator alive"),
        ("x.fits", {"layout": "compass", "actuator": 1}, "Input actuator .* must not be given with layout"),
        ("x.fits", {"layout": "proper", "actuator": 9, "across": 1}, "across .*; Input actuator .* from 0 to 8"),
    ],
)
def test_what_cannot_be_written_is_refused_and_leaves_no_file(shapes, tmp_path, name, options, wrong):
    with pytest.raises(ValueError, match=wrong):
        save_influence(tmp_path / name, shapes, **options)
    assert not list(tmp_path.iterdir())


def test_files_of_another_kind_are_refused(tmp_path):
    (tmp_path / "text.fits").write_text("no FITS")
    with pytest.raises(ValueError, match="^Input path of read_influence must be a FITS file; got .*text.fits"):
        read_influence(tmp_path / "text.fits")
    image = tmp_path / "image.fits"
    fits.PrimaryHDU(np.ones((5, 5))).writeto(image)
    with pytest.raises(ValueError, match="^Input pixel of read_influence must be given, as .* has no key P2PDX_M"):
        read_influence(image)
    assert read_influence(image, 2e-6).offsets.max() == pytest.approx(4e-6)
    with pytest.raises(ValueError, match="^Input pixel of read_influence must be greater than 0; got -1"):
        read_influence(image, -1.0)
    fits.PrimaryHDU(np.ones((4, 5))).writeto(tmp_path / "even.fits")
    with pytest.raises(ValueError, match=r"an odd number of pixels along each side.*; got \(4, 5\)"):
        read_influence(tmp_path / "even.fits", 1e-6)
    with pytest.raises(OSError, match="none.fits"):
        read_influence(tmp_path / "none.fits")


def test_a_file_that_ends_too_early_is_refused(shapes, tmp_path):
    path = saved(shapes, tmp_path, "specula")
    path.write_bytes(path.read_bytes()[:9000])
    with pytest.raises(ValueError, match="^Input path of read_influence must "):
        read_influence(path)


def test_headers_say_that_a_plate_is_not_uniform(section, tmp_path):
    varying = VaryingSection(section, lambda x, y: 5e-6 * (1 + 0.1 * x / RADIUS))
    plate = Plate(disc(RADIUS, RADIUS / 4), varying, foundation=1e10)
    header = fits.getheader(saved(plate.influence(POINTS), tmp_path, "specula"))
    assert header["FOUNDATN"] == 1e10 and "it varies" in header.comments["THICKNES"]
    assert "it varies" in header.comments["RIGIDITY"] and "FORMS" not in header
