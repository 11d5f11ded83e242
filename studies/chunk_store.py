"""The chunks of a sweep on disk: each a file that is there as a whole or not at all."""

from __future__ import annotations

import hashlib
import io
import os
from pathlib import Path

import numpy as np

from studies.record import KIND, Records

ENDING = ".chunk"


class ChunkStore:
    """A folder of finished chunks of one study, which is known by its key.

    A file holds the key, the hash of what follows, and the records. One of another study, or that is damaged, counts as
    none.
    """

    def __init__(self, folder: Path, key: str) -> None:
        self.folder, self._key = folder, bytes.fromhex(key)

    def load(self, chunk: int, length: int) -> Records | None:
        """The records of a chunk of a length; None: there are none."""
        try:
            content = self._file(chunk).read_bytes()
        except FileNotFoundError:
            return None
        size = len(self._key)
        key, digest, body = content[:size], content[size : 2 * size], content[2 * size :]
        if key != self._key or digest != hashlib.sha256(body).digest():
            return None
        records: Records = np.load(io.BytesIO(body))
        return records if records.shape == (length,) and records.dtype == KIND else None

    def save(self, chunk: int, records: Records) -> None:
        """Keeps the records of a chunk."""
        self.folder.mkdir(parents=True, exist_ok=True)
        buffer = io.BytesIO()
        np.save(buffer, records)
        body = buffer.getvalue()
        partial = self._file(chunk).with_suffix(f".{os.getpid()}.partial")
        partial.write_bytes(self._key + hashlib.sha256(body).digest() + body)
        os.replace(partial, self._file(chunk))

    def clear(self) -> None:
        """Removes all chunks, and the folder unless there is anything else in it."""
        if self.folder.is_dir():
            for file in [*self.folder.glob(f"*{ENDING}"), *self.folder.glob("*.partial")]:
                file.unlink()
            if not any(self.folder.iterdir()):
                self.folder.rmdir()

    def _file(self, chunk: int) -> Path:
        return self.folder / f"{chunk:08d}{ENDING}"
