"""Fits: drives that follow measured motions, smooth except for impacts, and what was found on the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupling.measured.jumps import VELOCITY, find_kicks
from coupling.measured.series import NO_KICKS, ORDER, Motion, Series, noise_of, series_of, smoothed
from coupling.measured.smoothing import LEAST_LEFT, chosen, roughness_of, validation
from particle import AnyDrive, HermiteDrive
from particle.drives import QuinticDrive, Segments

FloatArray = NDArray[np.float64]

DEGREE = 5  # of the spline through positions without noise
ROUNDS = 4  # of smoothing and of kicks, each of which needs the other
SAME = 0.05  # steps: kicks that hardly move have settled
MIN_SAMPLES = 30  # of a series in which kicks are sought
GAP = 3.0  # median steps: a longer one is a gap
AROUND = 10.0  # steps on either side of a kick, in which kicks must lower the cross-validation
WORTH = 0.7  # of that without any kick: less of a gain may be chance, or a blow that lasts some samples


@dataclass(frozen=True)
class MotionFit:
    """How a drive follows what was measured along one axis."""

    axis: str
    rms: float  # m, root mean square of the differences from the positions
    largest: float  # m
    noise: float  # m, of the positions, as the smoothing that suits the data leaves it
    noise_acceleration: float  # m/s^2, root mean square of what such noise adds to the drive's acceleration
    velocity_noise: float | None = None  # m/s, of measured velocities
    acceleration_noise: float | None = None  # m/s^2, of measured accelerations
    cutoff: float | None = None  # Hz, where the smoothing leaves half; None: it goes through every position
    freedom: float | None = None  # degrees of freedom of the motion, of as many as there are samples
    samples: int = 0
    named: bool = False  # whether the case named the smoothing
    jumps: tuple[tuple[float, float], ...] = ()  # s and m/s: when the velocity jumps, and by how much
    gaps: int = 0  # steps of more than three times the median
    longest_step: float = 0.0  # s
    ignored: tuple[str, ...] = ()  # columns of the file that are of no use here


def fit_motion(
    axis: str,
    times: ArrayLike,
    positions: ArrayLike,
    smoothing: float | None = None,
    velocities: ArrayLike | None = None,
    accelerations: ArrayLike | None = None,
) -> tuple[AnyDrive, MotionFit]:
    """The drive that follows what was measured at increasing times (n,) [s] from 0, n at least 6, and how.

    It is the smoothing spline that penalises the square of the fifth derivative, but where the velocity, the
    acceleration or the jerk jumps; between samples quintics follow it. Generalised cross-validation says how smooth it
    is. Positions without noise to be seen, and without jumps, have a spline of degree five through all of them.

    smoothing: m, in place of that: the root mean square of the differences from the positions.
    velocities, accelerations: (n,) in m/s and m/s^2, each weighed by its own noise.
    """
    t = np.asarray(times, dtype=float)
    heights = np.asarray(positions, dtype=float)
    columns = [heights, *(None if one is None else np.asarray(one, dtype=float) for one in (velocities, accelerations))]
    series, kicks, roughness = found_motion(t, columns)
    noise = series.noise * series.scales
    if smoothing is not None:
        roughness = roughness_of(series, kicks, smoothing / series.unit)
    motion = smoothed(series, kicks, roughness)
    alone = velocities is None is accelerations and not len(kicks) and smoothing is None
    unseen = series.noise[0] <= 2 * series.least_noise[0] or motion.freedom[0] > (1 - LEAST_LEFT) * len(t)
    if alone and unseen:
        return _through(axis, t, heights)
    drive = _drive(series, motion)
    difference = drive.evaluate(t)[0] - heights
    steps = np.diff(t)
    return drive, MotionFit(
        axis,
        _rms(difference),
        float(np.abs(difference).max()),
        float(noise[0]),
        _shaken(series, kicks, roughness),
        None if velocities is None else float(noise[1]),
        None if accelerations is None else float(noise[2]),
        float(roughness ** (1 / (2 * ORDER)) / (2 * np.pi * series.step)),
        float(motion.freedom.sum()),
        len(t),
        smoothing is not None,
        _jumps(series, motion),
        int((steps > GAP * series.step).sum()),
        float(steps.max()),
    )


def found_motion(t: FloatArray, columns: Sequence[FloatArray | None]) -> tuple[Series, FloatArray, float]:
    """The series of samples, with the noise that was found, the kicks of its motion and its roughness.

    Kicks are kept where the motion with them follows the samples around them clearly better than the smooth motion.
    """
    smooth, smooth_roughness = chosen(series_of(t, columns), NO_KICKS)
    series, kicks, roughness = smooth, NO_KICKS, smooth_roughness
    for _ in range(ROUNDS):
        found = find_kicks(series, roughness) if len(t) >= MIN_SAMPLES else NO_KICKS
        if found.shape == kicks.shape and np.allclose(found, kicks, atol=SAME):
            break
        kicks = found
        series, roughness = chosen(series, kicks)
    if len(kicks):
        near = np.abs(series.time[:, None] - kicks[:, 0]).min(axis=1) <= AROUND
        with_kicks, without = (
            validation(smoothed(*one), smooth.noise, near)
            for one in ((series, kicks, roughness), (smooth, NO_KICKS, smooth_roughness))
        )
        if with_kicks > WORTH * without:
            return smooth, NO_KICKS, smooth_roughness
    return series, kicks, roughness


def _drive(series: Series, motion: Motion) -> QuinticDrive:
    """The drive of a motion: quintics between its nodes, twice differentiable from one kick to the next."""
    time, (before, after) = motion.nodes.time * series.step, (motion.out.before, motion.out.after)
    ends = [0, *np.flatnonzero(motion.nodes.kick.any(axis=1)), len(time) - 1]
    parts, shortest = [], np.inf
    for first, last in pairwise(dict.fromkeys(ends)):
        states = np.concatenate([after[first:last], before[last : last + 1]]) * series.scales
        smooth = HermiteDrive(time[first : last + 1] - time[first], *states.T)
        parts.append(smooth.segments())
        shortest = min(shortest, smooth.stroke_time)
    scale, rows = (np.concatenate([getattr(part, name) for part in parts]) for name in ("scale", "coefficients"))
    stroke_time = max(shortest, series.step)
    return QuinticDrive(Segments(time[:-1], scale, rows, 1.0), stroke_time, 0.5 / stroke_time if rows.any() else 0.0)


def _jumps(series: Series, motion: Motion) -> tuple[tuple[float, float], ...]:
    places = np.flatnonzero(motion.nodes.kick[:, VELOCITY])
    sizes = (motion.out.after - motion.out.before)[places, VELOCITY] * series.scales[VELOCITY]
    return tuple(zip((motion.nodes.time[places] * series.step).tolist(), sizes.tolist(), strict=True))


def _shaken(series: Series, kicks: FloatArray, roughness: float) -> float:
    """What noise alone makes of the acceleration [m/s^2], root mean square: the smoothing is linear."""
    normal = np.random.default_rng(0).standard_normal(series.value.shape) * series.noise
    noise = replace(series, value=np.where(series.measured, normal, np.nan))
    return _rms(smoothed(noise, kicks, roughness).out.after[:, 2]) * float(series.scales[2])


def _through(axis: str, t: FloatArray, h: FloatArray) -> tuple[AnyDrive, MotionFit]:
    """The spline through positions that have no noise that could be seen."""
    from scipy import interpolate  # here, because few cases have measured motions

    through = interpolate.make_interp_spline(t, h, DEGREE)
    time, step = np.unique(through.t), float(np.median(np.diff(t)))
    drive = HermiteDrive(time, *(through.derivative(k)(time) if k else through(time) for k in range(3)))
    difference = drive.evaluate(t)[0] - h
    noise = noise_of(h)
    spline = interpolate.make_interp_spline(t, noise * np.random.default_rng(0).standard_normal(len(t)), DEGREE)
    shaken = _rms(spline.derivative(2)(np.linspace(t[0], t[-1], 4 * len(t))))
    steps = np.diff(t)
    return drive, MotionFit(
        axis,
        _rms(difference),
        float(np.abs(difference).max()),
        noise,
        shaken,
        samples=len(t),
        gaps=int((steps > GAP * step).sum()),
        longest_step=float(steps.max()),
    )


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
