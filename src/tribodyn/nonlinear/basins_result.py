"""What basins of attraction are: a plane of starts, its attractors, and what half the step says."""

from __future__ import annotations

import numpy as np

from tribodyn.nonlinear.basins_attractors import Attractor
from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, Index, Mask


@record
class Basins(Record):
    """Which motion every start of a plane comes to.

    Parameters
    ----------
    coordinates : tuple of two str
        Components of the state that vary; a velocity ends in ``_velocity``.
    units : tuple of two str
        Their units.
    first, second : (nx,), (ny,) array
        Their values [m, rad, m/s or rad/s].
    attractor : (nx, ny) int array
        Number of the attractor; -1 where the motion grew beyond all bounds or has not come near
        any motion that repeats.
    attractors : tuple of Attractor
        The motions, the one with the largest share first.
    refined_attractor : (nx, ny) int array
        The same with half the step, -2 for an attractor that the longer step does not show; all
        -3 if not asked for.
    names : tuple of str
        Names of the coordinates of the system.
    signal : str
        Name of what rms and contact loss are of, a contact or a coordinate.
    mesh_frequency : float
        Mesh frequency [Hz].
    steps : int
        Steps per mesh cycle.
    step_number : float
        ``omega_max * dt`` [-].
    finished : (nx, ny) bool array
        Which starts were marched; all of them unless the work was interrupted.
    """

    coordinates: tuple[str, str]
    units: tuple[str, str]
    first: Array = quantity("first", axis=True)
    second: Array = quantity("second", axis=True)
    attractor: Index = quantity("first", "second")
    attractors: tuple[Attractor, ...]
    refined_attractor: Index = quantity("first", "second")
    names: tuple[str, ...]
    signal: str = fact()
    mesh_frequency: float = fact()
    steps: int = fact()
    step_number: float = fact()
    finished: Mask = quantity("first", "second")

    @property
    def complete(self) -> bool:
        """Whether every start was marched."""
        return bool(self.finished.all())

    @property
    def unresolved(self) -> float:
        """Part of the starts that come to no attractor [-]."""
        return float(np.mean(self.attractor[self.finished] < 0)) if self.finished.any() else 1.0

    @property
    def changed(self) -> float:
        """Part of the starts that come to another attractor with half the step [-]."""
        judged = self.finished & (self.refined_attractor > -3)
        if not judged.any():
            return float("nan")
        return float(np.mean(self.attractor[judged] != self.refined_attractor[judged]))

    def __repr__(self) -> str:
        """One line."""
        kinds = [
            f"{100.0 * a.share:.3g} % {f'period {a.period}' if a.period else 'irregular'}"
            for a in self.attractors
        ]
        extra = f", {100.0 * self.unresolved:.3g} % unresolved" if self.unresolved else ""
        count = f"{self.first.size} x {self.second.size}"
        return (
            f"Basins({count} starts over {' and '.join(self.coordinates)} at "
            f"{self.mesh_frequency:.6g} Hz: {', '.join(kinds) or 'no attractor'}{extra}"
            f"{'' if self.complete else ', interrupted'})"
        )

    def _parts(self) -> Parts:
        parts = super()._parts().over(self.coordinates, self.units)
        units = {"rms": "m or rad"}
        for name in ("period", "rms", "contact_loss_share", "largest_multiplier", "share"):
            values = [getattr(each, name) for each in self.attractors]
            parts.variables[name] = ("number", values, {"units": units.get(name, "1")})
        parts.variables["verdict"] = ("number", [each.verdict for each in self.attractors])
        return parts
