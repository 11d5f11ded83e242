"""What the air under a part does: its figures, its warnings, and its drag in a run."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from page_files import numbers

from active_surface import Track, identify
from active_surface.studies.feasibility import feasibility
from active_surface.views import run_data
from coupling import Case, PlateSummary, Summary, read_run, run_case, run_cases, warnings
from coupling.air import AirFigures
from coupling.case import DriveCase, InputError
from coupling.drives import build_drive, first_jump
from coupling.report import lines
from particle import Outcome

G = 9.80665
TABLES: dict[str, Any] = {
    "plate": {"shape": "platform", "motion": {"z": {"stroke": "1 um", "frequency": "1 kHz", "cycle": "sine"}}},
    "part": {"mass": "2e-9 kg", "position": ["0 um", "0 um"], "size": "100 um", "velocity": ["20 mm/s", "0 mm/s"]},
    "friction": {"model": "kogut-etsion"},
    "run": {"duration": "1 ms"},
}
PLATE = {
    "shape": "disc",
    "radius": "1.2 mm",
    "supports": "clamped",
    "youngs_modulus": "169 GPa",
    "poisson_ratio": 0.3,
    "thickness": "100 um",
}


def case(**tables: Any) -> Case:
    return Case.model_validate(TABLES | tables)


def air_of(summary: Summary) -> AirFigures:
    assert summary.air is not None
    return summary.air


@pytest.fixture(scope="module")
def shaken() -> Summary:
    return run_case(case()).summary


def test_the_figures_of_a_part_of_the_reference(shaken: Summary) -> None:
    """Gamma at 1 kHz is 2 pi f C/k_c with C = .141671 N s/m and k_c = 1340.28 N/m; the rest by hand likewise."""
    air = air_of(shaken)
    assert air.gap == pytest.approx(88.727749e-9, rel=1e-7)
    assert air.frequency == 1000.0
    assert air.load_share == pytest.approx(2 * math.pi * 1000 * 0.141671 / 1340.28, rel=2e-5)
    assert air.breathing == 0.0  # a platform does not bend
    assert air.escape_speed == pytest.approx(5.4, rel=2e-3)
    assert air.settle_time == pytest.approx(1.0796e-8 / (2e-9 * G), rel=1e-4)
    assert air.drag_rate == pytest.approx(414.9, rel=1e-4)
    assert air.velocity_change == pytest.approx(2 * 2 * math.pi * 1000 * 1e-6, rel=1e-3)  # a sine's
    assert not air.assumed
    assert air.included == "nothing"


def test_a_plate_that_bends_breathes() -> None:
    """Beta by the definition, from the plate's own change of curvature, on contact that the adhesion pulls off."""
    actuators = [{"position": ["0 um", "0 um"], "stroke": "2 um", "frequency": "2 kHz", "cycles": 3}]
    part = {"mass": "2e-9 kg", "position": ["300 um", "200 um"], "size": "95 um"}
    friction = {"model": "coulomb", "coefficient": 0.1, "adhesion": "1.5 uN"}
    tables = {"plate": PLATE, "actuators": actuators, "part": part, "friction": friction}
    result = run_case(Case.model_validate(tables | {"run": {"duration": "1 ms"}}))
    air, surface = air_of(result.summary), result.surface
    path = result.trajectory
    bends = surface.evaluate_along(path.position, path.time).hessian.trace(axis1=1, axis2=2)
    stiffness = 1340.28 * 1.5e-6 / 3.71602e-6  # that of the reference has 3.716 uN
    share = air.load_share
    assert share is not None
    pumped = stiffness * 0.0262 * (95e-6) ** 2 * (bends.max() - bends.min()) / (2e-9 * G + 1.5e-6)
    assert air.breathing == pytest.approx(pumped * share / math.hypot(1, share), rel=2e-2)
    assert air.assumed
    said = " ".join(warnings(result.summary))
    assert "a film of air under the part carries" in said
    assert "pumps air under the part" in said
    assert "assumed, as the friction law states none" in str(lines(result.summary, verbose=True))


