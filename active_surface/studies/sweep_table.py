"""Table of a sweep: while it runs, the record of each finished path, found by a digest of what the path follows from.

A sweep that was stopped and a study that has grown find their finished paths by these keys. The table is an SQLite
file, whose commits survive a kill. Rows are appended; an index would scatter each commit over all of the file.
"""

from __future__ import annotations

import sqlite3
import zlib
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Final

import numpy as np

from active_surface.arrays import IntArray
from active_surface.studies.columns import KIND, Records

MADE_BY: Final = 0x41535357
"""SQLite's mark of the program that made a file."""
KEPT: Final = "finished paths are kept there, and the same command goes on from them"
TABLES: Final = (
    f"PRAGMA application_id = {MADE_BY}",
    "CREATE TABLE IF NOT EXISTS finished (key BLOB, record BLOB, checksum INTEGER, earlier INTEGER)",
    "DELETE FROM finished WHERE earlier OR record IS NULL OR checksum IS NOT crc32(record)",
    "DROP INDEX IF EXISTS by_key",
    "DROP TABLE IF EXISTS asked",
    "CREATE TABLE asked (number INTEGER PRIMARY KEY, key BLOB)",
)
IN_ORDER: Final = """\
SELECT record, checksum FROM asked LEFT JOIN finished
ON finished.rowid = (SELECT rowid FROM finished WHERE finished.key = asked.key LIMIT 1) ORDER BY number
"""


class SweepTable:
    """The paths that a study asks for, and those that are finished."""

    def __init__(self, database: sqlite3.Connection) -> None:
        self._database = database

    def ask(self, keys: Iterable[bytes]) -> None:
        """State the keys of all paths of the study, in the order of their numbers."""
        self._database.executemany("INSERT INTO asked VALUES (?, ?)", enumerate(keys))

    def keep(self, lots: Iterable[tuple[list[bytes], Records]]) -> tuple[int, int]:
        """Take over the keys and records of an earlier sweep.

        Returns how many paths of the study are among these, and how many of these are not in the study.
        """
        for keys, records in lots:
            rows = ((key, *row) for key, row in zip(keys, _rows(records), strict=True))
            self._database.executemany("INSERT INTO finished VALUES (?, ?, ?, TRUE)", rows)
        return (
            self._count("asked WHERE key IN (SELECT key FROM finished WHERE earlier)"),
            self._count("finished WHERE earlier AND key NOT IN (SELECT key FROM asked)"),
        )

    def missing(self) -> IntArray:
        """The numbers of the study's paths that are not finished."""
        rows = self._database.execute("SELECT number FROM asked WHERE key NOT IN (SELECT key FROM finished)")
        return np.fromiter((number for (number,) in rows), np.int64)

    def add(self, numbers: IntArray, records: Records) -> None:
        """Keep the records of finished paths of these numbers, safe on disk."""
        rows = ((*row, number) for row, number in zip(_rows(records), numbers.tolist(), strict=True))
        self._database.executemany("INSERT INTO finished SELECT key, ?, ?, FALSE FROM asked WHERE number = ?", rows)
        self.commit()

    def commit(self) -> None:
        """Write to disk what was done; what is not is undone when the table is closed."""
        self._database.execute("COMMIT")
        self._database.execute("BEGIN")

    def records(self, counts: Iterable[int]) -> Iterator[Records]:
        """Yield the records of all paths in order, so many at a time."""
        self._database.execute("CREATE INDEX by_key ON finished (key)")
        rows = self._database.execute(IN_ORDER)
        for count in counts:
            some = rows.fetchmany(count)
            if any(record is None or checksum != zlib.crc32(record) for record, checksum in some):
                raise sqlite3.DatabaseError
            yield np.frombuffer(b"".join(record for record, _ in some), KIND)

    def clear(self) -> None:
        """Drop the paths of the study, and those of an earlier sweep; other ones stay."""
        self._database.execute("DELETE FROM finished WHERE earlier OR key IN (SELECT key FROM asked)")
        self.commit()

    @property
    def empty(self) -> bool:
        """Whether no path is finished."""
        return not self._count("finished")

    def _count(self, rows: str) -> int:
        return int(self._database.execute(f"SELECT count(*) FROM {rows}").fetchone()[0])


def _rows(records: Records) -> Iterator[tuple[bytes, int]]:
    """Yield each record and its checksum."""
    for record in records:
        data = record.tobytes()
        yield data, zlib.crc32(data)


@contextmanager
def sweep_table(file: Path) -> Iterator[SweepTable]:
    """The table in a file, which this process alone uses until the block ends; folders are made if need be.

    An empty table leaves neither its file nor the folders that were made for it.

    Raises RuntimeError when another process uses the table, ValueError when the file is damaged or something else, and
    OSError, which names the file, when it cannot be read or written.
    """
    if file.is_dir():
        must = f"must have no folder {file.name}, as earlier versions made"
        raise ValueError(f"Input output {must}; got {file.parent}: remove the folder {file}")
    made = [folder for folder in file.parents if not folder.exists()]
    file.parent.mkdir(parents=True, exist_ok=True)
    unused = False
    try:
        with _sentences(file), closing(sqlite3.connect(file, timeout=0, isolation_level=None)) as database:
            database.create_function("crc32", 1, zlib.crc32, deterministic=True)
            database.execute("PRAGMA locking_mode = EXCLUSIVE")
            database.execute("BEGIN EXCLUSIVE")
            (maker,) = database.execute("PRAGMA application_id").fetchone()
            if maker != MADE_BY and database.execute("SELECT 1 FROM sqlite_master").fetchone():
                raise sqlite3.DatabaseError
            for statement in TABLES:
                database.execute(statement)
            table = SweepTable(database)
            table.commit()
            try:
                yield table
            finally:
                with suppress(sqlite3.Error, OSError):
                    database.rollback()
                    unused = table.empty
                    if unused:
                        file.unlink()  # while the lock keeps others out; Windows removes no open file
    finally:
        with suppress(OSError):
            if unused:
                file.unlink(missing_ok=True)
            for folder in made:
                folder.rmdir()


@contextmanager
def _sentences(file: Path) -> Iterator[None]:
    """Say what is wrong with the table in a file in one sentence."""
    try:
        yield
    except sqlite3.OperationalError as error:
        code = error.sqlite_errorcode & 0xFF
        removed = file.parent.is_dir() and not file.exists()  # by its last user, after it was opened here
        if code == sqlite3.SQLITE_BUSY or removed:
            raise RuntimeError(f"another sweep of this name is running in {file.parent}") from None
        kept = f"; {KEPT}" if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR) else ""
        raise OSError(f"{file}: {error}{kept}") from None
    except sqlite3.DatabaseError:
        what = "is damaged, or no file of finished paths"
        raise ValueError(f"{file}: {what}; move it away to compute all paths again") from None
