"""Units as people write them: what is read, or offered in place of what is not, is what they mean."""

from __future__ import annotations

import math
import re

import pytest

from coupling.case import Quantity

CUBIC = {"kg/m3": 1, "kg/m^3": 1, "kg/m**3": 1, "kg/m³": 1, "kg m-3": 1, "kg m^-3": 1, "kg·m⁻³": 1, "Kg/m3": 1}
MEANT: dict[str, dict[str, float]] = {
    "m": {
        **dict.fromkeys(("um", "µm", "μm", "UM", "Um", "uM", "mu", "mum", "micron", "microns", "Micron"), 1e-6),
        **dict.fromkeys(("micrometer", "micrometre", "Micrometer", "mikrometer", "micro m", "micrometr"), 1e-6),
        **dict.fromkeys(("mm", "MM", "millimeter", "milimeter", "Millimetre"), 1e-3),
        **dict.fromkeys(("nm", "NM", "Nm", "nanometer"), 1e-9),
        **{"cm": 1e-2, "CM": 1e-2, "m": 1, "M": 1, "meter": 1, "metres": 1, "Meter": 1, "in": 0.0254, "Å": 1e-10},
    },
    "m^2": {"um2": 1e-12, "um^2": 1e-12, "µm²": 1e-12, "um**2": 1e-12, "mm2": 1e-6, "MM2": 1e-6, "m2": 1, "qm": 1},
    "s": {
        **dict.fromkeys(("ms", "msec", "MS", "mS", "millisecond", "miliseconds", "Millisecond"), 1e-3),
        **dict.fromkeys(("us", "µs", "usec", "US", "microsecond"), 1e-6),
        **{"s": 1, "sec": 1, "S": 1, "seconds": 1, "Sek": 1, "ns": 1e-9, "min": 60},
    },
    "Hz": {
        **dict.fromkeys(("Hz", "hz", "HZ", "1/s", "s^-1", "s-1", "s⁻¹", "cps", "hertz", "Hertz"), 1),
        **dict.fromkeys(("kHz", "khz", "KHz", "KHZ", "kHZ", "kilohertz", "KiloHertz", "k Hz"), 1e3),
        **{"MHz": 1e6, "mhz": 1e6, "MHZ": 1e6, "GHz": 1e9, "rpm": 1 / 60, "rad/s": 0.5 / math.pi},
    },
    "rad": {
        **dict.fromkeys(("deg", "°", "Deg", "DEG", "degree", "degrees", "Degree", "Grad", "degs"), math.pi / 180),
        **{"rad": 1, "Rad": 1, "rads": 1, "turn": 2 * math.pi, "turns": 2 * math.pi, "rev": 2 * math.pi},
        **{"pi": math.pi, "π": math.pi, "pi rad": math.pi},
    },
    "m/s": {"m/s": 1, "M/S": 1, "m s-1": 1, "m/sec": 1, "mm/s": 1e-3, "um/s": 1e-6, "um/ms": 1e-3, "MM/S": 1e-3},
    "m/s^2": {
        **dict.fromkeys(("m/s^2", "m/s2", "m/s²", "m/s**2", "m/s/s", "M/S2", "m s-2", "m/sec2", "m·s⁻²"), 1),
        **dict.fromkeys(("g", "G", "gn", "g0", "g_0"), 9.80665),
    },
    "kg": {
        **dict.fromkeys(("ug", "µg", "μg", "UG", "Ug", "mcg", "microgram", "Microgram", "microgrm"), 1e-9),
        **{"kg": 1, "Kg": 1, "KG": 1, "kgs": 1, "g": 1e-3, "G": 1e-3, "gr": 1e-3, "gram": 1e-3, "grams": 1e-3},
        **{"mg": 1e-6, "MG": 1e-6, "ng": 1e-12, "NG": 1e-12, "nanogram": 1e-12, "pg": 1e-15},
    },
    "kg/m^3": {
        **CUBIC,
        **dict.fromkeys(("g/cm3", "g/cm^3", "g/cm**3", "g/cm³", "G/CM3", "g cm-3", "g.cm-3", "g/cc", "g/ccm"), 1e3),
        **{"g/ml": 1e3, "g/mL": 1e3, "kg/l": 1e3, "kg/L": 1e3, "kg/dm3": 1e3, "t/m3": 1e3, "mg/mm3": 1e3},
        **{"mg/cm3": 1, "g/mm3": 1e6, "g/m3": 1e-3, "KG/M3": 1},
    },
    "N": {
        **dict.fromkeys(("uN", "µN", "UN", "un", "Un", "micronewton"), 1e-6),
        **{"N": 1, "n": 1, "Newton": 1, "newtons": 1, "mN": 1e-3, "mn": 1e-3, "nN": 1e-9, "nn": 1e-9, "pN": 1e-12},
    },
    "N/m": {"N/m": 1, "n/m": 1, "N/M": 1, "N m-1": 1, "N/mm": 1e3, "mN/m": 1e-3, "uN/um": 1, "N/µm": 1e6, "mn/mm": 1},
    "Pa": {
        **dict.fromkeys(("GPa", "Gpa", "gpa", "GPA", "gigapascal", "Gigapascal", "kN/mm2", "kN/mm^2"), 1e9),
        **dict.fromkeys(("MPa", "Mpa", "mpa", "MPA", "N/mm2", "N/mm^2", "N/mm²", "n/mm2"), 1e6),
        **{"Pa": 1, "pa": 1, "PA": 1, "N/m2": 1, "N/m^2": 1, "pascal": 1, "kPa": 1e3, "KPa": 1e3, "bar": 1e5},
    },
    "J/m^2": {"J/m2": 1, "J/m^2": 1, "J/M2": 1, "mJ/m2": 1e-3, "mj/m2": 1e-3, "mJ/m²": 1e-3, "erg/cm2": 1e-3, "N/m": 1},
}
"""What one of each is in the SI unit; written down by hand."""


