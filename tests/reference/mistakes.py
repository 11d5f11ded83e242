"""Tables of mistakes, one a line: how a right text is changed, and what is then said.

In `name | old -> new | old ++ line | + end => said` the text of that name, or the first, is changed: old gives way to
new, a line comes after that with old, another text or a text of a name comes at the end. `\\n` is a line's end.
"""

from collections.abc import Callable, Iterator


def entries(table: str, texts: dict[str, str]) -> Iterator[tuple[str, str]]:
    """Each wrong text of a table, and what is said of it."""
    for line in filter(None, table.splitlines()):
        changes, _, said = line.rpartition(" => ")
        text = next(iter(texts.values()))
        for change in changes.replace("\\n", "\n").split(" | "):
            if change in texts:
                text = texts[change]
            elif change.startswith("+ "):
                text += texts.get(change[2:], change[2:] + "\n")
            else:
                old, mark, new = change.partition(" ++ " if " ++ " in change else " -> ")
                assert mark and old in text, line
                end = text.index("\n", text.index(old)) if mark == " ++ " else 0
                text = f"{text[:end]}\n{new}{text[end:]}" if end else text.replace(old, new, 1)
        yield text, said


def answered_otherwise(
    table: str, problems: Callable[[str], list[str]], /, **texts: str
) -> list[tuple[str, list[str]]]:
    """What is not said of the mistakes of a table, and what is said in its place."""
    answers = [(said, problems(text)) for text, said in entries(table, texts)]
    return [(said, found) for said, found in answers if not any(said in line for line in found)]
