"""A sweep read back from the file of its results."""

from __future__ import annotations

import csv
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from active_surface.studies.dataset import read_dataset
from active_surface.studies.read import read_study
from active_surface.studies.stored import differences, key_of, whole
from active_surface.studies.study import Study
from coupling.case import CaseError, read_case

if TYPE_CHECKING:
    import xarray

EXPECTED = "Input path must be a result of `active-surface sweep`"
VERSIONS = "versions"  # the trait that may differ


def read_sweep(path: Path, study: Study | None = None) -> tuple[Study, xarray.Dataset]:
    """The study whose results a netCDF file holds, and these, read on demand until closed.

    study: that study, if its file is at hand; None: it is read from the text in the results.
    Raises ValueError when there is no such file or it holds something else or another study, and when its case
    reads files that do not exist.
    """
    if not path.is_file():
        raise ValueError(f"{EXPECTED}; got {path}, and there is no such file")
    if key_of(path) is None:
        raise ValueError(f"{EXPECTED}; got {path}, which is something else")
    if study is not None:
        others = [name for name in differences(study, path) if name != VERSIONS]
        if others:
            raise ValueError(f"{EXPECTED} of {study.name}; got {path}, which is of other {' and '.join(others)}")
        return study, read_dataset(path, [axis.name for axis in study.points.axes])
    with whole(path), read_dataset(path) as opened:
        texts = {name: str(opened.attrs[name]) for name in ("study", "case")}
    if not texts["study"]:
        raise ValueError(f"{EXPECTED}; got {path}, whose study was made without a file")
    with tempfile.TemporaryDirectory() as folder:
        files = {name: Path(folder, name, f"{path.stem}.toml") for name in texts}
        for name, file in files.items():
            file.parent.mkdir()
            file.write_text(texts[name], encoding="utf-8")
        try:
            with whole(path):
                dataset = read_dataset(path)
            points = _points_file(dataset, Path(folder, "points.csv"))
            return read_study(files["study"], read_case(files["case"]), points), dataset
        except CaseError as error:
            raise ValueError(
                f"{path}: the study in it cannot be read; give the study file in its place\n{error}"
            ) from error


def _points_file(dataset: xarray.Dataset, path: Path) -> Path:
    """Write the points of a sweep to a file, from which a study whose own file is elsewhere gets them."""
    names = str(dataset.attrs["axes"]).split()
    if dataset.attrs["sampling"] == "list":
        with path.open("w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(str(dataset[name].attrs["field"]) for name in names)
            rows.writerows(zip(*(dataset[name].values.tolist() for name in names), strict=True))
    return path
