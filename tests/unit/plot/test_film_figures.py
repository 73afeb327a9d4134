"""Figures of the oil film along the path of contact: their curves, titles and refusals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from known_figures import caption, curve
from tribodyn.errors import InputError
from tribodyn.plot import FIGURES


@pytest.fixture
def result(drawable: Any) -> Any:
    drawn_result = drawable(film_model="dowson-higginson")
    drawn_result.mesh = replace(
        drawn_result.mesh,
        film_pressure=1.1 * drawn_result.mesh.hertz_pressure,
        stiffness=0.98 * drawn_result.mesh.tooth_stiffness,
        film_stiffness_kind="tangent",
    )
    return drawn_result


def test_the_film_ratio_has_a_panel_of_its_own(result: Any) -> None:
    figure = FIGURES["film"](result)
    ratio = curve(figure, "film ratio", "y2")
    least = result.mesh.minimum_film[result.mesh.in_contact].min()
    assert min(ratio.y) == pytest.approx(least / 0.5e-6)
    assert set(curve(figure, "asperity contact below", "y2").y) == {1.0}
    assert (
        figure.layout.title.text
        == f"The oil film at its thinnest is never below {least * 1e6:.3f} µm"
    )
    result.mesh = replace(result.mesh, film_ratio=None)
    assert len([trace for trace in FIGURES["film"](result).data if trace.yaxis == "y2"]) == 0


def test_film_pressure_is_drawn_with_the_dry_contact(result: Any) -> None:
    figure = FIGURES["film_pressure"](result)
    film, dry = curve(figure, "in the oil film"), curve(figure, "dry contact")
    assert np.asarray(film.y) == pytest.approx(1.1 * np.asarray(dry.y), rel=1e-12)
    assert max(dry.y) == pytest.approx(result.mesh.hertz_pressure.max() * 1e-9)
    assert f"{max(film.y):.3f} GPa" in figure.layout.title.text
    assert "one pair carries during" in caption("film_pressure", result)


def test_film_stiffness_is_drawn_with_that_of_the_teeth(result: Any) -> None:
    figure = FIGURES["film_stiffness"](result)
    assert figure.layout.yaxis.type == "log"
    film, teeth = curve(figure, "oil film"), curve(figure, "teeth")
    assert max(film.y) == pytest.approx(result.mesh.film_stiffness.max() * 1e-6)
    assert np.asarray(teeth.y) == pytest.approx(np.full(len(teeth.y), 200.0))
    combined = curve(figure, "teeth and film", "y2")
    assert np.asarray(combined.y) == pytest.approx(0.98 * np.asarray(teeth.y))
    lowest = (np.asarray(film.y) / np.asarray(teeth.y)).min()
    assert f"{lowest:.3g}"[:3] in figure.layout.title.text
    assert "tangent" in caption("film_stiffness", result)


def test_a_film_that_does_not_yield_has_one_panel(result: Any) -> None:
    result.mesh = replace(result.mesh, film_stiffness_kind="none")
    assert {trace.yaxis for trace in FIGURES["film_stiffness"](result).data} == {"y"}
    assert "adds no compliance" in caption("film_stiffness", result)


def test_figures_name_what_the_film_model_lacks(drawable: Any, result: Any) -> None:
    bare = drawable()
    for name in ("film", "film_pressure", "film_stiffness"):
        with pytest.raises(InputError, match=r"No film model was chosen.*newton"):
            FIGURES[name](bare)
    formula = drawable(film_model="moes")
    with pytest.raises(InputError, match=r'"moes" is a formula.*no pressure.*newton'):
        FIGURES["film_pressure"](formula)
    result.mesh = replace(result.mesh, film_stiffness=None)
    with pytest.raises(InputError, match="gives no film stiffness"):
        FIGURES["film_stiffness"](result)


def test_a_pair_without_load_does_not_count_in_the_ratio(result: Any) -> None:
    """Relieved flanks are apart where they come in: the teeth have no stiffness there."""
    before = FIGURES["film_stiffness"](result).layout.title.text
    teeth = result.mesh.tooth_stiffness.copy()
    teeth[:3, 0] = 0.0
    result.mesh = replace(result.mesh, tooth_stiffness=teeth)
    after = FIGURES["film_stiffness"](result).layout.title.text
    assert after.split(" to ")[1] == before.split(" to ")[1]
