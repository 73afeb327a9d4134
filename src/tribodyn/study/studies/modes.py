"""Natural modes of a case about its static load, and the speeds at which the mesh meets them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.machine import MachineModes, machine_modes
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.modes import MachineCampbell, MeshOrder, campbell_of, mesh_orders
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.pipeline.assembly import ORDERS, diagram_of
from tribodyn.study.pipeline.tooth_contact import operation_values
from tribodyn.study.studies.case_grid import build_system
from tribodyn.study.studies.study_axes import ends_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tribodyn.dynamics import Campbell, NaturalModes
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase

_SPEED = "operation.speed"
#: Smallest share of the energy that is reported.
_LEAST = 0.05


@dataclass(frozen=True)
class Mode:
    """Printed figures of an elastic mode."""

    number: int  #: index among all modes, the rigid ones included, from 0
    frequency: float  #: [Hz]
    damping_ratio: float  #: part of the critical damping
    moves: str  #: bodies with their shares of the kinetic energy
    strains: str  #: mesh, shafts and supports with their shares of the strain energy
    speeds: tuple[float, ...]  #: critical speeds, one for each of ``ORDERS`` [rad/s]


def natural_modes(case: AnyCase, progress: Progress = SILENT) -> NaturalModes | MachineModes:
    """Find the natural frequencies of a case about its static load; no motion is computed.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    progress : Progress
        Receives the progress of the tooth contact; silent by default.

    Returns
    -------
    NaturalModes or MachineModes
        With the mean stiffness of the mesh at this speed and load, contacts closed.

    Raises
    ------
    InputError
        If a value of the case is missing or invalid.

    Examples
    --------
    >>> import tribodyn
    >>> modes = natural_modes(tribodyn.load_case("fzg-roughness"))
    >>> modes.frequency.round().tolist()
    [0.0, 5045.0, 9044.0, 9390.0, 11452.0, 11991.0]
    """
    from tribodyn.dynamics import natural_modes as compute

    if not case.lumped:
        return modes_at_rest(case, progress)[0]
    return compute(build_system(case, progress=progress)[0])


def campbell(
    case: AnyCase,
    between: tuple[object, object] | None = None,
    *,
    orders: Iterable[int] = ORDERS,
    progress: Progress = SILENT,
) -> Campbell | MachineCampbell:
    """Find the speeds at which mesh harmonics of a case meet its natural frequencies.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    between : tuple, optional
        Lowest and highest value of ``operation.speed``: floats in rad/s, or text with a unit; by
        default up to beyond the speed at which the mesh frequency meets the mode of the mesh.
    orders : iterable of int
        Mesh harmonics; of pairs.
    progress : Progress
        Receives the progress of the tooth contact; silent by default.

    Returns
    -------
    Campbell or MachineCampbell
        Its speed is that of the gear whose speed the case gives, or of the input; the stiffness is
        that at the speed and load of the case.

    Raises
    ------
    InputError
        If a speed is out of range, or a value of the case is missing or invalid.

    Examples
    --------
    >>> import tribodyn
    >>> diagram = campbell(tribodyn.load_case("fzg-roughness"), ("1000 rpm", "5000 rpm"))
    >>> [(met.order, round(met.speed * 30 / np.pi)) for met in diagram.resonances]
    [(5, 3784), (4, 4730)]
    """
    if not case.lumped:
        speeds = None
        if between is not None:
            first, last = ends_of(case, _SPEED, between)
            speeds = np.linspace(first, last, 8)
        return campbell_of(structure_at_rest(case, progress), speeds)
    system, mesh_frequency = build_system(case, progress=progress)
    ends = None if between is None else operation_values("speed", between, case)
    return diagram_of(system, case, mesh_frequency, ends, orders)


def mode_rows(modes: NaturalModes, case: PairCase, mesh_frequency: float) -> list[Mode]:
    """Elastic modes of a case with energy shares by body and spring, and their critical speeds."""
    per_hertz = case.operation.speed / mesh_frequency
    bodies, springs = modes.body_share(), modes.strain_by_kind()
    return [
        Mode(
            number,
            float(modes.frequency[number]),
            float(modes.damping_ratio[number]),
            _describe_shares({name: float(share[number]) for name, share in bodies.items()}),
            _describe_shares({name: float(share[number]) for name, share in springs.items()}),
            tuple(per_hertz * float(modes.frequency[number]) / order for order in ORDERS),
        )
        for number in range(modes.rigid, modes.frequency.size)
    ]


def _describe_shares(shares: dict[str, float]) -> str:
    largest = sorted(shares.items(), key=lambda item: -item[1])
    return ", ".join(f"{name} {100 * share:.0f} %" for name, share in largest if share >= _LEAST)


def modes_at_rest(
    case: MachineCase, progress: Progress = SILENT
) -> tuple[MachineModes, tuple[MeshOrder, ...]]:
    """Natural modes of a machine at its operating point, and what the meshes strain of them."""
    modes = machine_modes(structure_at_rest(case, progress))
    return modes, mesh_orders(modes)
