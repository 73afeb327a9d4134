"""A loaded tooth contact at rest, for one torque or several."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.drawing import drawing
from tribodyn.plot.gear.path import corner_shades, pair_letters, roll_angle_of, roll_label
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.look.panels import Panel, event_lines, stack
from tribodyn.plot.look.style import TOTAL, Trace, line
from tribodyn.plot.mesh.cycle import between
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.stiffness import LoadedContact

#: Colours from the least to the greatest torque; between them they are mixed.
_ANCHORS = ("#0d0887", "#7e03a8", "#cc4778", "#f0893e")
#: Names of torques in a legend; further ones are told by the pointer.
_NAMED = 8
#: Mesh cycles shown beyond both ends of what is loaded.
_MARGIN = 0.04
#: Part of the total force that counts as load.
_BEARS = 1e-6
_QUANTITY = "static_transmission_error"
#: Width of lines over many mesh cycles or for more than a few torques [px].
_THIN, _FEW = 1.2, 8
#: Torques for which stiffness is drawn: its curves lie close to one another.
_STIFFNESSES = 4
#: Part of the greatest force that counts as load, and difference of teeth that is drawn.
_LOADED, _DIFFERENT = 1e-6, 1e-3


def torque_names(torques: ArrayLike) -> list[str]:
    """Torques with their unit and as many digits as tell them apart."""
    unit = display_unit("torque")
    return [f"{torque:.4g} {unit}" for torque in displayed("torque", np.ravel(torques))]


def torque_colors(count: int) -> list[str]:
    """Colours of curves that belong to rising torques."""
    if count == 1:
        return [TOTAL]
    anchors = np.array([[int(each[k : k + 2], 16) for k in (1, 3, 5)] for each in _ANCHORS])
    places = np.linspace(0.0, len(_ANCHORS) - 1.0, count)
    mixed = [np.interp(places, range(len(_ANCHORS)), anchors[:, k]) for k in range(3)]
    return ["#" + "".join(f"{round(part):02x}" for part in each) for each in np.transpose(mixed)]


def named(count: int, most: int = _NAMED) -> list[bool]:
    """Which of many torques are named in a legend: all of few, first, last and some of many."""
    chosen = np.linspace(0, count - 1, min(count, most)).round().astype(int)
    return [number in set(chosen.tolist()) for number in range(count)]


@dataclass(frozen=True)
class Life:
    """Least, mean and greatest value over all tooth pairs, from entry to exit."""

    age: Array  #: mesh cycles since a pair passed A, in order
    least: Array
    mean: Array
    greatest: Array

    @classmethod
    def of(cls, contact: LoadedContact, values: Array) -> Life:
        """Follow the tooth pairs of a loaded contact."""
        many = np.reshape(values, (-1, *np.shape(values)[-2:]))
        fraction = np.round(np.mod(contact.phase, 1.0), 9)
        phases, where = np.unique(fraction, return_inverse=True)
        groups = [many[:, where == group, :] for group in range(phases.size)]
        found = []
        for reduce in (np.min, np.mean, np.max):
            each = np.stack([reduce(group, axis=1) for group in groups], axis=1)
            found.append(np.moveaxis(each, 2, 1).reshape(many.shape[0], -1))
        age = np.asarray((phases[:, None] + contact.number).T.ravel(), dtype=np.float64)
        order = np.argsort(age, kind="stable")
        age, found = age[order], [part[:, order] for part in found]
        if np.min(contact.number) == 0:
            # Without tip corners the load begins at A at once.
            age, found = np.append(0.0, age), [np.pad(part, ((0, 0), (1, 0))) for part in found]
        return cls(age, *found)


def rows(contact: LoadedContact, values: Array) -> list[Array]:
    """Split values by torque, whether there is one torque or several."""
    return list(np.reshape(values, (np.size(contact.torque), -1)))


def several_cycles(contact: LoadedContact) -> bool:
    """Whether the teeth differ, so that several mesh cycles pass before everything repeats."""
    return bool(np.max(contact.phase) >= 1.0)


def span(contact: LoadedContact) -> tuple[float, float]:
    """Ages between which some pair carries load, with a little margin."""
    shares = Life.of(contact, contact.load_share)
    loaded = shares.age[(shares.greatest > _BEARS).any(axis=0)]
    last = max(contact.gear_pair.transverse_contact_ratio, float(loaded.max()))
    return min(0.0, float(loaded.min())) - _MARGIN, last + _MARGIN


def whole_cycles(phase: Array, values: Array, period: int, repeats: int = 1) -> tuple[Array, Array]:
    """Repeat evenly spaced samples of a periodic curve, up to where the last cycle ends."""
    turns = [phase + period * number for number in range(repeats)]
    end = [phase[0] + period * repeats]
    return np.concatenate([*turns, end]), np.append(np.tile(values, repeats), values[0])


def _title(contact: LoadedContact) -> str:
    """Answer: mean and swing of the transmission error."""
    names = torque_names(contact.torque)
    swings = np.ravel(contact.peak_to_peak_transmission_error)
    if len(names) == 1:
        mean, swing = (
            rounded(_QUANTITY, float(value))
            for value in (np.mean(contact.transmission_error), swings[0])
        )
        return f"Under {names[0]} the transmission error is {mean} on average and varies by {swing}"
    low, high = (rounded(_QUANTITY, float(at(swings))) for at in (np.min, np.max))
    return f"From {names[0]} to {names[-1]} the transmission error varies by {low} to {high}"


def _over(contact: LoadedContact, values: Array) -> tuple[Array, Array]:
    """Values of the whole mesh over what the figure has as its horizontal axis."""
    if several_cycles(contact):
        return whole_cycles(contact.phase, values, contact.mesh_cycles)
    age, repeated = between(contact.phase, values, span(contact))
    return displayed("roll_angle", roll_angle_of(contact.gear_pair, age)), repeated


def _curves(contact: LoadedContact, quantity: str, values: Array, **look: Any) -> list[Trace]:
    """One curve for each torque."""
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact.torque)
    known, traces = named(len(names)), []
    for color, name, shown, each in zip(colors, names, known, rows(contact, values), strict=True):
        x, y = _over(contact, displayed(quantity, each))
        trace = line(
            x,
            y,
            look.get("name", name),
            color,
            unit=display_unit(quantity),
            dash=look.get("dash", "solid"),
            width=_THIN if several_cycles(contact) or len(names) > _FEW else 2.0,
        )
        traces.append({**trace, "showlegend": shown and len(names) > 1})
    return traces


def _stiffness(contact: LoadedContact) -> list[Trace]:
    """Secant solid, tangent dashed; the legend tells the dashes, not the torques again."""
    if several_cycles(contact):
        found = _curves(contact, "mesh_stiffness_secant", contact.mesh_stiffness_secant)
        return [{**trace, "showlegend": False} for trace in found]
    traces: list[Trace] = []
    chosen = named(np.size(contact.torque), _STIFFNESSES)
    for kind, dash in (("secant", "solid"), ("tangent", "dash")):
        name = f"mesh_stiffness_{kind}"
        found = _curves(contact, name, getattr(contact, name), name=kind, dash=dash)
        kept = [trace for trace, shown in zip(found, chosen, strict=True) if shown]
        traces += [{**trace, "showlegend": number == 0} for number, trace in enumerate(kept)]
    return traces


def _shares(contact: LoadedContact) -> list[Trace]:
    """Load share: of one tooth pair over its way, or of all pairs over the mesh cycles."""
    if several_cycles(contact):
        return _shares_over_cycles(contact)
    life = Life.of(contact, contact.load_share)
    first, last = span(contact)
    seen = (life.age >= first) & (life.age <= last)
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[seen]))
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact.torque)
    return [
        {**line(x, share[seen], name, color), "showlegend": False}
        for color, name, share in zip(colors, names, life.mean, strict=True)
    ]


def _shares_over_cycles(contact: LoadedContact) -> list[Trace]:
    """Share of the pair that carries most, for each torque."""
    greatest = np.max(contact.load_share, axis=-1)
    period = contact.mesh_cycles
    colors, names = torque_colors(np.size(contact.torque)), torque_names(contact.torque)
    return [
        {
            **line(*whole_cycles(contact.phase, share, period), name, color, width=_THIN),
            "showlegend": False,
        }
        for color, name, share in zip(colors, names, rows(contact, greatest), strict=True)
    ]


@drawing(
    "loaded_contact",
    heading="Loaded tooth contact",
    caption="The transmission error is the way by which the loaded gears approach along the line "
    "of action; what varies in it excites the vibration. The tangent of the stiffness counts for "
    "small vibration about the load, the secant for the whole deflection. A pair that carries "
    "before A or after E does so on a tip corner.",
    of="LoadedContact",
    made_by="Call tribodyn.loaded_contact(case) and its plot method.",
)
def loaded_contact(contact: LoadedContact) -> Any:
    """Draw transmission error, stiffness and load sharing of a loaded tooth contact."""
    hunting, pair = several_cycles(contact), contact.gear_pair
    stiffness = "Secant stiffness" if hunting else "Mesh stiffness"
    share = "Greatest load share" if hunting else "Load share of a pair"
    panels = [
        Panel(
            axis_label(_QUANTITY, "Transmission error"),
            _curves(contact, _QUANTITY, contact.transmission_error),
        ),
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
    driving = contact.gear_pair.driver
    driven = "wheel" if driving == "pinion" else "pinion"
    return (
        "A pair takes over load as it comes in and hands it on before it leaves. Where the "
        f"background is grey a tip corner bears off the line of action: before A that of the "
        f"{driven}, after E that of the {driving}. High forces there press hard and call for "
        "tip relief. Where teeth differ, the band goes from the least to the most loaded pair."
    )


def _band(x: Array, least: Array, greatest: Array, color: str) -> dict[str, Any]:
    """Fill between the least and the most loaded pair."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": np.concatenate((x, x[::-1])),
        "y": np.concatenate((greatest, least[::-1])),
        "fill": "toself",
        "fillcolor": color,
        "opacity": 0.25,
        "line": {"width": 0, "color": color},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def _traces(contact: LoadedContact, life: Life, seen: Mask) -> list[Trace]:
    x = displayed("roll_angle", roll_angle_of(contact.gear_pair, life.age[seen]))
    newton, names = display_unit("normal_force"), torque_names(contact.torque)
    traces = []
    for row, (name, color, shown) in enumerate(
        zip(names, torque_colors(len(names)), named(len(names)), strict=True)
    ):
        least, mean, most = (
            displayed("normal_force", part[row][seen])
            for part in (life.least, life.mean, life.greatest)
        )
        if np.max(most - least) > _DIFFERENT * np.max(most):
            traces.append(_band(x, least, most, color))
        trace = line(x, mean, name, color, unit=newton)
        traces.append({**trace, "showlegend": shown and len(names) > 1})
    return traces


