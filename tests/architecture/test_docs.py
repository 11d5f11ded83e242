"""The project's own pages: links lead somewhere, equations that are referred to exist, the site shows every page."""

import importlib
import re
from collections import Counter
from pathlib import Path

import pytest

import particle
from coupling.case import PartCase

ROOT = Path(__file__).parents[2]
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *DOCS]
FENCE = re.compile(r"^```.*?^```$", flags=re.DOTALL | re.MULTILINE)
TAG = re.compile(r"\\tag\{([\d.]+)\}")
REFERENCE = re.compile(r"\[\((\d+\.\d+)\)\]\(([^)#]*)#([^)]+)\)")
SECTION = re.compile(r"^#+ (.+)$", flags=re.MULTILINE)
DIRECTIVES = re.compile(r"^(?:```|:::)\{|\{\w+\}`|^\([\w-]+\)=$|^\.\. \w+::", flags=re.MULTILINE)


def name(page):
    return str(page.relative_to(ROOT))


def prose(page):
    return FENCE.sub("", page.read_text())


def sections(page):
    """The text below each heading of a page, by the name of the link to it on the site and on code hosts."""
    _, *pieces = SECTION.split(prose(page))
    return {
        re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-"): text
        for title, text in zip(pieces[::2], pieces[1::2], strict=True)
    }


def test_links_lead_somewhere():
    wrong = []
    for page in PAGES:
        for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
            file, _, heading = link.partition("#")
            target = page.parent / file if file else page
            if "://" not in link and (not target.exists() or (heading and heading not in sections(target))):
                wrong.append((name(page), link))
    assert not wrong


def test_equations_have_one_number_each_and_references_lead_to_them():
    numbers = Counter(number for page in DOCS for number in TAG.findall(page.read_text()))
    assert numbers and max(numbers.values()) == 1
    references = 0
    for page in DOCS:
        for number, file, heading in REFERENCE.findall(page.read_text()):
            target = sections(page.parent / file if file else page)[heading]
            assert number in TAG.findall(target), f"{name(page)} refers to ({number})"
            references += 1
        starts = len(re.findall(r"^\$\$$", page.read_text(), flags=re.MULTILINE))
        assert starts == 2 * len(TAG.findall(page.read_text())), f"an equation of {name(page)} has no number"
    assert references > 10


def test_pages_read_on_a_code_host():
    assert [(name(page), found) for page in DOCS for found in DIRECTIVES.findall(page.read_text())] == []


def test_architecture_has_every_room_and_no_others():
    """The tree by its indents: of the packages, and of all folders in them that are packages."""
    tree, path = FENCE.findall((ROOT / "docs/architecture.md").read_text())[0], []
    named = []
    for indent, folder in re.findall(r"^( *)([\w/.]+)/ ", tree, flags=re.MULTILINE):
        path[len(indent) // 2 :] = [folder]
        named.append("/".join(path))
    packages = [folder for folder in named if "/" not in folder and (ROOT / folder / "__init__.py").exists()]
    rooms = [str(door.parent.relative_to(ROOT)) for top in packages for door in (ROOT / top).rglob("__init__.py")]
    assert len(packages) == 6
    assert Counter(folder for folder in named if folder.split("/")[0] in packages) == Counter(rooms)


def test_site_shows_every_page(extension):
    contents = extension("contents").CONTENTS
    shown = [
        (ROOT / "docs" / at).parent / page for at, parts in contents.items() for part in parts.values() for page in part
    ]
    files = Counter(page.with_name(f"{page.name}.md") for page in [ROOT / "docs/index", *shown])
    assert max(files.values()) == 1
    decisions = set((ROOT / "docs/decisions").glob("*.md"))  # in the repository only
    assert set(files) == set(DOCS) - decisions


def test_site_adds_what_pages_leave_out(extension):
    contents = extension("contents")
    gallery = contents.with_directives("gallery/index", (ROOT / "docs/gallery/index.md").read_text())
    assert gallery.count("{literalinclude}") == len(list((ROOT / "docs/gallery").glob("*.py")))
    index = contents.with_directives("index", (ROOT / "docs/index.md").read_text())
    assert "](architecture.md)" in index and "CONTRIBUTING.md" not in index
    for package in contents.PACKAGES:
        assert ".. automodule::" in contents.with_directives(f"api/{package}", "")


@pytest.fixture
def extension(monkeypatch):
    """A module of the site's own extensions, by its name."""
    monkeypatch.syspath_prepend(str(ROOT / "docs/extensions"))
    return importlib.import_module


@pytest.fixture
def fields(extension):
    return extension("fields")


PACKAGES = ["meshes", "fem_plate", "particle", "coupling"] + [
    f"active_surface.{room}" for room in ("studies", "views", "steering", "identification", "paper")
]


def public(package):
    """The module, and what it makes public by its names."""
    module = importlib.import_module(package)
    return {item: getattr(module, item) for item in module.__all__}


def test_reference_pages_name_all_that_is_public():
    pages = {package: (ROOT / "docs/api" / f"{package.partition('.')[0]}.md").read_text() for package in PACKAGES}
    assert [item for package, page in pages.items() for item in public(package) if f"| `{item}" not in page] == []


def test_public_fields_with_numbers_state_units_or_meaning(fields):
    """What the reference says of a field is the comment behind it, or the docstring of its class."""
    classes = {package: [item for item in public(package).values() if isinstance(item, type)] for package in PACKAGES}
    assert all(classes.values())
    silent = [
        f"{kind.__name__}.{row.name}"
        for kinds in classes.values()
        for kind in kinds
        for row in fields.of(kind)
        if re.search("float|Array", row.kind)
        and not row.comment
        and not re.search(rf"\b{row.name}\b", kind.__doc__ or "")
    ]
    assert not silent


def test_fields_have_type_default_and_comment(fields):
    rows = {row.name: row for row in fields.of(particle.Drive)}
    assert rows["stroke"] == ("stroke", "float", "", "m")
    assert rows["dwell"].default == "0.0" and rows["dwell"].comment.startswith("s, ")
    of_case = {row.name: row for row in fields.of(PartCase)}
    assert of_case["mass"][:3] == ("mass", "float", "computed") and of_case["mass"].comment.startswith("kg: ")
    assert of_case["velocity"][1:3] == ("tuple[float, float]", "(0.0, 0.0)")
    assert of_case["velocity"].comment.startswith("m/s: ")
    assert [row.name for row in fields.of(particle.State)] == ["STICK", "SLIP", "FLIGHT"]


def test_reference_escapes_what_is_no_markup(extension):
    reference = pytest.importorskip("reference", reason="needs sphinx, the extra docs")
    assert reference.escaped("N m, |x| * `a_b`") == r"N m, \|x\| \* `a_b`"
