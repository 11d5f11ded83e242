"""The tables and the picture of docs/howto/ring.md: how fast a wave carries a part around a ring, and how exactly.

.venv/bin/python docs/ring_wave_pictures.py
"""

import math
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest.mock import patch

import numpy as np
from generated import write
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from ring_field import FREQUENCIES, PLACES, RADII, WAVES, is_inner
from ring_wave import TURN, G, Ring, around

from coupling import build_friction, build_part, build_surface, read_case
from coupling.case import Case
from particle import SurfaceMotion, Trajectory, simulate

DOCS = Path(__file__).parent
PAGE = DOCS / "howto/ring.md"
CASE = DOCS.parent / "examples/ring_wave.toml"
LIFTS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95)  # A w^2 over the load per mass, of the table
STARTS = (5.4e-3, 6.2e-3, 7.0e-3)  # m from the centre
ON_TRACK = 0.9  # s, long enough to see whether parts stay on the track
MILLI, MICRO = 1e3, 1e6


def landings(path: Trajectory) -> list[float]:
    return [event.time for event in path.events if event.kind.name == "LANDS"]


def purity(ring: Ring) -> list[str]:
    """The waves at the wave's frequency on the crest's circle, over the wave itself."""
    circle = int(np.argmin(np.abs(RADII - ring.field.crest)))
    at = int(np.argmin(np.abs(2 * math.pi * ring.responses.frequencies - ring.rate)))
    forces = np.array([(one.force or 0.0) * np.exp(1j * one.phase) for one in ring.case.actuators])
    waves = np.abs(np.fft.fft(ring.responses.values[circle, :, :, at] @ (forces * is_inner(ring.case)))) / PLACES
    lines = ["| turns around the ring | amplitude over that of the wave |", "|---|---:|"]
    named = ((-2, "2, with the wave"), (2, "2, against it"), (4, "4, against it"), (-8, "8, with it"))
    return [*lines, *(f"| {name} | {waves[n] / waves[-WAVES]:.1e} |" for n, name in named)]


def lift_off(ring: Ring) -> tuple[float, float]:
    """What a part is pressed on with when it just stays, over its mass [m/s^2], and the plate's acceleration there."""
    radius, mass = ring.field.crest, ring.case.part.mass
    least, most = 0.0, 2 * ring.case.part.squeeze
    law = build_friction(ring.case)
    for _ in range(16):
        squeeze = (least + most) / 2
        part = build_part(
            ring.case.model_copy(update={"part": ring.case.part.model_copy(update={"squeeze": squeeze})}), (radius, 0.0)
        )
        path = simulate(ring.surface, part, law, 0.01, ring.case.run.gravity, ring.case.run.tolerance)
        least, most = (squeeze, most) if path.outcome == "detached" else (least, squeeze)
    times = np.linspace(0.0, 2 * math.pi / ring.rate, 2001)
    sunk = min(ring.surface.evaluate(np.array([[radius, 0.0]]), float(time)).w_tt[0] for time in times)
    return G + least / mass, -sunk


def over_amplitude(ring: Ring) -> tuple[list[str], np.ndarray]:
    """The wave alone, on the circle of its crest: speeds (k, 3) [m/s] of the run, by scipy, without friction."""
    alone = ring.driven(track=0.0)
    lines = ["| A w^2 over load | amplitude, um | speed, mm/s | scipy, mm/s | with hardly any friction, mm/s |"]
    lines.append("|---:|---:|---:|---:|---:|")
    speeds = []
    for lift in LIFTS:
        one = ring.driven(lift / alone.lift, track=0.0)
        radius = one.field.crest
        speeds.append((one.speed(radius), one.by_scipy(radius), one.sliding))
        texts = (f"{MILLI * speed:.3f}" for speed in speeds[-1])
        lines.append(f"| {lift:g} | {MICRO * one.field.wave(radius, -WAVES):.2f} | {' | '.join(texts)} |")
        print(lines[-1], flush=True)
    return lines, np.array(speeds)


