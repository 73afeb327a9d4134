// Draws every figure of the report; the data are in this file, nothing is fetched.
const options = {
  responsive: true,
  displaylogo: false,
  showSendToCloud: false,
  plotlyServerURL: "",
  modeBarButtons: [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]],
  toImageButtonOptions: { format: "svg" },
};
// On a narrow screen the legends of all panels stand below them, where the menu does not reach.
const narrow = window.innerWidth < 720;
const AXIS = 64, ROW = 22, MARK = 58, CHARACTER = 7.5;
const legends = (layout) => Object.keys(layout).filter((key) => /^legend\d*$/.test(key));
const below = (figure, place) => {
  const { layout, data } = figure;
  const beside = legends(layout).every((key) => (layout[key].x ?? 1.02) > 1);
  const several = data.filter(
    (trace) => trace.showlegend ?? (data.length > 1 && !["surface", "mesh3d"].includes(trace.type)),
  );
  if (!beside || !several.length) return;
  const seen = new Set();
  for (const trace of several) {
    const look = [trace.name, trace.line?.color, trace.line?.dash, trace.marker?.color].join();
    trace.showlegend = !seen.has(look);
    trace.legendgroup = trace.legendgroup ?? look;
    seen.add(look);
    delete trace.legend;
  }
  const title = layout.legend?.title;
  legends(layout).forEach((key) => delete layout[key]);
  const shown = several.filter((trace) => trace.showlegend);
  const widest = MARK + CHARACTER * Math.max(...shown.map((trace) => (trace.name ?? "").length));
  const columns = Math.max(1, Math.floor((place.clientWidth - layout.margin.l) / widest));
  const room = ROW * (Math.ceil(shown.length / columns) + (title ? 1 : 0));
  const panels = layout.height - layout.margin.t - layout.margin.b;
  layout.legend = { orientation: "h", x: 0, xanchor: "left", y: -AXIS / panels, yanchor: "top", title };
  layout.margin.b += room;
  layout.height += room;
  place.style.height = layout.height + "px";
};
// Bodies in space are seen from further away where their width would not fit.
const stepBack = ({ scene, margin }) => {
  const eye = scene?.camera?.eye;
  if (!eye) return;
  for (const axis of "xyz") eye[axis] *= 1.6;
  margin.l = margin.r;
};
for (const [name, figure] of Object.entries(figures)) {
  const place = document.getElementById("figure-" + name);
  figure.layout.modebar = { orientation: narrow ? "v" : "h" };
  if (narrow) {
    below(figure, place);
    stepBack(figure.layout);
  }
  Plotly.newPlot(place, figure.data, figure.layout, options);
}
const fit = () => {
  for (const name of Object.keys(figures)) Plotly.Plots.resize("figure-" + name);
};
window.addEventListener("beforeprint", fit);
window.addEventListener("afterprint", fit);
