"""Painter by matplotlib, for machines where pyvista cannot draw: triangles from the farthest to the nearest."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform

from active_surface.arrays import FloatArray, Image
from active_surface.views.film.frames import Frame
from active_surface.views.film.look import AMBIENT, DIFFUSE, Look

Colour = tuple[float, float, float]
Soup = tuple[
    FloatArray, FloatArray, FloatArray
]  # triangles (k, 3, 2) in pixels, colours with opacity (k, 3, 4), depths (k,)

NEARER = 0.03  # lengths of the scene by which lines and marks pass for nearer, lest triangles beside them cover them
WIDER = 1.0  # pixels by which the renderer draws a triangle wider than it is
CORNERS, RINGS = 32, 6  # of the ball


class AggPainter:
    """Draws frames with matplotlib's renderer of shaded triangles; lines and marks are triangles as well."""

    def __init__(self, look: Look) -> None:
        self._look = look
        self._light = look.light

    def paint(self, frame: Frame) -> Image:
        """The picture (height, width, 3) of a frame, without words."""
        look = self._look
        pieces = [self._surface(frame)]
        for name, (points, ends) in look.lines(frame).items():
            stroke = look.strokes[name]
            pieces.append(self._line(points[ends], stroke.colour, stroke.width))
        pieces += [self._flat(corners, colour) for corners, colour in look.marks(frame)]
        pieces.append(self._ball(frame))
        corners, colours, depth = (np.concatenate(part) for part in zip(*pieces, strict=True))
        order = np.argsort(depth, kind="stable")
        renderer = RendererAgg(look.layout.width, look.layout.height, 100)
        graphics = renderer.new_gc()
        graphics.set_linewidth(0)
        paper = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * [look.layout.width, look.layout.height]
        renderer.draw_path(graphics, Path(paper, closed=False), IdentityTransform(), (1.0, 1.0, 1.0, 1.0))
        renderer.draw_gouraud_triangles(graphics, corners[order], colours[order], IdentityTransform())
        return np.asarray(renderer.buffer_rgba())[..., :3].copy()

    def _surface(self, frame: Frame) -> Soup:
        look, camera = self._look, self._look.layout.camera
        points = look.surface(frame)
        toward = look.normals(points) @ (self._light @ np.stack([camera.right, camera.up, camera.towards]))
        lit = look.colours(frame) * (AMBIENT + DIFFUSE * np.clip(toward, 0, None))[:, None]
        corners = points[look.stage.triangles]
        depth = (corners @ camera.towards).mean(axis=1)
        return look.layout.pixels(corners), _opaque(np.clip(lit, 0, 1)[look.stage.triangles]), depth

    def _line(self, ends: FloatArray, colour: Colour, width: float) -> Soup:
        """Pieces of a line, ends (s, 2, 3), as strips of a width in pixels."""
        ends = ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]
        a, b = np.moveaxis(self._look.layout.pixels(ends), 1, 0)
        along = b - a
        length = np.maximum(np.hypot(*along.T), 1e-9)[:, None]
        opacity = 1 - math.sqrt(1 - min(width / WIDER, 1.0))  # of each half of a strip, which cover the same pixels
        width = max(width - WIDER, 0.05)
        side = width / 2 * np.stack([-along[:, 1], along[:, 0]], axis=1) / length
        over = width / 4 * along / length  # so that pieces of a bend meet
        p, q, r, s = a - over - side, a - over + side, b + over + side, b + over - side
        corners = np.concatenate([np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)])
        depth = (ends @ self._look.layout.camera.towards).mean(axis=1) + NEARER
        return corners, np.broadcast_to(np.array([*colour, opacity]), corners.shape[:2] + (4,)), np.tile(depth, 2)

    def _flat(self, corners: FloatArray, colour: Colour) -> Soup:
        """Triangles (k, 3, 3) of one colour, which face the camera."""
        depth = (corners @ self._look.layout.camera.towards).mean(axis=1) + NEARER
        return self._look.layout.pixels(corners), _opaque(np.broadcast_to(np.array(colour), corners.shape)), depth

    def _ball(self, frame: Frame) -> Soup:
        look, camera = self._look, self._look.layout.camera
        middle, colour = look.part(frame)
        share, turn = np.meshgrid(np.linspace(0, 1, RINGS + 1), np.linspace(0, 2 * np.pi, CORNERS + 1), indexing="ij")
        normal = np.stack([share * np.cos(turn), share * np.sin(turn), np.sqrt(1 - share**2)], axis=-1)
        toward = np.clip(normal @ self._light, 0, None)[..., None]
        lit = np.clip(np.array(colour) * (0.35 + 0.75 * toward) + 0.5 * toward**30, 0, 1)
        places = look.layout.pixels(middle) + look.part_radius * look.layout.scale * normal[..., :2]
        a, b, c, d = (
            (slice(None, -1), slice(None, -1)),
            (slice(1, None), slice(None, -1)),
            np.s_[1:, 1:],
            np.s_[:-1, 1:],
        )
        corners, colours = (
            np.concatenate(
                [
                    np.stack([part[k] for k in three], axis=2).reshape(-1, 3, part.shape[-1])
                    for three in ((a, b, c), (a, c, d))
                ]
            )
            for part in (places, lit)
        )
        depth = middle @ camera.towards + look.part_radius + NEARER
        return corners, _opaque(colours), np.full(len(corners), depth)


def _opaque(colours: FloatArray) -> FloatArray:
    """Colours (k, 3, 3) with an opacity of one."""
    return np.concatenate([colours, np.ones((len(colours), 3, 1))], axis=2)
