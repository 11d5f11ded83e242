"""Damping: how fast a plate's vibrations decay, one ratio for all modes or one by frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter, ValidationError, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from coupling.case.values import Frequency, quoted


@dataclass(frozen=True)
class _Ratios:
    """Marks a damping ratio, or pairs of a frequency and the ratio there."""

    expected = (
        'a ratio from 0 to below 1, or pairs of a frequency and a ratio, such as [["20 kHz", 0.02], ["80 kHz", 0.01]]'
    )

    def validate(self, value: object, info: ValidationInfo) -> float | tuple[tuple[float, float], ...]:
        if _is_ratio(value):
            return float(value)  # type: ignore[arg-type]
        if not isinstance(value, (list, tuple)) or not value or not all(map(_is_pair, value)):
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        pairs, last = [], 0.0
        for written, ratio in value:
            try:
                frequency = _FREQUENCY.validate_python(written, context=info.context)
            except ValidationError as error:
                raise ValueError(f"in each pair {error.errors()[0]['msg'].removeprefix('Value error, ')}") from None
            if not frequency > last:
                raise ValueError(f"must have increasing, positive frequencies; got {quoted(written)}")
            if not _is_ratio(ratio):
                raise ValueError(f"must have ratios from 0 to below 1; got {quoted(ratio)} at {quoted(written)}")
            pairs.append((frequency, float(ratio)))
            last = frequency
        return tuple(pairs)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        ratio = {"type": "number", "minimum": 0, "exclusiveMaximum": 1}
        pair = {"type": "array", "prefixItems": [{"type": "string"}, ratio], "minItems": 2, "maxItems": 2}
        return {"anyOf": [ratio, {"type": "array", "items": pair, "minItems": 1}]}


_FREQUENCY: TypeAdapter[float] = TypeAdapter(Frequency)
DampingRatios = Annotated[float | tuple[tuple[Frequency, float], ...], _Ratios()]


def _is_ratio(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < 1


def _is_pair(value: object) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 2
