"""From stages to functions that numba can call: their graphs as LLVM code on vectors of poses.

Vectors of eight doubles are one AVX-512 register; on smaller machines LLVM splits them.
"""

from __future__ import annotations

from collections.abc import Sequence
from inspect import Parameter, Signature
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from gsp.kernels.formulas.arcs import ARC
from gsp.kernels.stages import LANES as WIDTH
from gsp.kernels.stages import Stage
from gsp.kernels.trace import Traced, needed

DOUBLE, INTEGER = ir.DoubleType(), ir.IntType(64)
VECTOR = ir.VectorType(DOUBLE, WIDTH)
POINTER = DOUBLE.as_pointer()
# A product and a sum may become one operation, with one rounding; nothing else is relaxed.
RELAXED = ("contract",)


class _Emitter:
    """Writes the nodes of one stage into the body of its function."""

    def __init__(self, builder: ir.IRBuilder, inputs: dict[str, ir.Value]) -> None:
        self.builder, self.inputs = builder, inputs
        self.done: dict[int, ir.Value] = {}

    def value(self, x: Any) -> ir.Value:
        if isinstance(x, Traced):
            return self.done[x.number]
        return ir.Constant(VECTOR, [float(x)] * WIDTH)

    def place(self, array: str, k: int) -> ir.Value:
        """Pointer to the vector of scalar number k."""
        pointer = self.builder.gep(self.inputs[array], [INTEGER(k * WIDTH)])
        return self.builder.bitcast(pointer, VECTOR.as_pointer())

    def spread(self, number: ir.Value) -> ir.Value:
        """Vector of equal entries."""
        start = ir.Constant(VECTOR, ir.Undefined)
        single = self.builder.insert_element(start, number, ir.IntType(32)(0))
        zeros = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
        return self.builder.shuffle_vector(single, start, zeros)

    def emit(self, node: Traced) -> None:
        self.done[node.number] = getattr(self, f"_{NAMES[node.op]}")(*node.args)

    def _lane(self, array: str, k: int) -> ir.Value:
        return self.builder.load(self.place(array, k), align=8)

    def _uniform(self, array: str, k: int) -> ir.Value:
        return self.spread(self.builder.load(self.builder.gep(self.inputs[array], [INTEGER(k)])))

    def _scalar(self, name: str) -> ir.Value:
        return self.spread(self.inputs[name])

    def _add(self, x: Any, y: Any) -> ir.Value:
        return self.builder.fadd(self.value(x), self.value(y), flags=RELAXED)

    def _subtract(self, x: Any, y: Any) -> ir.Value:
        return self.builder.fsub(self.value(x), self.value(y), flags=RELAXED)

    def _multiply(self, x: Any, y: Any) -> ir.Value:
        return self.builder.fmul(self.value(x), self.value(y), flags=RELAXED)

    def _divide(self, x: Any, y: Any) -> ir.Value:
        return self.builder.fdiv(self.value(x), self.value(y))

    def _less(self, x: Any, y: Any) -> ir.Value:
        return self.builder.fcmp_ordered("<", self.value(x), self.value(y))

    def _root(self, x: Any) -> ir.Value:
        kind = ir.FunctionType(VECTOR, [VECTOR])
        name = f"llvm.sqrt.v{WIDTH}f64"
        function = cgutils.get_or_insert_function(self.builder.module, kind, name)
        return self.builder.call(function, [self.value(x)])

    def _arc(self, sine: Any, cosine: Any) -> ir.Value:
        """Write the graph of `gsp.kernels.formulas.arcs.arc` on two values."""
        inner = _Emitter(self.builder, {})
        for node in needed([ARC]):
            if node.op == "lane":
                inner.done[node.number] = self.value((sine, cosine)[node.args[1]])
            else:
                inner.emit(node)
        return inner.value(ARC)

    def _choose(self, condition: Any, yes: Any, no: Any) -> ir.Value:
        return self.builder.select(self.value(condition), self.value(yes), self.value(no))


NAMES = {
    "+": "add", "-": "subtract", "*": "multiply", "/": "divide", "<": "less", "sqrt": "root",
    "atan2": "arc", "choose": "choose", "lane": "lane", "uniform": "uniform", "scalar": "scalar",
}  # fmt: skip


