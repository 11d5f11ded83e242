"""Growth: which paths of a study are in the results of an earlier one already, matched by what they follow from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import IntArray
from active_surface.studies.axis import Axis
from active_surface.studies.points import DRAWN, contents_of, digests, earlier
from active_surface.studies.record import Records
from active_surface.studies.stored import Coordinates, differences, key_of, stored_coordinates, stored_records
from active_surface.studies.study import Study
from active_surface.studies.variants import heights_key
from coupling.case import find_field, lattice_of

MAY_DIFFER: Final = ["points"]
"""The traits in which two studies may differ and yet share paths."""


class Kept(NamedTuple):
    """Paths of a study that a file of results has."""

    numbers: IntArray  # (n,) in the study, ascending
    places: IntArray  # (n,) in the file
    lost: int = 0  # paths of the file that the study does not have
    whole: bool = True  # whether paths of the file can be kept at all

    def records(self, file: Path) -> Iterator[tuple[IntArray, Records]]:
        """Yield numbers of paths in the study and their records."""
        order = np.argsort(self.places, kind="stable")
        numbers, places = self.numbers[order], self.places[order]
        for start, records in stored_records(file) if len(order) else ():
            some = slice(*np.searchsorted(places, [start, start + len(records)]))
            yield numbers[some], records[places[some] - start]


NOTHING: Final = Kept(np.empty(0, np.int64), np.empty(0, np.int64), whole=False)


def kept_paths(study: Study, file: Path) -> Kept:
    """The paths of a study that the results in a file have, if there is one of the same case, files and versions."""
    if key_of(file) is None or differences(study, file) != MAY_DIFFER:
        return NOTHING
    stored = stored_coordinates(file)
    points, repeats = study.points, study.points.repeats
    if stored is None or stored.heights != heights_key(study) or stored.stream != points.stream:
        return NOTHING
    old = _identities(study, stored)
    places = {identity: place for place, identity in enumerate(old)}
    new = points.identities(range(len(points) // repeats))
    pairs = [(number, places[identity]) for number, identity in enumerate(new) if identity in places]
    shared = np.arange(min(repeats, stored.repeats))
    columns = np.array(pairs, np.int64).reshape(-1, 2).T[..., None]
    here = set(new)
    gone = sum(identity not in here for identity in old)
    return Kept(
        (columns[0] * repeats + shared).ravel(),
        (columns[1] * stored.repeats + shared).ravel(),
        gone * stored.repeats + (len(old) - gone) * (stored.repeats - len(shared)),
    )


def _identities(study: Study, stored: Coordinates) -> list[bytes]:
    """What tells the points of a file from others, as of `Points`."""
    lattice, _ = lattice_of(study.case)
    axes = [Axis("", find_field(study.case, lattice, field), ()) for field, _ in stored.axes]
    columns = [values for _, values in stored.axes]
    if stored.sampling == "grid":
        columns = [values.ravel() for values in np.meshgrid(*columns, indexing="ij")]
    contents, (jitter, _) = contents_of(axes, columns), stored.stream
    if jitter == 0 or stored.sampling == "grid":
        return digests(contents)
    return digests(contents, list(range(len(contents))) if stored.sampling in DRAWN else earlier(contents))
