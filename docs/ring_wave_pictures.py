"""The figures and the picture of a ring in docs/howto/waves.md: how fast a wave carries a part, and how exactly.

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
PAGE = DOCS / "howto/waves.md"
CASE = DOCS.parent / "examples/ring_wave.toml"
LIFTS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95)  # A w^2 over the load per mass
LIFT = 0.8  # of these, in the text
SHOWN = (602, 630, 658)  # Hz, in the text
STARTS = (5.4e-3, 6.2e-3, 7.0e-3)  # m from the centre
ON_TRACK = 0.9  # s, long enough to see whether parts stay on the track
MILLI, MICRO = 1e3, 1e6


def landings(path: Trajectory) -> list[float]:
    return [event.time for event in path.events if event.kind.name == "LANDS"]


def purity(ring: Ring) -> str:
    """The waves at the wave's frequency on the crest's circle, over the wave itself."""
    circle = int(np.argmin(np.abs(RADII - ring.field.crest)))
    at = int(np.argmin(np.abs(2 * math.pi * ring.responses.frequencies - ring.rate)))
    forces = np.array([(one.force or 0.0) * np.exp(1j * one.phase) for one in ring.case.actuators])
    waves = np.abs(np.fft.fft(ring.responses.values[circle, :, :, at] @ (forces * is_inner(ring.case)))) / PLACES
    back, others = waves[WAVES] / waves[-WAVES], max(waves[n] / waves[-WAVES] for n in (4, -8))
    return f"Of the wave {back:.1e} runs back; others reach {others:.1e}."


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


def over_amplitude(ring: Ring) -> np.ndarray:
    """The wave alone, on the circle of its crest: speeds (k, 3) [m/s] of the run, by scipy, without friction."""
    alone = ring.driven(track=0.0)
    speeds = []
    for lift in LIFTS:
        one = ring.driven(lift / alone.lift, track=0.0)
        radius = one.field.crest
        speeds.append((one.speed(radius), one.by_scipy(radius), one.sliding))
        print(lift, MICRO * one.field.wave(radius, -WAVES), [f"{MILLI * speed:.3f} mm/s" for speed in speeds[-1]])
    return np.array(speeds)


def over_frequency(ring: Ring) -> np.ndarray:
    """On the track, with the forces of the example: speeds (k, 2) [m/s] of the run and by scipy."""
    speeds = []
    for frequency in FREQUENCIES:
        one = ring.driven(frequency=frequency)
        radius = ring.case.part.position[0]
        speeds.append((one.speed(radius), one.by_scipy(radius)))
        amplitude = one.field.wave(one.field.crest, -WAVES)
        print(frequency, MICRO * amplitude, one.lift, [f"{MILLI * speed:.3f} mm/s" for speed in speeds[-1]], flush=True)
    return np.array(speeds)


def on_track(ring: Ring) -> list[str]:
    times = np.linspace(2 * ON_TRACK / 3, ON_TRACK, 1001)
    ends, speeds, last = [], [], []
    for radius in STARTS:
        path = ring.follow(radius, ON_TRACK)
        places = path.at(times).position
        last += [f"{MILLI * time:.0f} ms" for time in landings(path)[-1:]] or ["none"]
        ends.append(f"{MILLI * math.hypot(*places[-1]):.2f}")
        speeds.append(f"{MILLI * around(places, times):.2f}")
        print(radius, ends[-1], speeds[-1], last[-1], flush=True)
    starts = ", ".join(f"{MILLI * radius:g}" for radius in STARTS)
    return [
        f"- After {ON_TRACK:g} s parts that start {starts} mm from the centre are at {', '.join(ends)} mm, "
        f"with {', '.join(speeds)} mm/s.",
        f"  Last landings: {', '.join(last)}.",
    ]


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
    away = {name: float(np.linalg.norm(other - place)) / way for name, other in others.items()}
    print(away, flush=True)
    return [
        f"The end after {MILLI * case.run.duration:.0f} ms moves by at most {max(away.values()):.1e} of the way "
        "with tolerances or an error of the modes a hundredth as large,",
        "or pieces in time with a ten-thousandth of the error.",
    ]


def leaving(ring: Ring) -> str:
    """How a part that starts beside the crest's circle leaves it without the track."""
    crest, beside, off = ring.field.crest, 0.1e-3, 1e-3
    path = ring.driven(track=0.0).follow(crest + beside, 2.0)
    times = np.linspace(0.0, path.time[-1], 20001)
    places = path.at(times).position
    end = int(np.argmax(np.hypot(*places.T) > crest + off))
    assert end, "it does not leave"
    return (
        f"- Without the track a part that starts {MILLI * beside:g} mm beyond the crest's circle is {MILLI * off:g} mm "
        f"beyond it after {times[end]:.2f} s."
    )


def turn(ring: Ring) -> tuple[str, np.ndarray]:
    """One turn: its figures, and places (k, 2) [m] along it."""
    path = ring.follow(ring.case.part.position[0], TURN)
    times = np.linspace(0.0, TURN, 18001)
    places = path.at(times).position
    angles = np.unwrap(np.arctan2(places[:, 1], places[:, 0]))
    end = int(np.argmax(angles > 2 * math.pi))
    assert end, "it does not get round"
    places = places[: end + 1]
    radii = MILLI * np.hypot(*places.T)
    line = (
        f"- A turn takes {times[end]:.2f} s or {times[end] * ring.rate / 2 / math.pi:.0f} cycles, "
        f"at {radii.min():.2f} to {radii.max():.2f} mm and {MILLI * around(places, times[: end + 1]):.2f} mm/s, "
        f"with {len(landings(path))} landings."
    )
    print(line, flush=True)
    return line, places


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
    alone = ring.driven(track=0.0)
    load, sunk = lift_off(alone)
    amplitudes, frequencies = over_amplitude(ring), over_frequency(ring)
    round_trip, way = turn(ring)
    shown = [f"{MILLI * frequencies[FREQUENCIES.index(frequency), 0]:.3f}" for frequency in SHOWN]
    resonance = f"- The speed follows the resonance: {', '.join(shown)} mm/s at {', '.join(map(str, SHOWN))} Hz."
    write(PAGE, "ring", [*on_track(ring), round_trip, leaving(ring), resonance])
    run, _, sliding = MILLI * amplitudes[LIFTS.index(LIFT)]
    write(
        PAGE,
        "ring-trust",
        [
            f"At {LIFT:g} of the load the wave alone carries the part at {run:.3f} mm/s, "
            f"and with hardly any friction would at {sliding:.3f} mm/s.",
            f"{purity(ring)} On the crest's circle the plate",
            f"accelerates by {sunk:.2f} m/s^2; by bisection a part comes off below a load of {load:.2f} m/s^2.",
            *convergence(ring.case),
        ],
    )
    draw(ring, way, amplitudes, frequencies)
    print(ring.field.crest, alone.lift, alone.creeps)


if __name__ == "__main__":
    main()
