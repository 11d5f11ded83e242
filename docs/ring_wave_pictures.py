"""The tables and the picture of docs/howto/ring.md: how fast a wave carries a part around a ring, and how exactly.

.venv/bin/python docs/ring_wave_pictures.py
"""

import cmath
import math
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from unittest.mock import patch

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from active_surface.studies.response import response
from coupling import build_drives, build_friction, build_part, build_surface, read_case, shared_surface
from coupling.case import Case
from particle import SurfaceMotion, Trajectory, simulate

DOCS = Path(__file__).parent
PAGE = DOCS / "howto/ring.md"
CASE = DOCS.parent / "examples/ring_wave.toml"
INNER = 5e-3  # m, forces within make the wave, those beyond the track
WAVES = 2  # around the ring
PLACES = 32  # on a circle, to split a motion into waves
RADII = np.linspace(5.0e-3, 7.2e-3, 12)  # m, of these circles
KEPT = 1e-4  # of the largest wave: lower ones are left out
LIFTS = (0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95)  # A w^2 over the load per mass, of the table
FREQUENCIES = (574, 588, 602, 616, 623, 630, 637, 644, 658, 672, 686)  # Hz, with a common period with the track's
SETTLED, CYCLES = 20, 80  # cycles of the wave that are left out, and the last one
STARTS = (5.4e-3, 6.2e-3, 7.0e-3)  # m from the centre
TURN, ON_TRACK = 9.0, 0.9  # s, longer than a turn; long enough to see whether parts stay on the track
SMALL = 3e-6  # m/s, below which friction fades in scipy's integration
G = 9.80665
MILLI, MICRO = 1e3, 1e6


def is_inner(case: Case) -> np.ndarray:
    """Which actuators make the wave."""
    return np.array([math.hypot(*one.position) < INNER for one in case.actuators])


@dataclass(frozen=True)
class Field:
    """The plate's motion in waves Im(p(r) exp(i (rate t + n angle))) with polynomials p, from frequency responses."""

    terms: tuple[tuple[float, int, np.ndarray, np.ndarray], ...]  # rate [1/s], n, p and its derivative [m, 1]

    def wave(self, radius: float, n: int) -> float:
        """The amplitude [m] of the lowest frequency's wave."""
        rate = min(term[0] for term in self.terms)
        return float(sum(abs(np.polyval(p, radius / INNER)) for r, m, p, _ in self.terms if (r, m) == (rate, n)))

    @cached_property
    def crest(self) -> float:
        """The radius [m] where the wave is largest."""
        radii = np.linspace(RADII[0], RADII[-1], 2201)
        return float(radii[np.argmax([self.wave(radius, -WAVES) for radius in radii])])

    def at(self, x: float, y: float, t: float) -> tuple[float, tuple[float, float], tuple[float, float]]:
        """w_tt [m/s^2], the slope and its second rate [1/s^2]."""
        radius, angle = math.hypot(x, y), math.atan2(y, x)
        w_tt, slope, bend = 0.0, 0j, 0j
        turn = cmath.exp(1j * angle)
        for rate, n, p, derivative in self.terms:
            phase = cmath.exp(1j * (rate * t + n * angle))
            value = _polynomial(p, radius) * phase
            along = (_polynomial(derivative, radius) * phase).imag + 1j * (1j * n * value).imag / radius
            w_tt -= rate**2 * value.imag
            slope += along * turn
            bend -= rate**2 * along * turn
        return w_tt, (slope.real, slope.imag), (bend.real, bend.imag)


def _polynomial(coefficients: np.ndarray, x: float) -> complex:
    value = 0j
    for coefficient in coefficients.tolist():
        value = value * (x / INNER) + coefficient
    return value


