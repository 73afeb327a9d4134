"""Figures of a run show what varies, to its own scale."""

from __future__ import annotations

import numpy as np
import pytest

import tribodyn as td
from tribodyn.plot.motion.spectra import _MARKED, _REACHED


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_small_variations_of_a_hypoid_pair_fill_their_axes() -> None:
    """Forces on pinion and wheel are opposite and vary by a hundredth of their size."""
    result = td.run("hypoid-mixed-ehl")
    force = result.plot_mesh_force()
    assert force.layout.yaxis.rangemode != "tozero"
    bearing = result.plot_bearing_force()
    for number, panel in enumerate(("y", "y2", "y3")):
        curves = [np.asarray(t.y) for t in bearing.data if t.yaxis == panel]
        low, high = min(c.min() for c in curves), max(c.max() for c in curves)
        # Both curves share the panel: no more than the swings lies between them.
        assert high - low <= sum(np.ptp(curve) for curve in curves)
        title = bearing.layout["yaxis" + str(number + 1) * bool(number)].title.text
        assert max(map(len, title.split("<br>"))) <= 40
    caption = td.plot.bearing_force.caption_of(result)
    assert caption.count("(pinion)") == caption.count("(wheel)") == 3
    modes = result.natural_modes
    marked = {t.name.partition(":")[0] for t in result.plot_spectrum().data if ": " in t.name}
    share = modes.contact_share[modes.rigid :]
    assert 1 <= len(marked) <= _MARKED
    assert all(share[int(name) - 1] >= _REACHED for name in marked)


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_large_variations_keep_their_means_and_their_zero() -> None:
    result = td.run("fzg-roughness")
    assert result.plot_mesh_force().layout.yaxis.rangemode == "tozero"
    pinion = next(t for t in result.plot_bearing_force().data if t.name == "pinion")
    assert np.mean(pinion.y) == pytest.approx(-2600.0, rel=0.1)