def _function(module: ir.Module, stage: Stage) -> ir.Function:
    """Return the LLVM function of a stage, written on first use in a module."""
    name = "gsp." + stage.name.replace(" ", "_")
    if name in module.globals:
        return module.globals[name]
    kinds = [POINTER] * len(stage.arrays) + [DOUBLE] * len(stage.scalars)
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), kinds), name)
    function.linkage = "internal"
    function.attributes.add("noinline")
    # Vectors on the stack do not cross lines of the cache.
    function.attributes.alignstack = 8 * WIDTH
    inputs = dict(zip((*stage.arrays, *stage.scalars), function.args, strict=True))
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    _body(builder, stage, inputs)
    builder.ret_void()
    return function


def _body(builder: ir.IRBuilder, stage: Stage, inputs: dict[str, ir.Value]) -> None:
    """Write one pass over WIDTH poses, and again while the stage is to be repeated."""
    if not stage.repeat:
        _pass(builder, stage, inputs)
        return
    before, loop = builder.block, builder.append_basic_block("again")
    after = builder.append_basic_block("enough")
    builder.branch(loop)
    builder.position_at_end(loop)
    count = builder.phi(INTEGER)
    last = _pass(builder, stage, inputs)
    more = builder.add(count, INTEGER(1))
    count.add_incoming(INTEGER(0), before)
    count.add_incoming(more, builder.block)
    zero = ir.Constant(VECTOR, [0.0] * WIDTH)
    unfinished = builder.bitcast(builder.fcmp_ordered(">", last, zero), ir.IntType(WIDTH))
    again = builder.and_(
        builder.icmp_unsigned("!=", unfinished, ir.IntType(WIDTH)(0)),
        builder.icmp_unsigned("<", more, INTEGER(stage.repeat)),
    )
    builder.cbranch(again, loop, after)
    builder.position_at_end(after)


def _pass(builder: ir.IRBuilder, stage: Stage, inputs: dict[str, ir.Value]) -> ir.Value:
    emitter = _Emitter(builder, inputs)
    for node in needed(value for _, _, value in stage.outputs):
        emitter.emit(node)
    for array, k, value in stage.outputs:
        builder.store(emitter.value(value), emitter.place(array, k), align=8)
    return emitter.value(stage.outputs[-1][2])


def vectorised(*stages: Stage) -> Any:
    """Return a function (number, array, offset, array, offset, …, scalar, …) for numba code.

    It runs stage `number` of some stages with the same arguments; arrays are flat float64, and
    start for the stage at their offset.
    """
    first = stages[0]
    places = 2 * len(first.arrays)

    def run(context: Any, number: Any, *arguments: Any) -> Any:
        def code(context: Any, builder: ir.IRBuilder, signature: Any, values: Any) -> Any:
            pointers = [
                _pointer(context, builder, signature.args[1 + i], *values[1 + i : 3 + i])
                for i in range(0, places, 2)
            ]
            _dispatch(builder, stages, values[0], [*pointers, *values[1 + places :]])
            return context.get_dummy_value()

        return types.void(types.int64, *arguments), code

    names = [text for name in first.arrays for text in (name, f"{name}_at")]
    kind = Parameter.POSITIONAL_OR_KEYWORD
    parameters = [Parameter(n, kind) for n in ("context", "number", *names, *first.scalars)]
    run.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    return intrinsic(run)


def _pointer(
    context: Any, builder: ir.IRBuilder, kind: Any, array: ir.Value, offset: ir.Value
) -> ir.Value:
    return builder.gep(context.make_array(kind)(context, builder, array).data, [offset])


def _dispatch(
    builder: ir.IRBuilder, stages: Sequence[Stage], number: ir.Value, arguments: list[ir.Value]
) -> None:
    """Write calls of the stages, of which the number chooses one."""
    end = builder.append_basic_block("end")
    blocks = [builder.append_basic_block("stage") for _ in stages]
    switch = builder.switch(number, end)
    for i, (stage, block) in enumerate(zip(stages, blocks, strict=True)):
        switch.add_case(INTEGER(i), block)
        builder.position_at_end(block)
        builder.call(_function(builder.module, stage), arguments)
        builder.branch(end)
    builder.position_at_end(end)
