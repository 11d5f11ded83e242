"""Devices: plates that stretch, with parts of some height on their top face, and the statements put to them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Final, NamedTuple

from active_surface.paper.models import DEVICE, Bench, Ground
from active_surface.paper.parameters import PARAMETERS, Parameters
from active_surface.paper.readings.cases import STATEMENTS
from active_surface.paper.readings.kept import keep, kept_rows
from active_surface.paper.readings.reading import GRAVITY, INDEX, RIM, Reading, SweepSize
from active_surface.paper.readings.single import Shares, of_one
from active_surface.paper.readings.two import of_two
from coupling import Progress, silent

DENSITIES: Final = {"point": None, "tungsten tile": 19300.0, "silicon block": 2330.0}  # kg/m^3
POINT, TILE, BLOCK = DENSITIES
PUT: Final = [name for name in STATEMENTS if name != "VI-B"]  # statements with a path


class Device(NamedTuple):
    """A plate and a part; actuators are rigid points, the rim is clamped and immovable, there is gravity."""

    radius: float  # m
    thickness: float  # m
    part: str  # of DENSITIES: the paper's mass on its square contact
    top_face: bool = True  # else the part lies on the mid-plane

    @property
    def name(self) -> str:
        """In words."""
        part = self.part if self.top_face else "point on the mid-plane"
        return f"a = {1e6 * self.radius:g} um, {1e6 * self.thickness:g} um thick, {part}"

    @property
    def centre_height(self) -> float:
        """How high [m] the part's mass is over its face."""
        density = DENSITIES[self.part]
        return PARAMETERS.mass / (2 * density * PARAMETERS.contact_side**2) if density else 0.0

    def parameters(self) -> Parameters:
        """The parameters of all figures."""
        return replace(
            Reading(self.radius, GRAVITY, INDEX).parameters(), thickness=self.thickness,
            half_thickness=self.thickness / 2 if self.top_face else 0.0, centre_height=self.centre_height,
        )  # fmt: skip


LADDER: Final = (
    Device(PARAMETERS.radius, 20e-6, POINT, top_face=False),
    Device(PARAMETERS.radius, 20e-6, POINT),
    Device(PARAMETERS.radius, 20e-6, TILE),
    Device(PARAMETERS.radius, 20e-6, BLOCK),
)
"""One thing more at a time."""
OTHERS: Final = tuple(
    Device(radius, thickness, part)
    for radius, thickness in ((PARAMETERS.radius, 50e-6), (455e-6, 20e-6))
    for part in (TILE, BLOCK)
)
DEVICES: Final = LADDER + OTHERS
THIN: Final = tuple(Device(PARAMETERS.radius, 5e-6, part) for part in (TILE, BLOCK))
"""Of which only losses are looked at: over ten thicknesses no splines give the corrections, and paths are slow."""


class DeviceRow(NamedTuple):
    """What becomes of all statements on one device."""

    device: Device
    shares: dict[str, Shares]  # by model, of which there is one
    threshold: float  # Hz, of figure 18
    seconds: float
    processor: float  # s, of all threads

    @property
    def reading(self) -> Reading:
        """What it shares with readings."""
        return Reading(self.device.radius, GRAVITY, INDEX)


Grounds = dict[tuple[float, float], dict[tuple[str, str], Ground]]  # by radius and thickness


def bench_of(device: Device, grounds: Grounds) -> Bench:
    """The bench of a device; those of the same plate share its surfaces, as long as no other plate comes between."""
    plate = device.radius, device.thickness
    if plate not in grounds:
        grounds.clear()  # they take gigabytes
    return Bench(device.parameters(), grounds=grounds.setdefault(plate, {}))


def device_row(device: Device, size: SweepSize, grounds: Grounds) -> DeviceRow:
    """All statements on one device."""
    begun, worked = perf_counter(), process_time()
    bench = bench_of(device, grounds)
    shares, level = of_one({RIM: bench}, RIM, DEVICE, size)
    shares |= of_two({RIM: bench}, DEVICE, size)
    own = {name: row for name, row in shares.items() if name in PUT}
    return DeviceRow(device, {DEVICE: own}, level, perf_counter() - begun, process_time() - worked)


def sweep_devices(
    devices: Sequence[Device], size: SweepSize, kept: Path | None = None, progress: Progress = silent
) -> list[DeviceRow]:
    """All devices; kept: as of `sweep_readings`."""
    rows = kept_rows(kept, size)
    done = {(device := Device(*one.pop("device"))): DeviceRow(device, **one) for one in rows}
    grounds: Grounds = {}
    with progress("Putting the statements to devices") as tell:
        for k, device in enumerate(devices):
            if device not in done:
                done[device] = device_row(device, size, grounds)
                keep(kept, size, done[device])
            tell(k + 1, len(devices))
    return [done[device] for device in devices]
