"""Aims at their ends: parts that go on, starts at the rim, parts that are lost, Ctrl-C at any moment."""

import json
import signal
import threading

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import read_text

from active_surface.cli.program import main
from active_surface.steering import Route, Settings, Task, aim, plan
from active_surface.steering.aiming import aim_over, plan_over
from active_surface.steering.objectives import SAMPLES
from active_surface.steering.paths import Paths
from active_surface.steering.report import lines, plan_figures, plan_lines, scatter_line
from active_surface.steering.robustness import Disturbance, Scatter
from active_surface.steering.search import Trials
from coupling import build_surface
from particle import Outcome

TARGET = (-2e-5, 2e-5)
pytestmark = pytest.mark.compiled


def test_a_part_that_passes_a_target_has_not_reached_it(tmp_path, text):
    case = read_text(tmp_path, text.replace('"20 ms"', '"2.6 ms"').replace("40 nN", "1 nN"))
    surface = build_surface(case)
    fixed = {"frequency": (400, 400), "stroke": (5e-5, 5e-5), "cycles": (1, 1), "scatter": 1}
    end = aim_over(surface, Task(case, TARGET, Settings(**fixed))).trajectory.position[-1]
    passing = aim_over(surface, Task(case, (float(end[0]), float(end[1])), Settings(**fixed)))
    assert passing.distance == 0.0 and passing.trajectory.outcome is Outcome.MOVING and not passing.reached
    assert dict(lines(passing))["distance"].startswith(
        "0.0000 um, within the 0.5 um tolerance, but the part has not come to a final rest"
    )


def test_a_start_at_the_rim_is_disturbed_on_the_plate_only(tmp_path, text):
    case = read_text(tmp_path, text.replace('["0 um", "40 um"]', '["0 um", "299.8 um"]'))
    surface = build_surface(case)
    shifts = [(0.0, 1e-6), (0.0, -1e-6), (1e-7, 0.0), (5e-7, 9e-7)]
    paths = Paths(case, surface).of([(case.actuators, Disturbance(shift=shift)) for shift in shifts])
    starts = np.array([path.position[0] for path in paths]) - case.part.position
    assert starts == pytest.approx(np.array([(0.0, -1e-6), (0.0, -1e-6), (1e-7, 0.0), (-5e-7, -9e-7)]), abs=1e-15)
    found = aim_over(surface, Task(case, TARGET, Settings(paths=50, scatter=20)))
    assert len(found.scatter.distance) == 20


@pytest.mark.slow
def test_a_search_is_not_lost_by_an_interruption_of_its_scatter(case, folder, monkeypatch):

    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("active_surface.steering.aiming._scatter", stop)
    (folder / "out").mkdir()
    (folder / "out" / "base_aim.png").touch()  # of another search
    aimed = aim(Task(case, TARGET), folder / "out", overwrite=True)
    assert aimed.interrupted and aimed.reached and aimed.scatter is None
    assert [file.name for file in aimed.files] == ["base_aimed.toml"]
    assert [file.name for file in (folder / "out").iterdir()] == ["base_aimed.toml"]
    (folder / "aim.toml").write_text('[aim]\ncase = "base.toml"\ntolerance = "5 um"\n')
    arguments = [str(folder / "aim.toml"), "-o", str(folder / "out"), "--overwrite"]
    done = CliRunner().invoke(main, ["aim", *arguments, "--target", "-20,20"])
    assert done.exit_code == 130 and "not looked for, after Ctrl-C" in done.stdout
    done = CliRunner().invoke(main, ["plan", *arguments, "--json", "--through", "-20,20", "0,20"])
    told = json.loads(done.stdout)
    assert done.exit_code == 130 and len(told["legs"]) == 2 and told["scatter"] is None


