"""Bands of the variants in a figure."""

from __future__ import annotations

from plotly import graph_objects

from tribodyn.plot.signals.bands import _by_name_and_axes


def test_bodies_and_fields_have_no_band() -> None:
    curve = graph_objects.Scatter(x=[0.0, 1.0], y=[0.0, 1.0], name="force")
    bodies = [graph_objects.Mesh3d(name="tooth"), graph_objects.Surface(), graph_objects.Pie()]
    assert list(_by_name_and_axes([*bodies, curve, curve]).values()) == [curve, curve]
