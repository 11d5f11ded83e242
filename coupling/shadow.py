"""Refuses modules of a user that hide packages of active-surface, such as a particle.py beside a script."""

from importlib.util import find_spec
from os.path import dirname, join, realpath

HERE = dirname(dirname(realpath(__file__)))


def refuse_shadows(*packages: str) -> None:
    """Raise ImportError if Python would import one of these packages from anywhere but beside this one."""
    for name in packages:
        spec = find_spec(name)
        if spec and spec.origin and realpath(spec.origin) != join(HERE, name, "__init__.py"):
            module = dirname(spec.origin) if spec.submodule_search_locations else spec.origin
            raise ImportError(f"{module} hides the package {name} of active-surface; rename it")