def test_a_second_interruption_does_not_undo_the_first(case, surface, tmp_path, monkeypatch):
    written = []

    def write(*given):
        signal.raise_signal(signal.SIGINT)
        written.append(given)
        return given[1]

    def stop(done, of):
        raise KeyboardInterrupt

    assert threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr("active_surface.steering.aiming.write_case", write)
    aimed = aim_over(surface, Task(case, TARGET, Settings(scatter=5)), tell=stop, file=tmp_path / "a.toml")
    assert aimed.interrupted and len(written) == 1 and signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize("over", [aim_over, plan_over])
def test_an_interruption_while_the_file_is_written_is_heard_after_it(case, surface, tmp_path, monkeypatch, over):
    def write(case, file, said):
        signal.raise_signal(signal.SIGINT)
        return file

    monkeypatch.setattr("active_surface.steering.aiming.write_case", write)
    settings = Settings(paths=2, scatter=5)
    task = Task(case, TARGET, settings) if over is aim_over else Route(case, (TARGET,), settings)
    found = over(surface, task, file=tmp_path / "a.toml")
    assert found.interrupted and found.files == (tmp_path / "a.toml",) and found.scatter is None


def test_a_folder_in_place_of_a_result_is_refused_before_the_search(case, tmp_path):
    (tmp_path / "base_aim.png").mkdir()
    with pytest.raises(ValueError, match="free for base_aim.png; got .* where that is a folder"):
        aim(Task(case, TARGET), tmp_path, overwrite=True)


LIFTED = {"stroke": (3e-4, 4e-4), "frequency": (1900.0, 2000.0), "paths": 1, "scatter": 5}


def test_a_plan_ends_with_the_leg_that_loses_the_part_and_says_so(case, surface):
    planned = plan_over(surface, Route(case, (TARGET, (0.0, 0.0)), Settings(**LIFTED)))
    assert planned.trajectory.time[-1] < planned.case.run.duration
    assert not planned.arrivals and not planned.distances and not planned.complete and planned.scatter.lost == 5
    assert planned.failure.startswith("leg 0: The part ")
    assert planned.failure.endswith(f"At {planned.trajectory.time[-1] * 1e3:g} ms.")


def test_the_scatter_of_a_plan_is_about_the_way_point_of_its_last_leg(case, surface, tmp_path, monkeypatch):
    """The second leg does not settle: its drives are in the case all the same."""
    settings, rests = Settings(paths=40, scatter=3), iter([True, False])
    monkeypatch.setattr("active_surface.steering.aiming.settled", lambda path: next(rests))
    way = (TARGET, (6e-5, 5e-5))
    planned = plan_over(surface, Route(case, way, settings), file=tmp_path / "out" / "p.toml")
    assert len(planned.arrivals) == 1 and planned.targets == way and planned.failure.startswith("leg 1: ")
    assert planned.scatter.distance == pytest.approx(np.hypot(*(planned.scatter.ends - way[1]).T))
    comment = (tmp_path / "out" / "p.toml").read_text().split("\n\n")[0].splitlines()
    off = f"{planned.distances[0] * 1e6:g} um"
    assert planned.reached == [False]
    assert comment == [
        "# The drives miss way-point 0.",
        f"# The drives carry the part to within {off} of (-20 um, 20 um).",
        f"# {planned.failure}",
    ]


@pytest.mark.slow
def test_a_plan_whose_disturbed_runs_are_all_lost_says_nothing_of_how_near_they_are(case, tmp_path):
    planned = plan(Route(case, (TARGET,), Settings(**LIFTED)), tmp_path / "out")
    assert planned.scatter.as_dict() == {"count": 5, "median": None, "nine_in_ten": None, "worst": None} | {
        "cvar_nine_in_ten": None,
        "lost": 5,
    }
    assert dict(plan_lines(planned))["scatter"].startswith("5 lost (5 runs")
    json.dumps(plan_figures(planned), allow_nan=False)
    assert (tmp_path / "out" / "base_plan.png").exists() and np.isfinite(planned.scatter.ends).all()


