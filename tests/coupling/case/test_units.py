"""Quantities: numbers with units, in files."""

from __future__ import annotations

import re
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest
from case_files import changed, problems

from coupling.case import Quantity
from coupling.case.values import units

LENGTHS = """
"150 Hz" => , a frequency
"20 degC" => , a temperature
"5 K*m" => , which is not a length
"4 mV" => , a voltage
"50 %" => , a plain number
"150 umm" => , but there is no unit "umm"; did you mean um?
"150 UM" => , but there is no unit "UM"; did you mean um?
"5 frobs/umm" => , but there is no unit "frobs/umm"
"150" => , which has no unit
150 => , which has no unit
0 => , which has no unit
nan => , which has no unit
"nan um" => , which is not finite
"-inf um" => , which is not finite
"1e999 um" => , which is not finite
"1e308 km" => , which is not finite
"1,5 mm" => ; write decimals with a point
"" => , which is not a number and a unit
"um" => , which is not a number and a unit
"far away" => , which is not a number and a unit
"−5 um" => , which is not a number and a unit
"5 um; 3" => , which is not a number and a unit
"5 (um" => , but there is no unit "(um"; did you mean um?
"1/300 um" => , but there is no unit "/300 um"
true =>
["1 um"] =>
1979-05-27 =>
"""


def test_wrong_lengths(tmp_path: Path) -> None:
    for line in LENGTHS.strip().splitlines():
        value, _, reason = line.partition(" =>")
        found = problems(tmp_path, changed(('stroke = "150 um"', f"stroke = {value}")))
        reason = reason.removeprefix(" ")
        assert found == [f'10 actuators[0].stroke must be a length such as "150 um"; got {value}{reason}']


def test_units() -> None:
    values = {
        "m": {"150um": 150e-6, " .5 µm ": 0.5e-6, "1_000 nm": 1e-6, "+1 in": 0.0254},
        "m^2": {"1e4 um²": 1e-8},
        "s": {"2 min": 120},
        "Hz": {"300 1/s": 300},
        "m/s": {"5 m·s⁻¹": 5},
        "J/m^2": {"50 mN/m": 0.05},
        "kg/m^3": {"2.33 g / cm**3": 2330, "2.33 g/cm^3": 2330},
        "rad": {"90 deg": 1.5707963267948966, "-0.25 turn": -1.5707963267948966, "1.5 rad": 1.5}
        | {"90°": 1.5707963267948966, "100 grad": 1.5707963267948966, "500 mrad": 0.5},
    }
    for unit, texts in values.items():
        assert {text: Quantity(unit, "").parse(text) for text in texts} == pytest.approx(texts, rel=1e-15)


def test_prefixed_units_and_those_of_si_are_those_of_pint() -> None:
    wrong = []
    for prefix, (base, its) in product(units._PREFIXES, units._PREFIXED_BASES.items()):
        si, unit = units.prefixed(prefix + base)[0], prefix + base
        quantity = Quantity(si, "")
        numbers = ("1", "0.3", "123456.789e-3")
        pairs = [(quantity.value_of("", n, unit), quantity._by_pint("", n, unit)) for n in numbers]
        wrong += [unit] * (si != its or any(one != other for one, other in pairs))
    for unit in units.DIMENSIONS:
        quantity = Quantity(unit, "")
        wrong += [unit] * (not quantity.parse(f"0.1 {unit}") == quantity._by_pint("", "0.1", unit) == 0.1)
    assert wrong == []


def test_no_quantity_is_larger_or_smaller_than_anything_here() -> None:
    for unit, (least, most) in units.RANGES.items():
        quantity = Quantity(unit, "1", positive=True)
        assert quantity.parse(f"{least!r} {unit}") == least and Quantity(unit, "1").parse(f"-{most!r} {unit}") == -most
        above, below = f"above {most:g} {unit}", f"below {least:g} {unit}"
        for value, wrong in ((2 * most, above), (-1e300, "above"), (least / 2, below)):
            with pytest.raises(ValueError, match=f"but no .* may be {re.escape(wrong)}"):
                quantity.parse(f"{value!r} {unit}")
        assert Quantity(unit, "1").parse(f"{least / 2!r} {unit}") == least / 2  # as a place that rounding leaves near 0


@pytest.mark.parametrize("text", ["1 " + "m" * 100_000, "1" * 100_000 + " m", "1 " + "kg*" * 40_000 + "m"], ids=len)
def test_long_texts_are_refused_at_once(text: str) -> None:
    with pytest.raises(ValueError, match=r"\.\.\., which is not a number and a unit"):
        Quantity("m", "150 um").parse(text)


def test_other_units_are_left_to_pint() -> None:
    others = ["s^2", "Hz^2", "parsec", "ft", "min", "degC", "", "um2", "cmm"]
    assert {units.prefixed(unit)[0] for unit in others} == {""}


def test_import_does_not_load_pint() -> None:
    code = "import coupling.case, sys; sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parents[3]).returncode == 0


@pytest.mark.parametrize("text", ["2 kg0", "2 kg^0", "2 g**0", "2 gr", "2 Grad"])
def test_units_that_pint_misreads_or_cannot_take_apart_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="must be a mass"):
        Quantity("kg", "a mass").parse(text)
