"""Table: what a table of a file may hold, in SI units; a KeyedTable has keys that depend on each other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    model_validator,
)

from coupling.case.mistakes import Location, Mistake, input_error, meaning_of, why_wrong
from coupling.case.values import adapter, parts_of

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

WRONG: Final = object()
"""Stands for a value that is not valid."""

Contradictions = Iterator[tuple[str, str]]


class _Refusing(ModelMetaclass):
    """Describes what is wrong with a table that is made in Python in the words of files."""

    def __call__(cls, *arguments: Any, **values: Any) -> Any:
        try:
            return super().__call__(*arguments, **values)
        except ValidationError as error:
            raise input_error(cls, error, values) from None


class Table(BaseModel, metaclass=_Refusing):
    """Raises InputError, a ValueError, with every wrong field when it is made of values that it cannot have."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True)

    whole_file: ClassVar[bool] = False
    """Whether it is all that a file holds."""


class KeyedTable(Table):
    """A table whose keys depend on each other: `contradictions` are reported whatever else is wrong."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        """Yield each key that does not go with the others, or is missing because of them, and why.

        given: the values by their keys; WRONG for those that are not valid.
        """
        yield from ()

    @model_validator(mode="wrap")
    @classmethod
    def _check_keys(cls, data: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        def mistakes(reported: set[Location]) -> Iterator[Mistake]:
            for key, message in cls.contradictions(cls._given(data, info.context)):
                if (key,) not in reported and (key in data or message.startswith("is missing")):
                    yield (key,), message

        return validate_with(cls, handler, data, mistakes)

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
                # A misspelt key is a mistake already; the key that is meant is not missing as well.
                meant = meaning_of(str(key), data, cls.model_fields, why_wrong(cls, context))
                given |= dict.fromkeys((name for name in meant.keys if name not in data), WRONG) if meant else {}
            elif value is not None:
                try:
                    valid = adapter(cls, key).validate_python(value, context=context)
                except ValidationError:
                    valid = WRONG
                # In Python a default may be stated, as in the dump of a case that is made again.
                default = cls.model_fields[key].get_default(call_default_factory=True, validated_data=dict(data))
                if context or valid != default:
                    given[key] = valid
        return given


def right_value(model: type[BaseModel], key: str, table: Any, context: Any, missing: Any = None) -> Any:
    """The value of a key in a table that may be wrong elsewhere; None where it is wrong, `missing` where it is absent.

    table: a model, or what stands in its place.
    """
    if isinstance(table, BaseModel):
        return getattr(table, key, missing)
    if not isinstance(table, Mapping) or key not in table:
        return missing
    try:
        return adapter(model, key).validate_python(table[key], context=context)
    except ValidationError:
        return None


def validate(model: type[Table], data: Any, context: Any) -> tuple[Any, list[Any]]:
    """The tables that data make, None where they are wrong, and pydantic's errors about them."""
    try:
        return model.model_validate(data, context=context), []
    except ValidationError as error:
        return None, list(error.errors())


def validate_with(
    model: type[BaseModel], handler: Any, data: Any, mistakes: Callable[[set[Location]], Iterable[Mistake]]
) -> Any:
    """The table that a model's validation makes of data; raises ValidationError with its errors and further mistakes.

    mistakes: yields those in a dict; it gets the locations of the errors.
    """
    if not isinstance(data, dict):
        return handler(data)
    table: Any = None
    errors: list[Any] = []
    try:
        table = handler(data)
    except ValidationError as error:
        errors += error.errors()
    errors += errors_of(mistakes({error["loc"] for error in errors}))
    if errors:
        raise ValidationError.from_exception_data(model.__name__, errors)
    return table


def errors_of(mistakes: Iterable[Mistake]) -> list[Any]:
    """Mistakes in the form of pydantic's errors."""
    return [
        {"type": "value_error", "loc": location, "input": None, "ctx": {"error": ValueError(message)}}
        for location, message in mistakes
    ]


def tables_in(annotation: object) -> list[type[Table]]:
    """The tables that an annotation is made of, in its order."""
    return [part for part in parts_of(annotation) if isinstance(part, type) and issubclass(part, Table)]


def all_tables(table: type[Table]) -> Iterator[type[Table]]:
    """Yield a table and all those in its fields, some of them several times."""
    yield table
    for field in table.model_fields.values():
        for inner in tables_in(field.annotation):
            yield from all_tables(inner)
