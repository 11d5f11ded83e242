"""Measured motion: where a squeezed part ends on a shaker with impacts, from noisy samples, against the truth.

`python benchmarks/measured_motion.py [SEEDS]` prints the tables of docs/howto/measured-motion.md: the error of the end
with the smoothing that the program chooses, with the best one for all seeds (sought knowing the truth), and with a
spline through every sample; then how many impacts are found, what the search for them gains where a blow takes some
time, and how often motions without impacts get a jump. With --picture FILE it draws one such motion instead.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from coupling.measured import fit_motion
from coupling.measured.fit import _drive, found_motion
from coupling.measured.series import NO_KICKS, series_of, smoothed
from coupling.measured.smoothing import chosen
from particle import AnyDrive, CoulombAdhesion, HermiteDrive, Micropart, platform_surface, simulate
from particle.drives import QuinticDrive, Segments

FloatArray = NDArray[np.float64]

RATE, DURATION = 960, 1.0  # samples a second, s
NOISES = (2e-6, 5e-6, 10e-6, 20e-6, 40e-6)  # m
AMPLITUDE, IMPACTS, BLOWS = 1e-3, 10, 24  # m; in the second; that stand for one that takes some time
STAND, DAMPING = 2 * np.pi * 25.0, 0.1  # rad/s, of the stand that impacts set swinging
MASS, SQUEEZE, FRICTION = 2e-9, 1e-8, 0.6  # kg, N: friction bears 8.9 m/s^2
FACTORS = 10.0 ** np.arange(-3.0, 3.01, 0.5)  # of the roughness chosen
TIMES = np.arange(round(RATE * DURATION) + 1) / RATE


@dataclass(frozen=True)
class Shaker:
    """A sine of 20 to 50 Hz with impacts, each of which sets the stand swinging."""

    frequency: float  # Hz
    phase: float
    times: FloatArray  # (k,) s
    sizes: FloatArray  # (k,) m/s

    @classmethod
    def of(cls, seed: int, lasting: float = 0.0) -> Shaker:
        """One whose blows last some time [s]: each is BLOWS small impacts, spread as a half sine."""
        rng = np.random.default_rng(seed)
        times = np.sort(rng.uniform(0.03, DURATION - 0.03, IMPACTS))
        sizes = rng.choice([-1, 1], IMPACTS) * rng.uniform(0.1, 0.4, IMPACTS)
        frequency, phase = rng.uniform(20, 50), rng.uniform(0, 2 * np.pi)
        if lasting:
            share = np.arccos(1 - 2 * (np.arange(BLOWS) + 0.5) / BLOWS) / np.pi
            spread = (times[:, None] + lasting * share).ravel()
            times, sizes = spread[order := np.argsort(spread)], np.repeat(sizes / BLOWS, BLOWS)[order]
        return cls(frequency, phase, times, sizes)

    def __call__(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, velocity and acceleration at times (n,)."""
        rate = 2 * np.pi * self.frequency
        swing = STAND * np.sqrt(1 - DAMPING**2)
        moving = AMPLITUDE * np.exp(1j * (rate * t + self.phase)) * (1j * rate) ** np.arange(3)[:, None]
        rows = moving.imag
        root = -DAMPING * STAND + 1j * swing
        for time, size in zip(self.times, self.sizes, strict=True):
            since = np.maximum(t - time, 0.0)
            rows += np.where(t >= time, (size / swing * np.exp(root * since) * root ** np.arange(3)[:, None]).imag, 0.0)
        return rows[0], rows[1], rows[2]

    def drive(self) -> QuinticDrive:
        """The motion in pieces of a quarter of a millisecond at most, which jump where it does."""
        parts, edges = [], np.concatenate([[0.0], self.times, [DURATION]])
        for first, last in zip(edges[:-1], edges[1:], strict=True):
            inside = np.linspace(first, last, int((last - first) / 2.5e-4) + 2)
            rows = self((inside * (1 + 1e-15)).clip(None, np.nextafter(last, first)))
            parts.append((first, HermiteDrive(inside - first, *rows).segments()))
        start = np.concatenate([first + part.start for first, part in parts])
        scale, rows = (np.concatenate([getattr(part, name) for _, part in parts]) for name in ("scale", "coefficients"))
        return QuinticDrive(Segments(start, scale, rows, 1.0), 0.5 / self.frequency, self.frequency)


