"""The page about the paper: the table of verdicts, and every picture."""

from __future__ import annotations

from collections.abc import Sequence

from active_surface.paper.figure_result import FigureResult
from active_surface.paper.figures import paragraph
from active_surface.paper.models import CLOSED, MODELS, PAPER, PLATE
from active_surface.paper.parameters import Effort, Parameters
from active_surface.paper.share import HARDLY_ANY, NEARLY_ALL
from active_surface.paper.verdict import BEYOND, NOT, PARTLY, REPRODUCED, Verdict

MICRO = 1e6
SAID = {REPRODUCED: "**reproduced**", PARTLY: "partly", NOT: "**not**", BEYOND: "-"}
IN_SHORT = {REPRODUCED: "**yes**", PARTLY: "partly", NOT: "**no**"}


def page_of(
    results: Sequence[FigureResult], effort: Effort, parameters: Parameters, folder: str, builder: Sequence[str] = ()
) -> str:
    """The page in Markdown; pictures are in a folder beside it; builder: sentences on what a builder would see."""
    verdicts = [verdict for one in results for verdict in one.verdicts]
    parts = [
        "# The paper, figure by figure\n",
        "**Outside the model's validity:** the paper's strokes are 20 to 40 times the plate's thickness; the figures "
        "compare with the paper's linear theory, not with a device ([limits](limits.md)).\n",
        '"Micropart Motion on a Surface Due to Controlled Surface Excitation": what it states, and what this '
        "program computes.\n",
        f"Written by `active-surface reproduce all{' --full' if effort.name == 'full' else ''} --output docs`. "
        f"{counted(verdicts)} That is one reading of what the paper leaves open; over which readings each statement "
        "holds: [readings](paper-readings.md). What is left open: [open points](paper-open-points.md).\n",
        "Figures 1, 2 and 7 to 10 are drawings of concepts; they hold nothing to reproduce.\n",
        _how(effort, parameters),
        "## Verdicts\n",
        _table(verdicts),
        *_builder(builder),
        "## Figures\n",
    ]
    for one in results:
        parts.append(f"### {one.title}\n")
        parts.append(f"![{one.title}]({folder}/{one.name}.png)\n")
        parts.append(f"{one.caption.rstrip('.')}. [Data]({folder}/{one.name}.json)\n")
        for verdict in one.verdicts:
            parts.append(f"- **{verdict.figure}**: {verdict.why}")
            parts += [f"  - {MODELS[model]}: {one.more}." for model, one in verdict.answers.items() if one.more]
        parts.append("")
    return "\n".join(parts).replace(" um", " µm").replace("m/s^2", "m/s²").rstrip() + "\n"


def _builder(sentences: Sequence[str]) -> list[str]:
    if not sentences:
        return []
    return [
        "## What a builder would see\n",
        "The same statements on plates that stretch, with parts of some height on their top face and with gravity, "
        "as computed for the [readings](paper-readings.md#what-a-builder-would-see):\n",
        *(f"- {one}" for one in sentences),
        "",
    ]


def counted(verdicts: Sequence[Verdict]) -> str:
    """How many statements hold in the paper's own scheme, and in ours."""
    judged = [verdict for verdict in verdicts if not verdict.beyond]
    kinds = [verdict.verdict for verdict in judged]
    text = (
        f"Of {len(judged)} statements the paper's own scheme reproduces {kinds.count(REPRODUCED)}, "
        f"{kinds.count(PARTLY)} partly, {kinds.count(NOT)} not."
    )
    ours = []
    for model, where in ((CLOSED, "on the closed form"), (PLATE, "on finite elements")):
        own = [verdict.answers[model].verdict for verdict in judged if model in verdict.answers]
        if own:
            ours.append(f"{own.count(REPRODUCED)} of {len(own)} {where} ({own.count(PARTLY)} partly)")
    return text + (f" Our equations meet {' and '.join(ours)}." if ours else "")


