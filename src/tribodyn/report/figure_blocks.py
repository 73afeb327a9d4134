"""Figure sections of a report: a figure, or the reason why it is missing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from tribodyn.drawing import Sketch
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES, Drawing
from tribodyn.plot.theme.style import TOP

#: Figures of the report in order, by topic.
TOPICS = {
    "Gears": ("gear_pair", "path_of_contact", "flank_modification"),
    "Stiffness": ("mesh_stiffness", "load_sharing", "static_transmission_error"),
    "Friction and film": ("friction", "film", "lubrication", "film_pressure", "film_stiffness"),
    "Motion": ("mesh_force", "friction_force", "transmission_error", "acceleration", "spectrum"),
    "Bearings": ("bearing_force", "bearing_spectrum"),
    "Natural modes": ("mode_shapes", "campbell"),
}
#: Order of the figures in the report.
SECTIONS = tuple(name for names in TOPICS.values() for name in names)

#: Order of the figures in the report of a hypoid pair.
HYPOID_SECTIONS = (
    "hypoid_pair",
    "ease_off",
    "hypoid_contact",
    "hypoid_load",
    "hypoid_pressure",
    "hypoid_friction",
    "mesh_force",
    "tooth_force",
    "transmission_error",
    "acceleration",
    "spectrum",
    "bearing_force",
    "bearing_spectrum",
    "mode_shapes",
    "campbell",
)

#: Topics of the figures that are not in TOPICS.
_OTHER_TOPICS = {
    "hypoid_pair": "Gears",
    "ease_off": "Gears",
    "hypoid_contact": "Gears",
    "hypoid_load": "Stiffness",
    "hypoid_pressure": "Friction and film",
    "hypoid_friction": "Friction and film",
    "tooth_force": "Motion",
    "coupling": "Friction and film",
    "face_maps": "Stiffness",
    "turning_motion": "Motion",
}

#: Margin above the panels for marks and buttons [px].
_MARGIN = 44


def topic_of(name: str) -> str:
    """Topic of a figure of the report."""
    matches = (topic for topic, names in TOPICS.items() if name in names)
    return next(matches, _OTHER_TOPICS.get(name, "Figures"))


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


def script_json(text: str) -> str:
    r"""Escape JSON for a script element, which ends at the first closing tag."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def block_of_figure(name: str, heading: str, plotted: Any, caption: str) -> Block:
    """Build a section with a figure; the page prints its title as text, which can wrap."""
    sketch = plotted if isinstance(plotted, Sketch) else Sketch(**plotted.to_plotly_json())
    layout, saved = dict(sketch.layout), TOP - _MARGIN
    title, margin = layout.pop("title")["text"], layout["margin"]
    layout |= {"margin": {**margin, "t": margin["t"] - saved}, "height": layout["height"] - saved}
    text = script_json(replace(sketch, layout=layout).to_json())
    return Block(name, heading, caption, title=title, height=round(layout["height"]), json=text)


def _block(figure: Drawing, result: Any) -> Block:
    try:
        reason = figure.missing(result)
        sketch = None if reason else figure.sketch(result)
    except InputError as error:
        # Mesh tables of other programs may have no gears.
        problem = error.problems[0]
        reason, sketch = f"{problem.what}: {problem.why}", None
    if sketch is None:
        return Block(figure.name, figure.heading, missing=reason)
    return block_of_figure(figure.name, figure.heading, sketch, figure.caption_of(result))


def _joined(blocks: Iterable[Block]) -> list[Block]:
    """Merge the sections of figures that are missing for the same reason."""
    joined: list[Block] = []
    place: dict[str, int] = {}
    for block in blocks:
        if block.missing in place:
            first = joined[place[block.missing]]
            heading = f"{first.heading}, {block.heading[0].lower()}{block.heading[1:]}"
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
    """Draw every figure of the report and merge missing figures by reason."""
    names = [*sections_of(result.case), *(["coupling"] if result.coupling is not None else [])]
    if result.mesh.face_position is not None:
        names.insert(names.index("load_sharing") + 1, "face_maps")
    if result.case.faults is not None:
        names.insert(names.index("spectrum") + 1, "turning_motion")
    figures = (FIGURES[name] for name in names)
    return _joined(_block(figure, result) for figure in figures if isinstance(figure, Drawing))