def end(drive: AnyDrive) -> float:
    """Where the part ends, in m from the platform."""
    surface = platform_surface(drive, None, None, 2 * AMPLITUDE)
    part = Micropart(mass=MASS, position=(0.0, 0.0), squeeze=SQUEEZE)
    return float(simulate(surface, part, CoulombAdhesion(FRICTION), DURATION, tolerance=1e-8).position[-1, 0])


def errors(noise: float, seeds: Sequence[int]) -> tuple[FloatArray, FloatArray, FloatArray, int, int]:
    """Errors of the end as chosen (n,), by each factor (n, F), by a spline through all (n,); impacts found, false."""
    chosen, by_factor, through, found, false = [], [], [], 0, 0
    for seed in seeds:
        shaker = Shaker.of(seed)
        truth = end(shaker.drive())
        samples = shaker(TIMES)[0] + np.random.default_rng(seed + 1000).normal(0, noise, len(TIMES))
        series, kicks, roughness = found_motion(TIMES, [samples, None, None])
        drives = [_drive(series, smoothed(series, kicks, roughness * factor)) for factor in FACTORS]
        ends = np.array([end(drive) for drive in drives]) - truth
        by_factor.append(np.abs(ends))
        chosen.append(by_factor[-1][np.argmin(np.abs(FACTORS - 1))])
        spline = make_interp_spline(TIMES, samples, 5)
        rough = HermiteDrive(TIMES, *(spline.derivative(k)(TIMES) if k else spline(TIMES) for k in range(3)))
        through.append(abs(end(rough) - truth))
        jumps = kicks[kicks[:, 1] == 1, 0] * series.step
        near = np.abs(jumps[:, None] - shaker.times) < 2 / RATE
        found, false = found + int(near.any(axis=0).sum()), false + int((~near.any(axis=1)).sum())
    return np.array(chosen), np.array(by_factor), np.array(through), found, false


def gains(noise: float, lasting: float, seeds: Sequence[int]) -> tuple[float, float]:
    """The mean error of the end [m] with the search for impacts and without it, where blows last some time [s]."""
    found = []
    for seed in seeds:
        shaker = Shaker.of(seed, lasting)
        truth = end(shaker.drive())
        samples = shaker(TIMES)[0] + np.random.default_rng(seed + 1000).normal(0, noise, len(TIMES))
        searched = found_motion(TIMES, [samples, None, None])
        series, roughness = chosen(series_of(TIMES, [samples, None, None]), NO_KICKS)
        fits = (searched, (series, NO_KICKS, roughness))
        found.append([abs(end(_drive(fit[0], smoothed(*fit))) - truth) for fit in fits])
    with_search, without = np.mean(found, axis=0)
    return float(with_search), float(without)


def interval(chosen: FloatArray, by_factor: FloatArray) -> tuple[float, float]:
    """What 95 % of the ratios of medians lie between, by the bootstrap over motions, each with its own best factor."""
    rng, ratios = np.random.default_rng(0), []
    for _ in range(2000):
        drawn = rng.integers(0, len(chosen), len(chosen))
        ratios.append(np.median(chosen[drawn]) / np.median(by_factor[drawn], axis=0).min())
    low, high = np.percentile(ratios, (2.5, 97.5))
    return float(low), float(high)


def strokes(rng: np.random.Generator, frequency: float, share: float) -> FloatArray:
    """Up and down by 1, each in a share of half a period (n,): the jerk jumps at both ends."""
    turn = (TIMES * frequency + rng.uniform(0, 1)) % 1
    up, down = np.clip(2 * turn / share, 0, 1), np.clip((2 * turn - 1) / share, 0, 1)
    return up**3 * (10 - 15 * up + 6 * up**2) - down**3 * (10 - 15 * down + 6 * down**2)


