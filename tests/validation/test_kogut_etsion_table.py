"""The table of friction limits against quadrature in 30 digits, at random loads of contacts with random parameters."""

import math

import contact_in_30_digits as exact
import mpmath as mp
import numpy as np
import pytest

from particle import KogutEtsion
from particle.friction.kogut_etsion import NEAREST, ROUNDING

RANGES = {
    "roughness": (3e-9, 200e-9), "contact_area": (1e-12, 1e-6), "hardness": (2e8, 2e10), "adhesion_energy": (1e-2, 5.0),
    "plasticity_index": (0.4, 10.0), "asperity_beta": (0.022, 0.15), "intermolecular_distance": (0.1e-9, 0.8e-9),
}  # fmt: skip
PRESETS = {
    "table 1": KogutEtsion(),
    "unrounded": KogutEtsion(coefficients="unrounded"),
    "paper": KogutEtsion.paper(),
}
MANY = 3


def random_contacts(count):
    """Contacts whose parameters vary by factors of ten and more, as far as they have a stable branch."""
    draw, found = np.random.default_rng(20), []
    while len(found) < count:
        values = {name: float(np.exp(draw.uniform(*np.log(ends)))) for name, ends in RANGES.items()}
        values["poisson_ratio"] = float(draw.uniform(0, 0.49))
        values["coefficients"] = str(draw.choice(["printed", "unrounded"]))
        try:
            _ = KogutEtsion(**values).branch
        except ValueError:
            continue
        found.append(KogutEtsion(**values))
    return found


def random_loads(contact, count, seed):
    """Net loads, half uniform up to a few pull-offs, half log-uniform from 1e-9 of them above -pull_off to the end."""
    draw = np.random.default_rng(seed)
    room = 1 + contact.largest_load / contact.pull_off
    above = np.concatenate(
        [
            draw.uniform(0, min(room, 4.0), count // 2),
            np.exp(draw.uniform(math.log(NEAREST), math.log(room), count - count // 2)),
        ]
    )
    return contact.pull_off * (above - 1)


def error(contact, load):
    near = float(contact.separation(load))
    return abs(float(contact.friction_limit(load) / exact.friction_limit(contact, load, near) - 1))


CONTACTS = random_contacts(MANY)


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n != "paper")) for n in PRESETS])
def test_the_friction_limit_is_exact_to_1e_8(name):
    contact = PRESETS[name]
    worst = max(error(contact, load) for load in random_loads(contact, 8, seed=1))
    assert worst < 1e-8 and worst < contact.table_error


@pytest.mark.slow
@pytest.mark.parametrize("number", range(MANY))
def test_the_friction_limit_is_exact_to_1e_8_for_any_parameters(number):
    contact = CONTACTS[number]
    worst = max(error(contact, load) for load in random_loads(contact, 4, seed=number))
    assert worst < contact.table_error < 3e-9


@pytest.mark.parametrize("contact", [*PRESETS.values(), CONTACTS[0]], ids=[*PRESETS, "random"])
def test_pull_off_is_located_to_rounding(contact):
    off = mp.mpf(contact.branch[1])
    h = mp.mpf("1e-6")
    low, middle, high = (exact.net_load(contact, off + k * h) for k in (-1, 0, 1))
    assert abs((high - low) / (high - 2 * middle + low) * h / 2) < 1e-11  # to the vertex
    adhesion = float(exact.forces(contact, off)[1])
    assert abs(float(middle + contact.pull_off)) < ROUNDING * adhesion


@pytest.mark.parametrize(
    "above, contact",
    [
        (1e-9, PRESETS["paper"]),
        (1e-15, PRESETS["table 1"]),
        *(pytest.param(above, CONTACTS[2], marks=pytest.mark.slow) for above in (1e-9, 1e-12, 1e-15)),
    ],
)
def test_next_to_pull_off_only_the_loads_rounding_counts(contact, above):
    """A relative error e of pull-off changes Q by A e / (2 sqrt(above)), A = d ln Q / d sqrt(above)."""
    load = contact.pull_off * (above - 1)
    off = mp.mpf(contact.branch[1])
    least, step = exact.net_load(contact, off), mp.mpf("1e-5")
    curvature = (exact.net_load(contact, off - step) - least) / contact.pull_off / step**2
    truly_above = (mp.mpf(load) - least) / contact.pull_off
    limit = exact.friction_limit(contact, load, off - mp.sqrt(truly_above / curvature))
    rise = float(
        mp.log(exact.forces(contact, off - step)[2] / exact.forces(contact, off)[2]) / step / mp.sqrt(curvature)
    )
    rounding = ROUNDING * float(exact.forces(contact, off)[1]) / contact.pull_off
    bound = contact.table_error + rise * rounding / (2 * math.sqrt(float(truly_above)))
    assert abs(float(contact.friction_limit(load) / limit - 1)) < bound
