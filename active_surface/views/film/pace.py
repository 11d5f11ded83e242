"""Pace: how the time of a run becomes that of a film."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from active_surface.arrays import FloatArray

LASTS = 8.0  # s, about, of a film without a wish
ROUND = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
MAX_FRAMES = 20_000
EACH_STORED = 4.0  # frames to a stored step, from which on most of a film is interpolated
WHOLE = 1e-6  # of a frame: a shorter rest has none of its own
MIN_FRAMES_PER_CYCLE = 6.0  # fewer do not show a cycle as one


@dataclass(frozen=True)
class Pace:
    """Frames a second, and seconds of film for each second of the run."""

    fps: float
    slow_motion: float
    times: FloatArray  # (F,) s of the run, one for each frame

    @property
    def lasts(self) -> float:
        """How long the film is, in s."""
        return len(self.times) / self.fps

    @property
    def words(self) -> str:
        """How fast the film is, in words."""
        if self.slow_motion == 1:
            return "in real time"
        if self.slow_motion > 1:
            return f"{self.slow_motion:.6g} times slower"
        return f"{1 / self.slow_motion:.6g} times faster"


def pace_of(time: FloatArray, fps: float, slow_motion: float | None) -> Pace:
    """The pace of a film of stored steps at times (k,) [s]; without a wish it lasts about 8 s.

    Its frames are equally far apart, except for the last, which is the run's end.
    fps, slow_motion: above 0.  Raises ValueError when they ask for too many frames.
    """
    begin, end = float(time[0]), float(time[-1])
    slower = slow_motion or (nearest_round(LASTS / (end - begin)) if end > begin else 1.0)
    frames = (end - begin) * slower * fps
    if frames >= MAX_FRAMES:
        raise ValueError(
            f"Input slow-motion must make a film of at most {MAX_FRAMES} frames; got {slower:.6g}, which makes "
            f"{frames:.6g} at {fps:g} frames a second of a run of {end - begin:.6g} s"
        )
    before_end = math.ceil(frames - WHOLE) if end > begin else 0
    return Pace(fps, slower, np.append(begin + np.arange(before_end) / (fps * slower), end))


def nearest_round(value: float) -> float:
    """The round number that is nearest to a positive value."""
    power = 10.0 ** math.floor(math.log10(value))
    return min(ROUND, key=lambda digits: abs(digits - value / power)) * power


def warnings_of(pace: Pace, time: FloatArray, cycle: float | None) -> list[str]:
    """What a film of stored steps at times (k,) [s] does not show; cycle: the time [s] of the fastest drive's."""
    warnings = []
    frames, steps = len(pace.times) - 1, len(time) - 1
    if steps and (time[-1] - time[0]) * pace.fps * pace.slow_motion < 1 - WHOLE:
        warnings.append("The run is shorter than a frame: only its ends are shown. A larger --slow-motion shows more.")
    if steps and frames > EACH_STORED * steps:
        warnings.append(
            f"The film has {frames / steps:.3g} frames to each stored step; what is between stored steps is "
            "interpolated linearly. A larger run.frames stores more."
        )
    if frames and cycle:
        per_cycle = cycle * pace.fps * pace.slow_motion
        if per_cycle < MIN_FRAMES_PER_CYCLE:
            warnings.append(
                f"The film has {per_cycle:.2g} frames per cycle of the fastest drive: fast motion looks slow, jumpy or "
                "still in it. A larger --slow-motion shows it."
            )
    return warnings
