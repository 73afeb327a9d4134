"""How much does the vibration scatter with the tolerances?

Give a value its spread in the case; `td.ensemble` draws from all of them and every figure has a
band.

Read on: uncertainty
"""

import tribodyn as td

case = td.load_case("time-varying-friction").replace({
    "operation.torque": "80 N*m +- 3 %",
    "dynamics.bearing_stiffness": "3.5e9 N/m +- 10 %",
})  # fmt: skip
variants = td.ensemble(case, size=8, seed=1)
peak = variants.figures()["peak_mesh_force"]
print(f"peak mesh force {peak.min():.0f} to {peak.max():.0f} N")
variants.plot("mesh_force").write_html("tolerances.html")
