"""Two cycles of one actuator: where the part goes, and when it sticks and slips."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from coupling import Case, read_case, run_case
from particle import KogutEtsion, State

CASE = Path(__file__).parents[2] / "examples/one_actuator.toml"


def draw(quick: bool = False) -> Figure:
    case = read_case(CASE)
    run = case.run.model_copy(update={"duration": 2e-3 if quick else 2 / 300})
    path = run_case(Case.model_validate(dict(case) | {"run": run})).trajectory

    time = np.linspace(0, path.time[-1], 600)
    part = path.at(time)
    figure = Figure(figsize=(8, 5), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    upper.plot(time * 1e3, np.hypot(*part.position.T) * 1e6, color="black")
    upper.set_ylabel("distance from\nthe actuator [µm]")
    lower.plot(
        time * 1e3, KogutEtsion.paper().friction_limit(part.normal_force) * 1e9, color="black", label="its limit"
    )
    lower.plot(time * 1e3, part.friction_force * 1e9, "--", color="#c8371b", label="friction force")
    lower.set_ylabel("force [nN]")
    lower.set_xlabel("time [ms]")
    for axes in (upper, lower):
        stuck = part.state == State.STICK
        axes.fill_between(
            time * 1e3, 0, 1, where=stuck, transform=axes.get_xaxis_transform(), color="#d4deee", label="stuck"
        )
        axes.set_xlim(0, time[-1] * 1e3)
    figure.legend(*lower.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


if __name__ == "__main__":
    draw().savefig(Path(__file__).with_suffix(".png"), dpi=80)
