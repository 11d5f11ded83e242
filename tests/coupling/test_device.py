"""The device in words: outline, size, supports, thickness, actuators and part of a case."""

from pathlib import Path

import pytest

from coupling import read_case
from coupling.report import device

EXAMPLES = Path(__file__).parents[2] / "examples"
SILICON = "5 µm thick, Young's modulus 169 GPa"


@pytest.mark.parametrize(
    ("name", "plate", "count"),
    [
        ("annulus", f"A disc 600 µm across with a hole of 200 µm, clamped at outer; free at inner, {SILICON}", 2),
        ("l_with_hole", f"A plate from a mesh file of 400 µm by 400 µm, clamped at outer; free at hole, {SILICON}", 6),
        ("rectangle_2x2", f"A simply supported rectangle of 600 µm by 450 µm, {SILICON}", 4),
        ("transport", f"A clamped disc 1.4 mm across, {SILICON} (it bends and stretches)", 2),
    ],
)
def test_a_device_is_said_in_words(name, plate, count):
    part = "2.01 µg" if name == "transport" else "2 µg"
    said = f"{plate}, pushed from below by {count} actuators to move a part of {part}"
    assert device(read_case(EXAMPLES / f"{name}.toml")) == said


def test_a_platform_is_said_to_be_one():
    said = "A flat, rigid platform, moved as was measured, under a part of 2 µg"
    assert device(read_case(EXAMPLES / "shaker.toml")) == said


@pytest.mark.parametrize(
    ("outline", "said"),
    [
        (
            'shape = "ellipse"\nsemi_axis_x = "300 um"\nsemi_axis_y = "0.2 mm"',
            "A clamped ellipse of 600 µm by 400 µm, ",
        ),
        ('shape = "polygon"\nsides = 6\nradius = "300 um"', "A clamped regular polygon of 6 sides within a circle "),
        (
            'shape = "polygon"\ncorners = [["-300 um", "-300 um"], ["300 um", "-300 um"], ["0 um", "200 um"]]',
            "A clamped polygon of 3 corners of 600 µm by 500 µm, ",
        ),
    ],
)
def test_an_outline_is_said_with_its_size(tmp_path, outline, said):
    text = (EXAMPLES / "one_actuator.toml").read_text(encoding="utf-8")
    text = text.replace('"100 um", "100 um"', '"20 um", "20 um"')
    (tmp_path / "case.toml").write_text(text.replace('shape = "disc"\nradius = "300 um"', outline), encoding="utf-8")
    assert device(read_case(tmp_path / "case.toml")).startswith(said)
