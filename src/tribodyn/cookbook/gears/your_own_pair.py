"""How do I compute a gear pair of my own?

Write a case file; `tribodyn new my.toml` starts one with every value explained. What you leave
out has a default, which the report lists.

Read on: case-file, figures
"""

from pathlib import Path

import tribodyn as td

Path("my.toml").write_text("""
[gears]
normal_module = "3 mm"
normal_pressure_angle = "20 deg"
driver = "pinion"
pinion = { teeth = 23, face_width = "25 mm", roughness_ra = "0.3 um" }
wheel = { teeth = 45, face_width = "25 mm", roughness_ra = "0.3 um" }
[lubricant]
name = "80W"
[operation]
speed = "1500 rpm"
torque = "80 N*m"
[dynamics]
bearing_stiffness = "500 N/um"
""")
result = td.run("my.toml")
print(result)
result.plot_gear_pair().write_html("your_own_pair.html")
