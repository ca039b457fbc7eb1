"""Traversal of expressions without recursion: an expression may be thousands of operators deep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from robosc.model import engine, robosc, rosgraph
from robosc.model import expression as ex
from robosc.model.reflection import contents, features, is_attribute

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Mapping, MutableMapping, Sequence

_Node = TypeVar("_Node")
_Result = TypeVar("_Result")
_Element = TypeVar("_Element")


def operands(expression: ex.Expression | None) -> list[ex.Expression]:
    """Return the operands of an expression, from left to right. Operands missing from an unfinished text are None."""
    match expression:
        case ex.BinaryExpression():
            return [expression.left, expression.right]
        case ex.UnaryExpression():
            return [expression.operand]
        case ex.Conditional():
            return [expression.condition, expression.then, expression.otherwise]
        case ex.FunctionCall() | robosc.Call():
            return list(expression.arguments)
        case robosc.InstanceQuantifier():
            return [expression.body]
        case engine.And() | engine.Or():
            return list(expression.operands)
        case robosc.ObjectValue():
            return [property_value.value for property_value in expression.properties]
        case rosgraph.ConversionCall():
            return [expression.argument]
        case rosgraph.IfReadable():
            return [expression.value, expression.otherwise]
    return _in_arrays(expression)


def _in_arrays(expression: ex.Expression | None) -> list[ex.Expression]:
    match expression:
        case robosc.Access():
            return [index for segment in expression.segments for index in _indices(segment)]
        case rosgraph.WireAccess():
            return [index for step in expression.steps for index in _indices(step)]
        case robosc.ArrayQuantifier() | rosgraph.ArrayQuantifier():
            return [expression.array, expression.body]
        case robosc.ArrayLiteral() | rosgraph.ArrayLiteral():
            return list(expression.elements)
    return []


def _indices(step: robosc.AccessSegment | rosgraph.WireStep) -> list[ex.Expression]:
    """Return the index expressions of a step into an array; empty for other steps."""
    match step:
        case robosc.IndexSegment() | rosgraph.SliceStep():
            return [index for index in (step.first, step.last) if index is not None]
        case rosgraph.IndexStep() if step.position is not None:
            return [step.position]
    return []


def with_operands(original: ex.Expression, new_operands: Sequence[ex.Expression]) -> ex.Expression:
    """Return a copy of an expression's operator or function with other operands, which it contains."""
    kind: Any = type(original)
    copy: ex.Expression
    if isinstance(original, ex.FunctionCall):
        copy = kind(function=original.function, arguments=new_operands)
    elif isinstance(original, ex.Conditional):
        copy = kind(**dict(zip(("condition", "then", "otherwise"), new_operands, strict=True)))
    else:
        names = ("operand",) if len(new_operands) == 1 else ("left", "right")
        copy = kind(**dict(zip(names, new_operands, strict=True)))
    return copy


def branches(
    value: ex.Expression,
) -> Iterator[tuple[Sequence[tuple[ex.Expression, bool]], ex.Expression]]:
    """Yield the values that conditionals choose from, in the order of the text.

    Each comes with the conditions on the way to it, and whether they hold.
    """
    pending: list[tuple[tuple[tuple[ex.Expression, bool], ...], ex.Expression]] = [((), value)]
    while pending:
        conditions, branch = pending.pop()
        if isinstance(branch, ex.Conditional):
            pending.append(((*conditions, (branch.condition, False)), branch.otherwise))
            pending.append(((*conditions, (branch.condition, True)), branch.then))
        else:
            yield conditions, branch


def parts(expression: ex.Expression | None) -> Iterator[ex.Expression]:
    """Iterate over the expression and all its parts, each before its operands, from left to right."""
    pending = [expression]
    while pending:
        part = pending.pop()
        if part is not None:
            yield part
            pending += reversed(operands(part))


def fold(
    combine: Callable[[_Node, list[_Result]], _Result],
    root: _Node,
    inside: Callable[[_Node], Sequence[_Node]] = operands,  # type: ignore[assignment]
    memo: MutableMapping[_Node, _Result] | None = None,
) -> _Result:
    """Return the result for `root`, computed bottom-up.

    `combine` gets a node and the results for the nodes `inside` it, in order. `memo` stores the results of all nodes.
    Nodes that it already contains are not visited.
    """
    results: list[_Result] = []
    pending: list[tuple[_Node, int]] = [(root, -1)]
    while pending:
        node, count = pending.pop()
        if memo is not None and node in memo:
            results.append(memo[node])
        elif count < 0:
            children = inside(node)
            pending.append((node, len(children)))
            pending += [(child, -1) for child in reversed(children)]
        else:
            first = len(results) - count
            result = combine(node, results[first:])
            results[first:] = [result]
            if memo is not None:
                memo[node] = result
    return results[0]


def walk(
    step: Callable[[_Node], Generator[_Node, _Result, _Result]],
    root: _Node,
    memo: MutableMapping[_Node, _Result] | None = None,
) -> _Result:
    """Return the result for `root`. Each node chooses the nodes that it needs, and their order.

    Write `step` like a recursive function, with `yield other` in place of the recursive call: `left = yield node.left`.
    `memo` is as for `fold`.
    """
    nodes, steps = [root], [step(root)]
    result: Any = None
    while steps:
        try:
            child = steps[-1].send(result)
        except StopIteration as finished:
            result = finished.value
            steps.pop()
            node = nodes.pop()
            if memo is not None:
                memo[node] = result
            continue
        if memo is not None and child in memo:
            result = memo[child]
        else:
            result = None
            nodes.append(child)
            steps.append(step(child))
    return result  # type: ignore[no-any-return]


def copy_tree(root: _Element, instead: Mapping[Any, Any] | None = None) -> _Element:
    """Return a deep copy of an expression or a type. The original stays in its container.

    `instead` maps elements that the original refers to to those that the copy refers to.
    """
    known: dict[Any, Any] = {}
    references: list[tuple[Any, str, Any]] = []
    others = {} if instead is None else instead

    def copy(original: Any, children: list[Any]) -> Any:
        clone, inside = type(original)(), iter(children)
        known[original] = clone
        for name, feature in features(original.eClass).items():
            value = getattr(original, name)
            if value is None:
                continue
            if is_attribute(feature):
                setattr(clone, name, value)
            elif not feature.containment:
                setattr(clone, name, others.get(value, value))
                references.append((clone, name, value))
            elif feature.many:
                getattr(clone, name).extend(next(inside) for _ in value)
            else:
                setattr(clone, name, next(inside))
        return clone

    clone: _Element = fold(copy, root, lambda element: [child for _, child in contents(element)])
    for user, name, value in references:
        if value in known:  # A reference to an element inside, such as a state, refers to its copy.
            setattr(user, name, known[value])
    return clone
