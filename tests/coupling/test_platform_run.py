"""Runs on a platform from case to files, and what the summary says of them."""

import json
import math
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling import report, run_case, summary_of
from coupling.advice import advice_text, advise
from coupling.case import Case, ConstantCase, CoulombCase, PartCase, RunCase

EXAMPLES = Path(__file__).parents[2] / "examples"
X = {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}
Z = {"stroke": 3e-6, "frequency": 500.0, "cycle": "cosine"}


def case(motion, run=None, **part):
    return Case(
        plate={"shape": "platform", "motion": motion},
        part=PartCase(mass=2e-9, position=(1e-4, 0.0), **part),
        friction=CoulombCase(coefficient=0.3),
        run=RunCase(**{"duration": 5e-3} | (run or {})),
        name="platform",
    )


def said(result):
    rows = report.lines(result.summary, verbose=True)
    return "\n".join([*(text for _, text in rows), *report.warnings(result.summary)])


@pytest.mark.compiled
def test_flights_loads_and_errors_are_said(tmp_path):
    result = run_case(
        case({"x": X, "z": Z}, {"gravity": (0.5, 0.0, -9.8), "after_detachment": "fly"}, squeeze=1e-9), tmp_path
    )
    s = result.summary
    assert (s.flights, s.landings) == (3, 2)  # it is in the air at the end
    assert s.time_flying > 1e-3
    assert s.time_stuck + s.time_slipping + s.time_flying == pytest.approx(5e-3)
    assert s.energy_balance < 1e-7
    text = said(result)
    assert "3 flights, 2 landings" in text
    assert "gravity (0.5, 0, -9.8) m/s^2, squeezed by 0.001 uN" in text
    assert "drives follow their motion to 3.0e-13 of the stroke" in text
    assert f"the energy ledger closes to {s.energy_balance:.1e}" in text
    assert "counted from the platform" in text
    assert "thickness" not in text and "unknowns" not in text
    with h5py.File(tmp_path / "platform.part.vtkhdf") as file:
        assert set(file["VTKHDF/PointData/state"][:].tolist()) == {0, 1, 2}
        assert "from the platform" in json.loads(file["active_surface"].attrs["units"])["points"]


def test_figures_of_a_plate_are_none():
    summary = run_case(case({"x": X}, {"duration": 1e-4})).summary.as_dict()
    for name in ("plate_error", "surface_error", "deflection_over_thickness", "first_frequency", "part_sag"):
        assert summary[name] is None
    assert summary["gravity"] == 9.80665 and summary["energy_balance"] < 1e-6
    assert json.loads(json.dumps(summary))["motion_fits"] == []


def test_the_drawn_square_lies_around_the_path_and_moves_up_and_down(tmp_path):
    run = {"duration": 6e-4, "frames": 7, "gravity": 100.0}
    result = run_case(case({"x": X, "z": Z}, run, velocity=(0.05, 0.0)), tmp_path)
    with h5py.File(tmp_path / "platform.plate.vtkhdf") as file:
        points = file["VTKHDF/Points"][:]
        deflection = file["VTKHDF/PointData/deflection"][:].reshape(-1, 4)
        times = file["VTKHDF/Steps/Values"][:]
    path = result.trajectory.position
    assert (points[:, :2].min(axis=0) < path.min(axis=0)).all() and (points[:, :2].max(axis=0) > path.max(axis=0)).all()
    expected = 1.5e-6 * (1 - np.cos(2 * np.pi * 500 * times))
    rounding = np.finfo(np.float32).eps * expected + 1e-15  # m, as the files have single precision
    assert (np.abs(deflection - expected[:, None]) <= rounding[:, None]).all()
    with h5py.File(tmp_path / "platform.part.vtkhdf") as file:
        assert (np.abs(file["VTKHDF/Points"][:, 2] - expected) <= rounding).all()


