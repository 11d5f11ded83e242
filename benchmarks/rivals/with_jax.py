"""Fixed steps by JAX on one thread of the processor, many parts at once; an extra that need not be installed."""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from rivals.problem import GRAVITY, MASS, RADIUS, PathProblem

os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")

import jax
import jax.numpy as jnp

FloatArray = NDArray[np.float64]

jax.config.update("jax_enable_x64", True)


def new_fixed_steps(problem: PathProblem) -> Callable[[FloatArray, float, int], FloatArray]:
    """What takes starts (n, 2) [m], a step [s] and a count to the places (n, 2) [m]; constant friction only."""
    breakpoints, forces, sources = (
        jnp.asarray(a) for a in (problem.breakpoints, problem.forces, problem.points / RADIUS)
    )
    square, friction = (sources**2).sum(axis=1), float(problem.friction.friction_limit(0.0)) / MASS
    k = jnp.arange(6)

    def forces_at(time: jax.Array) -> jax.Array:
        span = jnp.searchsorted(breakpoints[1:-1], time, side="right")
        since = time - breakpoints[span]
        powers = jnp.power(since, k)
        first = k * jnp.concatenate([jnp.zeros(1), powers[:-1]])
        second = k * (k - 1) * jnp.concatenate([jnp.zeros(2), powers[:-2]])
        return forces[span] @ jnp.stack([powers, first, second], axis=1) / (16 * jnp.pi)

    def step(xy: jax.Array, v: jax.Array, f: jax.Array, h: jax.Array) -> tuple[jax.Array, jax.Array]:
        """One part."""
        xy = xy + 0.5 * h * v
        x = xy / RADIUS
        offset, image = x - sources, x * square[:, None] - sources
        big_r, big_s = (offset**2).sum(axis=1), (x @ x) * square - 2 * sources @ x + 1
        ratio = big_r / big_s
        by_r, by_s = jnp.log(ratio), 1 - ratio
        w_tt = f[:, 2] @ (big_r * by_r + big_s - big_r)
        gradient, gradient_t = 2 / RADIUS * f[:, :2].T @ (by_r[:, None] * offset + by_s[:, None] * image)
        # v.H.v = 4 sum f ((v.d)^2 / R - 2 (v.d)(v.e) / S + (v.e)^2 R / S^2) + 2 v.v sum f level
        along, across = offset @ v, image @ v
        bend = 4 * (along**2 / big_r - (2 * along - across * ratio) * across / big_s)
        bend = f[:, 0] @ (bend + 2 * (v @ v) * (by_r + square * by_s)) / RADIUS**2
        b = GRAVITY + w_tt + 2 * v @ gradient_t + bend
        free = v - h * b / (1 + gradient @ gradient) * gradient
        speed = jnp.sqrt(free @ free + (free @ gradient) ** 2)
        v = jnp.where(speed > h * friction, 1 - h * friction / speed, 0.0) * free
        return xy + 0.5 * h * v, v

    @jax.jit
    def march(starts: jax.Array, h: jax.Array, count: jax.Array) -> jax.Array:
        def body(n: jax.Array, state: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
            return jax.vmap(step, (0, 0, None, None))(*state, forces_at((n + 0.5) * h), h)

        return jax.lax.fori_loop(0, count, body, (starts, jnp.zeros_like(starts)))[0]

    return lambda starts, h, count: np.asarray(march(starts, h, count))
