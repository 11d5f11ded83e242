"""What the site adds to the plain Markdown pages: tables of contents, listings of programs, the Python reference.

Pages carry no Sphinx directives, so that they also read well on a code host. They get them when the site is built.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

REFERENCE = Path(__file__).parent / "reference"  # a file of directives for each page of docs/api

PACKAGES = ["meshes", "fem_plate", "particle", "coupling", "active_surface"]
CONTENTS = {  # the pages below a page, by caption
    "index": {
        "First steps": ["quick-start", "tutorial", "gallery/index"],
        "How to": [
            "howto/general-plates",
            *("howto/drift", "howto/measured-motion", "howto/waves", "howto/identify", "howto/optics"),
        ],
        "The program": [
            *("commands", "case-file", "results", "pictures", "app"),
            *("python", "messages", "sweeps", "aim", "feasibility"),
        ],
        "Theory": ["plate", "surface", "motion", "contact", "large-deflection", "inertia", "face", "air"],
        "Trust": ["limits", "accuracy", "benchmarks", "paper", "trust"],
        "Reference": ["conventions", "api/index"],
        "Inside": ["architecture"],
    },
    "api/index": {"": PACKAGES},
}
LISTING = re.compile(r"^Source: \[`[^`]+`\]\(([^)]+)\)$", re.MULTILINE)
# Links to what is in the repository only.
OFF_SITE = re.compile(r"\[([^\]]+)\]\((?:\.\./)*(?:decisions/|benchmarks/|CONTRIBUTING|CHANGELOG)[^)]+\)")
LANGUAGES = {".py": "python", ".geo": "c"}


def with_directives(page: str, text: str) -> str:
    """The text of a page with the directives that only the site needs."""
    text = LISTING.sub(_listing, OFF_SITE.sub(r"\1", text))
    directives = REFERENCE / f"{page.removeprefix('api/')}.rst"
    if page.startswith("api/") and directives.exists():
        text += f"\n```{{eval-rst}}\n{directives.read_text()}```\n"
    for caption, pages in CONTENTS.get(page, {}).items():
        options = [":hidden:", *([f":caption: {caption}"] if caption else [])]
        text += "\n```{toctree}\n" + "\n".join([*options, "", *pages]) + "\n```\n"
    return text


def _listing(line: re.Match[str]) -> str:
    language = LANGUAGES[Path(line[1]).suffix]
    return f"{line[0]}\n\n```{{literalinclude}} {line[1]}\n:language: {language}\n```"


def add_directives(app: Sphinx, page: str, source: list[str]) -> None:
    source[0] = with_directives(page, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", add_directives)
    return {"parallel_read_safe": True}
