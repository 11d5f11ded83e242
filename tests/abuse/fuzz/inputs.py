"""Inputs: one of every kind, made from its number alone, and what is done with it."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from fuzz import seeds
from fuzz.damage import damaged_hdf5
from fuzz.mutations import NUMBERS, WORDS, mutated_bytes, mutated_text, quantity
from fuzz.page import messages

Command = list[str]


class Maker(NamedTuple):
    """What makes inputs of one kind: it writes files into the current folder, and returns the command to try."""

    make: Callable[[random.Random, Path], Command]
    share: float  # of all inputs


@cache
def _texts() -> Mapping[str, list[str]]:
    return seeds.texts()


def _check_of(kind: str) -> Callable[[random.Random, Path], Command]:
    def make(chance: random.Random, _: Path) -> Command:
        others = _texts()[kind]
        _write("quick.toml", seeds.QUICK)
        _write("input.toml", mutated_text(chance.choice(others), chance, others))
        return ["check", "input.toml", *chance.choice(([], ["--json"]))]

    return make


def _write(name: str, content: str | bytes) -> None:
    data = content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
    Path(name).write_bytes(data)


def _mutated(data: bytes, chance: random.Random) -> bytes:
    """Data with something wrong, as a text if it is one."""
    if b"\0" not in data and chance.random() < 0.7:
        return mutated_text(data.decode("utf-8", "replace"), chance).encode("utf-8", "surrogatepass")
    return mutated_bytes(data, chance)


def mesh(chance: random.Random, made: Path) -> Command:
    """A case with a damaged mesh."""
    paths = sorted(path for path in made.iterdir() if path.suffix in (".msh", ".vtu", ".xdmf"))
    path = chance.choice(paths)
    heavy = path.with_suffix(".h5")
    for one in (path, *([heavy] if path.stem == "b" and path.suffix == ".xdmf" else [])):
        _write(f"plate{one.suffix}" if one == path else one.name, _mutated(one.read_bytes(), chance))
    _write("input.toml", seeds.case_with("mesh", ending=path.suffix[1:]))
    return ["check", "input.toml"]


def table(chance: random.Random, _: Path) -> Command:
    """A case or study with a damaged table of numbers."""
    _write("quick.toml", seeds.QUICK)
    name, text, case = chance.choice(
        (
            ("points.csv", seeds.FRICTION, seeds.case_with("friction")),
            ("motion.csv", seeds.MOTION, seeds.PLATFORM),
            ("points.csv", seeds.POINTS, '[study]\ncase = "quick.toml"\npoints = "points.csv"\n'),
        )
    )
    _write(name, _mutated(text.encode(), chance))
    _write("input.toml", case)
    return ["check", "input.toml"]


def result(chance: random.Random, made: Path) -> Command:
    """A damaged result of a run."""
    for kind in ("plate", "part"):
        data = (made / f"quick.{kind}.vtkhdf").read_bytes()
        if chance.random() < 0.6:
            data = damaged_hdf5(data, chance) if chance.random() < 0.5 else mutated_bytes(data, chance)
        _write(f"quick.{kind}.vtkhdf", data)
    words = chance.choice((["export", "quick", "--format", "csv"], ["reading", "quick"], ["reading", "quick"]))
    return [*words, "-o", "out"] if words[0] == "export" else words


def sweep(chance: random.Random, made: Path) -> Command:
    """A damaged result of a sweep."""
    data = (made / "study.nc").read_bytes()
    _write("study.nc", damaged_hdf5(data, chance) if chance.random() < 0.5 else mutated_bytes(data, chance))
    return ["plot", "study.nc", "--format", "svg", "-o", "out"] if chance.random() < 0.1 else ["reading", "study.nc"]


def formula(chance: random.Random, _: Path) -> Command:
    """A lattice with an expression by grammar."""
    unit = chance.choice(("Hz", "ms", "kHz", "", "um"))
    key = chance.choice(("frequency", "delay", "where"))
    text = expression(chance, chance.choice((1, 2, 3, 6)))
    if chance.random() < 0.2:
        text = mutated_text(text, chance)
    quoted = text.replace("\\", "").replace('"', "").replace("\n", " ")
    text = quoted if key == "where" else f"{quoted} {unit}"
    _write("input.toml", seeds.lattice_case(**{key: text}).replace("\x00", ""))
    return ["check", "input.toml"]


def expression(chance: random.Random, depth: int) -> str:
    """An expression, nearly right."""
    if depth == 0:
        return chance.choice((*("row", "column", "rows", "x", "y", "pi", "t", "2", "0.5"), *NUMBERS, *WORDS[-8:]))
    one, other = (expression(chance, depth - 1) for _ in range(2))
    function = chance.choice(("sqrt", "sin", "exp", "log", "abs", "max", "hypot", "atan2", "floor", "eval", "open"))
    return chance.choice(
        (
            f"{one} {chance.choice(('+', '-', '*', '/', '//', '%', '**', '<', '==', 'and', 'or', '@', '|'))} {other}",
            f"({one})",
            f"-{one}",
            f"not {one}",
            f"{function}({one})",
            f"{function}({one}, {other})",
            f"{one} if {other} else {one}",
        )
    )


def extreme(chance: random.Random, _: Path) -> Command:
    """A run of a case with sizes that are right, and far from usual."""
    text = seeds.QUICK
    for old, low, high, unit in (
        ("300 um", 1e-7, 1e-1, "m"), ("169 GPa", 1e3, 1e13, "Pa"), ("5 um", 1e-9, 1e-3, "m"), ("3 kHz", 1.0, 1e6, "Hz"),
        ("2e-9 kg", 1e-18, 1.0, "kg"), ("600 nN", 1e-15, 1.0, "N"), ("1 ms", 1e-8, 1e-2, "s"),
    ):  # fmt: skip
        if chance.random() < 0.3:
            value = math.exp(chance.uniform(math.log(low), math.log(high)))
            text = text.replace(f'"{old}"', f'"{value:.4g} {unit}"', 1)
            if old == "300 um":  # as many cells
                text = text.replace('"150 um"', f'"{value / 2:.4g} m"')
    _write("input.toml", text)
    return ["run", "input.toml", "--json", "-o", "out"]


def command(chance: random.Random, made: Path) -> Command:
    """A command line by grammar."""
    _write("quick.toml", seeds.QUICK)
    _write("study.toml", seeds.STUDY)
    for name in ("quick.plate.vtkhdf", "quick.part.vtkhdf", "study.nc"):
        _write(name, (made / name).read_bytes())
    names = (
        *("check", "view", "plot", "export", "animate", "response", "influence", "identify", "fit", "aim", "plan"),
        *("rerun", "schema", "example", "completion", "feasibility", "reproduce", "verify", "run", "sweep", "chekc"),
        "--version",
    )
    options = (
        *("--json", "--quiet", "-o", "--output", "--format", "--threads", "--target", "--through", "--x", "--width"),
        *("--help", "--camera", "--size", "--fps", "--free", "--measured", "--pixels", "--dead", "--frequency"),
        "--robust",
    )
    files = (
        *("quick.toml", "quick", "study.nc", "study.toml", "missing.toml", ".", "/dev/zero", "pipe", "loop"),
        "quick.part.vtkhdf",
    )
    words = [chance.choice(names)]
    for _ in range(chance.choice((0, 1, 1, 2, 3, 5))):
        kind = chance.choice(
            (files, options, (*NUMBERS, *WORDS), (quantity(chance), "1,2", "0.1 mm,5 um", "png", "out"))
        )
        words.append(chance.choice(kind).replace("\x00", ""))
    # Right command lines of these take long; others of them are refused at once.
    slow = (
        *("reproduce", "verify", "animate", "sweep", "feasibility", "aim", "plan", "identify", "response"),
        *("influence", "rerun"),
    )
    if words[0] in slow:
        others = (word.replace("quick", "missing").replace("study", "missing") for word in words[1:])
        words = [words[0], *others, *("--wrong",) * 3]
    return words


MAKERS: Final[Mapping[str, Maker]] = {
    "case": Maker(_check_of("case"), 0.34),
    "study": Maker(_check_of("study"), 0.08),
    "aim": Maker(_check_of("aim"), 0.06),
    "mesh": Maker(mesh, 0.10),
    "table": Maker(table, 0.08),
    "run result": Maker(result, 0.09),
    "sweep result": Maker(sweep, 0.09),
    "formula": Maker(formula, 0.10),
    "command line": Maker(command, 0.055),
    "page": Maker(messages, 0.004),
    "extreme run": Maker(extreme, 0.001),
}


def make(seed: int, number: int, made: Path) -> tuple[str, Command]:
    """Write input `number` of a seed into the current folder; returns its kind and the command."""
    chance = random.Random(f"{seed}/{number}")
    kind = chance.choices(list(MAKERS), [maker.share for maker in MAKERS.values()])[0]
    return kind, MAKERS[kind].make(chance, made)
