"""Look: sizes, colours and light of a film, the same whoever draws it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_rgb
from scipy.sparse import csr_matrix

from active_surface.arrays import FloatArray, IntArray
from active_surface.views.film.captions import colour_of
from active_surface.views.film.frames import Frame
from active_surface.views.film.layout import Layout
from active_surface.views.film.stage import Stage
from active_surface.views.lines import Lines
from coupling.pictures import Scale
from particle import PATH_COLOUR

AMBIENT, DIFFUSE = 0.42, 0.60  # brightness of what has no light, and what light adds at most
LIGHT = np.array([-0.35, 0.55, 0.76])  # right, up and towards the camera, where light comes from,
FROM_ABOVE = 0.8  # and by so much more from above, lest the level plate is dim in any view
CORNERS = 24  # of a disc
LIFT = 0.004  # of the frame's longer side towards the camera: lines lie before the surface, not in it


@dataclass(frozen=True)
class Stroke:
    """How a line on the surface is drawn: width in pixels, and by how many lifts it is before the surface."""

    colour: tuple[float, float, float]
    width: float
    lifts: float


@dataclass(frozen=True, eq=False)
class Look:
    """What both painters draw, in the scene's lengths."""

    stage: Stage
    layout: Layout
    scale: Scale

    @property
    def pixel(self) -> float:
        """What is a pixel in a picture of 720 lines, in pixels of this one."""
        return min(self.layout.width / 1280, self.layout.height / 720)

    @property
    def light(self) -> FloatArray:
        """The unit vector (3,) to the light, counted right, up and towards the camera."""
        camera = self.layout.camera
        total = LIGHT + FROM_ABOVE * np.array([0.0, camera.up[2], camera.towards[2]])
        return np.asarray(total / np.linalg.norm(total))

    @property
    def strokes(self) -> dict[str, Stroke]:
        """How the lines of the stage, and the trail, are drawn."""
        line = max(self.pixel, 0.6)
        return {
            "net": Stroke((0.35, 0.39, 0.43), 0.7 * line, 1.0),
            "cut": Stroke((0.35, 0.39, 0.43), 1.0 * line, 1.0),
            "rim": Stroke((0.0, 0.0, 0.0), 2.2 * line, 1.5),
            "trail": Stroke(to_rgb(PATH_COLOUR), 3.0 * line, 3.0),
            "pole": Stroke((0.2, 0.2, 0.2), 1.2 * line, 2.0),
        }

    @property
    def part_radius(self) -> float:
        """Of the ball that stands for the part."""
        return 11.0 * max(self.pixel, 0.5) / self.layout.scale

    @property
    def dot_radius(self) -> float:
        """Of the marks of actuators."""
        return 5.5 * max(self.pixel, 0.6) / self.layout.scale

    def surface(self, frame: Frame) -> FloatArray:
        """The surface's points (p, 3)."""
        return self.layout.scene(self.stage.surface, frame.heights["surface"], frame.shift)

    def colours(self, frame: Frame) -> FloatArray:
        """The surface's colours (p, 3), without light."""
        scale = self.scale
        return np.asarray(scale.colours(scale.norm(frame.heights["surface"] * scale.unit.per_si)))[:, :3]

    def normals(self, points: FloatArray) -> FloatArray:
        """The unit normals (p, 3) of a surface through points (p, 3), upwards."""
        a, b, c = np.moveaxis(points[self.stage.triangles], 1, 0)
        faces = np.cross(b - a, c - a)
        faces *= np.where(faces[:, 2:] < 0, -1.0, 1.0)
        corners = self.stage.triangles
        ones = np.ones(corners.size)
        columns = np.repeat(np.arange(len(corners)), 3)
        summed = csr_matrix((ones, (corners.ravel(), columns)), (len(points), len(corners))) @ faces
        return summed / np.linalg.norm(summed, axis=1, keepdims=True)

    def lines(self, frame: Frame) -> dict[str, tuple[FloatArray, IntArray]]:
        """Points (k, 3), before the surface, and pieces (s, 2) of each line. Pieces are always the same; those that
        are not there have no length.
        """
        stage, layout = self.stage, self.layout
        kept: dict[str, Lines] = {"net": stage.net, "cut": stage.cut, "rim": stage.rim}
        lines = {
            name: (layout.scene(one.xy, frame.heights[name], frame.shift), one.pieces) for name, one in kept.items()
        }
        along = np.arange(len(frame.trail) - 1)
        lines["trail"] = (
            layout.scene(frame.trail, frame.heights["trail"], frame.shift),
            np.stack([along, along + 1], axis=1),
        )
        ends = np.array([frame.under, frame.under + frame.flight])
        lines["pole"] = (layout.scene(np.tile(frame.part[:2], (2, 1)), ends, frame.shift), np.array([[0, 1]]))
        towards = LIFT * layout.camera.towards
        return {
            name: (points + self.strokes[name].lifts * towards, pieces)
            for name, (points, pieces) in lines.items()
            if len(pieces)
        }

    def marks(self, frame: Frame) -> list[tuple[FloatArray, tuple[float, float, float]]]:
        """The triangles (k, 3, 3) of the actuators' marks with their colours: white discs on black ones."""
        places = self.layout.scene(self.stage.actuators, frame.heights["actuators"], frame.shift)
        if not len(places):
            return []
        towards, radius = LIFT * self.layout.camera.towards, self.dot_radius
        return [
            (self.discs(places + 5.0 * towards, radius), (0.0, 0.0, 0.0)),
            (self.discs(places + 5.4 * towards, 0.68 * radius), (1.0, 1.0, 1.0)),
        ]

    def discs(self, middles: FloatArray, radius: float) -> FloatArray:
        """The triangles (k, 3, 3) of discs around middles (N, 3) that face the camera."""
        angle = np.linspace(0, 2 * np.pi, CORNERS + 1)
        camera = self.layout.camera
        around = radius * (np.outer(np.cos(angle), camera.right) + np.outer(np.sin(angle), camera.up))
        wedges = np.stack([np.zeros((CORNERS, 3)), around[:-1], around[1:]], axis=1)
        return (middles[:, None, None] + wedges).reshape(-1, 3, 3)

    def part(self, frame: Frame) -> tuple[FloatArray, tuple[float, float, float]]:
        """The middle (3,) of the ball that stands for the part, which lies on the surface or flies, and its colour."""
        height = max(float(frame.part[2]), frame.under)
        middle = self.layout.scene(frame.part[None, :2], np.array([height]), frame.shift)[0]
        before = 5.4 * LIFT * self.layout.camera.towards
        return middle + np.array([0.0, 0.0, self.part_radius]) + before, to_rgb(colour_of(self.stage, frame))
