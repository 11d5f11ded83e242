"""A table of a case whose keys depend on each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, Final, Self

from pydantic import ModelWrapValidatorHandler, TypeAdapter, ValidationError, ValidationInfo, model_validator

from coupling.case.table import Table
from coupling.suggestion import near

WRONG: Final = object()

Contradictions = Iterator[tuple[str, str]]


class KeyedTable(Table):
    """A table whose keys depend on each other: `contradictions` are found whatever else is wrong."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        """Yield each key that does not go with the others, or is missing because of them, and why.

        given: the values by their keys; WRONG for those that are not valid.
        """
        raise NotImplementedError

    @model_validator(mode="wrap")
    @classmethod
    def _check_keys(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        errors: list[Any] = []
        table: Self | None = None
        try:
            table = handler(data)
        except ValidationError as error:
            if not isinstance(data, dict):
                raise
            errors += error.errors()
        if isinstance(data, dict):
            told = {error["loc"] for error in errors}
            for key, message in cls.contradictions(cls._given(data, info.context)):
                if (key,) not in told and (key in data or message.startswith("is missing")):
                    context = {"error": ValueError(message)}
                    errors.append({"type": "value_error", "loc": (key,), "input": None, "ctx": context})
        if table is None or errors:
            raise ValidationError.from_exception_data(cls.__name__, errors)
        return table

    @classmethod
    def values_of(cls, table: Any, context: Any) -> Mapping[str, Any]:
        """The values by key of a table, or of a dict in which anything may be wrong.

        WRONG for each key that is not valid, is lacking, or may be meant by a misspelt one.
        """
        if isinstance(table, cls):
            return dict(table)
        fields = cls.model_fields.items()
        defaults = {key: WRONG if field.is_required() else field.default for key, field in fields}
        return defaults | cls._given(table, context)

    @classmethod
    def _given(cls, data: Mapping[str, Any], context: Any) -> dict[str, Any]:
        given: dict[str, Any] = {}
        for key, value in data.items():
            if key not in cls.model_fields:
                # A misspelt key is a mistake already; what it stands for is not missing as well.
                meant = near(str(key), cls.model_fields)
                given |= {meant: WRONG} if meant else {}
            elif value is not None:
                try:
                    valid = adapter(cls, key).validate_python(value, context=context)
                except ValidationError:
                    valid = WRONG
                # In Python a default may be stated: a case that was written down is read again.
                if context or valid != cls.model_fields[key].default:
                    given[key] = valid
        return given


@cache
def adapter(model: type[Table], key: str) -> TypeAdapter[Any]:
    """What validates one field of a table by itself."""
    return TypeAdapter(model.model_fields[key].rebuild_annotation())
