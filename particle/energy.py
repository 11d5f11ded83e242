"""Energy: the ledger of a path, for people."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MIN_ENERGY = 1e-6


@dataclass(frozen=True, eq=False)
class Energy:
    """The energy ledger at the rows of a trajectory: kinetic + potential grow by work - dissipated."""

    kinetic: FloatArray = field(repr=False)  # (n,) J, seen by one at rest
    potential: FloatArray = field(repr=False)  # (n,) J, of gravity
    work: FloatArray = field(
        repr=False
    )  # (n,) J, done on the part by the moving surface (and what squeezes) since the start
    dissipated: FloatArray = field(repr=False)  # (n,) J, by friction and impacts since the start
    scale: float  # J, that of a part thrown across the surface in a stroke; a millionth of it counts as nothing

    @property
    def balance(self) -> float:
        """The largest gap in the ledger, relative to the largest of its entries: the path's own check."""
        total = self.kinetic + self.potential
        gap = total - total[0] - (self.work - self.dissipated)
        entries = (self.kinetic, self.potential - self.potential[0], self.work, self.dissipated)
        largest = max(float(np.abs(entry).max()) for entry in entries)
        return float(np.abs(gap).max()) / max(largest, MIN_ENERGY * self.scale)


def energy_of(rows: NDArray[Any], scale: float) -> Energy:
    """The energy ledger of a record's rows (n,); scale: J, as in `Energy`."""
    return Energy(rows["kinetic"], rows["potential"], rows["work"], rows["dissipated"], scale)
