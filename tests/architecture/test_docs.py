"""The project's own pages: links lead somewhere, equations that are referred to exist, the site shows every page."""

import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *DOCS]
FENCE = re.compile(r"^```.*?^```$", flags=re.DOTALL | re.MULTILINE)
LABEL = re.compile(r"^\$\$ \(([\w-]+)\)$", flags=re.MULTILINE)


def name(page):
    return str(page.relative_to(ROOT))


def prose(page):
    return FENCE.sub("", page.read_text())


def anchors(page):
    """What links to the headings of a page are called, on the site and on code hosts."""
    titles = re.findall(r"^#+ (.+)$", prose(page), flags=re.MULTILINE)
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page):
    links = re.findall(r"\]\(([^)\s]+)\)", prose(page))
    wrong = []
    for link in links:
        if "://" in link:
            continue
        file, _, heading = link.partition("#")
        target = page.parent / file if file else page
        if not target.exists() or (heading and heading not in anchors(target)):
            wrong.append(link)
    assert links or page.name != "README.md"
    assert not wrong


def test_equations_have_one_label_each_and_references_exist():
    labels = Counter(label for page in DOCS for label in LABEL.findall(page.read_text()))
    assert labels and max(labels.values()) == 1
    for page in DOCS:
        text = page.read_text()
        assert set(re.findall(r"\{eq\}`([^`]+)`", text)) <= set(labels), name(page)
        starts = len(re.findall(r"^\$\$", text, flags=re.MULTILINE))
        assert starts == 2 * len(LABEL.findall(text)), f"an equation of {name(page)} has no label"


def test_site_shows_every_page():
    shown = {ROOT / "docs/index.md"}
    for page in DOCS:
        for tree in re.findall(r"^```\{toctree\}\n(.*?)^```$", page.read_text(), flags=re.DOTALL | re.MULTILINE):
            for entry in (line for line in tree.splitlines() if line and not line.startswith(":")):
                found = list(page.parent.glob(f"{entry}.md"))
                assert found, f"{name(page)} lists {entry}"
                shown |= set(found)
    assert [name(page) for page in DOCS if page not in shown] == []
