"""A page as one file that needs nothing else: its texts, styles, programs, numbers, and the plotting library."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template
from typing import Any

from coupling import whole_file
from coupling.report import with_micro_signs

PARTS = Path(__file__).parent / "page"


def write_page(path: Path, title: str, body: str, texts: Mapping[str, str], data: Any, programs: Sequence[str]) -> Path:
    """Writes a page as a whole or not at all; returns its path.

    body: the name of the file in `page/` that has the page's elements, into which `texts`, already HTML, are put.
    data: what `programs`, names of files in `page/`, find as `pageData`.
    """
    from plotly.offline import get_plotlyjs

    text = Template(part("page.html")).substitute(
        title=escape(title),
        style=part("page.css"),
        main=Template(part(body)).substitute(texts),
        data=json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        library=get_plotlyjs(),
        programs="\n".join(part(name) for name in ("common.js", *programs)),
    )
    with whole_file(path) as partial:
        partial.write_text(text, encoding="utf-8")
    return path


def rows_of(rows: Sequence[tuple[str, str]]) -> str:
    """Labels and texts as the rows of a table; a label without text goes on with the one before."""
    cells = [(escape(label), escape(with_micro_signs(text))) for label, text in rows]
    return "\n".join(f'<tr><th scope="row">{label}</th><td>{text}</td></tr>' for label, text in cells)


def trust_of(figures: str, warnings: Sequence[str]) -> str:
    """How far to trust a run: a verdict with its figures, and the warnings."""
    verdict = f"{len(warnings)} warning{'' if len(warnings) == 1 else 's'}" if warnings else "no warnings"
    line = f"<p><strong>Trust: {verdict}.</strong> {escape(with_micro_signs(figures[:1].upper() + figures[1:]))}.</p>"
    kind = "warnings" if warnings else "trusted"
    return f'<section class="trust {kind}" aria-label="Trust">{line}{_items(warnings)}</section>'


def notes_of(warnings: Sequence[str]) -> str:
    """Warnings as a list, or nothing."""
    if not warnings:
        return ""
    return f'<section class="warnings" aria-label="Warnings"><h2>Warnings</h2>{_items(warnings)}</section>'


def _items(texts: Sequence[str]) -> str:
    items = "\n".join(f"<li>{escape(with_micro_signs(text))}</li>" for text in texts)
    return f"<ul>\n{items}\n</ul>" if texts else ""


def part(name: str) -> str:
    """The text of a file in `page/`."""
    return (PARTS / name).read_text(encoding="utf-8")
