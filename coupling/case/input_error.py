"""InputError: the values that a table was to be made of in Python, and cannot have."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from coupling.case.case import TABLES, CaseTables
from coupling.case.lines import LACKS_DEFAULT, in_file, message_of, shown_location


class InputError(ValueError):
    """`problems` has each field of the table `owner` that is wrong, and what is wrong with it."""

    def __init__(self, owner: str, problems: list[tuple[str, str]]) -> None:
        super().__init__(owner, problems)
        self.owner, self.problems = owner, problems

    def __str__(self) -> str:
        return "\n".join(f"Input {field} of {self.owner} {message}" for field, message in self.problems)


def input_error(table: Any, error: ValidationError) -> InputError:
    """What is wrong with the values of a table, in the words of case files."""
    owner = table.__name__
    whole = issubclass(table, CaseTables)
    tables = TABLES | {owner: table}
    problems = []
    for detail in error.errors():
        if detail["type"] == LACKS_DEFAULT:
            continue
        if not whole:  # for its keys to be found among those of this table
            detail["loc"] = (owner, *detail["loc"])
        location = in_file(detail)[0 if whole else 1 :]
        value = detail["input"]
        if detail["type"].startswith("union_tag") and isinstance(value, dict):
            value = value.get("model")
        problems.append((shown_location(location), message_of(detail, value, tables)))
    return InputError(owner, problems)
