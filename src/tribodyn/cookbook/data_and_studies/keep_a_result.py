"""How do I keep a result, read it again and get its numbers?

The folder holds the report, the case, a summary and the arrays (netCDF).

Read on: command-line, exchange
"""

import tribodyn as td

td.run("fzg-roughness").save("my-result", force=True)
result = td.load_result("my-result")
print(f"peak mesh force {result.summary()['peak_mesh_force']:.0f} N")
arrays = result.to_xarray()
print(sorted(arrays.data_vars)[:5])
result.plot_transmission_error().write_html("keep_a_result.html")
