"""Result of a case: summary, figures, files and citations."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from tribodyn.drawing import write_report_of
from tribodyn.errors import collected
from tribodyn.record import Parts, html_table, record
from tribodyn.study.case.hypoid import mounting
from tribodyn.study.case.provenance import Assumption, assumptions
from tribodyn.study.faults.sensors import PairSensors
from tribodyn.study.pipeline.computed import Computed
from tribodyn.study.pipeline.parts_result import ResultOfCase
from tribodyn.study.pipeline.response_series import parts_of, stored, to_csv
from tribodyn.study.pipeline.save import new_directory
from tribodyn.study.pipeline.summary import summarize
from tribodyn.study.pipeline.summary_labels import in_words
from tribodyn.validated_files import write_dataset

if TYPE_CHECKING:
    from tribodyn.dynamics import Campbell, NaturalModes
    from tribodyn.gear import ToothContact
    from tribodyn.mesh import HypoidFriction, MeshTable
    from tribodyn.study.faults.motion import TurningMotion


@record
class Result(ResultOfCase, Computed):
    """What :func:`tribodyn.run` returns.

    Every figure that draws a run is a method: ``result.plot_mesh_force()``.

    Parameters
    ----------
    case : Case
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

    _MESH = "mesh"
    _COMPARISON = "result_comparison"

    @cached_property
    def figures(self) -> dict[str, float]:
        """All figures of the motion, in SI."""
        return summarize(self)

    @property
    def loads(self) -> Mapping[str, Result]:
        """The result by its load, which is that of ``[operation]``."""
        return {"operation": self}

    @property
    def tables(self) -> Mapping[str, MeshTable]:
        """Tooth contact by the name of the mesh; a pair has the mesh ``"mesh"``."""
        return {self._MESH: self.mesh}

    @property
    def signals(self) -> Any:
        """Series of the motion with units, as :meth:`to_xarray`."""
        return self.to_xarray()

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """Values that were assumed or are defaults, each with its reason."""
        return assumptions(self.case)

    @cached_property
    def hypoid_contact(self) -> ToothContact | None:
        """Tooth contact of a hypoid pair without load; None of other gears."""
        from tribodyn.gear import tooth_contact

        flanks = self.case.hypoid_flanks
        return None if flanks is None else tooth_contact(flanks, mounting(self.case.gears))

    @cached_property
    def hypoid_friction(self) -> HypoidFriction | None:
        """Load, film and friction in every cell of a hypoid pair at rest; None of other gears."""
        from tribodyn.study.mesh_inputs import mesh_inputs
        from tribodyn.study.pipeline.tooth_contact import hypoid_friction_of

        with collected():  # The run has raised the warnings.
            crossed = self.case.hypoid_flanks is not None
            return hypoid_friction_of(mesh_inputs(self.case)) if crossed else None

    @cached_property
    def natural_modes(self) -> NaturalModes:
        """Natural modes about the static load, contacts closed, friction left out."""
        from tribodyn.dynamics import natural_modes

        return natural_modes(self.system)

    @cached_property
    def campbell(self) -> Campbell:
        """Natural frequencies and mesh harmonics over the speed, with the stiffness of this one."""
        from tribodyn.study.studies.modes import diagram_of

        return diagram_of(self.system, self.case, self.mesh.mesh_frequency)

    @cached_property
    def turning_motion(self) -> TurningMotion:
        """Motion over whole turns of the gears, with faults and deviations of single teeth."""
        from tribodyn.study.faults.motion import turning_motion

        return turning_motion(self)

    @property
    def turns(self) -> TurningMotion | None:
        """Motion over whole turns; None where all teeth of a gear are alike."""
        from tribodyn.study.faults.clock import varies_over_turns

        return self.turning_motion if varies_over_turns(self.case) else None

    @property
    def _sensors(self) -> PairSensors:
        """What there is to sense."""
        return PairSensors(self.response.names)

    def _parts(self) -> Parts:
        """Parts of the motion, ramps of a force law as one contact, and the summary."""
        return parts_of(self, self._summary)

    def to_csv(self) -> str:
        """Write the series of the motion as comma-separated values in SI.

        Returns
        -------
        str
            One line for each step; units are in brackets in the first line.
        """
        return to_csv(stored(self._parts(), self.response))

    def save(
        self, directory: str | os.PathLike[str], *, force: bool = False, csv: bool = False
    ) -> Path:
        """Write case, summary, mesh table, motion and report into a new directory.

        The directory appears complete or not at all; :func:`tribodyn.load_result` reads it. Of a
        long transient the last mesh cycles are stored, as many as 64 MB hold.

        Parameters
        ----------
        directory : str or path
            Directory to make.
        force : bool
            Replace an earlier result there.
        csv : bool
            Write the motion as ``response.csv`` as well.

        Raises
        ------
        OutputExistsError
            If it exists and is not to be replaced, or is no result.
        InputError
            If the place cannot be written to.
        """
        target = Path(directory)
        with new_directory(target, force=force) as place:
            (place / "case.toml").write_text(self.case.to_toml(), encoding="utf-8")
            (place / "summary.json").write_text(_json(self._summary), encoding="utf-8")
            self.mesh.save(place / "mesh.nc")
            write_dataset(stored(self._parts(), self.response), place / "response.nc")
            if csv:
                (place / "response.csv").write_text(self.to_csv(), encoding="utf-8")
            write_report_of(self, place / "report.html")
        return target

    def _repr_html_(self) -> str:
        """Table of the summary by topic for notebooks."""
        rows = [(topic, in_words(name), *rest) for topic, name, *rest in self.rows()]
        return html_table(repr(self), ("topic", "figure", "value", "meaning"), rows)

    def __reduce__(self) -> NoReturn:
        """Refuse to be pickled: a result holds functions of the models."""
        raise TypeError("a Result cannot be pickled; keep it with save(), or pass its case")

    def __repr__(self) -> str:
        """One line."""
        figures = self._summary
        swing = figures["peak_to_peak_dynamic_transmission_error"] * 1e6
        return (
            f'Result("{self.case.title}": peak mesh force {figures["peak_mesh_force"]:.5g} N, '
            f"transmission error {swing:.4g} um peak to peak, {len(self.warnings)} warnings)"
        )


def _json(values: dict[str, float]) -> str:
    return json.dumps(values, indent=2, allow_nan=False) + "\n"
