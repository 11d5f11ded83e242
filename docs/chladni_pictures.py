"""The tables and the picture of docs/howto/chladni.md: a Chladni figure, where parts lift off, how far to trust it.

.venv/bin/python docs/chladni_pictures.py
"""

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from active_surface.studies import read_study, run_study
from active_surface.studies.response import response
from coupling import Case, build_friction, build_part, build_surface, read_case
from particle import CoulombAdhesion, SurfaceMotion, simulate

DOCS = Path(__file__).parent
CASE = DOCS.parent / "examples/chladni.toml"
STUDY = DOCS.parent / "examples/studies/chladni.toml"
PLACES = ((2e-3, 1e-3), (3e-3, 0.0), (4.5e-3, 4.5e-3))  # m, where the threshold is sought
STARTS, SEED, HALF = 8, 1, 4.9e-3  # of the comparison of tolerances; m
MILLI, MICRO = 1e3, 1e6


def heights(case: Case, places: np.ndarray) -> np.ndarray:
    """Of the plate [m] at places (n, 2) [m], complex."""
    drive = case.actuators[0]
    assert drive.stroke is not None and drive.frequency is not None
    ratios = response(case, places, np.array([drive.frequency])).dataset()["response"]
    return np.asarray(drive.stroke * ratios.sum("actuator").values.reshape(-1))


def in_phase(height: np.ndarray) -> np.ndarray:
    """Heights in phase with the largest one [m]: 0 on nodal lines."""
    turn = np.angle(height[np.argmax(np.abs(height))])
    return np.asarray((height * np.exp(-1j * turn)).real)


def lift_off(case: Case, surface: SurfaceMotion, place: tuple[float, float]) -> float:
    """The adhesion [N] above which a part stays on the plate."""
    part = build_part(case, place)
    least, most = 0.0, 1e-5
    for _ in range(24):
        adhesion = (least + most) / 2
        law = CoulombAdhesion(100.0, adhesion)  # friction holds it at its place
        path = simulate(surface, part, law, 0.01, case.run.gravity, case.run.tolerance)
        least, most = (adhesion, most) if path.outcome == "detached" else (least, adhesion)
    return least


def thresholds(case: Case) -> list[str]:
    surface, mass = build_surface(case), case.part.mass
    rate = 2 * math.pi * (case.actuators[0].frequency or 0.0)
    lines = [
        "| place, mm | amplitude A, um | A w^2, m/s^2 | (g + pull-off/m) at lift-off, m/s^2 |",
        "|---|---:|---:|---:|",
    ]
    for place, height in zip(PLACES, heights(case, np.array(PLACES)), strict=True):
        measured = 9.80665 + lift_off(case, surface, place) / mass
        texts = f"{MICRO * abs(height):.3f}", f"{abs(height) * rate**2:.3f}", f"{measured:.3f}"
        lines.append(f"| {MILLI * place[0]:g}, {MILLI * place[1]:g} | {' | '.join(texts)} |")
    return lines


def convergence(case: Case) -> list[str]:
    """How far ends move where something is computed more closely."""
    starts = np.random.default_rng(SEED).uniform(-HALF, HALF, (STARTS, 2))
    closer = case.model_copy(update={"run": case.run.model_copy(update={"surface_tolerance": 1e-10})})
    coarse, fine = build_surface(case), build_surface(closer)

    def ends(surface: SurfaceMotion, tolerance: float) -> np.ndarray:
        law, end, gravity = build_friction(case), case.run.duration, case.run.gravity
        parts = [build_part(case, (x, y)) for x, y in starts.tolist()]
        paths = [simulate(surface, part, law, end, gravity, tolerance, after_detachment="fly") for part in parts]
        return np.array([path.position[-1] for path in paths])

    usual = ends(coarse, case.run.tolerance)
    lines = ["| change | median move of the end, um | largest, um |", "|---|---:|---:|"]
    for name, others in (
        ("tolerance 1e-11", ends(coarse, 1e-11)),
        ("surface_tolerance 1e-10", ends(fine, case.run.tolerance)),
    ):
        away = MICRO * np.linalg.norm(others - usual, axis=1)
        lines.append(f"| {name} | {np.median(away):.2g} | {away.max():.2g} |")
    return lines


def draw(case: Case, starts: np.ndarray, ends: np.ndarray, path: Path) -> None:
    side = np.linspace(-5e-3, 5e-3, 81) * (1 - 1e-9)
    grid = np.array([(x, y) for y in side for x in side])
    height = in_phase(heights(case, grid)).reshape(len(side), len(side))
    rate = 2 * math.pi * (case.actuators[0].frequency or 0.0)
    held = (9.80665 + (case.friction.adhesion or 0.0) / case.part.mass) / rate**2
    figure = Figure(figsize=(12.0, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, places, title in zip(figure.subplots(1, 2), (starts, ends), ("starts", "ends"), strict=True):
        shades = axes.pcolormesh(MILLI * side, MILLI * side, MICRO * np.abs(height), cmap="YlOrBr", shading="gouraud")
        axes.contour(MILLI * side, MILLI * side, height, [0.0], colors="#1b4f9c", linewidths=1.5)
        axes.contour(
            MILLI * side, MILLI * side, np.abs(height), [held], colors="#1b4f9c", linewidths=0.8, linestyles="--"
        )
        axes.scatter(*(MILLI * places.T), s=5, c="black", linewidths=0)
        axes.set(title=title, xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    figure.colorbar(shades, ax=figure.axes, label="amplitude [um]")
    figure.savefig(path, dpi=100)


def main() -> None:
    case = read_case(CASE)
    with TemporaryDirectory() as folder:
        sweep = run_study(read_study(STUDY), folder)
        data = sweep.dataset.load()
        starts, ends = (np.stack([data[f"{at}_x"], data[f"{at}_y"]], axis=-1) for at in ("start", "end"))
        draw(case, starts, ends, DOCS / "chladni.png")
    print("\n".join([*thresholds(case), "", *convergence(case)]))


if __name__ == "__main__":
    main()
