"""Drift: the maps of a case's part for groups of its actuators, in words, as data and as a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from active_surface.studies.drifts.basins import Fate
from active_surface.studies.drifts.maps import DriftMap
from common import draw, joined, quantity
from coupling import whole_file
from coupling.case import Case

if TYPE_CHECKING:
    import xarray

WAY: Final = "median way of runs from places in between"
GAP: Final = "median from their ends to those of the map"
ENDS: Final = "number of the end, -1: it stays, -2: it comes off, -3: it leaves the plate"


@dataclass(frozen=True, eq=False)
class Drift:
    """The drift of a case's part, for all of its actuators or for groups of them."""

    case: Case
    maps: tuple[DriftMap, ...]  # over the same places

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        first = self.maps[0]
        maps = [one.figures() for one in self.maps]
        return {"places": len(first.starts), "spacing": first.field.spacing, "maps": maps, "warnings": self.warnings()}

    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print."""
        first = self.maps[0]
        spacing = quantity(first.field.spacing, "m")
        rows = [("places", f"{len(first.starts)}, {spacing} apart, each from rest")]
        for one in self.maps:
            rows.append((one.name, f"in {quantity(one.period, 's')}, the period of the drives{one.later}, {one.text}"))
            if one.check.runs:
                rows.append(("", one.check.text))
        return rows

    def warnings(self) -> list[str]:
        """What limits the trust in it."""
        found = []
        if self.case.part.face is not None and any(one.turned.any() for one in self.maps):
            heading = f"{math.degrees(self.case.part.heading):g} deg"
            found.append(f"The part turns, but the map's periods begin at the heading of the case, {heading}.")
        if wrong := [one.name for one in self.maps if one.check.is_far]:
            found.append(f"Runs end elsewhere than the map says ({joined(wrong)}): its ends are an indication at best.")
        return found

    def dataset(self) -> xarray.Dataset:
        """All of it with labels, by group and place."""
        import xarray

        def by_place(values: list[Any], **notes: str) -> tuple[tuple[str, str], Any, dict[str, str]]:
            return ("group", "place"), np.stack(values), notes

        def by_group(values: list[float], **notes: str) -> tuple[str, list[float], dict[str, str]]:
            return "group", values, notes

        maps, first, way = self.maps, self.maps[0], "displacement in a period"
        fates = ", ".join(f"{fate.value}: {fate.name.lower().replace('_', ' ')}" for fate in Fate)
        return xarray.Dataset(
            {
                "dx": by_place([one.moved[:, 0] for one in maps], units="m", long_name=way),
                "dy": by_place([one.moved[:, 1] for one in maps], units="m", long_name=way),
                "turn": by_place([one.turned for one in maps], units="rad", long_name="turn in a period"),
                "fate": by_place([one.fates.astype(np.int8) for one in maps], long_name=f"within a period, {fates}"),
                "end": by_place([one.basins.of_start for one in maps], long_name=ENDS),
                "end_x": by_place([one.basins.reached[:, 0] for one in maps], units="m", long_name="where it ends"),
                "end_y": by_place([one.basins.reached[:, 1] for one in maps], units="m", long_name="where it ends"),
                "period": by_group([one.period for one in maps], units="s"),
                "way": by_group([one.check.way for one in maps], units="m", long_name=WAY),
                "gap": by_group([one.check.gap for one in maps], units="m", long_name=GAP),
            },
            {
                "group": ("group", [one.name for one in maps]),
                "x": ("place", first.starts[:, 0], {"units": "m"}),
                "y": ("place", first.starts[:, 1], {"units": "m"}),
            },
            {"case": self.case.source or "", "spacing": first.field.spacing},
        )  # fmt: skip

    def plot(self) -> Any:
        """A figure of all maps."""
        return draw(self)

    def write(self, folder: Path) -> tuple[Path, ...]:
        """Writes NAME.drift.nc and NAME.drift.png into a folder; returns them."""
        from coupling.pictures import save_picture  # here, because it loads matplotlib

        folder.mkdir(parents=True, exist_ok=True)
        data = folder / f"{self.case.name}.drift.nc"
        with whole_file(data) as partial:
            partial.write_bytes(self.dataset().to_netcdf(engine="h5netcdf"))
        return data, save_picture(draw(self), folder / f"{self.case.name}.drift.png")
