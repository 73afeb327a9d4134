"""Force law of a mesh over whole turns of its gears, whose teeth differ."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from functools import cached_property
from hashlib import sha256
from typing import Any

import numpy as np

from tribodyn.errors import InputError, require_positive
from tribodyn.faults.fault import Fault
from tribodyn.gear import Material, SpurPair
from tribodyn.mesh import MeshForceLaw, MeshFunctions, phase_grid
from tribodyn.mesh.sharing import ramps_about
from tribodyn.model import NO_OPTIONS
from tribodyn.record import Record, fact, quantity, record
from tribodyn.stiffness.loaded.contact import contact_problem
from tribodyn.stiffness.loaded.face_problem import has_slices
from tribodyn.stiffness.loaded.problem import FAR, Compliance, ContactProblem, slice_gaps
from tribodyn.stiffness.model import MODELS
from tribodyn.types import Array, Index

#: Phases of a mesh cycle at which the teeth are solved, where the turns are not too many.
_PHASES, _FEWEST = 256, 32
#: Most phases of all turns: beyond it the table needs more memory than a notebook has.
_MOST = 400_000
#: Gaps that differ by less than half of its inverse are rounding [1/m].
_SAME = 1e17
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
    force_law : MeshForceLaw
        Force over the compression, over the phase of all turns.
    cycles : int
        Mesh cycles of all turns.
    """

    phase: Array = quantity("phase", unit="1", axis=True)
    transmission_error: Array = quantity("phase", of="static_transmission_error")
    mesh_stiffness_tangent: Array = quantity("phase")
    load_share: Array = quantity("phase", "pair")
    force_law: MeshForceLaw
    cycles: int = fact()

    @property
    def peak_to_peak_transmission_error(self) -> float:
        """Largest less least transmission error [m]."""
        return float(np.ptp(self.transmission_error))

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
    options: Mapping[str, Any] = NO_OPTIONS,
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
        pair = fault._on(pair)
    cycles = turns_of(pair, faults)
    if phases is None:
        phases = max(min(_PHASES, _MOST // cycles), _FEWEST)
    if cycles * phases > _MOST:
        what = f"all repeats after {cycles} mesh cycles, {cycles * phases} phases"
        remedy = (
            "Give faults of one gear only, numbers of teeth with a common factor, or fewer phases"
        )
        raise InputError(what, "argument faults", f"At most {_MOST} phases are solved", remedy)
    material = material or Material()
    force = torque / pair.pinion.base_radius
    problem = _problem(
        pair, faults, np.arange(cycles * phases) / phases, material,
        provider=provider, extended_contact=extended_contact, total_force=force, options=options,
    )  # fmt: skip
    shift, distinct, rows = _distinct(problem, cycles)
    solved = distinct.at_loads(np.array([force]))
    approach = solved.approach[0][rows] + shift
    if approach.max() > 0.5 * FAR:
        cycle = problem.places.phase[int(np.argmax(approach))]
        raise InputError(
            f"no tooth pair is left to carry {cycle:.4g} mesh cycles after the start",
            "argument faults",
            "The neighbours of the damaged tooth do not come into contact",
            "Leave more of the tooth, or take extended contact",
        )
    place, stiffness = ramps_about(distinct, solved.approach[0])
    place, stiffness = place[rows] + shift[:, None], stiffness[rows]
    law = MeshForceLaw(
        phase_grid((0.0,), cycles * phases), *(_closed(x) for x in (place, stiffness))
    )
    return TurningMesh(
        phase=np.arange(cycles * phases + 1) / phases,
        transmission_error=_closed(approach),
        mesh_stiffness_tangent=_closed(solved.tangent[0][rows]),
        load_share=_closed(_of_pairs(problem, distinct.forces(solved.load[0])[rows] / force)),
        force_law=law,
        cycles=cycles,
    )


def _distinct(problem: ContactProblem, cycles: int) -> tuple[Array, ContactProblem, Index]:
    """Shift of the approach (p,), the mesh cycles that differ by more, and their rows (p,)."""
    shift = problem.least_gap[:, None, None]
    gaps = np.where(problem.gaps >= FAR, FAR, problem.gaps - shift)
    structure, phases = problem.compliance.structure, len(gaps) // cycles
    groups: dict[bytes, int] = {}
    number, first = np.empty(cycles, dtype=np.int64), list[int]()
    for cycle in range(cycles):
        part = slice(cycle * phases, (cycle + 1) * phases)
        key = np.rint(gaps[part] * _SAME).tobytes() + structure[part].tobytes()
        number[cycle] = groups.setdefault(sha256(key).digest(), len(groups))
        if number[cycle] == len(first):
            first.append(cycle)
    within = np.arange(phases)
    chosen = (np.array(first)[:, None] * phases + within).ravel()
    parts, widths = problem.compliance, problem.widths
    compliance = Compliance(structure[chosen], parts.local[chosen], parts.logarithm)
    distinct = ContactProblem(
        problem.places, compliance, gaps[chosen], widths if len(widths) == 1 else widths[chosen]
    )
    return shift[:, 0, 0], distinct, (number[:, None] * phases + within).ravel()


def _of_pairs(problem: ContactProblem, share: Array) -> Array:
    """Shares of tooth pairs from those of their slices (p, n)."""
    if not problem.places.is_sliced:
        return share
    count = np.unique(problem.places.number).size
    return np.asarray(share.reshape(len(share), count, -1).sum(axis=2))


def _closed(values: Array) -> Array:
    """Values with the first one repeated at the end of the period."""
    return np.concatenate([values, values[:1]])


def _problem(
    pair: SpurPair, faults: Sequence[Fault], phase: Array, material: Material, **settings: Any
) -> ContactProblem:
    """Loaded tooth contact with the gaps and compliances of all faults."""
    sliced = has_slices(pair, MODELS[settings["provider"]])
    if not sliced:
        varies = any(fault._varies_over_face for fault in faults)
        settings["slices"] = _SLICES if varies else None
    problem = contact_problem(pair, phase=phase[phase < 1.0], material=material, **settings)
    count = problem.gaps.shape[1]
    number = problem.places.number
    if sliced:  # contacts are the slices of one pair after the other
        count = number.size // np.unique(number).size
    face = (((np.arange(count) + 0.5) / count - 0.5) * pair.common_face_width)[:, None]
    if sliced:
        face = np.tile(face.T, problem.gaps.shape[2] // count)
    problem = _repeated(problem, phase, face)
    places, gaps, structure = problem.places, problem.gaps, problem.compliance.structure
    contacts, apart = np.arange(structure.shape[1]), gaps >= FAR
    for fault in faults:
        gaps = gaps + fault._gap(places, face)
        sound = structure[:, contacts, contacts]
        structure[:, contacts, contacts] = sound + fault._compliance(places, material, sound)
    return replace(problem, gaps=np.where(apart, FAR, np.minimum(gaps, FAR)))


def _repeated(problem: ContactProblem, phase: Array, face: Array) -> ContactProblem:
    """The problem of a mesh cycle at the phases of many: places and compliances repeat."""
    cycles = phase.size // problem.places.phase.size

    def tiled(values: Array) -> Array:
        """Rows of a cycle for all cycles."""
        return np.tile(values, (cycles, *(1,) * (values.ndim - 1)))

    names = ("path", "separation", "pinion_curvature_radius", "wheel_curvature_radius")
    rows: dict[str, Any] = {name: tiled(getattr(problem.places, name)) for name in names}
    places = replace(problem.places, phase=phase, **rows)
    parts, widths = problem.compliance, problem.widths
    compliance = Compliance(tiled(parts.structure), tiled(parts.local), parts.logarithm)
    gaps = slice_gaps(places, face)
    return ContactProblem(places, compliance, gaps, widths if len(widths) == 1 else tiled(widths))