@dataclass(frozen=True)
class Responses:
    """How far circles of the plate follow each actuator, at the frequencies of the tables."""

    case: Case
    frequencies: np.ndarray
    values: np.ndarray  # (circles, places, actuators, frequencies)

    @staticmethod
    def of(case: Case) -> "Responses":
        angles = 2 * math.pi * np.arange(PLACES) / PLACES
        places = RADII[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        frequencies = np.array(sorted({*FREQUENCIES, *(one.frequency or 0.0 for one in case.actuators)}))
        values = response(case, places.reshape(-1, 2), frequencies).values
        return Responses(case, frequencies, values.reshape(len(RADII), PLACES, *values.shape[1:]))

    def field(self, case: Case) -> Field:
        """Of the example with other drives."""
        terms = []
        for inner in (True, False):
            forces = np.array([(one.force or 0.0) * np.exp(1j * one.phase) for one in case.actuators])
            chosen = is_inner(case) == inner
            frequency = next(one.frequency or 0.0 for one, at in zip(case.actuators, chosen, strict=True) if at)
            at = int(np.argmin(np.abs(self.frequencies - frequency)))
            waves = np.fft.fft(self.values[..., at] @ (forces * chosen), axis=1) / PLACES
            largest = np.abs(waves).max(axis=0)
            for n in np.flatnonzero(largest > max(KEPT * largest.max(), 1e-15)):
                p = np.polyfit(RADII / INNER, waves[:, n], 8)
                wave = int(n) if n < PLACES / 2 else int(n) - PLACES
                terms.append((2 * math.pi * frequency, wave, p, np.polyder(p) / INNER))
        return Field(tuple(terms))


@dataclass(frozen=True)
class Ring:
    """The example, also with other drives."""

    case: Case
    surface: SurfaceMotion
    responses: Responses

    @staticmethod
    def of(case: Case) -> "Ring":
        return Ring(case, shared_surface(case, [build_drives(case)], TURN), Responses.of(case))

    def driven(self, scale: float = 1.0, track: float = 1.0, frequency: float | None = None, way: int = 1) -> "Ring":
        """With the forces of wave and track scaled, another frequency [Hz] of the wave; way -1: it runs clockwise."""
        actuators = []
        for one, inner in zip(self.case.actuators, is_inner(self.case), strict=True):
            changes = {"force": (scale if inner else track) * (one.force or 0.0)}
            if inner:
                changes |= {"frequency": frequency or one.frequency or 0.0, "phase": way * one.phase}
            actuators.append(one.model_copy(update=changes))
        case = self.case.model_copy(update={"actuators": tuple(actuators)})
        return Ring(case, self.surface.driven_by(build_drives(case)), self.responses)

    @cached_property
    def field(self) -> Field:
        return self.responses.field(self.case)

    @property
    def rate(self) -> float:
        """Of the wave, 1/s."""
        return min(term[0] for term in self.field.terms)

    @property
    def load(self) -> float:
        """What presses the part on, over its mass [m/s^2]."""
        return G + self.case.part.squeeze / self.case.part.mass

    @property
    def lift(self) -> float:
        """The wave's acceleration on its crest over that: from 1 on the part comes off."""
        return self.field.wave(self.field.crest, -WAVES) * self.rate**2 / self.load

    @property
    def centre(self) -> float:
        """The height [m] of the part's centre of mass over the mid-plane."""
        return self.case.plate.thickness / 2 + self.case.part.centre_height  # type: ignore[union-attr]

    @property
    def creeps(self) -> float:
        """The `lift` from which a part at rest slips on the crest's circle."""
        friction = self.case.friction.coefficient or 0.0
        return friction / math.hypot(friction, self.centre * WAVES / self.field.crest)

    @property
    def sliding(self) -> float:
        """The speed [m/s] of a part with so little friction that its speed hardly changes over a cycle."""
        angle = brentq(lambda x: x - math.pi / 2 - self.lift * math.sin(x), math.pi / 2, math.pi)
        along = self.centre * WAVES / self.field.crest * self.field.wave(self.field.crest, -WAVES) * self.rate
        return -math.cos(angle) * along

    def follow(self, radius: float, end: float, tolerance: float | None = None) -> Trajectory:
        part, law, run = build_part(self.case, (radius, 0.0)), build_friction(self.case), self.case.run
        return simulate(self.surface, part, law, end, run.gravity, tolerance or run.tolerance, after_detachment="fly")

    def speed(self, radius: float) -> float:
        """The mean speed [m/s] around the ring, counter-clockwise, of a part that starts at a radius."""
        times = 2 * math.pi * np.array([SETTLED, CYCLES]) / self.rate
        return around(self.follow(radius, times[1]).at(times).position, times)

    def by_scipy(self, radius: float) -> float:
        """The same by scipy, for small slopes, over the waves of the frequency responses."""
        part, friction = self.case.part, self.case.friction.coefficient or 0.0

        def rates(t: float, state: np.ndarray) -> list[float]:
            x, y, vx, vy = state.tolist()
            w_tt, slope, bend = self.field.at(x, y, t)
            brake = friction * (self.load + w_tt) / math.sqrt(vx**2 + vy**2 + SMALL**2)
            ax, ay = (self.centre * b - s * (G + w_tt) for b, s in zip(bend, slope, strict=True))
            return [vx, vy, ax - brake * vx, ay - brake * vy]

        assert part.squeeze
        times = 2 * math.pi * np.array([SETTLED, CYCLES]) / self.rate
        start, options = (radius, 0.0, 0.0, 0.0), {"rtol": 1e-6, "atol": [1e-10, 1e-10, 1e-7, 1e-7]}
        result = solve_ivp(rates, (0.0, times[1]), start, "LSODA", times, max_step=0.3 / self.rate, **options)
        return around(result.y[:2].T, times)


def around(places: np.ndarray, times: np.ndarray) -> float:
    """The mean speed [m/s] around the ring from the first place to the last."""
    angles, radius = np.unwrap(np.arctan2(places[:, 1], places[:, 0])), np.hypot(*places.T).mean()
    return float(radius * (angles[-1] - angles[0]) / (times[-1] - times[0]))


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
    middle.legend(frameon=False)
    for column, style, text in ((1, "-", "scipy"), (0, "o", "run")):
        right.plot(FREQUENCIES, MILLI * frequencies[:, column], style, color="#1b4f9c", ms=5, label=text)
    right.set(xlabel="frequency of the wave [Hz]", ylabel="speed [mm/s]", title="on the track", ylim=(0.0, None))
    right.legend(frameon=False)
    figure.savefig(DOCS / "ring.png", dpi=90)


def write(page: Path, name: str, lines: list[str]) -> None:
    """Replaces what the page has between its marks of that name."""
    begin, end = f"<!-- {name}: generated -->", f"<!-- {name}: end -->"
    before, rest = page.read_text().split(begin)
    page.write_text(f"{before}{begin}\n\n" + "\n".join(lines) + f"\n\n{end}{rest.split(end)[1]}")


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
