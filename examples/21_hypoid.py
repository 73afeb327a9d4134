"""A hypoid pair: blank, contact, mixed lubrication and motion in space.

The built-in case has 10 teeth against 43 with an offset of 31.7 mm. Its source gives few sizes:
``tribodyn check hypoid-mixed-ehl`` counts what is assumed, the report lists it.

Run it with a folder to keep the report: ``python examples/21_hypoid.py report``.
"""

import sys
import warnings

import tribodyn as td

case = td.load_case("hypoid-mixed-ehl")
with warnings.catch_warnings():
    warnings.simplefilter("ignore", td.ModelWarning)  # the friction law leaves its range a little
    result = td.run(case)
figures = result.summary()

print(f"film ratio, least            {figures['minimum_film_ratio']:.3f}")
print(f"friction coefficient, mean   {figures['mean_friction_coefficient']:.5f}")
for axis in "xyz":
    print(f"mean force of the teeth, {axis}   {figures[f'mean_mesh_force_{axis}']:.1f} N")
error = figures["loaded_transmission_error_peak_to_peak"] * 1e6
print(f"loaded transmission error    {error:.4f} um peak to peak")
print(f"efficiency                   {figures['efficiency']:.5f}")

if len(sys.argv) > 1:
    print(f"report in {result.save(sys.argv[1])}")