@pytest.mark.parametrize(
    "keys, time", [({"delay": 2e-4}, 0.2), ({"frequency": 5e3, "cycles": 2}, 0.4), ({"frequency": 5e3}, None)]
)
def test_a_jump_of_velocity_is_told(keys, time):
    result = run_case(case({"x": X | {"stroke": 1e-9} | keys}, {"duration": 6e-4}))
    assert result.summary.drive_jump == (None if time is None else pytest.approx(time * 1e-3))
    assert "jumps at" not in said(result)  # an impact, which the ledger has
    assert result.summary.energy_balance < 1e-6
    run = {"duration": 6e-4, "scheme": "fixed"}
    fixed = run_case(case({"x": X | {"stroke": 1e-9} | keys}, run))
    assert ("jumps at" in said(fixed)) == (time is not None)


def test_strokes_do_not_jump():
    keys = {"stroke": 1e-9, "frequency": 5e3, "cycles": 2, "delay": 1e-4}
    assert run_case(case({"x": keys}, {"duration": 6e-4})).summary.drive_jump is None


def test_fixed_steps_are_checked_with_half_the_step():
    run = {"duration": 2e-3, "scheme": "fixed"}
    coarse, fine = (run_case(case({"x": X}, run | {"time_step": step})) for step in (2e-5, 1e-5))
    moved = abs(coarse.trajectory.position[-1, 0] - fine.trajectory.position[-1, 0])
    assert coarse.summary.path_error == pytest.approx(moved, rel=1e-12) and moved > 1e-8
    assert "in a run with half the time step" in said(coarse)
    assert "the error falls in proportion to run.time_step" in said(coarse)
    assert "100 times tighter" not in said(coarse)


@pytest.mark.compiled
def test_fixed_steps_that_are_not_given_are_those_of_the_integrator():
    """A ten-thousandth of the shortest stroke; half of it for the check."""
    run = {"duration": 2e-3, "scheme": "fixed"}
    chosen, given = (run_case(case({"x": X}, run | step)) for step in ({}, {"time_step": 1e-4 * 1.25e-3}))
    assert chosen.summary.path_error == pytest.approx(given.summary.path_error, rel=1e-3, abs=0.0)
    assert given.summary.path_error > 0.0
    assert (chosen.trajectory.position[-1] == given.trajectory.position[-1]).all()


def test_a_gap_in_the_energy_ledger_is_warned_of():
    summary = run_case(case({"x": X}, {"duration": 1e-4})).summary
    assert not any("ledger" in warning for warning in report.warnings(summary))
    worse = type(summary)(**vars(summary) | {"energy_balance": 2e-6})
    assert any("closes only to 2.0e-06" in warning for warning in report.warnings(worse))


@pytest.mark.slow
@pytest.mark.compiled
def test_a_measured_motion_from_the_command_line(tmp_path):
    command = ["run", str(EXAMPLES / "shaker.toml"), "--output", str(tmp_path), "--csv", "--json"]
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    (fit,) = found["motion_fits"]
    assert fit["axis"] == "x" and fit["rms"] < fit["largest"] < 1e-12
    names = ["shaker.csv", "shaker.part.vtkhdf", "shaker.plate.vtkhdf", "shaker.png"]
    assert sorted(file.name for file in tmp_path.iterdir()) == names
    assert sorted(Path(file).name for file in found["files"]) == names
    assert ",slip," in (tmp_path / "shaker.csv").read_text()
    assert CliRunner().invoke(main, command).exit_code == 0  # its own file is replaced


@pytest.mark.compiled
def test_advice_on_a_measured_motion_names_no_strokes(tmp_path):
    file = tmp_path / "motion.csv"
    file.write_text("time [ms], x [um]\n" + "".join(f"{k}, {0.1 * math.sin(k)}\n" for k in range(60)))
    result = run_case(case(str(file), {"duration": 5e-2}))
    assert "times the stroke" in said(result)
    assert advice_text(result, advise(result)[0]).startswith("A trial run with ")


def test_a_measured_motion_is_not_written_over(tmp_path):
    for name in ("shaker.toml", "shaker.csv"):
        (tmp_path / name).write_text((EXAMPLES / name).read_text())
    done = CliRunner().invoke(main, ["run", str(tmp_path / "shaker.toml"), "--output", str(tmp_path), "--csv"])
    assert done.exit_code == 2
    assert "must be free or a trajectory; got" in done.output
    assert (tmp_path / "shaker.csv").read_text() == (EXAMPLES / "shaker.csv").read_text()
    assert len(list(tmp_path.iterdir())) == 2


