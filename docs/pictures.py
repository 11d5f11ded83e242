"""Draws the pictures of the documentation anew: `make docs`."""

from pathlib import Path
from runpy import run_path
from shutil import copy
from tempfile import TemporaryDirectory

import nbformat
import numpy as np
from animation_pictures import draw_animation
from contact_pictures import draw_contact, draw_faces
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from motion_pictures import draw_motion_error
from nbclient import NotebookClient
from page_pictures import draw_pages
from paraview_pictures import draw_paraview
from tolerance_pictures import draw_tolerance

from active_surface.cli import main
from active_surface.steering import aim, plan, read_route, read_task
from active_surface.studies import read_study, run_study
from active_surface.studies.drifts import drift
from active_surface.views import animate
from coupling import read_case, run_case
from coupling.display import display_mesh, onto_plate
from fem_plate import InfluenceShapes, Plate, PlateSection
from meshes import PlateMesh, annulus, read, rectangle

ROOT = Path(__file__).parent.parent
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330)
MICRO = 1e6
PRESSURE, PITCH, ACROSS = 1e3, 100e-6, 100  # Pa, m, actuators along a side
CORNER = [(230e-6, 240e-6), (200e-6, 240e-6), (200e-6, 210e-6), (200e-6, 180e-6)]  # m
COLOURS = {"clamped": "black", "simply-supported": "#1b4f9c", "free": "#c8371b"}


def draw_runs() -> None:
    with TemporaryDirectory() as folder:
        for name in ("transport", "two_actuators"):
            run_case(read_case(ROOT / "examples" / f"{name}.toml"), output=folder)
            copy(Path(folder) / f"{name}.png", ROOT / "docs")


def draw_first() -> None:
    """The case of the quick start."""
    with TemporaryDirectory() as folder:
        case = Path(folder) / "first.toml"
        case.write_text((ROOT / "docs/quick-start.md").read_text().split("```toml\n")[1].split("```")[0])
        run_case(read_case(case), output=folder)
        copy(Path(folder) / "first.png", ROOT / "docs")


def draw_tutorial() -> None:
    """The pictures of the tutorial, and what the cells of its notebook print and draw."""
    device = (ROOT / "examples/device.toml").read_text()
    with TemporaryDirectory() as folder:
        case = Path(folder) / "column.toml"
        case.write_text(device.replace('"5 um"', '"5 * (column == 0) um"').replace("2 kHz", "4 kHz"))
        run_case(read_case(case)).plot().savefig(ROOT / "docs/tutorial.png")
        main(["feasibility", str(case), "--output", folder], standalone_mode=False)
        copy(Path(folder) / "column.feasibility.png", ROOT / "docs/tutorial_feasibility.png")
    notebook = nbformat.read(ROOT / "docs/tutorial.ipynb", 4)
    NotebookClient(notebook, timeout=600).execute()
    nbformat.write(notebook, ROOT / "docs/tutorial.ipynb")


def draw_sweep() -> None:
    with TemporaryDirectory() as folder:
        run_study(read_study(ROOT / "examples/studies/frequency_stroke.toml"), folder)
        run_study(read_study(ROOT / "examples/studies/starts.toml"), folder)
        copy(Path(folder) / "frequency_stroke.sweep.png", ROOT / "docs/sweep_map.png")
        copy(Path(folder) / "starts.sweep.png", ROOT / "docs/sweep_starts.png")


def draw_aims() -> None:
    with TemporaryDirectory() as folder:
        aim(read_task(ROOT / "examples/aims/to_target.toml"), folder)
        plan(read_route(ROOT / "examples/aims/around_the_corner.toml", CORNER), folder)
        copy(Path(folder) / "to_target_aim.png", ROOT / "docs/aim.png")
        copy(Path(folder) / "around_the_corner_plan.png", ROOT / "docs/plan.png")
        run_case(read_case(Path(folder) / "around_the_corner_planned.toml"), folder)
        film = ROOT / "docs/plan.gif"
        animate(Path(folder) / "around_the_corner_planned", film, size="640x400", fps=12, slow_motion=200)


def draw_drift() -> None:
    with TemporaryDirectory() as folder:
        drift(read_case(ROOT / "examples/device.toml"), "columns").write(Path(folder))
        copy(Path(folder) / "device.drift.png", ROOT / "docs/drift.png")


def draw_plates() -> None:
    figure = Figure(figsize=(12.0, 10.0))
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.12)
    axes = figure.subplots(2, 2)
    _draw_l(figure, axes[0, 0])
    _draw_annulus(figure, axes[0, 1])
    _draw_rectangle(figure, axes[1, 0])
    _draw_decay(axes[1, 1])
    keys = [Line2D([], [], color=colour, linewidth=2.5, label=support) for support, colour in COLOURS.items()]
    triangle = {"color": "white", "marker": "^", "markeredgecolor": "black", "linestyle": "", "markersize": 9}
    keys.append(Line2D([], [], label="actuator", **triangle))
    figure.legend(handles=keys, loc="outside lower center", ncols=4, frameon=False)
    figure.savefig(ROOT / "docs" / "plates.png", dpi=100)


def _draw_l(figure: Figure, axes: Axes) -> None:
    mesh = read(ROOT / "examples/meshes/l_with_hole.msh", unit=1e-6)
    places = [(150, 220), (140, 310), (70, 290), (220, 150), (310, 140), (290, 70)]
    supports = {"outer": "clamped", "hole": "free"}
    shapes = Plate(mesh, SECTION, supports).influence(np.array(places) * 1e-6)
    strokes = 1e-6 * np.eye(6)[0]
    _fill(figure, axes, mesh, supports, shapes, lambda xy: shapes.evaluate(xy, strokes)[0])
    cells = shapes.model.mesh
    axes.triplot(*(cells.points.T * MICRO), cells.triangles, color="black", linewidth=0.35, alpha=0.6)
    axes.set_title(
        "A mesh of gmsh, with the cells that are solved on:\none actuator up by 1 µm, five at rest", fontsize=11
    )


