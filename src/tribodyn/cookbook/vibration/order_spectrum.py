"""Which mesh harmonics does the housing receive?

The steady motion repeats with the mesh, so the spectrum of the bearing forces has lines at mesh
harmonics only.

Read on: figures, signals
"""

import tribodyn as td

result = td.run(td.load_case("fzg-12dof"))
summary = result.summary()
print(f"mesh frequency {summary['mesh_frequency']:.0f} Hz")
print(f"rms mesh force {summary['rms_mesh_force']:.0f} N")
result.plot_bearing_spectrum().write_html("order_spectrum.html")
