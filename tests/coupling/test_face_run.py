"""Cases whose part has a footprint: what is read, refused, computed and written."""

import csv
import math
from dataclasses import replace

import h5py
import numpy as np
import pytest

from active_surface.views import write_run_page
from coupling import Case, InputError, compare, read_run, run_case
from coupling.case import read_case, write_case
from coupling.part import build_friction, build_part
from coupling.report import lines
from particle import Body, CoulombAdhesion, Drive, EventKind, Footprint, Micropart, platform_surface, simulate

TABLES = {
    "plate": {"shape": "platform", "motion": {"x": {"stroke": "0.4 um", "frequency": "500 Hz", "cycle": "cosine"}}},
    "part": {
        "footprint": "rectangle",
        "sides": ["100 um", "60 um"],
        "thickness": "20 um",
        "density": "2330 kg/m^3",
        "position": ["10 um", "0 um"],
        "heading": "30 deg",
        "spin": "100 rad/s",
    },
    "friction": {"model": "coulomb", "coefficient": 0.3},
    "run": {"duration": "6 ms"},
    "name": "face",
}


def case_of(**tables):
    return Case.model_validate(TABLES | {name: TABLES[name] | keys for name, keys in tables.items()})


def part_of(**keys):
    rest = {key: value for key, value in TABLES["part"].items() if key not in ("footprint", "sides")}
    return Case.model_validate(TABLES | {"part": rest | keys})


def refusal(changes):
    """What is said of tables with other ones in their place, a line each."""
    with pytest.raises(InputError) as error:
        Case.model_validate(TABLES | changes)
    return "\n".join(f"{field} {message}" for field, message in error.value.problems)


def test_mass_and_height_follow_from_the_block():
    case = case_of()
    assert case.part.mass == pytest.approx(100e-6 * 60e-6 * 20e-6 * 2330)
    assert case.part.centre_height == 1e-5
    thicker = case.vary({"part.thickness": "40 um", "part.heading": "45 deg"})
    assert thicker.part.mass == pytest.approx(2 * case.part.mass) and thicker.part.centre_height == 2e-5
    assert thicker.part.heading == pytest.approx(math.pi / 4)
    assert case.footprint == pytest.approx(1e-4)
    assert isinstance(build_part(part_of(footprint="disc", radius="50 um")), Body)


def test_a_rough_contact_has_the_area_of_the_face():
    rough = case_of().vary({"friction": {"model": "kogut-etsion", "preset": "paper"}})
    square = rough.vary(
        {
            "friction": {"model": "kogut-etsion", "preset": "paper", "contact_area": "1e4 um^2"},
            "part": {"mass": 2e-9, "position": (0.0, 0.0)},
        }
    )
    assert isinstance(build_part(square), Micropart)
    ratio = build_friction(rough).pull_off / build_friction(square).pull_off
    assert ratio == pytest.approx(0.6, rel=1e-6)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"footprint": "disc"}, 'part.radius is missing; with footprint = "disc" it must be a length'),
        ({"radius": "50 um"}, 'part.radius must not be given with footprint = "rectangle", which has sides'),
        ({"mass": "1 ug"}, "part.density must not be given with mass"),
        ({"density": None}, 'part.mass is missing; it must be a mass such as "2e-9 kg", or give density instead'),
        ({"thickness": None}, "part.thickness is missing; with a footprint it must be a length"),
        ({"size": "1 um"}, "part.size must not be given with a footprint, which has sides"),
        ({"footprint": None}, "part.sides must not be given without a footprint"),
        ({"sides": ["1 um"]}, "part.sides must be two lengths, along its x and y; got"),
        (
            {"footprint": "polygon", "sides": None, "corners": [["0 um", "0 um"], ["1 um", "1 um"], ["2 um", "2 um"]]},
            "part.corners must be three or more corners, in order around the part, whose sides do not cross",
        ),
    ],
)
def test_keys_that_do_not_go_together_are_refused(keys, said):
    given = {key: value for key, value in (TABLES["part"] | keys).items() if value is not None}
    assert said in refusal({"part": given})


@pytest.mark.parametrize(
    ("table", "keys", "said"),
    [
        ("run", {"scheme": "fixed"}, 'run.scheme must be "events" with a footprint'),
        ("run", {"after_detachment": "fly"}, 'run.after_detachment must be "stop" with a footprint'),
        ("friction", {"model": "kogut-etsion", "coefficient": None, "contact_area": "1 um^2"}, "friction.contact_area"),
    ],
)
def test_what_does_not_go_with_a_face_is_refused(table, keys, said):
    changed = {key: value for key, value in (TABLES[table] | keys).items() if value is not None}
    assert said in refusal({table: changed})


def test_a_point_does_not_tip():
    point = {"mass": "1 ug", "position": ["0 um", "0 um"]}
    wrong = refusal({"part": point, "run": {"duration": "1 ms", "after_tipping": "ignore"}})
    assert wrong == 'run.after_tipping must be "stop" without a footprint in [part]: a point does not tip'


