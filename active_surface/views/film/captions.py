"""Captions: words and scales of a film, drawn once, and clock, state and time in each frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import FixedLocator, MaxNLocator, StrMethodFormatter
from PIL import Image as Pictures
from PIL import ImageDraw, ImageFont

from active_surface.arrays import FloatArray, Image, IntArray
from active_surface.views.film.layout import BOTTOM, Layout
from active_surface.views.film.pace import Pace
from active_surface.views.film.painter import colour_of
from active_surface.views.film.scene import Moment
from active_surface.views.geometry import outer_edges, round_below
from active_surface.views.result_file import part_of
from common import STEPS, draw_rim, quantity_text, unit_for
from coupling.case import PlatformCase
from coupling.pictures import MARKS
from particle import PATH_COLOUR, SHADES, State, stretches

DPI = 100
MIN_LETTER = 9.0  # pixels
WORDS = {State.STICK: "part stuck", State.SLIP: "part slipping", State.FLIGHT: "part in flight"}
LINE = (0.045, 0.09, 0.8, 0.024)  # of the picture: the time line


class Captions:
    """Words and scales of a film."""

    def __init__(self, layout: Layout, pace: Pace | None) -> None:
        self._figure = Figure(figsize=(layout.width / DPI, layout.height / DPI), dpi=DPI)
        self._canvas = FigureCanvasAgg(self._figure)
        self._letter = max(min(layout.height * 0.021, layout.width * 0.0165), MIN_LETTER) * 72 / DPI  # points
        self._scene, self._layout = layout.scene, layout
        self._time_unit = unit_for(self._scene.run.time, "s")
        if not self._scene.flat:
            self._draw_bar()
        self._draw_lengths()
        if layout.level and not self._scene.flat:
            self._draw_heights()
        self._draw_notes(pace)
        self._draw_keys()
        if self._scene.window:
            self._draw_map()
        self._draw_time_line()
        self._canvas.draw()
        self._still = np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
        pixels = self._letter * DPI / 72
        self._fonts = [
            ImageFont.truetype(findfont(FontProperties(weight=weight)), share * pixels)
            for weight, share in (("bold", 1.9), ("normal", 1.15))
        ]
        last = self._scene.run.time[-1] * self._time_unit.per_si
        self._digits = int(np.clip(np.ceil(np.log10(250 / last)), 0, 6)) if last > 0 else 0

    def picture(self, drawn: Image, moment: Moment) -> Image:
        """The picture (height, width, 3) of a moment whose surface is drawn in the layout's box."""
        layout, image = self._layout, self._still.copy()
        (left, lower), (right, upper) = layout.box
        box = image[layout.height - upper : layout.height - lower, left:right]
        np.minimum(box, drawn, out=box)
        begin, now, last = np.array([*self._scene.run.time[[0, -1]], moment.time])[[0, 2, 1]] * self._time_unit.per_si
        result = Pictures.fromarray(image)
        pen = ImageDraw.Draw(result)
        x, y = 0.03 * layout.width, 0.028 * layout.height
        for text, font, colour in (
            (f"{now:.{self._digits}f} {self._time_unit.name}", self._fonts[0], "black"),
            (self._words(moment), self._fonts[1], colour_of(moment)),
        ):
            pen.text((x, y), text, colour, font, stroke_width=1, stroke_fill="white")
            y += 1.4 * font.size
        share = (now - begin) / (last - begin) if last > begin else 0.5
        x, y, wide, tall = np.array(LINE) * np.array([layout.width, layout.height] * 2)
        width = max(self._letter * DPI / 72 / 6, 1.2)
        place = x + share * wide
        ends = place - width / 2, layout.height - y - tall, place + width / 2, layout.height - y
        pen.rectangle([round(end) for end in ends], fill="black")
        return np.asarray(result)

    def _words(self, moment: Moment) -> str:
        """What the part does, and while it is stuck how hard it is pulled; nothing of many parts."""
        run = self._scene.run
        if self._scene.others:
            return ""
        if moment.lost:
            return f"part {MARKS[run.loss.kind].afterwards}" if run.loss else ""
        if moment.state is State.FLIGHT:
            return f"{WORDS[moment.state]}, {quantity_text(moment.flight, 'm')} above"
        pull = float(np.interp(moment.time, run.margins.time, run.margins.slip))
        pulled = moment.state is State.STICK and np.isfinite(pull)
        return f"{WORDS[moment.state]}, pull {pull:.2f} of the friction limit" if pulled else WORDS[moment.state]

    def _draw_bar(self) -> None:
        """The scale of colours, no longer than the heights that there are."""
        scale = self._scene.scale
        tall = 0.38 if self._scene.window else 0.48
        axes = self._figure.add_axes((0.89, BOTTOM + 0.12, 0.016, tall))
        bar = self._figure.colorbar(ScalarMappable(scale.norm, scale.colours), cax=axes)
        axes.set_ylim(*(height * scale.unit.per_si for height in self._scene.range))
        bar.set_ticks(MaxNLocator(6, steps=STEPS))
        axes.yaxis.set_major_formatter(StrMethodFormatter("{x:.7g}"))
        axes.tick_params(labelsize=self._letter, pad=2, length=3)
        axes.set_title(f"height [{scale.unit.name}]", fontsize=self._letter, pad=self._letter)

    def _draw_lengths(self) -> None:
        """How long a length in the plane is across the picture, and how tall a height."""
        layout = self._layout
        left, bottom = 0.045, BOTTOM + 0.01
        letters: dict[str, Any] = {"fontsize": 0.9 * self._letter}
        per_metre = layout.scale / self._scene.size
        tall = per_metre * float(abs(layout.axes[1, 2])) * layout.exaggeration
        for pixels, up in ((per_metre, False), (tall, True)):
            if pixels < 0.05 * per_metre or (up and self._scene.flat):
                continue
            length = round_below(0.13 * min(layout.width, layout.height) / pixels)
            end = (
                (left, bottom + length * pixels / layout.height)
                if up
                else (left + length * pixels / layout.width, bottom)
            )
            line = Line2D((left, end[0]), (bottom, end[1]), color="black", solid_capstyle="butt")
            line.set_linewidth(max(layout.height / 500, 1.0))
            self._figure.add_artist(line)
            text = quantity_text(length, "m")
            if up:
                self._figure.text(0.03, end[1] + 0.006, text + self._times, va="bottom", **letters)
            else:
                self._figure.text(end[0] + 0.006, bottom, text, va="center", **letters)

    def _draw_heights(self) -> None:
        """An axis of heights at the left of a surface that is seen from the side."""
        layout, unit = self._layout, self._scene.scale.unit
        heights = np.array(self._scene.range)
        middle = self._scene.frame.mean(axis=0, keepdims=True)
        bottom, top = layout.pixels(layout.places(middle.repeat(2, axis=0), heights))[:, 1] / layout.height
        axes = self._figure.add_axes((0.07, bottom, 1e-3, top - bottom), facecolor="none")
        axes.set_ylim(*(heights * unit.per_si))
        axes.set_xticks([])
        axes.spines[["top", "right", "bottom"]].set_visible(False)
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=STEPS))
        axes.tick_params(labelsize=0.9 * self._letter, length=4, pad=2)
        axes.set_title(f"height [{unit.name}]{self._times}", fontsize=0.9 * self._letter, loc="left", pad=self._letter)

    @property
    def _times(self) -> str:
        times = self._layout.exaggeration
        return "" if times == 1 else f" (×{times:.6g})"

    def _draw_notes(self, pace: Pace | None) -> None:
        scene, times = self._scene, self._layout.exaggeration
        larger = "heights true to scale" if times == 1 else f"heights drawn {times:.6g} times larger"
        notes = ["flat" if scene.flat else larger, f"squares of {quantity_text(scene.mesh_width, 'm')}"]
        if pace is not None and len(pace.times) > 1:
            notes.append(pace.words)
        if isinstance(scene.run.case.plate, PlatformCase):
            notes.append("the trail is that on the platform")
        for place, words, share, look in (
            ((0.5, 0.012), "   ·   ".join(notes), 0.97, {"ha": "center", "va": "bottom"}),
            ((0.975, 0.972), scene.name, 0.6, {"ha": "right", "va": "top", "parse_math": False}),
        ):
            text = self._figure.text(*place, words, fontsize=self._letter, color="#404040", **look)
            wide = text.get_window_extent(self._canvas.get_renderer()).width / self._layout.width
            text.set_fontsize(self._letter * min(1.0, share / wide))

    def _draw_keys(self) -> None:
        letter, scene = self._letter, self._scene
        keys: list[Artist] = []
        look: dict[str, Any] = {"color": "none", "marker": "o", "markeredgecolor": "black", "markersize": letter * 0.6}
        if len(self._scene.actuators):
            keys.append(Line2D([], [], markerfacecolor="white", label="actuator", **look))
        if len(scene.trail[0]) and not scene.others:
            keys.append(Line2D([], [], color=PATH_COLOUR, linewidth=letter * 0.2, label="trail"))
        for one in (scene, *scene.others) if scene.others else ():
            keys.append(Patch(color=one.colour, alpha=0.75, linewidth=0, label=part_of(one.run)))
        for state, (colour, name) in SHADES.items():
            if not scene.others and (self._rows[1] == state).any():
                keys.append(Patch(color=colour, alpha=0.25, linewidth=0, label=name))
        if keys:
            place: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (0.985, 0.115), "borderpad": 0}
            look = {"frameon": False, "handlelength": 1.4, "labelspacing": 0.3, "fontsize": letter * 0.9}
            self._figure.legend(handles=keys, **place, **look)

    @property
    def _rows(self) -> tuple[FloatArray, IntArray]:
        """When (r,), in the clock's unit, the part came to its states (r,), as far as the run is stored."""
        run = self._scene.run
        known = run.rows.time <= run.time[-1]
        state = run.rows.state[known]
        return np.append(run.rows.time[known], run.time[-1]) * self._time_unit.per_si, np.append(state, state[-1:])

    def _draw_time_line(self) -> None:
        unit, letter = self._time_unit, self._letter
        begin, end = (self._scene.run.time[[0, -1]] * unit.per_si).tolist()
        axes = self._figure.add_axes(LINE, facecolor="none")
        rows, known = self._rows
        for state, (colour, _) in SHADES.items() if not self._scene.others else ():
            parts = [(rows[first], rows[last] - rows[first]) for first, last in stretches(known == state)]
            axes.broken_barh(parts, (0, 1), color=colour, alpha=0.25, linewidth=0)
        axes.set_yticks([])
        axes.set_ylim(0, 1)
        axes.set_xlim(*((begin, end) if end > begin else (begin - 1, begin + 1)))
        axes.xaxis.set_major_locator(MaxNLocator(10, steps=STEPS) if end > begin else FixedLocator([begin]))
        axes.tick_params(labelsize=0.9 * letter, length=2, pad=2)
        axes.spines[:].set_linewidth(0.6)
        self._figure.text(0.862, 0.0845, unit.name, fontsize=0.9 * letter, va="top")

    def _draw_map(self) -> None:
        """Where on the plate the frame is."""
        run, layout, frame = self._scene.run, self._layout, self._scene.frame
        wide, tall = 0.2 * min(layout.width, layout.height) / np.array([layout.width, layout.height])
        axes = self._figure.add_axes((0.975 - wide, 0.92 - tall, wide, tall))
        draw_rim(axes, run.points[outer_edges(run.triangles)], linewidths=0.8, clip_on=False)
        axes.add_patch(Rectangle(tuple(frame[0]), *np.ptp(frame, axis=0), color=PATH_COLOUR, linewidth=1.5))
        axes.set_aspect("equal", anchor="NE")
        axes.set_axis_off()
        axes.set_xlim(run.points[:, 0].min(), run.points[:, 0].max())
        axes.set_ylim(run.points[:, 1].min(), run.points[:, 1].max())
