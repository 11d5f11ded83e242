"""Animation: from a result to a film. This file reads as the pipeline.

run -> pace -> scene -> layout -> moments, each painted and captioned -> film file
"""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from active_surface.arrays import FloatArray, Image
from active_surface.views.film.captions import Captions
from active_surface.views.film.film_file import check_film, film_file, format_of
from active_surface.views.film.layout import Layout, camera_of, layout_of, size_of
from active_surface.views.film.pace import Pace, pace_of, warnings_of
from active_surface.views.film.painter import Painter
from active_surface.views.film.scene import scene_of
from coupling import ProgressCallback, build_drives, check_folder, no_progress
from coupling.case import Case
from coupling.results import SavedRun, name_of, read_runs

FPS = {"mp4": 30.0, "gif": 20.0, "png": 30.0}
SIZE = {"mp4": (1280, 720), "gif": (800, 450), "png": (1280, 720)}


@dataclass(frozen=True)
class Animation:
    """A film that was made."""

    file: Path  # of PNG pictures their folder
    frames: int
    fps: float  # frames a second
    slow_motion: float  # seconds of film for each second of the run
    exaggeration: float  # of heights
    warnings: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Everything, for JSON."""
        return vars(self) | {"file": str(self.file), "warnings": list(self.warnings)}


def animate(
    result: str | Path | SavedRun,
    output: str | Path | None = None,
    *,
    kind: str | None = None,
    camera: str | tuple[float, float] = "iso",
    fps: float | None = None,
    slow_motion: float | None = None,
    exaggeration: float | None = None,
    size: str | tuple[int, int] | None = None,
    tell: ProgressCallback = no_progress,
) -> Animation:
    """Make a film of a run.

    Between stored steps heights are interpolated linearly. An older film of that name is replaced.

    Parameters
    ----------
    result : path or SavedRun
        One of the run's files, FOLDER/NAME, also of many parts, or what `read_run` returns.
    output : path, optional
        File of the film, or folder of its pictures; by default NAME.mp4 beside the result.
    kind : str, optional
        `"mp4"`, `"gif"` or `"png"`; by default the ending of `output`.
    camera : str or pair of float
        `"iso"`, `"top"`, `"front"`, `"side"`, `"azimuth,elevation"` in degrees, or the two numbers.
    fps : float, optional
        Frames a second.
    slow_motion : float, optional
        Seconds of film for each second of the run; by default the film lasts about 8 s.
    exaggeration : float, optional
        Factor on heights; by default a round number that shows them.
    size : str or pair of int, optional
        `"WIDTHxHEIGHT"` in pixels, or the two numbers.
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
    RuntimeError
        There is no OpenGL.
    """
    form = format_of(None if output is None else Path(output), kind)
    rate, pixels = FPS[form] if fps is None else fps, size_of(SIZE[form] if size is None else size)
    view = camera_of(camera)
    for name, value in (("exaggeration", exaggeration), ("fps", rate), ("slow-motion", slow_motion)):
        _check_positive(name, value)
    run, *others = _runs_of(result)
    path = _output(run, name_of(run.plate_path) if others else run.name, output, form)
    check_folder(path.parent)
    pace = pace_of(run.time, rate, slow_motion)
    check_film(path, form, pixels, rate, len(pace.times))
    layout = _layout([run, *others], view, pixels, exaggeration)
    images = _images(layout, pace.times, pace)
    first = next(images)  # before there is a file: there may be no OpenGL
    path.parent.mkdir(parents=True, exist_ok=True)
    with closing(images), film_file(path, form, pixels, rate) as add:
        for k, image in enumerate(chain([first], images)):
            add(image)
            tell(k + 1, len(pace.times))
    warnings = warnings_of(pace, run.time, _cycle(run.case))
    if not all(one.complete for one in (run, *others)):
        warnings.append("The result is partial: its run was interrupted or has not ended. The film ends where it does.")
    return Animation(path, len(pace.times), rate, pace.slow_motion, layout.exaggeration, tuple(warnings))


def still(
    result: str | Path | SavedRun,
    time: float,
    *,
    camera: str | tuple[float, float] = "iso",
    exaggeration: float | None = None,
    size: str | tuple[int, int] = SIZE["png"],
) -> Image:
    """The picture (height, width, 3) of a film at a time [s]; otherwise as `animate`."""
    view, pixels = camera_of(camera), size_of(size)
    _check_positive("exaggeration", exaggeration)
    run, *others = _runs_of(result)
    if not run.time[0] <= time <= run.time[-1]:
        raise ValueError(f"Input time must be from {run.time[0]:g} to {run.time[-1]:g} s; got {time!r}")
    with closing(_images(_layout([run, *others], view, pixels, exaggeration), np.array([time]), None)) as images:
        return next(images)


def _layout(
    runs: Sequence[SavedRun], view: tuple[float, float], size: tuple[int, int], exaggeration: float | None
) -> Layout:
    scene = scene_of(runs[0], runs[1:])
    return layout_of(scene, view, size, exaggeration or scene.exaggeration)


def _images(layout: Layout, times: FloatArray, pace: Pace | None) -> Generator[Image]:
    with closing(Painter(layout)) as painter:
        captions = Captions(layout, pace)
        for first, *others in zip(
            *(scene.moments(times) for scene in (layout.scene, *layout.scene.others)), strict=True
        ):
            yield captions.picture(painter.paint(first, others), first)


def _output(run: SavedRun, name: str, output: str | Path | None, form: str) -> Path:
    if output is None:
        return run.plate_path.with_name(f"{name}.frames" if form == "png" else f"{name}.{form}")
    path = Path(output)
    return path.with_suffix("") if form == "png" and path.suffix.lower() == ".png" else path


def _runs_of(result: str | Path | SavedRun) -> list[SavedRun]:
    """The runs of all parts, those that last longest first."""
    return [result] if isinstance(result, SavedRun) else sorted(read_runs(result), key=lambda run: -len(run.time))


def _check_positive(name: str, value: float | None) -> None:
    if value is not None and not (math.isfinite(value) and value > 0):
        raise ValueError(f"Input {name} must be a finite number above 0; got {value!r}")


def _cycle(case: Case) -> float | None:
    """The time [s] of a cycle of the fastest drive; None: there are no cycles."""
    fastest = max((drive.frequency for drive in build_drives(case)), default=0.0)
    return 1 / fastest if fastest > 0 else None
