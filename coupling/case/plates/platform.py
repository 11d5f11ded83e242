"""The platform of a case: a flat rigid surface, moved by drives along its axes or as it was measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal, NamedTuple

from pydantic import Discriminator, Field, Tag

from coupling.case.actuators import MIN_SPACING, Angles, DriveCase, SegmentCase
from coupling.case.table import Contradictions, Mistake, Table
from coupling.case.values import (
    AXES,
    Angle,
    Columns,
    FileBeside,
    MeasuredColumns,
    PositiveLength,
    Quantity,
    first_of,
    read_columns,
    tag,
    unreadable,
)

_FROM_FILE, _BY_DRIVES = tag("file"), tag("drives")
HEADER: Final = "time [ms], x [um], z [um]"
RATES: Final = {axis: (f"v{axis}", f"a{axis}") for axis in AXES}  # the columns of velocity and acceleration
QUANTITIES: Final = (
    {"time": Quantity("s", "50 ms")}
    | dict.fromkeys(AXES, Quantity("m", "150 um"))
    | {velocity: Quantity("m/s", "1 mm/s") for velocity, _ in RATES.values()}
    | {acceleration: Quantity("m/s^2", "1 m/s^2") for _, acceleration in RATES.values()}
)
MIN_ROWS: Final = 6  # rows: as many as a quintic has coefficients


class Measured(NamedTuple):
    """A measured motion: `time` in s from 0, and what was measured along the axes, in SI units."""

    time: tuple[float, ...]
    columns: Columns  # positions x, y and z, velocities vx, ..., accelerations ax, ...
    ignored: tuple[str, ...]  # cells of the header that name something else


class AxisCase(DriveCase):
    """What moves a platform along one axis."""

    owner: ClassVar[str] = "an axis"


class TurnSegmentCase(SegmentCase):
    """A part of a schedule of turns, in rad, Hz and s."""

    stroke: Angle | None = Field(default=None, examples=["5 deg"])
    """How far it goes from where it is; negative: the other way. Not with "hold"."""


class TurnCase(DriveCase):
    """What turns a platform about its origin: a drive whose heights are angles, in rad."""

    owner: ClassVar[str] = "a turn"
    height: ClassVar[str] = 'an angle such as "90 deg"'

    stroke: Angle | None = Field(default=None, examples=["5 deg"])
    """How far it turns, counter-clockwise; negative: clockwise."""
    table: Angles | None = Field(default=None, examples=[[["0 ms", "0 deg"], ["1 ms", "5 deg"], ["3 ms", "2 deg"]]])
    """Instead of a stroke: where it is at given times, with a smooth stroke from each to the next."""
    segments: tuple[TurnSegmentCase, ...] | None = None
    """Instead of a stroke: a schedule, one table after the other."""


class MotionCase(Table):
    """What moves a platform; along an axis that is not given it does not move."""

    x: AxisCase | None = None
    """The drive along x."""
    y: AxisCase | None = None
    """The drive along y."""
    z: AxisCase | None = None
    """The drive along z."""
    turn: TurnCase | None = None
    """The drive that turns it about the origin, under a part with a footprint."""


class PlatformCase(Table):
    """A flat rigid surface without end; without a motion it stands still."""

    shape: Literal["platform"]
    """No plate, but a flat rigid surface without end that moves as a whole."""
    motion: (
        Annotated[
            Annotated[FileBeside, Tag(_FROM_FILE)] | Annotated[MotionCase, Tag(_BY_DRIVES)],
            Discriminator(lambda value: _FROM_FILE if isinstance(value, str) else _BY_DRIVES),
        ]
        | None
    ) = Field(default=None, examples=["shaker.csv"])
    """What moves it: a CSV file of a measured motion beside the case file, or a table for each axis."""
    smoothing: PositiveLength | None = Field(default=None, examples=["0.1 um"])
    """How far positions in the file are from the motion, root mean square; without it the data say so."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if "smoothing" in given and not isinstance(given.get("motion"), str):
            yield "smoothing", 'must not be given without motion = "file.csv", the noise of whose positions it is'

    @cached_property
    def read_motion(self) -> tuple[Measured | None, list[str]]:
        """The measured motion of a file and what is wrong with that; None where there is none or it is wrong.

        Raises OSError when the file cannot be read.
        """
        if not isinstance(self.motion, str):
            return None, []
        file = read_columns(Path(self.motion), QUANTITIES, (["time"], AXES), HEADER)
        mistakes = file.mistakes or list(_mistakes(file))
        if mistakes:
            return None, mistakes
        columns = dict(file.columns)
        times = columns.pop("time")
        return Measured(tuple(time - times[0] for time in times), columns, file.ignored), []

    def mistakes(self, duration: float) -> Iterator[Mistake]:
        """Yield where its motion is wrong, and why, for a run of a duration [s]."""
        where = ("plate", "motion")
        try:
            measured, mistakes = self.read_motion
        except (OSError, ValueError) as error:
            yield where, unreadable(Path(str(self.motion)).name, error)
            return
        for mistake in mistakes:
            yield where, f"in {Path(str(self.motion)).name}: {mistake}"
        if measured and duration > measured.time[-1] * (1 + MIN_SPACING):
            message = f"must not exceed the measured motion's, {measured.time[-1]:g} s; got {duration:g} s"
            yield ("run", "duration"), message


def _mistakes(file: MeasuredColumns) -> Iterator[str]:
    """What is wrong with times and axes of columns that have no mistake by themselves."""
    times = file.columns["time"]
    for axis, rates in RATES.items():
        for name in rates:
            if name in file.columns and axis not in file.columns:
                yield f"must have a column {axis} beside {name}: positions say where the motion is"
    if len(times) < MIN_ROWS:
        yield f"must have at least {MIN_ROWS} rows below its header; got {len(times)}"
        return
    closest = MIN_SPACING * (max(times) - min(times))
    late = [k for k in range(1, len(times)) if times[k] - times[k - 1] <= closest]
    rule = "must have a later time than the row before"
    yield from first_of([f"line {file.lines[k]} {rule}; got {times[k]:g} s after {times[k - 1]:g} s" for k in late])
