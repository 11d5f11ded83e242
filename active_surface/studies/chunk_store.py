"""The chunks of a sweep on disk: each a file that is there as a whole or not at all."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np

from active_surface.arrays import IntArray
from active_surface.studies.record import KIND, Records
from coupling import whole_file

ENDING = ".chunk"


class ChunkStore:
    """A folder of finished chunks of one study, which is known by its key.

    A file holds the key, the hash of what follows, the numbers of the paths, and their records. One of another study,
    or that is damaged, counts as none.
    """

    def __init__(self, folder: Path, key: str) -> None:
        self.folder, self._key = folder, bytes.fromhex(key)

    def load(self) -> Iterator[tuple[IntArray, Records]]:
        """Yield the numbers of the paths of each chunk, and their records."""
        for file in sorted(self.folder.glob(f"[0-9]*{ENDING}")):
            content, size = file.read_bytes(), len(self._key)
            key, digest, body = content[:size], content[size : 2 * size], content[2 * size :]
            if key != self._key or digest != hashlib.sha256(body).digest():
                continue
            buffer = io.BytesIO(body)
            numbers, records = np.load(buffer), np.load(buffer)
            if records.dtype == KIND and records.shape == numbers.shape:
                yield numbers, records

    def save(self, numbers: IntArray, records: Records) -> None:
        """Keep the records of paths of these ascending numbers; OSError, which names the folder, when it cannot."""
        buffer = io.BytesIO()
        np.save(buffer, numbers)
        np.save(buffer, records)
        body = buffer.getvalue()
        file = self.folder / f"{numbers[0]:010d}-{numbers[-1] + 1:010d}{ENDING}"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with whole_file(file) as partial:
                partial.write_bytes(self._key + hashlib.sha256(body).digest() + body)
        except OSError as error:
            kept = "finished chunks are kept there, and the same command goes on from them"
            raise OSError(f"{self.folder}: {error.strerror}; {kept}") from None

    def clear(self) -> None:
        """Remove all chunks, and the folder unless there is anything else in it."""
        for file in self.folder.glob(f"*{ENDING}"):  # partial ones, too
            file.unlink()
        with suppress(OSError):
            self.folder.rmdir()
