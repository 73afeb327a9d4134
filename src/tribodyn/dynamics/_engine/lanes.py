"""A vector of lanes as a number type of the compiled kernels.

A lane is one trajectory of an ensemble. ``load(lanes, buffer, slot)`` reads one number per lane;
the result adds and multiplies like a number and lives in vector registers. The number of lanes
is the length of the tuple ``lanes``, so the compiler knows it and unrolls; with one lane the
vector is a plain number. This replaces loops over lanes, which the compiler leaves scalar when
it cannot prove that the slots written differ from the slots read.
"""

from __future__ import annotations

import operator
from itertools import product
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

_FLAGS = ("contract", "nsz")


class LaneType(types.Type):
    """Numba type of a vector with one float64 per lane."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(name=f"Lanes({width})")


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: LaneType) -> None:
        super().__init__(manager, kind, ir.VectorType(ir.DoubleType(), kind.width))


def _data(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    return context.make_array(kind)(context, builder, array).data


@intrinsic
def address(typing: Any, array: Any) -> Any:
    """Address of a contiguous array; the caller must keep the array alive."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return _data(context, builder, signature.args[0], arguments[0])

    return types.CPointer(array.dtype)(array), generate


@intrinsic
def ahead(typing: Any, place: Any, count: Any) -> Any:
    """Address ``count`` items after ``place``."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.gep(arguments[0], [arguments[1]])

    return place(place, types.intp), generate


@intrinsic
def on_line(typing: Any, place: Any) -> Any:
    """First address from ``place`` on that is aligned to a cache line.

    Vectors of eight numbers that lie across two lines are read and written at half the speed.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        number = builder.ptrtoint(arguments[0], ir.IntType(64))
        number = builder.and_(builder.add(number, number.type(63)), number.type(-64))
        return builder.inttoptr(number, arguments[0].type)

    return place(place), generate


def _pointer(context: Any, builder: Any, kind: Any, array: Any, slot: Any, width: int) -> Any:
    data = array if isinstance(kind, types.CPointer) else _data(context, builder, kind, array)
    place = builder.gep(data, [builder.mul(slot, ir.Constant(slot.type, width))])
    return builder.bitcast(place, ir.VectorType(ir.DoubleType(), width).as_pointer())


@intrinsic
def keep_apart(typing: Any) -> Any:
    """Prevent inlining of the calling function, which would lengthen compilation."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.none(), generate


@intrinsic
def load(typing: Any, lanes: Any, buffer: Any, slot: Any) -> Any:
    """Read slot ``slot`` of ``buffer``: one number per lane."""
    kind = LaneType(len(lanes))

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = _pointer(
            context, builder, signature.args[1], arguments[1], arguments[2], kind.width
        )
        return builder.load(pointer, align=8)

    return kind(lanes, buffer, types.intp), generate


@intrinsic
def store(typing: Any, buffer: Any, slot: Any, value: Any) -> Any:
    """Write one number per lane into slot ``slot`` of ``buffer``."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        width = signature.args[2].width
        pointer = _pointer(context, builder, signature.args[0], arguments[0], arguments[1], width)
        builder.store(arguments[2], pointer, align=8)
        return context.get_dummy_value()

    return types.none(buffer, types.intp, value), generate


def _broadcast(builder: Any, scalar: Any, width: int) -> Any:
    kind = ir.VectorType(ir.DoubleType(), width)
    first = builder.insert_element(
        ir.Constant(kind, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0)
    )
    mask = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), mask)


def _uniform(width: int, number: float) -> Any:
    return ir.Constant(ir.VectorType(ir.DoubleType(), width), [number] * width)


def _any(builder: Any, comparison: Any, width: int) -> Any:
    return cgutils.is_not_null(builder, builder.bitcast(comparison, ir.IntType(width)))


@intrinsic
def any_above(typing: Any, value: Any, limit: Any) -> Any:
    """Whether the number of any lane is above its limit or NaN."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        higher = builder.fcmp_unordered(">", arguments[0], arguments[1])
        return _any(builder, higher, signature.args[0].width)

    return types.boolean(value, limit), generate


@intrinsic
def negative_lanes(typing: Any, value: Any) -> Any:
    """Bits of the lanes, at most 64, whose number is below zero."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        width = signature.args[0].width
        below = builder.fcmp_ordered("<", arguments[0], _uniform(width, 0.0))
        bits = builder.bitcast(below, ir.IntType(width))
        return bits if width == 64 else builder.zext(bits, ir.IntType(64))

    return types.int64(value), generate


def _indicator(comparison: str) -> Any:
    def compare(typing: Any, left: Any, right: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            width = signature.args[0].width
            holds = builder.fcmp_ordered(comparison, arguments[0], arguments[1])
            return builder.select(holds, _uniform(width, 1.0), _uniform(width, 0.0))

        return left(left, right), generate

    return intrinsic(compare)


@intrinsic
def entry(typing: Any, lanes: Any, rows: Any, item: Any) -> Any:
    """Read one item of a row table: one number, or one per lane where each lane has its rows."""
    per_lane = isinstance(rows, types.BaseTuple)
    kind = LaneType(len(lanes)) if per_lane else types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        if not per_lane:
            return builder.load(builder.gep(arguments[1], [arguments[2]]))
        data = builder.extract_value(arguments[1], 0)
        pointer = _pointer(context, builder, rows[0], data, arguments[2], kind.width)
        return builder.load(pointer, align=8)

    return kind(lanes, rows, types.intp), generate


def _arithmetic(operation: Any, name: str) -> None:
    """Define an operator for lanes and numbers."""

    @infer_global(operation)
    class _Combine(AbstractTemplate):
        def generic(self, arguments: Any, named: Any) -> Any:
            lanes = [kind for kind in arguments if isinstance(kind, LaneType)]
            number_types = (LaneType, types.Float, types.Integer)
            if not lanes or not all(isinstance(kind, number_types) for kind in arguments):
                return None
            operand_types = [
                kind if isinstance(kind, LaneType) else types.float64 for kind in arguments
            ]
            return signature(lanes[0], *operand_types)

    def generate(context: Any, builder: Any, kinds: Any, arguments: Any) -> Any:
        operands = [
            item
            if isinstance(kind, LaneType)
            else _broadcast(builder, item, kinds.return_type.width)
            for item, kind in zip(arguments, kinds.args, strict=True)
        ]
        return getattr(builder, name)(*operands, flags=_FLAGS)

    for left, right in product((LaneType, types.Float), repeat=2):
        if LaneType in (left, right):
            lower_builtin(operation, left, right)(generate)


_arithmetic(operator.add, "fadd")
_arithmetic(operator.sub, "fsub")
_arithmetic(operator.mul, "fmul")


@intrinsic
def first_lane(typing: Any, value: Any) -> Any:
    """Return the number of the first lane."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.extract_element(arguments[0], ir.Constant(ir.IntType(32), 0))

    return types.float64(value), generate


def _choice(comparison: str) -> Any:
    @intrinsic
    def choose(typing: Any, left: Any, right: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            first = builder.fcmp_ordered(comparison, arguments[0], arguments[1])
            return builder.select(first, arguments[0], arguments[1])

        return left(left, right), generate

    return choose


#: Smaller and larger of two vectors, lane by lane.
least, greatest = _choice("<"), _choice(">")

#: 1 for every lane whose left number is above, or below, the right one, else 0.
above, below = _indicator(">"), _indicator("<")


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
        width = signature.args[0].width
        negative = builder.fcmp_ordered("<", arguments[0], _uniform(width, 0.0))
        return builder.select(negative, builder.fneg(arguments[0]), arguments[0])

    return value(value), generate