def over_frequency(ring: Ring) -> tuple[list[str], np.ndarray]:
    """On the track, with the forces of the example: speeds (k, 2) [m/s] of the run and by scipy."""
    lines = [
        "| frequency, Hz | amplitude, um | A w^2 over load | speed, mm/s | scipy, mm/s |",
        "|---:|---:|---:|---:|---:|",
    ]
    speeds = []
    for frequency in FREQUENCIES:
        one = ring.driven(frequency=frequency)
        radius = ring.case.part.position[0]
        speeds.append((one.speed(radius), one.by_scipy(radius)))
        amplitude, texts = one.field.wave(one.field.crest, -WAVES), (f"{MILLI * speed:.3f}" for speed in speeds[-1])
        lines.append(f"| {frequency} | {MICRO * amplitude:.2f} | {one.lift:.3f} | {' | '.join(texts)} |")
        print(lines[-1], flush=True)
    return lines, np.array(speeds)


def on_track(ring: Ring) -> list[str]:
    lines = [
        "| start, mm | last landing, ms | after 0.9 s, mm | speed in the last third, mm/s |",
        "|---:|---:|---:|---:|",
    ]
    times = np.linspace(2 * ON_TRACK / 3, ON_TRACK, 1001)
    for radius in STARTS:
        path = ring.follow(radius, ON_TRACK)
        places = path.at(times).position
        landed = [f"{MILLI * time:.0f}" for time in landings(path)[-1:]] or ["none"]
        texts = (
            f"{MILLI * radius:g}",
            *landed,
            f"{MILLI * math.hypot(*places[-1]):.2f}",
            f"{MILLI * around(places, times):.2f}",
        )
        lines.append(f"| {' | '.join(texts)} |")
        print(lines[-1], flush=True)
    return lines


@contextmanager
def closer(*names: str) -> Iterator[None]:
    """A bound of the modes a hundredth of what it is, of the pieces in time a ten-thousandth."""
    bounds = {"coupling.vibration.choice.TOLERANCE": 5e-6, "coupling.vibration.vibration.PIECES": 3e-9}
    with ExitStack() as stack:
        for name in names:
            stack.enter_context(patch(name, bounds[name]))
        yield


def convergence(case: Case) -> list[str]:
    """How far the example's end moves where something is computed more closely."""

    def end(surface: SurfaceMotion, tolerance: float) -> np.ndarray:
        run = case.run
        return simulate(surface, build_part(case), build_friction(case), run.duration, run.gravity, tolerance).position[
            -1
        ]

    usual = build_surface(case)
    fine = case.model_copy(update={"run": case.run.model_copy(update={"surface_tolerance": 1e-10})})
    given = case.run.tolerance
    place, others = end(usual, given), {"tolerance 1e-13 in place of 1e-11": end(usual, 1e-13)}
    others["surface_tolerance 1e-10 in place of 1e-8"] = end(build_surface(fine), given)
    with closer("coupling.vibration.choice.TOLERANCE"):
        others["modes whose error is a hundredth"] = end(build_surface(case), given)
    with closer("coupling.vibration.vibration.PIECES"):
        others["pieces in time whose error is a ten-thousandth"] = end(build_surface(case), given)
    way = np.linalg.norm(place - case.part.position)
    lines = ["| change | the end moves by, um | of the way |", "|---|---:|---:|"]
    for name, other in others.items():
        away = float(np.linalg.norm(other - place))
        lines.append(f"| {name} | {MICRO * away:.2g} | {away / way:.1e} |")
        print(lines[-1], flush=True)
    return lines


def leaving(ring: Ring) -> list[str]:
    """How a part that starts beside the crest's circle leaves it without the track."""
    crest, beside, off = ring.field.crest, 0.1e-3, 1e-3
    path = ring.driven(track=0.0).follow(crest + beside, 2.0)
    times = np.linspace(0.0, path.time[-1], 20001)
    places = path.at(times).position
    end = int(np.argmax(np.hypot(*places.T) > crest + off))
    assert end, "it does not leave"
    way = math.hypot(*(places[end] - places[0]))
    lines = [
        f"A part that starts {MILLI * beside:g} mm beyond that circle is {MILLI * off:g} mm beyond it after "
        f"{times[end]:.2f} s and {MILLI * way:.1f} mm."
    ]
    print(lines[-1], flush=True)
    return lines


def turn(ring: Ring) -> tuple[list[str], np.ndarray]:
    """One turn: its figures, and places (k, 2) [m] along it."""
    path = ring.follow(ring.case.part.position[0], TURN)
    times = np.linspace(0.0, TURN, 18001)
    places = path.at(times).position
    angles = np.unwrap(np.arctan2(places[:, 1], places[:, 0]))
    end = int(np.argmax(angles > 2 * math.pi))
    assert end, "it does not get round"
    places = places[: end + 1]
    radii = MILLI * np.hypot(*places.T)
    lines = [
        "| time of a turn, s | cycles of the wave | radius, mm | mean speed, mm/s | landings |",
        "|---:|---:|---:|---:|---:|",
        f"| {times[end]:.2f} | {times[end] * ring.rate / 2 / math.pi:.0f} | {radii.min():.2f} to {radii.max():.2f} | "
        f"{MILLI * around(places, times[: end + 1]):.2f} | {len(landings(path))} |",
    ]
    print(lines[-1], flush=True)
    return lines, places


