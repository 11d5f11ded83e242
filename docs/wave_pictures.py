"""The picture and the table of a strip in docs/howto/waves.md: how fast a wave carries a part, over its phase velocity.

.venv/bin/python docs/wave_pictures.py
"""

import math
from pathlib import Path

import numpy as np
from generated import write
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from coupling import build_friction, build_part, build_surface, read_case
from particle import Drive, SurfaceMotion, Trajectory, simulate

DOCS = Path(__file__).parent
PAGE = DOCS / "howto/waves.md"
WAVELENGTH, RAMP = 4e-3, 3  # m, cycles; of examples/wave.toml
FREQUENCIES = (65, 130, 195, 255, 320, 360, 380, 390, 400, 410)  # Hz
DRAWN = (195, 320, 390)  # Hz, of the paths in the picture
SHOWN = (130, 195, 255, 320, 360, 380, 390, 410)  # Hz, in the table
SETTLED, CYCLES = 20, 100  # cycles of the wave that are left out, and the last one
RESTS = 1e-7  # m/s, up to which it does
MILLI, MICRO, G = 1e3, 1e6, 9.80665


def wave(surface: SurfaceMotion, places: np.ndarray, stroke: float, frequency: float, way: int) -> SurfaceMotion:
    """The surface with a wave that runs to the right (way 1) or to the left (-1)."""
    phases = np.mod(-way * 2 * math.pi * places / WAVELENGTH, 2 * math.pi)
    return surface.driven_by([Drive(stroke, frequency, "sine", phase=phase, ramp=RAMP) for phase in phases.tolist()])


def speed(path: Trajectory, frequency: float, first: int = SETTLED) -> float:
    """The mean speed [m/s] along x from one cycle to the last."""
    ends = path.at([first / frequency, CYCLES / frequency]).position[:, 0]
    return float(ends[1] - ends[0]) / ((CYCLES - first) / frequency)


def main() -> None:
    case = read_case(DOCS.parent / "examples/wave.toml")
    surface, law, part = build_surface(case), build_friction(case), build_part(case)
    places = np.array([actuator.position[0] for actuator in case.actuators])
    stroke = case.actuators[0].stroke or 0.0

    def follow(frequency: float, way: int, tolerance: float) -> Trajectory:
        driven = wave(surface, places, stroke, frequency, way)
        return simulate(driven, part, law, CYCLES / frequency, case.run.gravity, tolerance, after_detachment="fly")

    speeds: dict[int, list[float]] = {1: [], -1: []}
    hops = []  # whether it does, at each frequency
    for frequency in FREQUENCIES:
        flights = 0
        for way in (1, -1):
            path, closer = follow(frequency, way, 1e-9), follow(frequency, way, 1e-11)
            speeds[way].append(speed(closer, frequency))
            flights += sum(event.kind.name == "LANDS" for event in closer.events)
            shares = speed(path, frequency), speeds[way][-1], speed(closer, frequency, (SETTLED + CYCLES) // 2)
            print(way, frequency, [f"{MICRO * share:.1f} um/s" for share in shares], flights, flush=True)
        hops.append(flights > 0)
    write(PAGE, "speeds", table(stroke, speeds, hops))
    draw(speeds, {frequency: follow(frequency, 1, 1e-11) for frequency in DRAWN})


def table(stroke: float, speeds: dict[int, list[float]], hops: list[bool]) -> list[str]:
    """Speeds along the wave, with what the part does."""
    lines = ["| phase velocity, m/s | acceleration / g | wave to the right, um/s | to the left, um/s | the part |"]
    lines.append("|---:|---:|---:|---:|---|")
    for frequency, right, left, hop in zip(FREQUENCIES, speeds[1], speeds[-1], hops, strict=True):
        if frequency in SHOWN:
            does = "hops" if hop else "stays in contact" if abs(right) > RESTS else "rests"
            strength = stroke * (2 * math.pi * frequency) ** 2 / G
            figures = f"{WAVELENGTH * frequency:.2f} | {strength:.2f} | {MICRO * right:.1f} | {MICRO * -left + 0.0:.1f}"
            lines.append(f"| {figures} | {does} |")
    return lines


def draw(speeds: dict[int, list[float]], paths: dict[int, Trajectory]) -> None:
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    for frequency, path in paths.items():
        times = np.linspace(0.0, 0.2, 801)
        moved = path.at(times).position[:, 0] - path.position[0, 0]
        contact = "hopping" if any(event.kind.name == "LANDS" for event in path.events) else "in contact"
        text = f"{contact}, {'with' if moved[-1] > 0 else 'against'} the wave"
        left.plot(MILLI * times, MICRO * moved, label=f"{frequency} Hz: {text}")
    left.set(xlabel="time [ms]", ylabel="way along the wave's direction [µm]")
    left.legend(frameon=False)
    left.margins(y=0.15)
    velocities = WAVELENGTH * np.array([-f for f in reversed(FREQUENCIES)] + list(FREQUENCIES))
    right.plot(velocities, MILLI * np.array(speeds[-1][::-1] + speeds[1]), "o-", ms=4, color="#1b4f9c")
    right.axhline(0.0, color="0.6", lw=0.8)
    right.axvline(0.0, color="0.6", lw=0.8)
    right.set(xlabel="phase velocity [m/s]", ylabel="mean speed of the part [mm/s]")
    figure.savefig(DOCS / "waves.png", dpi=130)


if __name__ == "__main__":
    main()
