"""Where the contact of a hypoid pair moves, and how it transmits, with displaced gears."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, fields

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear.hypoid.flank import HypoidFlanks
from tribodyn.gear.hypoid.tooth_contact import Misalignment, ToothContact, tooth_contact
from tribodyn.record import Record, quantity, record
from tribodyn.types import Array

_CASES = ("case",)


@record
class MisalignmentStudy(Record):
    """Tooth contact of a hypoid pair for displaced gears; made by :func:`misalignment_study`.

    Parameters
    ----------
    offset, pinion_axial, wheel_axial : array (case,) [m]
        Displacements V, H and J, see :class:`Misalignment`.
    shaft_angle : array (case,) [rad]
        Change of the shaft angle.
    along, across : array (case,) [m]
        Mean place of the contact on the wheel, along and across its pitch cone.
    along_range : array (case,) [m]
        Length of the path of contact along the pitch cone.
    peak_to_peak : array (case,) [rad]
        Transmission error of the running pair without load.
    edge_share : array (case,)
        Part of the mesh cycle in which an edge touches.
    contacts : tuple of ToothContact
        The contact of each case.
    """

    offset: Array = quantity(*_CASES, unit="m")
    pinion_axial: Array = quantity(*_CASES, unit="m")
    wheel_axial: Array = quantity(*_CASES, unit="m")
    shaft_angle: Array = quantity(*_CASES, unit="rad")
    along: Array = quantity(*_CASES, unit="m")
    across: Array = quantity(*_CASES, unit="m")
    along_range: Array = quantity(*_CASES, unit="m")
    peak_to_peak: Array = quantity(*_CASES, unit="rad")
    edge_share: Array = quantity(*_CASES, unit="1")
    contacts: tuple[ToothContact, ...] = field()

    def __repr__(self) -> str:
        """One line."""
        low, high = 1e6 * self.peak_to_peak.min(), 1e6 * self.peak_to_peak.max()
        return f"MisalignmentStudy({self.along.size} cases, {low:.3g} to {high:.3g} urad)"


def misalignment_study(
    flanks: HypoidFlanks,
    misalignments: Sequence[Misalignment],
    *,
    exact: bool = False,
    marking_thickness: float = 6.35e-6,
) -> MisalignmentStudy:
    """Contact pattern, path of contact and transmission error for displaced gears.

    Parameters
    ----------
    flanks : HypoidFlanks
        The flanks with their ease-off.
    misalignments : sequence of Misalignment
        Displacements of both gears, one for each case.
    exact, marking_thickness
        As :func:`tooth_contact` takes them [m].

    Raises
    ------
    InputError
        If there is no case, or one is no misalignment.
    ComputationError
        If the flanks do not touch in a case.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
    >>> blank = hypoid_blank(10, 43, 31.7e-3, 0.336, 47.7e-3, math.radians(46.0), 0.1143)
    >>> flanks = hypoid_flanks(blank, ease_off=EaseOff(lengthwise_crowning=60e-6,
    ...                                                profile_crowning=20e-6))
    >>> study = misalignment_study(flanks, [Misalignment(), Misalignment(offset=50e-6)])
    >>> [round(1e3 * place, 1) for place in study.along.tolist()]
    [0.0, -0.9]
    """
    cases = tuple(misalignments)
    if not cases or not all(isinstance(case, Misalignment) for case in cases):
        why = "It is one Misalignment for each case"
        remedy = "Give for example [Misalignment(), Misalignment(offset=50e-6)]"
        raise InputError("no list of misalignments", Argument("misalignments"), why, remedy)
    contacts = tuple(
        tooth_contact(flanks, case, exact=exact, marking_thickness=marking_thickness)
        for case in cases
    )
    led = [(c.along[c.leads], c.across[c.leads], c.on_edge[c.leads]) for c in contacts]
    names = [each.name for each in fields(Misalignment)]
    return MisalignmentStudy(
        **{name: np.array([getattr(case, name) for case in cases]) for name in names},
        along=np.array([along.mean() for along, _, _ in led]),
        across=np.array([across.mean() for _, across, _ in led]),
        along_range=np.array([np.ptp(along) for along, _, _ in led]),
        peak_to_peak=np.array([contact.peak_to_peak for contact in contacts]),
        edge_share=np.array([edge.mean() for _, _, edge in led]),
        contacts=contacts,
    )
