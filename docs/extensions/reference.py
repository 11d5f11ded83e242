"""What the Python reference adds to numpydoc: the fields of classes with their units, and short signatures."""

import re
from typing import Any

import fields
from pydantic import BaseModel
from sphinx.application import Sphinx

LONG_TYPES = {
    r"TypeAliasForwardRef\('(\w+)'\)": r"\1",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?numpy\.float64\]\]": "FloatArray",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?numpy\.int64\]\]": "IntArray",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?(?:numpy\.)?bool\]\]": "BoolArray",
    r"~?contextlib\.AbstractContextManager\[.*?\]\]": "Progress",
    r"<(?:function \S+|factory)>": "...",
}
INHERITED = {"model_config", "model_post_init", "model_computed_fields", "model_fields"}


def add_fields(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Clear the docstrings of modules, whose pages introduce them; add to a class the fields it does not describe."""
    if what == "module":
        lines[:] = []
    if not isinstance(obj, type):
        return
    text = "\n".join(lines)
    rows = [row for row in fields.of(obj) if not re.search(rf"\*\*[\w, ]*\b{row.name}\b[\w, ]*\*\*", text)]
    if rows:
        items = (f"* `{row.name}`{row.described}: {escaped(row.comment)}".rstrip(": ") for row in rows)
        lines += ["", "Values:" if rows[0].is_member else "Fields:", "", *items, ""]


def escaped(comment: str) -> str:
    """A comment in which only what stands in backticks is markup."""
    parts = re.split(r"(`[^`]+`)", comment)
    return "".join(part if k % 2 else re.sub(r"([\\*|_])", r"\\\1", part) for k, part in enumerate(parts))


def shorten(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    if isinstance(obj, type) and (issubclass(obj, BaseModel) or getattr(obj, "_is_protocol", False)):
        return "", None  # the list of fields has it all
    for long, short in LONG_TYPES.items():
        signature, returned = (text and re.sub(long, short, text) for text in (signature, returned))
    return signature, returned


def skip(app: Sphinx, what: str, name: str, obj: Any, skipped: bool, options: Any) -> bool | None:
    return name in INHERITED or (getattr(obj, "__doc__", None) or "").startswith("Alias for field number") or None


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", add_fields, priority=900)  # after numpydoc
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-skip-member", skip)
    return {"parallel_read_safe": True}
