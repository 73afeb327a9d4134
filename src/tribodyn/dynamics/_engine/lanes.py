"""A vector of lanes as a number type of the compiled kernels.

A lane is one trajectory of an ensemble. ``load(lanes, buffer, slot)`` reads one number per lane;
the result adds and multiplies like a number and lives in vector registers. The number of lanes
is the length of the tuple ``lanes``, so the compiler knows it and unrolls; with one lane the
vector is a plain number. This replaces loops over lanes, which the compiler leaves scalar when
it cannot prove that the slots written differ from the slots read.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from itertools import product

from llvmlite import ir
from llvmlite.ir import IRBuilder, Value
from numba import types
from numba.core import cgutils
from numba.core.base import BaseContext
from numba.core.datamodel import DataModelManager
from numba.core.typing import Context, Signature
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model
from numba.types import Type

#: As many zeros as there are lanes.
Lanes = tuple[float, ...]

Values = Sequence[Value]
#: What Numba calls to generate the code of a call from its types and operands.
Generator = Callable[[BaseContext, IRBuilder, Signature, Values], Value]
#: What the definition of an intrinsic function returns.
Typed = tuple[Signature, Generator]

_FLAGS = ("contract", "nsz")


def of_operands(build: Callable[..., Value]) -> Generator:
    """Generator from a function that builds the instructions from the operands alone."""
    return lambda context, builder, called, operands: build(builder, *operands)


class LaneType(types.Type):
    """Numba type of a vector with one float64 per lane."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(name=f"Lanes({width})")


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager: DataModelManager, kind: LaneType) -> None:
        super().__init__(manager, kind, ir.VectorType(ir.DoubleType(), kind.width))


def _data(context: BaseContext, builder: IRBuilder, kind: Type, array: Value) -> Value:
    return context.make_array(kind)(context, builder, array).data


@intrinsic
def address(typing: Context, array: Type) -> Typed:
    """Address of a contiguous array; the caller must keep the array alive."""

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        return _data(context, builder, array, values[0])

    return types.CPointer(array.dtype)(array), emit


@intrinsic
def ahead(typing: Context, place: Type, count: Type) -> Typed:
    """Address ``count`` items after ``place``."""
    return place(place, types.intp), of_operands(lambda builder, at, by: builder.gep(at, [by]))


@intrinsic
def on_line(typing: Context, place: Type) -> Typed:
    """First address from ``place`` on that is aligned to a cache line.

    Vectors of eight numbers that lie across two lines are read and written at half the speed.
    """

    def aligned(builder: IRBuilder, at: Value) -> Value:
        number = builder.ptrtoint(at, ir.IntType(64))
        number = builder.and_(builder.add(number, number.type(63)), number.type(-64))
        return builder.inttoptr(number, at.type)

    return place(place), of_operands(aligned)


def _pointer(
    context: BaseContext, builder: IRBuilder, kind: Type, array: Value, slot: Value, width: int
) -> Value:
    data = array if isinstance(kind, types.CPointer) else _data(context, builder, kind, array)
    place = builder.gep(data, [builder.mul(slot, ir.Constant(slot.type, width))])
    return builder.bitcast(place, ir.VectorType(ir.DoubleType(), width).as_pointer())


@intrinsic
def keep_apart(typing: Context) -> Typed:
    """Prevent inlining of the calling function, which would lengthen compilation."""

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.none(), emit


@intrinsic
def load(typing: Context, lanes: Type, buffer: Type, slot: Type) -> Typed:
    """Read slot ``slot`` of ``buffer``: one number per lane."""
    kind = LaneType(len(lanes))

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        pointer = _pointer(context, builder, buffer, values[1], values[2], kind.width)
        return builder.load(pointer, align=8)

    return kind(lanes, buffer, types.intp), emit


@intrinsic
def store(typing: Context, buffer: Type, slot: Type, value: Type) -> Typed:
    """Write one number per lane into slot ``slot`` of ``buffer``."""

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        width = called.args[2].width
        pointer = _pointer(context, builder, called.args[0], values[0], values[1], width)
        builder.store(values[2], pointer, align=8)
        return context.get_dummy_value()

    return types.none(buffer, types.intp, value), emit


def _broadcast(builder: IRBuilder, scalar: Value, width: int) -> Value:
    kind = ir.VectorType(ir.DoubleType(), width)
    first = builder.insert_element(
        ir.Constant(kind, ir.Undefined), scalar, ir.Constant(ir.IntType(32), 0)
    )
    mask = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), mask)


def _uniform(vector: Value, number: float) -> Value:
    """The same number in all lanes, as many as a vector has."""
    return ir.Constant(vector.type, [number] * vector.type.count)


