"""Result of a pair of gears: its motion, summary and files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from inspect import signature
from typing import TYPE_CHECKING, NoReturn

from tribodyn.nomenclature import PAIR_MESH
from tribodyn.record import Parts, record
from tribodyn.study.coupling import Coupling
from tribodyn.study.faults.sensors import PairSensors
from tribodyn.study.pipeline.result_of_case import Result
from tribodyn.study.pipeline.store import MOTIONS
from tribodyn.study.pipeline.stored_motion import parts_of, stored, to_csv
from tribodyn.study.pipeline.summary import summarize

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, NaturalModes, Response, System
    from tribodyn.errors import ModelWarning
    from tribodyn.mesh import MeshFriction, MeshTable
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.faults.motion import TurningMotion
    from tribodyn.study.heat_balance import HeatBalance
    from tribodyn.study.pipeline.assembly import Damping
    from tribodyn.study.rating import RatedMesh


@record
class PairResult(Result):
    """What :func:`tribodyn.run` returns for a pair of gears.

    Parameters
    ----------
    case : PairCase
        What was computed.
    mesh : MeshTable
        The tooth contact over one mesh cycle.
    system : System
        The structure and its contact.
    response : Response
        Its motion.
    damping : Damping
        Damping in force [N*s/m].
    warnings : tuple of ModelWarning
        Warnings of the models.
    friction : MeshFriction, optional
        Friction over the load, where it follows the dynamic load of the teeth.
    nominal_friction_response : Response, optional
        The motion with the friction of the nominal load, to compare with.
    coupling : Coupling, optional
        Convergence of load, film, friction and stiffness, if ``solver.coupling`` is set.
    heat : HeatBalance, optional
        Heat balance of gears and oil, if ``lubricant.heat_transfer`` is given.
    """

    _MESH = PAIR_MESH
    _MOTION = MOTIONS[1]
    _COMPARISON = "result_comparison"

    case: PairCase
    mesh: MeshTable
    system: System
    response: Response
    damping: Damping
    warnings: tuple[ModelWarning, ...]
    friction: MeshFriction | None = None
    nominal_friction_response: Response | None = None
    coupling: Coupling | None = None
    heat: HeatBalance | None = None

    @cached_property
    def figures(self) -> dict[str, float]:
        """All figures of the motion, in SI."""
        return summarize(self)

    @property
    def loads(self) -> Mapping[str, PairResult]:
        """The result by its load, which is that of ``[operation]``."""
        return {"operation": self}

    @property
    def tables(self) -> Mapping[str, MeshTable]:
        """Tooth contact by the name of the mesh; a pair has the mesh ``"mesh"``."""
        return {self._MESH: self.mesh}

    @property
    def _pair(self) -> PairCase:
        return self.case

    @cached_property
    def natural_modes(self) -> NaturalModes:
        """Natural modes about the static load, contacts closed, friction left out."""
        from tribodyn.dynamics import natural_modes

        return natural_modes(self.system)

    @cached_property
    def campbell(self) -> Campbell:
        """Natural frequencies and mesh harmonics over the speed, with the stiffness of this one."""
        from tribodyn.study.pipeline.assembly import diagram_of

        return diagram_of(self.system, self.case, self.mesh.mesh_frequency)

    @cached_property
    def turning_motion(self) -> TurningMotion:
        """Motion over whole turns of the gears, with faults and deviations of single teeth."""
        from tribodyn.study.faults.motion import turning_motion

        return turning_motion(self)

    @property
    def turns(self) -> TurningMotion | None:
        """Motion over whole turns; None where all teeth of a gear are equal."""
        from tribodyn.study.faults.clock import varies_over_turns

        return self.turning_motion if varies_over_turns(self.case) else None

    def _rated(self) -> tuple[Iterable[RatedMesh], None]:
        from tribodyn.study.rating import rated_pair

        return rated_pair(self), None

    @property
    def _sensors(self) -> PairSensors:
        """What there is to sense."""
        return PairSensors(self.response.names)

    def _parts(self) -> Parts:
        """Parts of the motion, ramps of a force law as one contact, and the summary."""
        return parts_of(self)

    def _stored(self) -> Parts:
        """What a file holds of the motion: of a long run the last mesh cycles."""
        return stored(self)

    def to_csv(self) -> str:
        """Write the series of the motion as comma-separated values in SI.

        Returns
        -------
        str
            One line for each step; units are in brackets in the first line.
        """
        return to_csv(stored(self))

    def __reduce__(self) -> NoReturn:
        """Refuse to be pickled: a result holds functions of the models."""
        raise TypeError("a Result cannot be pickled; keep it with save(), or pass its case")

    @property
    def _headline(self) -> str:
        """Chief figures in one line."""
        figures = self._summary
        swing = figures["peak_to_peak_dynamic_transmission_error"] * 1e6
        return (
            f"peak mesh force {figures['peak_mesh_force']:.5g} N, "
            f"transmission error {swing:.4g} um peak to peak, {len(self.warnings)} warnings"
        )


#: What help and signature display of the class of every kind.
Result.__signature__ = signature(PairResult)
