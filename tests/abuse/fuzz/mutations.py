"""Mutations: what may be wrong with a text or with bytes, all from one source of chance."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from typing import Final

NUMBERS: Final = (
    *("0", "-0.0", "-1", "1", "2", "3", "0.5", "1e-3", "7e-13", "1e-15", "1e6", "1e12", "1e150", "1e300", "-1e300"),
    *("1e-300", "5e-324", "1.7976931348623157e308", "nan", "inf", "-inf", "1e9999", "99999999999", "-99999999999"),
    *("9223372036854775807", "9223372036854775808", "1" * 400, "1_0", "0x10", "0b1", ".5", "5.", "1,5", "1e", "٣"),
)
UNITS: Final = (
    *("m", "mm", "um", "nm", "s", "ms", "Hz", "kHz", "kg", "ug", "N", "uN", "GPa", "Pa", "deg", "rad", "J/m^2", "m/s"),
    *("kg/m^3", "N/m", "N/m^3", "m^2", "", "UM", "furlong", "m**9", "m^-1", "1/s", "%", "degC", "(m", "m" * 300),
)
WORDS: Final = (
    *("", " ", "true", "false", "endless", "paper", "disc", "rectangle", "annulus", "polygon", "platform", "coulomb"),
    *("von-karman", "steady", "free", "clamped", "fly", "fixed", "sine", "up", "hold", "linear", "table", "111"),
    *("../secret", "/dev/zero", "/dev/null", "pipe", "loop", ".", "/", "nothing.csv", "\\u0000", "é", "<script>"),
    *("x" * 5000, "__import__('os')", "row", "9**9**9", "((((((((((x))))))))))", "row if row else", "1 if 1 else 2 um"),
    *("x.y", "[]"),
)
VALUES: Final = (
    *("[]", "{}", "[[]]", "[[1, 2]]", '["1 um"]', '["1 um", "2 um"]', "{ x = 1 }", "1979-05-27", "[" * 40 + "]" * 40),
)
BYTES: Final = (
    *(b"\x00", b"\xff", b"\x7f", b"\x80", b"\xff" * 4, b"\xff" * 8, b"\x00" * 8, b"\x00" * 64),
    b"\x7f" + b"\xff" * 7,
)
_NUMBER: Final = re.compile(r"-?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?")
_TEXT: Final = re.compile(r'"[^"\n]*"')
_VALUE: Final = re.compile(r"(?<== )[^\n]+")


def mutated_text(text: str, chance: random.Random, others: Sequence[str] = ()) -> str:
    """A text with one to four things wrong."""
    for _ in range(chance.choice((1, 1, 1, 2, 2, 4))):
        text = chance.choice(_TEXT_MUTATIONS)(text, chance, others)
    return text


def quantity(chance: random.Random) -> str:
    """A number and a unit, often wrong."""
    return chance.choice(NUMBERS) + chance.choice((" ", "", "  ", "\t")) + chance.choice(UNITS)


def _replaced(pattern: re.Pattern[str], new: Callable[[random.Random], str]) -> Callable[..., str]:
    def mutation(text: str, chance: random.Random, _: Sequence[str]) -> str:
        found = list(pattern.finditer(text))
        if not found:
            return text
        match = chance.choice(found)
        return text[: match.start()] + new(chance) + text[match.end() :]

    return mutation


def _lines(text: str, chance: random.Random, others: Sequence[str]) -> str:
    lines = text.split("\n")
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    match chance.randrange(7):
        case 0:
            del lines[at]
        case 1:
            lines.insert(other, lines[at])
        case 2:
            lines[at], lines[other] = lines[other], lines[at]
        case 3:
            lines[at:at] = [lines[at]] * chance.choice((2, 50, 1000))
        case 4:
            del lines[min(at, other) : max(at, other)]
        case 5:
            lines[at] = lines[at] * chance.choice((2, 20))
        case _:
            more = chance.choice(others).split("\n") if others else lines
            cut = chance.randrange(len(more))
            lines[at:at] = more[cut : cut + chance.choice((1, 3, 10))]
    return "\n".join(lines)


def _characters(text: str, chance: random.Random, _: Sequence[str]) -> str:
    at = chance.randrange(len(text) + 1)
    count = chance.choice((1, 1, 2, 5, 40))
    match chance.randrange(4):
        case 0:
            return text[:at] + text[at + count :]
        case 1:
            return text[:at] + chance.choice("\x00\"'[]{}=#.,-+*/\\\n\t \u201c\ufeff\U0001f600e9") * count + text[at:]
        case 2:
            return text[:at]
        case _:
            return text[:at] + chr(chance.randrange(1, 0x250)) + text[at + 1 :]


def _key(text: str, chance: random.Random, _: Sequence[str]) -> str:
    keys = re.findall(r"^(\w+) = ", text, re.MULTILINE)
    if not keys:
        return text
    old = chance.choice(keys)
    new = chance.choice([*keys, "E", "diameter", "mesh", "x", "sides", "force", "phase", "table"])
    return text.replace(f"{old} = ", f"{new} = ", 1)


_TEXT_MUTATIONS: Final = (
    _replaced(_NUMBER, lambda chance: chance.choice(NUMBERS)),
    _replaced(_NUMBER, lambda chance: f"{10 ** chance.uniform(-12, 12):.3g}"),
    _replaced(_TEXT, lambda chance: f'"{quantity(chance)}"'),
    _replaced(_TEXT, lambda chance: f'"{chance.choice(WORDS)}"'),
    _replaced(_VALUE, lambda chance: chance.choice((*VALUES, *NUMBERS[:20], "true", f'"{quantity(chance)}"'))),
    _lines,
    _characters,
    _key,
)


def mutated_bytes(data: bytes, chance: random.Random, others: Sequence[bytes] = ()) -> bytes:
    """Bytes with one to eight places wrong, half of them where a header is."""
    result = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4, 8))):
        if not result:
            return b""
        at = chance.randrange(min(len(result), chance.choice((100, 2048, len(result)))))
        match chance.randrange(8):
            case 0 | 1:
                result[at] ^= 1 << chance.randrange(8)
            case 2 | 3:
                new = chance.choice(BYTES)
                result[at : at + len(new)] = new
            case 4:
                result[at] = chance.randrange(256)
            case 5:
                del result[at : at + chance.choice((1, 8, 512))]
            case 6:
                length = chance.choice((8, 64, 512))
                source = chance.choice([bytes(result), *others])
                start = chance.randrange(len(source) + 1)
                result[at : at + length] = source[start : start + length]
            case _:
                if chance.random() < 0.3:
                    del result[at:]
    return bytes(result)
