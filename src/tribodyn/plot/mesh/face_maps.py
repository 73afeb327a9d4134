"""Maps over path and face: load, pressure, film, friction and heat of a mesh with slices."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.drawing import Need, Sketch, drawing
from tribodyn.mesh.face_lines import face_map
from tribodyn.plot.mesh.cycle import table_drawing
from tribodyn.plot.theme.colors import HEAT, MUTED
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, label_with, rounded
from tribodyn.plot.theme.panels import event_lines
from tribodyn.plot.theme.path import pair_letters, roll_label
from tribodyn.plot.theme.style import Trace, axis, figure, heat
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study.rating import MeshRating

#: Quantities of columns that are called differently, and the columns of the maps.
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


class _Map(NamedTuple):
    """A map over path and face in the units of display."""

    name: str
    unit: str
    values: Array
    most: float  #: value of the last colour


@table_drawing(heading="Maps over the face", caption=_caption, missing=_without_face)
def face_maps(mesh: MeshTable) -> Sketch:
    """Draw load, pressure, film and friction over path and face."""
    charts = {
        name: face_map(mesh, name)
        for name in _NAMES
        if getattr(mesh, name) is not None and np.nanstd(face_map(mesh, name).values) > 0.0
    }
    maps = []
    for column, chart in charts.items():
        quantity = _QUANTITIES.get(column, column)
        values = displayed(quantity, chart.values)
        most = np.nanquantile(values, _COLORED if "film" in column else 1.0)
        maps.append(_Map(_NAMES[column], display_unit(quantity), values, most))
    greatest = rounded("load_per_width", mesh.load_per_width.max())
    title = f"The load per length of the lines of contact reaches {greatest}"
    first = next(iter(charts.values()))
    return _stacked(title, maps, mesh.gear_pair, (first.path, first.face_position))


def _stacked(title: str, maps: list[_Map], pair: Any, place: tuple[Array, Array]) -> Sketch:
    """Maps of a mesh one below the other."""
    total = _HEIGHT * len(maps) + _GAP * (len(maps) - 1)
    traces, layout = [], Trace()
    path, face = place
    radius = path if pair.driver == "pinion" else pair.line_of_action_length - path
    x = displayed("roll_angle", radius / pair.driving.base_radius)
    y = displayed("face_position", face)
    for number, chart in enumerate(maps):
        suffix = str(number + 1) if number else ""
        top = 1.0 - number * (_HEIGHT + _GAP) / total
        domain = (max(top - _HEIGHT / total, 0.0), top)
        label = label_with(chart.name.replace(" ", "<br>", 1), chart.unit)
        layout[f"yaxis{suffix}"] = axis(axis_label("face_position", "Face"), domain=domain)
        bar = Trace(y=sum(domain) / 2.0, len=domain[1] - domain[0], thickness=14)
        bar["title"] = {"text": label, "side": "right", "font": {"size": 12, "color": MUTED}}
        hover = f"%{{x:.4g}} deg, %{{y:.4g}} mm: %{{z:.4g}} {chart.unit}"
        more = {"yaxis": f"y{suffix}", "zmin": np.nanmin(chart.values), "zmax": chart.most}
        traces.append(heat(x, y, chart.values, HEAT, hover, colorbar=bar, **more))
    last = str(len(maps)) if len(maps) > 1 else ""
    layout["xaxis"] = axis(roll_label(pair), anchor=f"y{last}")
    marks = event_lines(pair_letters(pair), share=0.85)
    return figure(title, traces, {**layout, **marks, "height": total + _AROUND})


#: Safeties above which all is one colour.
_SAFE = 5.0
#: Maps of a rating: heading, and quantity whose unit they have.
_RATED = {
    "pressure": ("Contact pressure", "hertz_pressure"),
    "pitting_safety": ("Pitting safety", "film_ratio"),
    "contact_temperature": ("Contact temperature", "gear_temperature"),
    "scuffing_safety": ("Scuffing safety", "film_ratio"),
    "specific_film": ("Film over Ra", "film_ratio"),
    "micropitting_safety": ("Micropitting safety", "film_ratio"),
    "specific_film_a": ("Film over Ra, method A", "film_ratio"),
    "micropitting_safety_a": ("Micropitting safety, method A", "film_ratio"),
}


def _least_in_words(rating: MeshRating) -> str:
    modes = {key: key.replace("_safety", "").replace("_", " ") for key in rating.pointwise}
    return ", ".join(f"{mode} {rating.pointwise[key]['safety']:.3g}" for key, mode in modes.items())


@drawing(
    heading="Load capacity over the flank",
    caption=lambda rating: (
        "Pressure, temperature and film of a tooth pair with K_A, K_gamma and the computed K_v, "
        "and what the limits leave, over the path of contact and the face width. Least safeties: "
        f"{_least_in_words(rating)}."
    ),
    missing=Need("maps", "The mesh has no computed teeth, so no map over the flank."),
    of="MeshRating",
    made_by="Run a case with [rating], and take one of result.rating.ratings.",
)
def rating_maps(rating: MeshRating) -> Sketch:
    """Draw pressure, temperature, film and safeties over path and face."""
    data, maps = rating.maps, []
    assert data is not None
    assert rating.rated is not None
    pair, face = rating.rated.case.gear_pair, data["face_position"].values
    rows = 1
    if face.size == 1:  # whole pairs: the same over the face
        rows, face = 2, np.array([-0.5, 0.5]) * pair.common_face_width
    for name, (label, quantity) in _RATED.items():
        if name in data:
            values = np.repeat(displayed(quantity, data[name].values), rows, axis=0)
            greatest = float(np.nanmax(values))
            most = min(_SAFE, greatest) if "safety" in name else greatest
            maps.append(_Map(label, display_unit(quantity), values, most))
    title = f"Least safety on the flank: {_least_in_words(rating)}"
    return _stacked(title, maps, pair, (data["path"].values, face))
