"""Spelling: the units and numbers that are meant where they are written in another way than units are here."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Iterator
from itertools import product
from typing import Final, NamedTuple

_SYMBOLS: Final = (
    *("m", "um", "cm", "mm", "nm", "s", "ms", "us", "ns", "Hz", "kHz", "MHz", "GHz", "kg", "g", "mg", "ug", "ng"),
    *("rad", "deg", "turn", "degree", "radian", "micron", "L", "mL"),
    *("N", "kN", "mN", "uN", "nN", "Pa", "kPa", "MPa", "GPa", "J", "mJ", "uJ", "nJ", "K", "W"),
)
_BASES: Final = ("meter", "metre", "second", "hertz", "gram", "newton", "pascal", "joule")
_PREFIXES: Final = ("", "kilo", "mega", "giga", "centi", "milli", "micro", "nano")
USUAL: Final = (*_SYMBOLS, *(prefix + base for base in _BASES for prefix in _PREFIXES))
"""Units that somebody is likely to mean; prefixes that nobody needs here, as in Mm, are left out."""

ALIASES: Final = {
    "mu": "um",  # the Greek letter by name
    "mym": "um",
    "ccm": "cm^3",
    "qm": "m^2",
    "cps": "Hz",  # cycles a second; pint counts counts
    "sek": "s",
    "rev": "turn",
    "grad": "deg",  # as German has it, in capitals; what pint calls grad is one of 400 in a turn
    "grd": "deg",
    "gr": "g",
    "rads": "rad",  # pint has a dose of that name
}
"""What people also call units that have another name, or another meaning, here; in small letters."""

MULTIPLES: Final = {
    "m/s^2": dict.fromkeys(("g", "G", "gn", "g0", "gee"), (9.80665, "m/s^2")),
    "rad": dict.fromkeys(("pi", "\u03c0", "pi rad", "\u03c0 rad"), (180.0, "deg")),
}
"""Units that are a name for some of another one where such a quantity is meant, and how many of which they are."""

MISREAD: Final = ("Grad", "gr")
"""Units that are taken for unknown, as nobody means what pint reads: a thousand million radians, and a grain."""

MAX_MEANT: Final = 2
"""Units that differ, of which it may be worth to ask whether they are meant."""

SHORT: Final = 5  # letters: shorter names are alike too easily
_ALIKE: Final = {True: 0.8, False: 0.75}  # ratio of difflib, of short and of other names

_FACTOR: Final = re.compile(
    r"(?P<sign>[\s*/.·⋅]*)(?P<name>[^\W\d_]+(?:_[^\W\d]+)?|°|%)(?:(?:\^|\*\*)?\(?(?P<power>[+-]?\d+)\)?)?"
)
_SUPERSCRIPTS: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_PREFIX_WORD: Final = re.compile(rf"\b({'|'.join(_PREFIXES[1:])})[\s-]+(?=[a-zA-Z])", re.IGNORECASE)
_TIMES_TEN: Final = re.compile(r"\s*[*x×·⋅]\s*10\s*(?:\^|\*\*)?\s*\(?([+-]?\d+)\)?(?=\s*[^\W\d])")
_DECIMAL_COMMA: Final = re.compile(r"([+-]?(?:0,\d+|\d+,(?:\d{1,2}|\d{4,})))(?=[eE\s]|[^\W\d]|$)")


class _Factor(NamedTuple):
    sign: str  # what joins it to the one before
    name: str
    power: str


def meant_units(unit: str, known: Callable[[str], bool], fits: Callable[[str], bool]) -> list[str]:
    """The units that may be meant by one that is wrong: one, several that are as likely, or none.

    known: whether a name is that of a unit.  fits: whether a unit has the dimension that is needed.
    """
    joined = re.sub(r"\s+", "", unit)  # as in "k Hz"
    if joined != unit and known(joined) and fits(joined):
        return [joined]
    factors = _factors(unit)
    if not factors:
        return []
    for options in (_same, _in_other_letters, _alike):
        names = [list(dict.fromkeys(options(factor.name, known))) for factor in factors]
        texts = [_joined(factors, choice) for choice in product(*names)]
        meant = [text for text in dict.fromkeys(texts) if text != unit and fits(text)]
        if meant:
            return meant
    return []


def meant_number(text: str) -> str | None:
    """A number and its unit as they are written here; None: nothing in the text is known to be written otherwise."""
    plain = re.sub("[\N{MINUS SIGN}\N{EN DASH}]", "-", text.strip()).translate(_SUPERSCRIPTS if "10" in text else {})
    plain = _DECIMAL_COMMA.sub(lambda match: match[1].replace(",", "."), plain, count=1)
    plain = _TIMES_TEN.sub(r"e\1", plain, count=1)
    plain = re.sub(r"(?<=\d)[ '\N{NARROW NO-BREAK SPACE}\N{NO-BREAK SPACE}](?=\d{3}(?:\D|$))", "", plain)
    return plain if plain != text.strip() else None


def _factors(unit: str) -> list[_Factor]:
    """The factors of a unit; none where it is not made of such."""
    text = _PREFIX_WORD.sub(lambda match: match[1].lower(), unit.strip().translate(_SUPERSCRIPTS))
    factors, place = [], 0
    while match := _FACTOR.match(text, place):
        if match.end() == place:
            break
        factors.append(_Factor(match["sign"].strip(), match["name"], match["power"] or ""))
        place = match.end()
    whole = place == len(text) and all(factor.sign in ("", "*", "/", ".", "·", "⋅") for factor in factors)
    return factors if whole else []


def _joined(factors: Iterable[_Factor], names: Iterable[str]) -> str:
    """A unit of these factors under other names, one of which may be a power, as cm^3 is."""
    text = ""
    for factor, name in zip(factors, names, strict=True):
        joint = "/" if factor.sign == "/" else " " if text else ""
        text += joint + name + (f"^{factor.power}" if factor.power not in ("", "1") else "")
    return text


def _same(name: str, known: Callable[[str], bool]) -> Iterator[str]:
    if known(name):
        yield name


def _in_other_letters(name: str, known: Callable[[str], bool]) -> Iterator[str]:
    """Yield a name, its alias, and usual units that differ in capitals only."""
    yield from _same(name, known)
    alias = ALIASES.get(name.lower())
    if alias:
        yield alias
    else:
        yield from (usual for usual in USUAL if usual.lower() == name.lower())


def _alike(name: str, known: Callable[[str], bool]) -> Iterator[str]:
    """Yield a name, or the usual units that are most like it where it is unknown."""
    others = list(_in_other_letters(name, known))
    yield from others
    if others:
        return
    short = len(name) < SHORT
    ratios = {
        usual: _likeness(usual.lower(), name.lower()) for usual in USUAL if (len(usual) < SHORT) == short or not short
    }
    best = max(ratios.values())
    if best >= _ALIKE[short]:
        yield from (usual for usual, ratio in ratios.items() if ratio == best)


def _likeness(one: str, other: str) -> float:
    """How alike two names are, from 0 to 1; letters in another order hardly count."""
    swapped = _ALIKE[True] if sorted(one) == sorted(other) else 0.0
    return max(swapped, difflib.SequenceMatcher(None, one, other).ratio())