def test_check_of_a_platform():
    done = CliRunner().invoke(main, ["check", str(EXAMPLES / "shaker.toml")])
    assert done.exit_code == 0
    assert "fine; a platform, 4000 ms" in done.output


def test_a_constant_limit_under_a_load_below_zero_is_warned_of():
    platform = case({"z": {"stroke": "20 um", "frequency": "500 Hz"}}, {"duration": 4e-3})
    held = platform.model_copy(update={"friction": ConstantCase(limit=1e-8)})
    summary = run_case(held).summary
    assert summary.margins.smallest_load < 0 and summary.margins.contact is None
    assert any("A constant limit holds it" in warning for warning in report.warnings(summary))
    rough = run_case(platform.model_copy(update={"friction": CoulombCase(coefficient=0.3, adhesion=1e-3)})).summary
    assert rough.margins.smallest_load < 0 and not any("constant limit" in text for text in report.warnings(rough))


def test_noise_that_pulls_harder_than_friction_holds_is_warned_of(tmp_path):
    times = np.arange(0, 1, 1 / 960)
    quiet = 1e-3 * np.sin(2 * np.pi * 3 * times)
    noisy = quiet + np.random.default_rng(1).normal(0, 10e-6, len(times))
    friction = CoulombCase(coefficient=0.3)
    pulls = []
    for name, x in (("quiet", quiet), ("noisy", noisy)):
        file = tmp_path / f"{name}.csv"
        rows = "\n".join(f"{t * 1e3:.17g}, {place * 1e6:.17g}" for t, place in zip(times, x, strict=True))
        file.write_text(f"time [ms], x [um]\n{rows}\n")
        measured = Case(
            plate={"shape": "platform", "motion": str(file), "smoothing": 1e-7},
            part=PartCase(mass=2e-9, position=(0.0, 0.0)),
            friction=friction,
            run=RunCase(duration=0.05),
        )
        summary = run_case(measured).summary
        pulls.append(summary.noise_pull)
        assert any("Noise of" in text for text in report.warnings(summary)) == (name == "noisy")
    assert pulls[0] < 1e-3 and pulls[1] > 1


def test_what_was_found_in_a_measured_motion_is_said(tmp_path):
    """Impacts, a gap and a column of no use; the figures survive as JSON."""
    times = np.delete(np.arange(240) / 960, slice(200, 208))
    x = 1e-3 * np.sin(2 * np.pi * 30 * times) + 0.3 * np.maximum(0, times - 0.1003)
    x += np.random.default_rng(1).normal(0, 5e-6, len(times))
    rows = "\n".join(f"{t:.17g}, {place:.17g}, warm" for t, place in zip(times, x, strict=True))
    (tmp_path / "x.csv").write_text(f"time [s], x [m], weather\n{rows}\n")
    summary = run_case(
        Case(
            plate={"shape": "platform", "motion": str(tmp_path / "x.csv")},
            part=PartCase(mass=2e-9, position=(0.0, 0.0), squeeze=1e-8),
            friction=CoulombCase(coefficient=0.5),
            run=RunCase(duration=0.15),
        )
    ).summary
    text = " ".join(text for _, text in report.lines(summary, verbose=True))
    assert "smoothed by cross-validation" in text and "velocity of x jumps" in text and "at 100." in text
    warnings = report.warnings(summary)
    assert any("1 gap, up to 9.3" in warning for warning in warnings)
    assert any('column "weather"' in warning for warning in warnings)
    assert summary.drive_jump == pytest.approx(0.1003, abs=3e-4)
    assert summary_of(json.loads(json.dumps(summary.as_dict()))).motion_fits == summary.motion_fits


def test_a_coarse_friction_table_is_warned_of():
    summary = run_case(case({"x": X}, {"duration": 1e-4})).summary
    assert not any("friction table" in text for text in report.warnings(summary))
    coarse = type(summary)(**vars(summary) | {"contact_error": 0.4})
    assert any("good to 40 % only" in text for text in report.warnings(coarse))
