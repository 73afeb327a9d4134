"""What the results of machines and of planetary stages share: summary, sources, tables."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from tribodyn.record import html_table
from tribodyn.study.pipeline.result import Result
from tribodyn.study.pipeline.summary_figures import summary_rows

if TYPE_CHECKING:
    from tribodyn.study.case.provenance import Assumption
    from tribodyn.study.faults.sensors import Sensors


class PartsResult:
    """Result of a case of parts at its operating point and under its load cases."""

    case: Any
    operation: Any
    load_cases: tuple[Any, ...]
    recording: ClassVar[Any] = Result.recording

    @property
    def _sensors(self) -> Sensors:
        sensors: Sensors = self.case._sensors
        return sensors

    @property
    def motion(self) -> Any:
        """Motion at the operating point."""
        return self.operation.motion

    @cached_property
    def _summary(self) -> dict[str, float]:
        figures = dict(self.operation.figures)
        for each in self.load_cases:
            prefix = f"load_cases.{each.load.name}"
            figures |= {f"{prefix}.{key}": value for key, value in each.figures.items()}
        return figures

    def summary(self) -> dict[str, float]:
        """All figures in SI by dotted key; those of load cases begin with ``load_cases.NAME.``."""
        return dict(self._summary)

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """What was assumed because the case does not give it."""
        assumptions: tuple[Assumption, ...] = self.case.assumptions
        return assumptions

    def cite(self, style: str = "text") -> str:
        """Name the papers behind this result, as ``"text"`` or ``"bibtex"``."""
        from tribodyn.study.pipeline.citations import cite

        return cite(self.case, style)

    def to_xarray(self) -> Any:
        """Motion at the operating point with units."""
        return self.motion.to_xarray()

    def rows(self) -> list[tuple[str, str, str, str]]:
        """Topic, key, value with unit and meaning of each figure of the summary."""
        return summary_rows(self._summary)

    def _repr_html_(self) -> str:
        """Table of the summary by part for notebooks."""
        return html_table(repr(self), ("part", "figure", "value", "meaning"), self.rows())
