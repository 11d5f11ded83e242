"""Identification from measured headings: against linear regression, and of a part that a platform turns."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.stats import t as student

from active_surface import Case, Track, identify, read_track
from active_surface.cli.program import main
from coupling import run_case
from coupling.case import write_case

COEFFICIENT, GRAVITY, RADIUS, SPIN, HEADING = 0.05, 9.80665, 5e-5, 200.0, 0.3
TIMES = np.linspace(5e-4, 0.015, 30)  # s; the disc stops at 15.3 ms


def spinning(**part: object) -> Case:
    """A disc that friction brakes on a platform at rest, by 4/3 coefficient g / radius."""
    own = {"footprint": "disc", "radius": RADIUS, "thickness": 2e-5, "density": 2330.0, "position": (0.0, 0.0)}
    return Case(
        plate={"shape": "platform"},
        part=own | {"heading": HEADING, "spin": SPIN} | part,
        friction={"model": "coulomb", "coefficient": COEFFICIENT},
        run={"duration": 0.02},
        name="spinning",
    )


def spun(noise: tuple[float, float] | None = None) -> Track:
    """The closed form with noise, in whole turns that differ, and places that say nothing."""
    generator = np.random.default_rng(2)
    heading = HEADING + SPIN * TIMES - 2 / 3 * COEFFICIENT * GRAVITY / RADIUS * TIMES**2
    heading += 0.02 * generator.standard_normal(len(TIMES)) + 2 * np.pi * generator.integers(-2, 3, len(TIMES))
    heading[4] = np.nan
    return Track(TIMES, 1e-6 * generator.standard_normal((len(TIMES), 2)), heading, noise)


@pytest.mark.parametrize("noise", [None, (1e-6, 0.02)])
@pytest.mark.compiled
def test_value_and_interval_are_those_of_weighted_regression(noise):
    """The heading is linear in the coefficient, so the interval is that of Student's t."""
    track = spun(noise)
    found = identify(spinning(), track, "friction.coefficient", {"friction.coefficient": (0.04, 0.06)}, threads=1)
    lever, known = RADIUS / math.sqrt(2) if noise is None else 1e-6 / 0.02, np.isfinite(track.heading)
    slope, turned = -2 / 3 * GRAVITY / RADIUS * TIMES**2, track.heading - HEADING - SPIN * TIMES
    turned += 2 * np.pi * np.round((slope * COEFFICIENT - turned) / (2 * np.pi))
    slope, turned = lever * slope[known], lever * turned[known]
    best = slope @ turned / (slope @ slope)
    left = np.concatenate([turned - slope * best, track.position.ravel()])
    reach = student.ppf(0.975, len(left) - 1) * math.sqrt(left @ left / (len(left) - 1) / (slope @ slope))
    (one,) = found.estimates
    assert one.value == pytest.approx(best, abs=0.02 * reach)
    assert one.high - one.low == pytest.approx(2 * reach, rel=0.03)
    (fit,) = found.fits
    assert len(fit.residuals) == 89 and fit.residual == pytest.approx(math.sqrt(left @ left / 89), rel=1e-3)
    assert fit.heading_residual == pytest.approx(0.02, rel=0.3)


@pytest.mark.slow
@pytest.mark.compiled
def test_friction_and_start_of_a_part_that_a_platform_turns_are_found():
    sway = {"stroke": "4 um", "frequency": "500 Hz", "cycle": "cosine"}
    truth = Case(
        plate={"shape": "platform", "motion": {"x": sway}},
        part={
            "footprint": "rectangle",
            "sides": ["100 um", "60 um"],
            "thickness": "20 um",
            "density": "2330 kg/m^3",
            "position": ["10 um", "0 um"],
            "heading": "30 deg",
            "spin": "100 rad/s",
        },
        friction={"model": "coulomb", "coefficient": 0.1},
        run={"duration": "6 ms"},
        name="swayed",
    )
    times, generator = np.linspace(0, 6e-3, 41), np.random.default_rng(1)
    exact = run_case(truth).trajectory.at(times)
    places = exact.position + 2e-7 * generator.standard_normal((41, 2))
    track = Track(times, places, exact.heading + 3e-3 * generator.standard_normal(41))
    off = truth.vary({"friction.coefficient": 0.2, "part.heading": "10 deg"})
    found = identify(off, track, ["friction.coefficient", "part.heading"], {"part.heading": ["0 deg", "90 deg"]})
    for one, value in zip(found.estimates, (0.1, math.pi / 6), strict=True):
        assert one.low < value < one.high and one.high - one.low < 0.1 * value


def test_headings_are_read_from_a_column_with_a_unit_and_asked_of_a_part_that_turns(tmp_path):
    file = tmp_path / "track.csv"
    file.write_text("time [ms], x [um], y [um], heading [deg]\n0, 1, 2, 30\n1, 1, 2, 390\n2, 1, 2, 31\n")
    track = read_track(file, noise=(1e-6, 0.02))
    assert track.heading == pytest.approx(np.radians([30, 390, 31])) and track.lever(1.0) == pytest.approx(5e-5)
    point = Case(
        plate={"shape": "platform"},
        part={"mass": 2e-9, "position": (0.0, 0.0)},
        friction={"model": "coulomb", "coefficient": 0.1},
        run={"duration": 0.02},
        name="point",
    )
    said = "track of identify in .*/track.csv must have no heading: the part of case point has no footprint, and a "
    with pytest.raises(ValueError, match=said):
        identify(point, track, "friction.coefficient")
    with pytest.raises(ValueError, match="Input heading of Track must have shape"):
        Track(TIMES, np.zeros((30, 2)), np.zeros(29))
    for noise, heading in (((1e-6, 0.0), np.zeros(30)), ((1e-6, 0.02), None)):
        with pytest.raises(ValueError, match="Input noise of Track must be two positive deviations"):
            Track(TIMES, np.zeros((30, 2)), heading, noise)


@pytest.mark.slow
@pytest.mark.compiled
def test_the_command_weighs_headings_by_their_noise_and_draws_them(tmp_path):
    write_case(spinning(), tmp_path / "spinning.toml")
    track = spun()
    rows = np.column_stack([track.time * 1e3, track.position * 1e6, np.degrees(track.heading)])
    header = "time [ms], x [um], y [um], heading [deg]"
    np.savetxt(tmp_path / "track.csv", rows[track.measured.all(axis=1)], delimiter=",", header=header, comments="")
    words = ["identify", str(tmp_path / "spinning.toml"), "--track", str(tmp_path / "track.csv"), "-o"]
    words += [str(tmp_path / "out"), "--free", "friction.coefficient", "--noise", "1 um,0.02 rad"]
    done = CliRunner().invoke(main, [*words, "--json"])
    told = json.loads(done.stdout)
    assert done.exit_code == 0 and told["tracks"]["spinning"]["measured"] == 87
    assert told["tracks"]["spinning"]["heading_residual"] == pytest.approx(0.02, rel=0.3)
    assert told["fields"]["friction.coefficient"]["value"] == pytest.approx(COEFFICIENT, rel=0.02)
    assert (tmp_path / "out" / "spinning_identified.png").stat().st_size > 10_000
    refused = CliRunner().invoke(main, [*words[:-1], "1 um", "--overwrite"])
    assert refused.exit_code == 2 and "--noise must be an angle" in refused.stderr