@pytest.mark.parametrize(
    ("off", "within", "said"),
    [
        ([1.0, 100.0], [1.0, 100.0, 100.0], "half within 1 um, 90 % within 100 um, all within 100 um of the target ("),
        ([*range(1, 10), np.inf], [5.0, 9.0, None], "half within 5 um, 90 % within 9 um of the target; 1 lost ("),
        ([3.0, np.inf, 2.0, np.inf], [3.0, None, None], "half within 3 um of the target; 2 lost ("),
    ],
)
def test_a_share_of_the_parts_is_within_a_distance_only_where_that_many_are(off, within, said):
    scatter = Scatter(np.zeros((len(off), 2)), 1e-6 * np.array(off))
    wanted = [None if away is None else pytest.approx(1e-6 * away) for away in within]
    assert [scatter.as_dict()[name] for name in ("median", "nine_in_ten", "worst")] == wanted
    assert scatter_line(scatter).startswith(said)


@pytest.mark.slow
def test_a_plan_says_which_way_points_it_missed(folder):
    (folder / "aim.toml").write_text('[aim]\ncase = "base.toml"\npaths = 3\nscatter = 2\n')
    arguments = ["plan", str(folder / "aim.toml"), "-o", str(folder / "out"), "--through", "-90,120", "90,120"]
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 1 and "not within the 0.5 um tolerance" in done.stdout
    assert "0 of 2 way-points within 0.5 um" in done.stdout
    told = json.loads(CliRunner().invoke(main, [*arguments, "--json", "--overwrite"]).stdout)
    assert [leg["reached"] for leg in told["legs"]] == [False, False] and not told["complete"]


def test_bounds_that_leave_no_time_for_a_cycle_are_refused(case):
    with pytest.raises(
        ValueError, match=r"^frequency must leave time for a cycle .* is 25 ms, and the run ends at 20 ms$"
    ):
        Task(case, TARGET, Settings(frequency=(10.0, 40.0)))
    with pytest.raises(ValueError, match=r"^delay must leave time .* is 20.6667 ms, and"):
        Task(case, TARGET, Settings(delay=(19e-3, 40e-3)))
    Task(case, TARGET, Settings(delay=(18e-3, 40e-3)))


@pytest.mark.slow
def test_a_case_file_may_follow_the_way_points(folder):
    (folder / "1.toml").write_text('[aim]\ncase = "base.toml"\npaths = 3\nscatter = 2\n')
    arguments = ["plan", "--through", "-90,120", "90,120", str(folder / "1.toml"), "-o", str(folder / "out")]
    done = CliRunner().invoke(main, [*arguments, "--json"])
    assert done.exit_code == 1 and len(json.loads(done.stdout)["legs"]) == 2


def test_a_robust_search_by_few_paths_ends_with_them(case, surface, monkeypatch):
    asked, of, paths = [], Trials.of, 2

    def counted(objective, values):
        asked.append(len(values))
        return of(objective, values)

    monkeypatch.setattr(Trials, "of", counted)
    task = Task(case, TARGET, Settings(quantile=0.9, paths=paths, scatter=1))
    found = aim_over(surface, task)
    assert np.isfinite(found.distance) and found.paths <= paths + SAMPLES and len(asked) < 20


@pytest.mark.slow
def test_the_option_robust_is_the_quantile(folder):
    (folder / "aim.toml").write_text('[aim]\ncase = "base.toml"\npaths = 200\nscatter = 2\n')
    arguments = ["aim", str(folder / "aim.toml"), "--target=-20,20", "--json", "-o", str(folder / "out")]
    plain = json.loads(CliRunner().invoke(main, arguments).stdout)
    robust = json.loads(CliRunner().invoke(main, [*arguments, "--robust", "0.9", "--overwrite"]).stdout)
    assert robust["paths"] <= 200 + SAMPLES and robust["legs"] != plain["legs"]
