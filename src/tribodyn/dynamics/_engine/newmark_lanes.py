"""Operations on vectors of lanes that only Newmark's scheme needs."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic


@intrinsic
def quotient(typing: Any, left: Any, right: Any) -> Any:
    """Divide lane by lane."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fdiv(arguments[0], arguments[1])

    return left(left, right), generate


@intrinsic
def magnitude(typing: Any, value: Any) -> Any:
    """Take absolute values lane by lane."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind = arguments[0].type
        zero = ir.Constant(kind, [0.0] * signature.args[0].width)
        below = builder.fcmp_ordered("<", arguments[0], zero)
        return builder.select(below, builder.fneg(arguments[0]), arguments[0])

    return value(value), generate


@intrinsic
def any_above(typing: Any, value: Any, limit: Any) -> Any:
    """Tell whether any lane is above its limit or no number."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        above = builder.fcmp_unordered(">", arguments[0], arguments[1])
        bits = builder.bitcast(above, ir.IntType(signature.args[0].width))
        return cgutils.is_not_null(builder, bits)

    return types.boolean(value, limit), generate


@intrinsic
def below(typing: Any, left: Any, right: Any) -> Any:
    """1 for every lane whose left number is below the right one, else 0."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind, width = arguments[0].type, signature.args[0].width
        lower = builder.fcmp_ordered("<", arguments[0], arguments[1])
        one, zero = ir.Constant(kind, [1.0] * width), ir.Constant(kind, [0.0] * width)
        return builder.select(lower, one, zero)

    return left(left, right), generate


@intrinsic
def any_negative(typing: Any, value: Any) -> Any:
    """Tell whether the number of any lane is below zero."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        width = signature.args[0].width
        zero = ir.Constant(arguments[0].type, [0.0] * width)
        lower = builder.fcmp_ordered("<", arguments[0], zero)
        return cgutils.is_not_null(builder, builder.bitcast(lower, ir.IntType(width)))

    return types.boolean(value), generate
