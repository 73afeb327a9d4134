"""One pair, three surfaces: effect of flank roughness on friction and vibration.

Rougher flanks mean more friction. Friction acts across the line of action, so that is where the
vibration grows first. The roughest surface is outside the range of the friction law, which
every run reports as a warning.
"""

import warnings

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # printed in the last column instead
case = td.load_case("fzg-roughness")

print("roughness   friction      rms acceleration [m/s^2]   rms bearing force [N]   beyond the law")
print("    [um]    coefficient      along      across           across")
for roughness in ("0.325 um", "0.53 um", "0.991 um"):
    result = td.run(case.replace({"gears.composite_roughness": roughness}))
    figures = result.summary()
    beyond = any("friction-roughness" in str(warning) for warning in result.warnings)
    print(
        f"{roughness.split()[0]:>8}    {figures['mean_friction_coefficient']:.5f}"
        f"      {figures['rms_acceleration_loa_pinion']:10.2f}"
        f"  {figures['rms_acceleration_oloa_pinion']:10.2f}"
        f"       {figures['rms_bearing_force_oloa_pinion']:10.2f}"
        f"              {'yes' if beyond else 'no'}"
    )
