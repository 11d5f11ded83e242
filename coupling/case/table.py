"""A table of a case: fields in SI units that cannot be changed, and no others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict, ValidationError

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)


class _Refusing(ModelMetaclass):
    """Has what is wrong with a table that is made in Python told in the words of case files."""

    def __call__(cls, *arguments: Any, **values: Any) -> Any:
        try:
            return super().__call__(*arguments, **values)
        except ValidationError as error:
            from coupling.case.input_error import input_error  # here, because it knows all tables

            raise input_error(cls, error) from None


class Table(BaseModel, metaclass=_Refusing):
    """Raises InputError, a ValueError, with every wrong field when it is made of values that it cannot have."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
