"""How much of the load do the asperities carry?

`friction.law = "mixed"` splits load and friction between the film and the asperities of rough
flanks.

Read on: friction, film
"""

import tribodyn as td

case = td.load_case("fzg-roughness").replace({"friction.law": "mixed", "film.model": "moes"})
for roughness in ("0.3 um", "0.6 um", "0.9 um"):
    result = td.run(case.replace({"gears.composite_roughness": roughness}))
    summary = result.summary()
    print(f"{roughness}: film ratio {summary['minimum_film_ratio']:.2f}, "
          f"friction {summary['mean_friction_coefficient']:.4f}")  # fmt: skip
result.plot_lubrication().write_html("mixed_friction.html")
