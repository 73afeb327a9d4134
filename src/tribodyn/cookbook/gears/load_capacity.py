"""Do my gears last: pitting, bending, scuffing, micropitting?

`[rating]` asks for the load capacity by ISO 6336; `materials.NAME` has the strength that a gear
names. `tribodyn rate FILE` prints the same table.

Read on: rating
"""

import tribodyn as td

stated = ("dynamic_viscosity", "density", "pressure_viscosity_coefficient")
case = td.load_case("helical-pair").replace(
    {f"lubricant.{key}": None for key in stated}
    | {
        "lubricant.name": "ISO VG 220",
        "lubricant.temperature": "70 degC",
        "rating.required_life": "10000 h",
        "rating.application_factor": 1.25,
        "materials.steel.kind": "Eh",
        "materials.steel.hardness": 720.0,
        "gears.pinion.material": "steel",
        "gears.wheel.material": "steel",
    }
)
result = td.run(case)
for verdict in result.rating.verdicts():
    print(f"{verdict.mode:10}{verdict.part:8}{verdict.safety:7.2f} of {verdict.required:g}")
result.plot_mesh_force().write_html("load_capacity.html")
