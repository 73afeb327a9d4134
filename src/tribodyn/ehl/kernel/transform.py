"""Fourier transform of a power of two inside a compiled kernel.

A library transform would need the interpreter, and with it the lock that keeps threads apart.
Radix-4 passes of Stockham, which need no reordering; real and imaginary parts in arrays of their
own, so that the passes become vector instructions.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.options import INNER
from tribodyn.types import Array


@nb.njit(**INNER)
def twiddles(size: int, table: Array) -> None:
    """Fill ``table[0]`` and ``table[1]`` with cosine and minus sine of 2 pi j/size."""
    for j in range(size):
        # The nearest of the eight directions first: cosine and sine of small angles are exact.
        angle = 2.0 * math.pi * j / size
        table[0, j] = math.cos(angle)
        table[1, j] = -math.sin(angle)


@nb.njit(**INNER)
def _first_pass(size: int, x: Array, y: Array, table: Array) -> None:
    """Radix-4 pass with stride 1."""
    m = size // 4
    xr, xi, yr, yi = x[0], x[1], y[0], y[1]
    for p in range(m):
        ar, ai = xr[p], xi[p]
        br, bi = xr[p + m], xi[p + m]
        cr, ci = xr[p + 2 * m], xi[p + 2 * m]
        dr, di = xr[p + 3 * m], xi[p + 3 * m]
        sr, si, tr, ti = ar + cr, ai + ci, ar - cr, ai - ci
        ur, ui, vr, vi = br + dr, bi + di, bi - di, dr - br
        yr[4 * p], yi[4 * p] = sr + ur, si + ui
        er, ei = tr + vr, ti + vi
        fr, fi = sr - ur, si - ui
        gr, gi = tr - vr, ti - vi
        cosine, sine = table[0, p], table[1, p]
        yr[4 * p + 1] = er * cosine - ei * sine
        yi[4 * p + 1] = er * sine + ei * cosine
        cosine, sine = table[0, 2 * p], table[1, 2 * p]
        yr[4 * p + 2] = fr * cosine - fi * sine
        yi[4 * p + 2] = fr * sine + fi * cosine
        cosine, sine = table[0, 3 * p], table[1, 3 * p]
        yr[4 * p + 3] = gr * cosine - gi * sine
        yi[4 * p + 3] = gr * sine + gi * cosine


@nb.njit(**INNER)
def _pass(m: int, stride: int, x: Array, y: Array, table: Array) -> None:
    """Radix-4 pass: the inner loop runs over neighbours that share their rotation."""
    quarter = m * stride
    for p in range(m):
        w1r, w1i = table[0, p * stride], table[1, p * stride]
        w2r, w2i = table[0, 2 * p * stride], table[1, 2 * p * stride]
        w3r, w3i = table[0, 3 * p * stride], table[1, 3 * p * stride]
        a = p * stride
        ar_, ai_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        br_, bi_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        cr_, ci_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        dr_, di_ = x[0, a : a + stride], x[1, a : a + stride]
        a = 4 * p * stride
        y0r, y0i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y1r, y1i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y2r, y2i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y3r, y3i = y[0, a : a + stride], y[1, a : a + stride]
        for q in range(stride):
            ar, ai, br, bi = ar_[q], ai_[q], br_[q], bi_[q]
            cr, ci, dr, di = cr_[q], ci_[q], dr_[q], di_[q]
            sr, si, tr, ti = ar + cr, ai + ci, ar - cr, ai - ci
            ur, ui, vr, vi = br + dr, bi + di, bi - di, dr - br
            y0r[q], y0i[q] = sr + ur, si + ui
            er, ei = tr + vr, ti + vi
            fr, fi = sr - ur, si - ui
            gr, gi = tr - vr, ti - vi
            y1r[q], y1i[q] = er * w1r - ei * w1i, er * w1i + ei * w1r
            y2r[q], y2i[q] = fr * w2r - fi * w2i, fr * w2i + fi * w2r
            y3r[q], y3i[q] = gr * w3r - gi * w3i, gr * w3i + gi * w3r


@nb.njit(**INNER)
def _last_pass(stride: int, x: Array, y: Array) -> None:
    """Radix-2 pass without rotation, for sizes that are no power of four."""
    for q in range(stride):
        ar, ai, br, bi = x[0, q], x[1, q], x[0, q + stride], x[1, q + stride]
        y[0, q], y[1, q] = ar + br, ai + bi
        y[0, q + stride], y[1, q + stride] = ar - br, ai - bi


@nb.njit(**INNER)
def transform(size: int, x: Array, y: Array, table: Array) -> bool:
    """Forward transform of ``x[0] + i x[1]`` for a size of 4 or more."""
    _first_pass(size, x, y, table)
    # Typed: a literal would make the compiler translate the pass anew.
    left, stride, in_x = size // 4, np.int64(4), False
    while left >= 4:
        if in_x:
            _pass(left // 4, stride, x, y, table)
        else:
            _pass(left // 4, stride, y, x, table)
        left //= 4
        stride *= 4
        in_x = not in_x
    if left == 2:
        if in_x:
            _last_pass(stride, x, y)
        else:
            _last_pass(stride, y, x)
        in_x = not in_x
    return in_x
