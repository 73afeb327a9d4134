"""Mesh force over the face width by independent slices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, real_numbers
from tribodyn.machine.fields import check_number
from tribodyn.machine.graph.kinematics import mean_stiffness
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import mean_over_phase
from tribodyn.machine.plane_law import SPATIAL, coordinate_count, mean_in_space
from tribodyn.types import Array

#: Points over the face: an odd number, for the rule of Simpson.
_POINTS = 81


def _simpson() -> Array:
    weights = np.full(_POINTS, 2.0)
    weights[1::2], weights[[0, -1]] = 4.0, 1.0
    return np.asarray(weights / weights.sum())


_WEIGHTS = _simpson()


@dataclass(frozen=True, eq=False)
class FaceLaw:
    """Law of a mesh whose slices carry independently of each other, each in compression only.

    Parameters
    ----------
    stiffness : float
        Mean mesh stiffness of the full face [N/m].
    face_width : float
        Common face width [m].
    gap : float or (81,) array
        Gap between the flanks without load at equal distances from the end at -x to that at +x,
        such as a crowning or a helix modification [m].
    error : float
        Mean displacement error, subtracted from the compression [m].

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Slices of equal stiffness per width. Where all carry, a linear gap ``F`` over the face gives
    the face load factor ``1 + F k/(2 N)`` of the force N, and ``sqrt(2 F k/N)`` where they do
    not. Neighbouring slices support each other in a real tooth, so that this overestimates the
    factor.

    Examples
    --------
    >>> law = FaceLaw(stiffness=4e8, face_width=0.02)
    >>> force, moment, _ = law(10e-6, 4e-6 / 0.02)
    >>> round(force, 6), round(moment, 6), round(law.face_load_factor(10e-6, 4e-6 / 0.02), 6)
    (4000.0, 2.666667, 1.2)
    """

    stiffness: float
    face_width: float
    gap: ArrayLike = 0.0
    error: float = 0.0

    def __post_init__(self) -> None:
        check_number(self, "stiffness", "N/m", 0.0, above=True)
        check_number(self, "face_width", "m", 0.0, 10.0, above=True)
        check_number(self, "error", "m", -1.0, 1.0)
        gap = real_numbers(Argument("FaceLaw.gap"), self.gap)
        if gap.shape not in ((), (_POINTS,)) or not np.all(np.abs(gap) < 1.0):
            what = f"gap has the shape {gap.shape} or is not below 1 m"
            why = f"Wanted: one number, or {_POINTS} numbers over the face in m"
            raise InputError(what, Argument("FaceLaw.gap"), why, "Interpolate it at these points")
        object.__setattr__(self, "gap", np.broadcast_to(gap, _POINTS).copy())

    @property
    def position(self) -> Array:
        """Points over the face, from mid face along x, (81,) [m]."""
        return self.face_width * np.linspace(-0.5, 0.5, _POINTS)

    def load_per_width(self, compression: float, slope: float) -> Array:
        """Load per face width.

        Parameters
        ----------
        compression : float
            Compression along the line of action at mid face [m].
        slope : float
            Increase of the compression over x, over the face width [1].

        Returns
        -------
        (81,) array [N/m]
            At :attr:`position`.
        """
        pressed = compression - self.error + slope * self.position - np.asarray(self.gap)
        return np.asarray(self.stiffness / self.face_width * np.maximum(pressed, 0.0))

    def face_load_factor(self, compression: float, slope: float) -> float:
        """Greatest over mean load per width; 1 where nothing carries.

        Parameters
        ----------
        compression : float
            Compression along the line of action at mid face [m].
        slope : float
            Increase of the compression over x [1].

        Returns
        -------
        float
            K_Hbeta of the slices, at least 1.
        """
        load = self.load_per_width(compression, slope)
        mean = float(_WEIGHTS @ load)
        return float(load.max() / mean) if mean > 0.0 else 1.0

    def __call__(self, compression: float, slope: float) -> tuple[float, float, Array]:
        """Force, moment about mid face, and their derivatives.

        Parameters
        ----------
        compression : float
            Compression along the line of action at mid face [m].
        slope : float
            Increase of the compression over x [1].

        Returns
        -------
        tuple
            Force [N], moment [N*m], derivatives (2, 2) [N/m, N, N*m].
        """
        weight = self.face_width * _WEIGHTS
        load = weight * self.load_per_width(compression, slope)
        levers = np.array([np.ones(_POINTS), self.position])
        force, moment = (levers @ load).tolist()
        carrying = self.stiffness / self.face_width * weight * (load > 0.0)
        return force, moment, (levers * carrying) @ levers.T


@dataclass(frozen=True, eq=False)
class LoadCenterLaw:
    """Law of a mesh about a misalignment at which the centre of its load is known.

    Parameters
    ----------
    stiffness : float
        Mean mesh stiffness of the full face [N/m].
    face_width : float
        Common face width [m].
    slope : float
        Increase of the compression over x with which the tooth contact was computed [1].
    lever : float
        Moment of the load about mid face over the load, at this slope [m].
    error : float
        Mean displacement error, subtracted from the compression [m].

    Notes
    -----
    Away from that slope the moment changes as that of :class:`FaceLaw` with the full face in
    contact, so that an iteration with the tooth contact converges to the moment of the latter.

    Examples
    --------
    >>> law = LoadCenterLaw(stiffness=4e8, face_width=0.02, slope=1e-4, lever=1e-3)
    >>> force, moment, _ = law(10e-6, 1e-4)
    >>> round(force, 6), round(moment, 6)
    (4000.0, 4.0)
    """

    stiffness: float
    face_width: float
    slope: float
    lever: float
    error: float = 0.0

    def __call__(self, compression: float, slope: float) -> tuple[float, float, Array]:
        """Force, moment about mid face, and their derivatives, as :class:`FaceLaw`."""
        change = slope - self.slope
        force = self.stiffness * (compression - self.error + self.lever * change)
        tilting = self.stiffness * self.face_width**2 / 12.0
        levers = np.array([1.0, self.lever])
        tangent = self.stiffness * np.outer(levers, levers) + np.diag([0.0, tilting])
        return force, force * self.lever + tilting * change, tangent


def load_lever(machine: Machine, name: str) -> float:
    """Mean moment of the load of a mesh with twelve coordinates about mid face, over it [m]."""
    direction = machine.directions[name]
    turn = np.cross([1.0, 0.0, 0.0], direction.normal)
    return float(turn @ (mean_in_space(machine, name)[3:6] - direction.direction[3:6]))


def face_laws(
    machine: Machine, misalignment: Mapping[str, float] | None = None
) -> dict[str, FaceLaw | LoadCenterLaw]:
    """Laws of all meshes of a machine over their face, for :func:`static_balance`.

    Parameters
    ----------
    machine : Machine
        The machine.
    misalignment : mapping of str to float, optional
        Increase of the compression over the face along x with which the contacts of meshes were
        computed [m].

    Returns
    -------
    dict
        :class:`LoadCenterLaw` of meshes whose contacts know the centre of the load, with twelve
        coordinates; of others :class:`FaceLaw` of the mean stiffness, mean error and common face
        width, without gap; no law of meshes on crossed axes.

    Examples
    --------
    >>> from tribodyn.machine import Gear, Mesh, Operation, Shaft
    >>> machine = Machine(
    ...     shafts={"in": Shaft(), "out": Shaft()},
    ...     gears={"z1": Gear("in", None, 20, 0.02), "z2": Gear("out", None, 40, 0.03)},
    ...     meshes={"first": Mesh(("z1", "z2"), 3e-3, stiffness=3e8)},
    ...     operation=Operation("in", "out", 100.0, 60.0))
    >>> face_laws(machine)["first"].face_width
    0.02
    """
    laws: dict[str, FaceLaw | LoadCenterLaw] = {}
    for name, mesh in machine.meshes.items():
        if mesh.crossed is not None:  # the load moves with the mounting of the gears
            continue
        gears = machine.gears[mesh.gears[0]], machine.gears[mesh.gears[1]]
        width = min(gear.face_width for gear in gears)
        stiffness, error = mean_stiffness(mesh, gears), mean_over_phase(mesh.error)
        if mesh.contacts and coordinate_count(mesh.contacts[0]) == SPATIAL:
            slope = (misalignment or {}).get(name, 0.0) / width
            laws[name] = LoadCenterLaw(stiffness, width, slope, load_lever(machine, name), error)
        else:
            laws[name] = FaceLaw(stiffness, width, error=error)
    return laws
