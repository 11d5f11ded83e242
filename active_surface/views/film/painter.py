"""Painter: draws the surface of a film and what lies on it with pyvista, off screen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import pyvista as pv
from PIL import Image as Pictures
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from active_surface.arrays import FloatArray, Image
from active_surface.views.film.layout import MAX_SIDE, Layout
from active_surface.views.film.scene import Moment, Scene, shapes_of
from particle import PATH_COLOUR, STICK_COLOUR, State

NO_OPENGL = "Films need OpenGL, which is not here: install EGL, on Debian by `apt-get install libegl1 libgl1-mesa-dri`"
FINER = 2  # pixels along each side of one of the picture, which is their mean; in software MSAA takes twice the time
LIFT = 0.004  # of the frame's longer side, towards the camera: lines lie before the surface, not in it
LIGHT, FROM_ABOVE = np.array([-0.35, 0.55, 0.76]), 0.8  # right, up and towards the camera, and so much more from above
AMBIENT, DIFFUSE = 0.42, 0.6  # brightness of the surface without light, and what light adds at most
BALL = {"ambient": 0.35, "diffuse": 0.75, "specular": 0.6, "specular_power": 30}
FACE = 0.75  # opacity of the face of a part
GREY, LOST = "#59636e", "#7a4b94"
COLOURS = {State.STICK: STICK_COLOUR, State.SLIP: PATH_COLOUR, State.FLIGHT: "#303030"}


def colour_of(moment: Moment) -> str:
    """The colour of what the part does."""
    return LOST if moment.lost else COLOURS[moment.state]


class _Part(NamedTuple):
    """What is drawn of a part."""

    scene: Scene
    trail_shapes: FloatArray  # (q, r) m
    trail: pv.PolyData
    pole: pv.PolyData
    ball: pv.PolyData
    face: pv.PolyData  # empty: of a point
    actors: list[pv.Actor]  # of ball and face


class Painter:
    """Draws the moments of a scene; to be closed after the last.

    Raises RuntimeError where there is no OpenGL.
    """

    def __init__(self, layout: Layout) -> None:
        self._layout, self._scene = layout, layout.scene
        self._finer = FINER if FINER * max(layout.width, layout.height) <= MAX_SIDE else 1
        sides = [self._finer * side for side in np.ptp(layout.box, axis=0).tolist()]
        with pv.vtk_verbosity("off"):  # VTK tries a display first, and warns that there is none
            self._plotter = plotter = pv.Plotter(off_screen=True, window_size=sides, lighting="none")
            plotter.render_window.Initialize()
        if not plotter.render_window.initialized:
            raise RuntimeError(NO_OPENGL)
        plotter.set_background("white")
        plotter.disable_anti_aliasing()
        right, up, towards = layout.axes
        light = LIGHT @ layout.axes + [0, 0, FROM_ABOVE]
        self._light = light / np.linalg.norm(light)
        plotter.add_light(pv.Light(position=light, light_type="scene light"))
        focus, depth = layout.focus @ layout.axes[:2], layout.depth + 1
        plotter.camera.position = focus + 2 * depth * towards
        plotter.camera.focal_point = focus
        plotter.camera.up = up
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = sides[1] / self._finer / layout.scale / 2
        plotter.camera.clipping_range = (depth, 3 * depth)
        self._pixels = vtkUnsignedCharArray()
        self._movers: list[tuple[pv.PolyData, FloatArray]] = []  # meshes with their shapes
        self._actors: list[tuple[pv.Actor, FloatArray]] = []  # with where they are without a shift
        self._add_all()

    def _add_all(self) -> None:
        scene, layout = self._scene, self._layout
        line = max(layout.pixel, 0.8)
        dot = 11 * max(layout.pixel, 0.6)
        self._surface = pv.PolyData.from_regular_faces(scene.surface.points, scene.surface.regular_faces)
        self._surface["colours"] = np.zeros((self._surface.n_points, 3), np.uint8)
        self._add(self._surface, shapes_of(scene.surface), 0, scalars="colours", rgb=True, lighting=False)
        lines = [(scene.net, 1.0, GREY, 1.0), (scene.rim, 2.2, "black", 1.5)]
        for mesh, width, colour, lift in [*lines, *[(scene.cut, 1.0, GREY, 1.0)] * scene.window]:
            if mesh.n_points:
                self._add(mesh.copy(), shapes_of(mesh), lift, color=colour, line_width=width * line, lighting=False)
        dots: dict[str, Any] = {"style": "points", "render_points_as_spheres": True, "lighting": False}
        shapes = scene.shapes_at(scene.actuators)
        for size, colour, lift in ((dot, "black", 5.0), (0.68 * dot, "white", 5.0 + dot / layout.scale / LIFT)):
            self._add(
                pv.PolyData(_flat(scene.scaled(scene.actuators))), shapes, lift, color=colour, point_size=size, **dots
            )
        self._ball_radius = 11 * max(layout.pixel, 0.5)
        self._parts = [self._add_part(one, line) for one in (scene, *scene.others)]

    def _add_part(self, scene: Scene, line: float) -> _Part:
        """Add a part with its trail; line: the width of a line [pixels]."""
        trail, look = scene.trail[0], {"color": scene.colour or PATH_COLOUR, "line_width": 3 * line}
        line_of = pv.lines_from_points(_flat(scene.scaled(trail))) if len(trail) else pv.PolyData()
        drawn = self._add(line_of, None, 3.0, lighting=False, **look)
        pole = self._add(pv.Line(), None, 2.0, color="#333333", line_width=1.2 * line, lighting=False)
        points: dict[str, Any] = {"style": "points", "render_points_as_spheres": True, "lighting": True, **BALL}
        ball = self._add(pv.PolyData(np.zeros((1, 3))), None, 5.4, point_size=2 * self._ball_radius, **points)
        actors = [ball_actor := self._actors[-1][0]]
        corners = pv.PolyData()
        if (face := scene.face) is not None:
            count = len(face.outline((0.0, 0.0), 0.0))
            corners = pv.PolyData(np.zeros((count, 3)), faces=[count, *range(count)])
            look = {"show_edges": True, "edge_color": "black", "line_width": 1.5 * line, "lighting": False}
            corners = self._add(corners, None, 4.5, opacity=FACE, **look)
            actors.append(self._actors[-1][0])
            ball_actor.visibility = face.reach * self._layout.scale < self._ball_radius * scene.size
        return _Part(scene, scene.shapes_at(trail), drawn, pole, ball, corners, actors)

    def _add(self, mesh: pv.PolyData, shapes: FloatArray | None, lift: float, **look: Any) -> pv.PolyData:
        """Add a mesh, which its shapes move if it has any; sizes are in pixels of the picture."""
        if mesh.n_points:
            look |= {name: self._finer * look[name] for name in ("line_width", "point_size") if name in look}
            actor = self._plotter.add_mesh(mesh, reset_camera=False, **look)
            self._actors.append((actor, lift * LIFT * self._layout.axes[2]))
            if shapes is not None:
                self._movers.append((mesh, shapes))
        return mesh

    def paint(self, moment: Moment, others: Sequence[Moment] = ()) -> Image:
        """The picture (height, width, 3) of the layout's box at a moment; others: of further parts."""
        per_metre = self._layout.exaggeration / self._scene.size
        for mesh, shapes in self._movers:
            mesh.points[:, 2] = per_metre * (shapes @ moment.amplitudes)
        self._surface["colours"][:] = self._colours(moment.amplitudes)
        for part, its in zip(self._parts, (moment, *others), strict=True):
            self._move(part, its, moment.amplitudes)
        for actor, place in self._actors:
            actor.position = place + np.append(moment.shift, 0.0) / self._scene.size
        window = self._plotter.render_window
        window.Render()
        (wide, tall), pixels = window.GetSize(), self._pixels
        window.GetPixelData(0, 0, wide - 1, tall - 1, 0, pixels, 0)  # a screenshot of pyvista copies them thrice
        image = Pictures.frombuffer("RGB", (wide, tall), pv.convert_array(pixels), "raw", "RGB", 0, -1)
        return np.asarray(image.reduce(self._finer))

    def _move(self, drawn: _Part, moment: Moment, amplitudes: FloatArray) -> None:
        """Put a part and its trail to where they are at a moment."""
        places, (trail, then) = self._layout.places, drawn.scene.trail
        here, below = moment.part[None, :2], np.array([moment.under])
        if len(trail):
            passed = then <= moment.time
            height = np.where(passed, drawn.trail_shapes @ amplitudes, moment.under)
            drawn.trail.points = places(np.where(passed[:, None], trail, here), height)
        drawn.pole.points = places(here.repeat(2, axis=0), moment.under + np.array([0.0, moment.flight]))
        up = self._ball_radius / self._layout.scale
        drawn.ball.points = places(here, np.maximum(below, moment.part[2])) + [0.0, 0.0, up]
        if (face := drawn.scene.face) is not None:
            corners = face.outline(moment.part[:2], moment.heading)
            drawn.face.points = places(corners, drawn.scene.shapes_at(corners) @ amplitudes)
        for actor in drawn.actors:
            actor.prop.color = drawn.scene.colour or colour_of(moment)

    def _colours(self, amplitudes: FloatArray) -> Image:
        """The colours (p, 3) of the surface, lit here: light for each pixel takes software half of the time."""
        scene, scale = self._scene, self._scene.scale
        heights = shapes_of(scene.surface) @ amplitudes
        slopes = self._layout.exaggeration * (scene.slopes @ amplitudes)  # (2, p)
        across, upwards = self._light[:2] @ slopes, self._light[2]
        lit = np.clip((upwards - across) / np.sqrt(1 + (slopes**2).sum(axis=0)), 0, None)
        colours = scale.colours(scale.norm(heights * scale.unit.per_si))[:, :3]
        return np.asarray(np.rint(255 * np.clip(colours * (AMBIENT + DIFFUSE * lit)[:, None], 0, 1)), dtype=np.uint8)

    def close(self) -> None:
        """Let go of the window."""
        self._plotter.close()


def _flat(places: FloatArray) -> FloatArray:
    return np.column_stack([places, np.zeros(len(places))])
