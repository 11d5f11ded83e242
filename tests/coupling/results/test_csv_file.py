"""Trajectories as CSV files."""

import csv

import numpy as np
import pytest

from coupling import write_csv
from particle import ConstantFriction, CoulombAdhesion, Drive, Micropart, platform_surface, simulate

COLUMNS = [
    *("time [s]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "state"),
    *("normal force [N]", "friction force [N]"),
]


@pytest.fixture(scope="module")
def trajectory():
    """Carried along, then thrown into the air."""
    surface = platform_surface(x=Drive(1e-3, 40.0, "up"), z=Drive(2e-4, 100.0), size=1e-3)
    part = Micropart(1e-9, (1e-4, 0.0), (0.0, 1e-2))
    return simulate(surface, part, CoulombAdhesion(0.3), 30e-3, after_detachment="fly")


def read(path):
    with path.open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header == COLUMNS
    words = [row.pop(6) for row in rows]
    return np.array(rows, dtype=float), words


def test_without_times_it_holds_every_row(trajectory, tmp_path):
    numbers, words = read(write_csv(trajectory, tmp_path / "path.csv"))
    assert (numbers[:, 0] == trajectory.time).all()
    assert (numbers[:, 1:3] == trajectory.position).all()
    assert (numbers[:, 3] == trajectory.height).all()
    assert (numbers[:, 4:6] == trajectory.velocity).all()
    assert (numbers[:, 6] == trajectory.normal_force).all()
    assert (numbers[:, 7] == trajectory.friction_force).all()
    assert words == [{0: "stick", 1: "slip", 2: "flight"}[state] for state in trajectory.state.tolist()]
    assert {"slip", "flight"} <= set(words)


def test_times_come_with_the_events_between_them_in_order_and_once(trajectory, tmp_path):
    times = [3e-3, 1e-3, 1e-3, 5e-3, -1.0, 99.0]
    numbers, words = read(write_csv(trajectory, str(tmp_path / "path.csv"), times))
    events = [event.time for event in trajectory.events]
    assert len(events) >= 2
    assert numbers[:, 0].tolist() == sorted({0.0, 1e-3, 3e-3, 5e-3, trajectory.time[-1], *events})
    landing = next(event for event in trajectory.events if event.kind.name == "LANDS")
    row = numbers[:, 0].tolist().index(landing.time)
    assert words[row - 1] == "flight" and words[row] != "flight"
    assert numbers[row, 1:3] == pytest.approx(landing.position, abs=1e-15)


def test_a_trajectory_is_replaced_and_nothing_partial_stays(trajectory, tmp_path):
    path = write_csv(trajectory, tmp_path / "path.csv")
    write_csv(trajectory, path, [0.0])
    assert len(read(path)[0]) == len({0.0, *(event.time for event in trajectory.events)})
    assert list(tmp_path.iterdir()) == [path]


def test_another_file_is_left_alone(trajectory, tmp_path):
    path = tmp_path / "shaker.csv"
    path.write_text("time [ms], x [um]\n0, 0\n")
    with pytest.raises(ValueError, match="Input path of write_csv must be free or a trajectory; got .*shaker.csv"):
        write_csv(trajectory, path)
    assert path.read_text().startswith("time [ms]")


def test_times_must_be_finite(trajectory, tmp_path):
    with pytest.raises(ValueError, match="Input times of write_csv must be finite times in s; got nan"):
        write_csv(trajectory, tmp_path / "path.csv", [0.0, np.nan])
    assert not list(tmp_path.iterdir())


def test_a_part_at_rest_has_one_word(tmp_path):
    still = simulate(platform_surface(), Micropart(1e-9, (0.0, 0.0)), ConstantFriction(1e-9), 1.0)
    numbers, words = read(write_csv(still, tmp_path / "path.csv", [0.0, 0.5, 1.0]))
    assert words == ["stick"] * 3
    assert numbers[:, 6] == pytest.approx(9.80665e-9)
