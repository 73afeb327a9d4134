"""Figure sections of a report: a figure, or the reason why it is missing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn import plot
from tribodyn.drawing import Sketch, draws, load_figures
from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.gear import Misalignment, tooth_contact
from tribodyn.plot import FIGURES, Drawing
from tribodyn.plot.theme.style import TOP
from tribodyn.study.machine.pair_cases import inputs_under
from tribodyn.study.mesh_inputs import HypoidTeeth
from tribodyn.study.pipeline.tooth_contact import hypoid_friction_of
from tribodyn.study.studies.needs import PAIRS, kind_of

if TYPE_CHECKING:
    from tribodyn.mesh import MeshTable
    from tribodyn.study import MachineResult, Result

#: Figures of reports by topic; others have a topic of their own.
TOPICS = {
    "Gears": "gear_pair path_of_contact flank_modification hypoid_pair ease_off hypoid_contact "
    "planetary_stage",
    "Stiffness": "mesh_stiffness load_sharing static_transmission_error face_maps hypoid_load "
    "hypoid_misalignment",
    "Friction and film": "friction film lubrication film_pressure film_stiffness coupling "
    "hypoid_pressure hypoid_friction",
    "Motion": "mesh_force friction_force tooth_force transmission_error acceleration spectrum "
    "turning_motion machine_orders machine_forces planetary_forces ring_sensor",
    "Bearings": "bearing_force bearing_spectrum",
    "Natural modes": "mode_shapes campbell machine_modes machine_campbell planetary_modes",
    "Machine": "machine machine_space machine_power",
}
_TOPIC_OF = {name: topic for topic, names in TOPICS.items() for name in names.split()}
_OF_BEARINGS = ("bearing_force", "bearing_spectrum", "mode_shapes", "campbell")
#: Order of the figures in the report of a pair, and of one of hypoid gears.
SECTIONS = (
    *("gear_pair", "path_of_contact", "flank_modification", "mesh_stiffness", "load_sharing"),
    *("static_transmission_error", "friction", "film", "lubrication", "film_pressure"),
    *("film_stiffness", "mesh_force", "friction_force", "transmission_error", "acceleration"),
    *("spectrum", *_OF_BEARINGS),
)
HYPOID_SECTIONS = (
    *("hypoid_pair", "ease_off", "hypoid_contact", "hypoid_load", "hypoid_pressure"),
    *("hypoid_friction", "mesh_force", "tooth_force", "transmission_error", "acceleration"),
    *("spectrum", *_OF_BEARINGS),
)
#: Those of the teeth at rest.
_OF_TEETH = SECTIONS[: SECTIONS.index("mesh_force")]
#: Margin above the panels for marks and buttons [px].
_MARGIN = 44
#: Height of a figure that states none [px].
_HEIGHT = 420


@dataclass(frozen=True)
class Block:
    """One section of the report."""

    name: str
    heading: str
    caption: str = ""  #: what to look for in the figure
    missing: str = ""  #: why there is no figure
    title: str = ""  #: title of the figure
    height: int = 0  #: height of the figure [px]
    json: str = ""  #: data and layout of the figure, safe within a script element
    topic: str = "Figures"  #: of the figures that belong together


def script_json(text: str) -> str:
    r"""Escape JSON for a script element, which ends at the first closing tag."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def block_of_figure(name: str, heading: str, plotted: Any, caption: str) -> Block:
    """Build a section with a figure; the page prints its title as text, which can wrap."""
    sketch = plotted if isinstance(plotted, Sketch) else Sketch(**plotted.to_plotly_json())
    layout, saved = dict(sketch.layout), TOP - _MARGIN
    # A figure of somebody else may have neither title nor size.
    title, height = layout.pop("title", {}).get("text", ""), layout.get("height", _HEIGHT)
    margin = {"t": TOP, **layout.get("margin", {})}
    layout |= {"margin": {**margin, "t": margin["t"] - saved}, "height": height - saved}
    text = script_json(replace(sketch, layout=layout).to_json())
    return Block(name, heading, caption, title=title, height=round(layout["height"]), json=text)


class _Place(NamedTuple):
    """A figure of the report, what it draws, and its name and heading where they differ."""

    figure: Drawing
    subject: Any
    name: str = ""
    heading: str = ""

    def block(self) -> Block:
        """Draw the figure, or give the reason why it is missing."""
        figure, subject = self.figure, self.subject
        try:
            reason = figure.missing(subject)
            sketch = None if reason else figure.sketch(subject)
        except InputError as error:
            # Mesh tables of other programs may have no gears.
            problem = error.problems[0]
            reason, sketch = f"{problem.what}: {problem.why}", None
        name, heading = self.name or figure.name, self.heading or figure.heading
        if sketch is None:
            block = Block(name, heading, missing=reason)
        else:
            block = block_of_figure(name, heading, sketch, figure.caption_of(subject))
        return replace(block, topic=_TOPIC_OF.get(figure.name, "Figures"))


def _within(heading: str) -> str:
    """A heading as the second part of another one."""
    return f"{heading[0].lower()}{heading[1:]}"


def _joined(blocks: Iterable[Block]) -> list[Block]:
    """Merge the sections of figures that are missing for the same reason."""
    joined: list[Block] = []
    place: dict[str, int] = {}
    for block in blocks:
        if block.missing in place:
            first = joined[place[block.missing]]
            heading = f"{first.heading}, {_within(block.heading)}"
            joined[place[block.missing]] = replace(first, heading=heading)
            continue
        if block.missing:
            place[block.missing] = len(joined)
        joined.append(block)
    return joined


