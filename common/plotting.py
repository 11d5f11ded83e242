"""Drawing of results, which know nothing of pictures: modules of pictures register how each type is drawn."""

from __future__ import annotations

from functools import singledispatch
from html import escape
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from common import Figure

PICTURES = "pictures"  # the module or room, beside a type or above it, that draws it


@singledispatch
def draw(thing: Any, *axes: Any, **options: Any) -> Figure:
    """Draw a thing in the way that is registered for its type, and return the figure.

    The registered function takes the axes and options. It is looked for in `pictures` of the packages around the type,
    from the inside out, so that nothing that draws is loaded earlier.
    """
    for kind in type(thing).__mro__:
        package = kind.__module__
        while "." in package:
            package = package.rpartition(".")[0]
            if _has_pictures(package):
                import_module(f"{package}.{PICTURES}")
                if draw.dispatch(type(thing)) is not _FALLBACK:
                    return draw(thing, *axes, **options)
    raise TypeError(f"Input thing of draw must be of a type that has a picture; got {type(thing).__name__}")


def _has_pictures(package: str) -> bool:
    """Whether a package has pictures; a type may also name a module that cannot be imported."""
    try:
        return find_spec(f"{package}.{PICTURES}") is not None
    except ModuleNotFoundError:
        return False


_FALLBACK = draw.dispatch(object)


def notebook_html(thing: Any) -> str:
    """What a notebook shows of something that can be plotted: its repr above its picture."""
    return f"<div><div>{escape(repr(thing))}</div>{thing.plot()._repr_html_()}</div>"
