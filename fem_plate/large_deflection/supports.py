"""Which plates stretch, and how their rims are held in their plane."""

from __future__ import annotations

from collections.abc import Mapping

from fem_plate.elements import FREE
from fem_plate.given_plate import GivenPlate
from fem_plate.section import PlateSection

IMMOVABLE, MOVABLE = "immovable", "movable"
KINDS = (IMMOVABLE, MOVABLE)


def check_stretches(plate: GivenPlate, caller: str) -> None:
    """ValueError, for `caller`, unless a plate is uniform, isotropic and without a tension."""
    wrong = []
    if plate.tension:
        wrong.append(f"Input tension of Plate must be 0 for {caller}; got {plate.tension!r} N/m")
    if not isinstance(plate.section, PlateSection):
        kind = type(plate.section).__name__
        wrong.append(f"Input section of Plate must be a PlateSection for {caller}; got a {kind}")
    if callable(plate.foundation) or plate.foundation:
        wrong.append(f"Input foundation of Plate must be 0 for {caller}; got {plate.foundation!r}")
    if plate.forms:
        wrong.append(f"Input forms of Plate must be empty for {caller}; got {len(plate.forms)}")
    if wrong:
        raise ValueError("; ".join(wrong))


def movable_by_boundary(in_plane_supports: str | Mapping[str, str], supports: Mapping[str, str]) -> dict[str, bool]:
    """Whether each boundary is free to move in the plane.

    One name counts for all boundaries that `supports` hold, and free ones can move. Those that a mapping leaves out can
    move, too. Raises ValueError, naming every unknown support and boundary.
    """
    if isinstance(in_plane_supports, str):
        given = {name: in_plane_supports if held != FREE else MOVABLE for name, held in supports.items()}
        kinds = {"the rim": in_plane_supports}
    elif isinstance(in_plane_supports, Mapping):
        given = kinds = dict(in_plane_supports)
    else:
        raise ValueError(
            "Input in_plane_supports of large_deflection must be one name or a mapping from boundaries; got "
            f"{in_plane_supports!r}"
        )
    names = ", ".join(map(repr, supports))
    mistakes = [f"boundary {name!r} is not one of the mesh's, {names}" for name in given if name not in supports]
    mistakes += [
        f"the support of {name!r} must be {IMMOVABLE!r} or {MOVABLE!r}; got {kind!r}"
        for name, kind in kinds.items()
        if kind not in KINDS
    ]
    if mistakes:
        raise ValueError("Input in_plane_supports of large_deflection: " + "; ".join(mistakes))
    return {name: given.get(name, MOVABLE) == MOVABLE for name in supports}
