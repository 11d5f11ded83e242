"""The path of a part on a film of air, for people."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from particle.body import Face, face_states
from particle.events import Request, contact_states, new_record
from particle.film.face import shares
from particle.film.film import Film
from particle.film.march import march_film
from particle.film.memory import HEADING, HEAT, PUMPED, SPIN, STATE, STORED, V_X, V_Y, X, Y, Z, new_memory
from particle.friction import ConstantFriction, Contact
from particle.modes import Verdict
from particle.path import Computed, Rows, computed_of, seen, trajectory_of, with_cells
from particle.surface import Surface, SurfaceMotion
from particle.trajectory import FilmEnergy, Trajectory
from particle.types import FloatArray, IntArray


def find_film_path(
    surface: SurfaceMotion,
    request: Request,
    film: Film,
    friction: Contact,
    stop: IntArray | None = None,
    face: Face | None = None,
) -> Trajectory | None:
    """As `find_path`, of a part on a film of air, the drag of which takes the place of the part's own."""
    request = request._replace(part=request.part._replace(drag=0.0))
    layer = film.layer(friction)
    start = np.zeros(STATE)
    places = [X, Y, V_X, V_Y] if face is None else [X, Y, HEADING, V_X, V_Y, SPIN]
    start[places], start[Z] = request.start[: len(places)], np.nan
    states = np.zeros((0, STATE))

    def path(record: Surface) -> Computed:
        nonlocal states
        memory = new_memory(record, face, np.zeros(1, dtype=np.int64) if stop is None else stop)
        with seen(memory.now, request.until):
            found, states = march_film(record, request, layer, face or (), start, memory, new_record())
        return computed_of(found, memory)

    computed = with_cells(surface, path)
    rows = computed.rows
    if computed.verdict == Verdict.INTERRUPTED:
        return None
    if computed.verdict == Verdict.JUMPS:
        at = float(rows["time"][-1])
        raise ValueError(
            f"Input surface of simulate must move without jumps of velocity under a Film; got one at {at:g} s"
        )
    states = states[: len(rows)]

    def sampler(times: FloatArray) -> Rows:
        """The rows at ascending times [s]: pieces of the path, each from the row before."""
        places = np.searchsorted(rows["time"], times, side="right") - 1
        found, record = rows[places], new_record()
        memory = new_memory(surface.record, face, np.zeros(1, dtype=np.int64))
        for k in np.flatnonzero((times > found["time"]) & (places + 1 < len(rows))):
            row, until = found[k], float(times[k])
            piece = request._replace(mode=int(row["mode"]), begin=float(row["time"]), until=until)
            piece = piece._replace(first_step=until - piece.begin)
            memory.counts[0] = record.lengths[0] = 0
            done, _ = march_film(surface.record, piece, layer, face or (), states[places[k]], memory, record)
            found[k] = done.rows[done.lengths[0]["rows"] - 1]
        return found

    def contact(rows: Rows) -> Rows:
        """Where contact and centre of mass are at rows of the path, and what acts there."""
        if face is not None:
            memory = new_memory(surface.record, face, np.zeros(1, dtype=np.int64))
            on_film = shares(surface.record, request, layer, face, memory, rows)
            return face_states(surface.record, request, face, memory.body, rows, on_film)
        height = surface.half_thickness
        points = surface.samples(np.column_stack([rows["x"], rows["y"]]), np.ascontiguousarray(rows["time"]))
        part = request.part._replace(law=ConstantFriction(0.0).law)
        drags = np.array([film.air.drag(film.area, gap) for gap in rows["gap"].tolist()])
        return contact_states(points, part, height, height + request.centre_height, rows, drags)

    trajectory = trajectory_of(surface, request, computed, sampler, contact, face, film=True)
    energy = FilmEnergy(states[:, STORED], states[:, PUMPED], states[:, HEAT])
    return replace(trajectory, film_energy=energy)
