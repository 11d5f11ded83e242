"""The contact of a part on a bent plate, beside that of flat faces which a run takes."""

from types import SimpleNamespace

import numpy as np
import pytest

from coupling import Case, build_friction, run_case, warnings
from coupling.advice import Setting, Trials
from coupling.case import InputError
from coupling.part import bent_under
from coupling.run import build_scene
from particle import polynomial_surface

CASE = {
    "plate": {"shape": "platform"},
    "part": {"mass": "2e-9 kg", "position": ["0 um", "0 um"], "size": "100 um"},
    "friction": {"model": "kogut-etsion", "preset": "paper"},
    "run": {"duration": "1 ms"},
}
PATH = SimpleNamespace(position=np.array([[0.0, 0.0], [1e-4, 0.0]]), time=np.array([0.0, 1e-3]))
U = [(0, 0), (9, 0), (9, 9), (6, 9), (6, 3), (3, 3), (3, 9), (0, 9)]
U_SHAPE = {
    "footprint": "polygon",
    "corners": [[f"{10 * x} um", f"{10 * y} um"] for x, y in U],
    "thickness": "50 um",
    "mass": "2e-9 kg",
    "position": ["0 um", "0 um"],
    "local_contact": True,
}
POINT = SimpleNamespace(**vars(PATH), heading=None)
EVERYWHERE = SimpleNamespace(gap=lambda places: np.ones(len(places)))


def bent(xx, yy, **tables):
    return bent_under(Case.model_validate(CASE | tables), EVERYWHERE, bowl(xx, yy), POINT)


def bowl(xx, yy):
    return polynomial_surface([[0, 0, yy / 2], [0, 0, 0], [xx / 2, 0, 0]], size=1e-3)


def case_with(part):
    return Case.model_validate(CASE | {"part": part})


@pytest.mark.parametrize(
    ("xx", "yy", "friction", "pull_off"),
    [(-80, -80, 11.834602, 1.3632966), (60, 60, 3.780255, 0.9104900), (80, -80, 5.385862, 0.9215777)],
)
def test_friction_and_pull_off_fall_as_on_a_face_of_that_curvature(xx, yy, friction, pull_off):
    found = bent(xx, yy)
    assert found.friction == pytest.approx(friction / 41.79725, rel=1e-5)
    assert found.pull_off == pytest.approx(pull_off / 2.982497, rel=1e-5)
    assert found.curvature == pytest.approx(abs(xx) * 1e-4)
    roughness = Case.model_validate(CASE).friction.roughness
    assert found.sag == pytest.approx(
        abs(xx) * 1e-8 / 4 / roughness
    )  # half the curvature times the half diagonal squared


def test_the_curvature_is_that_along_the_face_s_own_axes():
    long = {"footprint": "rectangle", "sides": ["200 um", "20 um"], "thickness": "20 um", "mass": "1 ug"}
    part = long | {"position": ["0 um", "0 um"]}
    path = SimpleNamespace(**vars(PATH), heading=np.full(2, np.pi / 2))
    along, across = (bent_under(case_with(part), EVERYWHERE, bowl(xx, yy), path) for xx, yy in ((0, 60), (60, 0)))
    plain = bent_under(case_with(part), EVERYWHERE, bowl(60, 0), SimpleNamespace(**vars(PATH), heading=np.zeros(2)))
    assert along.friction == pytest.approx(plain.friction, rel=1e-6) and across.friction > 2 * along.friction


def test_a_face_that_is_flat_enough_and_other_laws_have_no_bent_contact():
    assert bent(1.0, 0.0)[2:] == (None, None)
    assert bent(1e5, 0.0)[2:] == (None, None)
    assert bent(60, 60, friction={"model": "constant", "limit": "1 nN"})[1:] == (None, None, None)


PLATE = {
    "plate": {
        "shape": "disc",
        "radius": "700 um",
        "supports": "clamped",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "20 um",
    },
    "actuators": [{"position": ["-200 um", "0 um"], "stroke": "2 um", "frequency": "1000 Hz", "cycle": "sine"}],
    "part": {"mass": "2e-9 kg", "position": ["-120 um", "-80 um"], "size": "95 um"},
    "friction": {"model": "kogut-etsion", "preset": "paper"},
    "run": {"duration": "1 ms"},
}


