"""Cases of one plate: shapes that are used again, batches, and the bits of single runs."""

import numpy as np
import pytest
from sweeps import DISC

from coupling import (
    Case,
    InputError,
    PathTask,
    batch,
    build_friction,
    build_surface,
    follow,
    follow_each,
    follow_part,
    run_case,
    run_cases,
)
from fem_plate import Plate
from particle import Micropart, Samples

ACTUATORS = [
    {"position": ("-75 um", "0 um"), "stroke": "60 um", "frequency": "400 Hz"},
    {"position": (75e-6, 0), "stroke": 60e-6, "frequency": 300},
]
PLATE = DISC | {"cell_size": "80 um", "density": 2330}


def case(**tables):
    """A case from dicts, with quantities as texts and as SI numbers."""
    given = {
        "plate": PLATE,
        "actuators": ACTUATORS,
        "part": {"mass": "2e-9 kg", "position": ("-140 um", "20 um")},
        "friction": {"model": "constant", "limit": "40 nN"},
        "run": {"duration": "2 ms"},
    }
    return Case(**(given | tables))


def same(one, other):
    """Whether two results have the same path, bit for bit, and summary."""
    rows = (np.array_equal(getattr(one.trajectory, key), getattr(other.trajectory, key)) for key in Samples._fields)
    return all(rows) and one.summary == other.summary


def counted(monkeypatch):
    """A list that gets an entry whenever a plate is solved for two actuators; a check of runs adds the part to them."""
    solved, influence = [], Plate.influence

    def noted(plate, points, *rest, **more):
        solved.extend([plate] if len(points) == 2 else [])
        return influence(plate, points, *rest, **more)

    monkeypatch.setattr(Plate, "influence", noted)
    return solved


@pytest.fixture(scope="module")
def result():
    return run_case(case())


@pytest.mark.compiled
def test_a_plate_is_not_solved_again_and_the_bits_are_the_same(result, monkeypatch):
    varied = result.case.vary({"actuators.*.stroke": "50 um", "part.mass": 3e-9, "plate.top_face": False})
    expected = run_case(varied)
    solved = counted(monkeypatch)
    assert same(run_case(varied, shapes=result.shapes), expected) and solved == []
    assert not same(expected, result)


OTHER_PLATES = [
    ({"plate.thickness": "6 um"}, "theirs has thickness 5e-06, not 6e-06"),
    ({"plate.radius": "301 um"}, "theirs has another outline or other cells"),
    ({"plate.cell_size": "70 um"}, "theirs has another outline or other cells"),
    ({"plate.supports": "simply-supported"}, r"theirs has supports {'rim': 'clamped'}, not {'rim': 'simply-supp"),
    ({"plate.tension": "1 N/m"}, "theirs has tension 0.0, not 1.0"),
    ({"actuators.1.position.0": "76 um"}, "theirs has actuators at other places"),
    ({"actuators.1.stiffness": "1e4 N/m"}, "theirs has actuators of another stiffness"),
    (
        {"plate.youngs_modulus": "1 GPa", "plate.poisson_ratio": 0.2},
        r"theirs has youngs_modulus 1.69e\+11, not 1e\+09 and poisson_ratio 0.3, not 0.2",
    ),
]


@pytest.mark.compiled
def test_shapes_of_another_plate_are_refused(result):
    for changes, message in OTHER_PLATES:
        with pytest.raises(ValueError, match=f"^Input shapes of run_case must be of the case's plate; {message}"):
            run_case(result.case.vary(changes), shapes=result.shapes)


@pytest.mark.slow
@pytest.mark.compiled
def test_shapes_serve_a_plate_with_inertia_too(result):
    ringing = result.case.vary({"plate.inertia": True, "run.duration": "0.1 ms"})
    assert same(run_case(ringing, shapes=result.shapes), run_case(ringing))


@pytest.mark.slow
@pytest.mark.compiled
def test_a_batch_has_the_bits_of_single_runs_and_solves_each_plate_once(result, monkeypatch):
    base = result.case
    cases = [
        base,
        base.vary({"friction": {"model": "coulomb", "coefficient": 0.2}, "part.velocity.0": "1 mm/s"}),
        base.vary({"run.surface_tolerance": 1e-7}),
        base.vary({"run.scheme": "fixed", "run.duration": "0.1 ms"}),
        base.vary({"plate.top_face": False}),
        base.vary({"plate.thickness": "6 um"}),
        base.vary({"plate.inertia": True, "run.duration": "0.1 ms"}),
    ]
    expected = [run_case(one) for one in cases]
    solved = counted(monkeypatch)
    found = run_cases(cases, threads=2)
    assert len(solved) == 2  # of two thicknesses
    assert [one.case for one in found] == cases
    assert all(same(one, other) for one, other in zip(found, expected, strict=True))


