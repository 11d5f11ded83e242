"""Formulas: what they may say, what they give, and that no text brings down more than a clear error."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coupling.case.values.formula import FUNCTIONS, NAMES, Amount, Condition, Formula, condition

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
        ("asin(1) + acos(1) + atan(1) + atan2(1, -1) ms", 1.5 * math.pi * 1e-3),
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


REFUSED = [
    ("row^2 ms", "there is no unit"),
    ("(" * 300 + "row" + ")" * 300 + " ms", ": it is longer than 500 characters"),
    ("(row ms", ": the expression is incomplete, or has an unknown sign"),
    ("sine(row) ms", ": there is no sine; did you mean sin?"),
    ("arctan2(y, x) ms", ": there is no arctan2; did you mean atan2?"),
    ("round(row) ms", ": there is no round; there are row, column, rows, columns, x, y, pi, sqrt, sin, cos, tan,"),
    ("t * 5 ms", ": there is no t: an expression is constant in time"),
    ("r * 5 ms", ": there is no r; "),
    ("row", ", which has no unit"),
    ("2 * row um", ", a length"),
    ("row - row mss", 'there is no unit "mss"; did you mean ms?'),
    ("5 ms * row", "there is no unit"),
    ("row.__class__ ms", "there is no unit"),
    ("row[0] ms", "there is no unit"),
    ("row " + "+ row " * 500 + "ms", ": it is longer than 500 characters"),
]
NO_VALUE = [
    ("sqrt(row, 2) ms", "has a function with the wrong number of arguments, or something that is not a number"),
    ("min(row) ms", "has a function"),
    ("sqrt + 1 ms", "has a function"),
    ("pi(2) ms", "has a function"),
    ("(1, 2) ms", "has a function"),
    ("1 / (row - 2) ms", "divides by zero"),
    ("log(row - 2) ms", "has no real value"),
    ("exp(1000) ms", "is too large"),
    ("1e300 * 1e300 ms", "is not finite"),
    ("row > 1 ms", "is a comparison and not a number"),
]


def test_what_is_no_formula_or_has_no_value_is_refused_with_the_cause():
    wrong = []
    for text, cause in [*REFUSED, *NO_VALUE]:
        with pytest.raises(ValueError, match="^must be an expression|^must be a time") as caught:
            TIME.parse(text).value(PLACE)
        wrong += [(text, str(caught.value))] * (cause not in str(caught.value))
    assert wrong == []


@pytest.mark.parametrize(
    ("text", "truth"),
    [
        ("not (row == 2 and column == 3)", False),
        ("row % 2 == 0", True),
        ("hypot(x, y) > 100e-6", True),
        (" row > 2 or\ncolumn > 2 ", True),
        ("x > 0 if row > 5 else y > 0", False),
    ],
)
def test_conditions_hold_or_do_not(text, truth):
    assert isinstance(condition(text), Condition) and condition(text).value(PLACE) is truth


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("hypot(x, y) > 100 um", '"um" is too much: a condition has no unit, and x and y are in metres'),
        ("rwo > 2", "there is no rwo; did you mean row?"),
        ("row = 2", '"= 2" is too much'),
        ("row >", "incomplete"),
        ("row > 2 and open('x')", "is too much"),
        ("row " + "+ row " * 500, "longer than 500 characters"),
        ("", "must be an expression that is true or false"),
        (True, "must be an expression that is true or false"),
        (["row > 2"], "must be an expression that is true or false"),
    ],
)
def test_what_is_no_condition(text, cause):
    with pytest.raises(ValueError, match="^must be an expression ") as caught:
        condition(text)
    assert cause in str(caught.value)


@pytest.mark.parametrize("text", ["row", "row % 2", "5", "row and column"])
def test_a_number_is_no_condition(text):
    with pytest.raises(ValueError, match="is a number and not a comparison"):
        condition(text).value(PLACE)


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
        assert str(error).startswith(("must be a time", "must be an expression"))
        return None
    assert type(value) is float and math.isfinite(value)
    return value


@settings(max_examples=200)
@given(st.lists(WORDS, max_size=14).map(" ".join) | st.lists(WORDS, max_size=14).map("".join) | st.text(max_size=40))
def test_hostile_text_gives_a_finite_number_or_the_clear_error(text):
    outcome(text)
    outcome(text + " ms")
    try:
        assert condition(text).value(PLACE) in (True, False)
    except ValueError as error:
        assert str(error).startswith(("must be an expression", "must be true or false for each actuator; "))


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


@settings(max_examples=200)
@given(NUMBERS)
def test_any_expression_gives_a_finite_number_or_the_clear_error(expression):
    outcome(f"{expression} ms")


@pytest.mark.parametrize(
    ("text", "value"), [("9**9**9**9 ms", None), ("-" * 100 + "row ms", 2e-3), ("row" + "**9" * 100 + " ms", None)]
)
def test_towers_of_powers_and_of_signs_end(text, value):
    assert outcome(text) == value
