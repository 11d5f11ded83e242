"""The summary of runs with springs, forces and slow and fast drives."""

import json
import math
from contextlib import contextmanager
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from sweeps import DISC
from threadpoolctl import threadpool_info, threadpool_limits

from coupling import build_scene, quick_summary, report, run_case
from coupling.case import ActuatorCase, Case, CoulombCase, PartCase, RunCase
from coupling.display import frames
from coupling.plate_figures import StretchError, part_sag
from coupling.summary import summary_of
from fem_plate import Plate, PlateSection
from fem_plate.analytic import DiscShapes
from meshes import disc

PLATE = {
    "shape": "rectangle",
    "width": 6e-4,
    "height": 4e-4,
    "supports": {"left": "clamped", "right": "simply-supported"},
    "youngs_modulus": 169e9,
    "poisson_ratio": 0.3,
    "thickness": 5e-6,
    "density": 2330,
    "cell_size": 8e-5,
}
ACTUATORS = [
    ActuatorCase(position=(-1e-4, 0.0), stroke=2e-7, frequency=400),
    ActuatorCase(position=(1e-4, 5e-5), stroke=2e-7, frequency=300, cycle="up", stiffness=50.0),
    ActuatorCase(position=(1e-4, -1e-4), force=1e-6, frequency=200),
]


@pytest.fixture(scope="module")
def result():
    case = Case(
        plate=PLATE,
        actuators=ACTUATORS,
        part=PartCase(mass=2e-9, position=(0.0, 0.0)),
        friction=CoulombCase(coefficient=0.3, adhesion=1e-6),
        run=RunCase(duration=2e-3),
    )
    return run_case(case)


@pytest.mark.slow
def test_the_slowest_and_fastest_drive_and_stroke_are_stated_over_the_first_frequency(result):
    s = result.summary
    assert s.drives_over_first == pytest.approx((200 / s.first_frequency, 400 / s.first_frequency))
    assert s.strokes_over_first == pytest.approx((300 / s.first_frequency, 800 / s.first_frequency))
    assert s.drive_over_first == max(s.drives_over_first)
    (text,) = [text for _, text in report.lines(s, verbose=True) if "drive frequency" in text]
    ranges = ["{:.2g}-{:.2g}".format(*ratios) for ratios in (s.drives_over_first, s.strokes_over_first)]
    assert text == "drive frequency / first frequency: {}; stroke rate / first frequency: {}".format(*ranges)
    alike = replace(s, drives_over_first=(0.25, 0.25))
    assert any(
        "drive frequency / first frequency: 0.25; stroke rate" in text for _, text in report.lines(alike, verbose=True)
    )


@pytest.mark.slow
def test_the_quick_summary_is_that_of_the_run_without_a_second_path(result):
    slow = replace(result.summary, path_error=0.0, same_events=True)
    assert quick_summary(result.case, result.scene) == slow


def test_springs_give_and_the_residual_says_how_well_the_rest_is_held(result):
    """Moved by its base, a spring lifts the plate by less than its own stroke; where a force acts nothing is held."""
    heights, wrong = result.shapes.evaluate(result.shapes.points)[0], result.summary.plate_error
    assert 0 < heights[1, 1] < 0.99
    assert wrong < 1e-5
    assert heights[0] == pytest.approx([1, 0, 0], abs=wrong)
    assert result.summary.hold_residual < wrong


def test_the_surface_rises_by_stroke_spring_and_force(result):
    """At 1.25 ms: the first drive has its full stroke, the others are on their way."""
    time = 1.25e-3
    drives = np.array([2e-7, 2e-7 * quintic(0.375), 1e-6 * quintic(0.5)])
    spots = np.array([[0.0, 0.0], [-1e-4, 0.0], [2e-4, 1.5e-4]])
    expected = result.shapes.evaluate(spots, drives)[0]
    assert result.surface.evaluate(spots, time).w == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def quintic(s):
    return 10 * s**3 - 15 * s**4 + 6 * s**5


def summary_with(*actuators, duration=1e-3, plate=DISC | {"density": 2330}):
    case = Case(
        plate=plate,
        actuators=actuators,
        part=PartCase(mass=2e-9, position=(50e-6, 120e-6)),
        friction=CoulombCase(coefficient=0.3, adhesion=1e-6),
        run=RunCase(duration=duration),
    )
    return quick_summary(case, build_scene(case))


