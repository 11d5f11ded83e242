"""Opened: a case file that is open on the page, and what was made of it so far."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from active_surface.examples import examples_folder
from coupling.case import Case, read_case, unfit_name, write_edited

MAX_STEPS: Final = 200  # that can be taken back


@dataclass
class Opened:
    """A case as it was read, and the steps that were made from it."""

    saved: Case
    folder: Path  # that names of files in it are counted from
    file: Path | None  # where it is kept; None: it is an example that is nobody's yet
    steps: list[Case] = field(default_factory=list)  # those before this one, the oldest first
    undone: list[Case] = field(default_factory=list)
    gesture: Any = None  # of the latest step: what is dragged is one step until the hand lets go

    def __post_init__(self) -> None:
        self.case = self.saved

    def change(self, case: Case, gesture: Any) -> None:
        """Take a case as the next step, or in place of the latest one where that is of the same gesture."""
        if gesture is None or gesture != self.gesture:
            self.steps = [*self.steps, self.case][-MAX_STEPS:]
        self.case, self.undone, self.gesture = case, [], gesture

    def undo(self) -> bool:
        """Take the latest step back; whether there was one."""
        return self._step(self.steps, self.undone)

    def redo(self) -> bool:
        """Take a step again that was taken back; whether there was one."""
        return self._step(self.undone, self.steps)

    def save(self, name: str, replace: bool) -> Path:
        """Write the case to a file in its folder, where all that is the same stays as it was written.

        Raises ValueError where the name is none of a case file, or is taken and not to be replaced.
        """
        name = name if "." in name else f"{name}.toml"
        path = self.folder_to_save / name
        if Path(name).name != name or not name.endswith(".toml") or name.startswith("."):
            raise ValueError(f'the name must be that of a file in this folder, such as "my_case.toml"; got "{name}"')
        if unfit := unfit_name(path.stem):
            raise ValueError(f"the file {unfit}")
        if path.exists() and not replace:
            raise ValueError(f"{name} exists; replace it, or choose another name")
        write_edited(self.case, self.saved, self.folder, path)
        self.saved, self.folder, self.file = read_case(path), path.parent, path
        self.case = self.saved
        return path

    @property
    def folder_to_save(self) -> Path:
        """Where files are written: beside the case's file; of an example the folder that the program was started in."""
        return Path.cwd() if self.file is None else self.folder

    def _step(self, back: list[Case], forth: list[Case]) -> bool:
        if not back:
            return False
        forth.append(self.case)
        self.case, self.gesture = back.pop(), None
        return True


def open_case(path: Path) -> Opened:
    """A case file; raises CaseError where it cannot be read."""
    return Opened(read_case(path), path.absolute().parent, path.absolute())


def open_example(name: str) -> Opened:
    """An example of the program; raises ValueError where there is no such case."""
    if name not in example_cases():
        raise ValueError(f"must be one of the examples; got {name}")
    path = examples_folder() / f"{name}.toml"
    return Opened(read_case(path), path.parent, None)


def example_cases() -> dict[str, str]:
    """The examples that are cases, and what each is about."""
    from active_surface.examples import example_names, kind_of

    return {name: about for name, about in example_names().items() if kind_of(name) == "case"}
