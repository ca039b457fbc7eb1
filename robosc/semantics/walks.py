"""Walks over expressions that need no recursion: an expression may be thousands of operators deep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from robosc.metamodel import engine, robosc, rosgraph
from robosc.metamodel import expression as ex
from robosc.metamodel.reflection import contents, features, is_attribute

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Mapping, MutableMapping, Sequence

_Node = TypeVar("_Node")
_Result = TypeVar("_Result")
_Element = TypeVar("_Element")


def operands(expression: ex.Expression | None) -> list[ex.Expression]:
    """The expressions directly inside an expression, from left to right; what an unfinished text lacks is None."""
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
            return [given.value for given in expression.properties]
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
    """What the index of a step into an array is computed from, if it is."""
    match step:
        case robosc.IndexSegment() | rosgraph.SliceStep():
            return [index for index in (step.first, step.last) if index is not None]
        case rosgraph.IndexStep() if step.position is not None:
            return [step.position]
    return []


def with_operands(original: ex.Expression, given: Sequence[ex.Expression]) -> ex.Expression:
    """The operator or function of an expression, of other operands; the new expression contains them."""
    kind: Any = type(original)
    made: ex.Expression
    if isinstance(original, ex.FunctionCall):
        made = kind(function=original.function, arguments=given)
    elif isinstance(original, ex.Conditional):
        made = kind(**dict(zip(("condition", "then", "otherwise"), given, strict=True)))
    else:
        names = ("operand",) if len(given) == 1 else ("left", "right")
        made = kind(**dict(zip(names, given, strict=True)))
    return made


def parts(expression: ex.Expression | None) -> Iterator[ex.Expression]:
    """The expression and all that is inside it, each before its operands, from left to right."""
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
    """The result for `root`, made bottom-up: `combine` gets a node and the results for what is `inside` it, in order.

    `memo` keeps the results of all nodes; what is in it already is not looked into again.
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
    """The result for `root`, where each node decides which others it needs, and in which order.

    `step` is written as a recursive function is, with `yield other` for the call of itself: `left = yield node.left`.
    `memo` is as for `fold`.
    """
    nodes, steps = [root], [step(root)]
    result: Any = None
    while steps:
        try:
            wanted = steps[-1].send(result)
        except StopIteration as finished:
            result = finished.value
            steps.pop()
            node = nodes.pop()
            if memo is not None:
                memo[node] = result
            continue
        if memo is not None and wanted in memo:
            result = memo[wanted]
        else:
            result = None
            nodes.append(wanted)
            steps.append(step(wanted))
    return result  # type: ignore[no-any-return]


def copied(root: _Element, instead: Mapping[Any, Any] | None = None) -> _Element:
    """A copy of an expression or a type with all that it contains; what contains the original keeps it.

    `instead` holds the elements that the copy refers to where the original refers to others.
    """
    known: dict[Any, Any] = {}
    others = {} if instead is None else instead

    def copy(original: Any, children: list[Any]) -> Any:
        made, inside = type(original)(), iter(children)
        known[original] = made
        for name, feature in features(original.eClass).items():
            value = getattr(original, name)
            if value is None:
                continue
            if is_attribute(feature):
                setattr(made, name, value)
            elif not feature.containment:
                # What names an element of an array names it in the copy, too: it stands before.
                setattr(made, name, known[value] if value in known else others.get(value, value))
            elif feature.many:
                getattr(made, name).extend(next(inside) for _ in value)
            else:
                setattr(made, name, next(inside))
        return made

    made: _Element = fold(copy, root, lambda element: [child for _, child in contents(element)])
    return made
