"""Identified: the cases whose paths are closest to tracks, and how well their fields are known."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.identification.estimate import Estimate, TrackFit
from active_surface.identification.track import Track
from common import draw, notebook_html, quantity_text
from coupling import check_free
from coupling.case import Case, write_case
from particle import Trajectory

if TYPE_CHECKING:
    import pandas

    from common import Axes, Figure

ALIKE: Final = 0.95  # a correlation of two fields that hardly differ in their effect


@dataclass(frozen=True, eq=False, repr=False)
class Identified:
    """The result of an identification.

    Parameters
    ----------
    fits : tuple of TrackFit
        Each track with its case and path.
    estimates : tuple of Estimate
        Each free field: those that tracks share, then track by track its own.
    correlation : (n, n) array
        Of the errors of the fields, by the slopes of the residuals.
    paths : int
        How many were followed.
    """

    fits: tuple[TrackFit, ...]
    estimates: tuple[Estimate, ...]
    correlation: FloatArray
    paths: int
    files: tuple[Path, ...] = field(default=())

    @property
    def case(self) -> Case:
        """The case of the only track; ValueError with several, whose cases are in `fits`."""
        return self._only.case

    @property
    def track(self) -> Track:
        """The only track; ValueError with several."""
        return self._only.track

    @property
    def trajectory(self) -> Trajectory:
        """The path of the only track; ValueError with several."""
        return self._only.trajectory

    @property
    def _only(self) -> TrackFit:
        if len(self.fits) > 1:
            raise ValueError(f"Input fits of Identified must be one; got {len(self.fits)}: take one of fits")
        return self.fits[0]

    @property
    def residuals(self) -> FloatArray:
        """Paths minus tracks (m,) [m], track by track."""
        return np.concatenate([fit.residuals for fit in self.fits])

    @property
    def residual(self) -> float:
        """Root mean square of the residuals [m]."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def table(self) -> pandas.DataFrame:
        """The fields with value, low, high, unit and whether the data determine them.

        Its index is the field; with own fields the field and the case whose own it is, "" of shared ones.
        """
        import pandas

        names = ("value", "low", "high", "unit", "determined")
        rows = [[getattr(one, name) for name in names] for one in self.estimates]
        index: pandas.Index[Any] = pandas.Index([one.field for one in self.estimates], name="field")
        if any(one.case for one in self.estimates):
            pairs = [(one.field, one.case or "") for one in self.estimates]
            index = pandas.MultiIndex.from_tuples(pairs, names=["field", "case"])
        return pandas.DataFrame(rows, index=index, columns=names)

    @property
    def alike(self) -> list[tuple[str, str, float]]:
        """Pairs of fields that the data hardly tell apart, with the correlation of their errors.

        Own fields of two tracks are left out: they are alike only as both are like a shared one.
        """
        found = []
        for i, j in zip(*np.triu_indices(len(self.estimates), 1), strict=True):
            first, second, r = self.estimates[i], self.estimates[j], float(self.correlation[i, j])
            if abs(r) > ALIKE and (first.case is None or first.case == second.case):
                found.append((first.label, second.label, r))
        return found

    def warnings(self) -> list[str]:
        """What limits the trust in it."""
        found = [
            f"{first} and {second} can hardly be distinguished: the correlation of their errors is {r:.3f}"
            for first, second, r in self.alike
        ]
        these = "this track" if len(self.fits) == 1 else "these tracks"
        found += [f"{one.label} is not determined by {these}" for one in self.estimates if not one.determined]
        for fit in self.fits:
            found += [f"{fit.name}: {text}" if len(self.fits) > 1 else text for text in fit.warnings()]
        return found

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        return {
            "fields": {one.label: {**vars(one), "determined": one.determined} for one in self.estimates},
            "correlation": self.correlation.tolist(),
            "tracks": {
                fit.name: {
                    "residual": fit.residual,
                    "heading_residual": fit.heading_residual,
                    "succession": fit.succession,
                    "measured": len(fit.residuals),
                }
                for fit in self.fits
            },
            "paths": self.paths,
            "warnings": self.warnings(),
        }

    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print."""
        rows = [("field", f"{one.label} = {one.text}") for one in self.estimates]
        for fit in self.fits:
            of = f" of {fit.name}" if len(self.fits) > 1 else ""
            size, headings = quantity_text(fit.residual, "m"), int(fit.track.measured[:, 2:].sum())
            count = f"{len(fit.residuals) - headings} places"
            if fit.heading_residual is not None:
                turn = f"{math.degrees(fit.heading_residual):.3g} deg"
                count += f" and {headings} headings as lengths, {turn} of these alone"
            rows.append(("residual", f"{size} root mean square of {count}{of}"))
        return [*rows, ("paths", str(self.paths))]

    def written(self, folder: Path, overwrite: bool = False) -> Identified:
        """The same with its files NAME_identified.toml, one for each case, and NAME_identified.png, named by the first.

        Raises ValueError where they exist and are not to be replaced.
        """
        from coupling.pictures import save_picture  # here, because it loads matplotlib

        cases = {fit.case.name: fit for fit in self.fits}
        *files, picture = free_files(folder, list(cases), overwrite)
        for file, fit in zip(files, cases.values(), strict=True):
            of = [one for one in self.estimates if one.case in (None, fit.name)]
            values = "\n".join(f"{one.field} = {one.text}" for one in of)
            write_case(fit.case, file, f"Fitted to a track:\n{values}")
        return replace(self, files=(*files, save_picture(draw(self), picture)))

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw tracks beside paths, over the plane and over time; with axes only over the plane, into these."""
        return draw(self, axes)

    def __repr__(self) -> str:
        found = "; ".join(f"{one.label} = {one.text}" for one in self.estimates)
        names = ", ".join(repr(fit.case.name) for fit in self.fits)
        return f"Identified {names}: {found}. Residuals of {quantity_text(self.residual, 'm')}"

    _repr_html_ = notebook_html


def names_of(names: Sequence[str], count: int) -> list[str]:
    """Names of a number of things, of which those with one name are numbered; one name stands for all."""
    many = list(names) * (count // len(names) if len(names) == 1 else 1)
    return [f"{name}_{number}" if many.count(name) > 1 else name for number, name in enumerate(many)]


def case_names(cases: Sequence[Case], tracks: int, own: bool) -> list[str]:
    """The names of identified cases: one for each case, or each track if those of one case have fields of their own."""
    return names_of([f"{case.name}_identified" for case in cases], tracks if own else len(cases))


def free_files(folder: Path, names: Sequence[str], overwrite: bool) -> list[Path]:
    """The files of identified cases, and the picture's; ValueError where they cannot be made or replaced."""
    files = [*(folder / f"{name}.toml" for name in names), folder / f"{names[0]}.png"]
    check_free(files, overwrite)
    return files