def test_a_run_s_margins_are_those_of_the_local_law():
    case = Case.model_validate(PLATE | {"part": PLATE["part"] | {"local_contact": True}})
    result = run_case(case)
    margin, law = result.summary.margins.slip, build_friction(case)
    assert result.summary.outcome == "stuck"
    surface, place = result.scene.surface, np.array([case.part.position])
    h = surface.evaluate_along(place, np.array([margin.time])).hessian[0]
    at = result.trajectory.contact_at([margin.time])
    needed = np.linalg.norm(at.friction[0])
    assert margin.value == pytest.approx(needed / law.on_surface(h).friction_limit(at.normal_force[0]), rel=1e-4)
    flat = run_case(Case.model_validate(PLATE))
    assert margin.value > 1.05 * flat.summary.margins.slip.value
    assert result.summary.thresholds.slips_from < 0.98 * flat.summary.thresholds.slips_from
    assert any("flat faces" in text for text in warnings(flat.summary))
    assert not any("flat faces" in text for text in warnings(result.summary))


@pytest.mark.slow
def test_a_face_s_run_follows_the_local_law_with_margins_of_its_own():
    face = {"footprint": "rectangle", "sides": ["95 um", "60 um"], "thickness": "0.5 um", "local_contact": True}
    part = {"mass": "2e-9 kg", "position": ["-120 um", "-80 um"], "heading": "90 deg"} | face
    case = Case.model_validate(PLATE | {"part": part})
    result = run_case(case)
    s, law = result.summary, build_friction(case)
    assert (s.outcome, s.pressure, s.least_pressure) == ("stuck", "local", None)
    assert not any("flat faces" in text for text in warnings(s))
    (x, y), weights = case.part.face.rule(8)[0].T, case.part.face.rule(8)[1]
    places = np.column_stack([-y, x]) + case.part.position
    h = weights @ result.scene.surface.evaluate_along(places, np.full(len(x), s.margins.slip.time)).hessian.reshape(
        -1, 4
    )
    h = h.reshape(2, 2)
    at = result.trajectory.contact_at([s.margins.slip.time])
    turned = law.on_surface([[h[1, 1], -h[0, 1]], [-h[0, 1], h[0, 0]]])
    needed = np.linalg.norm(at.friction[0])
    assert s.margins.slip.value == pytest.approx(needed / turned.friction_limit(at.normal_force[0]), rel=2e-3)
    borne = at.normal_force[0] + law.pull_off - at.bend_loss[0]
    assert 0.2 * turned.pull_off < borne < turned.pull_off + at.normal_force[0]


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"friction": {"model": "coulomb", "coefficient": 0.1}}, "part.local_contact of Case must be false with model"),
        ({"run": {"duration": "1 ms", "scheme": "paper"}}, "run.scheme of Case must be"),
        ({"friction": CASE["friction"] | {"contact_area": "9e3 um^2"}}, "contact_area of Case must not be given with"),
        ({"part": U_SHAPE}, "part.corners of Case must outline a face all of which its centroid sees"),
    ],
)
def test_what_a_local_contact_does_not_go_with_is_refused(tables, words):
    with pytest.raises(InputError, match=words):
        Case.model_validate(CASE | {"part": CASE["part"] | {"local_contact": True}} | tables)
    Case.model_validate(CASE | {"part": U_SHAPE | {"local_contact": False}})


def test_trials_of_another_rough_contact_keep_the_area_of_the_face():
    face = {"footprint": "rectangle", "sides": ["200 um", "60 um"], "thickness": "1 um"}
    case = Case.model_validate(CASE | {"part": face | {"mass": "2e-9 kg", "position": ["0 um", "0 um"]}})
    still = SimpleNamespace(outcome="stuck", distance=0.0)
    trials = Trials(SimpleNamespace(case=case, scene=build_scene(case), trajectory=still, summary=None), 1.0)
    assert trials.law(Setting(plasticity=6.0)).contact_area == pytest.approx(1.2e-8)
