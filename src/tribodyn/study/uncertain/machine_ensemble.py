"""Machines whose values are spread: figures of many variants."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.uncertain.lanes import successful
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.studies.sweep_result import SweepPoint

#: Fewest variants that make an ensemble.
_FEWEST = 3


@record
class MachineEnsemble(Record):
    """Figures of many variants of a machine.

    Parameters
    ----------
    input : (k,) array of str
        Keys that were spread.
    value : (n, k) array
        Sampled values of the variants, in SI.
    figure : (m,) array of str
        Keys of the summary.
    middle : (m,) array
        Figures at the median of all inputs, in SI.
    sample : (n, m) array
        Figures of the variants, in SI.
    seed : int
        Of the sample.
    title : str
        Title of the case.
    """

    input: Any = quantity("input", axis=True, unit="", name="input")
    value: Array = quantity("variant", "input", unit="")
    figure: Any = quantity("figure", axis=True, unit="", name="figure")
    middle: Array = quantity("figure", unit="")
    sample: Array = quantity("variant", "figure", unit="")
    seed: int = fact()
    title: str = fact()

    def figures(self) -> dict[str, Array]:
        """Figures of the summary, in SI.

        Returns
        -------
        dict of str to (n + 1,) array
            First that at the median of all inputs, then those of the variants.
        """
        columns = np.vstack((self.middle, self.sample)).T
        return {str(name): column for name, column in zip(self.figure, columns, strict=True)}

    def plot(self, figure: str = "machine_ensemble") -> Any:
        """Draw the levels of the parts, or ``load_share_statistics`` of a planetary stage.

        Parameters
        ----------
        figure : str
            Name in :data:`tribodyn.plot.FIGURES`.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return draw(self, figure)

    def __repr__(self) -> str:
        """One line."""
        inputs = ", ".join(map(str, self.input))
        return f"MachineEnsemble({len(self.value)} variants over {inputs})"


def ensemble_of(
    points: list[SweepPoint], keys: Iterable[str], seed: int, title: str
) -> MachineEnsemble:
    """Ensemble of the points of its variants; the first point is the middle."""
    fewest = len(points) if points[0].failed else 1 + _FEWEST
    middle, *variants = successful(points, "variants", "tolerances", fewest)
    names = [n for n in middle.figures if all(n in point.figures for point in variants)]
    return MachineEnsemble(
        input=np.array(list(keys)),
        value=np.array([point.values for point in variants]),
        figure=np.array(names),
        middle=np.array([middle.figures[name] for name in names]),
        sample=np.array([[point.figures[name] for name in names] for point in variants]),
        seed=seed,
        title=title,
    )
