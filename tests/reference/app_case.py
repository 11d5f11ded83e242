"""A case of one actuator that is found in milliseconds, with comments to keep."""

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
