"""Feasibility: where, and at which frequencies, the array of a case moves its part without losing it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from threadpoolctl import threadpool_limits

from active_surface.arrays import BoolArray, FloatArray
from active_surface.studies.feasibility.area import ACROSS, MAX_STROKES, Curves, Feasible, find_feasible, moving
from active_surface.studies.feasibility.faster import faster, find_feasible_anew
from active_surface.studies.frequency_range import range_fault
from coupling import (
    Progress,
    StretchedSurface,
    VibratingSurface,
    build_drives,
    build_friction,
    build_part,
    build_scene,
    shared_surface,
    silent,
    whole_file,
)
from coupling.case import Case, PlateCase
from coupling.ringing import RingingModel
from coupling.vibration import VibrationModel, always_running
from fem_plate import Shapes
from meshes import Outline
from particle import AnyDrive, SurfaceMotion, interruptible
from particle.drives import drive_table
from particle.events import horizon

if TYPE_CHECKING:
    import xarray


SPAN: Final = 0.25, 8.0  # times the case's own frequency
DEFAULTS: Final = "a quarter of the case's", "eight times the case's"
COUNT: Final = 31  # frequencies
STAGE: Final = "Looking where the part slips"


@dataclass(frozen=True, eq=False)
class Feasibility:
    """The feasible areas of a case, over frequencies (F,) [Hz] of its fastest drive.

    All drives run as many times as fast, whatever they are: times of tables and segments shrink as cycles do.
    """

    case: Case
    areas: Feasible
    frequency: float  # Hz, of the fastest drive in the case
    whole_window: float  # s, what the drives do until they repeat themselves, at most the run's duration
    outline: Outline
    actuators: FloatArray  # (N, 2) m

    @property
    def frequencies(self) -> FloatArray:
        """Hz, of the fastest drive: (F,)."""
        return self.areas.factors * self.frequency

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units; None: there is no such frequency."""
        areas = self.areas
        return {
            "frequency": self.frequency,
            "frequencies": self.frequencies[[0, -1]].tolist(),
            "window": areas.window,
            "whole_window": self.whole_window,
            "peak_area": areas.own.peak,
            "time_integral": areas.own.integral,
            "area_where_it_comes_off": areas.own.lost_area,
            "frequency_of_largest_peak_area": _top(self.frequencies, areas.feasible.peak),
            "largest_peak_area": float(areas.feasible.peak.max()),
            "frequency_of_largest_time_integral": _top(self.frequencies, areas.feasible.integral),
            "largest_time_integral": float(areas.feasible.integral.max()),
            "moves_it_from_between": _begins(self.frequencies, areas.slipping.peak > 0),
            "loses_it_from_between": _begins(self.frequencies, areas.lost_area > 0),
        }

    def dataset(self) -> xarray.Dataset:
        """All of it with labels."""
        import xarray

        areas, own = self.areas, self.areas.own
        slipping: Curves = areas.slipping
        return xarray.Dataset(
            {
                "peak_area": ("frequency", areas.feasible.peak, {"units": "m^2"}),
                "time_integral": ("frequency", areas.feasible.integral, {"units": "m^2 s"}),
                "slipping_peak_area": ("frequency", slipping.peak, {"units": "m^2"}),
                "slipping_time_integral": ("frequency", slipping.integral, {"units": "m^2 s"}),
                "lost_area": ("frequency", areas.lost_area, {"units": "m^2"}),
                "area": ("time", own.over_time, {"units": "m^2"}),
                "share": ("place", own.shares, {"units": "1", "long_name": "share of the window in which it slips"}),
                "lost": ("place", own.lost.astype(np.int8), {"long_name": "whether the part comes off at some time"}),
                "x": ("place", areas.points[:, 0], {"units": "m"}),
                "y": ("place", areas.points[:, 1], {"units": "m"}),
            },
            {
                "frequency": ("frequency", self.frequencies, {"units": "Hz", "long_name": "of the fastest drive"}),
                "time": ("time", areas.moments, {"units": "s"}),
            },
            {"case": self.case.source or "", "window": areas.window, "spacing": areas.spacing},
        )

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Writes NAME.feasibility.nc and NAME.feasibility.png into a folder; returns them."""
        from active_surface.studies.feasibility.picture import draw_feasibility

        folder.mkdir(parents=True, exist_ok=True)
        data = folder / f"{self.case.name}.feasibility.nc"
        with whole_file(data) as partial:
            self.dataset().to_netcdf(partial, engine="h5netcdf")
        return data, draw_feasibility(self, folder / f"{self.case.name}.feasibility.png")


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


def feasibility(
    case: Case,
    lowest: float | None = None,
    highest: float | None = None,
    across: int = ACROSS,
    progress: Progress = silent,
) -> Feasibility:
    """The feasible areas of a case.

    lowest, highest: Hz, the frequencies of its fastest drive that are looked at, by default a quarter of its own and
    eight times that; all times of all drives shrink likewise. Of segments the highest frequency counts, of a table
    that of strokes as short as its shortest, of a drive at rest none.  across: places along the plate's longer side.
    The window is what the drives do until they repeat themselves, at most the run's duration, and of that no more than
    `active_surface.studies.feasibility.area` looks at. A plate with inertia answers each frequency anew, in the steady
    state or from rest as `run.start` says; from rest the window is the run's beginning.
    Raises ValueError for a platform, drives of which none moves, numbers that make no sense, and a mode without damping
    that resonates in a steady state.
    """
    drives = _movers(case)
    wrong = []
    if not case.actuators:
        wrong.append("Input case of feasibility must have a plate on actuators; got a platform")
    frequency = max((drive.frequency for drive in drives), default=0.0)
    if case.actuators and not frequency:
        wrong.append("Input case of feasibility must have a drive that moves; got none")
    low = SPAN[0] * frequency if lowest is None else lowest
    high = SPAN[1] * frequency if highest is None else highest
    if not wrong and (fault := range_fault("feasibility", lowest, highest, low, high, DEFAULTS)):
        wrong.append(fault)
    if not 10 <= across <= 1000:
        wrong.append(f"Input across of feasibility must be in [10, 1000]; got {across}")
    if wrong:
        raise ValueError("; ".join(wrong))
    with threadpool_limits(limits=1, user_api="blas"):
        factors = np.geomspace(low, high, COUNT) / frequency
        find = _vibrating if isinstance(case.plate, PlateCase) and case.plate.inertia else _following
        areas, whole, shapes = find(case, drives, factors, across, progress)
    return Feasibility(case, areas, frequency, whole, shapes.outline, shapes.points)


def _following(
    case: Case, movers: Sequence[AnyDrive], factors: FloatArray, across: int, progress: Progress
) -> tuple[Feasible, float, Shapes]:
    """The areas on a plate that follows its actuators at once, the whole window [s], and the plate's shapes."""
    scene = build_scene(case, progress)
    assert scene.shapes
    whole, part = _window(case, movers), build_part(case)
    with progress(STAGE):
        areas = interruptible(
            find_feasible, scene.surface, scene.shapes.outline, part, build_friction(case), whole, factors,
            case.run.gravity, across,
        )  # fmt: skip
    return areas, whole, scene.shapes


