"""Doors: a package or room is entered by its `__init__`, from other rooms as well as from scripts."""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ["common", "meshes", "fem_plate", "particle", "coupling", "active_surface"]
FILES = [file for package in PACKAGES for file in sorted((ROOT / package).rglob("*.py"))]
MODULES = {".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file for file in FILES}
SCRIPTS = sorted(file for folder in ("benchmarks", "docs", "examples") for file in (ROOT / folder).rglob("*.py"))
INSIDE = {  # scripts that measure or describe parts of rooms, which are not public
    "benchmarks/aims.py",
    "benchmarks/app.py",
    "benchmarks/assembly.py",
    "benchmarks/contact.py",
    "benchmarks/measured_motion.py",
    "benchmarks/results.py",
    "docs/extensions/fields.py",
}


def is_door(module):
    return MODULES[module].name == "__init__.py"


def imports(text):
    """The line of each import, and the module and the name that it imports; None for a name: the module."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield from ((node.lineno, node.module, alias.name) for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name, None) for alias in node.names)


def names_of(door):
    """What a door hands on: the names that its stub or, without one, its own imports bind."""
    file = MODULES[door]
    stub = file.with_suffix(".pyi")
    tree = ast.parse((stub if stub.exists() else file).read_text())
    bound = (alias.asname or alias.name for node in tree.body if hasattr(node, "names") for alias in node.names)
    return {*bound, *(node.name for node in tree.body if isinstance(node, ast.FunctionDef))}


def room_around(module, target):
    """The package around both, "" at the top."""
    shared = zip(module.split(".")[:-1], target.split("."), strict=False)
    depth = next((k for k, (mine, its) in enumerate(shared) if mine != its), None)
    parts = module.split(".")[:-1]
    return ".".join(parts[: len(parts) if depth is None else depth])


def passes_a_door(module, target, name):
    """Whether `module` may import a name of the module `target`: beside it or above, or a door that has the name."""
    if target.rpartition(".")[0] == room_around(module, target) and not is_door(target):
        return True
    if not is_door(target):
        return False
    inside = f"{module}.".startswith(f"{target}.")  # a room's own modules import each other by its name
    part = f"{target}.{name}"
    return inside or part not in MODULES or is_door(part) or name in names_of(target)


def wrong_ways(text, module):
    return [
        f"line {line}: {target}{f', {name}' if name else ''}"
        for line, target, name in imports(text)
        if target in MODULES and not passes_a_door(module, target, name)
    ]


def test_rooms_are_entered_by_their_doors():
    rooms = [module for module in MODULES if not is_door(module)]
    wrong = {module: wrong_ways(MODULES[module].read_text(), module) for module in rooms}
    assert {module: lines for module, lines in wrong.items() if lines} == {}


def test_scripts_come_in_by_doors():
    inside = [str(file.relative_to(ROOT)) for file in SCRIPTS if wrong_ways(file.read_text(), file.stem)]
    assert sorted(inside) == sorted(INSIDE)


RULE = [
    ("coupling.case.case", "from coupling.case.table import Table", True),
    ("coupling.run", "from coupling.summary import summary_of", True),
    ("coupling.run", "from coupling.case import Case", True),
    ("coupling.run", "from coupling.case.table import Table", False),
    ("coupling.case.case", "from coupling.suggestion import near", True),
    ("coupling.case.case", "from coupling.scene.plate import PlateScene", False),
    ("coupling.case.case", "from particle.simulation import simulate", False),
    ("coupling.case.case", "import particle.simulation", False),
    ("coupling.case.case", "from particle import simulate, friction", True),
    ("coupling.case.case", "from particle import path", False),
    ("coupling.case.case", "from fem_plate import analytic", True),
    ("active_surface.studies.run", "from active_surface.views.film.scene import Scene", False),
]


def test_the_rule_tells_doors_from_windows():
    assert [row for row in RULE if bool(wrong_ways(row[1], row[0])) is row[2]] == []