@intrinsic
def any_above(typing: Context, value: Type, limit: Type) -> Typed:
    """Whether the number of any lane is above its limit or NaN."""

    def above_any(builder: IRBuilder, value: Value, limit: Value) -> Value:
        higher = builder.fcmp_unordered(">", value, limit)
        bits = builder.bitcast(higher, ir.IntType(value.type.count))
        return cgutils.is_not_null(builder, bits)

    return types.boolean(value, limit), of_operands(above_any)


@intrinsic
def negative_lanes(typing: Context, value: Type) -> Typed:
    """Bits of the lanes, at most 64, whose number is below zero."""

    def negative(builder: IRBuilder, value: Value) -> Value:
        below = builder.fcmp_ordered("<", value, _uniform(value, 0.0))
        bits = builder.bitcast(below, ir.IntType(value.type.count))
        return bits if value.type.count == 64 else builder.zext(bits, ir.IntType(64))

    return types.int64(value), of_operands(negative)


@intrinsic
def entry(typing: Context, lanes: Type, rows: Type, item: Type) -> Typed:
    """Read one item of a row table: one number, or one per lane where each lane has its rows."""
    per_lane = isinstance(rows, types.BaseTuple)
    kind = LaneType(len(lanes)) if per_lane else types.float64

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        if not per_lane:
            return builder.load(builder.gep(values[1], [values[2]]))
        data = builder.extract_value(values[1], 0)
        pointer = _pointer(context, builder, rows[0], data, values[2], kind.width)
        return builder.load(pointer, align=8)

    return kind(lanes, rows, types.intp), emit


def _arithmetic(operation: Callable[[float, float], float], name: str) -> None:
    """Define an operator for lanes and numbers."""

    @infer_global(operation)
    class _Combine(AbstractTemplate):
        def generic(self, arguments: Sequence[Type], named: object) -> Signature | None:
            lanes = [kind for kind in arguments if isinstance(kind, LaneType)]
            number_types = (LaneType, types.Float, types.Integer)
            if not lanes or not all(isinstance(kind, number_types) for kind in arguments):
                return None
            operand_types = [
                kind if isinstance(kind, LaneType) else types.float64 for kind in arguments
            ]
            return signature(lanes[0], *operand_types)

    def emit(context: BaseContext, builder: IRBuilder, called: Signature, values: Values) -> Value:
        vectors = [
            item
            if isinstance(kind, LaneType)
            else _broadcast(builder, item, called.return_type.width)
            for item, kind in zip(values, called.args, strict=True)
        ]
        return getattr(builder, name)(*vectors, flags=_FLAGS)

    for left, right in product((LaneType, types.Float), repeat=2):
        if LaneType in (left, right):
            lower_builtin(operation, left, right)(emit)


_arithmetic(operator.add, "fadd")
_arithmetic(operator.sub, "fsub")
_arithmetic(operator.mul, "fmul")


@intrinsic
def first_lane(typing: Context, value: Type) -> Typed:
    """Return the number of the first lane."""
    first = ir.Constant(ir.IntType(32), 0)
    read = of_operands(lambda builder, value: builder.extract_element(value, first))
    return types.float64(value), read


def _of_two(build: Callable[[IRBuilder, Value, Value], Value]) -> Callable[[float, float], float]:
    """Function of two vectors, lane by lane, from the instructions for it."""

    @intrinsic
    def combine(typing: Context, left: Type, right: Type) -> Typed:
        return left(left, right), of_operands(build)

    return combine


def _choice(comparison: str) -> Callable[[float, float], float]:
    def choose(builder: IRBuilder, left: Value, right: Value) -> Value:
        return builder.select(builder.fcmp_ordered(comparison, left, right), left, right)

    return _of_two(choose)


def _indicator(comparison: str) -> Callable[[float, float], float]:
    def compare(builder: IRBuilder, left: Value, right: Value) -> Value:
        holds = builder.fcmp_ordered(comparison, left, right)
        return builder.select(holds, _uniform(left, 1.0), _uniform(left, 0.0))

    return _of_two(compare)


#: Smaller and larger of two vectors, lane by lane.
least, greatest = _choice("<"), _choice(">")

#: 1 for every lane whose left number is above, or below, the right one, else 0.
above, below = _indicator(">"), _indicator("<")

#: The left vector over the right one, lane by lane.
quotient = _of_two(IRBuilder.fdiv)


@intrinsic
def magnitude(typing: Context, value: Type) -> Typed:
    """Take absolute values lane by lane."""

    def absolute(builder: IRBuilder, value: Value) -> Value:
        negative = builder.fcmp_ordered("<", value, _uniform(value, 0.0))
        return builder.select(negative, builder.fneg(value), value)

    return value(value), of_operands(absolute)
