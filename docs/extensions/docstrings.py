"""Docstrings of this project, plain text, as reStructuredText; fields of classes with units; short signatures.

A docstring line such as `radius: of the disc [m].` becomes an item of a list, "Raises" begins a paragraph, and what
reStructuredText would take for markup is kept as it is written.
"""

import re
from collections.abc import Mapping
from typing import Any

import fields
from pydantic import BaseModel
from sphinx.application import Sphinx

ITEM = re.compile(r"(?:^|  +)((?:[a-z]\w*|cycle \"\w+(?:-\w+)?\")(?:, [a-z]\w*)*): ")
CODE = re.compile(r"(`[^`]+`)")
LONG_TYPES = {
    r"TypeAliasForwardRef\('(\w+)'\)": r"\1",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?numpy\.float64\]\]": "FloatArray",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?numpy\.int64\]\]": "IntArray",
    r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[~?(?:numpy\.)?bool\]\]": "BoolArray",
    r"~?contextlib\.AbstractContextManager\[.*?\]\]": "Progress",
    r"<(?:function \S+|factory)>": "...",
}
INHERITED = {"model_config", "model_post_init", "model_computed_fields", "model_fields"}


def written(text: str) -> str:
    """Text in which only what stands in backticks is markup."""
    parts = CODE.split(text)
    return "".join(f"`{part}`" if k % 2 else re.sub(r"([\\*|_])", r"\\\1", part) for k, part in enumerate(parts))


def paragraphs(lines: list[str], kinds: Mapping[str, str] | None = None) -> tuple[list[str], set[str]]:
    """The lines of a docstring as reStructuredText, and the names of its items; kinds: what stands behind names."""
    found: list[str] = []
    names: set[str] = set()
    item = False
    for line in lines:
        if not line.strip() or line.startswith(" "):  # formulas stay on lines of their own
            found.append(f"| {written(line.strip())}" if line.strip() else "")
            item = False
            continue
        before, *pieces = ITEM.split(line)
        if before:
            if before.startswith(("Raises", "Returns")):
                found.append("")
                item = False
            found.append(("  " if item else "") + written(before))
        for words, text in zip(pieces[::2], pieces[1::2], strict=True):
            head = ", ".join(f"`{word}`{(kinds or {}).get(word, '')}" for word in words.split(", "))
            found += ["", f"* {head}: {written(text)}"]
            names |= set(words.split(", "))
            item = True
    return [*found, ""], names


def process_text(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    if what == "module":
        lines[:] = []
        return
    rows = fields.of(obj) if isinstance(obj, type) else []
    unsigned = isinstance(obj, type) and issubclass(obj, BaseModel)
    lines[:], known = paragraphs(lines, {row.name: row.described for row in rows} if unsigned else None)
    rest = [f"* `{row.name}`{row.described}: {written(row.comment)}" for row in rows if row.name not in known]
    if rest:
        lines += ["", "Values:" if rows[0].is_member else "Fields:", "", *(row.rstrip(": ") for row in rest), ""]


def process_signature(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    if isinstance(obj, type) and (issubclass(obj, BaseModel) or getattr(obj, "_is_protocol", False)):
        return "", None  # the fields say it all
    for long, short in LONG_TYPES.items():
        signature, returned = (text and re.sub(long, short, text) for text in (signature, returned))
    return signature, returned


def skip(app: Sphinx, what: str, name: str, obj: Any, skipped: bool, options: Any) -> bool | None:
    return name in INHERITED or (getattr(obj, "__doc__", None) or "").startswith("Alias for field number") or None


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", process_text)
    app.connect("autodoc-process-signature", process_signature)
    app.connect("autodoc-skip-member", skip)
    return {"parallel_read_safe": True}
