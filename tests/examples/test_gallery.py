"""Every script of the gallery draws its picture, and has a place on the gallery's page."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.image import imread

GALLERY = Path(__file__).parents[2] / "docs/gallery"
SCRIPTS = sorted(GALLERY.glob("*.py"))
INK = 0.03  # of the pixels at least


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_script_draws_a_picture_within_its_frame(script):
    spec = importlib.util.spec_from_file_location(f"gallery_{script.stem}", script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    figure = module.draw(quick=True)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    assert (pixels < 250).any(axis=-1).mean() > INK
    rim = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    assert (rim > 250).all(), "something is cut off at the rim of the picture"
    assert all(axes.has_data() for axes in figure.axes)


def test_page_shows_scripts_and_pictures():
    page = (GALLERY / "index.md").read_text()
    for script in SCRIPTS:
        assert f"({script.stem}.png)" in page and f"Source: [`{script.name}`]({script.name})" in page
        picture = script.with_suffix(".png")
        assert picture.stat().st_size < 100_000
        assert imread(picture).std() > 0.05
