"""TrackFit: one track beside the path that is closest to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.track import Track
from coupling.case import Case
from particle import Trajectory

TELLING: Final = 3.0  # standard deviations of the correlation of successive residuals that are independent
EARLY: Final = 1e-9  # of the track's end


@dataclass(frozen=True, eq=False)
class TrackFit:
    """One track, and the case whose path it is closest to.

    Parameters
    ----------
    name : str
        Of the case as it was, with a number where several tracks have one name.
    case : Case
        The case with the fields that were found.
    track : Track
        What it was fitted to.
    trajectory : Trajectory
        Its path, until the track ends.
    """

    name: str
    case: Case
    track: Track
    trajectory: Trajectory

    @property
    def away(self) -> FloatArray:
        """Path minus track (k, 2) [m]; nan where a place was not measured."""
        return np.asarray(self.trajectory.at(self.track.time).position - self.track.position)

    @property
    def residuals(self) -> FloatArray:
        """Path minus track (m,) [m]."""
        return self.away[np.isfinite(self.track.position)]

    @property
    def residual(self) -> float:
        """Root mean square of the residuals [m]."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def succession(self) -> float:
        """The correlation of each residual along x or y with the next; near 0 where they are noise."""
        away = np.nan_to_num(self.away)
        total = float((away**2).sum())
        return float((away[1:] * away[:-1]).sum() / total) if total else 0.0

    def warnings(self) -> list[str]:
        """What limits the trust in it."""
        told = []
        if self.succession > TELLING / np.sqrt(len(self.residuals)):
            told.append(
                f"residuals follow each other (correlation {self.succession:.2f}): the model leaves more than noise, "
                "and intervals are too narrow"
            )
        if self.trajectory.time[-1] < self.track.time[-1] * (1 - EARLY) and self.trajectory.at_rest_since is None:
            told.append(f"the path ends before the track: {self.trajectory.sentence}")
        return told
