"""Things are drawn by their type, wherever it is defined, and by modules that load when something is drawn."""

import subprocess
import sys

import pytest

from common import draw
from fem_plate import Plate, PlateSection
from meshes import disc

SECTION = PlateSection(thickness=50e-6, youngs_modulus=160e9, poisson_ratio=0.25)


def test_a_subclass_is_drawn_as_its_base_wherever_it_is_defined():
    class Mine(Plate):
        __module__ = "no.such.package"

    figure = Mine(disc(1e-3, 0.4e-3), SECTION).plot()
    assert len(figure.axes) == 1 and figure.axes[0].get_xlabel() == "x [mm]"


def test_things_are_drawn_into_axes_that_are_given():
    plate = Plate(disc(1e-3, 0.4e-3), SECTION)
    figure = plate.plot()
    assert draw(plate, figure.axes[0]) is figure


def test_a_type_without_a_picture_is_named():
    class Other:
        pass

    with pytest.raises(TypeError, match="a type that has a picture; got Other"):
        draw(Other())


def test_pictures_load_when_something_is_drawn():
    lines = (
        "import sys, fem_plate, meshes",
        "plate = fem_plate.Plate(meshes.disc(1e-3, 0.4e-3), fem_plate.PlateSection(160e9, 0.25, 50e-6))",
        "before = 'matplotlib' in sys.modules",
        "plate.plot()",
        "print(before, 'matplotlib' in sys.modules)",
    )
    done = subprocess.run([sys.executable, "-c", "; ".join(lines)], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]
