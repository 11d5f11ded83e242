"""Formulas: what they may say, what they give, and that no text brings down more than a clear error."""

import math
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coupling.formula import FUNCTIONS, LONGEST, NAMES, Amount, Formula

TIME = Amount("s", "50 ms")
PLACE = {"row": 2.0, "column": 3.0, "rows": 5.0, "columns": 7.0, "x": 1e-4, "y": -2e-4, "pi": math.pi}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.05 * (row + column) ms", 0.25e-3),
        ("(row + column)ms", 5e-3),
        ("5 if row > 2 else 3 ms", 3e-3),
        ("(5 if row >= 2 and not column == 4 or row < 0 else 3) ms", 5e-3),
        ("1 < row < 3 and 2 or 1 ms", 2e-3),
        ("(row + column) % 4 ms", 1e-3),
        ("column // row ms", 1e-3),
        ("-row ** 2 + +7 ms", 3e-3),
        ("hypot(x, y) / 1e-4 * 2 ms", 2e-3 * math.sqrt(5)),
        ("min(row, column, rows) + max(1, columns) + abs(y) ms", 9.0002e-3),
        ("sqrt(4) + sin(pi / 2) + cos(0) + tan(0) + exp(0) + log(1) + log(8, 2) + floor(1.7) ms", 9e-3),
        ("(row != 2) * 5 + 1 ms", 1e-3),
        ("0.1*row µs", 0.2e-6),
        ("row * 2 1/Hz", 4.0),
        ("row\n * 2 ms", 4e-3),
    ],
)
def test_values(text, value):
    formula = TIME.parse(text)
    assert isinstance(formula, Formula)
    assert formula.value(PLACE) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(("text", "value"), [("5 ms", 5e-3), ("-0.5ms", -0.5e-3), ("2 min", 120.0), ("+1e3 us", 1e-3)])
def test_a_number_and_a_unit_stay_a_number(text, value):
    assert TIME.parse(text) == value


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5 ms if row > 2 else 3 ms", "whose unit must come once, at its end"),
        ("row^2 ms", "a power is written **"),
        ("(row ms", "whose expression is not complete"),
        ("sqrt(row, 2) ms", "but sqrt takes 1 number; it has 2"),
        ("log() ms", "but log takes 1 or 2 numbers; it has 0"),
        ("min(row) ms", "but min takes 2 or more numbers; it has 1"),
        ("max(*row) ms", "but max takes 2 or more"),
        ("max(*row, 2) ms", "which has more than numbers"),
        ("sqrt + 1 ms", "but sqrt is a function, written sqrt(...)"),
        ("sine(row) ms", "did you mean sin?"),
        ("(1, 2) ms", "which has more than numbers"),
        ("True * row ms", "which has more than numbers"),
        ("row + 'a' ms", "means nothing"),
        ("row.__class__ ms", "an operator such as * is missing"),
        ("row[0] ms", 'in which "[" means nothing'),
        ("row " + "+ row " * LONGEST + "ms", f"longer than {LONGEST} characters"),
        ("(" * 300 + "row" + ")" * 300 + " ms", ""),
    ],
)
def test_what_they_must_not_say(text, expected):
    with pytest.raises(ValueError, match=r"^must be a time such as .*; got ") as caught:
        TIME.parse(text)
    assert expected in str(caught.value)


WORDS = st.sampled_from(
    [*NAMES, *FUNCTIONS, *"+-*/%(),<>=!.^&|~@:;[]{}'\"\\_", "**", "//", "==", "<=", "!=", ":=", "if", "else", "and"]
    + ["or", "not", "in", "is", "for", "lambda", "await", "yield", "import", "None", "True", "__class__", "__import__"]
    + ["0", "1", "9", "1e308", "9" * 60, "0x1F", "1j", "0.5", "1_0", "007", "ms", "um", "m/s", "µs", "\n", "\0", "\t"]
)


def outcome(text):
    """The value; None where the text was refused as it should be."""
    try:
        amount = TIME.parse(text)
        value = amount.value(PLACE) if isinstance(amount, Formula) else amount
    except ValueError as error:
        assert str(error).startswith(("must be a time", "is ", "has ", "divides "))
        return None
    assert type(value) is float and math.isfinite(value)
    return value


@settings(max_examples=600, deadline=2000)
@given(st.lists(WORDS, max_size=14).map(" ".join) | st.lists(WORDS, max_size=14).map("".join) | st.text(max_size=40))
def test_hostile_text_gives_a_finite_number_or_the_clear_error(text):
    outcome(text)
    outcome(text + " ms")


NUMBERS = st.recursive(
    st.sampled_from([*NAMES, "0", "2", "9", "1e308", "9" * 60]),
    lambda inner: (
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "//", "%", "**", "<", "==", "and", "or"]), inner).map(
            lambda parts: f"({' '.join(parts)})"
        )
        | st.tuples(st.sampled_from(sorted(FUNCTIONS)), inner).map(lambda parts: f"{parts[0]}({parts[1]})")
        | st.tuples(inner, inner, inner).map(lambda parts: f"({parts[0]} if {parts[1]} else {parts[2]})")
    ),
    max_leaves=12,
)


@settings(max_examples=600, deadline=2000)
@given(NUMBERS)
def test_any_expression_gives_a_finite_number_or_the_clear_error(expression):
    outcome(f"{expression} ms")


@pytest.mark.parametrize("text", ["9**9**9**9 ms", "-" * 400 + "row ms", "row" + "**9" * 100 + " ms"])
def test_nothing_takes_long(text):
    begin = time.perf_counter()
    outcome(text)
    assert time.perf_counter() - begin < 1
