"""Band of impacts of a channel, and the frequencies with which they come."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np

from tribodyn.errors import ComputationError, InputError
from tribodyn.measurement.shaft_speed import ShaftSpeed
from tribodyn.signals.cepstrum import lifter
from tribodyn.signals.cyclic_coherence import CyclicCoherence, cyclic_coherence
from tribodyn.signals.kurtogram import Kurtogram, kurtogram
from tribodyn.types import Array

#: Orders of the shaft up to which modulations are searched, and turns of the record for it.
_ORDERS, _TURNS = 8.5, 20.0
#: Least order of a modulation: below it the speed and the load wander.
_LEAST = 0.25
#: Coherence of a rate over that of its strongest harmonic, at least.
_PART = 0.3


def impacts_of(
    values: Array, rate: float, shaft: ShaftSpeed | None, mesh_frequency: float | None
) -> dict[str, Any]:
    """Kurtogram of a channel, and cyclic coherence of its turns without the mesh."""
    parts: dict[str, Any] = {}
    with suppress(InputError, ComputationError):  # too short
        parts["kurtogram"] = kurtogram(values, rate)
    if shaft is None or shaft.varies:
        return parts
    turn = shaft.mean / (2.0 * np.pi)
    used = values[: round(_TURNS / turn * rate)]
    step = 0.5 * rate / used.size
    rates = np.arange(max(_LEAST * turn, 4.5 * rate / used.size), _ORDERS * turn, step)
    with suppress(InputError, ComputationError):
        quiet = (
            used if mesh_frequency is None else lifter(used, rate, remove=[1.0 / mesh_frequency])
        )
        parts["coherence"] = cyclic_coherence(quiet, rate, rates[rates < 0.4 * rate])
    return parts


def impact_figures(
    kurtosis: Kurtogram | None, coherence: CyclicCoherence | None
) -> dict[str, float]:
    """Numbers of both in SI."""
    numbers: dict[str, float] = {}
    if kurtosis is not None:
        best = kurtosis.best
        numbers |= {
            "kurtogram_centre": float(kurtosis.centre[best]),
            "kurtogram_bandwidth": float(kurtosis.width[best]),
            "kurtogram_kurtosis": float(kurtosis.kurtosis[best]),
            "kurtogram_limit": float(kurtosis.limit[best]),
        }
    if coherence is not None:
        band = None if kurtosis is None or not kurtosis.significant else kurtosis.band
        mean = coherence.enhanced_envelope_spectrum(band)
        strongest = _fundamental(coherence.cyclic_frequency, mean)
        numbers |= {
            "coherence_frequency": float(coherence.cyclic_frequency[strongest]),
            "coherence": float(mean[strongest]),
            "coherence_of_noise": 1.0 / coherence.blocks,
        }
    return numbers


def _fundamental(rates: Array, mean: Array) -> int:
    """Index of the largest coherence, or of the rate of which it is a harmonic."""
    peak = int(np.argmax(mean))
    for harmonic in (4, 3, 2):
        candidates = np.flatnonzero(np.abs(rates - rates[peak] / harmonic) <= rates[1] - rates[0])
        if candidates.size and mean[candidates].max() > _PART * mean[peak]:
            return int(candidates[np.argmax(mean[candidates])])
    return peak
