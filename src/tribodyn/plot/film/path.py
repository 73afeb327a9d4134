"""One tooth pair along the path of contact: speeds, friction, and its oil film."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Need, Sketch
from tribodyn.nomenclature import GEARS
from tribodyn.plot.mesh.cycle import (
    driving_roll_angle,
    pair_life,
    roll_angle_positions,
    sharing_under_load,
    table_drawing,
)
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import FROM_ZERO, ZERO, Panel, curve, curves, event_lines, stack
from tribodyn.plot.theme.path import roll_label
from tribodyn.plot.theme.style import Trace, line
from tribodyn.types import Array, Mask

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable

#: Column of the mesh table, name in the legend, colour and dash.
Rows = tuple[tuple[str, str, str, str], ...]
_SPEEDS: Rows = (
    ("sliding_speed", "sliding", WHEEL, "solid"),
    ("entrainment_speed", "entrainment", PINION, "solid"),
)
_RADII: Rows = (
    (f"{GEARS[0]}_curvature_radius", GEARS[0], PINION, "dash"),
    (f"{GEARS[1]}_curvature_radius", GEARS[1], WHEEL, "dash"),
    ("equivalent_radius", "equivalent", TOTAL, "solid"),
)
_FILMS: Rows = (
    ("central_film", "in the centre", PAIR_COLORS[2], "solid"),
    ("minimum_film", "at its thinnest", TOTAL, "solid"),
)
_PRESSURES: Rows = (
    ("film_pressure", "in the oil film", TOTAL, "solid"),
    ("hertz_pressure", "dry contact", PAIR_COLORS[3], "dash"),
)
_OIL: Rows = (("film_stiffness", "oil film", PAIR_COLORS[2], "solid"),)
_TEETH: Rows = (("tooth_stiffness", "teeth", PAIR_COLORS[0], "dash"),)
_BOTH: Rows = (("stiffness", "teeth and film", TOTAL, "solid"),)
#: The quantity of a column that is called differently.
_QUANTITIES = {"stiffness": "pair_stiffness"}
_LOGARITHMIC = {"type": "log", "dtick": 1}
#: Ratio of the thickest to the usual film from which the scale is logarithmic.
_VERY_THICK = 10.0


class Path:
    """Values of one tooth pair over the roll angle of the driving gear."""

    def __init__(self, mesh: MeshTable) -> None:
        self.mesh = mesh
        self.angle = driving_roll_angle(mesh)

    def life(self, column: str) -> Array:
        """Values of one tooth pair from its entry to its exit, in SI."""
        return pair_life(self.mesh, column, in_middle=True)[1]

    @cached_property
    def loaded(self) -> Mask:
        """Mask of the samples where the pair carries load and has film and friction."""
        from tribodyn.mesh.sharing import LEAST_SHARE

        return np.asarray(self.life("load_share") > LEAST_SHARE)

    def under_load(self, column: str) -> Array:
        """The same values with gaps (NaN) where the pair carries no load."""
        return np.where(self.loaded, self.life(column), np.nan)

    def curves(self, rows: Rows, quantity: str = "", *, loaded: bool = True) -> list[Trace]:
        """Curves of columns of the mesh table in their display units or in that of ``quantity``."""
        values = self.under_load if loaded else self.life
        return [
            curve(quantity or _QUANTITIES.get(column, column), self.angle, values(column), name,
                  color, dash=dash)
            for column, name, color, dash in rows
        ]  # fmt: skip

    def figure(self, title: str, panels: list[Panel]) -> Sketch:
        """Stack panels over the roll angle, with the positions A to E."""
        marks = event_lines(roll_angle_positions(self.mesh).items())
        return stack(title, roll_label(self.mesh.gear_pair), panels, marks)

    def level(self, value: float, name: str, unit: str = "") -> Trace:
        """Dotted horizontal line."""
        return line(self.angle, np.full_like(self.angle, value), name, MUTED, unit=unit, dash="dot")


def _reversal(mesh: MeshTable, what: str) -> str:
    """Sentence on where the sliding speed and ``what`` change their sign."""
    if mesh.gears is not None and mesh.gears.pitch_point_age is None:
        return f"The pitch point C lies beyond A or E: {what} has the same sign everywhere."
    return f"At the pitch point C the surfaces roll without sliding: {what} changes its sign there."


def _path_caption(mesh: MeshTable) -> str:
    return (
        "Kinematics of a tooth pair from A to E, the ends of the path of contact of perfect rigid "
        f"flanks. {_reversal(mesh, 'the sliding speed')} {sharing_under_load(mesh)}"
    )


@table_drawing(heading="Along the path of contact", caption=_path_caption)
def path_of_contact(mesh: MeshTable) -> Sketch:
    """Draw speeds, radii and slide-to-roll ratio over the roll angle of the driving gear."""
    path = Path(mesh)
    fastest = np.max(np.abs(path.life("sliding_speed")))
    ratio = line(path.angle, path.life("slide_to_roll_ratio"), "slide-to-roll", TOTAL)
    radii = path.curves(_RADII, "curvature_radius", loaded=False)
    speeds = path.curves(_SPEEDS, "sliding_speed", loaded=False)
    panels = [
        Panel(axis_label("sliding_speed", "Speed"), speeds, ZERO),
        Panel(axis_label("curvature_radius", "Radius of curvature"), radii),
        Panel(axis_label("slide_to_roll_ratio"), [ratio], ZERO, height=0.8),
    ]
    title = f"The flanks slide at up to {rounded('sliding_speed', fastest)}"
    return path.figure(title, panels)


def _friction_caption(mesh: MeshTable) -> str:
    return (
        "The friction coefficient of one tooth pair from its entry to its exit, and the friction "
        f"force under the static load. {_reversal(mesh, 'the force')} Its other "
        f"changes follow the load. {sharing_under_load(mesh)}{gaps_sentence(mesh)}"
    )


def gaps_sentence(mesh: MeshTable) -> str:
    """Explain gaps of the curves; empty if the pair carries load along the entire path."""
    gaps = " Where curves are interrupted, the pair carries no load, friction or film."
    return "" if np.all(Path(mesh).loaded) else gaps


def _frictionless(mesh: MeshTable) -> str:
    if np.any(mesh.friction_coefficient):
        return ""
    return (
        "No friction acts between the flanks: the friction coefficient is zero. Choose a law, for "
        'example friction.law = "xu-2007".'
    )


@table_drawing(heading="Friction", caption=_friction_caption, missing=_frictionless)
def friction(mesh: MeshTable) -> Sketch:
    """Draw friction coefficient and friction force of a tooth pair over the roll angle."""
    path = Path(mesh)
    coefficient, load = path.under_load("friction_coefficient"), path.life("normal_force")
    force = coefficient * load * path.life("sliding_direction")
    mean = rounded("friction_coefficient", mesh.mean_friction_coefficient)
    mean = f"{mean} over the mesh cycle, weighted with the load shares"
    rows = (
        ("friction_coefficient", coefficient, PAIR_COLORS[0], FROM_ZERO, 1.0),
        ("friction_force", force, WHEEL, ZERO, 1.0),
        ("normal_force", load, TOTAL, FROM_ZERO, 0.8),
    )
    panels = [
        curves(name, None, path.angle, [(name.replace("_", " "), values, color)], axis, height)
        for name, values, color, axis, height in rows
    ]
    return path.figure(f"The mean friction coefficient is {mean}", panels)


_has_film = Need(
    "central_film minimum_film",
    'No film model was chosen, so no oil film was computed. Choose film.model = "newton".',
)


def _film_axis(films: list[Array]) -> Trace:
    """Axis from zero, or logarithmic if a lightly loaded pair has a very thick film."""
    thickest = max(float(np.nanmax(film)) for film in films)
    return _LOGARITHMIC if thickest > _VERY_THICK * float(np.nanmedian(films[0])) else FROM_ZERO


def _film_caption(mesh: MeshTable) -> str:
    return (
        "Thickness of the oil film between the flanks, and its ratio to the composite roughness. "
        "Where the ratio approaches 1, the highest asperities touch." + gaps_sentence(mesh)
    )


@table_drawing(heading="Oil film", caption=_film_caption, missing=_has_film)
def film(mesh: MeshTable) -> Sketch:
    """Draw the film thickness of one tooth pair over the roll angle of the driving gear."""
    path = Path(mesh)
    unit = display_unit("film_thickness")
    columns = tuple(row for row in _FILMS if getattr(mesh, row[0]) is not None)
    column, place = columns[-1][:2]
    least = rounded("film_thickness", np.nanmin(path.under_load(column)))
    roughness = float(displayed("film_thickness", mesh.composite_roughness))
    curves = [*path.curves(columns, "film_thickness"), path.level(roughness, "roughness", unit)]
    axis = _film_axis([path.under_load(row[0]) for row in columns])
    panels = [Panel(axis_label("film_thickness"), curves, axis, height=1.3)]
    if mesh.film_ratio is not None:  # ideal flanks have no film ratio
        values = path.under_load("film_ratio")
        ratio = line(path.angle, values, "film ratio", TOTAL)
        curves = [ratio, path.level(1.0, "asperity contact below")]
        axis = _film_axis([values])
        panels.append(Panel(axis_label("film_ratio"), curves, axis, height=0.8))
    return path.figure(f"The oil film {place} is never below {least}", panels)


def _pressure_caption(mesh: MeshTable) -> str:
    return (
        "Maximum pressure in the oil film of a tooth pair from its entry to its exit, and "
        "the pressure of the dry contact under the same load. The film exceeds it where a spike "
        "forms at its outlet, and is below it where a thick film spreads the load. A spike is "
        "narrower than the grid: its height is a lower bound, and uneven by some percent. "
        + sharing_under_load(mesh)
    )


def _no_pressure(mesh: MeshTable) -> str:
    if mesh.film_pressure is not None:
        return ""
    return _has_film(mesh) or (
        f'The film model "{mesh.film_model}" is a formula for the thickness: it has no '
        'pressure. Choose film.model = "newton".'
    )


@table_drawing(heading="Pressure in the oil film", caption=_pressure_caption, missing=_no_pressure)
def film_pressure(mesh: MeshTable) -> Sketch:
    """Draw the greatest film pressure of one tooth pair over the roll angle."""
    path = Path(mesh)
    greatest = rounded("film_pressure", np.nanmax(path.life("film_pressure")))
    panel = Panel(axis_label("film_pressure"), path.curves(_PRESSURES), FROM_ZERO, height=1.3)
    return path.figure(f"The pressure in the oil film reaches {greatest}", [panel])


def _in_series(mesh: MeshTable) -> bool:
    from tribodyn.mesh.sharing import IN_SERIES

    return mesh.film_stiffness_kind in IN_SERIES


def _stiffness_caption(mesh: MeshTable) -> str:
    kind = mesh.film_stiffness_kind
    if not _in_series(mesh):
        return (
            "Stiffness of the oil film of a tooth pair and of its teeth, on a logarithmic scale. "
            + "The film stiffness is the sum printed in the source. " * (kind == "seed")
            + "In this case the film adds no compliance: the mesh has the stiffness of the teeth "
            'alone. Choose film.stiffness = "approach" to put both in series.'
        )
    return (
        f"Stiffness of the oil film of one tooth pair ({kind}) and of its teeth, on a logarithmic "
        "scale. They are springs in series: the softer one dominates. Below, the teeth alone and "
        "the pair with its film."
    )


def _no_stiffness(mesh: MeshTable) -> str:
    if mesh.film_stiffness is not None:
        return ""
    return _has_film(mesh) or (
        f'The film model "{mesh.film_model}" gives no film stiffness. Choose film.model = "newton".'
    )


@table_drawing(
    heading="Stiffness of the oil film", caption=_stiffness_caption, missing=_no_stiffness
)
def film_stiffness(mesh: MeshTable) -> Sketch:
    """Draw the stiffness of film, teeth and pair over the roll angle."""
    path = Path(mesh)
    label = axis_label("film_stiffness", "Stiffness")
    panels = [Panel(label, path.curves((*_OIL, *_TEETH)), _LOGARITHMIC)]
    if _in_series(mesh):
        panels.append(Panel(axis_label("pair_stiffness"), path.curves((*_TEETH, *_BOTH))))
    oil, teeth = path.life("film_stiffness"), path.life("tooth_stiffness")
    # Pairs with relieved flanks carry no load where they enter and leave.
    loaded = (teeth > 0.0) & np.isfinite(oil)
    ratio = oil[loaded] / teeth[loaded]
    least, greatest = (significant(at(ratio)) for at in (np.min, np.max))
    return path.figure(f"The oil film is {least} to {greatest} times as stiff as the teeth", panels)