def _draw_annulus(figure: Figure, axes: Axes) -> None:
    mesh, supports = annulus(100e-6, 300e-6, 25e-6), {"outer": "clamped", "inner": "free"}
    angle = 2 * np.pi * np.arange(6) / 6
    shapes = Plate(mesh, SECTION, supports).influence(200e-6 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    strokes = 1e-6 * np.eye(6)[1]
    _fill(figure, axes, mesh, supports, shapes, lambda xy: shapes.evaluate(xy, strokes)[0])
    axes.set_title("A ring, its inner rim free:\none actuator up by 1 µm, five at rest", fontsize=11)


def _draw_rectangle(figure: Figure, axes: Axes) -> None:
    mesh = rectangle(600e-6, 400e-6, 40e-6)
    supports = {"left": "clamped", "bottom": "simply-supported", "top": "simply-supported", "right": "free"}
    answer = Plate(mesh, SECTION, supports).pressure(PRESSURE)
    _fill(figure, axes, mesh, supports, None, lambda xy: answer.evaluate(xy)[0])
    axes.set_title("A support for every side:\nunder a pressure of 1 kPa, without actuators", fontsize=11)


def _fill(figure: Figure, axes: Axes, mesh: PlateMesh, supports, shapes: InfluenceShapes | None, deflection) -> None:
    """The deflection in µm, rims by their support, actuators."""
    actuators = np.empty((0, 2)) if shapes is None else shapes.points
    points, triangles = display_mesh(mesh.refined(), actuators)
    w = deflection(onto_plate(mesh.outline, points)) * MICRO
    most = np.abs(w).max()
    low = -most if w.min() < -0.01 * most else 0.0
    levels = MaxNLocator(21).tick_values(low, most)
    colours = {"cmap": "RdBu_r" if low else "Reds", "levels": levels}
    filled = axes.tricontourf(*(points.T * MICRO), triangles, w, **colours)
    figure.colorbar(filled, ax=axes, label="deflection [µm]", shrink=0.85, format="%.3g", ticks=MaxNLocator(9))
    for name in mesh.boundaries:
        pieces = mesh.arcs(name, np.linspace(0, 1, 9))[0] * MICRO
        axes.add_collection(LineCollection(list(pieces), colors=COLOURS[supports[name]], linewidths=2.5, zorder=3))
    axes.plot(*(actuators.T * MICRO), "^", color="white", markeredgecolor="black", markersize=8, zorder=4)
    axes.set_aspect("equal")
    axes.margins(0.03)
    axes.use_sticky_edges = False
    axes.set_xlabel("x [µm]")
    axes.set_ylabel("y [µm]")


def _draw_decay(axes: Axes) -> None:
    """The shape of an actuator in the middle of a large array, along its row."""
    side = PITCH * (np.arange(ACROSS) - (ACROSS - 1) / 2)
    points = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    width = PITCH * (ACROSS + 1)
    shapes = Plate(rectangle(width, width, width / 16), SECTION).influence(points)
    row = int(np.argmin(np.hypot(*points.T)))
    weights = np.eye(1, len(points), row)[0]
    per_pitch, reach = 50, 10
    offset = PITCH * np.arange(-reach * per_pitch, reach * per_pitch + 1) / per_pitch
    xy = points[row] + np.stack([offset, np.zeros_like(offset)], axis=1)
    w = np.abs(shapes.evaluate(xy, weights)[0])
    axes.semilogy(offset * MICRO, np.where(w > 0, w, np.nan), color="black", linewidth=0.8, label="along its row")
    peaks = w[reach * per_pitch :][:-1].reshape(reach, per_pitch).max(axis=1)
    middle = (np.arange(reach) + 0.5) * PITCH * MICRO
    peaks[peaks == 0] = np.nan
    axes.plot(middle, peaks, "o", color="#c8371b", label="largest within each pitch")
    kept = np.flatnonzero(np.isfinite(peaks))
    rate = np.exp(-np.polyfit(kept[1:], np.log(peaks[kept[1:]]), 1)[0])
    axes.axhline(1e-6, color="#1b4f9c", linestyle="--", linewidth=1, label="truncation")
    axes.set_ylim(1e-8, 1e3)  # room for the legend above the curve
    axes.set_yticks(10.0 ** np.arange(-8, 1))
    axes.set_xticks(500 * np.arange(-2, 3))
    axes.set_xlabel("distance from the actuator along x [µm]; one pitch is 100 µm")
    axes.set_ylabel("deflection, over that at the actuator")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper center", fontsize=9)
    axes.set_title(
        f"One of 10 000 actuators, in the middle of 100 x 100:\n{rate:.1f} times less with each pitch", fontsize=11
    )
    print(
        f"{len(points)} actuators, {len(shapes.tiles)} tiles, {len({id(t.patch) for t in shapes.tiles})} patches; "
        f"left out {shapes.truncation_error:.1e}; peaks",
        " ".join(f"{p:.1e}" for p in peaks),
    )


def draw_gallery() -> None:
    for script in sorted((ROOT / "docs/gallery").glob("*.py")):
        run_path(str(script), run_name="__main__")


if __name__ == "__main__":
    draw_gallery()
    draw_runs()
    draw_animation()
    draw_first()
    draw_tutorial()
    draw_sweep()
    draw_aims()
    draw_drift()
    draw_plates()
    draw_contact()
    draw_faces()
    draw_motion_error()
    draw_tolerance()
    draw_paraview()
    draw_pages()
