"""Painter by pyvista: the surface with light and hidden parts, off screen."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from active_surface.arrays import FloatArray, Image, IntArray
from active_surface.views.film.frames import Frame
from active_surface.views.film.look import AMBIENT, DIFFUSE, Look

Colour = tuple[float, float, float]

AROUND = 1.0  # length of the scene: room for the sizes of marks and ball


class VtkPainter:
    """Draws frames with pyvista; only after `offscreen.prepare` has found that it can."""

    def __init__(self, look: Look) -> None:
        self._look = look
        layout = look.layout
        self._plotter = plotter = pv.Plotter(
            off_screen=True, window_size=[layout.width, layout.height], lighting="none"
        )
        plotter.set_background("white")
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        light = pv.Light(position=tuple(look.light), focal_point=(0, 0, 0), light_type="camera light")
        plotter.add_light(light)
        camera = layout.camera
        focus = layout.focus @ np.stack([camera.right, camera.up])
        reach = layout.depth + AROUND
        plotter.camera.position = tuple(focus + 2 * reach * camera.towards)
        plotter.camera.focal_point = tuple(focus)
        plotter.camera.up = tuple(camera.up)
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = layout.height / 2 / layout.scale
        plotter.camera.clipping_range = (reach, 3 * reach)

        self._meshes: dict[str, pv.PolyData] = {}
        cells = look.stage.triangles
        self._surface = pv.PolyData.from_regular_faces(np.zeros((len(look.stage.surface), 3)), cells)
        self._surface["colours"] = np.zeros((len(look.stage.surface), 3), np.uint8)
        self._surface.point_data.active_normals = np.tile([0.0, 0.0, 1.0], (len(look.stage.surface), 1))
        light_of = {"ambient": AMBIENT, "diffuse": DIFFUSE, "specular": 0.0}
        plotter.add_mesh(self._surface, scalars="colours", rgb=True, smooth_shading=True, **light_of)
        self._ball = pv.Sphere(radius=look.part_radius, theta_resolution=40, phi_resolution=40)
        shine = {"ambient": 0.35, "diffuse": 0.75, "specular": 0.6, "specular_power": 30, "smooth_shading": True}
        self._part = plotter.add_mesh(self._ball, **shine)

    def close(self) -> None:
        """Let go of the window."""
        self._plotter.close()

    def paint(self, frame: Frame) -> Image:
        """The picture (height, width, 3) of a frame, without words."""
        look, plotter = self._look, self._plotter
        points = look.surface(frame)
        self._surface.points = points
        self._surface["colours"][:] = np.rint(255 * look.colours(frame)).astype(np.uint8)
        self._surface.point_data["Normals"][:] = look.normals(points)
        self._surface.Modified()
        for name, (line, pieces) in look.lines(frame).items():
            stroke = look.strokes[name]
            self._flat(name, line, np.column_stack([np.full(len(pieces), 2), pieces]), stroke.colour, stroke.width)
        for k, (corners, colour) in enumerate(look.marks(frame)):
            fans = np.arange(3 * len(corners)).reshape(-1, 3)
            self._flat(f"marks {k}", corners.reshape(-1, 3), np.insert(fans, 0, 3, axis=1), colour)
        middle, colour = look.part(frame)
        self._part.position = tuple(middle)
        self._part.prop.color = colour
        plotter.render()
        return np.asarray(plotter.screenshot(None, return_img=True))

    def _flat(self, name: str, points: FloatArray, cells: IntArray, colour: Colour, width: float = 1.0) -> None:
        """Lines or triangles without light; only their points change from one frame to the next."""
        if name in self._meshes:
            self._meshes[name].points = points
            return
        kind = {"lines": cells} if cells.shape[1] == 3 else {"faces": cells}
        self._meshes[name] = mesh = pv.PolyData(points, **kind)
        self._plotter.add_mesh(mesh, color=colour, line_width=width, lighting=False, reset_camera=False)
