"""A path as labelled arrays: a dataset of xarray or a table of pandas, each column with its unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import pandas
    import xarray

    from particle.samples import Event, Samples

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
EVENTS: Final = {"event_time": "s", "event_x": "m", "event_y": "m", "event_speed": "m/s", "event_load": "N"}
STATES: Final = ("stick", "slip", "flight")
"""The states by their number."""


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
    table = dataset[[*COLUMNS, "state"]].to_dataframe()
    table["state"] = [STATES[state] for state in table["state"]]
    table.attrs = {"units": {"time": "s"} | {name: unit for name, (unit, _) in COLUMNS.items()}, **attributes}
    return table
