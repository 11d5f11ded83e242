"""Draws docs/paraview.png: what ParaView's 3D view shows after the steps of the page, drawn by pyvista."""

import os
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # without a display

import numpy as np  # noqa: E402
import pyvista  # noqa: E402
from PIL import Image  # noqa: E402

from coupling import read_case, run_case  # noqa: E402

ROOT = Path(__file__).parent.parent
SIZE, BACKGROUND, PART = (560, 380), "#52576e", "#ffe14d"  # the colours that ParaView starts with
RADIUS = 12e-6  # m, of the ball that stands for the part
LATE = 52  # the step that is shown, of an eighth of a millisecond each
RANGE = (0.0, 180e-6)  # m, of deflection over all steps


def draw_paraview() -> None:
    with TemporaryDirectory() as folder:
        files = run_case(read_case(ROOT / "examples/two_actuators.toml"), output=folder).files
        plates, parts = (list(_steps(file)) for file in files[:2])
    trail = pyvista.lines_from_points(np.array([part.points[0] for part in parts]))
    _shoot(_warped(plates[LATE]), parts[LATE], trail)


def _steps(file: Path) -> Iterator[pyvista.DataSet]:
    reader = pyvista.get_reader(str(file)).reader
    reader.UpdateInformation()
    for step in range(LATE + 1):
        reader.SetStep(step)
        reader.Update()
        yield pyvista.wrap(reader.GetOutputDataObject(0)).copy()


def _warped(plate: pyvista.DataSet) -> pyvista.DataSet:
    return plate.warp_by_scalar("deflection", factor=1.0, normal=(0, 0, 1))


def _shoot(plate: pyvista.DataSet, part: pyvista.DataSet, trail: pyvista.PolyData) -> None:
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background(BACKGROUND)
    bar = {
        "title": "deflection",
        "vertical": True,
        "color": "white",
        "fmt": "%.1e",
        "position_x": 0.83,
        "position_y": 0.35,
        "height": 0.55,
    }
    plotter.add_mesh(plate, scalars="deflection", cmap="coolwarm", clim=RANGE, scalar_bar_args=bar)
    plotter.add_mesh(pyvista.Sphere(radius=RADIUS, center=part.points[0]), color=PART)
    plotter.add_mesh(trail, color="white", line_width=3)
    plotter.add_axes(color="white", line_width=3)
    plotter.camera_position = [(-7e-4, -9e-4, 7.5e-4), (2e-5, 0.0, 2e-5), (0, 0, 1)]
    plotter.camera.zoom(1.12)
    picture = Image.fromarray(plotter.screenshot(return_img=True))
    picture.save(ROOT / "docs/paraview.png", optimize=True)
    plotter.close()


if __name__ == "__main__":
    draw_paraview()
