"""The figures of a report: drawn, or replaced by the reason why there is none."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from tribodyn.drawing import Sketch
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES, Drawing
from tribodyn.plot.theme.style import TOP

#: Figures of the report in their order, by what they are about.
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

#: The same of a hypoid pair.
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

#: The figures that spur gears do not have, by the same topics.
_ELSEWHERE = {
    "hypoid_pair": "Gears",
    "ease_off": "Gears",
    "hypoid_contact": "Gears",
    "hypoid_load": "Stiffness",
    "hypoid_pressure": "Friction and film",
    "hypoid_friction": "Friction and film",
    "tooth_force": "Motion",
    "coupling": "Friction and film",
}

#: Room above the panels for marks and buttons [px].
_MARGIN = 44


def topic_of(name: str) -> str:
    """What a figure of the report is about."""
    found = (topic for topic, names in TOPICS.items() if name in names)
    return next(found, _ELSEWHERE.get(name, "Figures"))


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
    r"""Make JSON safe within a script element, which ends at the first closing tag it meets."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def drawn_block(name: str, heading: str, drawn: Any, caption: str) -> Block:
    """A section with a figure, whose title the page prints itself and can break into lines."""
    sketch = drawn if isinstance(drawn, Sketch) else Sketch(**drawn.to_plotly_json())
    layout, saved = dict(sketch.layout), TOP - _MARGIN
    title, margin = layout.pop("title")["text"], layout["margin"]
    layout |= {"margin": {**margin, "t": margin["t"] - saved}, "height": layout["height"] - saved}
    text = script_json(replace(sketch, layout=layout).to_json())
    return Block(name, heading, caption, title=title, height=round(layout["height"]), json=text)


def _block(figure: Drawing, result: Any) -> Block:
    try:
        reason = figure.missing(result)
        drawn = None if reason else figure.sketch(result)
    except InputError as error:
        # A mesh table of another program knows no gears.
        told = error.problems[0]
        reason, drawn = f"{told.what}: {told.why}", None
    if drawn is None:
        return Block(figure.name, figure.heading, missing=reason)
    return drawn_block(figure.name, figure.heading, drawn, figure.caption_of(result))


def _joined(blocks: Iterable[Block]) -> list[Block]:
    """Gather the headings of figures that are missing for the same reason."""
    kept: list[Block] = []
    place: dict[str, int] = {}
    for block in blocks:
        if block.missing in place:
            first = kept[place[block.missing]]
            heading = f"{first.heading}, {block.heading[0].lower()}{block.heading[1:]}"
            kept[place[block.missing]] = replace(first, heading=heading)
            continue
        if block.missing:
            place[block.missing] = len(kept)
        kept.append(block)
    return kept


def sections_of(case: Any) -> tuple[str, ...]:
    """Names of the figures of a report, in their order."""
    return HYPOID_SECTIONS if case.gears.kind == "hypoid" else SECTIONS


def figure_blocks(result: Any) -> list[Block]:
    """Draw every figure of the report; what lacks for one reason is told once."""
    names = [*sections_of(result.case), *(["coupling"] if result.coupling is not None else [])]
    figures = (FIGURES[name] for name in names)
    return _joined(_block(figure, result) for figure in figures if isinstance(figure, Drawing))