def sections_of(case: Any) -> tuple[str, ...]:
    """Names of the figures of a report, in their order."""
    return SECTIONS if case.hypoid_flanks is None else HYPOID_SECTIONS


def figure_blocks(result: Any) -> list[Block]:
    """Draw every figure of the report of any kind of case."""
    # Missing figures of a pair are merged by reason; parts have the figures that they need.
    if kind_of(result.case) in PAIRS:
        return _joined(place.block() for place in (*_of_pair(result), *_of_others(result)))
    places = (*_of_parts(result), *_of_others(result))
    blocks = (place.block() for place in places)
    return [*(block for block in blocks if not block.missing), *_with_faults(result)]


def _of_others(result: object) -> Iterator[_Place]:
    """Figures that other packages and scripts have registered for this kind of result."""
    load_figures()
    for figure in (each for each in FIGURES.all().values() if isinstance(each, Drawing)):
        if not figure.draw.__module__.startswith("tribodyn.") and draws(figure, result):
            yield _Place(figure, result)


def _of_pair(result: Result) -> Iterator[_Place]:
    names = [*sections_of(result.case), *(["coupling"] if result.coupling is not None else [])]
    if result.mesh.face_position is not None:
        names.insert(names.index("load_sharing") + 1, "face_maps")
    if result.case.faults is not None:
        names.insert(names.index("spectrum") + 1, "turning_motion")
    for name in names:
        if isinstance(figure := FIGURES[name], Drawing):
            yield _Place(figure, result)


def _of_parts(result: MachineResult) -> Iterator[_Place]:
    """Figures of the whole, of each stage, of each mesh, and of the motion of all parts."""
    if result.case.lone_stage is None:  # a lone stage has its front view
        yield _Place(plot.machine, result)
    yield _Place(plot.machine_space, result)
    yield _Place(plot.machine_power, result)
    yield from _of_stages(result)
    yield from _of_meshes(result)
    for figure in (plot.machine_orders, plot.machine_forces):
        yield _Place(figure, result)
    for figure in (plot.machine_modes, plot.machine_campbell):
        yield _Place(figure, result)


def _with_faults(result: MachineResult) -> Iterator[Block]:
    """Figures of the motion with faults, which the others leave out, or why there is none."""
    if not result.case.faults:
        return
    try:
        motion = result.turning_motion.motion
    except (InputError, ComputationError) as error:
        yield Block("with-faults", "With faults", missing=str(error), topic="Motion")
        return
    if motion is not result.operation.motion:  # defects of bearings act in recordings
        for figure in (plot.machine_orders, plot.machine_forces):
            heading = f"With faults: {_within(figure.heading)}"
            yield _Place(figure, motion, f"{figure.name}-with-faults", heading).block()


def _of_stages(result: MachineResult) -> Iterator[_Place]:
    """Figures of each planetary stage."""
    for number, name in enumerate(result.machine.planets):
        stage, end = result.operation.stage(name), f"-{number + 1}" if number else ""
        # As Inalpolat and Kahraman: the sensor feels the planet that passes it.
        sensor = stage.ring_sensor(window=2.0 * np.pi / stage.stage.count)
        for figure, part, place in (
            (plot.planetary_stage, result, "stage"),
            (plot.planetary_forces, stage.motion, "forces"),
            (plot.ring_sensor, sensor, "ring-sensor"),
            (plot.planetary_modes, stage.modes, "mode-shapes"),
        ):
            if not (number and part is result):
                yield _Place(figure, part, f"{place}{end}", f"{name}: {figure.heading}")


def _of_meshes(result: MachineResult) -> Iterator[_Place]:
    """Figures of computed teeth, of planets with equal teeth once, and how shafts move them."""
    load, tables = result.operation, set[int]()
    for number, (mesh, table) in enumerate(load.tables.items(), 1):
        if id(table) in tables:
            continue
        tables.add(id(table))
        for name, subject in _of_teeth(result, mesh, table):
            if isinstance(figure := FIGURES[name], Drawing):
                heading = f"Mesh {mesh}: {_within(figure.heading)}"
                yield _Place(figure, subject, f"{name.replace('_', '-')}-{number}", heading)
    for number, (mesh, errors) in enumerate(load.misalignment.items(), 1):
        if isinstance(errors, Misalignment):
            study, heading = result.mounting_study(mesh), "contact with deflected shafts"
            place = f"mounting-{number}", f"Mesh {mesh}: {heading}"
            yield _Place(plot.hypoid_misalignment, study, *place)


def _of_teeth(result: MachineResult, mesh: str, table: MeshTable) -> Iterator[tuple[str, Any]]:
    """Names of the figures of a mesh of a machine, those of its pair, and what they draw."""
    load = result.operation
    inputs = inputs_under(result.case, mesh, load.load, load.misalignment[mesh])
    if not isinstance(teeth := inputs.teeth, HypoidTeeth):
        yield from ((name, table) for name in (*_OF_TEETH, "face_maps"))
        return
    with collected():  # the run has raised the warnings
        friction = hypoid_friction_of(inputs)
    yield from (("hypoid_pair", teeth.flanks), ("ease_off", teeth.flanks))
    yield "hypoid_contact", tooth_contact(teeth.flanks, teeth.mounting)
    yield from (("hypoid_load", friction.loaded), ("hypoid_pressure", friction.loaded))
    yield from (("hypoid_friction", friction), ("mesh_stiffness", table))
    yield "static_transmission_error", table
