"""The table and the picture of nodal lines in docs/howto/waves.md: how parts gather, and where they lift off.

.venv/bin/python docs/chladni_pictures.py
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from contourpy import contour_generator
from generated import write
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from active_surface.studies import Study, read_study, run_study
from active_surface.studies.response import response
from coupling import Case, build_friction, build_part, build_surface, read_case
from particle import CoulombAdhesion, SurfaceMotion, simulate

DOCS = Path(__file__).parent
PAGE = DOCS / "howto/waves.md"
CASE = DOCS.parent / "examples/chladni.toml"
STUDY = DOCS.parent / "examples/studies/chladni.toml"
PLACES = ((2e-3, 1e-3), (3e-3, 0.0), (4.5e-3, 4.5e-3))  # m, where the threshold is sought
STARTS, SEED, HALF = 8, 1, 4.9e-3  # of the comparison of tolerances; m
NEAR = (0.1e-3, 0.5e-3)  # m, from a nodal line
MOMENTS = "start", "half way", "end"
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


def thresholds(case: Case) -> str:
    """How far the loads at which parts come off are from (6.5)."""
    surface, mass = build_surface(case), case.part.mass
    rate = 2 * math.pi * (case.actuators[0].frequency or 0.0)
    apart = []
    for place, height in zip(PLACES, heights(case, np.array(PLACES)), strict=True):
        measured = 9.80665 + lift_off(case, surface, place) / mass
        apart.append(abs(measured / (abs(height) * rate**2) - 1))
    return f"At three places parts come off where (6.5) says, to {max(apart):.1e}."


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
    tighter, closer_surface = (
        f"{MICRO * np.linalg.norm(others - usual, axis=1).max():.2g} um"
        for others in (ends(coarse, 1e-11), ends(fine, case.run.tolerance))
    )
    return [
        f"Eight ends move by at most {tighter} at a tolerance of 1e-11,",
        f"and {closer_surface} at a surface_tolerance of 1e-10.",
    ]


def gathering(study: Study) -> tuple[np.ndarray, dict[str, int]]:
    """Places (3, n, 2) [m] of the study's parts at the start, half way and at the end, and how many ended how."""
    run = study.case.run
    half = study.case.model_copy(update={"run": run.model_copy(update={"duration": run.duration / 2})})
    whole, until_half = run_study(study), run_study(replace(study, case=half))
    data = (whole.dataset, "start"), (until_half.dataset, "end"), (whole.dataset, "end")
    return np.array([np.stack([d[f"{at}_x"], d[f"{at}_y"]], axis=-1) for d, at in data]), whole.outcomes


def from_nodal_lines(case: Case, places: np.ndarray) -> np.ndarray:
    """The distances (...) [m] of places (..., 2) from the nearest nodal line."""
    side, height = on_grid(case)
    lines = contour_generator(side, side, height).lines(0.0)
    start, end = (np.concatenate([line[part] for line in lines]) for part in (np.s_[:-1], np.s_[1:]))
    along, away = end - start, places[..., None, :] - start
    share = np.clip((away * along).sum(-1) / (along**2).sum(-1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * along, axis=-1).min(axis=-1))


def on_grid(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (k,) [m] along either side of the plate, and heights (k, k) [m] there in phase with the largest."""
    side = np.linspace(-5e-3, 5e-3, 161) * (1 - 1e-9)
    grid = np.array([(x, y) for y in side for x in side])
    return side, in_phase(heights(case, grid)).reshape(len(side), len(side))


def held_amplitude(case: Case) -> float:
    """The amplitude [m] up to which a part stays on the plate."""
    rate = 2 * math.pi * (case.actuators[0].frequency or 0.0)
    return (9.80665 + (case.friction.adhesion or 0.0) / case.part.mass) / rate**2


def shares(case: Case, places: np.ndarray) -> list[str]:
    """Of all parts, how many are where, at each moment."""
    far, amplitude = from_nodal_lines(case, places), np.abs(heights(case, places.reshape(-1, 2))).reshape(3, -1)
    rows = [(f"within {MILLI * near:g} mm of a nodal line", (far < near).mean(axis=1)) for near in NEAR]
    rows.append(("where they cannot lift off", (amplitude < held_amplitude(case)).mean(axis=1)))
    lines = [f"| parts | {' | '.join(MOMENTS)} |", "|---|---:|---:|---:|"]
    lines += [f"| {name} | {' | '.join(f'{100 * share:.1f} %' for share in values)} |" for name, values in rows]
    return lines


def draw(case: Case, places: np.ndarray, path: Path) -> None:
    side, height = on_grid(case)
    x = MILLI * side
    figure = Figure(figsize=(15.0, 5.2), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, parts, title in zip(figure.subplots(1, 3, sharey=True), places, MOMENTS, strict=True):
        shades = axes.contourf(x, x, MICRO * np.abs(height), np.arange(0.0, 50.0, 5.0), cmap="YlOrBr")
        axes.contour(x, x, height, [0.0], colors="#1b4f9c", linewidths=1.5)
        held = held_amplitude(case)
        axes.contour(x, x, np.abs(height), [held], colors="#1b4f9c", linewidths=0.8, linestyles="--")
        axes.scatter(*(MILLI * parts.T), s=5, c="black", linewidths=0)
        axes.set(title=title, xlabel="x [mm]", aspect="equal", xlim=(-5, 5), ylim=(-5, 5))
    figure.axes[0].set_ylabel("y [mm]")
    figure.colorbar(shades, ax=figure.axes[-1], label="amplitude [um]", fraction=0.047)
    figure.savefig(path, dpi=90)


def main() -> None:
    case = read_case(CASE)
    write(PAGE, "chladni-convergence", [thresholds(case), *convergence(case)])
    places, outcomes = gathering(read_study(STUDY))
    print(outcomes)
    write(PAGE, "gathering", shares(case, places))
    draw(case, places, DOCS / "chladni.png")


if __name__ == "__main__":
    main()
