"""Animation: from a result to a film. This file reads as the pipeline.

run -> stage -> pace -> layout -> painter -> frames, each painted and captioned -> film file
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from active_surface.arrays import FloatArray, Image
from active_surface.views.film.camera import Camera, camera_of
from active_surface.views.film.captions import Captions
from active_surface.views.film.film_file import check_film, film_file, format_of
from active_surface.views.film.frames import frames_of
from active_surface.views.film.layout import layout_of, size_of
from active_surface.views.film.look import Look
from active_surface.views.film.pace import Pace, pace_of, warnings_of
from active_surface.views.film.painter import chosen, painter
from active_surface.views.film.stage import Stage, stage_of
from coupling import ProgressCallback, build_drives, check_folder, no_progress
from coupling.case import Case
from coupling.results import SavedRun, read_run

FPS = {"mp4": 30.0, "gif": 20.0, "png": 30.0}
SIZE = {"mp4": (1280, 720), "gif": (800, 450), "png": (1280, 720)}
HELP = "It needs OpenGL; Debian has it in libegl1 and libgl1-mesa-dri."


@dataclass(frozen=True)
class Animation:
    """A film that was made."""

    file: Path  # of PNG pictures their folder
    frames: int
    fps: float  # frames a second
    slow_motion: float  # seconds of film for each second of the run
    exaggeration: float  # of heights
    renderer: str
    warnings: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Everything, for JSON."""
        return vars(self) | {"file": str(self.file), "warnings": list(self.warnings)}


def animate(
    result: str | Path | SavedRun,
    output: str | Path | None = None,
    *,
    kind: str | None = None,
    camera: str | Camera = "iso",
    fps: float | None = None,
    slow_motion: float | None = None,
    exaggeration: float | None = None,
    size: str | tuple[int, int] | None = None,
    renderer: str = "auto",
    tell: ProgressCallback = no_progress,
) -> Animation:
    """Make a film of a run.

    Between stored steps heights are interpolated linearly. An older film of that name is replaced.

    Parameters
    ----------
    result : path or SavedRun
        One of the run's files, FOLDER/NAME, or what `read_run` returns.
    output : path, optional
        File of the film, or folder of its pictures; by default NAME.mp4 beside the result.
    kind : str, optional
        `"mp4"`, `"gif"` or `"png"`; by default the ending of `output`.
    camera : str or camera
        A name in `CAMERAS`, `"azimuth,elevation"` in degrees, or a camera.
    fps : float, optional
        Frames a second.
    slow_motion : float, optional
        Seconds of film for each second of the run; by default the film lasts about 8 s.
    exaggeration : float, optional
        Factor on heights; by default a round number that shows them.
    size : str or pair of int, optional
        `"WIDTHxHEIGHT"` in pixels, or the two numbers.
    renderer : str
        `"pyvista"`, `"matplotlib"`, or `"auto"`: pyvista where it can draw.
    tell : callable
        Called with the number of finished frames, and of all.

    Returns
    -------
    animation : Animation
        The film.

    Raises
    ------
    ValueError
        The result cannot be read, or an input is refused.
    OSError
        The film cannot be written.
    """
    tries = _Tries()
    form = tries(format_of, None if output is None else Path(output), kind) or "mp4"
    rate, pixels = FPS[form] if fps is None else fps, SIZE[form] if size is None else size
    view = tries(camera_of, camera)
    pixels = tries(size_of, pixels) or SIZE[form]
    for name, value in (("exaggeration", exaggeration), ("fps", rate), ("slow-motion", slow_motion)):
        tries(_check_positive, name, value)
    run = tries(_run_of, result)
    tries.end()
    path = _output(run, output, form)
    tries(check_folder, path.parent)
    pace = tries(pace_of, run.time, rate, slow_motion)
    tries(check_film, path, form, pixels, rate, len(pace.times) if pace else 0)
    chosen_renderer, reason = tries(chosen, renderer) or ("", None)
    tries.end()

    stage = stage_of(run)
    times = exaggeration or stage.exaggeration
    path.parent.mkdir(parents=True, exist_ok=True)
    with film_file(path, form, pixels, rate) as film:
        for k, image in enumerate(_images(stage, view, pixels, times, pace.times, pace, chosen_renderer)):
            film.add(image)
            tell(k + 1, len(pace.times))
    warnings = [] if reason is None else [f"pyvista cannot draw here, so matplotlib has: {reason}. {HELP}"]
    warnings += warnings_of(pace, run.time, _cycle(run.case))
    if not run.complete:
        warnings.append("The result is partial: its run was interrupted or has not ended. The film ends where it does.")
    return Animation(path, len(pace.times), rate, pace.slow_motion, times, chosen_renderer, tuple(warnings))


def still(
    result: str | Path | SavedRun,
    time: float,
    *,
    camera: str | Camera = "iso",
    exaggeration: float | None = None,
    size: str | tuple[int, int] = SIZE["png"],
    renderer: str = "auto",
) -> Image:
    """The picture (height, width, 3) of a film at a time [s]; otherwise as `animate`."""
    tries = _Tries()
    view, pixels = tries(camera_of, camera), tries(size_of, size)
    tries(_check_positive, "exaggeration", exaggeration)
    run = tries(_run_of, result)
    tries.end()
    if not run.time[0] <= time <= run.time[-1]:
        raise ValueError(f"Input time must be from {run.time[0]:g} to {run.time[-1]:g} s; got {time!r}")
    stage = stage_of(run)
    chosen_renderer, times = chosen(renderer)[0], exaggeration or stage.exaggeration
    return next(_images(stage, view, pixels, times, np.array([time]), None, chosen_renderer))


def _images(
    stage: Stage,
    camera: Camera,
    size: tuple[int, int],
    exaggeration: float,
    times: FloatArray,
    pace: Pace | None,
    renderer: str,
) -> Iterator[Image]:
    layout = layout_of(stage, camera, size, exaggeration)
    captions = Captions(stage, layout, pace)
    with painter(renderer, Look(stage, layout, stage.scale)) as drawn:
        for frame in frames_of(stage, times):
            yield captions.put_on(drawn.paint(frame), frame)


def _output(run: SavedRun, output: str | Path | None, form: str) -> Path:
    if output is None:
        name = f"{run.name}.frames" if form == "png" else f"{run.name}.{form}"
        return run.plate_path.with_name(name)
    path = Path(output)
    return path.with_suffix("") if form == "png" and path.suffix.lower() == ".png" else path


class _Tries:
    """Collects what is refused, to say it all at once."""

    def __init__(self) -> None:
        self._mistakes: list[str] = []

    def __call__(self, work: Callable[..., Any], *arguments: object) -> Any:
        """work(*arguments), or None where it is refused."""
        try:
            return work(*arguments)
        except ValueError as error:
            self._mistakes.append(str(error))
            return None

    def end(self) -> None:
        """Raises ValueError with all that was refused."""
        if self._mistakes:
            raise ValueError("\n".join(self._mistakes))


def _run_of(result: str | Path | SavedRun) -> SavedRun:
    return result if isinstance(result, SavedRun) else read_run(result)


def _check_positive(name: str, value: float | None) -> None:
    if value is not None and not (math.isfinite(value) and value > 0):
        raise ValueError(f"Input {name} must be a finite number above 0; got {value!r}")


def _cycle(case: Case) -> float | None:
    """The time [s] of a cycle of the fastest drive; None: there are no cycles."""
    fastest = max((drive.frequency for drive in build_drives(case)), default=0.0)
    return 1 / fastest if fastest > 0 else None
