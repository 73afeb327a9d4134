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
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tribodyn.cases import cases, load_case, load_result, run, warm_up
    from tribodyn.errors import ComputationError, InputError, ModelWarning
    from tribodyn.study import (
        Case,
        Result,
        basins,
        bifurcation,
        build_system,
        campbell,
        compare_results,
        comprehensive_stiffness,
        continuation,
        ensemble,
        film_over_operation,
        friction_experiment,
        harris_map,
        kinematic_frequencies,
        loaded_contact,
        loss_map,
        lyapunov_exponents,
        natural_modes,
        operating_data,
        optimize_lead,
        optimize_tip_relief,
        rig_power_flow,
        run_up,
        sobol_indices,
        speed_sweep,
        sweep,
        vibration_data,
    )
    from tribodyn.variants import open_study, run_study

__version__ = "0.2.0"

__all__ = [
    "Case",
    "ComputationError",
    "InputError",
    "ModelWarning",
    "Result",
    "__version__",
    "basins",
    "bifurcation",
    "build_system",
    "campbell",
    "cases",
    "compare_results",
    "comprehensive_stiffness",
    "continuation",
    "ensemble",
    "film_over_operation",
    "friction_experiment",
    "harris_map",
    "kinematic_frequencies",
    "load_case",
    "load_result",
    "loaded_contact",
    "loss_map",
    "lyapunov_exponents",
    "natural_modes",
    "open_study",
    "operating_data",
    "optimize_lead",
    "optimize_tip_relief",
    "rig_power_flow",
    "run",
    "run_study",
    "run_up",
    "sobol_indices",
    "speed_sweep",
    "sweep",
    "vibration_data",
    "warm_up",
]

#: Package that defines a public name, if not ``study``.
_ELSEWHERE = {
    "ComputationError": "errors",
    "InputError": "errors",
    "ModelWarning": "errors",
    "load_case": "cases",
    "load_result": "cases",
    "open_study": "variants",
    "run": "cases",
    "run_study": "variants",
    "warm_up": "cases",
}

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
    if name in __all__:
        return getattr(import_module(f"{__name__}.{_ELSEWHERE.get(name, 'study')}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Public names and packages."""
    return sorted({*__all__, *_PACKAGES})


if "IPython" in sys.modules:
    import_module(f"{__name__}.notebook").prepare(sys.modules["IPython"].get_ipython())
