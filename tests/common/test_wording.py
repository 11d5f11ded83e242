"""Quantities in words."""

import pytest

from active_surface.identification import Estimate
from common import quantity_text


@pytest.mark.parametrize(
    "value, digits, text",
    [(250e-6, 2, "250 µm"), (-0.001234, 3, "-1.23 mm"), (1.23456789e-6, 9, "1.23456789 µm"), (0.0, 3, "0 µm")],
)
def test_a_quantity_has_the_digits_that_are_asked_for(value, digits, text):
    assert quantity_text(value, "m", digits) == text


def test_an_interval_has_digits_that_tell_its_ends_apart():
    narrow = Estimate("part.squeeze", None, "N", 1.23456789e-8, 1.23456780e-8, 1.23456799e-8, False, False)
    assert narrow.text == "12.3456789 nN, from 12.345678 nN to 12.3456799 nN (95 %)"
