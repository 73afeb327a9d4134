"""What do the angle and the order map of a long run-up cost, beside resampling over the angle?

The rival resamples the record to even angles by ``numpy.interp`` and takes windowed spectra of
SciPy, which folds what lies above its orders; ours folds nothing.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from scipy.signal import ShortTimeFFT

from race import arguments
from tribodyn.measurement import order_map, shaft_angle, synthetic_run_up
from tribodyn.types import Array

#: Sampling rate [Hz], orders, and revolutions of a block.
RATE, ORDERS, BLOCK = 50_000.0, 100, 8


def main(words: Sequence[str] | None = None) -> None:
    """Print seconds of the processor for the angle, our map and the rival's."""
    quick = arguments(__doc__, words).quick
    lasts = 2.0 if quick else 60.0
    run = synthetic_run_up(
        {1: 1.0, 29: 2.0}, (0.0, 314.159, 0.0), duration=lasts, sample_rate=RATE, jitter=0.01
    )
    warm = run.cut(0.25 * lasts, 0.25 * lasts + 1.0)
    order_map(warm["signal"], warm["angle"], ORDERS, RATE)  # what is compiled once
    angle = timed("shaft angle", lambda: shaft_angle(run["tacho"], RATE, 60))
    ours = timed("order map", lambda: order_map(run["signal"], angle, ORDERS, RATE).cut(29))
    rival = timed("resampled and transformed", lambda: resampled(run["signal"], angle))
    middle = slice(len(ours.amplitude) // 4, -len(ours.amplitude) // 4)
    print(f"order 29 is 2: ours {np.median(ours.amplitude[middle]):.4f}, {np.median(rival):.4f}")


def resampled(signal: Array, angle: Array) -> Array:
    """Amplitude of order 29 over the blocks of a record with even angles."""
    per = 4 * ORDERS
    even = np.arange(angle[0], angle[-1], 2.0 * np.pi / per)
    window = np.hanning(BLOCK * per + 1)[:-1]
    transform = ShortTimeFFT(window, BLOCK * per // 4, per, scale_to="magnitude")
    found = np.abs(transform.stft(np.interp(even, angle, signal)))
    return np.asarray(2.0 * found[29 * BLOCK])


def timed(words: str, compute: object) -> object:
    """Print seconds of the processor and of the clock, and return what was computed."""
    start = time.perf_counter(), time.process_time()
    found = compute()  # type: ignore[operator]
    wall, processor = time.perf_counter() - start[0], time.process_time() - start[1]
    print(f"{words:28} {processor:8.3f} s of the processor, {wall:8.3f} s by the clock")
    return found


if __name__ == "__main__":
    main()
