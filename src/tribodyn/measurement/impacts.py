"""Band of impacts of a channel, and the frequencies with which they come."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.measurement.shaft_speed import ShaftSpeed, attempt
from tribodyn.signals.cepstrum import lifter
from tribodyn.signals.cyclic_coherence import CyclicCoherence, cyclic_coherence
from tribodyn.signals.envelope import Kurtogram, kurtogram
from tribodyn.types import Array, Tree

#: Orders of the shaft up to which modulations are searched, and turns of the record for it.
_ORDERS, _TURNS = 8.5, 20.0
#: Least order of a modulation: below it the speed and the load wander.
_LEAST = 0.25
#: Coherence of a rate over that of its strongest harmonic, at least.
_PART = 0.3


def impacts_of(
    values: Array,
    rate: float,
    shaft: ShaftSpeed | None,
    mesh_frequency: float | None,
    notes: list[Problem],
) -> Tree:
    """Kurtogram of a channel, and cyclic coherence of its turns without the mesh."""
    parts: Tree = {"kurtogram": attempt("kurtogram", lambda: kurtogram(values, rate), notes)}
    if shaft is None or shaft.varies:
        return parts
    turn = shaft.mean / (2.0 * np.pi)
    used = values[: round(_TURNS / turn * rate)]
    step = 0.5 * rate / used.size
    rates = np.arange(max(_LEAST * turn, 4.5 * rate / used.size), _ORDERS * turn, step)

    def coherence() -> CyclicCoherence:
        if not rates.size:
            what = f"the record holds {used.size * turn / rate:.3g} turns of the shaft"
            raise InputError(what, "", "Too few for any modulation", "Record longer")
        quiet = used
        if mesh_frequency is not None and mesh_frequency < 0.5 * rate:
            quiet = lifter(used, rate, remove=[1.0 / mesh_frequency])
        return cyclic_coherence(quiet, rate, rates[rates < 0.4 * rate])

    parts["coherence"] = attempt("cyclic coherence", coherence, notes)
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
        band = _band(kurtosis, coherence)
        mean, limit = coherence.enhanced_envelope_spectrum(band), coherence.noise_limit(band)
        strongest = _fundamental(coherence.cyclic_frequency, mean, limit)
        numbers |= {
            "coherence_frequency": float(coherence.cyclic_frequency[strongest]),
            "coherence": float(mean[strongest]),
            "coherence_of_noise": 1.0 / coherence.blocks,
            "coherence_limit": limit,
        }
    return numbers


def _band(kurtosis: Kurtogram | None, coherence: CyclicCoherence) -> tuple[float, float] | None:
    """Band of impacts; None where there is none, or one narrower than the blocks resolve."""
    if kurtosis is None or not kurtosis.significant:
        return None
    low, high = kurtosis.band
    carriers = (coherence.frequency >= low) & (coherence.frequency <= high)
    return kurtosis.band if coherence.coherence[carriers].any() else None


def _fundamental(rates: Array, mean: Array, limit: float) -> int:
    """Index of the largest coherence, or of the rate of which it is a harmonic."""
    peak = int(np.argmax(mean))
    least = max(_PART * mean[peak], limit)
    for harmonic in (4, 3, 2):
        candidates = np.flatnonzero(np.abs(rates - rates[peak] / harmonic) <= rates[1] - rates[0])
        if candidates.size and mean[candidates].max() > least:
            return int(candidates[np.argmax(mean[candidates])])
    return peak
