"""Effect of spread inputs on forces and motion: a mesh cycle of many variants, with bands."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import draw as draw_figure
from tribodyn.drawing import figures_of
from tribodyn.errors import Argument, InputError, quiet, require_one_of
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record, fact, quantity, record
from tribodyn.study.uncertain.cycles import SIGNALS, steady_cycles
from tribodyn.study.uncertain.lanes import draw, lanes_of, points_of_values, successful
from tribodyn.types import Array, Texts
from tribodyn.uncertainty import Band, bootstrap_band

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase
    from tribodyn.study.pipeline.result import PairResult
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

    input: Texts = quantity("input", axis=True, unit="", name="input")
    value: Array = quantity("variant", "input", unit="")
    figure: Texts = quantity("figure", axis=True, unit="", name="figure")
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
        return draw_figure(self, figure)

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


#: Phases of a mesh cycle, and largest number of variants whose full results are computed.
_PHASES, _MAX_RESULTS = 256, 32


@record
class CaseEnsemble(Record):
    """Variants of a case over one mesh cycle of their steady motion.

    Parameters
    ----------
    input : (k,) array of str
        Keys of the case, or factors, that were spread.
    value : (n, k) array
        Sampled values, in SI.
    phase : (p,) array
        Mesh phase.
    mesh_frequency : (n,) array
        Mesh frequency [Hz].
    mesh_force : (n, p) array
        Force along the line of action [N].
    dynamic_transmission_error : (n, p) array
        Compression of the mesh with its error, from the middle of the play [m].
    acceleration : (n, p) array
        Acceleration of the smaller gear along the line of action [m/s^2].
    seed : int
        Of the sample, and of the bands.
    title : str
        Title of the case.
    case : PairCase, optional
        The case whose inputs are spread.
    """

    input: Texts = quantity("input", axis=True, unit="", name="input")
    value: Array = quantity("variant", "input", unit="")
    phase: Array = quantity("phase", axis=True, unit="1")
    mesh_frequency: Array = quantity("variant", unit="Hz")
    mesh_force: Array = quantity("variant", "phase", unit="N")
    dynamic_transmission_error: Array = quantity("variant", "phase", unit="m")
    acceleration: Array = quantity("variant", "phase", unit="m/s^2")
    seed: int = fact()
    title: str = fact()
    case: PairCase | None = None

    @cached_property
    def results(self) -> tuple[PairResult, ...]:
        """Full results at the median of all inputs, and of up to 32 variants evenly among all.

        Raises
        ------
        InputError
            If an input is a factor and no key of a case, so that its variants are no cases.
        """
        from tribodyn.study.pipeline.run import computed
        from tribodyn.study.studies.runner import run_each

        keys = [str(key) for key in self.input]
        factors = [key for key in keys if "." not in key]
        if self.case is None or factors:
            why = f"{', '.join(factors) or 'It'}: of no case"
            raise InputError("no full results of this ensemble", "", why, "Spread keys")
        count = len(self.value)
        chosen = np.unique(np.linspace(0, count - 1, min(count, _MAX_RESULTS)).round().astype(int))
        # The case has its own values; other spread inputs are at the median of the sample.
        medians = zip(keys, np.median(self.value, axis=0), strict=True)
        middle = {key: float(value) for key, value in medians if key not in self.case.uncertain}
        rows = [dict(zip(keys, map(float, row), strict=True)) for row in self.value[chosen]]
        cases = [self.case.replace(row) if row else self.case for row in (middle, *rows)]
        with quiet():
            return tuple(run_each(computed, cases))

    def plot(self, name: str = "", *arguments: object, **options: object) -> Any:
        """Draw the spread of the motion, or any figure of a run with bands of the variants.

        Parameters
        ----------
        name : str
            Figure of a run, such as ``"mesh_stiffness"``; empty: force, transmission error and
            spectrum of all variants.
        *arguments, **options
            Of that figure.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        is_figure = not name or name in figures_of(self)
        if not is_figure:
            return draw_figure(self, "bands", name)
        return draw_figure(self, name or "ensemble", *arguments, **options)

    def figures(self) -> dict[str, Array]:
        """Figures of the summary of every full result, in SI.

        Returns
        -------
        dict of str to (n,) array
            First that at the median of all inputs, then those of the variants.
        """
        summaries = [result.summary() for result in self.results]
        shared = [name for name in summaries[0] if all(name in other for other in summaries)]
        return {name: np.array([figures[name] for figures in summaries]) for name in shared}

    def spectrum(self, signal: str = "mesh_force", harmonics: int = 10) -> Array:
        """Amplitudes of the mesh harmonics of every variant.

        Parameters
        ----------
        signal : str
            ``"mesh_force"``, ``"dynamic_transmission_error"`` or ``"acceleration"``.
        harmonics : int
            Number of harmonics.

        Returns
        -------
        (n, harmonics) array
            Peak amplitudes, in the unit of the signal.

        Raises
        ------
        InputError
            If there is no such signal, or there are more harmonics than places resolve.
        """
        values = self._signal(signal)
        count = require_whole("harmonics", harmonics)
        if count >= self.phase.size // 2:
            what, why = f"harmonics = {count}", f"There are {self.phase.size} places in a cycle"
            raise InputError(what, Argument("harmonics"), why, "Request fewer")
        lines = np.fft.rfft(values, axis=1)[:, 1 : count + 1]
        return np.asarray(2.0 * np.abs(lines) / self.phase.size)

    def band(
        self,
        signal: str = "mesh_force",
        level: float = 0.95,
        *,
        harmonics: int = 0,
        simultaneous: bool = False,
    ) -> Band:
        """Confidence band of the mean over the variants, by the bootstrap.

        Parameters
        ----------
        signal : str
            As of :meth:`spectrum`.
        level : float
            Probability that the band holds the true mean [-].
        harmonics : int
            Of so many harmonics; 0: of the curve over the mesh phase.
        simultaneous : bool
            Whether the band holds the whole curve with that probability, not each point of it.

        Raises
        ------
        InputError
            If there is no such signal, or there are fewer than three variants.
        """
        values = self.spectrum(signal, harmonics) if harmonics else self._signal(signal)
        return bootstrap_band(
            values, level, seed=self.seed, simultaneous=simultaneous, unit=SIGNALS[signal]
        )

    def spread(self, signal: str = "mesh_force", level: float = 0.95, harmonics: int = 0) -> Array:
        """Interval that contains a given share of the variants, point by point.

        Parameters
        ----------
        signal : str
            As of :meth:`spectrum`.
        level : float
            Share of the variants between both ends [-].
        harmonics : int
            As of :meth:`band`.

        Returns
        -------
        (2, points) array
            Lower and upper end, in the unit of the signal.
        """
        values = self.spectrum(signal, harmonics) if harmonics else self._signal(signal)
        ends = (0.5 - 0.5 * level, 0.5 + 0.5 * level)
        return np.asarray(np.quantile(values, ends, axis=0))

    def _signal(self, name: str) -> Array:
        names = ("mesh_force", "dynamic_transmission_error", "acceleration")
        return np.asarray(getattr(self, require_one_of("signal", name, names)))

    def __repr__(self) -> str:
        """One line."""
        mean = self.mesh_force.max(axis=1)
        return (
            f"CaseEnsemble({len(self.value)} variants over {', '.join(self.input)}: peak mesh "
            f"force {mean.min():.5g} to {mean.max():.5g} N)"
        )


