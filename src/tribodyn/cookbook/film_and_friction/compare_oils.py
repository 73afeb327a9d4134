"""What does another oil change?

`td.compare_results` lists every figure that differs between results; its `.plot()` overlays their
motions. The least film is drawn here, over the temperature of the oil.

Read on: lubricants, film
"""

import plotly.graph_objects as go

import tribodyn as td

case = td.load_case("fzg-roughness")
temperatures, figure = (40, 60, 80, 100), go.Figure()
for oil in ("ISO VG 100", "ISO VG 220"):
    results = [
        td.run(case.replace({"lubricant.name": oil, "lubricant.temperature": f"{t} degC"}))
        for t in temperatures
    ]
    films = [1e6 * result.summary()["minimum_film_over_path"] for result in results]
    figure.add_scatter(x=temperatures, y=films, name=oil)
print(td.compare_results(results[0], results[-1]))
figure.update_layout(xaxis_title="Oil temperature [degC]", yaxis_title="Least film [um]")
figure.write_html("compare_oils.html")
