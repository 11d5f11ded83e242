"""Identified: the case whose path is closest to a track, and how well its fields are known."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.track import Track
from coupling.case import Case, write_case
from meshes import quantity_text
from particle import Trajectory

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ALIKE: Final = 0.95  # a correlation that tells of two fields which hardly differ in what they do
TELLING: Final = 3.0  # standard deviations of the correlation of successive residuals that are independent
MOST_DIGITS: Final = 9
EARLY: Final = 1e-9  # of the track's end


@dataclass(frozen=True)
class Estimate:
    """A field with its 95 % interval by the profile of the likelihood."""

    field: str
    unit: str  # SI, "1" of a plain number
    value: float  # in it
    low: float  # in it; a bound of the search where `open_low`
    high: float  # in it
    open_low: bool  # the data do not say how small it may be
    open_high: bool  # nor how large

    @property
    def determined(self) -> bool:
        """Whether the data bound it on either side."""
        return not (self.open_low and self.open_high)

    @property
    def text(self) -> str:
        """The value with its interval, in words."""
        low, high = (self._written(value) for value in (self.low, self.high))
        if not self.determined:
            return f"not determined: any value from {low} to {high} describes the track as well"
        if self.open_low or self.open_high:
            return f"{self._written(self.value)}, at {f'most {high}' if self.open_low else f'least {low}'} (95 %)"
        return f"{self._written(self.value)}, from {low} to {high} (95 %)"

    def _written(self, value: float) -> str:
        """A value with as many digits as tell the ends apart."""
        size, width = abs(self.value), self.high - self.low
        digits = (
            MOST_DIGITS if not width else int(np.clip(np.ceil(np.log10(max(size / width, 1.0))) + 2, 3, MOST_DIGITS))
        )
        return f"{value:.{digits}g}" if self.unit == "1" else quantity_text(value, self.unit, digits)


@dataclass(frozen=True, eq=False, repr=False)
class Identified:
    """The result of an identification.

    Parameters
    ----------
    case : Case
        The case with the fields that were found.
    track : Track
        What it was fitted to.
    trajectory : Trajectory
        Its path, until the track ends.
    estimates : tuple of Estimate
        Each free field.
    correlation : (n, n) array
        Of the errors of the fields, by the slopes of the residuals.
    residuals : (m,) array
        Path minus track, m.
    paths : int
        How many were followed.
    """

    case: Case
    track: Track
    trajectory: Trajectory
    estimates: tuple[Estimate, ...]
    correlation: FloatArray
    residuals: FloatArray
    paths: int
    files: tuple[Path, ...] = field(default=())

    @property
    def residual(self) -> float:
        """Root mean square of the residuals [m]."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def succession(self) -> float:
        """The correlation of each residual along x or y with the next; near 0 where they are noise."""
        away = np.where(np.isfinite(self.track.position), self._away, 0.0)
        total = float((away**2).sum())
        return float((away[1:] * away[:-1]).sum() / total) if total else 0.0

    @property
    def _away(self) -> FloatArray:
        """Path minus track (k, 2) [m]."""
        return np.asarray(self.trajectory.at(self.track.time).position - self.track.position)

    @property
    def table(self) -> pandas.DataFrame:
        """The fields with value, low, high, unit and whether the data determine them."""
        import pandas

        names = ("value", "low", "high", "unit", "determined")
        rows = [[getattr(one, name) for name in names] for one in self.estimates]
        return pandas.DataFrame(
            rows, index=pandas.Index([one.field for one in self.estimates], name="field"), columns=names
        )

    @property
    def alike(self) -> list[tuple[str, str, float]]:
        """Pairs of fields that the data hardly tell apart, with the correlation of their errors."""
        names = [one.field for one in self.estimates]
        pairs = zip(*np.triu_indices(len(names), 1), strict=True)
        return [(names[i], names[j], float(r)) for i, j in pairs if abs(r := self.correlation[i, j]) > ALIKE]

    def warnings(self) -> list[str]:
        """What limits the trust in it."""
        told = [
            f"{first} and {second} can hardly be told apart: the correlation of their errors is {r:.3f}"
            for first, second, r in self.alike
        ]
        told += [f"{one.field} is not determined by this track" for one in self.estimates if not one.determined]
        if self.succession > TELLING / np.sqrt(len(self.residuals)):
            told.append(
                f"residuals follow each other (correlation {self.succession:.2f}): the model leaves more than noise, "
                "and intervals are too narrow"
            )
        if self.trajectory.time[-1] < self.track.time[-1] * (1 - EARLY) and self.trajectory.at_rest_since is None:
            told.append(f"the path ends before the track: {self.trajectory.sentence}")
        return told

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        return {
            "fields": {one.field: {**vars(one), "determined": one.determined} for one in self.estimates},
            "correlation": self.correlation.tolist(),
            "residual": self.residual,
            "succession": self.succession,
            "measured": len(self.residuals),
            "paths": self.paths,
            "warnings": self.warnings(),
        }

    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print."""
        rows = [("field", f"{one.field} = {one.text}") for one in self.estimates]
        rows.append(
            ("residual", f"{quantity_text(self.residual, 'm')} root mean square of {len(self.residuals)} places")
        )
        return [*rows, ("paths", str(self.paths))]

    def written(self, folder: Path, overwrite: bool = False) -> Identified:
        """The same with its files NAME_identified.toml and NAME_identified.png in a folder.

        Raises ValueError where they exist and are not to be replaced.
        """
        from active_surface.identification.picture import draw_identified

        file, picture = check_free(folder, self.case.name, overwrite)
        said = "\n".join(f"{one.field} = {one.text}" for one in self.estimates)
        case = write_case(self.case, file, f"Fitted to a track:\n{said}")
        return replace(self, files=(case, draw_identified(self, picture)))

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the track beside the path, over the plane and over time; with axes only over the plane, into these."""
        from active_surface.identification.picture import plot_identified  # here, as matplotlib is for pictures only

        return plot_identified(self, axes)

    def __repr__(self) -> str:
        found = "; ".join(f"{one.field} = {one.text}" for one in self.estimates)
        return f"Identified {self.case.name!r}: {found}. Residuals of {quantity_text(self.residual, 'm')}"

    def _repr_html_(self) -> str:
        from meshes import notebook_html

        return notebook_html(self)


def check_free(folder: Path, name: str, overwrite: bool) -> tuple[Path, Path]:
    """The files of an identified case; ValueError where they exist and are not to be replaced."""
    files = folder / f"{name}.toml", folder / f"{name}.png"
    if not overwrite and (there := [str(file) for file in files if file.exists()]):
        raise ValueError(
            f"Input output of identify must be free of an earlier result; got {', '.join(there)}: "
            "--overwrite replaces it"
        )
    return files
