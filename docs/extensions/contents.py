"""What the site adds to the plain Markdown pages: tables of contents, listings of programs, the Python reference.

Pages carry no Sphinx directives, so that they also read well on a code host. They get them when the site is built.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

DOCS = Path(__file__).parents[1]
REFERENCE = Path(__file__).parent / "reference"  # a file of directives for each page of docs/api

PACKAGES = ["meshes", "fem_plate", "particle", "coupling", "studies", "views", "steering", "identification", "paper"]
CONTENTS = {  # the pages below a page, by caption
    "index": {
        "First steps": ["quick-start", "tutorial", "gallery/index"],
        "How to": [
            *("howto/own-mesh", "howto/general-plates"),
            *("howto/measured-motion", "howto/waves", "howto/identify", "howto/optics"),
        ],
        "The program": [
            *("commands", "case-file", "results", "pictures", "app"),
            *("python", "messages", "sweeps", "aim", "feasibility"),
        ],
        "Theory and trust": ["theory", "accuracy", "paper", "limits", "trust", "benchmarks"],
        "Reference": ["conventions", "api/index"],
        "Inside": ["architecture", "contributing", "changes"],
    },
    "theory": {"": ["plate", "surface", "motion", "contact", "large-deflection", "inertia", "face"]},
    "api/index": {"": PACKAGES},
}
NUMBERED = {"theory"}  # whose pages have the numbers that their equations begin with
COPIES = {"changes": "CHANGELOG.md", "contributing": "CONTRIBUTING.md"}  # pages that show a file of the root folder
LISTING = re.compile(r"^Source: \[`[^`]+`\]\(([^)]+)\)$", re.MULTILINE)
LINK = re.compile(r"\[([^\]]+)\]\(([^)]+)\)")
# Links to what is in the repository only.
OFF_SITE = re.compile(r"\[([^\]]+)\]\((?:\.\./|docs/)*(?:decisions|benchmarks)/[^)]+\)")
LANGUAGES = {".py": "python", ".geo": "c"}


def with_directives(page: str, text: str) -> str:
    """The text of a page with the directives that only the site needs."""
    if page in COPIES:
        return LINK.sub(_link, OFF_SITE.sub(r"\1", (DOCS.parent / COPIES[page]).read_text()))
    text = LISTING.sub(_listing, OFF_SITE.sub(r"\1", text))
    directives = REFERENCE / f"{page.removeprefix('api/')}.rst"
    if page.startswith("api/") and directives.exists():
        text += f"\n```{{eval-rst}}\n{directives.read_text()}```\n"
    for caption, pages in CONTENTS.get(page, {}).items():
        options = [":hidden:", *([f":caption: {caption}"] if caption else []), *([":numbered: 1"] * (page in NUMBERED))]
        text += "\n```{toctree}\n" + "\n".join([*options, "", *pages]) + "\n```\n"
    return text


def _listing(line: re.Match[str]) -> str:
    language = LANGUAGES[Path(line[1]).suffix]
    return f"{line[0]}\n\n```{{literalinclude}} {line[1]}\n:language: {language}\n```"


def _link(link: re.Match[str]) -> str:
    """A link of a file in the root folder as one of a page; what the site has no page for stays text."""
    if "://" in link[2]:
        return link[0]
    return f"[{link[1]}]({link[2].removeprefix('docs/')})" if link[2].startswith("docs/") else link[1]


def add_directives(app: Sphinx, page: str, source: list[str]) -> None:
    source[0] = with_directives(page, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("source-read", add_directives)
    return {"parallel_read_safe": True}
