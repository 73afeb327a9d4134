"""Gear tribo-dynamics: from gear and lubricant data to tooth contact, friction and vibration.

>>> import tribodyn as td
>>> case = td.load_case("fzg-roughness")
>>> case.gears.wheel.teeth
24

Everything is loaded when it is first used: the names below, and the packages ``gear``, ``contact``,
``lubricant``, ``ehl``, ``friction``, ``losses``, ``stiffness``, ``mesh``, ``dynamics``,
``machine``, ``rating``, ``analysis``, ``measurement``, ``uncertainty``,
``exchange``, ``study``, ``cases``, ``cookbook``, ``variants``, ``plot`` and ``report``.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any

from tribodyn.aliases import names_of_stub

__version__ = "0.2.0"

#: Packages that define the public names.
_HOMES = names_of_stub(__file__)

__all__ = sorted(["__version__", *_HOMES])

_PACKAGES = (
    "analysis", "cases", "contact", "cookbook", "dynamics", "ehl", "errors", "exchange",
    "faults", "friction", "gear", "losses", "lubricant", "machine", "measurement", "mesh",
    "nomenclature", "plot", "progress", "rating", "report", "stiffness", "study", "surrogate",
    "uncertainty", "units", "variants",
)  # fmt: skip


def __getattr__(name: str) -> Any:
    """Load a public name or a package when it is first used."""
    if name in _PACKAGES:
        return import_module(f"{__name__}.{name}")
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Public names and packages."""
    return sorted({*__all__, *_PACKAGES})


if "IPython" in sys.modules:
    import_module(f"{__name__}.notebook").prepare(sys.modules["IPython"].get_ipython())
