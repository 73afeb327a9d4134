"""How much do the tooth stiffness models differ?

Each model is a name in the case. `tribodyn explain fe2d` prints what a model contains and its
source.

Read on: stiffness, extending
"""

import tribodyn as td

case = td.load_case("fzg-roughness")
models = ("analytic", "potential-energy", "iso6336")
results = [td.run(case.replace({"stiffness.model": model})) for model in models]
for model, result in zip(models, results, strict=True):
    print(f"{model:18}{1e-6 * result.summary()['mean_mesh_stiffness']:7.1f} N/um")
td.compare_results(*results, names=models).plot().write_html("stiffness_models.html")