@pytest.mark.slow
def test_a_late_stroke_beside_a_busy_drive_is_seen():
    late = [{"cycle": "hold", "dwell": "70.2 ms"}, {"stroke": 5e-6, "frequency": 4000.0}]
    s = summary_with(
        ActuatorCase(position=(-1e-4, 0.0), stroke=5e-8, frequency=1000),
        ActuatorCase(position=(1e-4, 0.0), segments=late),
        duration=0.1,
    )
    assert s.deflection_over_thickness == pytest.approx(1, rel=0.02)
    assert any("times its thickness" in said for said in report.warnings(s))


def test_the_slope_between_actuators_close_to_each_other_is_seen():
    s = summary_with(
        ActuatorCase(position=(90e-6, 40e-6), stroke=2e-6, frequency=300),
        ActuatorCase(position=(98e-6, 40e-6), stroke=0.0, frequency=300),
        duration=2e-3,
    )
    x = np.linspace(85e-6, 103e-6, 181)
    spots = np.stack(np.meshgrid(x, x - 54e-6), axis=-1).reshape(-1, 2)
    truth = np.hypot(*DiscShapes([[90e-6, 40e-6], [98e-6, 40e-6]], 300e-6).evaluate(spots, [2e-6, 0.0])[1].T).max()
    assert 0.9 * truth < s.largest_slope < 1.01 * truth


@pytest.mark.slow
def test_a_stroke_makes_the_plate_ring_alike_however_it_is_written():
    stroke, at, rest = 2e-7, (0.0, 0.0), 1 / 900
    ways = [
        {"cycle": "up", "stroke": stroke, "frequency": 900},
        {"table": [(0.0, 0.0), (rest, stroke)]},
        {"cycle": "up-down", "stroke": stroke, "frequency": 450},
    ]
    errors = [summary_with(ActuatorCase(position=at, **way)).quasi_static_error for way in ways]
    assert errors == pytest.approx([3.3 * 450 / 484.477e3] * 3, rel=1e-4)


def test_a_drive_that_jumps_lets_the_plate_ring_at_any_frequency():
    steady = ActuatorCase(position=(0.0, 0.0), stroke=2e-7, frequency=300, cycle="sine")
    assert not summary_with(steady).plate_rings  # it has been running before the run began
    s = summary_with(steady.model_copy(update={"delay": 1e-4}))
    assert s.plate_rings and s.quasi_static_error is None
    assert any("rings" in said for said in report.warnings(s))
    assert any("it rings where a drive jumps" in text for _, text in report.lines(s))


def test_a_drive_at_rest_counts_for_nothing():
    alone = ActuatorCase(position=(-1e-4, 0.0), stroke=2e-7, frequency=300)
    still = ActuatorCase(position=(1e-4, 0.0), stroke=0.0, frequency=1e5)
    s = summary_with(alone, still)
    assert s.drive_over_first == pytest.approx(300 / s.first_frequency)
    assert s.strokes_over_first == pytest.approx((600 / s.first_frequency,) * 2)


@pytest.mark.slow
def test_long_runs_say_that_their_files_strobe(monkeypatch):
    """2 s of 300 Hz in 20 MB; the extremes are found although 201 even moments fall on whole periods."""
    monkeypatch.setattr(frames, "MAX_BYTES", 20e6)
    case = Case(
        plate=DISC,
        actuators=[{"position": (0.0, 0.0), "stroke": 10e-6, "frequency": 300.0}],
        part={"mass": 2e-9, "position": (100e-6, 0.0)},
        friction={"model": "constant", "limit": 1e-6},
        run={"duration": 2.0},
    )
    scene = build_scene(case)
    summary, steps = quick_summary(case, scene), frames.frame_times(case, scene, 2.0)
    assert summary.deflection_over_thickness == pytest.approx(2.0, rel=1e-6)
    assert 600 < len(steps) < 1500 and summary.frames_per_cycle == pytest.approx((len(steps) - 1) / 600)
    assert any(f"{summary.frames_per_cycle:.2g} steps per cycle" in warning for warning in report.warnings(summary))


@pytest.mark.slow
def test_a_run_keeps_blas_on_one_thread_and_gives_the_others_back():
    """Its many small systems take two to four times as long on more."""

    def threads():
        return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}

    @contextmanager
    def watched(what):
        seen.append(threads())
        yield lambda *_: None

    seen = []
    moving = PartCase(mass=2e-9, position=(0.0, 0.0))
    case = Case(
        plate=PLATE,
        actuators=ACTUATORS[:1],
        part=moving,
        friction=CoulombCase(coefficient=0.3),
        run=RunCase(duration=1e-4),
    )
    with threadpool_limits(limits=2, user_api="blas"):
        run_case(case, progress=watched)
        assert threads() == {2}
    assert seen and all(found == {1} for found in seen)


