"""Case files as newcomers write them: who follows each message to the letter has a right file after one step."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

import pytest

from coupling.case import CaseError, Problem, read_case

FILES = sorted((Path(__file__).parents[2] / "newcomers").glob("*.toml"))
TEXT = r'"(?:[^"\\]|\\.)*"'
OFFERED = re.compile(
    rf"(?:did you mean|write|point:|is) ({TEXT}|\[[^;]*\]|true|false|[\d.]+)"
    rf"(?:, which is [^?]*)?(?: or {TEXT})?(?:\?|, without quotes)?$"
)


class Follower:
    """Somebody who does what messages say, and knows nothing else."""

    def __init__(self, text: str) -> None:
        self.lines = text.split("\n")
        self.gone: set[int] = set()
        self.below: dict[int, list[str]] = defaultdict(list)
        self.moved: dict[int, str] = {}  # lines, and the headers to which they go

    def follow(self, problem: Problem) -> None:
        number, message = (problem.line or 0) - 1, problem.message
        line = self.lines[number]
        if "curly quote" in message:
            self.lines = [re.sub("[“”]", '"', line) for line in self.lines]
        elif "leave it out" in message or "leave out one" in message:
            self.gone.add(number)
        elif "double brackets" in message:
            self.lines[number] = re.sub(r"\[(\w+)\]", r"[[\1]]", line)
        elif match := re.search(r"(?:did you mean (\w+) in|belongs? to) (\[.*\])", message):
            self.move(number, match[2], match[1])
        elif match := re.search(r"is not known; did you mean (\w+)\?(.*)$", message):
            if line.startswith("["):
                self.lines[number] = line.replace(problem.field, match[1])
            else:
                value = OFFERED.search(match[2])
                self.lines[number] = f"{match[1]} = " + (value[1] if value else line.partition("=")[2].strip())
        elif match := re.search(r"; write (\w+ = .*)$", message):
            new = re.sub(r" and (?=\w+ = )", "\n", match[1])
            if message.startswith("is missing"):
                self.below[number].append(new)
            elif new == self.lines[number - 1]:  # said of the line above as well, as of x and y
                self.gone.add(number)
            else:
                self.lines[number] = new
        elif match := re.search(rf"^is missing; .*such as ({TEXT}|\[.*?\])", message):
            self.below[number].append(f"{problem.field.split('.')[-1]} = {match[1]}")
        elif match := OFFERED.search(message):
            self.lines[number] = self.with_value(line, problem, match[1])

    def move(self, number: int, header: str, key: str | None) -> None:
        """Take a line, under another key if there is one, or all lines of a table, to where they belong."""
        if key:
            self.lines[number] = f"{key} ={self.lines[number].partition('=')[2]}"
        if not self.lines[number].startswith("["):
            self.moved[number] = header
            return
        self.gone.add(number)
        self.moved |= dict.fromkeys(range(number + 1, self.lines.index("", number)), header)

    @staticmethod
    def with_value(line: str, problem: Problem, value: str) -> str:
        """A line with a value in place of that which is wrong."""
        item = re.search(r"\[(\d+)\]$", problem.field)
        if item and "= [" in line:
            head, _, items = line.partition("= [")
            values = items.rstrip("] ").split(", ")
            values[int(item[1])] = value
            return f"{head}= [{', '.join(values)}]"
        got = re.search(r"; got (.*?)(?:, (?:but|a |an |which|in quotes)|; )", problem.message)
        old = got[1] if got and got[1] in line else line.partition("=")[2].strip()
        return line.replace(old, value, 1)

    @property
    def text(self) -> str:
        for n, header in self.moved.items():
            if header not in self.lines:
                self.lines += ["", header]
            self.below[self.lines.index(header)].append(self.lines[n])
        kept = [(n, line) for n, line in enumerate(self.lines) if n not in self.gone | {*self.moved}]
        return "\n".join("\n".join([line, *self.below[n]]) for n, line in kept)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_one_step_leads_to_a_right_file(path: Path, tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read_case(path)
    follower = Follower(path.read_text(encoding="utf-8"))
    for problem in caught.value.problems:
        follower.follow(problem)
    (tmp_path / path.name).write_text(follower.text, encoding="utf-8")
    assert read_case(tmp_path / path.name).run.duration > 0


def test_there_are_files() -> None:
    assert len(FILES) >= 10