def draw(ring: Ring, way: np.ndarray, amplitudes: np.ndarray, frequencies: np.ndarray) -> None:
    figure = Figure(figsize=(14.0, 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    left, middle, right = figure.subplots(1, 3)
    radii, angles = np.linspace(2e-3, 10e-3, 41) * (1 - 1e-9), np.linspace(0.0, 2 * math.pi, 145)
    x, y = radii[:, None] * np.cos(angles), radii[:, None] * np.sin(angles)
    x[0], y[0] = x[0] * (1 + 2e-9), y[0] * (1 + 2e-9)
    places = np.stack([x, y], axis=-1).reshape(-1, 2)
    height = MICRO * ring.surface.evaluate(places, 0.0).w.reshape(x.shape)
    most = np.abs(height).max()
    shades = left.contourf(MILLI * x, MILLI * y, height, np.linspace(-most, most, 14), cmap="RdBu_r", alpha=0.75)
    figure.colorbar(shades, ax=left, label="height at one moment [um]", ticks=np.arange(-20, 21, 10))
    left.plot(*(MILLI * way.T), color="black", lw=1.5)
    left.plot(*(MILLI * way[0]), "o", color="black", ms=5)
    for inner, mark, text in ((True, "^", "forces of the wave"), (False, "s", "forces of the track")):
        actuators = np.array([one.position for one in ring.case.actuators])[is_inner(ring.case) == inner]
        left.plot(*(MILLI * actuators.T), mark, color="black", mfc="white", ms=6, label=text)
    left.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="one turn of the part")
    left.legend(frameon=False, loc="upper right", fontsize=7, handletextpad=0.2)
    left.set(xlim=(-10.5, 10.5), ylim=(-10.5, 12.5))
    for column, style, text in ((2, ":", "with hardly any friction"), (1, "-", "scipy"), (0, "o", "run")):
        middle.plot(LIFTS, MILLI * amplitudes[:, column], style, color="#1b4f9c", ms=5, label=text)
    middle.axvline(ring.creeps, color="0.6", lw=0.8)
    middle.annotate("friction\nholds it", (ring.creeps - 0.01, 6.0), ha="right", fontsize=8)
    middle.set(xlabel=r"$A \omega^2$ over load", ylabel="speed [mm/s]", title="the wave alone, on its crest's circle")
    middle.legend(framealpha=1, edgecolor="none")  # over the line where friction gives way
    for column, style, text in ((1, "-", "scipy"), (0, "o", "run")):
        right.plot(FREQUENCIES, MILLI * frequencies[:, column], style, color="#1b4f9c", ms=5, label=text)
    right.set(xlabel="frequency of the wave [Hz]", ylabel="speed [mm/s]", title="on the track", ylim=(0.0, None))
    right.legend(frameon=False)
    figure.savefig(DOCS / "ring.png", dpi=90)


def main() -> None:
    ring = Ring.of(read_case(CASE))
    write(PAGE, "purity", purity(ring))
    alone = ring.driven(track=0.0)
    load, sunk = lift_off(alone)
    write(
        PAGE,
        "lift-off",
        [
            "On the crest's circle, 6.2 mm from the centre, the wave of the example accelerates the plate by",
            f"{sunk:.2f} m/s^2. A part comes off if it is pressed on with less than {load:.2f} m/s^2 (by bisection).",
        ],
    )
    speeds, amplitudes = over_amplitude(ring)
    write(PAGE, "amplitudes", speeds)
    speeds, frequencies = over_frequency(ring)
    write(PAGE, "frequencies", speeds)
    write(PAGE, "leaving", leaving(ring))
    write(PAGE, "track", on_track(ring))
    figures, way = turn(ring)
    write(PAGE, "turn", figures)
    draw(ring, way, amplitudes, frequencies)
    write(PAGE, "convergence", convergence(ring.case))
    print(ring.field.crest, alone.lift, alone.creeps)


if __name__ == "__main__":
    main()