def ensemble(
    case: AnyCase,
    distributions: Mapping[str, object] | None = None,
    size: int = 64,
    *,
    method: str = "latin-hypercube",
    seed: int,
    progress: Progress = SILENT,
) -> CaseEnsemble | MachineEnsemble:
    """Compute many variants of a case with spread inputs in one batch.

    Parameters
    ----------
    case : Case
        From :func:`tribodyn.load_case`.
    distributions : mapping, optional
        Inputs that are spread, as :func:`tribodyn.uncertainty.sample` reads them: keys of the
        case, or the factors ``stiffness_scale``, ``damping_scale``, ``friction_scale``,
        ``error_scale``, ``gap_scale`` and ``force_scale`` [-]. By default those that the case
        itself spreads.
    size : int
        Variants.
    method : {"monte-carlo", "latin-hypercube", "sobol"}
        Sampling method.
    seed : int
        The same seed gives the same ensemble.
    progress : Progress
        Receives the progress of the computation; silent by default.

    Returns
    -------
    CaseEnsemble or MachineEnsemble
        Mesh cycles of all variants of a pair; the figures of the summary of all variants of a
        machine at its operating point, which takes keys but no factors.

    Raises
    ------
    InputError
        If nothing is spread, or an input cannot be.
    ComputationError
        If a variant grows beyond all bounds.

    Warns
    -----
    ModelWarning
        ``ensemble-period`` if variants do not repeat after one mesh cycle; ``ensemble-failed`` if
        variants of a machine cannot be computed.

    Notes
    -----
    Variants share one structure if they differ in factors, in the coefficient of constant
    friction, in mesh damping, in the speed if neither film nor friction depends on it, or in the
    torque if the tooth contact is the same for the least and the greatest one. For any other key
    the tooth contact of every variant is computed.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("time-varying-friction")
    >>> variants = ensemble(case, {"stiffness_scale": "1 +- 2 %"}, 8, seed=1)
    >>> variants.mesh_force.shape
    (8, 256)
    """
    spread = dict(case.uncertain if distributions is None else distributions)
    if not spread:
        why, remedy = "", 'Give {"friction.coefficient": "0.05 +- 0.83 %"}'
        raise InputError("nothing is spread", Argument("distributions"), why, remedy)
    values = draw(case, spread, require_whole("size", size, 3), method=method, seed=seed)
    if not case.lumped:
        return _of_machine(case, values, int(seed), progress)
    lanes = lanes_of(case, values, progress)
    signals = steady_cycles(lanes, _PHASES, progress)
    return CaseEnsemble(
        input=np.array(list(values)),
        value=np.stack(list(values.values()), axis=1),
        phase=signals.phase,
        mesh_frequency=lanes.mesh_frequency,
        mesh_force=signals.signals["mesh_force"],
        dynamic_transmission_error=signals.signals["dynamic_transmission_error"],
        acceleration=signals.signals["acceleration"],
        seed=int(seed),
        title=case.title,
        case=case,
    )


def _of_machine(
    case: MachineCase, values: Mapping[str, Array], seed: int, progress: Progress
) -> MachineEnsemble:
    """Figures of a machine or a stage at the median of the values, and at each of them."""
    medians = {key: float(np.median(column)) for key, column in values.items()}
    middle = {key: case[key] if key in case.uncertain else medians[key] for key in values}
    columns = {key: np.append(middle[key], column) for key, column in values.items()}
    progress.start("Variants", len(next(iter(columns.values()))))
    points = points_of_values(case, columns, progress)
    progress.finish()
    return ensemble_of(points, values, seed, case.title)
