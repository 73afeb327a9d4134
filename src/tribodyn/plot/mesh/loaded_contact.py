"""Static loaded tooth contact, and maps of a mesh with slices over path and face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import Need, Sketch, drawing
from tribodyn.mesh.face_lines import face_map
from tribodyn.plot.mesh.cycle import between, table_drawing
from tribodyn.plot.theme.colors import HEAT, MUTED, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, label_with, rounded
from tribodyn.plot.theme.panels import Panel, curve, event_lines, from_zero, stack
from tribodyn.plot.theme.path import corner_shades, pair_letters, roll_angle_of, roll_label
from tribodyn.plot.theme.style import Trace, axis, figure, heat, line
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.stiffness import LoadedContact
    from tribodyn.study.rating import MeshRating

#: Colours from the smallest to the largest torque, interpolated in between.
_ANCHORS = ("#0d0887", "#7e03a8", "#cc4778", "#f0893e")
#: Most torques in a legend; hovering names the others.
_NAMED = 8
#: Margin of the axis beyond the loaded range [mesh cycles].
_MARGIN = 0.04
#: Least load share that counts as load.
_BEARS = 1e-6
_QUANTITY = "static_transmission_error"
#: Width of lines over many mesh cycles or for more than a few torques [px].
_THIN, _MANY_TORQUES = 1.2, 8
#: Most torques with a stiffness curve: the curves are close together.
_STIFFNESSES = 4
#: Least fraction of the largest force that counts as load, and that gives a band of the pairs.
_LOADED, _DIFFERENT = 1e-6, 1e-3


def torque_names(torques: ArrayLike) -> list[str]:
    """Format torques with their unit."""
    unit = display_unit("torque")
    return [f"{torque:.4g} {unit}" for torque in displayed("torque", np.ravel(torques))]


def torque_colors(count: int) -> list[str]:
    """Colours of curves for ascending torques."""
    if count == 1:
        return [TOTAL]
    anchors = np.array([[int(each[k : k + 2], 16) for k in (1, 3, 5)] for each in _ANCHORS])
    places = np.linspace(0.0, len(_ANCHORS) - 1.0, count)
    mixed = [np.interp(places, range(len(_ANCHORS)), anchors[:, k]) for k in range(3)]
    return ["#" + "".join(f"{round(part):02x}" for part in each) for each in np.transpose(mixed)]


def in_legend(count: int, most: int = _NAMED) -> list[bool]:
    """Flags of the evenly spaced torques that have a legend entry, at most ``most``."""
    chosen = np.linspace(0, count - 1, min(count, most)).round().astype(int)
    return [number in set(chosen.tolist()) for number in range(count)]


@dataclass(frozen=True)
class Life:
    """Minimum, mean and maximum over all tooth pairs from entry to exit."""

    age: Array  #: mesh cycles since A, ascending
    least: Array
    mean: Array
    greatest: Array

    @classmethod
    def of(cls, contact: LoadedContact, values: Array) -> Life:
        """Collect the values of a loaded contact by the age of the tooth pairs."""
        by_torque = np.reshape(values, (-1, *np.shape(values)[-2:]))
        fraction = np.round(np.mod(contact.phase, 1.0), 9)
        phases, where = np.unique(fraction, return_inverse=True)
        groups = [by_torque[:, where == group, :] for group in range(phases.size)]
        statistics = []
        for reduce in (np.min, np.mean, np.max):
            reduced = np.stack([reduce(group, axis=1) for group in groups], axis=1)
            statistics.append(np.moveaxis(reduced, 2, 1).reshape(by_torque.shape[0], -1))
        half_overlap = 0.5 * contact.gear_pair.overlap_ratio
        age = np.asarray(phases[:, None] + contact.number, float).T.ravel() - half_overlap
        order = np.argsort(age, kind="stable")
        age, statistics = age[order], [part[:, order] for part in statistics]
        if np.min(contact.number) == 0:  # Without tip corners the load starts at A.
            age = np.append(-half_overlap, age)
            statistics = [np.pad(part, ((0, 0), (1, 0))) for part in statistics]
        return cls(age, *statistics)


def rows(contact: LoadedContact, values: Array) -> list[Array]:
    """Split values by torque, for one or several torques."""
    return list(np.reshape(values, (np.size(contact.torque), -1)))


def several_cycles(contact: LoadedContact) -> bool:
    """Whether the teeth differ, so that the period is several mesh cycles."""
    return bool(np.max(contact.phase) >= 1.0)


def span(contact: LoadedContact) -> tuple[float, float]:
    """Range of ages at which any pair carries load, with a margin."""
    shares = Life.of(contact, contact.load_share)
    loaded = shares.age[(shares.greatest > _BEARS).any(axis=0)]
    pair = contact.gear_pair
    last = max(pair.transverse_contact_ratio + 0.5 * pair.overlap_ratio, float(loaded.max()))
    return min(0.0, float(loaded.min())) - _MARGIN, last + _MARGIN


def whole_cycles(phase: Array, values: Array, period: int, repeats: int = 1) -> tuple[Array, Array]:
    """Repeat evenly spaced samples of a periodic curve and close the last cycle."""
    turns = [phase + period * number for number in range(repeats)]
    end = [phase[0] + period * repeats]
    return np.concatenate([*turns, end]), np.append(np.tile(values, repeats), values[0])


def _title(contact: LoadedContact) -> str:
    """Title: mean and peak-to-peak value of the transmission error."""
    names = torque_names(contact.torque)
    swings = np.ravel(contact.peak_to_peak_transmission_error)
    if len(names) == 1:
        values = (np.mean(contact.transmission_error), swings[0])
        mean, swing = (rounded(_QUANTITY, value) for value in values)
        return f"Under {names[0]} the transmission error is {mean} on average and varies by {swing}"
    low, high = (rounded(_QUANTITY, at(swings)) for at in (np.min, np.max))
    return f"From {names[0]} to {names[-1]} the transmission error varies by {low} to {high}"


def _over(contact: LoadedContact, values: Array) -> tuple[Array, Array]:
    """Values of the mesh over the horizontal axis: mesh cycles or roll angle."""
    if several_cycles(contact):
        return whole_cycles(contact.phase, values, contact.mesh_cycles)
    age, repeated = between(contact.phase, values, span(contact))
    return displayed("roll_angle", roll_angle_of(contact.gear_pair, age)), repeated


def _curves(contact: LoadedContact, quantity: str, values: Array, **style: Any) -> list[Trace]:
    """One curve per torque."""
    count, name = np.size(contact.torque), style.pop("name", "")
    style["width"] = _THIN if several_cycles(contact) or count > _MANY_TORQUES else 2.0
    return [
        curve(quantity, *_over(contact, each), name or torque, color,
              showlegend=visible and count > 1, **style)
        for (torque, color, visible), each in zip(
            _styles(contact), rows(contact, values), strict=True)
    ]  # fmt: skip


def _styles(contact: LoadedContact) -> list[tuple[str, str, bool]]:
    """Name, colour and whether the legend has it, of each torque."""
    names = torque_names(contact.torque)
    return list(zip(names, torque_colors(len(names)), in_legend(len(names)), strict=True))


def _stiffness(contact: LoadedContact) -> list[Trace]:
    """Secant (solid) and tangent (dashed) stiffness; the legend explains the dashes."""
    if several_cycles(contact):
        curves = _curves(contact, "mesh_stiffness_secant", contact.mesh_stiffness_secant)
        return [{**trace, "showlegend": False} for trace in curves]
    traces: list[Trace] = []
    chosen = in_legend(np.size(contact.torque), _STIFFNESSES)
    for kind, dash in (("secant", "solid"), ("tangent", "dash")):
        name = f"mesh_stiffness_{kind}"
        curves = _curves(contact, name, getattr(contact, name), name=kind, dash=dash)
        visible = [trace for trace, selected in zip(curves, chosen, strict=True) if selected]
        traces += [{**trace, "showlegend": number == 0} for number, trace in enumerate(visible)]
    return traces


def _shares(contact: LoadedContact) -> list[Trace]:
    """Load share of a tooth pair over the roll angle, or the largest share over the cycles."""
    if several_cycles(contact):
        return _shares_over_cycles(contact)
    life = Life.of(contact, contact.load_share)
    first, last = span(contact)
    inside = (life.age >= first) & (life.age <= last)
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[inside]))
    return [
        line(x, share[inside], name, color, showlegend=False)
        for (name, color, _), share in zip(_styles(contact), life.mean, strict=True)
    ]


def _shares_over_cycles(contact: LoadedContact) -> list[Trace]:
    """Largest load share of all pairs, for each torque."""
    shares = rows(contact, np.max(contact.load_share, axis=-1))
    over = [whole_cycles(contact.phase, share, contact.mesh_cycles) for share in shares]
    return [
        line(*each, name, color, width=_THIN, showlegend=False)
        for (name, color, _), each in zip(_styles(contact), over, strict=True)
    ]


def _over_cycles_or_angle(contact: LoadedContact) -> str:
    caption = (
        "The transmission error is the approach of the loaded gears along the line of action; its "
        "variation excites vibration. The secant stiffness is the load over the total deflection"
    )
    if several_cycles(contact):
        return f"{caption}. The teeth differ: the curves repeat after {contact.mesh_cycles} cycles."
    part = contact.gear_pair.overlap_ratio
    corner = "carries with a part of its face" if part else "has tip-corner contact"
    return (
        f"{caption}, the tangent stiffness applies to small vibration about the load. A pair that "
        f"carries load before A or after E {corner}."
    )


@drawing(
    heading="Loaded tooth contact",
    caption=_over_cycles_or_angle,
    of="LoadedContact",
    made_by="Call tribodyn.loaded_contact(case) and its plot method.",
)
def loaded_contact(contact: LoadedContact) -> Sketch:
    """Draw transmission error, stiffness and load sharing of a loaded tooth contact."""
    hunting, pair = several_cycles(contact), contact.gear_pair
    stiffness = "Secant stiffness" if hunting else "Mesh stiffness"
    share = "Greatest load share" if hunting else "Load share of a pair"
    errors = _curves(contact, _QUANTITY, contact.transmission_error)
    panels = [
        Panel(axis_label(_QUANTITY, "Transmission error"), errors),
        Panel(axis_label("mesh_stiffness", stiffness), _stiffness(contact)),
        Panel(share, _shares(contact), {"range": [0.0, 1.05]}, 0.8),
    ]
    if hunting:
        label, layout = axis_label("mesh_phase", "Mesh cycles"), {}
        layout["xaxis"] = {"range": [0.0, contact.mesh_cycles]}
    else:
        ends = roll_angle_of(pair, np.array(span(contact)))
        label, layout = roll_label(pair), event_lines(pair_letters(pair))
        layout["xaxis"] = {"range": displayed("roll_angle", ends).tolist()}
    return stack(_title(contact), label, panels, layout)


def _caption(contact: LoadedContact) -> str:
    pair, life = contact.gear_pair, Life.of(contact, contact.normal_force)
    sentences = ["A pair takes over load as it enters and sheds it before it leaves."]
    if _corners(contact, life)["shapes"] and pair.overlap_ratio:
        sentences.append("In the grey ranges a part of the face carries load.")
    elif _corners(contact, life)["shapes"]:
        sentences.append(
            "In the grey ranges a tip corner carries load off the line of action: before A that "
            f"of the {pair.driven_gear}, after E that of the {pair.driver}. High forces there "
            "cause high pressure and call for tip relief."
        )
    if np.max(life.greatest - life.least) > _DIFFERENT * np.max(life.greatest):
        sentences.append("The teeth differ: the band covers all pairs.")
    return " ".join(sentences)


def _corners(contact: LoadedContact, life: Life) -> dict[str, list[Trace]]:
    """Shades of the ranges in which a tip corner carries load."""
    loaded = life.age[(life.greatest > _LOADED * life.greatest.max()).any(axis=0)]
    return corner_shades(contact.gear_pair, float(loaded.min()), float(loaded.max()))


def _band(x: Array, least: Array, greatest: Array, color: str) -> Trace:
    """Band between the least and the most loaded pair."""
    ends = np.concatenate((x, x[::-1])), np.concatenate((greatest, least[::-1]))
    fill: Trace = {"fill": "toself", "fillcolor": color, "opacity": 0.25, "hoverinfo": "skip"}
    band = line(*ends, "", color, line={"width": 0, "color": color}, showlegend=False, **fill)
    return {key: value for key, value in band.items() if key not in ("name", "hovertemplate")}


def _traces(contact: LoadedContact, life: Life, inside: Mask) -> list[Trace]:
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[inside]))
    styles, traces = _styles(contact), []
    for row, (name, color, visible) in enumerate(styles):
        least, mean, most = (p[row][inside] for p in (life.least, life.mean, life.greatest))
        if np.max(most - least) > _DIFFERENT * np.max(most):
            band = displayed("normal_force", [least, most])
            traces.append(_band(x, band[0], band[1], color))
        in_key = visible and len(styles) > 1
        traces.append(curve("normal_force", x, mean, name, color, showlegend=in_key))
    return traces


@drawing(
    heading="Load sharing",
    caption=_caption,
    of="LoadedContact",
    made_by="Call tribodyn.loaded_contact(case) and its plot method.",
)
def loaded_sharing(contact: LoadedContact) -> Sketch:
    """Draw the force on a tooth pair over the range in which it carries load."""
    pair, (first, last) = contact.gear_pair, span(contact)
    life = Life.of(contact, contact.normal_force)
    inside = (life.age >= first) & (life.age <= last)
    peak = life.greatest.max()
    layout = event_lines(pair_letters(pair))
    for kind, shades in _corners(contact, life).items():
        layout[kind] = [*shades, *layout[kind]]
    ends = displayed("roll_angle", roll_angle_of(pair, np.array([first, last])))
    layout["xaxis"] = {"range": ends.tolist()}
    label = axis_label("normal_force", "Force on a tooth pair")
    panel = from_zero(label, _traces(contact, life, inside), 1.6)
    title = f"A tooth pair carries up to {rounded('normal_force', peak)}"
    return stack(title, roll_label(pair), [panel], layout)


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


def _map_caption(mesh: MeshTable) -> str:
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


@table_drawing(heading="Maps over the face", caption=_map_caption, missing=_without_face)
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