def _how(effort: Effort, p: Parameters) -> str:
    return "\n".join([
        "## How it was compared\n",
        f"One set of parameters for all figures (`active_surface/paper/parameters.py`): a = {MICRO * p.radius:g} µm, "
        f"actuators {MICRO * p.pitch:g} µm apart, stroke {MICRO * p.stroke:g} µm up and down in 1/f, "
        f"mass {1e9 * p.mass:g} µg, "
        f"{f'gravity {p.gravity} m/s²' if p.gravity else 'no gravity, as the paper has none'}, friction by the preset "
        "`paper`. a, the drive and the preset were chosen with "
        "these figures in view, so where they agree that is in part a fit. What single figures need and the paper does "
        "not state was chosen for them: the platform's motion and friction (4), the strokes (5, 6, 15), the second "
        "start (14), the start (15, 16), the number of cycles (16), the places (18) and the states (19, 22).\n",
        "The paper's part is a point on the plate's mid-plane, and so it is in all figures and models here. A case "
        "file has parts on the top face, which bending also moves in its plane, unless its `[plate]` has "
        "`top_face = false` ([motion](motion.md#equations)).\n",
        "Three models:\n",
        f"- **{MODELS[PAPER]}**: fixed steps of {MICRO * p.time_step:g} µs by its equations (6) to (12), on equation "
        "(2);",
        "- **our equations, closed form**: the same surface, the full equations of motion, every slip and stop "
        "located ([motion](motion.md));",
        f"- **{MODELS[PLATE]}**: the same on one clamped plate of finite elements that all actuators are attached "
        "to.\n",
        paragraph(p),
        "One actuator in the middle of a clamped disc bends it by equation (2), so that there the second and the "
        "third model must agree; they differ where paths are chaotic.\n",
        "With two actuators the closed form is put together in two ways: the profiles of both are added, or that of "
        "the nearest actuator counts alone. A plate does neither: on it an actuator that holds its point shapes the "
        "other's deflection. Nor is its rim the same: each closed form is a disc of radius a around its actuator, "
        f"together from {-MICRO * p.radius:g} to {MICRO * (p.pitch + p.radius):g} µm along x, the plate is one such "
        f"disc with its centre half-way between them, from {MICRO * (p.pitch / 2 - p.radius):g} to "
        f"{MICRO * (p.pitch / 2 + p.radius):g} µm. Parts that go over the rim cannot be compared.\n",
        f"Where paths are chaotic each model is asked from many starts, displaced by up to {MICRO * p.jitter:g} µm "
        f"along x and y, as the paper states places in µm: {effort.starts} ({effort.starts_by_steps} with the paper's "
        'scheme). "87 % (76-93)" has Wilson\'s interval of 95 %. A statement is met when that interval lies above '
        f"{100 * NEARLY_ALL:.0f} %, and not met when it lies below {100 * HARDLY_ANY:.0f} %; else it is undecided, and "
        "counts half.\n",
        "**The verdict is that of the paper's own scheme**, as the paper's sentences are about that: "
        "\"reproduced\" when "
        "it meets all that a sentence says, \"not\" when it meets nothing of it, else \"partly\". Our equations answer "
        "beside it, each model for itself. A statement without a surface or a scheme has one answer.\n",
    ])  # fmt: skip


def _table(verdicts: Sequence[Verdict]) -> str:
    head = ["figure", "the paper", "verdict", *MODELS.values()]
    rows = [head, ["---"] * len(head)]
    for verdict in verdicts:
        cells = [_cell(verdict, model) for model in MODELS]
        rows.append([verdict.figure, verdict.statement, SAID[verdict.verdict], *cells])
    return "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"


def _cell(verdict: Verdict, model: str) -> str:
    answer = verdict.answers.get(model)
    if answer is None:
        return "-"
    return answer.text if verdict.beyond or model == PAPER else f"{IN_SHORT[answer.verdict]}: {answer.text}"
