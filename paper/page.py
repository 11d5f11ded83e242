"""The page about the paper: the table of verdicts, and every picture."""

from __future__ import annotations

from collections.abc import Sequence

from paper.found import Found
from paper.models import MODELS, PAPER, PLATE
from paper.parameters import Effort, Parameters
from paper.verdict import FEW, MOST, NOT, PARTLY, REPRODUCED, Verdict

MICRO = 1e6
SAID = {REPRODUCED: "**reproduced**", PARTLY: "partly", NOT: "**not**"}


def page_of(found: Sequence[Found], effort: Effort, parameters: Parameters, folder: str) -> str:
    """The page in Markdown; pictures are in a folder beside it."""
    verdicts = [verdict for one in found for verdict in one.verdicts]
    counts = {said: sum(verdict.verdict == said for verdict in verdicts) for said in (REPRODUCED, PARTLY, NOT)}
    parts = [
        "# The paper, figure by figure\n",
        '"Micropart Motion on a Surface Due to Controlled Surface Excitation": what it states, and what this '
        "program finds.\n",
        f"Written by `active-surface reproduce all{' --full' if effort.name == 'full' else ''} --output docs`. Of "
        f"{len(verdicts)} statements {counts[REPRODUCED]} are reproduced, {counts[PARTLY]} partly, {counts[NOT]} not. "
        "What the paper leaves open, and how much each figure depends on it: [open points](paper-open-points.md).\n",
        "Figures 1, 2 and 7 to 10 are drawings of concepts; there is nothing in them to be found again.\n",
        _how(effort, parameters),
        "## Verdicts\n",
        _table(verdicts),
        "## Figures\n",
    ]
    for one in found:
        parts.append(f"### {one.title}\n")
        parts.append(f"![{one.title}]({folder}/{one.name}.png)\n")
        parts.append(one.caption.rstrip(".").replace(" um", " µm") + f". [Data]({folder}/{one.name}.json)\n")
        for verdict in one.verdicts:
            parts.append(f"- **{verdict.figure}**: {verdict.why}".replace(" um", " µm"))
        parts.append("")
    return "\n".join(parts).rstrip() + "\n"


def _how(effort: Effort, p: Parameters) -> str:
    return "\n".join([
        "## How it was compared\n",
        f"One set of parameters for all figures (`paper/parameters.py`): a = {MICRO * p.radius:g} µm, actuators "
        f"{MICRO * p.pitch:g} µm apart, stroke {MICRO * p.stroke:g} µm up and down in 1/f, mass {1e9 * p.mass:g} µg, "
        f"gravity {p.gravity} m/s², friction by the preset `paper`. a, the drive and the preset were chosen with "
        "these figures in view, so where they agree that is in part a fit; nothing is chosen for one figure, but the "
        "platform's friction of figure 4.\n",
        "Three models:\n",
        f"- **{MODELS[PAPER]}**: fixed steps of {MICRO * p.time_step:g} µs by its equations (6) to (12), on equation "
        "(2);",
        "- **our equations, closed form**: the same surface, the full equations of motion, every slip and stop "
        "located ([motion](motion.md));",
        f"- **{MODELS[PLATE]}**: the same on one clamped plate of finite elements that all actuators are attached "
        "to.\n",
        "One actuator in the middle of a clamped disc bends it by equation (2), so that there the second and the "
        "third model must agree; they differ where paths are chaotic.\n",
        "With two actuators the closed form is put together in two ways: the profiles of both are added, or that of "
        "the nearest actuator counts alone. A plate does neither: on it an actuator that holds its point shapes the "
        "other's deflection.\n",
        f"Where paths are chaotic each model is asked from many starts, displaced by up to {MICRO * p.jitter:g} µm "
        f"along x and y, as the paper states places in µm: {effort.starts} ({effort.starts_by_steps} with the paper's "
        f"scheme). A statement is met when at least {100 * MOST:.0f} % of them do what it says, and not met when at "
        f"most {100 * FEW:.0f} % do. A verdict is "
        '"reproduced" when every model meets all of a statement, "not" when none meets any of it, else "partly".\n',
    ])  # fmt: skip


def _table(verdicts: Sequence[Verdict]) -> str:
    head = ["figure", "the paper", *MODELS.values(), "verdict"]
    rows = [head, ["---"] * len(head)]
    for verdict in verdicts:
        answers = [verdict.answers[model].text if model in verdict.answers else "-" for model in MODELS]
        rows.append([verdict.figure, verdict.statement, *answers, SAID[verdict.verdict]])
    return "\n".join("| " + " | ".join(cell.replace(" um", " µm") for cell in row) + " |" for row in rows) + "\n"
