"""Which mesh of a gearbox causes which line of the spectrum?

A machine is gears on shafts and meshes between them. `tribodyn run two-stage-spur` computes one
with bending shafts, rolling bearings and a housing; this one is four gears on rigid shafts.

Read on: machines, dynamics
"""

import tribodyn as td

case = td.Case(
    gears={
        "z1": {"shaft": "in", "teeth": 23, "face_width": "30 mm"},
        "z2": {"shaft": "middle", "teeth": 57, "face_width": "30 mm"},
        "z3": {"shaft": "middle", "position": "70 mm", "teeth": 21, "face_width": "45 mm"},
        "z4": {"shaft": "out", "teeth": 61, "face_width": "45 mm"},
    },
    meshes={
        "first": {"gears": ["z1", "z2"], "normal_module": "3 mm"},
        "second": {"gears": ["z3", "z4"], "normal_module": "4 mm"},
    },
    stiffness={"model": "analytic"},
    operation={"input": "in", "output": "out", "speed": "3000 rpm", "torque": "120 N*m"},
)
result = td.run(case)
print(result)
result.plot("machine_orders").write_html("gearbox.html")
