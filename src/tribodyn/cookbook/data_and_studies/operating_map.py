"""How do I compute a map over speed and torque?

`td.sweep` runs the whole chain at every value; a point that fails states its reason and the
others go on.

Read on: command-line, scale
"""

import tribodyn as td

case = td.load_case("fzg-roughness")
sweep = td.sweep(case, {
    "operation.speed": ("400 rpm", "3500 rpm", 12),
    "operation.torque": ("50 N*m", "300 N*m", 4),
})  # fmt: skip
print(sweep)
sweep.plot("rms_mesh_force").write_html("operating_map.html")
