"""active-surface: simulate active surfaces, thin plates on point actuators that move micron-sized parts.

All public names of the program are here, and each is loaded when it is used. The stub beside this file lists them.
"""

import ast
import os
import sys
from importlib import import_module, util

_HERE = os.path.dirname(__file__)
_COMMANDS = ("-m", "active-surface", "active-surface.exe")


def _refuse_shadows() -> None:
    """Raise ImportError if a module of the user hides one of our packages; a command ends with exit code 2."""
    # Loaded by its path, because a coupling.py of the user would hide its package.
    spec = util.spec_from_file_location("environment", os.path.join(_HERE, os.pardir, "coupling", "environment.py"))
    assert spec and spec.loader
    environment = util.module_from_spec(spec)
    spec.loader.exec_module(environment)
    try:
        environment.refuse_shadows("coupling", "common", "meshes", "fem_plate", "particle")
    except ImportError as error:
        if os.path.basename(sys.argv[0]) not in _COMMANDS:
            raise
        print(f"active-surface: {error}", file=sys.stderr)
        sys.exit(2)


def _homes() -> dict[str, tuple[str, str]]:
    """Where each name of the stub comes from: the module, and the name in it, "" for the module itself."""
    with open(os.path.join(_HERE, "__init__.pyi"), encoding="utf-8") as stub:
        tree = ast.parse(stub.read())
    homes = {}
    for node in tree.body:
        if isinstance(node, ast.Import):
            homes |= {alias.name: (alias.name, "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module is None:
            homes |= {alias.name: (f"{__name__}.{alias.name}", "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            module = f"{__name__}.{node.module}" if node.level else str(node.module)
            homes |= {alias.name: (module, alias.name) for alias in node.names}
    return homes


_refuse_shadows()
_HOMES = _homes()
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    value = import_module(module)
    globals()[name] = value = getattr(value, attribute) if attribute else value  # found at once from now on
    return value


def __dir__() -> list[str]:
    return [*globals(), *__all__]
