"""Read one curve, the marks or the caption of a figure."""

from __future__ import annotations

from typing import Any

from tribodyn.plot import FIGURES, Drawing

__all__ = ["caption", "curve", "marks"]


def curve(figure: Any, name: str, axis: str = "y") -> Any:
    """The one curve of a name on an axis."""
    (curve_,) = (trace for trace in figure.data if (trace.name, trace.yaxis or "y") == (name, axis))
    return curve_


def marks(figure: Any) -> dict[str, float]:
    """Places of the names over a figure."""
    return {note.text: note.x for note in figure.layout.annotations}


def caption(name: str, result: Any) -> str:
    """What a figure says about a result."""
    figure = FIGURES[name]
    assert isinstance(figure, Drawing)
    return figure.caption_of(result)
