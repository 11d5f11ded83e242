"""The chunks of a sweep on disk: each a file that is there as a whole or not at all."""

from __future__ import annotations

import hashlib
import io
from contextlib import suppress
from pathlib import Path

import numpy as np

from active_surface.studies.record import KIND, Records
from coupling import whole_file

ENDING = ".chunk"


class ChunkStore:
    """A folder of finished chunks of one study, which is known by its key.

    A file holds the key, the hash of what follows, and the records. One of another study, or that is damaged, counts as
    none.
    """

    def __init__(self, folder: Path, key: str) -> None:
        self.folder, self._key = folder, bytes.fromhex(key)

    def load(self, start: int, stop: int) -> Records | None:
        """The records of the paths from one to before another; None: there is no chunk of just these."""
        try:
            content = self._file(start, stop).read_bytes()
        except FileNotFoundError:
            return None
        size = len(self._key)
        key, digest, body = content[:size], content[size : 2 * size], content[2 * size :]
        if key != self._key or digest != hashlib.sha256(body).digest():
            return None
        records: Records = np.load(io.BytesIO(body))
        return records if records.shape == (stop - start,) and records.dtype == KIND else None

    def save(self, start: int, records: Records) -> None:
        """Keeps the records of the paths that begin with one; OSError, which names the folder, when it cannot."""
        buffer = io.BytesIO()
        np.save(buffer, records)
        body = buffer.getvalue()
        file = self._file(start, start + len(records))
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with whole_file(file) as partial:
                partial.write_bytes(self._key + hashlib.sha256(body).digest() + body)
        except OSError as error:
            kept = "finished chunks are kept there, and the same command goes on from them"
            raise OSError(f"{self.folder}: {error.strerror}; {kept}") from None

    def clear(self) -> None:
        """Removes all chunks, and the folder unless there is anything else in it."""
        for file in self.folder.glob(f"*{ENDING}"):  # partial ones, too
            file.unlink()
        with suppress(OSError):
            self.folder.rmdir()

    def _file(self, start: int, stop: int) -> Path:
        return self.folder / f"{start:010d}-{stop:010d}{ENDING}"
