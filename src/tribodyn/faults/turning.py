"""Force law of a mesh over whole turns of its gears, whose teeth differ."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, replace
from functools import cached_property
from hashlib import sha256
from typing import Any, NamedTuple

import numpy as np

from tribodyn.contact.face_contacts import face_positions
from tribodyn.errors import InputError, require_positive
from tribodyn.faults.fault import Fault
from tribodyn.gear import Material, SpurPair
from tribodyn.mesh import MeshForceLaw, MeshFunctions, phase_grid
from tribodyn.model import NO_OPTIONS
from tribodyn.record import Record, fact, quantity, record
from tribodyn.stiffness.loaded.contact import contact_problem
from tribodyn.stiffness.loaded.face_problem import has_slices
from tribodyn.stiffness.loaded.problem import (
    FAR,
    Compliance,
    ContactPlaces,
    ContactProblem,
    slice_gaps,
)
from tribodyn.stiffness.loaded.ramps import ramps_about
from tribodyn.stiffness.model import MODELS
from tribodyn.types import Array, ByName, Index

#: Phases of a mesh cycle at which the teeth are solved, where the turns are not too many.
_PHASES, _FEWEST = 256, 32
#: Most phases of all turns: beyond it the table needs more memory than a notebook has.
_MOST = 400_000
#: Most phases of all turns where the teeth have slices, at which more are not tried, and bytes of
#: the compliances that are set up at once.
_MOST_OF_SLICES, _AT_ONCE = 105_000, 2**28
#: Gaps that differ by less than half of its inverse are rounding [1/m].
_SAME = 1e17
#: Difference of force laws, over their size, that is rounding.
_ROUNDING = 1e-9
#: Slices of the face where a fault is narrower than it.
_SLICES = 21


def turns_of(pair: SpurPair, faults: Sequence[Fault] = ()) -> int:
    """Mesh cycles until all repeats.

    Parameters
    ----------
    pair : SpurPair
        The pair.
    faults : sequence of Fault
        Faults of its gears.

    Returns
    -------
    int
        Teeth of the gear whose teeth differ; of both gears their least common multiple, the
        hunting period.

    Examples
    --------
    >>> from tribodyn.faults import eccentricity
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=16, wheel_teeth=24, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02)
    >>> turns_of(pair, [eccentricity("pinion", 1e-5)])
    16
    """
    gears = {"pinion": pair.pinion, "wheel": pair.wheel}
    differ = {name for name, gear in gears.items() if gear.modification.teeth_differ}
    differ |= {fault.gear for fault in faults}
    return math.lcm(*(abs(gears[name].teeth) for name in differ))


@record
class TurningMesh(Record):
    """A mesh over whole turns of its gears.

    Parameters
    ----------
    phase : (k,) array
        Mesh cycles since tooth 1 of both gears came into contact; its end included.
    transmission_error : (k,) array
        Approach of the gears under the mean load at rest [m].
    mesh_stiffness_tangent : (k,) array
        Slope of the force over the approach there [N/m].
    load_share : (k, pairs) array
        Part of the force on each pair.
    face_position : (slices,) array
        Middles of slices of the face, from its middle [m].
    face_load : (cycles, slices) array
        Load of each tooth pair, in the order of contact, on slices of the face over its time in
        contact; the mean of all is one [1].
    force_law : MeshForceLaw
        Force over the compression, over the phase of all turns.
    cycles : int
        Mesh cycles of all turns.
    error : callable, optional
        Deviations as an error of the mesh over the phase of all turns [m], where no tooth has a
        gap.
    """

    phase: Array = quantity("phase", unit="1", axis=True)
    transmission_error: Array = quantity("phase", of="static_transmission_error")
    mesh_stiffness_tangent: Array = quantity("phase")
    load_share: Array = quantity("phase", "pair")
    face_position: Array = quantity("face_position", unit="m", axis=True)
    face_load: Array = quantity("tooth_pair", "face_position", unit="1")
    force_law: MeshForceLaw
    cycles: int = fact()
    error: Callable[[Array | float], Array] | None = None

    @property
    def peak_to_peak_transmission_error(self) -> float:
        """Largest less least transmission error [m]."""
        return float(np.ptp(self.transmission_error))

    def repeats(self, cycle: TurningMesh) -> bool:
        """Whether all mesh cycles have the force law of a mesh over one cycle, but for rounding.

        Parameters
        ----------
        cycle : TurningMesh
            Over one mesh cycle, on the same phases of it.

        Returns
        -------
        bool
        """
        for name in ("knot_deflection", "knot_stiffness"):
            knots, once = (getattr(law, name) for law in (self.force_law, cycle.force_law))
            if len(knots) - 1 != self.cycles * (len(once) - 1) or knots.shape[1] != once.shape[1]:
                return False
            rows = knots[:-1].reshape(self.cycles, *once[:-1].shape)
            if np.abs(rows - once[:-1]).max() > _ROUNDING * np.abs(once).max():
                return False
        return True

    def functions(self, healthy: MeshFunctions) -> MeshFunctions:
        """What a dynamic model reads: this force law, and the friction of the sound mesh.

        Parameters
        ----------
        healthy : MeshFunctions
            Of the mesh table, over its mesh cycle.

        Returns
        -------
        MeshFunctions
            Over the phase of all turns, in [0, 1).
        """
        skipped = ("event_phases", "force_law", "total_normal_force")
        functions: dict[str, Any] = {
            field.name: self._turning(getattr(healthy, field.name))
            for field in fields(healthy)
            if field.name not in skipped
        }
        cycle = np.arange(self.cycles)[:, None]
        events = (np.array(healthy.event_phases) + cycle).ravel() / self.cycles
        functions |= {"event_phases": tuple(events.tolist()), "force_law": self.force_law}
        if self.error is not None:
            deviations, sound = self.error, functions["error"]
            functions["error"] = (
                deviations if sound is None else lambda phase: sound(phase) + deviations(phase)
            )
        return replace(healthy, **functions)

    def _turning(self, function: Callable[..., Array] | None) -> Callable[..., Array] | None:
        if function is None:
            return None
        of_cycle = function

        def turning(phase: Array | float) -> Array:
            """Value over the phase of all turns."""
            return of_cycle(self._phase_in_cycle(phase))

        return turning

    def _phase_in_cycle(self, phase: Array | float) -> Array:
        """Mesh phase in [0, 1), exact at the events."""
        turned = np.asarray(phase, dtype=float) * self.cycles
        nearest = np.round(turned)
        # Far below the distance at which systems compare both sides of an event.
        rounding = min(1e-11 * self.cycles, 1e-9)
        turned = np.where(np.abs(turned - nearest) < rounding, nearest, turned)
        return np.asarray(turned % 1.0)

    @cached_property
    def _swing(self) -> float:
        return 1e6 * self.peak_to_peak_transmission_error

    def __repr__(self) -> str:
        """One line."""
        return (
            f"TurningMesh({self.cycles} mesh cycles, transmission error {self._swing:.4g} um peak "
            f"to peak, {self.force_law.knot_stiffness.shape[1]} ramps)"
        )


def turning_mesh(
    pair: SpurPair,
    torque: float,
    faults: Sequence[Fault] = (),
    *,
    provider: str = "fe2d",
    extended_contact: bool = True,
    material: Material | None = None,
    options: ByName = NO_OPTIONS,
    phases: int | None = None,
) -> TurningMesh:
    """Solve the loaded tooth contact over whole turns.

    Parameters
    ----------
    pair : SpurPair
        Both gears in their working position.
    torque : float
        Torque on the pinion [N*m].
    faults : sequence of Fault
        Faults, besides the deviations of the pair.
    provider, extended_contact, material, options
        As for :func:`tribodyn.stiffness.loaded_contact`.
    phases : int, optional
        Phases of a mesh cycle; 256 by default, fewer where the turns are many.

    Returns
    -------
    TurningMesh

    Raises
    ------
    InputError
        If a fault does not fit the pair, or the turns are too many.

    Notes
    -----
    Every tooth pair has the gap and the compliance of its own two teeth: ``delta = C F + local(F) +
    gap``, as :func:`tribodyn.stiffness.loaded_contact` solves it. The force law is exact at the
    load and within 1 % from 0.75 to 1.3 times its deflection.

    Examples
    --------
    >>> from tribodyn.faults import BrokenTooth
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=16, wheel_teeth=24, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=0.02, pinion_bore_diameter=0.02,
    ...     wheel_bore_diameter=0.03)
    >>> broken = BrokenTooth(remaining=0.6)
    >>> turning_mesh(pair, 90.0, [broken], provider="analytic", phases=16).cycles
    16
    """
    require_positive("torque", torque, "N*m")
    for fault in faults:
        fault._check(pair)
        fault._check_model(pair, provider)
        pair = fault._on(pair)
    cycles = turns_of(pair, faults)
    if phases is None:
        most = _MOST_OF_SLICES if has_slices(pair, MODELS[provider]) else _MOST
        phases = max(min(_PHASES, most // cycles), _FEWEST)
    if cycles * phases > _MOST:
        what = f"all repeats after {cycles} mesh cycles, {cycles * phases} phases"
        remedy = "Give faults of one gear only, or fewer phases of a mesh cycle"
        raise InputError(what, "argument faults", f"At most {_MOST} phases are solved", remedy)
    material = material or Material()
    force = torque / pair.pinion.base_radius
    places, problems, shift, rows = _turns(
        pair, faults, np.arange(cycles * phases) / phases, material,
        provider=provider, extended_contact=extended_contact, total_force=force, options=options,
    )  # fmt: skip
    solved = [_solved(problem, force) for problem in problems]
    approach, tangent, pair_force, place, stiffness = map(np.concatenate, zip(*solved, strict=True))
    approach = approach[rows] + shift
    if approach.max() > 0.5 * FAR:
        cycle = places.phase[int(np.argmax(approach))]
        raise InputError(
            f"no tooth pair is left to carry {cycle:.4g} mesh cycles after the start",
            "argument faults",
            "The neighbours of the damaged tooth do not come into contact",
            "Leave more of the tooth, or take extended contact",
        )
    place, stiffness = place[rows] + shift[:, None], stiffness[rows]
    law = MeshForceLaw(
        phase_grid((0.0,), cycles * phases), *(_closed(x) for x in (place, stiffness))
    )
    face_load = _face_load(places, pair_force, rows, cycles)
    return TurningMesh(
        phase=np.arange(cycles * phases + 1) / phases,
        transmission_error=_closed(approach),
        mesh_stiffness_tangent=_closed(tangent[rows]),
        load_share=_closed(_of_pairs(places, pair_force.sum(axis=1)[rows] / force)),
        face_position=face_positions(places.contact, face_load.shape[1]),
        face_load=face_load,
        force_law=law,
        cycles=cycles,
    )


class _Turns(NamedTuple):
    """Contacts over all turns, and the problem of those mesh cycles that differ."""

    places: ContactPlaces
    #: Of the mesh cycles that differ by more than a shift of the approach, some at a time.
    problems: Iterator[ContactProblem]
    shift: Array  #: of the approach (p,) [m]
    rows: Index  #: row of the problems of each phase (p,)


def _solved(problem: ContactProblem, force: float) -> tuple[Array, ...]:
    """Approach, stiffness, forces of the pairs, and ramps of a problem at a load."""
    solved = problem.at_loads(np.array([force]))
    approach = solved.approach[0]
    ramps = ramps_about(problem, approach)
    return approach, solved.tangent[0], problem.widths * solved.load[0], *ramps


def _distinct(places: ContactPlaces, gaps: Array, faults: Sequence[Fault], cycles: int) -> Index:
    """Number of the first mesh cycle that differs from each one by no more than a shift."""
    phases = len(gaps) // cycles
    softened = [mask for fault in faults if (mask := fault._softened(places)) is not None]
    groups: dict[bytes, int] = {}
    first = np.empty(cycles, dtype=np.int64)
    for cycle in range(cycles):
        part = slice(cycle * phases, (cycle + 1) * phases)
        key = np.rint(gaps[part] * _SAME).tobytes() + b"".join(m[part].tobytes() for m in softened)
        first[cycle] = groups.setdefault(sha256(key).digest(), cycle)
    return first


def _of_pairs(places: ContactPlaces, share: Array) -> Array:
    """Shares of tooth pairs from those of their slices (p, n)."""
    if not places.is_sliced:
        return share
    count = np.unique(places.number).size
    return np.asarray(share.reshape(len(share), count, -1).sum(axis=2))


def _face_load(places: ContactPlaces, force: Array, rows: Index, cycles: int) -> Array:
    """Load of each tooth pair on slices of the face (cycles, s), their mean over all pairs one."""
    numbers = np.unique(places.number)
    sliced = (len(force), numbers.size, -1)
    of_slices = force.reshape(sliced) if places.is_sliced else force.transpose(0, 2, 1)
    load = np.zeros((cycles, of_slices.shape[2]))
    entered = np.floor(places.phase).astype(int)
    for column, number in enumerate(numbers):
        np.add.at(load, (entered - number) % cycles, of_slices[rows, column])
    return np.asarray(load / load.mean())


def _closed(values: Array) -> Array:
    """Values with the first one repeated at the end of the period."""
    return np.concatenate([values, values[:1]])


def _turns(
    pair: SpurPair, faults: Sequence[Fault], phase: Array, material: Material, **settings: Any
) -> _Turns:
    """Loaded tooth contact with the gaps and compliances of all faults."""
    sliced = has_slices(pair, MODELS[settings["provider"]])
    if not sliced:
        varies = any(fault._varies_over_face for fault in faults)
        settings["slices"] = _SLICES if varies else None
    cycle = contact_problem(pair, phase=phase[phase < 1.0], material=material, **settings)
    count = cycle.gaps.shape[1]
    number = cycle.places.number
    if sliced:  # contacts are the slices of one pair after the other
        count = number.size // np.unique(number).size
    face = (((np.arange(count) + 0.5) / count - 0.5) * pair.common_face_width)[:, None]
    if sliced:
        face = np.tile(face.T, cycle.gaps.shape[2] // count)
    within = np.arange(phase.size) % len(cycle.gaps)  # the places of a cycle repeat
    places = replace(_at_phases(cycle.places, within), phase=phase)
    gaps = slice_gaps(places, face)
    separated = gaps >= FAR
    for fault in faults:
        gaps = gaps + fault._gap(places, face)
    gaps = np.where(separated, FAR, np.minimum(gaps, FAR))
    shift = gaps.min(axis=(1, 2), keepdims=True)
    gaps = np.where(gaps >= FAR, FAR, gaps - shift)
    first = _distinct(places, gaps, faults, phase.size // len(cycle.gaps))
    chosen, group = np.unique(first, return_inverse=True)
    phases = np.arange(len(cycle.gaps))
    parts, widths = cycle.compliance, cycle.widths
    at_once = max(1, _AT_ONCE // (phases.size * parts.structure[0].nbytes))

    def problems() -> Iterator[ContactProblem]:
        for begin in range(0, chosen.size, at_once):
            some = chosen[begin : begin + at_once]
            rows, same = (some[:, None] * phases.size + phases).ravel(), np.tile(phases, some.size)
            compliance = parts.structure[same], parts.local[same], parts.logarithm
            problem = ContactProblem(
                _at_phases(places, rows), Compliance(*compliance), gaps[rows],
                widths if len(widths) == 1 else widths[same],
            )  # fmt: skip
            for fault in faults:
                fault._soften(problem, material)
            yield problem

    rows = (group[:, None] * phases.size + phases).ravel()
    return _Turns(places, problems(), shift[:, 0, 0], rows)


def _at_phases(places: ContactPlaces, rows: Index) -> ContactPlaces:
    """Places at some phases."""
    names = (
        "phase", "path", "separation", "pinion_curvature_radius", "wheel_curvature_radius"
    )  # fmt: skip
    chosen: dict[str, Any] = {name: getattr(places, name)[rows] for name in names}
    return replace(places, **chosen)
