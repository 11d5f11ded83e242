"""Result: what a feasibility has found, as figures, labelled data, a picture, and cases at its points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.studies.feasibility.area import Feasible
from active_surface.studies.feasibility.chart import Chart, Nearest, State
from active_surface.studies.feasibility.ground import Ground
from common import draw
from coupling import whole_file
from coupling.case import Case, scaled_case
from meshes import Outline

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class Feasibility:
    """Where the array of a case moves its part, over frequency and stroke and, if wanted, over the plate.

    All drives run as many times as fast, whatever they are: times of tables and segments shrink as cycles do. All
    strokes, heights and forces grow as much.
    """

    case: Case
    own: State  # of the case's own run
    chart: Chart  # of runs from the case's start, as long as the case's
    valid: FloatArray  # (columns of the chart,) factors of the strokes up to which the model is valid
    nearest: Nearest | None  # where a part that no point of the chart moves comes nearest to that
    areas: Feasible | None  # None: not asked for
    frequency: float  # Hz, of the fastest drive in the case
    stroke: float  # m or N, the largest in the case
    stroke_unit: str  # "m", or "N" where all actuators are forces
    whole_window: float  # s, what the drives do until they repeat themselves, at most the run's duration
    ground: Ground

    @property
    def outline(self) -> Outline:
        """The plate's rim."""
        return self.ground.outline

    @property
    def actuators(self) -> FloatArray:
        """Where they are, (N, 2) m."""
        return self.ground.actuators

    def at(self, frequency: float, stroke: float) -> Case:
        """The case with its fastest drive at a frequency [Hz] and its largest stroke [m or N], named NAME_picked."""
        scaled = scaled_case(self.case, frequency / self.frequency, stroke / self.stroke)
        return scaled.model_copy(update={"name": f"{self.case.name}_picked", "source": None})

    def state(self, frequency: float, stroke: float) -> State:
        """What a run of that case does: "rest", "moves", "lost", or "either" of the last two where borders are ragged.

        Raises ValueError for a frequency beyond those looked at.
        """
        return self.chart.state(frequency / self.frequency, stroke / self.stroke)

    def borders(self) -> tuple[FloatArray, ...]:
        """Frequencies (n,) [Hz]; strokes [m or N] from which the part slips, some run loses it, and all do."""
        columns = self.chart.columns
        rows = np.array([(one.frequency, one.slips, one.lost, one.all_lost) for one in columns])
        return rows[:, 0] * self.frequency, *(self.stroke * rows[:, 1:]).T

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units, those of areas where they were asked for; None: there is no such number."""
        columns = self.chart.columns
        return {
            "frequency": self.frequency,
            "frequencies": [columns[0].frequency * self.frequency, columns[-1].frequency * self.frequency],
            "stroke": self.stroke,
            "stroke_unit": self.stroke_unit,
            "duration": self.ground.duration,
            "whole_duration": self.case.run.duration,
            "at_the_case": {"state": self.own} | self._own(),
            "map": self._map(),
            "nearest": None if self.nearest is None else self.nearest._asdict(),
        } | ({} if self.areas is None else self._areas(self.areas))

    def _areas(self, areas: Feasible) -> dict[str, Any]:
        peaks, integrals, own = areas.feasible.peak, areas.feasible.integral, areas.own
        frequencies = areas.factors * self.frequency
        return {
            "window": areas.window,
            "whole_window": self.whole_window,
            "peak_area": own.peak,
            "time_integral": own.integral,
            "area_where_it_comes_off": own.lost_area,
            "frequency_of_largest_peak_area": _top(frequencies, peaks),
            "largest_peak_area": float(peaks.max()),
            "frequency_of_largest_time_integral": _top(frequencies, integrals),
            "largest_time_integral": float(integrals.max()),
            "moves_it_from_between": _begins(frequencies, areas.slipping.peak > 0),
            "loses_it_from_between": _begins(frequencies, areas.lost_area > 0),
            "areas_change_by": areas.errors.moments,
            "areas_differ_by_squares": areas.errors.squares,
        }

    def _own(self) -> dict[str, Any]:
        """The strokes of the borders at the case's own frequency, where that is on the chart; None: none looked at."""
        columns = self.chart.columns
        if not columns[0].frequency <= 1 <= columns[-1].frequency:
            return {}
        limits = self.chart.limits(1.0)
        return {
            "slips_from": _finite(self.stroke * limits.slips[0]),
            "lost_from": _finite(self.stroke * limits.lost[0]),
            "all_lost_from": _finite(self.stroke * limits.lost[1]),
            "valid_to": self.stroke * float(np.interp(0.0, np.log([k.frequency for k in columns]), self.valid)),
        }

    def _map(self) -> dict[str, Any]:
        """The borders by frequency; None: beyond the largest stroke looked at."""
        rows = [list(map(_finite, row.tolist())) for row in self.borders()]
        names = "frequencies", "slips_from", "lost_from", "all_lost_from"
        return dict(zip(names, rows, strict=True)) | {
            "strokes": [self.stroke * factor for factor in self.chart.strokes],
            "interpolated": [one.losses for one in self.chart.smooth],
            "runs": sum(len(one.runs) for one in self.chart.columns),
        }

    def dataset(self) -> xarray.Dataset:
        """All of it with labels."""
        import xarray

        frequencies, *borders = self.borders()
        texts = {
            "slips_from": "stroke from which the part slips",
            "lost_from": "stroke from which the first run loses it",
            "all_lost_from": "stroke from which the last does",
            "valid_to": "up to which the model is valid",
        }
        fastest = {"units": "Hz", "long_name": "of the fastest drive"}
        found = xarray.Dataset(
            {
                name: ("column", border, {"units": self.stroke_unit, "long_name": text})
                for (name, text), border in zip(texts.items(), [*borders, self.stroke * self.valid], strict=True)
            },
            {"column": ("column", frequencies, fastest)},
            {"case": self.case.source or ""},
        )
        if (areas := self.areas) is None:
            return found
        area, integral, own = {"units": "m^2"}, {"units": "m^2 s"}, areas.own
        return found.assign(
            peak_area=("frequency", areas.feasible.peak, area),
            time_integral=("frequency", areas.feasible.integral, integral),
            slipping_peak_area=("frequency", areas.slipping.peak, area),
            slipping_time_integral=("frequency", areas.slipping.integral, integral),
            lost_area=("frequency", areas.lost_area, area),
            area=("time", own.over_time, area),
            share=("place", own.shares, {"units": "1", "long_name": "share of the window in which it slips"}),
            lost=("place", own.lost.astype(np.int8), {"long_name": "whether the part comes off at some time"}),
            x=("place", areas.points[:, 0], {"units": "m"}),
            y=("place", areas.points[:, 1], {"units": "m"}),
            frequency=("frequency", areas.factors * self.frequency, fastest),
            time=("time", areas.moments, {"units": "s"}),
        ).assign_attrs(window=areas.window, spacing=areas.spacing)

    def write(self, folder: Path, picked: tuple[float, float] | None = None) -> tuple[Path, ...]:
        """Writes NAME.feasibility.nc and NAME.feasibility.png into a folder; returns them.

        picked: a frequency [Hz] and a stroke [m or N] to mark.
        """
        from coupling.pictures import save_picture  # here, because it loads matplotlib

        folder.mkdir(parents=True, exist_ok=True)
        data = folder / f"{self.case.name}.feasibility.nc"
        with whole_file(data) as partial:
            partial.write_bytes(self.dataset().to_netcdf(engine="h5netcdf"))
        return data, save_picture(draw(self, picked), folder / f"{self.case.name}.feasibility.png")


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _top(frequencies: FloatArray, values: FloatArray) -> float | None:
    return float(frequencies[np.argmax(values)]) if values.max() > 0 else None


def _begins(frequencies: FloatArray, holds: BoolArray) -> list[float | None] | None:
    """The neighbouring frequencies [Hz] between which something begins; the first is None if it holds at the lowest.

    None: it holds at none.
    """
    first = np.flatnonzero(holds)
    if not len(first):
        return None
    return [float(frequencies[first[0] - 1]) if first[0] else None, float(frequencies[first[0]])]
