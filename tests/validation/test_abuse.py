"""Abuse in small: a slice of the fuzzer and of the random cases. `make abuse` tries the whole."""

import subprocess
import sys
from pathlib import Path

import pytest
from random_cases import chance, is_finite, random_case

from particle import Outcome

ABUSE = Path(__file__).parents[1] / "abuse"


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.skipif(sys.platform != "linux", reason="the fuzzer needs fork and limits of memory")
def test_sixty_inputs_are_refused_or_accepted():
    command = [sys.executable, "-m", "fuzz", "--seed", "7", "--count", "60"]
    done = subprocess.run(command, cwd=ABUSE, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "seed 7: 60 inputs" in done.stdout and "0 wrong" in done.stdout


@pytest.mark.compiled
def test_random_cases_end_within_their_work_and_account_for_their_energy():
    for seed in (seed for seed in range(600) if chance(seed)[1] < 5):  # on five of the surfaces
        path = random_case(seed).run()
        assert is_finite(path), seed
        assert path.outcome is not Outcome.WORK_LIMIT, seed
        assert path.energy.balance < 1e-6, seed
