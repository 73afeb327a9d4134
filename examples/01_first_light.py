"""First light: load the built-in FZG type A pair, run it, look at the figures, save the report.

Run it with a folder to keep the report: ``python examples/01_first_light.py my-report``.
"""

import sys
from pathlib import Path

import tribodyn as td

case = td.load_case("fzg-roughness")
result = td.run(case)
summary = result.summary()

pair = case.gear_pair
print(f"transverse contact ratio    {pair.transverse_contact_ratio:.6f}")
print(f"mesh frequency              {summary['mesh_frequency']:.3f} Hz")
print(f"mean mesh force             {summary['mean_mesh_force']:.1f} N")
print(f"peak mesh force             {summary['peak_mesh_force']:.1f} N")
print(f"mean friction coefficient   {summary['mean_friction_coefficient']:.4f}")
print(f"rms acceleration across     {summary['rms_acceleration_oloa_pinion']:.1f} m/s^2")

print(f"{len(result.assumptions)} values were assumed or left at their defaults, for example:")
print(result.assumptions[0])

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "fzg-report")
result.save(folder)
print(f"files in {folder.resolve()}:", *sorted(path.name for path in folder.iterdir()))
