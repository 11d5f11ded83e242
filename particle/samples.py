"""Samples: a part at moments of its path, for people, also as a dataset of xarray or a table of pandas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.modes import EventKind, Mode, State
from particle.types import FloatArray, IntArray

if TYPE_CHECKING:
    import pandas
    import xarray


COLUMNS: Final = {
    "x": ("m", "x of the part"),
    "y": ("m", "y of the part"),
    "z": ("m", "height of the surface under the part; in flight that of the part"),
    "vx": ("m/s", "velocity along x"),
    "vy": ("m/s", "velocity along y"),
    "vz": ("m/s", "velocity along z"),
    "normal_force": ("N", "net normal force of the contact"),
    "friction_force": ("N", "size of the friction"),
}
"""The columns of a path, but its state, with their units and meanings."""
FACE_COLUMNS: Final = {
    "heading": ("rad", "heading of the part, counter-clockwise from the plate's x"),
    "spin": ("rad/s", "rate of the heading"),
    "pressure_margin": ("1", "least pressure on the face over the mean; below 0 an edge lifts"),
    "gap": ("m", "mean gap under the part"),
    "air_force": ("N", "force of the film of air, a share of the normal force"),
}
"""Further columns of a part with a face, and of one on a film of air."""
EVENTS: Final = {"event_time": "s", "event_x": "m", "event_y": "m", "event_speed": "m/s", "event_load": "N"}
STATES: Final = ("stick", "slip", "flight")
"""The states by their number."""


@dataclass(frozen=True)
class Event:
    """One moment of a trajectory."""

    kind: EventKind
    time: float  # s
    position: tuple[float, float]  # m
    speed: float  # m/s, in the plane; at a landing that after it
    load: float  # N, net normal force
    heading: float | None = None  # rad, of a part with a face


class Samples(NamedTuple):
    """The part at k moments."""

    time: FloatArray  # (k,) s
    position: FloatArray  # (k, 2) m
    velocity: FloatArray  # (k, 2) m/s
    vertical_velocity: FloatArray  # (k,) m/s
    height: FloatArray  # (k,) m, that of the surface under it unless it flies
    normal_force: FloatArray  # (k,) N, net, of the contact
    friction_force: FloatArray  # (k,) N, its magnitude
    state: IntArray  # (k,) State
    heading: FloatArray | None = None  # (k,) rad, of a part with a face, as are these
    spin: FloatArray | None = None  # (k,) rad/s
    pressure_margin: FloatArray | None = None  # (k,) the least pressure on the face over the mean
    gap: FloatArray | None = None  # (k,) m, the mean under a part on a film of air
    air_force: FloatArray | None = None  # (k,) N, of the film, a share of the normal force

    def chosen(self, rows: Any) -> Samples:
        """Those of `rows`, an index or mask of numpy."""
        columns: Any = (None if column is None else column[rows] for column in self)
        return Samples(*columns)


class RoughContact(Protocol):
    """What `KogutEtsion` knows of the parts of its normal force."""

    @property
    def pull_off(self) -> float: ...

    @property
    def largest_load(self) -> float: ...

    def separation(self, net_load: ArrayLike) -> FloatArray: ...

    def forces(self, separation: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]: ...


class ContactSamples(NamedTuple):
    """Contact and centre of mass of a part in space at k moments, and the forces on it."""

    time: FloatArray  # (k,) s
    contact: FloatArray  # (k, 3) m, where it touches the surface; in flight the place that would touch
    centre: FloatArray  # (k, 3) m, its centre of mass
    normal: FloatArray  # (k, 3) the surface's normal, along which it stands: its attitude
    normal_force: FloatArray  # (k,) N, net, along the normal
    friction: FloatArray  # (k, 3) N, on the part
    pull: FloatArray  # (k,) m/s^2, along the surface, without friction, scaled to the flat law's limit; 0 in flight
    point_pull: FloatArray  # (k,) m/s^2, the same on a point of the mid-plane
    added_pull: FloatArray  # (k,) m/s^2, the difference, which the heights of contact and centre of mass make
    separation: FloatArray  # (k,) over the roughness, of a rough contact; nan in flight and without its law
    contact_load: FloatArray  # (k,) N, pressing its asperities; nan likewise
    adhesion: FloatArray  # (k,) N, holding against it; contact_load - adhesion is the normal force; nan likewise
    state: IntArray  # (k,) State
    bend_loss: FloatArray  # (k,) N, by how much the surface's curvature lessens the pull-off force (`LocalContact`)


def samples_of(rows: NDArray[Any], face: bool = False, film: bool = False) -> Samples:
    """The rows (k,) of a record, for people; face: of a part that has one; film: of a part on a film of air."""
    return Samples(
        time=rows["time"],
        position=np.column_stack([rows["x"], rows["y"]]),
        velocity=np.column_stack([rows["v_x"], rows["v_y"]]),
        vertical_velocity=rows["v_z"],
        height=rows["z"],
        normal_force=rows["load"],
        friction_force=rows["friction"],
        state=_states(rows),
        heading=rows["heading"] if face else None,
        spin=rows["spin"] if face else None,
        pressure_margin=rows["pressure"] if face else None,
        gap=rows["gap"] if film else None,
        air_force=rows["air"] if film else None,
    )


def _states(rows: NDArray[Any]) -> IntArray:
    return np.where(rows["mode"] == Mode.MANIFOLD, State.SLIP, rows["mode"])


def contact_samples_of(rows: NDArray[Any], states: NDArray[Any], friction: RoughContact | None) -> ContactSamples:
    """Rows (k,) of a record with those of `ContactState` at them, for people."""
    vectors = (
        np.column_stack([states[head + axis] for axis in "xyz"]) for head in ("", "centre_", "normal_", "friction_")
    )
    place, centre, normal, force = vectors
    load = rows["load"]
    parts = np.full((3, len(load)), np.nan)
    touching = rows["mode"] != Mode.FLYING
    if friction is not None and touching.any():
        # The end of contact is located just beyond it, where the law has no separation.
        borne = (load - rows["air"])[touching]
        separation = friction.separation(np.clip(borne, -friction.pull_off, friction.largest_load))
        parts[:, touching] = separation, *friction.forces(separation)[:2]
    pull, of_point, added = (states[name] for name in ("pull", "point_pull", "added_pull"))
    separations, contact_loads, adhesions = parts
    return ContactSamples(
        *(rows["time"], place, centre, normal, load, force, pull, of_point, added),
        *(separations, contact_loads, adhesions, _states(rows), states["bend_loss"]),
    )


def dataset_of(samples: Samples, events: Sequence[Event], **attributes: Any) -> xarray.Dataset:
    """The dataset of samples at ascending times, the last of those at a time, and of events."""
    import xarray

    last = np.append(np.diff(samples.time) > 0, True)
    columns = (*samples.position.T, samples.height, *samples.velocity.T, samples.vertical_velocity)
    columns += (samples.normal_force, samples.friction_force)
    variables: dict[str, Any] = {
        name: ("time", column[last], {"units": unit, "long_name": meaning})
        for (name, (unit, meaning)), column in zip(COLUMNS.items(), columns, strict=True)
    }
    for name, (unit, meaning) in FACE_COLUMNS.items():
        if (column := getattr(samples, name)) is not None:
            variables[name] = ("time", column[last], {"units": unit, "long_name": meaning})
    flags = {"flag_values": list(range(len(STATES))), "flag_meanings": " ".join(STATES)}
    variables["state"] = ("time", samples.state[last].astype(np.int8), {"long_name": "contact from then on", **flags})
    rows = [(event.time, *event.position, event.speed, event.load) for event in events]
    for (name, unit), values in zip(EVENTS.items(), np.array(rows, float).reshape(-1, len(EVENTS)).T, strict=True):
        variables[name] = ("event", values, {"units": unit})
    kinds = [event.kind.name.lower() for event in events]
    variables["event_kind"] = ("event", np.array(kinds, str), {"long_name": "what happened"})
    time = ("time", samples.time[last], {"units": "s", "long_name": "time"})
    return xarray.Dataset(variables, {"time": time}, attributes)


def table_of(samples: Samples, **attributes: Any) -> pandas.DataFrame:
    """The table of samples at ascending times, the last of those at a time; units are in its `attrs`."""
    dataset = dataset_of(samples, ())
    columns = {name: unit for name, (unit, _) in (COLUMNS | FACE_COLUMNS).items() if name in dataset}
    table = dataset[[*columns, "state"]].to_dataframe()
    table["state"] = [STATES[state] for state in table["state"]]
    table.attrs = {"units": {"time": "s"} | columns, **attributes}
    return table
