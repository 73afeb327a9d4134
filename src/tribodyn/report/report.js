// Draws every figure of the report; the data stand in this file, nothing is fetched.
const options = {
  responsive: true,
  displaylogo: false,
  showSendToCloud: false,
  plotlyServerURL: "",
  modeBarButtons: [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]],
  toImageButtonOptions: { format: "svg" },
};
// On a narrow screen the menu stands upright, clear of the buttons above the panels.
const orientation = window.innerWidth < 720 ? "v" : "h";
for (const [name, figure] of Object.entries(figures)) {
  figure.layout.modebar = { orientation };
  Plotly.newPlot("figure-" + name, figure.data, figure.layout, options);
}
const fit = () => {
  for (const name of Object.keys(figures)) Plotly.Plots.resize("figure-" + name);
};
window.addEventListener("beforeprint", fit);
window.addEventListener("afterprint", fit);
