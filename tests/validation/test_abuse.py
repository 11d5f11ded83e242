"""A slice of the fuzzer: inputs of a fixed seed, of every kind but runs, which end as they must."""

import sys

import pytest

if sys.platform != "linux":
    pytest.skip("the fuzzer needs fork and limits of memory", allow_module_level=True)

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.compiled
def test_a_hundred_inputs_and_more_are_refused_or_accepted():
    command = [sys.executable, "-m", "fuzz", "--seed", "7", "--count", "150"]
    done = subprocess.run(command, cwd=ROOT / "benchmarks", capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "seed 7: 150 inputs" in done.stdout and "0 wrong" in done.stdout
