"""Values and types of expressions: constants, algebraic variables, named types."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.language.cif.expressions import ExpressionReader, TypedNode, referenced_names
from robosc.language.cif.faults import CHANNELS, CifFaultError, construct
from robosc.language.cif.scopes import Argument, Declaration, Scope, Specification, plain
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cif_types import BOOLEAN, LARGEST, Type, contains, format_type
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.printing import conjunction
from robosc.model.semantics.walks import copy_tree, parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


#: Size limits after expanding names, in operators and operands: of one expression, and of the whole specification.
_LARGEST, _LARGEST_IN_ALL = 20_000, 100_000
#: Operands that synthesis does not support, and hints to replace them.
_FOREIGN = {
    "Received": ("channels", CHANNELS),
    "Time": ("time", "model the passing of time by events"),
    "Real": ("reals", "write whole numbers"),
    "String": ("strings", "write an enumeration"),
    "Collection": ("lists, sets and dictionaries", "write a variable for each element"),
}
#: Maximum nesting depth of definitions. Definitions that are read one after the other are unlimited.
_DEEPEST = 30
#: Constructs with a name and a suffix, by the first character of the suffix.
_SUFFIXES = {"'": "derivatives", "(": "functions", "[": "elements of lists and tuples"}
_DEFINED = ("Constants", "Algebraics", "Types")
_MINMAX = {"min": min, "max": max}


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

    def typed(self, read: Any, scope: Scope) -> TypedNode:
        """Return the value of an expression in a scope. Raises CifFaultError."""
        made = self._nested(read, scope)
        if isinstance(made.type, sct.Plant):
            raise CifFaultError(read, "type", "an automaton is no value", "name one of its locations")
        return made

    def whole(self, read: Any, scope: Scope) -> TypedNode:
        """Return the value of an expression that has its own size limit. Raises CifFaultError."""
        self._size = 0
        return self.typed(read, scope)

    def condition(self, reads: Sequence[Any], scope: Scope) -> ex.Expression | None:
        """Return the conjunction of boolean expressions, or None if there are none."""
        made = []
        for read in reads:
            boolean = self.whole(read, scope)
            if boolean.type != BOOLEAN:
                raise CifFaultError(read, "type", f"a condition is bool, this is {format_type(boolean.type)}")
            made.append(boolean.expression)
        return conjunction(made)

    def constant(self, read: Any, scope: Scope) -> tuple[Any, Type]:
        """Return the value of a constant expression, and its type."""
        made = self.whole(read, scope)
        value = constant_value(made.expression)
        if value is None:
            raise CifFaultError(read, "type", "this is no constant")
        return value, range(value, value + 1) if isinstance(made.type, range) else made.type

    def _nested(self, read: Any, scope: Scope) -> TypedNode:
        reader = ExpressionReader(read, lambda value, switched: self._operand(value, scope, switched), self._grow)
        return reader.result

    def _operand(self, read: Any, scope: Scope, switched: sct.Plant | None) -> TypedNode:
        match type(read).__name__:
            case "Truth":
                return TypedNode(read, ex.BooleanLiteral(value=read.value == "true"), BOOLEAN)
            case "Number":
                value = int(read.value) if len(read.value) < 12 else LARGEST + 1
                if value > LARGEST:
                    raise CifFaultError(read, "integer-range", "an int is at most 2147483647")
                return TypedNode(read, ex.IntegerLiteral(value=value), range(value, value + 1))
            case "Parenthesis":
                return self._nested(read.inner, scope)._replace(node=read)
            case "Call":
                return self._call(read, scope)
            case "Reference":
                return self._reference(read, scope, switched)
            case "Own":
                if scope.plant is None:
                    raise CifFaultError(read, "type", "`self` stands in automata only")
                return TypedNode(read, None, scope.plant)
        raise construct(read, *_FOREIGN[type(read).__name__])

    def _call(self, read: Any, scope: Scope) -> TypedNode:
        name = read.function.strip()
        if name not in ("min", "max", "abs"):
            raise construct(read, f"the function `{name}`", "synthesis computes with `min`, `max` and `abs` only")
        given = [self._nested(argument, scope) for argument in read.arguments]
        wanted = 1 if name == "abs" else 2
        if len(given) != wanted:
            raise CifFaultError(
                read, "argument", f"`{name}` takes {wanted} argument{'s'[: wanted - 1]}, found {len(given)}"
            )
        for argument, value in zip(read.arguments, given, strict=True):
            if not isinstance(value.type, range):
                raise CifFaultError(argument, "type", f"`{name}` wants an int")
        made = ex.FunctionCall(function=name, arguments=[value.expression for value in given])
        bounds = [(value.type.start, value.type.stop - 1) for value in given if isinstance(value.type, range)]
        if name == "abs":
            [(low, high)] = bounds
            return TypedNode(read, made, range(max(low, -high, 0), max(-low, high) + 1))
        least, most = (_MINMAX[name](ends) for ends in zip(*bounds, strict=True))
        return TypedNode(read, made, range(least, most + 1))

    def _reference(self, read: Any, scope: Scope, switched: sct.Plant | None) -> TypedNode:
        if read.suffix:
            what = _SUFFIXES[read.suffix[0]]
            raise construct(read, what, "write an algebraic variable for what it computes")
        if switched is not None:
            own = next((location for location in switched.locations if location.name == plain(read.name.text)), None)
            if own is not None:
                return TypedNode(read, sct.LocationReference(location=own), BOOLEAN)
        made = self._value(read, self.names.find(read.name, scope))
        if switched is not None and not isinstance(made.expression, sct.LocationReference):
            raise CifFaultError(read, "type", f"`{read.name.text}` is no location of `{switched.name}`")
        return made

    def _value(self, read: Any, found: Any) -> TypedNode:
        match found:
            case sct.Location():
                return TypedNode(read, sct.LocationReference(location=found), BOOLEAN)
            case Scope(plant=sct.Plant() as plant):
                return TypedNode(read, None, plant)
            case Argument():
                return self._copied(read, found)
            case Declaration(kind="Constants" | "Algebraics"):
                return self._copied(read, found)
            case Declaration(kind="Variables" | "Inputs"):
                if found.element is None:
                    # A variable that is declared later has no fault yet, but a constant cannot read it.
                    raise found.fault or CifFaultError(read, "type", "this is no constant")
                return TypedNode(read, sct.VariableReference(variable=found.element), found.type)
            case Declaration(kind="Literal"):
                enumeration = self.enumeration(found.outer)
                literal = next(literal for literal in enumeration.literals if literal.name == found.name)
                return TypedNode(read, ex.EnumerationLiteralReference(literal=literal), enumeration)
        raise CifFaultError(read, "type", f"`{read.name.text}` has no value")

    def _copied(self, read: Any, named: Definition) -> TypedNode:
        made: TypedNode = self.known(named)
        if named not in self._sizes:
            self._sizes[named] = sum(1 for _ in parts(made.expression))
        self._grow(read, self._sizes[named])
        return TypedNode(read, copy_tree(made.expression), made.type)

    def _grow(self, read: Any, more: int) -> None:
        """Count the nodes that a name adds to an expression. Raises CifFaultError if a size limit is exceeded."""
        self._size += more
        self._size_in_all += more
        if self._size > _LARGEST:
            raise _too_large(read, "what the names in the expression stand for", _LARGEST)
        if self._size_in_all > _LARGEST_IN_ALL:
            what = "what all names in expressions stand for"
            self._exhausted = self._exhausted or _too_large(read, what, _LARGEST_IN_ALL)
            raise self._exhausted

    # Definitions

    def known(self, found: Definition) -> Any:
        """Return the value of a constant, an algebraic variable or an argument, or the type behind a name.

        Its operands are settled first without recursion, because a chain of definitions may exceed Python's stack. The
        fault of a definition is reported once. Raises CifFaultError.
        """
        if found not in self._known and found not in self._open:
            self._settle(found)
        if found not in self._known:
            raise computed_from_itself(found)
        made = self._known[found]
        if isinstance(made, CifFaultError):
            raise made
        return made

    def _settle(self, found: Definition) -> None:
        path = {found: iter(self._uses(found))}
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

    def _uses(self, found: Definition) -> Iterator[Definition]:
        """Yield the definitions and arguments that one names, except those that are keys of a `switch`."""
        scope = found.scope
        types = (
            [found.outer.type if found.kind != "Types" else found.node.type] if isinstance(found, Declaration) else []
        )
        reads = [
            bound for kind in types if type(kind).__name__ == "Integer" for bound in (kind.low, kind.high) if bound
        ]
        names = [kind.type for kind in types if type(kind).__name__ == "NamedType"]
        if isinstance(found, Argument) or (found.kind != "Types" and found.node.value is not None):
            reads.append(found.node if isinstance(found, Argument) else found.node.value)
        elif found.kind == "Algebraics":
            with suppress(CifFaultError):
                reads += [equation for _, equation in self.equations(scope).get(found.name, ())]
        for name in (*names, *(name for read in reads for name in referenced_names(read))):
            with suppress(CifFaultError):
                used = self.names.find(name, scope)
                if isinstance(used, Argument) or (isinstance(used, Declaration) and used.kind in _DEFINED):
                    yield used

    def _create(self, found: Definition) -> Any:
        """Return the value of a definition or an argument, or its fault."""
        if len(self._open) > _DEEPEST:
            return CifFaultError(found.node, "cif-construct", "definitions lie too deep within each other")
        before, self._size = self._size, 0
        self._open.add(found)
        try:
            if isinstance(found, Argument):
                return self.typed(found.node, found.scope)
            if found.kind == "Types":
                return self.declared_type(found.node.type, found.scope)
            return self._computed(found)
        except CifFaultError as fault:
            return fault
        finally:
            self._open.remove(found)
            self._size = before

    def _computed(self, found: Declaration) -> TypedNode:
        """Return the value of a constant or an algebraic variable."""
        kind = self.declared_type(found.outer.type, found.scope)
        made = self._equation(found) if found.kind == "Algebraics" else self._fixed(found)
        if not (isinstance(made.type, range) if kind == "int" else contains(kind, made.type)):
            raise CifFaultError(
                found.node, "type", f"`{found.name}` is {format_type(kind)}, its value {format_type(made.type)}"
            )
        return made

    def _fixed(self, found: Declaration) -> TypedNode:
        value, kind = self.constant(found.node.value, found.scope)
        return TypedNode(found.node, literal(value), kind)

    def _equation(self, found: Declaration) -> TypedNode:
        """Return the value of an algebraic variable from its declaration, an equation, or an equation per location."""
        if found.node.value is not None:
            return self.typed(found.node.value, found.scope)
        equations = self.equations(found.scope).get(found.name, [])
        if not equations:
            raise CifFaultError(
                found.node, "cif-declaration", f"nothing says what `{found.name}` is", "add an equation for it"
            )
        made: TypedNode | None = None
        for location, read in reversed(equations):
            value = self.typed(read, found.scope)
            if made is None or location is None:
                made = value
                continue
            if isinstance(value.type, range) and isinstance(made.type, range):
                kind: Any = range(min(value.type.start, made.type.start), max(value.type.stop, made.type.stop))
            else:
                kind = value.type
            condition = sct.LocationReference(location=location)
            choice = ex.Conditional(condition=condition, then=value.expression, otherwise=made.expression)
            made = TypedNode(found.node, choice, kind)
        assert made is not None
        return made

    def equations(self, scope: Scope) -> dict[str, list[tuple[sct.Location | None, Any]]]:
        """Return the equations of a scope by variable; an equation in a location comes with that location."""
        if scope not in self._equations:
            known = self._equations[scope] = {}
            told: list[tuple[sct.Location | None, Any]] = [
                (None, equation) for declared in scope.declarations("Equations") for equation in declared.equations
            ]
            if scope.plant is not None and scope.kind is not None:
                for location, read in zip(scope.plant.locations, scope.bodies[0].locations, strict=True):
                    for element in read.elements:
                        if type(element).__name__ == "Equations":
                            told += [(location, equation) for equation in element.equations]
            for place, equation in told:
                if equation.derivative:
                    raise construct(equation, "continuous variables", "leave them to simulation")
                known.setdefault(plain(equation.name), []).append((place, equation.value))
        return self._equations[scope]

    # Types

    def declared_type(self, read: Any, scope: Scope) -> Type | str:
        """Return the type of a declaration; `int` if it has no range."""
        match type(read).__name__:
            case "Boolean":
                return BOOLEAN
            case "Integer":
                return "int" if read.low is None else self._range(read, scope)
            case "ForeignType":
                raise construct(read, f"the type `{read.word}`", "synthesis takes `bool`, ranges of `int` and `enum`")
        found = self.names.find(read.type, scope)
        if isinstance(found, Declaration) and found.kind == "Enumeration":
            return self.enumeration(found)
        if not isinstance(found, Declaration) or found.kind != "Types":
            raise CifFaultError(read, "type", f"`{read.type.text}` is no type")
        kind: Type | str = self.known(found)
        return kind

    def _range(self, read: Any, scope: Scope) -> range:
        (low, lowest), (high, highest) = (self.constant(bound, scope) for bound in (read.low, read.high))
        if not isinstance(lowest, range) or not isinstance(highest, range):
            raise CifFaultError(read, "type", "the bounds of an int are whole numbers")
        if low > high:
            raise CifFaultError(read, "integer-range", f"nothing is in int[{low}..{high}]")
        return range(low, high + 1)

    def enumeration(self, declared: Declaration) -> ex.Enumeration:
        """Return the enumeration of a declaration."""
        if declared.element is None:
            declared.element = ex.Enumeration(name=declared.name, origin=declared.scope.path or None)
            declared.element.literals.extend(
                ex.EnumerationLiteral(name=plain(literal.name)) for literal in declared.node.literals
            )
        found: ex.Enumeration = declared.element
        return found


def _too_large(read: Any, what: str, most: int) -> CifFaultError:
    message = f"{what} has more than {most} operators and operands"
    return CifFaultError(read, "cif-construct", message, "give parts of it to automata with variables")


def computed_from_itself(found: Definition) -> CifFaultError:
    """Return the fault of a definition or an argument that is computed from itself."""
    if isinstance(found, Declaration):
        verb = "defined by" if found.kind == "Types" else "computed from"
        return CifFaultError(found.node, "cyclic-definition", f"`{found.name}` is {verb} itself")
    return CifFaultError(found.node, "cyclic-definition", "what the parameter stands for is computed from itself")


class _ChangingError(Exception):
    """Signals that a value is not constant."""


def constant_value(expression: ex.Expression) -> Any:
    """Return the value of a constant expression, or None if it is not constant.

    The value is a bool, an int or an enumeration literal.
    """

    def read(reference: ex.Expression) -> Any:
        if isinstance(reference, ex.EnumerationLiteralReference):
            return reference.literal
        raise _ChangingError

    try:
        return evaluate(expression, read)
    except _ChangingError:
        return None


def literal(value: Any) -> ex.Expression:
    """Return a value as a literal."""
    if isinstance(value, bool):
        return ex.BooleanLiteral(value=value)
    if isinstance(value, ex.EnumerationLiteral):
        return ex.EnumerationLiteralReference(literal=value)
    whole = ex.IntegerLiteral(value=abs(int(value)))
    return ex.UnaryMinus(operand=whole) if value < 0 else whole
