"""Pages as files: a small run and a small sweep that they are made of, and the data in them."""

import base64
import json
import re

import numpy as np
from sweeps import PLATE, altered

NAME = "a<script>alert(1)<b>&"
CASE = "# </script><script>alert(2)</script>\n" + altered(
    PLATE[: PLATE.index("[[actuators]]")] + PLATE[PLATE.rindex("[[actuators]]") :],
    ('cell_size = "80 um"', 'cell_size = "100 um"'),
    ('position = ["75 um", "0 um"]', 'position = ["0 um", "0 um"]'),
    ('stroke = "60 um"', 'stroke = "150 um"'),
    ('position = ["-140 um", "20 um"]', 'position = ["100 um", "100 um"]'),
    ('limit = "40 nN"', 'limit = "41.8 nN"'),
    ('duration = "5 ms"', 'duration = "2 ms"\nframes = 11'),
)
FACED = """\
[plate]
shape = "platform"
motion = { x = { stroke = "2 um", frequency = "500 Hz", cycle = "cosine" } }

[part]
footprint = "polygon"
corners = [
  ["0 um", "0 um"], ["90 um", "0 um"], ["90 um", "30 um"], ["30 um", "30 um"], ["30 um", "60 um"], ["0 um", "60 um"],
]
thickness = "5 um"
density = "2330 kg/m^3"
position = ["40 um", "-70 um"]
heading = "30 deg"
spin = "600 rad/s"

[friction]
model = "coulomb"
coefficient = 0.3

[run]
duration = "3 ms"
"""
STUDY = """\
[study]
case = "base.toml"

[[axes]]
field = "actuators.0.frequency"
name = "frequency"
values = ["250 Hz", "300 Hz", "350 Hz"]

[[axes]]
field = "part.position.0"
name = "x"
values = ["60 um", "100 um", "400 um"]

[map]
threshold = "distance > 1 um"
"""
TURNS = """\
[study]
case = "faced.toml"

[[axes]]
field = "part.heading"
name = "heading"
values = ["30 deg", "-75 deg"]
"""


def data_of(page):
    text = page.read_text(encoding="utf-8")
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL)
    return json.loads(found.group(1))


def numbers(array):
    return np.frombuffer(base64.b64decode(array["bytes"]), "<" + array["kind"])