def test_platforms_come_in_batches_too():
    shaken = {"shape": "platform", "motion": {"x": {"stroke": "20 um", "frequency": "200 Hz"}}}
    base = case(plate=shaken, actuators=[], part={"mass": 2e-9, "position": (0, 0)})
    cases = [base, base.vary({"plate.motion.x.stroke": "30 um"}), base.vary({"friction.limit": "20 nN"})]
    found = run_cases(cases)
    assert all(same(one, run_case(other)) for one, other in zip(found, cases, strict=True))
    assert run_cases([]) == []
    with pytest.raises(ValueError, match="^Input shapes of run_case must not be given for a platform"):
        run_case(base, shapes=object())
    with pytest.raises(ValueError, match="^Input threads of run_cases must be at least 1; got 0"):
        run_cases([base], threads=0)


@pytest.mark.parametrize(
    ("run", "given", "message"),
    [
        (run_case, "a.toml", "Input case of run_case must be a Case, as read_case reads it from a file; got 'a.toml'"),
        (run_cases, "a.toml", "Input cases of run_cases must be a list of cases; got 'a.toml'"),
        (run_cases, case(), "Input cases of run_cases must be a list of cases; got Case 'case'"),
        (run_cases, [case(), None], r"Input cases\[1\] of run_cases must be a Case, .* got None"),
    ],
)
def test_what_is_no_case_is_refused(run, given, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        run(given)


def test_paths_that_fail_together_are_followed_one_by_one(monkeypatch):
    shaken = {"shape": "platform", "motion": {"x": {"stroke": "20 um", "frequency": "200 Hz"}}}
    base = case(plate=shaken, actuators=[], part={"mass": 2e-9, "position": (0, 0)})
    surface, law = build_surface(base), build_friction(base)
    many, counts, short = batch.simulate_many, [], base.run.model_copy(update={"duration": 1e-3})

    def failing(surface, parts, *rest):
        counts.append(len(parts))
        if any(part.mass == 3e-9 for part in parts):
            raise RuntimeError("it went wrong")
        return many(surface, parts, *rest)

    monkeypatch.setattr(batch, "simulate_many", failing)
    masses, runs = (1e-9, 3e-9, 4e-9, 5e-9), (base.run, base.run, short, base.run)
    tasks = [PathTask(surface, Micropart(m, (0.0, 0.0)), law, run) for m, run in zip(masses, runs, strict=True)]
    found = dict(follow_each(tasks, threads=1))
    assert counts == [3, 1, 1, 1, 1] and sorted(found) == [0, 1, 2, 3] and str(found[1]) == "it went wrong"
    for number in (0, 2, 3):
        single = base.vary({"part.mass": masses[number], "run.duration": runs[number].duration})
        alone = follow_part(single, surface, law)
        assert np.array_equal(found[number].position, alone.position)
    with pytest.raises(RuntimeError, match="it went wrong"):
        follow(tasks)


def test_a_case_that_cannot_be_run_is_named_by_its_number(monkeypatch):
    base = case()

    def failing(one):
        raise ValueError("it has no law")

    monkeypatch.setattr("coupling.batch.build_friction", failing)
    monkeypatch.setattr("coupling.batch.SolvedPlates.scene", lambda plates, one: None)
    with pytest.raises(ValueError, match=r"^Input cases\[0\] of run_cases cannot be run: it has no law"):
        run_cases([base])


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"actuators.*.stroke": "5 um"}, lambda one: [a.stroke for a in one.actuators] == [5e-6, 5e-6]),
        ({"actuators.*.stroke": 5e-6, "actuators.1.stroke": "6 um"}, lambda one: one.actuators[1].stroke == 6e-6),
        ({"part.position": ["1 um", 2e-6]}, lambda one: one.part.position == (1e-6, 2e-6)),
        ({"part.position.1": "3 um"}, lambda one: one.part.position == (-140e-6, 3e-6)),
        ({"run.frames": 200, "run.after_detachment": "fly"}, lambda one: one.run.frames == 200),
        ({"friction": {"model": "coulomb", "coefficient": 0.3}}, lambda one: one.friction.coefficient == 0.3),
        ({"actuators": ACTUATORS[:1]}, lambda one: len(one.actuators) == 1),
    ],
)
def test_fields_vary_by_the_paths_of_studies(changes, expected):
    base = case()
    varied = base.vary(changes)
    assert expected(varied) and base == case() and varied.name == base.name
    assert base.vary(changes, name="other").name == "other" and base.vary({}) == base


def test_all_wrong_places_and_values_are_reported():
    with pytest.raises(InputError) as caught:
        case().vary({"actuators.0.frequencey": "3 kHz", "actuators.7.stroke": 1, "part.mass": "3 um", "frequency": 1})
    assert str(caught.value).splitlines() == [
        "Input actuators.0.frequencey of Case must be a field of the case; actuators[0] has no frequencey; did you "
        "mean frequency?",
        "Input actuators.7.stroke of Case must be a field of the case; its actuators are counted from 0 to 1, * for "
        "all; got 7",
        "Input frequency of Case must be a field of the case; the case has no frequency; did you mean "
        "actuators.*.frequency?",
        'Input part.mass of Case must be a mass such as "2e-9 kg"; got "3 um", a length',
    ]
