"""What is found: an Estimate of each field with its interval, a TrackFit of each track with the closest path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.track import Track
from common import quantity_text
from coupling.case import Case
from particle import Trajectory

MOST_DIGITS: Final = 9
SIGNIFICANT: Final = 3.0  # standard deviations of the correlation of successive residuals that are independent
EARLY: Final = 1e-9  # of the track's end


@dataclass(frozen=True)
class Estimate:
    """A field with its 95 % interval by the profile of the likelihood."""

    field: str
    case: str | None  # whose own it is; None of a field that all tracks share
    unit: str  # SI, "1" of a plain number
    value: float  # in it
    low: float  # in it; a bound of the search where `open_low`
    high: float  # in it
    open_low: bool  # the data do not say how small it may be
    open_high: bool  # nor how large

    @property
    def label(self) -> str:
        """The field, with the case whose own it is."""
        return self.field if self.case is None else f"{self.field} of {self.case}"

    @property
    def determined(self) -> bool:
        """Whether the data bound it on either side."""
        return not (self.open_low and self.open_high)

    @property
    def text(self) -> str:
        """The value with its interval, in words."""
        value, low, high = (self._written(one) for one in (self.value, self.low, self.high))
        if not self.determined:
            return f"not determined: any value from {low} to {high} describes the track as well"
        if self.open_low or self.open_high:
            return f"{value}, at {f'most {high}' if self.open_low else f'least {low}'} (95 %)"
        return f"{value}, from {low} to {high} (95 %)"

    def _written(self, value: float) -> str:
        """A value with as many digits as tell the ends apart."""
        width = max(self.high - self.low, 1e-300)
        digits = int(np.clip(np.ceil(np.log10(max(abs(self.value) / width, 1.0))) + 2, 3, MOST_DIGITS))
        return f"{value:.{digits}g}" if self.unit == "1" else quantity_text(value, self.unit, digits)


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
        """Path minus track (k, 2) [m], with headings (k, 3), as lengths; nan where it was not measured."""
        return self.track.away(self.trajectory, self.case.part.gyration)

    @property
    def residuals(self) -> FloatArray:
        """Path minus track (m,) [m], headings as lengths."""
        return self.away[self.track.measured]

    @property
    def residual(self) -> float:
        """Root mean square of the residuals [m]."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def heading_residual(self) -> float | None:
        """Root mean square of the residuals of headings [rad]; None: they were not measured."""
        if self.track.heading is None:
            return None
        turns = self.away[:, 2] / self.track.lever(self.case.part.gyration)
        return float(np.sqrt(np.nanmean(turns**2)))

    @property
    def succession(self) -> float:
        """The correlation of each residual along x or y with the next; near 0 where they are noise."""
        away = np.nan_to_num(self.away)
        total = float((away**2).sum())
        return float((away[1:] * away[:-1]).sum() / total) if total else 0.0

    def warnings(self) -> list[str]:
        """What limits the trust in it."""
        found = []
        if self.succession > SIGNIFICANT / np.sqrt(len(self.residuals)):
            found.append(
                f"residuals follow each other (correlation {self.succession:.2f}): the model leaves more than noise, "
                "and intervals are too narrow"
            )
        if self.trajectory.time[-1] < self.track.time[-1] * (1 - EARLY) and self.trajectory.at_rest_since is None:
            found.append(f"the path ends before the track: {self.trajectory.sentence}")
        return found
