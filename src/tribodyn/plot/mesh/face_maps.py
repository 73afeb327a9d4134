"""Maps over path and face: load, pressure, film, friction and heat of a mesh with slices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.mesh.face.maps import face_map
from tribodyn.plot.mesh.cycle import table_drawing
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, label_with, rounded
from tribodyn.plot.theme.panels import event_lines
from tribodyn.plot.theme.path import pair_letters, roll_label
from tribodyn.plot.theme.style import HEAT, MUTED, Trace, figure, heat

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable

#: Columns of the maps, and their quantities where these are called differently.
_COLUMNS = (
    "load_per_width",
    "hertz_pressure",
    "central_film",
    "film_ratio",
    "friction_coefficient",
    "flash_temperature",
)
_QUANTITIES = {"central_film": "film_thickness"}
_NAMES = {
    "load_per_width": "Load per length",
    "hertz_pressure": "Hertzian pressure",
    "central_film": "Central film",
    "film_ratio": "Film ratio",
    "friction_coefficient": "Friction coefficient",
    "flash_temperature": "Flash temperature",
}
#: Part of the film whose values the colours resolve: slices that hardly carry have thick films.
_COLORED = 0.97
#: Height of a map, of the gap between two, and of what surrounds them [px].
_HEIGHT, _GAP, _AROUND = 190, 40, 150


def _without_face(mesh: MeshTable) -> str:
    if mesh.face_position is not None:
        return ""
    return (
        "The contacts of this mesh are whole tooth pairs: there is one line over the path of "
        'contact, no map. Helical pairs have maps, and spur pairs with stiffness.model = "fe3d".'
    )


def _caption(mesh: MeshTable) -> str:
    return (
        "Values that a tooth pair meets while it passes, over the path of contact and the face "
        "width. Lines of contact run at the base helix angle across the map. "
        f"The greatest load of a slice over the mean of all is {mesh.face_load_factor:.4g}, each "
        "over the mesh cycle."
    )


@table_drawing("face_maps", heading="Maps over the face", caption=_caption, missing=_without_face)
def face_maps(mesh: MeshTable) -> Any:
    """Draw load, pressure, film and friction over path and face."""
    columns = [
        name
        for name in _COLUMNS
        if getattr(mesh, name) is not None and np.nanstd(face_map(mesh, name).values) > 0.0
    ]
    total = _HEIGHT * len(columns) + _GAP * (len(columns) - 1)
    traces, layout = [], dict[str, Any]()
    pair = mesh.gear_pair
    for number, column in enumerate(columns):
        chart, suffix = face_map(mesh, column), str(number + 1) if number else ""
        quantity = _QUANTITIES.get(column, column)
        unit, values = display_unit(quantity), displayed(quantity, chart.values)
        radius = chart.path if pair.driver == "pinion" else pair.line_of_action_length - chart.path
        top = 1.0 - number * (_HEIGHT + _GAP) / total
        domain = (max(top - _HEIGHT / total, 0.0), top)
        label = label_with(_NAMES[column].replace(" ", "<br>", 1), unit)
        heading = {"text": axis_label("face_position", "Face")}
        layout[f"yaxis{suffix}"] = {"title": heading, "domain": domain}
        bar = Trace(y=sum(domain) / 2.0, len=domain[1] - domain[0], thickness=14)
        bar["title"] = {"text": label, "side": "right", "font": {"size": 12, "color": MUTED}}
        most = np.nanquantile(values, _COLORED if "film" in column else 1.0)
        x = displayed("roll_angle", radius / pair.driving.base_radius)
        y = displayed("face_position", chart.face_position)
        hover = f"%{{x:.4g}} deg, %{{y:.4g}} mm: %{{z:.4g}} {unit}"
        more = {"yaxis": f"y{suffix}", "zmin": np.nanmin(values), "zmax": most, "colorbar": bar}
        traces.append(heat(x, y, values, HEAT, hover, **more))
    last = str(len(columns)) if len(columns) > 1 else ""
    layout["xaxis"] = {"title": {"text": roll_label(pair)}, "anchor": f"y{last}"}
    greatest = rounded("load_per_width", float(mesh.load_per_width.max()))
    marks = event_lines(pair_letters(pair), share=0.85)
    title = f"The load per length of the lines of contact reaches {greatest}"
    return figure(title, traces, {**layout, **marks, "height": total + _AROUND})
