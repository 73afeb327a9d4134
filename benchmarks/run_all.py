"""All benchmarks, one report."""

from __future__ import annotations

import importlib
from collections.abc import Sequence

from race import arguments

__all__ = ["SCRIPTS", "main"]

SCRIPTS = (
    "ensemble_speed",
    "equal_accuracy",
    "operating_map",
    "steady_state_speed",
    "speed_sweep",
    "steady_state_cycles",
    "machine_speed",
    "planetary_speed",
    "bifurcation_speed",
    "parameter_map",
    "gpu_speed",
    "film_speed",
    "film_batch",
    "friction_speed",
    "friction_experiment",
    "losses_speed",
    "fe2d_speed",
    "stiffness_speed",
    "fault_speed",
    "phase_speed",
    "helical_speed",
    "learning_speed",
    "signals_speed",
    "rating_speed",
    "study_speed",
    "hypoid_speed",
    "point_contact_speed",
    "geared_rotors",
    "cold_start",
)


def main(words: Sequence[str] | None = None) -> None:
    """Run every script in turn.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    own = ["--quick"] if arguments(__doc__, words).quick else []
    for script in SCRIPTS:
        print(f"{'=' * 100}\n")
        importlib.import_module(script).main(own)


if __name__ == "__main__":
    main()