def test_all_of_the_part_must_be_on_the_plate():
    plate = {"shape": "disc", "radius": "300 um", "thickness": "5 um", "youngs_modulus": "169 GPa"}
    plate |= {"poisson_ratio": 0.3}
    actuators = [{"position": ["0 um", "0 um"], "stroke": "1 um", "frequency": "100 Hz"}]
    part = TABLES["part"] | {"position": ["0 um", "260 um"]}
    wrong = refusal({"plate": plate, "actuators": actuators, "part": part})
    assert wrong.startswith("part.position must put all of the part on the plate; got one that reaches ")


def test_a_disc_is_not_over_the_rim_between_two_corners_of_its_drawing():
    plate = {"shape": "disc", "radius": "300 um", "thickness": "5 um", "youngs_modulus": "169 GPa"}
    plate |= {"poisson_ratio": 0.3}
    actuators = [{"position": ["0 um", "0 um"], "stroke": "1 um", "frequency": "100 Hz"}]
    turned = math.pi / 48  # half way between two
    part = {"footprint": "disc", "radius": "50 um", "thickness": "20 um", "mass": "1 ug"}
    part |= {"position": [2.5005e-4 * math.cos(turned), 2.5005e-4 * math.sin(turned)]}
    assert refusal({"plate": plate, "actuators": actuators, "part": part}).startswith("part.position must put all of")


def test_a_mass_takes_the_place_of_a_density():
    assert case_of().vary({"part.mass": "1 ug"}).part.mass == pytest.approx(1e-9)
    assert case_of().vary({"part.mass": "1 ug"}).part.density is None


@pytest.mark.compiled
@pytest.mark.parametrize(("cycle", "at_once"), [("up-down", False), ("cosine", True)])
def test_a_part_that_tips_is_drawn_and_read_back_as_lost(tmp_path, cycle, at_once):
    shaken = TABLES["plate"] | {"motion": {"x": {"stroke": "20 um", "frequency": "500 Hz", "cycle": cycle}}}
    high = TABLES["part"] | {"thickness": "300 um", "spin": "0 rad/s"}
    case = Case.model_validate(
        TABLES | {"plate": shaken, "part": high, "friction": {"model": "coulomb", "coefficient": 1}}
    )
    result = run_case(case, output=tmp_path)
    assert result.summary.outcome == "tipped" and result.files[-1].name == "face.png"
    assert result.summary.least_pressure == pytest.approx(0, abs=1e-6) or at_once
    assert (result.summary.end_time == 0) is at_once
    saved = read_run(tmp_path / "face")
    assert saved.loss.kind is EventKind.TIPS and saved.loss.heading == result.trajectory.events[-1].heading
    write_run_page(saved, tmp_path / "face.html")
    assert "tipped" in (tmp_path / "face.html").read_text()


@pytest.mark.compiled
def test_a_part_that_rests_on_a_still_plate_stays():
    still = run_case(case_of().vary({"plate.motion": {"x": {"stroke": "0.4 um", "frequency": "500 Hz", "cycles": 1}}}))
    assert still.trajectory.stays and "do not move it again" in still.trajectory.sentence
    later = {"stroke": "40 um", "frequency": "90 Hz", "delay": "8 ms"}
    again = run_case(case_of().vary({"plate.motion": {"x": later}, "part.spin": 0.0}))
    assert again.summary.outcome == "stuck" and again.trajectory.stays is False


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("said", "tables"),
    [
        ("linear over", {}),
        ("uniform over", {"part": TABLES["part"] | {"pressure": "uniform"}}),
        ("None", {"part": {"mass": "1 ug", "position": ["0 um", "0 um"]}}),
    ],
)
def test_a_run_states_its_law_of_pressure(said, tables):
    summary = run_case(Case.model_validate(TABLES | {"run": {"duration": "0.1 ms"}} | tables)).summary
    assert str(summary.as_dict()["pressure"]) in said and "pressure" not in dict(lines(summary))
    assert dict(lines(summary, verbose=True)).get("pressure", "None").startswith(said)