def test_the_strain_of_bending_is_that_of_the_closed_form_half_a_thickness_from_the_actuator():
    """w = w0 (1 - r^2 + 2 r^2 ln r) bends by 4 w0 ln(r) / a^2 around the actuator: by 4 w0 / a^2 at the rim."""
    s = summary_with(ActuatorCase(position=(0.0, 0.0), stroke=5e-6, frequency=1000))
    curvature = 4 * np.log(300 / 2.5) * 5e-6 / 300e-6**2
    assert s.largest_strain == pytest.approx(2.5e-6 * curvature, rel=1e-4)
    assert s.theory == "linear"
    assert s.stretch_error is None
    assert any(f"strain {100 * s.largest_strain:.2g} % by linear theory" in text for _, text in report.lines(s))
    assert not any("strained" in text for text in report.warnings(s))
    assert any(
        "strained by 0.51 % by linear theory" in text for text in report.warnings(replace(s, largest_strain=0.0051))
    )


def test_a_plate_beyond_linear_theory_names_the_line_to_add():
    s = summary_with(ActuatorCase(position=(0.0, 0.0), stroke=5e-6, frequency=1000))
    (text,) = [text for text in report.warnings(s) if "times its thickness" in text]
    assert 'theory = "von-karman" in [plate]' in text
    assert "path error of about 8 %" in text
    mild = replace(s, deflection_over_thickness=0.3, linear_path_error=0.08 * 0.3**2)
    (text,) = [text for text in report.warnings(mild) if "times its thickness" in text]
    assert "von-karman" not in text


@pytest.mark.parametrize(
    ("plate", "cycle", "stretches", "vibrates"),
    [
        ({}, "up-down", True, True),
        ({"tension": 10.0}, "up-down", False, True),
        ({"foundation": 1e8}, "sine", False, True),
        ({"pressure": 10.0}, "sine", False, True),
        pytest.param({"tension": 10.0, "inertia": True}, "up-down", False, False, marks=pytest.mark.slow),
    ],
)
def test_a_remedy_that_is_named_is_possible(plate, cycle, stretches, vibrates):
    drive = ActuatorCase(position=(0.0, 0.0), stroke=5e-6, frequency=100e3, cycle=cycle)
    s = summary_with(drive, plate=DISC | {"density": 2330.0} | plate)
    s = replace(s, deflection_over_thickness=0.9, linear_path_error=0.07, quasi_static_error=0.2)
    said = " ".join(report.warnings(s))
    assert ('theory = "von-karman"' in said, "inertia = true" in said) == (stretches, vibrates)


@pytest.mark.parametrize(
    ("more", "modulus"), [({}, 169e9 / 0.7), ({"wafer": "100"}, 165.64e9 + 63.94e9 - 2 * 63.94e9**2 / 165.64e9)]
)
def test_strain_has_that_of_a_residual_tension(more, modulus):
    drive = ActuatorCase(position=(0.0, 0.0), stroke=1e-10, frequency=1000)
    plate = {key: value for key, value in DISC.items() if not (more and key in ("youngs_modulus", "poisson_ratio"))}
    s = summary_with(drive, plate=plate | more | {"thickness": 10e-6, "tension": 1e3})
    assert s.largest_strain == pytest.approx(1e3 / 10e-6 / modulus, rel=1e-3)


def test_a_plate_thicker_than_wide_has_a_summary_without_a_strain():
    """All of it is nearer to an actuator than half its thickness, where strains of thin plates mean nothing."""
    drive = ActuatorCase(position=(0.0, 0.0), stroke=1e-9, frequency=1000)
    s = summary_with(drive, plate=DISC | {"thickness": 1e-3})
    assert s.largest_strain is None and s.largest_slope > 0


def test_of_a_plate_that_stretches_the_summary_has_errors_and_strain():
    s = summary_with(ActuatorCase(position=(0.0, 0.0), stroke=5e-6, frequency=1000))
    error = StretchError(mesh=2e-4, reduction=3e-5, pieces=4e-6)
    new = {"theory": "von-karman", "linear_path_error": None, "stretch_error": error, "stretch_solutions": 7}
    s = replace(s, largest_strain=0.004, **new)
    texts = [text for _, text in report.lines(s, verbose=True)]
    assert (
        "stretching from 7 full solutions, good to 2.0e-04 (estimated); the reduced model adds 3.0e-05, its "
        "pieces in time 4.0e-06"
    ) in texts
    assert any(text.startswith("deflection 1 times the thickness (von Karman's theory), slope") for text in texts)
    assert any(text.endswith("strain 0.4 %") for text in texts)
    assert not any("times its thickness" in text or "accurate to" in text for text in report.warnings(s))
    assert summary_of(json.loads(json.dumps(s.as_dict()))) == s
    coarse = replace(s, stretch_error=replace(error, mesh=2e-3), largest_strain=0.006, largest_slope=0.3)
    texts = report.warnings(coarse)
    assert "The plate that stretches is accurate to 2.0e-03 of its deflection only; take smaller cells." in texts
    assert any("strained by 0.6 %; silicon breaks near 1 %" in text for text in texts)
    assert any("as steep as 0.3" in text for text in texts)


