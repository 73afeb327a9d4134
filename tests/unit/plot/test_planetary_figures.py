"""Front view of a planetary stage with its modes."""

import numpy as np

from known_planetary import LIN_PARKER
from tribodyn.machine import planetary_modes, planetary_plane_model
from tribodyn.plot.machine.planetary import MODE_COLORS


def test_modes_move_the_bodies_of_their_type_only() -> None:
    modes = planetary_modes(planetary_plane_model(planets=4, **LIN_PARKER))
    figure = modes.plot()
    assert figure.layout.title.text == "2: 727.27 Hz, translational"
    rest, *moved = figure.data
    sun, ring = slice(0, 73), slice(77, 150)  # their circles in the outline
    assert np.ptp(rest.x[ring]) > 2.0 * np.ptp(rest.x[sun])
    for mode_type, trace in zip(modes.types, moved, strict=True):
        assert trace.line.color == MODE_COLORS[mode_type]
        shift = np.abs(np.subtract(trace.x[sun], rest.x[sun])).max()
        shift += np.abs(np.subtract(trace.y[sun], rest.y[sun])).max()
        assert (shift > 1e-3) == (mode_type == "translational")
    buttons = figure.layout.updatemenus[0].buttons
    assert [button.label.split(", ")[1] for button in buttons] == list(modes.types)
    assert [bool(trace.visible) for trace in figure.data] == list(buttons[1].args[0]["visible"])