def _vibrating(
    case: Case, movers: Sequence[AnyDrive], factors: FloatArray, across: int, progress: Progress
) -> tuple[Feasible, float, Shapes]:
    """The same on a plate with mass; its modes are chosen for all factors together."""
    drives = build_drives(case)
    if case.run.start == "steady":
        movers = [always_running(drive) for drive in movers]
    whole, stroke_time = _window(case, movers), min(drive.stroke_time for drive in movers)
    window = min(whole, MAX_STROKES * stroke_time)
    sets = [faster(drives, factor) for factor in [1.0, *factors.tolist()]]
    surface = shared_surface(case, sets, window / min(1.0, float(factors.min())), progress)
    assert isinstance(surface, (VibratingSurface, StretchedSurface))
    model = surface.model
    assert isinstance(model, (VibrationModel, RingingModel))

    def driven(factor: float) -> SurfaceMotion:
        return surface.until(window / factor).driven_by(faster(drives, factor))

    with progress(STAGE):
        areas = interruptible(
            find_feasible_anew, driven, model.chosen.modes.frequencies, stroke_time, model.shapes.outline,
            build_part(case), build_friction(case), whole, factors, case.run.gravity, across,
        )  # fmt: skip
    return areas, whole, model.shapes


def _window(case: Case, movers: Sequence[AnyDrive]) -> float:
    """What the drives do until they repeat themselves, at most the run's duration [s]."""
    until = horizon(drive_table(movers), 0.0)
    return case.run.duration if until is None else min(until, case.run.duration)


def _movers(case: Case) -> list[AnyDrive]:
    """The drives that move; the others have a frequency, too, which counts for nothing."""
    drives = build_drives(case)
    return [drive for drive, moves in zip(drives, moving(drive_table(drives)), strict=True) if moves]