SMOOTH: dict[str, Callable[[np.random.Generator], FloatArray]] = {
    "sines of 20 to 50 Hz": lambda rng: np.sin(2 * np.pi * rng.uniform(20, 50) * TIMES + rng.uniform(0, 6)),
    "eight sines of 5 to 60 Hz": lambda rng: sum(
        0.2 * np.sin(2 * np.pi * rng.uniform(5, 60) * TIMES + rng.uniform(0, 6)) for _ in range(8)
    ),
    "a chirp of 5 to 85 Hz": lambda rng: np.sin(2 * np.pi * (5 * TIMES + 40 * TIMES**2) + rng.uniform(0, 6)),
    "nothing moves": lambda rng: 0 * TIMES,
    "strokes up and down at 10 Hz": lambda rng: strokes(rng, 10.0, 1.0),
    "strokes up and down at 30 Hz, with dwells": lambda rng: strokes(rng, 30.0, 0.5),
}


def main(seeds: int) -> None:
    print(
        "| noise | median, chosen | best | ratio | 90 %, chosen | best | ratio | median through all | found | false "
        "| ratio of medians, 95 % |"
    )
    for noise in NOISES:
        chosen, by_factor, through, found, false = errors(noise, range(seeds))
        cells = [f"{1e6 * noise:.0f} um"]
        for share in (50, 90):
            one, best = np.percentile(chosen, share), np.percentile(by_factor, share, axis=0).min()
            cells += [f"{1e6 * one:.1f} um", f"{1e6 * best:.1f} um", f"{one / best:.2f}"]
        cells += [f"{1e6 * np.median(through):.0f} um", f"{found} of {seeds * IMPACTS}", str(false)]
        cells.append("{:.2f} to {:.2f}".format(*interval(chosen, by_factor)))
        print("| " + " | ".join(cells) + " |", flush=True)
    print("\n| noise | a blow lasts | mean error with the search | without it |")
    for noise in (2e-6, 10e-6):
        for lasting in (0.0, 1e-3, 2e-3, 3e-3, 4e-3):
            with_search, without = gains(noise, lasting, range(seeds))
            errors_of = f"{1e6 * with_search:.0f} um | {1e6 * without:.0f} um"
            print(f"| {1e6 * noise:.0f} um | {1e3 * lasting:.0f} ms | {errors_of} |", flush=True)
    print("\n| motion of 1 mm without impacts | noise | series with a jump |")
    for name, motion in SMOOTH.items():
        for noise in (2e-6, 10e-6, 40e-6):
            jumped = 0
            for seed in range(5 * seeds):
                rng = np.random.default_rng(seed)
                samples = AMPLITUDE * motion(rng) + rng.normal(0, noise, len(TIMES))
                jumped += bool(fit_motion("x", TIMES, samples)[1].jumps)
            print(f"| {name} | {1e6 * noise:.0f} um | {jumped} of {5 * seeds} |", flush=True)


def draw(file: str) -> None:
    """The velocity of one motion with noise of 10 um: as it was, as found and by a spline through every sample."""
    import matplotlib.pyplot as plt

    shaker = Shaker.of(3)
    samples = shaker(TIMES)[0] + np.random.default_rng(1003).normal(0, 10e-6, len(TIMES))
    drive, fit = fit_motion("x", TIMES, samples)
    rough = make_interp_spline(TIMES, samples, 5).derivative(1)
    times = np.linspace(0, 0.4, 8001)
    figure, axes = plt.subplots(figsize=(8, 3.6), layout="constrained")
    axes.plot(1e3 * times, rough(times), color="0.8", linewidth=0.8, label="spline through every sample")
    axes.plot(1e3 * times, shaker(times)[1], color="#1f5fa8", linewidth=2.4, label="truth")
    axes.plot(1e3 * times, drive.evaluate(times)[1], color="#d1662b", linewidth=1.2, label="measured motion")
    for k, time in enumerate(time for time, _ in fit.jumps if time < 0.4):
        axes.axvline(1e3 * time, color="0.5", linewidth=0.8, linestyle=":", label=None if k else "impact found")
    axes.set(xlabel="time [ms]", ylabel="velocity [m/s]", xlim=(0, 400), ylim=(-0.9, 0.9))
    axes.legend(loc="upper right", ncols=2, fontsize="small")
    figure.savefig(file, dpi=110)


if __name__ == "__main__":
    if "--picture" in sys.argv:
        draw(sys.argv[-1])
    else:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
