"""Devices: their limit is the paper's plate, what pulls parts off adds up to the pull-off, and the page's sentences."""

from dataclasses import replace

import numpy as np
import pytest
from made_builder import BLOCK, BUILDER, POINT, device_row

from active_surface.paper.models import CLOSED, DEVICE, Bench
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings import SweepSize
from active_surface.paper.readings.builder_page import section
from active_surface.paper.readings.conclusions import summary
from active_surface.paper.readings.devices import TILE, Device, sweep_devices
from active_surface.paper.readings.kept import keep
from active_surface.paper.readings.losses import losses_of, normal_terms
from active_surface.paper.readings.windows import Grid, around, windows_of


def test_heights_of_parts():
    """A silicon block of 2 ug on 100 um x 100 um is 86 um high; the paper's part is a point on the mid-plane."""
    assert BLOCK.centre_height == pytest.approx(42.9e-6, rel=1e-3)
    assert Device(300e-6, 20e-6, TILE).centre_height == pytest.approx(5.18e-6, rel=1e-3)
    assert BLOCK.parameters().half_thickness == 10e-6 and BLOCK.parameters().centre_height == BLOCK.centre_height
    assert POINT.parameters().half_thickness == POINT.parameters().centre_height == 0.0
    assert POINT.name == "a = 300 um, 20 um thick, point on the mid-plane"


@pytest.mark.slow
@pytest.mark.compiled
def test_a_thick_device_bends_as_the_papers_plate():
    """At 3 % of a thickness it hardly stretches; but its points move in its plane, by about w^2 / a."""
    p = replace(PARAMETERS, thickness=6e-3, strokes=(150e-6, 150e-6))
    device, closed = Bench(p), Bench(p)
    drive, end = device.drive(300.0), 1 / 300.0
    xy = np.array([[60e-6, 0.0], [-90e-6, 120e-6]])
    for time in (0.2 * end, 0.4 * end):
        ours = device.surface(DEVICE, [drive], end).evaluate(xy, time)
        theirs = closed.surface(CLOSED, [drive], end).evaluate(xy, time)
        for name in ("w", "w_t", "w_tt", "gradient", "hessian"):
            bend = getattr(theirs, name)
            assert getattr(ours, name) == pytest.approx(bend, abs=2e-3 * np.abs(bend).max())
        share = np.hypot(*ours.u.T) / (theirs.w**2 / p.radius)
        assert share.min() > 0.1 and share.max() < 10
    high = Bench(replace(p, centre_height=40e-6, half_thickness=3e-3), grounds=device.grounds)
    assert high.surface(DEVICE, [drive], end).half_thickness == 3e-3
    ends = [bench.paths(DEVICE, [drive], [p.start], end / 2)[0].place[-1] for bench in (device, high)]
    assert np.hypot(*(ends[0] - ends[1])) > 1e-6


@pytest.mark.compiled
def test_what_pulls_a_part_off_adds_up_to_the_pull_off():
    """On equation (2) the corner is v.H v; without gravity and height nothing else is left but the slope's square."""
    bench = Bench(replace(PARAMETERS, tolerance=1e-7))
    (*_, row) = losses_of("closed", bench, CLOSED, 12)
    assert (
        row.frequency == 600.0
        and row.converge + row.leave + row.off <= row.parts
        and row.off > 4
        and row.by_corner > row.by_stroke
    )
    drive = bench.drive(600.0)
    off = [one for one in bench.paths(CLOSED, [drive], [(90e-6, 0.0), (120e-6, 0.0)], 0.05) if one.came_off]
    terms = normal_terms(bench, CLOSED, 600.0, off)
    limit = bench.parameters.friction.pull_off / bench.parameters.mass
    assert len(off) and terms.sum(axis=1) == pytest.approx(-limit, rel=1e-4)
    away, speed = off[0].off_at((0.0, 0.0))
    curvature = 4 / bench.parameters.radius**2 * (np.log(away / bench.parameters.radius) + 1)
    height = drive.evaluate(off[0].time[-1])[0]
    assert terms[0, 2] == pytest.approx(curvature * height * speed**2, rel=1e-3)


@pytest.mark.compiled
def test_windows_on_the_linear_plate(monkeypatch):
    """With equation (2) in the device's place: a small stroke holds all parts, 150 um at 250 Hz brings most of them."""
    linear = Bench().ground(CLOSED)
    monkeypatch.setattr("active_surface.paper.models.Bench.ground", lambda *_: linear)
    monkeypatch.setattr("active_surface.paper.readings.windows.RATIOS", ())
    placing, passing = windows_of(Grid((300e-6,), (5e-6, 150e-6), (250.0,), 4))
    held, brought, *_ = placing
    assert held.held == 1 and held.converge == held.lost == 0 and not passing
    assert brought.converge >= 0.5 and brought.converge + brought.held == 1 and brought.away < 30e-6
    places = np.hypot(*around(150e-6, 4, 200).T)
    assert places.max() < 75e-6 and places.min() > 75e-6 * np.sqrt(0.1)


def test_devices_that_are_done_are_not_computed_again(tmp_path):
    size, kept = SweepSize((), 8, 20.0, 18, 14), tmp_path / "kept.jsonl"
    rows = [device_row(BLOCK), device_row(POINT, **{"12": {"": 1.0}})]
    for one in rows:
        keep(kept, size, one._replace(threshold=310.0))
    assert sweep_devices((BLOCK, POINT), size, kept) == [one._replace(threshold=310.0) for one in rows]


def test_the_sections_of_the_page():
    page = "\n".join(section(BUILDER, None))
    for row in ("| 12 | **100** | 0 |", "| 600 | 0 | 25 | 75 | 2 | 0.15 | -900 |", "| 300 | silicon block | 20 | 12 |"):
        assert row in page
    strain, held, _, ladder, windows, handed = summary(BUILDER)
    assert "5 um of silicon bear 5 um with a = 300 um" in strain and "0 hold on all 2 devices" in held
    assert "off the one that stretches: 75 %" in ladder and "with 20 um at 1000 Hz (silicon block" in windows
    assert "12 % where it runs 1.33 times as fast" in handed
