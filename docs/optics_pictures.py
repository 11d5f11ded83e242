"""The picture and the table of docs/howto/optics.md: influence functions, and fits to noisy ones.

.venv/bin/python docs/optics_pictures.py
"""

import re
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from generated import write
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import Case, read_case
from coupling.scene import actuator_stiffness, build_plate
from fem_plate import InfluenceShapes, Plate, fit_influence, read_influence, save_influence

DOCS = Path(__file__).parent
PAGE = DOCS / "howto/optics.md"
MIDDLE, NEIGHBOUR = 18, 19  # actuators
NOISE = 0.01  # of the largest value
FITS = (("specula", 101), ("proper", 101))  # layout, pixels
MILLI = 1e3


def shapes_of(case: Case, passive: list[int]) -> InfluenceShapes:
    """The case's influence functions, with some actuators that follow."""
    stiffness = actuator_stiffness(case)
    stiffness[passive] = 0.0
    return build_plate(case.plate).influence([actuator.position for actuator in case.actuators], stiffness)


def draw(case: Case) -> None:
    """The middle actuator's function from above, and cuts through it."""
    alive, passive = shapes_of(case, []), shapes_of(case, [NEIGHBOUR])
    radius = case.plate.radius
    figure = Figure(figsize=(8.5, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.4])
    side = np.linspace(-radius, radius, 301)
    xy = np.stack(np.meshgrid(side, side), axis=-1)
    on = np.hypot(*np.moveaxis(xy, -1, 0)) <= radius
    image = np.full(on.shape, np.nan)
    image[on] = alive.evaluate(xy[on])[0][:, MIDDLE]
    edge = MILLI * radius
    drawn = left.imshow(image, origin="lower", extent=(-edge, edge, -edge, edge), cmap="viridis")
    left.plot(*(MILLI * alive.points.T), "w.", markersize=3)
    left.plot(*(MILLI * alive.points[NEIGHBOUR]), "rs", markersize=5, fillstyle="none")
    left.set(xlabel="x, mm", ylabel="y, mm")
    figure.colorbar(drawn, ax=left, label="surface over stroke, m/m", shrink=0.85)
    line = np.column_stack([side, np.zeros_like(side)])[1:-1]
    for shapes, label, style in (
        (alive, "holds", "-"),
        (passive, "follows", "--"),
    ):
        right.plot(MILLI * line[:, 0], shapes.evaluate(line)[0][:, MIDDLE], style, label=label)
    right.plot(MILLI * alive.points[NEIGHBOUR, 0], 0, "rs", fillstyle="none", clip_on=False)
    right.set(xlabel="x, mm, through the middle", ylabel="surface over stroke, m/m", ylim=(0, None))
    right.legend(frameon=False, fontsize="small", loc="upper left", title="the neighbour", title_fontsize="small")
    figure.savefig(DOCS / "optics.png", dpi=110)


def table(case: Case) -> list[str]:
    """What fits to noisy functions find, beginning without tension at springs half as stiff."""
    shapes, points = shapes_of(case, []), [actuator.position for actuator in case.actuators]
    full = build_plate(case.plate)
    untold = Plate(full.mesh, full.section)
    stiffness = case.actuators[0].stiffness
    lines = ["| functions | values on the plate | stiffness, N/m | tension, N/m | residual |"]
    lines.append("|---|---:|---:|---:|---:|")
    with TemporaryDirectory() as folder:
        for layout, pixels in FITS:
            path = Path(folder) / "x.fits"
            save_influence(path, shapes, pixels, layout)
            exact = read_influence(path)
            errors = np.random.default_rng(0).standard_normal(exact.values.shape)
            noisy = replace(exact, values=exact.values + NOISE * np.nanmax(exact.values) * errors)
            fit = fit_influence(noisy, untold, points, stiffness / 2)
            whose = "one, in a unit of its own" if layout == "proper" else f"all, {pixels} x {pixels} pixels"
            found = f"{fit.stiffness:.2f} +- {fit.stiffness_error:.2f} | {fit.tension:.2f} +- {fit.tension_error:.2f}"
            lines.append(f"| {whose} | {fit.pixels} | {found} | {fit.residual:.4f} |")
            print(lines[-1], flush=True)
    return lines


def main() -> None:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "mirror.toml"
        file.write_text(re.search(r"```toml\n(.*?)```", PAGE.read_text(), re.DOTALL)[1])
        case = read_case(file)
    draw(case)
    write(PAGE, "fits", table(case))


if __name__ == "__main__":
    main()
