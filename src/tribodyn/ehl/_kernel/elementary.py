"""How the kernels are compiled, and exponential and logarithm as vector instructions.

Numba calls the C library for every single element; these are straight arithmetic without
branches, several times faster in a loop over an array.
"""

from __future__ import annotations

from collections.abc import Callable

import numba as nb
from llvmlite import ir
from numba import types
from numba.core.typing import Context, Signature
from numba.extending import intrinsic

from tribodyn.compiled.jit import INNER_OPTIONS
from tribodyn.types import Tree

#: What the definition of an intrinsic function returns.
Typed = tuple[Signature, Callable[..., ir.Value]]

#: NaN stays detectable: neither "nnan" nor "ninf". Only the outermost kernel is cached on disk.
JIT: Tree = {
    "nogil": True,
    "fastmath": {"contract", "nsz", "arcp", "reassoc"},
    "error_model": "numpy",
}

#: Options of functions that only compiled functions call.
INNER: Tree = {**JIT, **INNER_OPTIONS}

#: Files whose code is part of every compiled film kernel, in addition to its own file.
SOURCES: tuple[str, ...] = ("elementary", "reynolds", "film_sum", "factors", "linear_solver")
SOURCES += ("grid_transfer", "inlet", "newton")

#: Sums must keep their order: the rounding below would be optimised away. For the same reason
#: the functions are inlined by the compiler's back end, which keeps these flags, never by Numba.
STRICT = {**INNER, "fastmath": {"contract"}}


def _read_as(read: ir.Type) -> Callable[..., ir.Value]:
    return lambda context, builder, called, values: builder.bitcast(values[0], read)


@intrinsic
def _bits(typing: Context, value: types.Type) -> Typed:
    """Bit pattern of a double as an integer."""
    return types.int64(types.float64), _read_as(ir.IntType(64))


@intrinsic
def _double(typing: Context, value: types.Type) -> Typed:
    """Double of a bit pattern."""
    return types.float64(types.int64), _read_as(ir.DoubleType())


@nb.njit(**STRICT)
def exp_(x: float) -> float:
    """Exponential of a number, held between exp(-700) and exp(700)."""
    x = min(max(x, -700.0), 700.0)
    # Adding and taking away 1.5 * 2^52 rounds to the nearest integer.
    shifted = x * 1.4426950408889634 + 6755399441055744.0
    k = shifted - 6755399441055744.0
    r = x - k * 0.693147180369123816490
    r = r - k * 1.90821492927058770002e-10
    s = 1.0 / 6227020800.0
    s = s * r + 1.0 / 479001600.0
    s = s * r + 1.0 / 39916800.0
    s = s * r + 1.0 / 3628800.0
    s = s * r + 1.0 / 362880.0
    s = s * r + 1.0 / 40320.0
    s = s * r + 1.0 / 5040.0
    s = s * r + 1.0 / 720.0
    s = s * r + 1.0 / 120.0
    s = s * r + 1.0 / 24.0
    s = s * r + 1.0 / 6.0
    s = s * r + 0.5
    s = s * r + 1.0
    s = s * r + 1.0
    # The integer k sits in the lowest bits of the shifted number.
    power = (_bits(shifted) - 4843621399236968448 + 1023) << 52
    result: float = s * _double(power)
    return result


@nb.njit(**STRICT)
def log_(x: float) -> float:
    """Natural logarithm of a positive normal number; undefined for any other."""
    bits = _bits(x)
    # Exponent such that the mantissa lies between sqrt(1/2) and sqrt(2).
    k = (bits - 4604544271217802189) >> 52
    m = _double(bits - (k << 52))
    f = m - 1.0
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    odd = w * (
        3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01)
    )
    even = z * (
        6.666666666666735130e-01
        + w
        * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01))
    )
    half = 0.5 * f * f
    tail = s * (half + odd + even) + k * 1.90821492927058770002e-10
    result: float = k * 6.93147180369123816490e-01 - ((half - tail) - f)
    return result
