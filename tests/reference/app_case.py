"""A case of one actuator that is found in milliseconds, with comments to keep, and a device of which a column moves."""

CASE = """# Mine.
[plate]
shape = "disc"  # round
radius = "300 um"
supports = "clamped"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
density = "2330 kg/m^3"

# The only one.
[[actuators]]
position = ["0 um", "0 um"]
stroke = "60 um"
frequency = "900 Hz"

[part]
mass = "2e-9 kg"  # heavy
position = ["80 um", "30 um"]

[friction]
model = "constant"
limit = "40 nN"

[run]
duration = "3 ms"
"""

DEVICE = (
    """
[plate]
shape = "rectangle"
width = "2.4 mm"
height = "2 mm"
supports = "clamped"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "100 um"
density = "2330 kg/m^3"

"""
    + "\n".join(
        f'[[actuators]]\nposition = ["{x} um", "{y} um"]\nstroke = "{stroke} um"\nfrequency = "4 kHz"\ncycles = 190'
        for y in (-500, 0, 500)
        for x, stroke in ((-500, 3), (0, 0), (500, 0))
    )
    + """

[part]
mass = "1 ug"
size = "100 um"
centre_height = "20 um"
position = ["-80 um", "-80 um"]

[friction]
model = "coulomb"
coefficient = 0.2
adhesion = "0.5 uN"

[air]
pressure = "0 Pa"

[run]
duration = "50 ms"
"""
)
