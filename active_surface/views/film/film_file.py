"""Film file: MP4, GIF, or a folder of PNG pictures; it has its name only once it is complete."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from tempfile import TemporaryFile
from typing import IO, Protocol

import numpy as np
from PIL import Image as Pictures

from active_surface.arrays import Image
from coupling import whole_file

FORMATS = ("mp4", "gif", "png")
# Settings of ffmpeg: H.264 as every viewer plays it, with no loss that is seen; a GIF whose 256 colours are chosen for
# the whole film.
H264 = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-preset", "medium", "-movflags", "+faststart"]
COLOURS = "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a"
ENCODERS = {"mp4": H264, "gif": ["-filter_complex", COLOURS]}
MAX_GIF_FPS = 50  # viewers slow down faster films
MAX_GIF_FRAMES = 600  # which are all in memory
PICTURE = re.compile(r"\d{5}\.png")


class Writer(Protocol):
    """Takes the frames one after the other."""

    def add(self, image: Image) -> None:
        """Add the picture (height, width, 3) of the next frame."""

    def end(self) -> None:
        """Put down what is not yet written."""

    def drop(self) -> None:
        """Let go of what is open; what was written will be thrown away."""


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
    """Raises ValueError when a film cannot be written so, with all that is wrong: better before the work than after."""
    mistakes = []
    if kind == "mp4" and any(side % 2 for side in size):
        mistakes.append(f"Input size must be even numbers for mp4; got {size[0]}x{size[1]}")
    if kind == "gif" and fps > MAX_GIF_FPS:
        mistakes.append(f"Input fps must be at most {MAX_GIF_FPS} for gif; got {fps:g}")
    if kind == "gif" and frames > MAX_GIF_FRAMES:
        mistakes.append(f"Input slow-motion must make at most {MAX_GIF_FRAMES} frames of a gif; got {frames}")
    if kind == "png" and path.exists() and not _ours(path):
        mistakes.append(f"Input output must be a new folder or one of frames; got {path}, which has something else")
    if kind != "png" and path.is_dir():
        mistakes.append(f"Input output must be a file; got {path}, which is a folder")
    if mistakes:
        raise ValueError("\n".join(mistakes))


@contextmanager
def film_file(path: Path, kind: str, size: tuple[int, int], fps: float) -> Iterator[Writer]:
    """Write a film that replaces `path` as a whole when the `with` block ends well.

    Raises RuntimeError when there is no ffmpeg, OSError when the film cannot be written.
    """
    with whole_file(path.resolve(), replace=_replace_folder if kind == "png" else os.replace) as partial:
        writer: Writer = _Folder(partial) if kind == "png" else _Film(partial, kind, size, fps)
        try:
            yield writer
            writer.end()
        except BaseException:
            writer.drop()
            raise


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


class _Film:
    """A film by ffmpeg; its path is absolute, as ffmpeg would take others for options or protocols."""

    def __init__(self, path: Path, kind: str, size: tuple[int, int], fps: float) -> None:
        from imageio_ffmpeg import get_ffmpeg_exe

        frames = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}", "-r", f"{fps!r}", "-i", "-"]
        command = [get_ffmpeg_exe(), "-y", "-v", "error", *frames, *ENCODERS[kind], "-f", kind, f"file:{path}"]
        self._errors = TemporaryFile()  # noqa: SIM115
        # In a session of its own: Ctrl-C is for us, who then end it.
        self._ffmpeg = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=self._errors, start_new_session=True)

    def add(self, image: Image) -> None:
        try:
            self._pipe.write(np.ascontiguousarray(image).data)
        except BrokenPipeError:
            self.end()

    def end(self) -> None:
        with suppress(BrokenPipeError):
            self._pipe.close()
        self._ffmpeg.wait()
        self._errors.seek(0)
        text = self._errors.read().decode(errors="replace").strip()
        self._errors.close()
        if self._ffmpeg.returncode != 0:
            raise OSError(f"ffmpeg cannot write the film: {text or f'exit code {self._ffmpeg.returncode}'}")

    def drop(self) -> None:
        self._ffmpeg.kill()
        self._ffmpeg.wait()
        with suppress(BrokenPipeError):
            self._pipe.close()
        self._errors.close()

    @property
    def _pipe(self) -> IO[bytes]:
        assert self._ffmpeg.stdin is not None
        return self._ffmpeg.stdin


class _Folder:
    """Numbered pictures."""

    def __init__(self, path: Path) -> None:
        shutil.rmtree(path, ignore_errors=True)  # of a film that was killed
        path.mkdir()
        self._path, self._count = path, 0

    def add(self, image: Image) -> None:
        self._count += 1
        Pictures.fromarray(image).save(self._path / f"{self._count:05d}.png")

    def end(self) -> None:
        pass

    drop = end


def _ours(path: Path) -> bool:
    """Whether this is a folder that has nothing but frames."""
    return path.is_dir() and all(PICTURE.fullmatch(entry.name) for entry in path.iterdir())