@pytest.mark.slow
def test_strain_is_that_off_corners_where_moments_are_infinite():
    """At such a corner it would grow without end as cells shrink there."""
    outline = {"corners": [(0.0, 0.0), (6e-4, 0.0), (6e-4, 3e-4), (3e-4, 3e-4), (3e-4, 6e-4), (0.0, 6e-4)]}
    x, y = 2e-4, 2e-4
    cases = [
        Case(
            plate={key: PLATE[key] for key in ("youngs_modulus", "poisson_ratio", "thickness")}
            | outline
            | {"shape": "polygon", "cell_size": size},
            actuators=[ActuatorCase(position=(x, y), stroke=5e-7, frequency=400)],
            part=PartCase(mass=2e-9, position=(x - 5e-5, y)),
            friction=CoulombCase(coefficient=0.3, adhesion=1e-6),
            run=RunCase(duration=1e-3),
        )
        for size in (8e-5, 4e-5)
    ]
    strains = [quick_summary(case, build_scene(case)).largest_strain for case in cases]
    assert strains[0] == pytest.approx(strains[1], rel=0.03) and strains[1] < 0.003


@pytest.mark.parametrize("truncation", [None, 1e-4])
def test_a_part_on_an_actuator_sags_as_its_spring_yields(truncation):
    """The clamped plate's own stiffness 16 pi D / a^2 and the spring's add up; a force that floats adds none."""
    radius, weight = 300e-6, 2e-9 * 9.80665
    section = PlateSection(169e9, 0.3, 5e-6)
    plate = Plate(disc(radius, radius / 4), section)
    of_plate = 16 * np.pi * section.rigidity / radius**2
    on_actuator = SimpleNamespace(position=np.zeros((1, 2)))
    for spring, expected in ((1.0, weight / (of_plate + 1)), (0.0, weight / of_plate), (np.inf, 0.0)):
        shapes = plate.influence([[0.0, 0.0]], spring, truncation=truncation)
        assert part_sag(plate, shapes, on_actuator, weight) == pytest.approx(expected, rel=1e-3)
    beside = SimpleNamespace(position=np.array([[1e-9, 0.0]]))
    spring = plate.influence([[0.0, 0.0]], 1.0)
    assert part_sag(plate, spring, beside, weight) == pytest.approx(weight / (of_plate + 1), rel=1e-3)
    assert weight / (of_plate + 1) == pytest.approx(1.818e-11, rel=1e-3)


def test_a_part_near_the_rim_sags_alike_on_any_cells():
    """On small cells at its own rim, also where those at the opposite one are small for an actuator there."""
    section, actuator = PlateSection(169e9, 0.3, 5e-6), [[0.99, 0.0]]
    for place in ([-0.985, 0.02], [-0.9, 0.0], [-0.7, 0.1]):
        part = SimpleNamespace(position=np.array([place]))
        coarse, fine = (Plate(disc(1.0, cell), section) for cell in (0.5, 0.08))
        with_part = fine.influence([*actuator, place], [np.inf, 0.0])
        found = part_sag(coarse, coarse.influence(actuator), part, 1.0)
        assert found == pytest.approx(with_part.own_heights()[1], rel=2e-3)


@pytest.mark.parametrize("kind", ["linear", "stretching", "vibrating", "platform"])
def test_a_summary_is_read_back_from_its_json(ran, kind):
    summary = replace(ran(kind).summary, path_error=math.inf, gravity=(0.0, 1.0, -9.81))
    figures = json.loads(json.dumps(summary.as_dict()))
    assert summary_of(dict(reversed(figures.items()))) == summary
    assert math.isnan(summary_of(figures | {"energy_balance": math.nan}).energy_balance)
    with pytest.raises(ValueError, match="the summary has no valid slips, margins, as that of another version may"):
        summary_of({**figures, "slips": "many", "margins": {"slip": 3}})