def test_warnings_begin_at_their_bounds(shaken: Summary) -> None:
    def texts(**figures: Any) -> str:
        return " ".join(warnings(replace(shaken, air=replace(air_of(shaken), **figures))))

    assert "expect the way to be off by about the whole way" in texts(load_share=0.66)
    assert "expect the way to be off by about 20 %" in texts(load_share=0.2)
    assert "film of air" not in texts(load_share=0.04)
    assert "pumps" not in texts(breathing=0.04)


def test_a_part_that_comes_off_a_slow_plate_does_so_in_a_vacuum_only(shaken: Summary) -> None:
    loose = replace(shaken, outcome=Outcome.DETACHED.value)
    assert "would not come off: air holds it on a plate slower than 5.4 m/s" in " ".join(warnings(loose))
    fast = replace(loose, air=replace(air_of(shaken), velocity_change=6.0))
    assert "would not come off" not in " ".join(warnings(fast))


def test_a_vacuum_has_no_figures_to_warn_of_and_the_same_bits(shaken: Summary) -> None:
    result = run_case(case(air={"pressure": "0 Pa"}))
    assert air_of(result.summary).load_share == air_of(result.summary).drag_rate == 0.0
    assert not [text for text in warnings(result.summary) if " air " in text]
    assert "none: in a vacuum" in str(lines(result.summary, verbose=True))
    assert result.summary.end_position == shaken.end_position


def test_air_slows_a_part_and_rarefied_air_less(tmp_path: Any) -> None:
    ends = {
        text: run_case(case(air={"pressure": text}), tmp_path / text[0] if text == "1 Pa" else None).summary
        for text in ("101325 Pa", "1000 Pa", "1 Pa")
    }
    ways = [summary.distance for summary in ends.values()]
    assert ways[0] < ways[1] < ways[2]
    assert all(summary.energy_balance < 1e-9 and air_of(summary).included == "drag" for summary in ends.values())
    saved = read_run(tmp_path / "1/case")
    assert saved.case.air == case(air={"pressure": "1 Pa"}).air
    assert json.loads(json.dumps(saved.summary["air"]))["pressure"] == 1.0


