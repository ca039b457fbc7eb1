"""Values and types of expressions: constants, algebraic variables, named types."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.language.cif import static_values
from robosc.language.cif.expressions import ExpressionReader, pair, referenced_names
from robosc.language.cif.faults import CifFaultError, construct
from robosc.language.cif.scopes import Argument, Declaration, Scope, Specification, plain
from robosc.language.cif.static_values import (
    ForeignType,
    Static,
    TypedNode,
    conformed,
    constant_value,
    is_foreign,
    static_node,
)
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cif_types import BOOLEAN, LARGEST, Type, contains, format_type
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree, parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


#: Size limits after expanding names, in operators and operands: of one expression, and of the whole specification.
_LARGEST, _LARGEST_IN_ALL = 20_000, 100_000
#: Maximum nesting depth of definitions. Definitions that are read one after the other are unlimited.
_DEEPEST = 30
_DEFINED = ("Constants", "Algebraics", "Types")
_MINMAX = {"min": min, "max": max}
_DISTRIBUTIONS = frozenset(
    [
        "bernoulli",
        "beta",
        "binomial",
        "constant",
        "erlang",
        "exponential",
        "gamma",
        "geometric",
        "lognormal",
        "normal",
        "poisson",
        "random",
        "triangle",
        "uniform",
        "weibull",
    ]
)
#: Number of arguments of each function that does not have one.
_ARGUMENTS = {"min": 2, "max": 2, "pow": 2, "del": 2, "scale": 5}


#: A constant, an algebraic variable, a named type, or the argument of an algebraic parameter.
Definition: TypeAlias = Declaration | Argument


class Values:
    """Reads the expressions of a specification."""

    def __init__(self, names: Specification) -> None:
        self.names = names
        #: Values of definitions and arguments, or their faults.
        self._known: dict[Definition, Any] = {}
        self._open: set[Definition] = set()
        self._sizes: dict[Definition, int] = {}
        self._equations: dict[Scope, dict[str, list[tuple[sct.Location | None, Any]]]] = {}
        self._size = self._size_in_all = 0
        self._exhausted: CifFaultError | None = None
        #: The value that `?` stands for in the updates of an edge that receives one.
        self.received: TypedNode | None = None

    def typed(self, node: Any, scope: Scope) -> TypedNode:
        """Return the value of an expression in a scope. Raises CifFaultError."""
        typed = self._nested(node, scope)
        if isinstance(typed.type, sct.Plant):
            raise CifFaultError(node, "type", "an automaton is not a value", "name one of its locations")
        return typed

    def whole(self, node: Any, scope: Scope) -> TypedNode:
        """Return the value of an expression that has its own size limit. Raises CifFaultError."""
        self._size = 0
        return self.typed(node, scope)

    def condition(self, reads: Sequence[Any], scope: Scope) -> ex.Expression | None:
        """Return the conjunction of boolean expressions, or None if there are none."""
        conditions = []
        for node in reads:
            boolean = self.whole(node, scope)
            if boolean.type != BOOLEAN:
                raise CifFaultError(node, "type", f"a condition is bool, this is {format_type(boolean.type)}")
            conditions.append(boolean.expression)
        return conjunction(conditions)

    def constant(self, node: Any, scope: Scope) -> tuple[Any, Type]:
        """Return the value of a constant expression, and its type."""
        typed = self.whole(node, scope)
        value = constant_value(typed.expression)
        if value is None:
            raise CifFaultError(node, "type", "this is not a constant")
        return value, range(value, value + 1) if isinstance(typed.type, range) else typed.type

    def _nested(self, node: Any, scope: Scope) -> TypedNode:
        reader = ExpressionReader(node, lambda value, switched: self._operand(value, scope, switched), self._grow)
        return reader.result

    def _operand(self, node: Any, scope: Scope, switched: sct.Plant | None) -> TypedNode:
        match type(node).__name__:
            case "Truth" | "Number" | "Real" | "String" as rule:
                typed = _literal(node, rule)
                return self._suffixed(typed, node, scope) if rule == "String" else typed
            case "Parenthesis" if not node.more:
                return self._suffixed(self._nested(node.inner, scope)._replace(node=node), node, scope)
            case "Parenthesis" | "Call" | "Collection" as rule:
                return self._suffixed(getattr(self, f"_{rule.lower()}")(node, scope), node, scope)
            case "Reference":
                return self._reference(node, scope, switched)
            case "Own":
                if scope.plant is None:
                    raise CifFaultError(node, "type", "`self` is allowed only in automata")
                return TypedNode(node, None, scope.plant)
            case "Received":
                return self._received(node)
        raise construct(node, "time", "model the passing of time by events")

    def _parenthesis(self, node: Any, scope: Scope) -> TypedNode:
        values = [static_values.static_value(self._nested(part, scope), "tuples") for part in (node.inner, *node.more)]
        return static_node(node, static_values.Tuple(tuple(values)))

    def _collection(self, node: Any, scope: Scope) -> TypedNode:
        elements = []
        for element in node.elements:
            parts = pair(element)
            elements.append(
                self._nested(element, scope)
                if parts is None
                else (self._nested(parts[0], scope), self._nested(parts[1], scope))
            )
        return static_values.collection(node, elements)

    def _suffixed(self, typed: TypedNode, node: Any, scope: Scope) -> TypedNode:
        """Return the element or part of a list, text, tuple or dictionary that the suffixes select."""
        for suffix in node.suffixes:
            if suffix.word != "[":
                what = "derivatives" if suffix.word == "'" else "functions"
                raise construct(node, what, "write an algebraic variable for its result")
            bounds = None if suffix.first is None else pair(suffix.first)
            if suffix.slice or bounds is not None:
                limits = bounds or (suffix.first, suffix.last)
                ends = [None if bound is None else self._nested(bound, scope) for bound in limits]
                typed = static_values.sliced(suffix, typed, ends)
                continue
            if suffix.first is None:
                raise CifFaultError(suffix, "syntax", "an index is missing here")
            name = plain(getattr(getattr(suffix.first.first.value, "name", None), "text", ""))
            value = constant_value(typed.expression)
            is_field = isinstance(value, static_values.Tuple) and name in value.names
            typed = static_values.projected(suffix, typed, name if is_field else self._nested(suffix.first, scope))
        return typed

    def _received(self, node: Any) -> TypedNode:
        if self.received is None:
            message = "`?` has a value only in the updates of an edge that receives one"
            raise CifFaultError(node, "type", message)
        self._grow(node, sum(1 for _ in parts(self.received.expression)))
        return TypedNode(node, copy_tree(self.received.expression), self.received.type)

    def _call(self, node: Any, scope: Scope) -> TypedNode:
        name = node.function.strip()
        if name in _DISTRIBUTIONS:
            raise construct(node, "distributions", "write a value of the required type")
        arguments = [self._nested(argument, scope) for argument in node.arguments]
        count = _ARGUMENTS.get(name, 1)
        if len(arguments) != count and name != "fmt":
            raise CifFaultError(
                node, "argument", f"`{name}` takes {count} argument{'s' if count > 1 else ''}, found {len(arguments)}"
            )
        if name not in ("min", "max", "abs") or any(is_foreign(value.type) for value in arguments):
            return static_values.call(node, name, arguments)
        for argument, value in zip(node.arguments, arguments, strict=True):
            if not isinstance(value.type, range):
                raise CifFaultError(argument, "type", f"`{name}` expects an int")
        call = ex.FunctionCall(function=name, arguments=[value.expression for value in arguments])
        bounds = [(value.type.start, value.type.stop - 1) for value in arguments if isinstance(value.type, range)]
        if name == "abs":
            [(low, high)] = bounds
            return TypedNode(node, call, range(max(low, -high, 0), max(-low, high) + 1))
        least, most = (_MINMAX[name](ends) for ends in zip(*bounds, strict=True))
        return TypedNode(node, call, range(least, most + 1))

    def _reference(self, node: Any, scope: Scope, switched: sct.Plant | None) -> TypedNode:
        if node.suffixes:
            calls = node.suffixes[0].word != "["
            base = TypedNode(node, None, None) if calls else self._value(node, self.names.find(node.name, scope))
            return self._suffixed(base, node, scope)
        if switched is not None:
            own = next((location for location in switched.locations if location.name == plain(node.name.text)), None)
            if own is not None:
                return TypedNode(node, sct.LocationReference(location=own), BOOLEAN)
        typed = self._value(node, self.names.find(node.name, scope))
        if switched is not None and not isinstance(typed.expression, sct.LocationReference):
            raise CifFaultError(node, "type", f"`{node.name.text}` is not a location of `{switched.name}`")
        return typed

    def _value(self, node: Any, named: Any) -> TypedNode:
        match named:
            case sct.Location():
                return TypedNode(node, sct.LocationReference(location=named), BOOLEAN)
            case Scope(plant=sct.Plant() as plant):
                return TypedNode(node, None, plant)
            case Argument():
                return self._copied(node, named)
            case Declaration(kind="Constants" | "Algebraics"):
                return self._copied(node, named)
            case Declaration(kind="Variables" | "Inputs"):
                if named.element is None:
                    # A variable that is declared later has no fault yet, but a constant cannot read it.
                    raise named.fault or CifFaultError(node, "type", "this is not a constant")
                return TypedNode(node, sct.VariableReference(variable=named.element), named.type)
            case Declaration(kind="Literal"):
                enumeration = self.enumeration(named.outer)
                literal = next(literal for literal in enumeration.literals if literal.name == named.name)
                return TypedNode(node, ex.EnumerationLiteralReference(literal=literal), enumeration)
            case Declaration(kind="Function"):
                raise construct(node, "functions", "write an algebraic variable for its result")
        raise CifFaultError(node, "type", f"`{node.name.text}` has no value")

    def _copied(self, node: Any, named: Definition) -> TypedNode:
        typed: TypedNode = self.known(named)
        if named not in self._sizes:
            is_static = isinstance(typed.expression, Static)
            self._sizes[named] = 1 if is_static else sum(1 for _ in parts(typed.expression))
        self._grow(node, self._sizes[named])
        if isinstance(typed.expression, Static):
            return typed._replace(node=node)
        return TypedNode(node, copy_tree(typed.expression), typed.type)

    def _grow(self, node: Any, more: int) -> None:
        """Count the nodes that a name adds to an expression. Raises CifFaultError if a size limit is exceeded."""
        self._size += more
        self._size_in_all += more
        if self._size > _LARGEST:
            raise _too_large(node, "the expression after its names are expanded", _LARGEST)
        if self._size_in_all > _LARGEST_IN_ALL:
            what = "the specification after its names are expanded"
            self._exhausted = self._exhausted or _too_large(node, what, _LARGEST_IN_ALL)
            raise self._exhausted

    # Definitions

    def known(self, named: Definition) -> Any:
        """Return the value of a constant, an algebraic variable or an argument, or the type behind a name.

        Its operands are settled first without recursion, because a chain of definitions may exceed Python's stack. The
        fault of a definition is reported once. Raises CifFaultError.
        """
        if named not in self._known and named not in self._open:
            self._settle(named)
        if named not in self._known:
            raise computed_from_itself(named)
        value = self._known[named]
        if isinstance(value, CifFaultError):
            raise value
        return value

    def _settle(self, named: Definition) -> None:
        path = {named: iter(self._uses(named))}
        while path:
            last = next(reversed(path))
            used = next((used for used in path[last] if used not in self._known), None)
            if used is None:
                del path[last]
                if last not in self._known:
                    self._known[last] = self._create(last)
            elif used in path:
                circle = list(path)
                self._known |= {
                    definition: computed_from_itself(definition) for definition in circle[circle.index(used) :]
                }
            elif used not in self._open:
                path[used] = iter(self._uses(used))

    def _uses(self, named: Definition) -> Iterator[Definition]:
        """Yield the definitions and arguments that one names, except those that are keys of a `switch`."""
        scope = named.scope
        types = (
            [named.outer.type if named.kind != "Types" else named.node.type] if isinstance(named, Declaration) else []
        )
        reads = [
            bound for kind in types if type(kind).__name__ == "Integer" for bound in (kind.low, kind.high) if bound
        ]
        names = [kind.type for kind in types if type(kind).__name__ == "NamedType"]
        if isinstance(named, Argument) or (named.kind != "Types" and named.node.value is not None):
            reads.append(named.node if isinstance(named, Argument) else named.node.value)
        elif named.kind == "Algebraics":
            with suppress(CifFaultError):
                reads += [equation for _, equation in self.equations(scope).get(named.name, ())]
        for name in (*names, *(name for node in reads for name in referenced_names(node))):
            with suppress(CifFaultError):
                used = self.names.find(name, scope)
                if isinstance(used, Argument) or (isinstance(used, Declaration) and used.kind in _DEFINED):
                    yield used

    def _create(self, named: Definition) -> Any:
        """Return the value of a definition or an argument, or its fault."""
        if len(self._open) > _DEEPEST:
            return CifFaultError(named.node, "cif-construct", "definitions are nested too deeply")
        before, self._size = self._size, 0
        self._open.add(named)
        try:
            if isinstance(named, Argument):
                return self.typed(named.node, named.scope)
            if named.kind == "Types":
                return self.declared_type(named.node.type, named.scope)
            return self._computed(named)
        except CifFaultError as fault:
            return fault
        finally:
            self._open.remove(named)
            self._size = before

    def _computed(self, declared: Declaration) -> TypedNode:
        """Return the value of a constant or an algebraic variable."""
        kind = self.declared_type(declared.outer.type, declared.scope)
        typed = self._equation(declared) if declared.kind == "Algebraics" else self._fixed(declared)
        if isinstance(kind, ForeignType):
            return conformed(typed, kind, declared.name)
        if not (isinstance(typed.type, range) if kind == "int" else contains(kind, typed.type)):
            raise CifFaultError(
                declared.node, "type", f"`{declared.name}` is {format_type(kind)}, its value {format_type(typed.type)}"
            )
        return typed

    def _fixed(self, declared: Declaration) -> TypedNode:
        value, _ = self.constant(declared.node.value, declared.scope)
        return static_node(declared.node, value)

    def _equation(self, declared: Declaration) -> TypedNode:
        """Return the value of an algebraic variable from its declaration, an equation, or an equation per location."""
        if declared.node.value is not None:
            return self.typed(declared.node.value, declared.scope)
        equations = self.equations(declared.scope).get(declared.name, [])
        if not equations:
            message = f"`{declared.name}` has no value"
            raise CifFaultError(declared.node, "cif-declaration", message, "add an equation for it")
        result: TypedNode | None = None
        for location, node in reversed(equations):
            value = self.typed(node, declared.scope)
            if result is None or location is None:
                result = value
                continue
            if is_foreign(value.type) or is_foreign(result.type):
                static_values.refuse_changing(value)
            if isinstance(value.type, range) and isinstance(result.type, range):
                kind: Any = range(min(value.type.start, result.type.start), max(value.type.stop, result.type.stop))
            else:
                kind = value.type
            condition = sct.LocationReference(location=location)
            choice = ex.Conditional(condition=condition, then=value.expression, otherwise=result.expression)
            result = TypedNode(declared.node, choice, kind)
        assert result is not None
        return result

    def equations(self, scope: Scope) -> dict[str, list[tuple[sct.Location | None, Any]]]:
        """Return the equations of a scope by variable; an equation in a location comes with that location."""
        if scope not in self._equations:
            known = self._equations[scope] = {}
            located_equations: list[tuple[sct.Location | None, Any]] = [
                (None, equation) for declared in scope.declarations("Equations") for equation in declared.equations
            ]
            if scope.plant is not None and scope.kind is not None:
                for location, node in zip(scope.plant.locations, scope.bodies[0].locations, strict=True):
                    for element in node.elements:
                        if type(element).__name__ == "Equations":
                            located_equations += [(location, equation) for equation in element.equations]
            for place, equation in located_equations:
                if equation.derivative:
                    raise construct(equation, "continuous variables", "use them only in simulation")
                known.setdefault(plain(equation.name), []).append((place, equation.value))
        return self._equations[scope]

    # Types

    def synthesized_type(self, node: Any, scope: Scope) -> Type:
        """Return the type of a variable or channel. Raises CifFaultError if synthesis does not have the type."""
        kind: Type | ForeignType = self.declared_type(node, scope)
        if isinstance(kind, ForeignType):
            hint = "synthesis takes `bool`, ranges of `int` and `enum`"
            raise construct(node, f"the type `{kind.word}`", hint)
        return kind

    def declared_type(self, node: Any, scope: Scope) -> Any:
        """Return the type of a declaration: `int` if it has no range, and a ForeignType for static values only."""
        match type(node).__name__:
            case "Boolean":
                return BOOLEAN
            case "Integer":
                return "int" if node.low is None else self._range(node, scope)
            case "ForeignType":
                return self._foreign_type(node, scope)
        declared = self.names.find(node.type, scope)
        if isinstance(declared, Declaration) and declared.kind == "Enumeration":
            return self.enumeration(declared)
        if not isinstance(declared, Declaration) or declared.kind != "Types":
            raise CifFaultError(node, "type", f"`{node.type.text}` is not a type")
        return self.known(declared)

    def _foreign_type(self, node: Any, scope: Scope) -> ForeignType:
        fields = [(part.type, plain(name.name)) for part in node.fields for name in part.names]
        kinds = [kind for kind in (node.keys, node.elements, *(kind for kind, _ in fields)) if kind is not None]
        sizes = None
        if node.size is not None:
            low, high = (self.constant(bound, scope)[0] for bound in (node.size.low, node.size.high or node.size.low))
            sizes = range(low, high + 1)
        parts_of = tuple(self.declared_type(kind, scope) for kind in kinds)
        return ForeignType(node.word, parts_of, tuple(name for _, name in fields), sizes)

    def _range(self, node: Any, scope: Scope) -> range:
        (low, lowest), (high, highest) = (self.constant(bound, scope) for bound in (node.low, node.high))
        if not isinstance(lowest, range) or not isinstance(highest, range):
            raise CifFaultError(node, "type", "the bounds of an int are whole numbers")
        if low > high:
            raise CifFaultError(node, "integer-range", f"the range int[{low}..{high}] is empty")
        return range(low, high + 1)

    def enumeration(self, declared: Declaration) -> ex.Enumeration:
        """Return the enumeration of a declaration."""
        if declared.element is None:
            declared.element = ex.Enumeration(name=declared.name, origin=declared.scope.path or None)
            declared.element.literals.extend(
                ex.EnumerationLiteral(name=plain(literal.name)) for literal in declared.node.literals
            )
        enumeration: ex.Enumeration = declared.element
        return enumeration


def _literal(node: Any, rule: str) -> TypedNode:
    """Return the value of a literal."""
    match rule:
        case "Truth":
            return static_node(node, node.value == "true")
        case "Real":
            return static_node(node, float(node.value))
        case "String":
            escapes = {"n": "\n", "t": "\t"}
            return static_node(node, re.sub(r"\\(.)", lambda match: escapes.get(match[1], match[1]), node.value[1:-1]))
    value = int(node.value) if len(node.value) < 12 else LARGEST + 1
    if value > LARGEST:
        raise CifFaultError(node, "integer-range", "an int is at most 2147483647")
    return static_node(node, value)


def _too_large(node: Any, what: str, most: int) -> CifFaultError:
    message = f"{what} has more than {most} operators and operands"
    return CifFaultError(node, "cif-construct", message, "move parts of it to automata with variables")


def computed_from_itself(named: Definition) -> CifFaultError:
    """Return the fault of a definition or an argument that is computed from itself."""
    if isinstance(named, Declaration):
        verb = "defined by" if named.kind == "Types" else "computed from"
        return CifFaultError(named.node, "cyclic-definition", f"`{named.name}` is {verb} itself")
    return CifFaultError(named.node, "cyclic-definition", "the argument of the parameter is computed from itself")
