"""Small cases of each kind that the program runs; the fixture `ran` runs each of them once for all tests."""

from __future__ import annotations

from pathlib import Path

from coupling import Result, read_case, run_case

PLATE = """
[plate]
shape = "disc"
radius = "300 um"
supports = "clamped"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "20 um"
density = "2330 kg/m^3"
"""
ACTUATOR = """
[[actuators]]
position = ["-60 um", "0 um"]
stroke = "2 um"
frequency = "10 kHz"
"""
PART = """
[part]
mass = "2e-9 kg"
position = ["40 um", "20 um"]
squeeze = "10 uN"
"""
FRICTION = """
[friction]
model = "constant"
limit = "20 nN"
"""
RUN = """
[run]
duration = "0.4 ms"
"""
HIGH = 'centre_height = "45 um"\n'
LATTICE = """
[lattice]
rows = 2
columns = 2
pitch = "120 um"
stroke = "1 um"
frequency = "10 kHz"
"""
PLATFORM = """
[plate]
shape = "platform"
[plate.motion]
x = { stroke = "20 um", frequency = "1 kHz", cycle = "sine" }
"""
STRETCHING = PLATE + 'theory = "von-karman"\n'
PATH = PART + FRICTION + RUN
TEXTS = {
    "linear": PLATE + ACTUATOR + PATH,
    "top-face": PLATE + ACTUATOR + PART + HIGH + FRICTION + RUN,
    "stretching": STRETCHING + ACTUATOR + PATH,
    "vibrating": PLATE + "inertia = true\n" + ACTUATOR + PATH,
    "ringing": STRETCHING + "inertia = true\n" + ACTUATOR + PATH,
    "platform": PLATFORM + PATH,
    "array": PLATE + LATTICE + PATH,
}


def run(kind: str, folder: Path) -> Result:
    """Run a case of a kind, whose file and results are left in a folder."""
    file = folder / f"{kind}.toml"
    file.write_text(TEXTS[kind], encoding="utf-8")
    return run_case(read_case(file), folder)
