"""What a builder sees, made up: two devices of which one meets figure 12, losses at one frequency, one good window."""

from active_surface.paper.readings.builder import LINEAR, Builder
from active_surface.paper.readings.devices import PUT, Device, DeviceRow
from active_surface.paper.readings.losses import Losses
from active_surface.paper.readings.plates import Inertia, Strained
from active_surface.paper.readings.windows import Passage, Window, Windows

NAN = float("nan")
BLOCK, POINT = Device(300e-6, 20e-6, "silicon block"), Device(300e-6, 20e-6, "point", top_face=False)


def device_row(device, **shares):
    return DeviceRow(device, {"device": {name: {"": 0.0} for name in PUT} | shares}, NAN, 60.0, 60.0)


BUILDER = Builder(
    rows=[device_row(BLOCK, **{"12": {"": 1.0}, "16": {"one": 0.2, "ten": 0.75}}), device_row(POINT)],
    plates=[
        Strained(300e-6, 20e-6, 150e-6, 0.86, 1.05, 178.0, 10.4, 1.94e6),
        Strained(300e-6, 5e-6, 5e-6, 0.02, 0.006, 0.01, 0.005, 4.8e5),
        Strained(300e-6, 5e-6, 20e-6, 0.1, 0.03, 0.1, 0.02, 4.8e5),
    ],
    inertia=Inertia(300.0, 1.94e6, 34.5e-6, 10e-9),
    losses=[
        Losses(LINEAR, 600.0, 4, 3, 1, 0, *[NAN] * 8),
        Losses(POINT.name, 600.0, 4, 0, 1, 3, 2e-6, 0.15, -900.0, -200.0, -391.0, 0.0, 1.0, 0.0),
    ],
    windows=Windows(
        [
            Window(300e-6, "silicon block", 5e-6, 500.0, 0.0, 0.0, 1.0, 1e-4),
            Window(300e-6, "silicon block", 20e-6, 500.0, 0.25, 0.0, 0.75, 1e-4),
            Window(300e-6, "silicon block", 20e-6, 1000.0, 0.95, 0.0, 0.0, 2e-6),
            Window(300e-6, "silicon block", 20e-6, 2000.0, 0.0, 1.0, 0.0, NAN),
        ],
        [
            Passage(300e-6, "silicon block", 20e-6, 1000.0, 4 / 3, 0.125, 0.5),
            Passage(300e-6, "silicon block", 20e-6, 1000.0, 1.5, 0.0, 1.0),
            Passage(300e-6, "silicon block", 20e-6, 1000.0, 0.0, 0.625, 0.0),
        ],
    ),
    seconds=600.0,
    processor=900.0,
)
