"""The annotated fields of a class with the comments on their lines, which state their units; the members of an enum."""

import ast
import inspect
import io
import re
import textwrap
import tokenize
from dataclasses import is_dataclass
from enum import Enum
from typing import NamedTuple, get_args

from pydantic import BaseModel

from coupling.case.values import quantities

HIDDEN = "_"
PACKAGES = {"common", "meshes", "fem_plate", "particle", "coupling", "active_surface"}
PLAIN = {
    "StrictInt": "int",
    "StrictFloat": "float",
    "StrictStr": "str",
    "FileBeside": "str",
    "Count": "int",
    "Repeats": "int | str",
    "PointsOrFile": "int | str",
    "Where": "Condition",
}
SHAPES = {
    "Point": ("tuple[float, float]", "m"),
    "Place": ("tuple[float, float]", "m"),
    "Velocity": ("tuple[float, float]", "m/s"),
    "Pitch": ("float | tuple[float, float]", "m"),
    "Gravity": ("float | tuple[float, float, float]", "m/s^2"),
    "Forces": ("tuple[float, ...]", "N"),
    "Points": ("tuple[tuple[float, float], ...]", "s and m"),
    "Positive": ("float", "Hz"),
    "Waiting": ("float", "s"),
}


class Row(NamedTuple):
    """A field, or a member of an enum."""

    name: str
    kind: str
    default: str
    comment: str

    @property
    def is_member(self) -> bool:
        return not self.kind

    @property
    def described(self) -> str:
        """Type and default in brackets."""
        if self.is_member:
            return f" = `{self.default}`"
        return f" (`{self.kind}`" + (f", default `{self.default}`)" if self.default else ")")


def of(kind: type) -> list[Row]:
    """The fields of a dataclass, a named tuple or a table of a case file, those of the classes it extends first."""
    if issubclass(kind, Enum):
        return _members(kind)
    if not (is_dataclass(kind) or issubclass(kind, BaseModel) or hasattr(kind, "_fields")):
        return []
    found: dict[str, Row] = {}
    for base in reversed(inspect.getmro(kind)):
        if base.__module__.split(".")[0] in PACKAGES:
            found |= {row.name: row for row in _own(base)}
    return list(found.values())


def _own(kind: type) -> list[Row]:
    body, comments = _parsed(kind)
    found = []
    for line, below in zip(body, [*body[1:], None], strict=True):
        if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name) and line.target.id[0] != HIDDEN:
            text, unit = _without_units(_kind(line.annotation))
            if not text.startswith("ClassVar"):
                said = comments.get(line.end_lineno or 0, unit), _text(below)
                comment = ": ".join(filter(None, said))
                found.append(Row(line.target.id, text, _default(line.value, kind, line.target.id), comment))
    return found


def _text(line: ast.stmt | None) -> str:
    """A text that stands alone, as below a field."""
    if isinstance(line, ast.Expr) and isinstance(line.value, ast.Constant):
        return " ".join(str(line.value.value).split())
    return ""


def _members(kind: type[Enum]) -> list[Row]:
    body, comments = _parsed(kind)
    notes = {
        ast.unparse(line.targets[0]): comments.get(line.end_lineno or 0, "")
        for line in body
        if isinstance(line, ast.Assign)
    }
    return [
        Row(member.name, "", repr(member.value), notes.get(member.name) or getattr(member, "sentence", ""))
        for member in kind
    ]


def _parsed(kind: type) -> tuple[list[ast.stmt], dict[int, str]]:
    """What a class consists of, and the comments in its source by their lines."""
    source = textwrap.dedent(inspect.getsource(kind))
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    comments = {
        token.start[0]: token.string.lstrip("# ")
        for token in tokens
        if token.type == tokenize.COMMENT and "type: ignore" not in token.string
    }
    definition = ast.parse(source).body[0]
    assert isinstance(definition, ast.ClassDef)
    return definition.body, comments


def _without_units(kind: str) -> tuple[str, str]:
    """A type in which quantities are numbers, and the units of these."""
    units: list[str] = []

    def number(match: re.Match[str]) -> str:
        name = match[1]
        if name in SHAPES:
            units.append(SHAPES[name][1])
            return SHAPES[name][0]
        marks = get_args(getattr(quantities, name, None))
        if len(marks) == 2 and isinstance(marks[1], quantities.Quantity):
            units.append(marks[1].unit)
            return "float"
        return PLAIN.get(name, match[0])

    kind = re.sub(r"(?<![\w.'\"])(?:\w+\.)?(\w+)", number, kind)
    return kind, ", ".join(dict.fromkeys(units))


def _kind(annotation: ast.expr) -> str:
    """The type, without what only the reader of case files needs."""
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) == "Annotated":
        assert isinstance(annotation.slice, ast.Tuple)
        return ast.unparse(annotation.slice.elts[0])
    if isinstance(annotation, ast.BinOp):
        return f"{_kind(annotation.left)} | {_kind(annotation.right)}"
    return ast.unparse(annotation)


def _default(value: ast.expr | None, kind: type, name: str) -> str:
    given = {word.arg: word.value for word in value.keywords} if isinstance(value, ast.Call) else {"default": value}
    default = given.get("default")
    if isinstance(default, ast.Attribute) and issubclass(kind, BaseModel):  # of the law that has the number
        return repr(kind.model_fields[name].default)
    return ast.unparse(default) if default is not None else "computed" if "default_factory" in given else ""