def test_a_bow_lessens_what_the_air_does() -> None:
    bowed = air_of(run_case(case(air={"bow": "2 um"})).summary)
    assert bowed.gap == pytest.approx(2.0887e-6, rel=1e-4)
    assert bowed.load_share is not None
    assert bowed.load_share < 5e-4


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"air": {"pressure": "-1 Pa"}}, "Input air.pressure of Case must be at least 0"),
        ({"air": {"temperature": "0 K"}}, "Input air.temperature of Case must be greater than 0"),
        ({"air": {}, "run": {"duration": "1 ms", "scheme": "fixed"}}, 'run.scheme of Case must be "events" with .air'),
        (
            {"air": {}, "friction": {"model": "coulomb", "coefficient": 0.1}, "part": TABLES["part"] | {"size": None}},
            "Input part.size of Case is missing; with .air., unless that is a vacuum, it must be a length such as",
        ),
    ],
)
def test_wrong_air_is_refused(tables: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        case(**tables)


def test_a_part_that_nothing_presses_down_or_keeps_has_no_breathing() -> None:
    run = TABLES["run"] | {"gravity": "0 m/s^2"}
    air = air_of(run_case(case(run=run, friction={"model": "coulomb", "coefficient": 0.1})).summary)
    assert (air.breathing, air.settle_time) == (None, None)


def test_a_part_without_a_size_has_no_figures_of_air() -> None:
    part = {key: value for key, value in TABLES["part"].items() if key != "size"}
    summary = run_case(case(part=part, friction={"model": "constant", "limit": "5 nN"})).summary
    assert summary.air is None
    assert not isinstance(summary, PlateSummary)


FILM = {"air": {"film": True}}
SHAKEN: dict[str, Any] = {
    "plate": {"shape": "platform", "motion": {"z": {"stroke": "5 um", "frequency": "1 kHz", "cycle": "sine"}}},
    "friction": {"model": "coulomb", "coefficient": 0.05, "adhesion": "0.5 uN"},
}


@pytest.mark.compiled
def test_a_film_bears_load_and_is_in_the_summary_and_the_files(tmp_path: Any) -> None:
    result = run_case(case(**FILM), tmp_path, csv=True)
    air = air_of(result.summary)
    assert (air.included, result.summary.margins.contact, result.summary.thresholds) == ("film", None, None)
    assert air.largest_gap is not None
    assert air.largest_gap > air.gap
    assert air.film_balance is not None
    assert air.film_balance < 1e-6
    assert not [text for text in warnings(result.summary) if "film of air" in text]
    said = str(lines(result.summary, verbose=True))
    assert "the film of air opens to" in said
    assert "a film carries part of the load" in said
    assert "without it the part would end at" in said
    own = result.trajectory.normal_force - result.trajectory.air_force  # type: ignore[operator]
    assert result.summary.margins.smallest_load == pytest.approx(own.min(), rel=1e-3)
    drag_alone = run_case(case(air={})).summary
    assert air.end_without == drag_alone.end_position
    header, *rows = (tmp_path / "case.csv").read_text().splitlines()
    assert header.endswith("gap [m],air force [N]")
    assert float(rows[-1].split(",")[-2]) == result.trajectory.gap[-1]  # type: ignore[index]
    saved = read_run(tmp_path / "case")
    assert saved.case.air == case(**FILM).air


@pytest.mark.compiled
def test_a_film_that_counts_as_flat_under_a_plate_that_sags_is_warned_of() -> None:
    bent = replace(air_of(run_case(case(**FILM)).summary), sag_over_gap=0.5)
    summary = replace(run_case(case(**FILM)).summary, air=bent)
    assert "sags under the part by up to 0.5 times the gap of the film" in " ".join(warnings(summary))


@pytest.mark.compiled
def test_thin_air_under_a_film_is_a_path_without_air_in_a_sweep_over_the_pressure() -> None:
    free = case(air={"pressure": "0 Pa"}, **SHAKEN)
    cases = [free, *(case(**SHAKEN, **FILM).vary({"air.pressure": value}) for value in (1.0, 101325.0))]
    way, thin, dense = (result.summary.distance for result in run_cases(cases))
    assert thin == pytest.approx(way, rel=1e-3)
    assert abs(dense - way) > 0.02 * way


@pytest.mark.compiled
def test_a_bow_is_found_from_a_track() -> None:
    made = case(**SHAKEN, air={"film": True, "bow": "0.3 um"})
    times = np.linspace(0.1e-3, 1e-3, 10)
    track = Track(times, run_case(made).trajectory.at(times).position)
    found = identify(made.vary({"air.bow": 0.1e-6}), track, ["air.bow"], {"air.bow": ("0.05 um", "1 um")}, threads=1)
    assert found.estimates[0].value == pytest.approx(0.3e-6, rel=1e-3)


FACE = {"mass": "2 ug", "position": ["0 um", "0 um"], "footprint": "disc", "radius": "50 um", "thickness": "50 um"}
TRIANGLE = {
    **{key: FACE[key] for key in ("mass", "position", "thickness")},
    "footprint": "polygon",
    "corners": [["0 um", "0 um"], ["50 um", "0 um"], ["0 um", "50 um"]],
}


@pytest.mark.compiled
def test_a_case_has_a_film_under_a_face(tmp_path: Any) -> None:
    made = case(**SHAKEN, **FILM, part={**FACE, "velocity": ["20 mm/s", "0 mm/s"], "spin": "500 rad/s"})
    result = run_case(made, tmp_path)
    air, path = air_of(result.summary), result.trajectory
    assert air.included == "film"
    assert air.film_balance is not None and air.film_balance < 1e-6
    assert air.end_without is not None and air.largest_gap is not None
    assert path.air_force is not None and np.ptp(path.air_force) > 0
    assert path.heading is not None and path.heading[-1] != 0
    own, adhesion = path.normal_force - path.air_force, made.friction.adhesion
    least = ((path.pressure_margin * own + adhesion) / (own + adhesion)).min()  # what asperities bear
    assert 0 < least < 1  # as no edge lifts
    assert result.summary.least_pressure == pytest.approx(least)
    panels = {panel["label"]: panel for panel in run_data(read_run(tmp_path / "case"))["curves"]["panels"]}
    assert numbers(panels["Pressure"]["lines"][0]["values"]).min() == pytest.approx(least, rel=1e-5)
    assert not [line for line in warnings(result.summary) if "film of air" in line]
    assert any("a film carries part of the load" in text for _, text in lines(result.summary, verbose=True))


ENDS = {
    "shape": "platform",
    "motion": {"x": {"stroke": "1 um", "frequency": "2 kHz", "cycle": "sine", "cycles": 1}},
}


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ({"air": {"film": True, "pressure": "0 Pa"}}, "air.film of Case must be false in a vacuum"),
        ({"air": {"film": "yes"}}, "air.film of Case must be true or false"),
        ({**FILM, "part": TRIANGLE}, r"air.film of Case must be false with a polygon in .part.: only squares, rect"),
        (
            {**FILM, "part": {**FACE, "local_contact": True}},
            "air.film of Case must be false with a footprint and local",
        ),
        (
            {**FILM, "part": FACE, "run": {"duration": "1 ms", "after_tipping": "ignore"}},
            'run.after_tipping of Case must be "stop" with a film of air under a footprint',
        ),
        (
            {**FILM, "friction": {"model": "coulomb", "coefficient": 0.1}},
            "friction.adhesion of Case must be greater than 0 with a film of air",
        ),
        (
            {**FILM, "friction": {"model": "table", "loads": [0.0, 1e-6, 2e-6], "limits": [0.0, 1e-8, 2e-8]}},
            r"friction.loads\[0\] of Case must be below 0 with a film of air",
        ),
        ({**FILM, "plate": ENDS}, "plate.motion.x.cycles of Case must not be given with a film .* ends, at 0.5 ms"),
        ({"part": FACE, "plate": ENDS}, r"plate.motion.x.cycles of Case must not be given with a footprint in .part."),
    ],
)
def test_what_does_not_go_with_a_film_is_refused(tables: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        case(**tables)


@pytest.mark.parametrize("cycle", ["up-down", "sine", "cosine"])
@pytest.mark.parametrize("times", [{}, {"delay": 0.3e-3}, {"cycles": 2}, {"cycles": 2, "delay": 0.3e-3}, {"cycles": 9}])
def test_a_case_knows_the_jumps_of_its_drives(cycle: str, times: dict[str, Any]) -> None:
    waits = {"dwell": 0.1e-3} if cycle == "up-down" else {}
    for degrees in (0, 30, 90, 150, 170, 180, 270, 355):
        own = DriveCase(stroke=1e-6, frequency=1e3, cycle=cycle, phase=math.radians(degrees), **times, **waits)
        known = own.jump(3e-3)
        assert (known and known[1]) == pytest.approx(first_jump([build_drive(own)], 3e-3)), degrees


def test_what_leaves_a_film_out_says_so() -> None:
    plate = {"plate": PLATE, "actuators": [{"position": ["0 um", "0 um"], "stroke": "1 um", "frequency": "1 kHz"}]}
    with pytest.raises(ValueError, match="case of feasibility must have air.film = false"):
        feasibility(Case.model_validate(TABLES | plate | FILM))
