"""Builder: all that somebody sees who builds the paper's device, as data."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter, process_time
from typing import Final, NamedTuple

from active_surface.paper.models import CLOSED, DEVICE
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.devices import (
    DEVICES,
    LADDER,
    POINT,
    THIN,
    Device,
    DeviceRow,
    bench_of,
    sweep_devices,
)
from active_surface.paper.readings.losses import Losses, losses_of
from active_surface.paper.readings.plates import Inertia, Strained, inertia_of, strained
from active_surface.paper.readings.reading import GRAVITY, INDEX, RIM, Reading, SweepSize, benches_of
from active_surface.paper.readings.windows import THICKNESS, Grid, Windows, windows_of
from coupling import Progress, silent

LINEAR = "linear plate, point on the mid-plane"


class BuilderSize(NamedTuple):
    """How much of it is computed."""

    devices: tuple[Device, ...] = DEVICES
    losing: tuple[Device, ...] = LADDER + THIN  # on which losses are looked at
    weighed: Device = LADDER[-1]  # also with the plate's mass
    losses: int = 24  # starts at each frequency
    windows: Grid = Grid()


ALL: Final = BuilderSize()


class Builder(NamedTuple):
    """What a builder sees."""

    rows: list[DeviceRow]
    plates: list[Strained]
    inertia: Inertia
    losses: list[Losses]
    windows: Windows
    seconds: float
    processor: float  # s, of all threads


def see(size: SweepSize, more: BuilderSize = ALL, kept: Path | None = None, progress: Progress = silent) -> Builder:
    """All of it; kept: of the statements on devices."""
    rows = sweep_devices(more.devices, size, kept, progress)
    begun, worked = perf_counter(), process_time()
    with progress("Straining the plates"):
        thick = sorted({(device.radius, device.thickness) for device in more.devices + more.losing})
        plates = [strained(Device(*one, POINT).parameters(), PARAMETERS.stroke) for one in thick]
        thin = [Device(radius, THICKNESS, POINT).parameters() for radius in more.windows.radii]
        plates += [strained(p, stroke) for p in thin for stroke in more.windows.strokes]
    with progress("Adding the plate's mass"):
        inertia = inertia_of(more.weighed.parameters())
    with progress("Looking at what pulls parts off"):
        linear = benches_of(Reading(more.losing[0].radius, GRAVITY, INDEX), {})[RIM]
        losses = losses_of(LINEAR, linear, CLOSED, more.losses)
        grounds = {}  # type: ignore[var-annotated]
        for device in more.losing:
            losses += losses_of(device.name, bench_of(device, grounds), DEVICE, more.losses)
    windows = windows_of(more.windows, progress)
    seconds = perf_counter() - begun + sum(row.seconds for row in rows)
    processor = process_time() - worked + sum(row.processor for row in rows)
    return Builder(rows, plates, inertia, losses, windows, seconds, processor)
