"""In Python and notebooks: what objects say of themselves, and the pictures that they show."""

import re
import warnings
from base64 import b64decode
from io import BytesIO

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from sweeps import LATTICE, PLATE, PLATFORM

from common.drawing import Drawing, label_axis
from coupling import read_case
from fem_plate import Plate, PlateSection
from meshes import annulus, disc, rectangle

SECTION = PlateSection(169e9, 0.3, 5e-6, 2330.0)


@pytest.fixture(autouse=True)
def _no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def case_of(folder, text):
    (folder / "case.toml").write_text(text)
    return read_case(folder / "case.toml")


def pixels(html):
    """The picture in what a notebook is shown, of which there is one."""
    (data,) = re.findall(r'src="data:image/png;base64,([^"]+)"', html)
    return imread(BytesIO(b64decode(data)))[..., :3]


def check(thing, said):
    """What a notebook shows has the words and a picture that is not blank."""
    from IPython.core.formatters import DisplayFormatter

    assert re.fullmatch(said, repr(thing)), repr(thing)
    shown, _ = DisplayFormatter().format(thing)
    assert shown["text/plain"] == repr(thing)
    assert 0.005 < (pixels(shown["text/html"]).min(axis=-1) < 0.9).mean() < 0.95
    figure = thing.plot()
    assert isinstance(figure, Figure)
    assert pixels(DisplayFormatter().format(figure)[0]["text/html"]).shape[0] > 100  # without pyplot
    for axes in figure.axes:
        for label in (axes.get_xlabel(), axes.get_ylabel()):
            assert not label or label.endswith("]") or label.startswith("shape of actuator"), label


def test_a_case_shows_its_plate_and_the_start(tmp_path):
    case = case_of(tmp_path, PLATE.replace('"20 um"]', '"20 um"]\nvelocity = ["1 mm/s", "0 m/s"]'))
    check(
        case, r"Case 'case': 2 actuators under a plate, a part of 2e-09 kg at \(-0.00014, 2e-05\) m, constant.*0.005 s"
    )
    check(case_of(tmp_path, PLATFORM), "Case 'case': a platform, a part of .*")
    check(case_of(tmp_path, LATTICE), "Case 'case': .* actuators under a plate, .*")
    own = Figure().subplots()
    assert case.plot(own) is own.figure
    assert own.get_xlabel() == "x [µm]" and own.get_xlim()[1] == pytest.approx(3.3e-4, rel=0.1)  # data in SI units


@pytest.mark.parametrize("stiffness", [None, [np.inf, 1e3, 0.0]])
def test_plates_and_shapes_show_themselves(stiffness):
    plate = Plate(annulus(1e-4, 3e-4, 6e-5), SECTION, {"outer": "clamped"})
    check(plate, "Plate of 0.0006 m x 0.0006 m, 5e-06 m thick; .*outer clamped.*")
    shapes = plate.influence([(2e-4, 0), (0, 2e-4), (-2e-4, 0)], stiffness)
    kinds = "3 rigid" if stiffness is None else "1 rigid, 1 floating, 1 springy"
    check(shapes, f"InfluenceShapes of {kinds} actuators on a plate of 0.0006 m x 0.0006 m")
    bar = shapes.plot([1e-6, 2e-6, 0.0]).axes[1]
    assert bar.get_ylabel() == "deflection [µm]"
    with pytest.raises(ValueError, match="Input weights of plot must be one an actuator, 3; got shape"):
        shapes.plot([1.0])


def test_the_shape_that_is_drawn_is_the_shape():
    shapes = Plate(disc(3e-4, 8e-5), SECTION).influence([(-1e-4, 0.0), (1e-4, 0.0)])
    figure = shapes.plot([0.0, 1e-6])
    levels = next(one.levels for one in figure.axes[0].collections if hasattr(one, "levels"))
    assert levels.max() == pytest.approx(1e-6, rel=0.3) and abs(levels.min()) < 0.3e-6


@pytest.mark.slow
def test_shapes_from_patches_show_themselves():
    side = 1e-4 * (np.arange(11) - 5)
    points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    shapes = Plate(rectangle(1.2e-3, 1.2e-3, 2e-4), SECTION).influence(points, truncation=1e-3)
    check(shapes, "PatchedShapes of 121 rigid actuators on a plate of 0.0012 m x 0.0012 m")


@pytest.mark.compiled
@pytest.mark.parametrize("kind", [pytest.param("linear", marks=pytest.mark.slow), "platform"])
def test_results_and_trajectories_show_themselves(ran, kind):
    result = ran(kind)
    check(result, rf"Result of Case '{kind}': .* The part .* It is .* m from the start\.")
    check(
        result.trajectory,
        r"Trajectory of 0.0004 s: (moving|stuck), .* m from the start over a path of .* m; .* rows, .*",
    )
    axes = Figure().subplots()
    assert result.plot(axes) is axes.figure
    (line,) = (one for one in axes.get_lines() if one.get_label().startswith(("path", "the part, which stays")))
    assert np.abs(line.get_xydata()[0] - result.trajectory.position[0]).max() < 1e-12
    assert result.trajectory.plot(Figure().subplots()).axes[0].get_xlabel().startswith("x [")


@pytest.mark.parametrize(
    ("extent", "label"), [(3e-4, "x [µm]"), (1e-3, "x [mm]"), (2.5, "x [m]"), (1e4, "x [km]"), (3e-11, "x [pm]")]
)
def test_axes_of_si_numbers_are_labelled_with_a_prefix(extent, label):
    axes = Drawing().subplots()
    axes.plot([-extent, extent], [0, 1])
    label_axis(axes.xaxis, "x", "m")
    axes.figure.canvas.draw()
    assert axes.get_xlabel() == label
    ticks = [tick.get_text() for tick in axes.get_xticklabels()]
    assert "0" in ticks and any(tick.startswith("\N{MINUS SIGN}") for tick in ticks)