@drawing(
    "loaded_sharing",
    heading="Load sharing",
    caption=_caption,
    of="LoadedContact",
    made_by="Call tribodyn.loaded_contact(case) and its plot method.",
)
def loaded_sharing(contact: LoadedContact) -> Any:
    """Draw the force on one tooth pair from where it begins to carry to where it ends."""
    pair, (first, last) = contact.gear_pair, span(contact)
    life = Life.of(contact, contact.normal_force)
    seen = (life.age >= first) & (life.age <= last)
    peak = life.greatest.max()
    loaded = life.age[(life.greatest > _LOADED * peak).any(axis=0)]
    layout = event_lines(pair_letters(pair))
    for kind, found in corner_shades(pair, float(loaded.min()), float(loaded.max())).items():
        layout[kind] = [*found, *layout[kind]]
    layout["xaxis"] = {
        "range": displayed("roll_angle", roll_angle_of(pair, np.array([first, last]))).tolist()
    }
    return stack(
        f"A tooth pair carries up to {rounded('normal_force', float(peak))}",
        roll_label(pair),
        [
            Panel(
                axis_label("normal_force", "Force on a tooth pair"),
                _traces(contact, life, seen),
                {"rangemode": "tozero"},
                1.6,
            )
        ],
        layout,
    )