@pytest.mark.compiled
def test_a_run_turns_and_says_so(tmp_path):
    result = run_case(case_of(), output=tmp_path, csv=True)
    path, summary = result.trajectory, result.summary
    assert abs(path.heading[-1] - path.heading[0]) > 0.01
    assert summary.turned == path.heading[-1] - path.heading[0] and summary.end_heading == path.heading[-1]
    assert summary.least_pressure == pytest.approx(path.pressure_margin.min())  # nothing adheres
    assert dict(lines(summary))["turn"].startswith(f"{math.degrees(summary.turned):+.4f} degrees, to a heading of ")
    rounded = replace(summary, turned=-1e-15, end_heading=-1e-15, least_pressure=-7e-14, end_position=(-1e-15, 0.0))
    said = dict(lines(rounded))
    still = "+0.0000 degrees, to a heading of 0.0000 degrees"
    assert said["turn"] == f"{still}; least pressure under the part 0 of the mean"
    assert said["end"].startswith("(0.0000, 0.0000) um")
    beside = compare(*[replace(result, summary=rounded)] * 2).lines
    assert [text.split() for label, text in beside if label.startswith("turned")] == [["+0.0000", "deg"] * 2]
    # At rest, after its spin: the largest acceleration over that which friction bears, without a torque.
    largest = 2e-7 * (2 * math.pi * 500) ** 2 / (0.3 * 9.80665)
    assert summary.margins.slip.value == pytest.approx(largest, rel=1e-5)
    assert np.nanmax(result.margin_curves.slip) == pytest.approx(largest, rel=1e-2)

    with (tmp_path / "face.csv").open() as file:
        rows = list(csv.DictReader(file))
    samples = path.at([float(row["time [s]"]) for row in rows])
    assert [float(row["heading [rad]"]) for row in rows] == pytest.approx(samples.heading, abs=1e-12)

    saved = read_run(tmp_path / "face")
    face = Footprint.rectangle(1e-4, 6e-5)
    with h5py.File(tmp_path / "face.part.vtkhdf") as file:
        points, heading = file["VTKHDF/Points"][:].reshape(-1, 5, 3), file["VTKHDF/PointData/heading"][::5]
    assert saved.position == pytest.approx(points[:, 0], abs=0)
    assert points[:, 1:, :2] == pytest.approx(face.outline(points[:, 0, :2], heading), abs=1e-15)
    assert points[:, :, 2] == pytest.approx(0.0, abs=1e-15)
    assert saved.to_xarray()["heading"].values[-1] == path.heading[-1]
    drawn = [line.get_xydata() for line in result.plot().axes[0].lines]
    first = face.outline(path.position[0], path.heading[0])
    assert any(len(data) == 5 and np.ptp(data, axis=0) == pytest.approx(np.ptp(first, axis=0) * 1e6) for data in drawn)


TURN = {"stroke": "0.1 rad", "frequency": "70 Hz", "cycle": "sine", "phase": "0.5 rad"}


@pytest.mark.compiled
def test_a_platform_turns_a_part_as_it_does_in_python(tmp_path):
    sway = {"stroke": "20 um", "frequency": "100 Hz", "cycle": "sine"}
    case = case_of(plate={"motion": {"x": sway, "turn": TURN}}, part={"heading": "0 deg", "spin": "0 rad/s"})
    assert read_case(write_case(case, tmp_path / "turned.toml")).plate == case.plate
    path = run_case(case).trajectory
    drives = Drive(20e-6, 100.0, cycle="sine"), Drive(0.1, 70.0, cycle="sine", phase=0.5)
    table = platform_surface(x=drives[0], turn=drives[1], size=40e-6)
    body = Body(Footprint.rectangle(100e-6, 60e-6), 20e-6, case.part.mass, position=(10e-6, 0.0))
    same = simulate(table, body, CoulombAdhesion(0.3), 6e-3)
    for name in ("position", "heading", "spin"):
        assert getattr(path, name).tobytes() == getattr(same, name).tobytes()
    assert path.energy.balance < 1e-12 and case.plot().axes[-1].get_ylabel() == "turn of the platform [mrad]"


@pytest.mark.compiled
def test_the_work_of_a_turn_that_carries_a_part_is_its_kinetic_energy():
    case = case_of(plate={"motion": {"turn": TURN}}, part={"heading": "0 deg", "spin": "0 rad/s"})
    path = run_case(case).trajectory
    rate = 0.1 * 2 * math.pi * 70 * np.cos(2 * math.pi * 70 * path.time + 0.5)
    inertia = case.part.mass * (1e-5**2 + (100e-6**2 + 60e-6**2) / 12)  # about the platform's origin
    assert path.outcome.value == "stuck" and np.ptp(path.heading) == 0
    assert path.energy.kinetic == pytest.approx(inertia * rate**2 / 2, rel=1e-9)
    assert path.energy.work == pytest.approx(
        inertia * (rate**2 - rate[0] ** 2) / 2, abs=1e-9 * inertia * rate.max() ** 2
    )


def test_a_turn_is_an_angle_under_a_footprint():
    motion = {"shape": "platform", "motion": {"turn": TURN}}
    point = {"mass": "1 ug", "position": ["0 um", "0 um"]}
    said = "plate.motion.turn must not be given without a footprint in [part]: a point has no heading"
    assert refusal({"plate": motion, "part": point}) == said
    for keys, said in (
        (TURN | {"stroke": "5 um"}, 'plate.motion.turn.stroke must be an angle such as "90 deg"'),
        (
            {"frequency": "70 Hz"},
            'plate.motion.turn.stroke is missing; it must be an angle such as "90 deg", or use a table',
        ),
        ({"table": [["0 ms", "0 um"], ["1 ms", "1 um"]]}, "plate.motion.turn.table"),
        ({"table": ["0 ms"]}, "plate.motion.turn.table must be two or more points, each a time and an angle"),
    ):
        assert said in refusal({"plate": {"shape": "platform", "motion": {"turn": keys}}})
    steps = [{"stroke": "5 deg", "frequency": "70 Hz", "cycle": "up"}, {"cycle": "hold", "dwell": "1 ms"}]
    turned = case_of(plate={"motion": {"turn": {"segments": steps}}}).plate.motion.turn
    assert turned.segments[0].stroke == pytest.approx(math.radians(5))
