"""A branch of periodic orbits over a parameter, with its special points."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from tribodyn.record import Parts, Record, fact, quantity, record
from tribodyn.types import Array, ComplexArray, Mask


@dataclass(frozen=True)
class SpecialPoint:
    """A point of a branch at which something changes.

    Parameters
    ----------
    kind : str
        ``"fold"``, ``"period-doubling"``, ``"neimark-sacker"``, ``"branch-point"`` or
        ``"grazing"``, where a contact begins to open.
    parameter : float
        Value of the parameter [its unit].
    mesh_frequency : float
        Mesh frequency [Hz].
    position, velocity : (n,) array
        State at mesh phase 0 [m or rad, m/s or rad/s].
    floquet_multipliers : (m,) complex array
        Multipliers, the largest first.
    rms, peak_to_peak : (signals,) array
        Alternating rms and range of each signal [m or rad].
    period : int
        Mesh cycles after which the motion repeats.
    index : int
        Number of the point of the branch before it.
    """

    kind: str
    parameter: float
    mesh_frequency: float
    position: Array = field(repr=False)
    velocity: Array = field(repr=False)
    floquet_multipliers: ComplexArray = field(repr=False)
    rms: Array = field(repr=False)
    peak_to_peak: Array = field(repr=False)
    period: int = 1
    index: int = 0


@record
class Branch(Record):
    """Periodic orbits joined over a parameter, stable and unstable, in their order.

    Parameters
    ----------
    name : str
        Name of the parameter.
    parameter : (p,) array
        Value of the parameter at each point [its unit].
    mesh_frequency : (p,) array
        Mesh frequency [Hz].
    period : int
        Mesh cycles after which the motions repeat.
    position, velocity : (p, n) array
        States at mesh phase 0 [m or rad, m/s or rad/s].
    names : tuple of str
        Names of the coordinates.
    signals : tuple of str
        Names of the signals.
    mean, rms, peak_to_peak : (p, signals) array
        Mean, alternating rms and range of each signal [m or rad].
    peak_force : (p, contacts) array
        Largest force of each contact [N].
    contact_loss : (p, contacts) array
        Part of the time off the driving flank [-].
    clearance : (p, contacts) array
        Least compression beyond the gap [m]; negative where a contact opens.
    floquet_multipliers : (p, m) complex array
        Multipliers, the largest first.
    stable : (p,) bool array
        Whether all multipliers lie inside the unit circle.
    error : (p,) array
        Distance to the exact branch of the stepped system, relative to the motion [-].
    special_points : tuple of SpecialPoint
        In the order of the branch.
    ending : str
        Why the branch ends where it does.
    complete : bool
        Whether it left the range or closed, or has as many points as allowed.
    cycles_used : int
        Integrated mesh cycles.
    """

    name: str = fact(name="parameter")
    parameter: Array = quantity("point", axis=True)
    mesh_frequency: Array = quantity("point", unit="Hz", axis=True)
    period: int = fact()
    position: Array = quantity("point", "coordinate", unit="m or rad")
    velocity: Array = quantity("point", "coordinate", unit="m/s or rad/s")
    names: tuple[str, ...] = quantity("coordinate", axis=True, name="coordinate")
    signals: tuple[str, ...] = quantity("signal", axis=True, name="signal")
    mean: Array = quantity("point", "signal", unit="m or rad")
    rms: Array = quantity("point", "signal", unit="m or rad")
    peak_to_peak: Array = quantity("point", "signal", unit="m or rad")
    peak_force: Array = quantity("point", "contact", unit="N")
    contact_loss: Array = quantity("point", "contact", unit="1")
    clearance: Array = quantity("point", "contact", unit="m")
    floquet_multipliers: ComplexArray
    stable: Mask = quantity("point")
    error: Array = quantity("point", unit="1")
    special_points: tuple[SpecialPoint, ...]
    ending: str = fact()
    complete: bool
    cycles_used: int

    def special(self, kind: str) -> tuple[SpecialPoint, ...]:
        """Special points of one kind.

        Parameters
        ----------
        kind : str

        Returns
        -------
        tuple of SpecialPoint
        """
        return tuple(point for point in self.special_points if point.kind == kind)

    def start(self, index: int) -> tuple[Array, Array]:
        """State of one point, from which a search or an integration can start.

        Parameters
        ----------
        index : int
            Number of the point.

        Returns
        -------
        tuple of two (n,) arrays
            Position and velocity [m or rad, m/s or rad/s].
        """
        return self.position[index], self.velocity[index]

    def __repr__(self) -> str:
        """One line."""
        low, high = self.parameter.min(), self.parameter.max()
        marks = [point.kind for point in self.special_points]
        counts = [f"{marks.count(kind)} {kind}" for kind in dict.fromkeys(marks)]
        cycles = f"{self.period} mesh cycle{'s' if self.period != 1 else ''}"
        return (
            f"Branch({self.parameter.size} orbits of {cycles}, {self.name} {low:.6g} to "
            f"{high:.6g}, {int(self.stable.sum())} stable"
            + (f", {', '.join(counts)}" if counts else "")
            + ("" if self.complete else ", ended early")
            + ")"
        )

    def _parts(self) -> Parts:
        variables, coordinates, _ = parts = super()._parts()
        for kind, values in (
            ("real", self.floquet_multipliers.real),
            ("imaginary", self.floquet_multipliers.imag),
        ):
            variables[f"multiplier_{kind}"] = (("point", "multiplier"), values, {"units": "1"})
        special = "special_point", self.special_points
        variables["special_parameter"] = (special[0], [point.parameter for point in special[1]])
        coordinates["special_kind"] = (special[0], [point.kind for point in special[1]])
        return parts


def of_contact(branch: Branch, contact: int) -> Branch:
    """The branch with the figures of one contact alone."""
    names = ("peak_force", "contact_loss", "clearance")
    return replace(branch, **{name: getattr(branch, name)[:, [contact]] for name in names})