def offered(message: str) -> list[str]:
    """What a message says to write."""
    _, _, rest = message.partition("; got ")
    question = re.search(r"(?:did you mean|is|point:|write) (\"[^;]*)", rest)
    return re.findall(r'"([^"]+)"', question[1]) if question else []


@pytest.mark.parametrize("si", MEANT)
def test_units_are_read_or_what_is_offered_in_their_place_is_meant(si: str) -> None:
    quantity, wrong = Quantity(si, f"1 {si}"), []
    for unit, factor in MEANT[si].items():
        try:
            texts = [f"-4.2e-3 {unit}"]
            found = [quantity.parse(texts[0])]
        except ValueError as error:
            texts = offered(str(error))
            found = [quantity.parse(text) for text in texts]
        if found != pytest.approx([-4.2e-3 * factor], rel=1e-8):
            wrong.append((unit, texts, found))
    assert wrong == []


OTHERWISE = [
    *(("m", "1,5 mm", 1.5e-3), ("m", "0,125 mm", 0.125e-3), ("m", "−5 um", -5e-6), ("m", "5x10^-6 m", 5e-6)),
    *(("m", "5 * 10^-6 m", 5e-6), ("kg", "2·10⁻⁹ kg", 2e-9), ("kg", "2 × 10^-9 kg", 2e-9)),
    *(("m", "1 500 um", 1.5e-3), ("Hz", "2 ms", 500.0)),
]
AMBIGUOUS = ["1,500 um", "12,345 um", "5 mil", "5 (um", "1/300 um", "5 frobs", "3 xm", "5 mN"]


def test_a_number_that_is_written_otherwise_is_offered_as_it_is_meant_unless_two_things_may_be() -> None:
    for si, text, value in [*OTHERWISE, *(("m", text, None) for text in AMBIGUOUS)]:
        with pytest.raises(ValueError) as caught:
            Quantity(si, f"1 {si}").parse(text)
        found = [Quantity(si, "").parse(one) for one in offered(str(caught.value))]
        assert found == ([] if value is None else [pytest.approx(value, rel=1e-9)]), text


def test_a_density_in_grams_is_offered_with_what_it_is() -> None:
    with pytest.raises(ValueError, match=re.escape('did you mean "2.33 g/cm^3", which is 2330 kg/m^3?')):
        Quantity("kg/m^3", "2330 kg/m^3").parse("2.33 g/cm3")
