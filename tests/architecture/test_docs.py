"""The project's own pages: links lead somewhere, equations that are referred to exist, the site shows every page."""

import importlib
import re
from collections import Counter
from pathlib import Path

import pytest

import particle
from coupling.case.case import PartCase

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


@pytest.fixture
def fields(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs/extensions"))
    return importlib.import_module("fields")


PACKAGES = ["meshes", "fem_plate", "particle", "coupling"] + [
    f"active_surface.{room}" for room in ("studies", "views", "steering", "paper")
]


@pytest.mark.parametrize("package", PACKAGES)
def test_public_fields_with_numbers_state_units_or_meaning(package, fields):
    """What the reference says of a field is the comment behind it, or the docstring of its class."""
    module = importlib.import_module(package)
    classes = [found for found in (getattr(module, item) for item in module.__all__) if isinstance(found, type)]
    silent = [
        f"{kind.__name__}.{row.name}"
        for kind in classes
        for row in fields.of(kind)
        if re.search("float|Array", row.kind)
        and not row.comment
        and not re.search(rf"\b{row.name}\b", kind.__doc__ or "")
    ]
    assert classes and not silent


def test_fields_have_type_default_and_comment(fields):
    rows = {row.name: row for row in fields.of(particle.Drive)}
    assert rows["stroke"] == ("stroke", "float", "", "m")
    assert rows["dwell"].default == "0.0" and rows["dwell"].comment.startswith("s, ")
    of_case = {row.name: row for row in fields.of(PartCase)}
    assert of_case["mass"][:3] == ("mass", "float", "") and of_case["mass"].comment.startswith("kg: ")
    assert of_case["velocity"][1:3] == ("tuple[float, float]", "(0.0, 0.0)")
    assert of_case["velocity"].comment.startswith("m/s: ")
    assert [row.name for row in fields.of(particle.State)] == ["STICK", "SLIP", "FLIGHT"]


def test_docstrings_become_lists(fields):
    docstrings = pytest.importorskip("docstrings", reason="needs sphinx, the extra docs")
    lines, names = docstrings.paragraphs(
        ["A disc.", "", "radius: m.  rigidity: N m, |x| * 2", "and more.", "Raises X."]
    )
    assert names == {"radius", "rigidity"}
    assert [line for line in lines if line] == [
        "A disc.",
        "* `radius`: m.",
        r"* `rigidity`: N m, \|x\| \* 2",
        "  and more.",
        "Raises X.",
    ]
