"""Runs, and surfaces that many runs share, of a plate that stretches and has mass."""

import numpy as np
import pytest
from sweeps import toml

from coupling import build_drives, build_scene, read_case, report, shared_surface

CASE = toml(
    plate={
        "shape": "disc",
        "radius": "300 um",
        "supports": "clamped",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "5 um",
        "density": "2330 kg/m^3",
        "theory": "von-karman",
        "inertia": True,
    },
    actuators=[{"position": ["-60 um", "0 um"], "stroke": "5 um", "frequency": "20 kHz"}],
    part={"mass": "2e-9 kg", "centre_height": "45 um", "position": ["40 um", "20 um"]},
    friction={"model": "coulomb", "coefficient": 0.1, "adhesion": "50 uN"},
    run={"duration": "0.2 ms"},
)


def case_of(folder, *changes):
    text = CASE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = folder / "case.toml"
    file.write_text(text)
    return read_case(file)


@pytest.mark.compiled
def test_a_run_says_how_many_modes_the_membrane_couples(ran):
    result = ran("ringing")
    vibration = result.summary.vibration
    assert 1 <= vibration.coupled < vibration.modes
    assert result.summary.theory == "von-karman" and result.summary.quasi_static_error is None
    assert not any("good to" in warning or "accurate to" in warning for warning in report.warnings(result.summary))
    text = "\n".join(line for _, line in report.lines(result.summary, verbose=True))
    assert f"the lowest {vibration.coupled} coupled by the membrane" in text
    assert result.summary.energy_balance < 1e-5


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("start", ["rest", "steady"])
def test_a_shared_surface_is_that_of_single_runs(tmp_path, start):
    case = case_of(tmp_path, ('duration = "0.2 ms"', f'duration = "0.2 ms"\nstart = "{start}"'))
    faster = case_of(tmp_path, ('duration = "0.2 ms"', f'duration = "0.2 ms"\nstart = "{start}"'), ("20 kHz", "25 kHz"))
    sets = [build_drives(one) for one in (case, faster)]
    shared = shared_surface(case, sets, case.run.duration)
    xy = np.array([[40e-6, 20e-6], [-100e-6, 130e-6]])
    for one, drives in zip((case, faster), sets, strict=True):
        driven, single = shared.driven_by(drives), build_scene(one).surface
        for time in (31e-6, 77e-6, 140e-6):
            w, expected = driven.evaluate(xy, time).w, single.evaluate(xy, time).w
            np.testing.assert_allclose(w, expected, rtol=0, atol=2e-5 * 5e-6)
