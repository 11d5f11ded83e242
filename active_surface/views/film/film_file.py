"""Film file: MP4, GIF, or a folder of PNG pictures; it has its name only once it is complete."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from tempfile import TemporaryFile

import numpy as np

from active_surface.arrays import Image
from coupling import whole_file

FORMATS = ("mp4", "gif", "png")
# Settings of ffmpeg: H.264 as every viewer plays it, with no loss that is seen; a GIF whose 256 colours are chosen for
# the whole film; numbered pictures.
H264 = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-preset", "veryfast", "-movflags", "+faststart"]
COLOURS = "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a"
ENCODERS = {"mp4": [*H264, "-f", "mp4"], "gif": ["-filter_complex", COLOURS, "-f", "gif"], "png": ["-f", "image2"]}
MAX_GIF_FPS = 50  # viewers slow down faster films
MAX_GIF_FRAMES = 600  # which are all in memory
PICTURE, NUMBERED = re.compile(r"\d{5}\.png"), "%05d.png"


def format_of(output: Path | None, requested: str | None) -> str:
    """The requested format, or that of a name.

    Raises ValueError when there is none, or when the two differ.
    """
    ending = output.suffix.lower().removeprefix(".") if output else ""
    if requested not in (None, *FORMATS):
        raise ValueError(f"Input format must be {', '.join(FORMATS)}; got {requested!r}")
    if ending in FORMATS:
        if requested not in (None, ending):
            raise ValueError(f"Input format must be that of output; got {requested} for {output}")
        return ending
    if output and requested != "png":
        raise ValueError(f"Input output must end with {', '.join('.' + name for name in FORMATS)}; got {output}")
    return requested or "mp4"


def check_film(path: Path, kind: str, size: tuple[int, int], fps: float, frames: int) -> None:
    """Raises ValueError when a film cannot be written so: better before the work than after."""
    if kind == "mp4" and any(side % 2 for side in size):
        raise ValueError(f"Input size must be even numbers for mp4; got {size[0]}x{size[1]}")
    if kind == "gif" and fps > MAX_GIF_FPS:
        raise ValueError(f"Input fps must be at most {MAX_GIF_FPS} for gif; got {fps:g}")
    if kind == "gif" and frames > MAX_GIF_FRAMES:
        raise ValueError(f"Input slow-motion must make at most {MAX_GIF_FRAMES} frames of a gif; got {frames}")
    if kind == "png" and path.exists() and not _ours(path):
        raise ValueError(f"Input output must be a new folder or one of frames; got {path}, which has something else")
    if kind != "png" and path.is_dir():
        raise ValueError(f"Input output must be a file; got {path}, which is a folder")


@contextmanager
def film_file(path: Path, kind: str, size: tuple[int, int], fps: float) -> Iterator[Callable[[Image], None]]:
    """Write a film that replaces `path` as a whole when the `with` block ends well; it gets what takes the next frame.

    Raises OSError when the film cannot be written.
    """
    with whole_file(path.resolve(), replace=_replace_folder if kind == "png" else os.replace) as partial:
        if kind == "png":
            shutil.rmtree(partial, ignore_errors=True)  # of a film that was killed
            partial.mkdir()
        with _ffmpeg(partial, kind, size, fps) as add:
            yield add


@contextmanager
def _ffmpeg(path: Path, kind: str, size: tuple[int, int], fps: float) -> Iterator[Callable[[Image], None]]:
    """What takes frames for a film by ffmpeg, which runs in the folder of pictures so that its name has no pattern."""
    from imageio_ffmpeg import get_ffmpeg_exe

    frames = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-r", f"{fps!r}", "-i", "-"]
    name, folder = (NUMBERED, path) if kind == "png" else (path, path.parent)
    command = [get_ffmpeg_exe(), "-y", "-v", "error", *frames, *ENCODERS[kind], f"file:{name}"]
    with TemporaryFile() as errors:
        # In a session of its own: Ctrl-C is for us, who then end it.
        process = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=errors, cwd=folder, start_new_session=True)
        pipe = process.stdin
        assert pipe is not None

        def end() -> None:
            with suppress(BrokenPipeError):
                pipe.close()
            if process.wait() != 0:
                errors.seek(0)
                text = errors.read().decode(errors="replace").strip() or f"exit code {process.returncode}"
                raise OSError(f"ffmpeg cannot write the film: {text}")

        def add(image: Image) -> None:
            try:
                pipe.write(np.ascontiguousarray(image).data)
            except BrokenPipeError:
                end()

        try:
            yield add
            end()
        finally:
            process.kill()
            process.wait()
            with suppress(BrokenPipeError):
                pipe.close()


def _replace_folder(partial: Path, path: Path) -> None:
    """Put a folder of frames in place of an older one; raises OSError if others put something else there meanwhile."""
    if not path.exists():
        partial.replace(path)
        return
    older = path.with_name(f"{path.name}.{os.getpid()}.older")
    path.rename(older)
    if not _ours(older):
        older.rename(path)
        raise OSError(f"{path} has got something else than frames while the film was made; it stays as it is")
    try:
        partial.replace(path)
    except BaseException:
        older.rename(path)
        raise
    shutil.rmtree(older)


def _ours(path: Path) -> bool:
    """Whether this is a folder that has nothing but frames."""
    return path.is_dir() and all(PICTURE.fullmatch(entry.name) for entry in path.iterdir())
