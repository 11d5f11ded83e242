"""Synonyms: what people also call the keys, choices, tables and commands of this program.

Each row has the words of other programs, books and languages that stand for one thing here. A row counts only where
what it stands for may be written, so one word may stand in several: `period` is a pitch in a lattice and one over a
frequency in a drive. The first row that suits the value counts; where none does, the first row.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from typing import Final, Literal, NamedTuple

Conversion = Literal[
    "same", "half", "inverse", "angular", "degrees", "amplitude", "peak", "quality", "stress", "side", "square", "step",
    "duration", "repeats", "place", "speed", "range", "name",
]  # fmt: skip
"""How the value follows from that under the other name; "name": it cannot be known, the key only is meant."""


class Synonym(NamedTuple):
    """What a word stands for: one key, or several at once."""

    keys: tuple[str, ...]
    conversion: Conversion
    hint: str  # where the value does not follow: a sentence after the key, or in small letters one in place of it


_ROWS: Final[tuple[tuple[str, str, Conversion, str], ...]] = (
    # The plate: the letters of textbooks, and the words of finite-element programs.
    ("e young youngmodulus youngs elasticmodulus emodulus emodul modulus elasticity", "youngs_modulus", "same", ""),
    ("nu \u03bd poisson poissons poissonsratio poissonratio", "poisson_ratio", "same", ""),
    ("t h thick platethickness", "thickness", "same", ""),
    ("rho \u03c1 massdensity", "density", "same", ""),
    ("r", "radius", "same", ""),
    ("d dia diameter", "radius", "half", ""),
    ("innerdiameter holediameter", "inner_radius", "half", ""),
    ("outerdiameter diameter", "outer_radius", "half", ""),
    ("r1 ri rin innerrad holeradius", "inner_radius", "same", ""),
    ("r2 ro rout outerrad", "outer_radius", "same", ""),
    ("a rx semimajor semimajoraxis", "semi_axis_x", "same", ""),
    ("b ry semiminor semiminoraxis", "semi_axis_y", "same", ""),
    ("majoraxis axisx", "semi_axis_x", "half", ""),
    ("minoraxis axisy", "semi_axis_y", "half", ""),
    ("a", "radius", "same", ""),
    ("lx sizex lengthx w", "width", "same", ""),
    ("ly sizey lengthy", "height", "same", ""),
    ("side sidelength edge edgelength a", "width height", "square", ""),
    ("length l", "width", "name", "It is the length along x, height that along y"),
    ("length l", "height", "name", "It is the length along y, width that along x"),
    ("side sidelength edge edgelength", "radius", "side", "It goes from the centre to a corner"),
    ("n nsides numberofsides", "sides", "same", ""),
    ("points vertices", "corners", "same", ""),
    ("angle orientation", "rotation", "same", ""),
    ("type geometry form outline", "shape", "same", ""),
    ("boundary boundaries bc bcs boundarycondition boundaryconditions edge edges clamping mount", "supports", "same",
     ""),
    ("model nonlinear", "theory", "name", 'write theory = "von-karman" for a plate that stretches'),
    ("dynamic dynamics dynamical vibration", "inertia", "same", ""),
    ("zeta \u03b6 dampingratio modaldamping", "damping", "same", ""),
    ("q qfactor qualityfactor", "damping", "quality", "It is 1 over twice the quality factor"),
    ("prestress stress residualstress filmstress", "tension", "stress", "It is a stress times the thickness"),
    ("crystal wafercut wafertype", "wafer", "same", ""),
    ("winkler winklermodulus subgrade elasticfoundation bedding", "foundation", "same", ""),
    ("meshsize elementsize hmax lc maxelementsize", "cell_size", "same", ""),
    ("meshfile file", "mesh", "same", ""),
    # Actuators and other drives.
    ("pos location at xy coordinates coords center centre", "position", "same", ""),
    ("x y posx posy x0 y0", "position", "place", "It is two lengths, x and y"),
    ("freq f drivefrequency fdrive", "frequency", "same", ""),
    ("period t cycletime periodtime", "frequency", "inverse", "It is 1 over the period"),
    ("omega \u03c9 angularfrequency w", "frequency", "angular", "It is the angular frequency over 2 pi"),
    ("height lift rise travel displacement elongation", "stroke", "same", ""),
    ("amplitude amp", "stroke", "amplitude", 'With "up-down" it is the whole way from the bottom to the top'),
    ("peaktopeak pp ptp vpp", "stroke", "peak", 'With "sine" it is half of that'),
    ("amplitude amp load push thrust", "force", "same", ""),
    ("phi \u03c6 phaseshift phaseoffset", "phase", "same", ""),
    ("phasedeg phasedegrees", "phase", "degrees", ""),
    ("waveform wave signal profile function type motion kind", "cycle", "same", ""),
    ("ncycles numcycles numberofcycles nperiods periods count", "cycles", "same", ""),
    ("duration time ton", "cycles", "duration", "It is how many there are"),
    ("repeat repetitions loops passes", "cycles", "repeats", ""),
    ("wait pause rest hold", "dwell", "same", ""),
    ("start starttime t0 onset lag timedelay", "delay", "same", ""),
    ("spring springconstant k springstiffness", "stiffness", "same", ""),
    ("repeat repetitions loops passes", "repeats", "same", ""),
    ("schedule steps", "segments", "same", ""),
    # Lattices.
    ("nx ncols cols numcolumns ncolumns", "columns", "same", ""),
    ("ny nrows numrows", "rows", "same", ""),
    ("spacing distance period gap", "pitch", "same", ""),
    ("center origin", "centre", "same", ""),
    ("condition mask filter", "where", "same", ""),
    ("type layout pattern arrangement", "kind", "same", ""),
    # The part.
    ("m weight", "mass", "same", ""),
    ("density volume", "mass", "name", "It is density times volume"),
    ("side edge width length footprint", "size", "same", ""),
    ("v v0 speed initialvelocity", "velocity", "same", ""),
    ("vx vy", "velocity", "speed", "It is two velocities, x and y"),
    ("initialposition start startposition", "position", "same", ""),
    ("height", "centre_height", "name", "It is how high the centre of mass stands, in a block half of its height"),
    ("centerheight zc cog centreofmass", "centre_height", "same", ""),
    ("preload normalforce pressforce", "squeeze", "same", ""),
    # Friction: the letters of textbooks.
    ("mu \u03bc \u00b5 cof frictioncoefficient coefficientoffriction muk mud kineticcoefficient dynamiccoefficient",
     "coefficient", "same", ""),
    ("friction slidingcoefficient kineticfriction dynamicfriction mukinetic mudynamic", "coefficient", "same", ""),
    ("mus mustatic staticfriction staticfrictioncoefficient", "static_coefficient", "same", ""),
    ("force frictionforce maxforce fmax f max limitforce frictionlimit maximum", "limit", "same", ""),
    ("adhesionforce adhesiveforce pulloff pulloffforce stiction", "adhesion", "same", ""),
    ("workofadhesion surfaceenergy gamma \u03b3 dupre", "adhesion_energy", "same", ""),
    ("sigma \u03c3 rms rmsroughness rq", "roughness", "same", ""),
    ("psi \u03c8", "plasticity_index", "same", ""),
    ("area nominalarea an", "contact_area", "same", ""),
    ("type law name", "model", "same", ""),
    # The run.
    ("time tend tmax tfinal end endtime finaltime totaltime stoptime runtime simulationtime t length", "duration",
     "same", ""),
    ("dt deltat step timestepsize stepsize h", "time_step", "step",
     'leave it out: the default scheme, "events", chooses its steps by the tolerance'),
    ("steps nsteps numsteps timesteps samples nframes outputs snapshots", "frames", "same", ""),
    ("g", "gravity", "same", ""),
    ("tol rtol relativetolerance accuracy precision", "tolerance", "same", ""),
    ("method solver integrator", "scheme", "same", ""),
    # Studies.
    ("parameter param path key variable", "field", "same", ""),
    ("min max from to start stop low high lower upper first last begin end", "range", "range",
     "It is the first and the last value"),
    ("number num n steps samples npoints", "count", "same", ""),
    ("scale", "spacing", "same", ""),
    ("base basecase file input model", "case", "same", ""),
    ("method design", "sampling", "same", ""),
    ("n samples count number", "points", "same", ""),
    ("replicates repetitions runs", "repeats", "same", ""),
    ("noise perturbation", "jitter", "same", ""),
    ("randomseed rng", "seed", "same", ""),
    # Aims.
    ("goal destination to", "target", "same", ""),
    ("maxpaths evaluations maxevaluations budget iterations", "paths", "same", ""),
    ("robust robustness", "quantile", "same", ""),
    ("frequencies", "frequency", "same", ""),
    ("strokes", "stroke", "same", ""),
    # Columns of measured data.
    ("t", "time", "same", ""),
    ("load", "loads", "same", ""),
    # Tables.
    ("micropart particle object cube body chip slider component", "part", "name", ""),
    ("simulation solver sim settings time integration", "run", "name", ""),
    ("contact tribology interface", "friction", "name", ""),
    ("actuator drive drives driver drivers piston pistons pin pins", "actuators", "name", ""),
    ("array grid", "lattice", "name", ""),
    ("surface membrane diaphragm disc disk platform geometry", "plate", "name", ""),
    ("axis parameter parameters variable variables", "axes", "name", ""),
    ("sweep scan", "study", "name", ""),
    ("goal search optimisation optimization", "aim", "name", ""),
)  # fmt: skip

_CHOICES: Final[tuple[tuple[str, str], ...]] = (
    ("circle circular round disk", "disc"),
    ("square rect rectangular quad quadratic box", "rectangle"),
    ("ring washer annular", "annulus"),
    ("oval elliptic elliptical", "ellipse"),
    ("triangle pentagon hexagon hexagonal heptagon octagon regularpolygon", "polygon"),
    ("table shaker rigid", "platform"),
    ("fixed clamp fix builtin encastre encastred rigid glued held", "clamped"),
    ("pinned hinged hinge simple simply supported simplysupported", "simply-supported"),
    ("none unsupported loose", "free"),
    ("fixed clamped held pinned", "immovable"),
    ("free sliding roller loose", "movable"),
    ("nonlinear large largedeflection geometricallynonlinear karman fvk foepplvonkarman stretching", "von-karman"),
    ("small smalldeflection kirchhoff bending", "linear"),
    ("sin sinus sinusoid sinusoidal harmonic", "sine"),
    ("cos cosinus", "cosine"),
    ("updown", "up-down"),
    ("once step raise", "up"),
    ("wait pause rest dwell", "hold"),
    ("amontons dry", "coulomb"),
    ("ke rough asperities adhesive koguttetsion", "kogut-etsion"),
    ("const fixed", "constant"),
    ("measured tabulated points csv file", "table"),
    ("event eventdriven adaptive", "events"),
    ("rk4 euler verlet fixedstep timestepping", "fixed"),
    ("continue flight", "fly"),
    ("end break halt", "stop"),
    ("zero still", "rest"),
    ("stationary steadystate periodic", "steady"),
    ("hex triangular honeycomb", "hexagonal"),
    ("square rect grid cartesian", "rectangular"),
    ("full factorial all cartesian", "grid"),
    ("zip pairs paired", "list"),
    ("montecarlo uniform", "random"),
    ("log log10 geometric", "logarithmic"),
    ("lin equal", "linear"),
    ("hole", "inner"),
    ("edge border boundary outside", "rim"),
    ("edge border boundary outside rim", "outer"),
    # Commands.
    ("simulate solve start", "run"),
    ("movie film video gif", "animate"),
    ("picture draw image figure", "plot"),
    ("show open html page display", "view"),
    ("optimise optimize steer", "aim"),
    ("validate lint", "check"),
    ("scan study", "sweep"),
    ("convert save", "export"),
    ("template new init", "schema"),
    ("route waypoints", "plan"),
    ("modes frf spectrum", "response"),
    ("repeat again", "rerun"),
    ("selftest", "verify"),
    ("--out --outdir --folder --dir", "--output"),
    ("--workers --jobs --cpus --cores --processes", "--threads"),
    ("--silent", "--quiet"),
)  # fmt: skip

SIDES: Final = {"triangle": 3, "pentagon": 5, "hexagon": 6, "hexagonal": 6, "heptagon": 7, "octagon": 8}
"""How many sides regular polygons have, by their names."""


def plain(word: str) -> str:
    """A word in small letters, without what joins its parts."""
    text = word.strip().lower()
    return text if text.startswith("-") else re.sub(r"[\s_'-]", "", text)


def synonyms(word: str, known: Collection[str]) -> list[Synonym]:
    """What a word may stand for, of the keys that there are."""
    return [synonym for synonym in _by_word().get(plain(word), ()) if all(key in known for key in synonym.keys)]


def choices(word: str, known: Iterable[str]) -> Iterator[str]:
    """Yield those of some known words that another may stand for."""
    there = {*known}
    yield from (choice for words, choice in _CHOICES if choice in there and plain(word) in words.split())


@cache
def _by_word() -> dict[str, list[Synonym]]:
    table: dict[str, list[Synonym]] = {}
    for words, keys, conversion, hint in _ROWS:
        for word in words.split():
            table.setdefault(word, []).append(Synonym(tuple(keys.split()), conversion, hint))
    return table
