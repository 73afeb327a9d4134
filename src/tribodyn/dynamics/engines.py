"""Engines by name: how a motion is marched over time, and the options of each way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tribodyn.dynamics.time.engines import Method
from tribodyn.model import Model, Registry, number


@dataclass(frozen=True)
class Engine(Model):
    """A way to march over time.

    Parameters
    ----------
    name : str
        Name in a case file.
    method : str
        Its name in :func:`tribodyn.dynamics.simulate`.
    options : mapping of str to Option or default
        Its options; ``argument`` of each is the argument of that function.
    meaning : str
        One line for whoever chooses an engine.
    papers : tuple of str
        Keys of the bibliography of the package.
    source : str
        Where the engine comes from, of those without such a key.

    Examples
    --------
    >>> ENGINES["newmark"].arguments({"gamma": 0.5, "beta": 0.25})
    {'method': 'newmark', 'gamma': 0.5, 'beta': 0.25}
    """

    name: str
    method: Method
    options: Mapping[str, Any] = field(default_factory=dict)
    meaning: str = ""
    papers: tuple[str, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        """Keep options and defaults apart."""
        self.declare(self.options)

    def arguments(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Arguments of :func:`tribodyn.dynamics.simulate`.

        Parameters
        ----------
        options : mapping of str to object
            Options of this engine.

        Returns
        -------
        dict of str to object
        """
        named = {self.declared[name].argument or name: value for name, value in options.items()}
        return {"method": self.method, **named}


ENGINES: Registry[Engine] = Registry("engine", model=Engine, part="method")

for _engine in (
    Engine("runge-kutta-4", "rk4", meaning="steps of one length, of fourth order"),
    Engine(
        "dormand-prince",
        "dormand-prince",
        {
            "relative_tolerance": number(
                1e-6, 1e-12, 1e-2, "a double carries 15 digits", argument="rtol",
                meaning="error of each state over its largest size so far", example="1e-6",
            ),
        },
        "steps as long as a tolerance allows, of fifth order",
        ("dormand-prince",),
    ),
    Engine(
        "newmark",
        "newmark",
        {
            "gamma": number(
                0.5, 0.5, 1.0, "below 1/2 it feeds energy in, above 1/2 it damps",
                meaning="weight of the acceleration at the end of a step in the velocity",
                example="0.5",
            ),
            "beta": number(
                0.25, 0.0, 0.5, "from constant to linear acceleration and beyond",
                meaning="weight of the acceleration at the end of a step in the position",
                example="0.25",
            ),
        },
        "implicit steps of one length, of second order: average acceleration",
        ("newmark",),
    ),
):  # fmt: skip
    ENGINES.register(_engine.name)(_engine)
