"""The case that every extension is used from."""

__all__ = ["CASE", "DYNAMICS", "STIFFNESS"]

CASE = """\
title = "A pair"
[gears]
normal_module = "4.5 mm"
normal_pressure_angle = "20 deg"
center_distance = "91.5 mm"
driver = "pinion"
[gears.pinion]
teeth = 16
profile_shift_coefficient = 0.8635
face_width = "20 mm"
bore_diameter = "30 mm"
[gears.wheel]
teeth = 24
profile_shift_coefficient = -0.5103
[operation]
speed = "900 rpm"
torque = "90 N*m"
[stiffness]
model = "rectangular"
pair_stiffness = "2e8 N/m"
[dynamics]
model = "torsional"
[solver]
steps_per_mesh_cycle = 512
"""
STIFFNESS = 'model = "rectangular"\npair_stiffness = "2e8 N/m"'
DYNAMICS = 'model = "torsional"'
