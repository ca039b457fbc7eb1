"""Meaning of names in a robot's text: components, templates, constants, conditions, functions, quantifiers."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

from robosc.analysis.verify.model_reading.machine import BOOLEANS, At, Literal, Meaning, Plant, Slot
from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.evaluation import evaluate, literal
from robosc.model.semantics.operators import operator_of
from robosc.model.semantics.walks import fold, operands, walk, with_operands

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import Domain

_Definition = TypeVar("_Definition")
_LITERALS = (ex.BooleanLiteral, ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*+"?|\d+(?:\.\d+)?|\w+|\.\.|=>|!=|<=|>=|[^\s()^]')
#: Kinds of the plants of communications that others call.
_SERVED = {robosc.OutgoingService: "serviceServer", robosc.OutgoingAction: "actionServer"}
#: Location of a service while it is running; an action has two.
_WHILE_RUNNING = {"service": "wait_for_response", "serviceServer": "open"}
#: Functions that the supervisor computes, of integers.
_OF_SUPERVISOR = ("abs", "min", "max", "mod")
#: Requirements that follow events: they have states of their own.
OBSERVERS = (robosc.OrderRequirement, robosc.CountRequirement, robosc.AutomatonRequirement)


class NotReadError(Exception):
    """Element of the text that this reading does not support."""

    def __init__(self, element: ex.Located) -> None:
        super().__init__(f"`{type(element).__name__}` is not read a second time")


@dataclass(frozen=True, eq=False)
class Instance:
    """A component of the robot, and the component whose text it is an instance of."""

    name: str
    text: robosc.Component
    arguments: Mapping[robosc.FormalParameter, tuple[ex.Expression, Environment]] = field(default_factory=dict)
    remapped: Mapping[robosc.CommunicationType, tuple[robosc.TopicRemapping, Environment]] = field(default_factory=dict)

    def of(self, kind: type[_Definition]) -> list[_Definition]:
        """Return the definitions of a kind, in the order of the text."""
        assert isinstance(self.text.type, robosc.LocalComponent)
        return [definition for definition in self.text.type.definitions if isinstance(definition, kind)]

    def behaviour(self, kind: type[_Definition]) -> list[_Definition]:
        """Return the definitions of a kind in the component's automaton."""
        automata = self.of(robosc.ComponentBehaviour)
        definitions = (definition for behaviour in automata for definition in behaviour.automaton.definitions)
        return [definition for definition in definitions if isinstance(definition, kind)]

    @property
    def plant(self) -> Plant:
        """Plant of the behavior."""
        return Plant("behaviour", self.name)

    @property
    def place(self) -> Environment:
        """Context of the component's text."""
        return Environment(self, self.arguments)


class Environment(NamedTuple):
    """Context of an expression: the instance that contains it, bound parameters, and quantified instances.

    A template before which `each` stands is at hand, too.
    """

    within: Instance | None = None
    bound: Mapping[robosc.FormalParameter, tuple[ex.Expression, Environment]] = {}
    at_hand: Mapping[robosc.Component, Instance] = {}


class Data(NamedTuple):
    """Part of an event's data or of a stored value: its text word by word.

    `path` are the properties that lead to it; None for an element and for stored data. `segments` are the segments of
    its access. `stored` is its variable; None if it is a part of the event's data.
    """

    words: tuple[str, ...]
    path: tuple[str, ...] | None
    segments: tuple[robosc.AccessSegment, ...] = ()
    stored: tuple[robosc.Variable, Instance] | None = None


class Names:
    """Instances of a robot, and its expressions with names expanded."""

    def __init__(self, robot: robosc.Base) -> None:
        self.robot = robot
        self._meanings: dict[ex.Expression, Meaning | Data] = {}
        self._changing: dict[ex.Expression, bool] = {}
        #: Words of expressions that the text names otherwise than their meaning, and of those with a place in a plant.
        self._named: dict[ex.Expression, tuple[str, ...]] = {}
        #: Instances by component and number. The number of a component that is no fleet is None.
        self._of: dict[tuple[robosc.Component, int | None], Instance] = {}
        for component in robot.definitions:
            if isinstance(component, robosc.Component) and not component.parameters:
                for number in self._numbers(component):
                    self._of[component, number] = _instance(component, number)
        #: Plants of the requirements with states of their own, by their automaton and context.
        self.observers: dict[tuple[robosc.Requirement, Instance | None, Instance | None], Plant] = {}
        for requirement, place in self.definitions(robosc.Requirement):
            if isinstance(requirement, OBSERVERS):
                number = len(self.observers) + 1
                self.observers[self._observer(requirement, place)] = Plant("requirement", str(number))
        self.assumptions = self._assumptions()

    def __iter__(self) -> Iterator[Instance]:
        return iter(self._of.values())

    def _numbers(self, component: robosc.Component) -> Sequence[int | None]:
        """Return the numbers of a component's instances: a fleet has several, any other component one without."""
        if component.first is None or component.last is None:
            return [None]
        first, last = (self.constant(bound, Environment()) for bound in (component.first, component.last))
        return range(first, last + 1)

    def definitions(self, kind: type[_Definition]) -> list[tuple[_Definition, Environment]]:
        """Return definitions outside of components, then those in each component, with their context.

        A definition with `each` is repeated: for every instance of its template. In the template's own text, the
        instance is the one with that text.
        """
        texts: list[tuple[Any, Environment]] = [(definition, Environment()) for definition in self.robot.definitions]
        texts += ((definition, instance.place) for instance in self for definition in instance.of(kind))
        return [
            (definition, each)
            for definition, place in texts
            if isinstance(definition, kind)
            for each in self._repeated(definition, place)
        ]

    def _repeated(self, definition: Any, place: Environment) -> list[Environment]:
        template = definition.template if isinstance(definition, robosc.StatedDefinition) else None
        if template is None:
            return [place]
        if place.within is not None and place.within.text is template:
            return [place._replace(at_hand={template: place.within})]
        return [place._replace(at_hand={template: instance}) for instance in self if instance.text is template]

    def _observer(
        self, requirement: robosc.Requirement, place: Environment
    ) -> tuple[robosc.Requirement, Instance | None, Instance | None]:
        """Return the key of a requirement at its own place."""
        template = requirement.template
        return requirement, place.within, None if template is None else place.at_hand[template]

    def observer(self, requirement: robosc.Requirement, place: Environment) -> Plant:
        """Return the plant of a requirement with states of its own, at its own place."""
        return self.observers[self._observer(requirement, place)]

    def _assumptions(self) -> list[tuple[robosc.Assumption, Environment]]:
        """Return the assumptions. One outside of the components of a library is about each import of its component."""
        assumptions = self.definitions(robosc.Assumption)
        for instance in self:
            library = instance.text.eContainer()
            for assumption in library.definitions if library is not self.robot else ():
                if isinstance(assumption, robosc.Assumption):
                    first = assumption.target.events[0].communicationType
                    if first.component is instance.text:
                        assumptions.append((assumption, instance.place))
        return assumptions

    def port(
        self, reference: robosc.CommunicationReference, place: Environment
    ) -> tuple[Instance, robosc.CommunicationType]:
        """Return the instance and the communication that a reference names."""
        return self._instance_of(reference.component, place, reference.index), reference.communicationType

    def _instance_of(
        self, component: robosc.Component | None, place: Environment, index: ex.Expression | None = None
    ) -> Instance:
        if component is not None and component in place.at_hand:
            return place.at_hand[component]
        if place.within is not None and (component is None or component is place.within.text):
            return place.within
        assert component is not None
        return self._of[component, None if index is None else self.constant(index, place)]

    def written_out(self, expression: ex.Expression, place: Environment) -> ex.Expression:
        """Return a new expression without names of expressions; `meaning` resolves its references."""
        expanded: ex.Expression = walk(self._write, (expression, place))
        return expanded

    def meaning(self, reference: ex.Expression) -> Meaning | Data:
        """Return the meaning of a reference."""
        return self._meanings[reference]

    def leaf(self, meaning: Meaning | Data) -> ex.Expression:
        """Return an expression with this meaning."""
        access = robosc.Access()
        self._meanings[access] = meaning
        return access

    def constant(self, expression: ex.Expression, place: Environment) -> Any:
        """Return the value of a constant expression; the value of an enum is a Literal."""
        return evaluate(self.written_out(expression, place), self._meanings.__getitem__)

    def parameter(self, expression: ex.Expression, place: Environment) -> str | None:
        """Return the ROS name if the expression is a parameter, else None."""
        if not isinstance(expression, robosc.Access) or not isinstance(expression.item, robosc.Parameter):
            return None
        is_member = _is_member(expression.item)
        owner = f"{self._instance_of(expression.component, place, expression.index).name}." if is_member else ""
        return f"{owner}{expression.item.name}"

    def settings(self, expression: ex.Expression, place: Environment) -> tuple[float, float, float]:
        """Return the default, least and greatest value of the parameter that an expression consists of."""
        assert isinstance(expression, robosc.Access)
        parameter = expression.item
        assert isinstance(parameter, robosc.Parameter)
        inside = Environment()
        if _is_member(parameter):
            inside = self._inside(parameter, self._instance_of(expression.component, place, expression.index))
        whole = self.domain(parameter.type, inside)
        first = self.constant(parameter.value, inside)
        if isinstance(whole, range):
            return first, whole[0], whole[-1]
        assert parameter.lowest is not None
        assert parameter.highest is not None
        return first, self.constant(parameter.lowest, inside), self.constant(parameter.highest, inside)

    def topic(self, instance: Instance, communication: robosc.CommunicationType) -> str:
        """Return the ROS name of a communication: by its import `with`, by its identifier, or its own name."""
        named: Any
        named, place = instance.remapped.get(communication, (communication, instance.place))
        topic = named.identifier if named.computedIdentifier is None else self.constant(named.computedIdentifier, place)
        return str(topic or communication.name)

    def domain(self, declared: robosc.DataType, place: Environment) -> Domain | None:
        """Return the values of a type; None if it is infinite."""
        if isinstance(declared, robosc.BooleanDataType):
            return BOOLEANS
        if isinstance(declared, robosc.IntegerDataType):
            low, high = declared.minimum, declared.maximum
            if low is None and declared.lower is not None and declared.upper is not None:
                low, high = self.constant(declared.lower, place), self.constant(declared.upper, place)
            return None if low is None or high is None else range(low, high + 1)
        if isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.EnumDataType):
            return tuple(dict.fromkeys(rule.value.name for rule in declared.type.rules))
        return None

    def _write(self, node: tuple[ex.Expression, Environment]) -> Generator[Any, Any, ex.Expression]:
        expression, place = node
        match expression:
            case robosc.Access():
                return (yield from self._access(expression, place))
            case robosc.Call(function=function):
                arguments = {
                    parameter: (argument, place)
                    for parameter, argument in zip(function.parameters, expression.arguments, strict=True)
                }
                inner = self._inside(function, place.within)
                body = yield function.value, inner._replace(bound={**inner.bound, **arguments})
                return cast("ex.Expression", body)
            case robosc.InstanceQuantifier():
                return (yield from self._quantified(expression, place))
            case robosc.ErrorReason():
                return self.leaf(Data(("error",), None))
            case robosc.IntegerText():
                number = yield expression.operand, place
                return ex.StringLiteral(value=str(evaluate(number, self._meanings.__getitem__)))
            case robosc.ArrayQuantifier():
                array = yield expression.array, place
                body = yield expression.body, place
                head = (str(expression.quantifier), expression.element.name, "in")
                return self.leaf(Data((*head, *self._words(array), ":", *self._words(body)), None))
            case _ if isinstance(expression, _LITERALS):
                kind: Any = type(expression)
                copy: ex.Expression = kind(value=expression.value)
                return copy
        inside = []
        for operand in operands(expression):
            inside.append((yield operand, place))  # noqa: PERF401 - a comprehension cannot contain `yield`
        return with_operands(expression, inside)

    def _access(self, access: robosc.Access, place: Environment) -> Generator[Any, Any, ex.Expression]:
        item = access.item
        match item:
            case None | robosc.ArrayElement():
                return (yield from self._data(access, place))
            case robosc.FormalParameter():
                argument: ex.Expression = yield place.bound[item]
                # Arguments of an instance are constant; arguments of a function may be any expressions.
                is_constant = isinstance(item.eContainer(), robosc.Component)
                return self._folded(argument) if is_constant else (yield from self._part(argument, access, place))
            case robosc.EnumValue():
                return self.leaf(Literal(item.name))
            case robosc.Parameter():
                # A parameter is data, because only the node computes with it: the supervisor reads none.
                named = self._instance_of(access.component, place, access.index) if access.component else None
                owner = (named.name, ".") if named is not None else ()
                return self.leaf(Data((*owner, item.name), None))
            case robosc.RequirementState():
                automaton = item.eContainer()
                reached = self.leaf(At(Slot(self._automaton(access, automaton, place)), item.name))
                return self._called(reached, automaton.name, item.name)
        is_member = access.component is not None or _is_member(item)
        instance = self._instance_of(access.component, place, access.index) if is_member else None
        match item:
            case robosc.State() if instance is not None:
                return self._called(self.leaf(At(Slot(instance.plant), item.name)), instance.name, item.name)
            case robosc.Variable() if instance is not None:
                return (yield from self._variable(access, instance, place))
            case robosc.Service() | robosc.Action() | robosc.OutgoingService() | robosc.OutgoingAction() if (
                instance is not None
            ):
                return self._running(item, instance)
        if not isinstance(item, robosc.Constant | robosc.Condition):
            raise NotReadError(item)
        value: ex.Expression = yield item.value, self._inside(item, instance)
        return self._folded(value) if isinstance(item, robosc.Constant) else value

    def _variable(
        self, access: robosc.Access, instance: Instance, place: Environment
    ) -> Generator[Any, Any, ex.Expression]:
        """Return a variable of the supervisor, or data that only the node stores."""
        variable = access.item
        assert isinstance(variable, robosc.Variable)
        if self._is_data(variable.type):
            start = self.leaf(Data((instance.name, ".", variable.name), None, (), (variable, instance)))
            return (yield from self._part(start, access, place))
        return self._called(self.leaf(Slot(instance.plant, variable.name)), instance.name, variable.name)

    def _is_data(self, declared: robosc.DataType) -> bool:
        """Return whether a variable of the type exists only in the node."""
        named = declared.type if isinstance(declared, robosc.ComplexDataTypeReference) else None
        only_node = robosc.DoubleDataType | robosc.StringDataType | robosc.Array
        return isinstance(declared, only_node) or isinstance(named, robosc.ObjectDataType)

    def _called(self, expression: ex.Expression, *names: str) -> ex.Expression:
        """Return the expression, which the text calls by these names with dots between them."""
        self._named[expression] = tuple(word for name in names for word in (".", name))[1:]
        return expression

    def _automaton(self, access: robosc.Access, automaton: robosc.AutomatonRequirement, place: Environment) -> Plant:
        """Return the plant of an automaton: with `each`, that of the instance in brackets or at hand."""
        inside = isinstance(automaton.eContainer(), robosc.LocalComponent)
        instance = None if automaton.template is None else place.at_hand.get(automaton.template)
        if isinstance(access.index, robosc.Access) and isinstance(access.index.item, robosc.Component):
            instance = self._instance_of(access.index.item, place, access.index.index)
        if instance is not None and instance.text is automaton.eContainer().eContainer():
            return self.observers[automaton, instance, instance]
        return self.observers[automaton, place.within if inside else None, instance]

    def _running(self, call: robosc.CommunicationType, instance: Instance) -> ex.Expression:
        """Return the condition that a service or action was requested and its end is not known.

        One that others call is running while a request or goal is open.
        """
        kind = kind_of(call)
        slot = Slot(Plant(kind, f"{instance.name}.{call.name}"))
        if kind in _WHILE_RUNNING:
            running = self.leaf(At(slot, _WHILE_RUNNING[kind]))
        else:
            running = ex.Disjunction(left=self.leaf(At(slot, "executing")), right=self.leaf(At(slot, "canceling")))
        return self._called(running, instance.name, call.name, "running")

    def _folded(self, constant: ex.Expression) -> ex.Expression:
        """Return the value of an expanded constant expression, as an expression."""
        folded = evaluate(constant, self._meanings.__getitem__)
        return self.leaf(folded) if isinstance(folded, Literal) else literal(folded)

    def _inside(self, named: robosc.NamedExpression, owner: Instance | None) -> Environment:
        """Return the context of a definition's text."""
        return owner.place if owner is not None and _is_member(named) else Environment()

    def _quantified(
        self, quantifier: robosc.InstanceQuantifier, place: Environment
    ) -> Generator[Any, Any, ex.Expression]:
        bodies: list[ex.Expression] = []
        for instance in self:
            if instance.text is quantifier.template:
                body = yield quantifier.body, place._replace(at_hand={**place.at_hand, quantifier.template: instance})
                bodies.append(body)
        if quantifier.quantifier == robosc.Quantifier.count:
            number = ex.IntegerLiteral
            bodies = [
                ex.Conditional(condition=body, then=number(value=1), otherwise=number(value=0)) for body in bodies
            ]
            combined: Any = ex.Addition
            nothing: ex.Expression = number(value=0)
        else:
            everyone = quantifier.quantifier == robosc.Quantifier.all
            combined = ex.Conjunction if everyone else ex.Disjunction
            nothing = ex.BooleanLiteral(value=everyone)
        return reduce(lambda left, right: combined(left=left, right=right), bodies) if bodies else nothing

    def _data(self, access: robosc.Access, place: Environment) -> Generator[Any, Any, ex.Expression]:
        path = None if access.item else ()
        start = self.leaf(Data((access.item.name if access.item else "value",), path))
        return (yield from self._part(start, access, place))

    def _part(
        self, start: ex.Expression, access: robosc.Access, place: Environment
    ) -> Generator[Any, Any, ex.Expression]:
        """Return the part of some data to which the segments of an access lead."""
        whole = self._meanings.get(start)
        if not access.segments:
            return start
        assert isinstance(whole, Data)
        words, path = list(whole.words), whole.path
        for segment in access.segments:
            if isinstance(segment, robosc.PropertySegment):
                path = None if path is None else (*path, segment.property.name)
                words += [".", segment.property.name]
                continue
            assert isinstance(segment, robosc.IndexSegment)
            path = None
            words += ["["]
            if segment.first is None:
                words.append(str(segment.index))
            else:
                words += self._words((yield segment.first, place))
            if segment.last is not None:
                words += ["..", *self._words((yield segment.last, place))]
            words += ["]"]
        return self.leaf(Data(tuple(words), path, (*whole.segments, *access.segments), whole.stored))

    def words(self, expression: ex.Expression) -> tuple[str, ...] | None:
        """Return the text of an expression over data as words without parentheses; None if it reads slots."""
        changing = fold(self._changes, expression, memo=self._changing)
        return None if changing else tuple(self._words(expression))

    def all_words(self, expression: ex.Expression) -> tuple[str, ...]:
        """Return the text of an expression, also over slots, as `words` does."""
        return tuple(self._words(expression))

    def words_of_node(self, expression: ex.Expression) -> tuple[str, ...] | None:
        """Return the text of an expression over slots that only the node can compute, as `words` does.

        None if the supervisor can compute it.
        """
        is_of_node = fold(self._needs_node, expression)
        return tuple(self._words(expression)) if is_of_node else None

    def _needs_node(self, part: ex.Expression, inside: Sequence[bool]) -> bool:
        """Return whether only the node can compute a part. The supervisor computes an `and` of others itself."""
        if isinstance(part, ex.Conjunction | ex.Disjunction | ex.Implication | ex.Negation):
            return all(inside)
        is_of_node = isinstance(part, ex.FunctionCall) and part.function not in _OF_SUPERVISOR
        return is_of_node or isinstance(self._meanings.get(part), Data) or any(inside)

    def _changes(self, part: ex.Expression, inside: Sequence[bool]) -> bool:
        return isinstance(self._meanings.get(part), Slot | At) or any(inside)

    def _words(self, expression: ex.Expression) -> list[str]:
        return fold(self._part_words, expression)

    def _part_words(self, part: ex.Expression, inside: list[list[str]]) -> list[str]:
        meaning = self._meanings.get(part)
        if part in self._named:
            return list(self._named[part])
        if isinstance(meaning, Data):
            return list(meaning.words)
        if isinstance(meaning, Slot | At):
            return []  # a part of an expression that the text calls by a name
        if isinstance(meaning, Literal):
            return [str(meaning)]
        if isinstance(part, ex.Conditional):
            condition, then, otherwise = inside
            return ["if", *condition, "then", *then, "else", *otherwise]
        row = operator_of(part)
        if row is None:
            assert isinstance(part, _LITERALS)
            return [_word(part)]
        if isinstance(part, ex.FunctionCall):
            return [row.symbol, *reduce(lambda words, more: [*words, ",", *more], inside)]
        return [*(inside[0] if len(inside) == 2 else ()), row.symbol, *inside[-1]]


def kind_of(communication: robosc.CommunicationType) -> str:
    """Return the kind of a communication's plant."""
    return _SERVED.get(type(communication), type(communication).__name__.lower())


def words_of(text: str) -> tuple[str, ...]:
    """Return the words of a text without parentheses, with numbers as Python writes them."""
    return tuple(str(float(word)) if re.fullmatch(r"\d+\.\d+", word) else word for word in _TOKEN.findall(text))


def _word(part: Any) -> str:
    if isinstance(part, ex.BooleanLiteral):
        return str(part.value).lower()
    if isinstance(part, ex.StringLiteral):
        return '"' + part.value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(part.value)


def _is_member(item: Any) -> bool:
    """Return whether a definition is in a component: states and variables in its automaton, others directly."""
    return isinstance(item, robosc.State | robosc.Variable) or isinstance(item.eContainer(), robosc.LocalComponent)


def _instance(component: robosc.Component, number: int | None) -> Instance:
    """Return an instance of a component, with the arguments along the chain of `is` and `import`."""
    arguments: dict[robosc.FormalParameter, tuple[ex.Expression, Environment]] = {}
    remapped: dict[robosc.CommunicationType, tuple[robosc.TopicRemapping, Environment]] = {}
    own: dict[robosc.FormalParameter, tuple[ex.Expression, Environment]] = {}
    if number is not None and component.number is not None:
        own[component.number] = ex.IntegerLiteral(value=number), Environment()
    text = component
    while not isinstance(text.type, robosc.LocalComponent):
        instantiation = text.type
        assert isinstance(instantiation, robosc.InstantiatedComponent | robosc.ImportedComponent)
        text = instantiation.definition
        outside = Environment(bound={**own, **arguments})
        for position, argument in enumerate(instantiation.arguments):
            arguments[argument.parameter or text.parameters[position]] = argument.value, outside
        for parameter in text.parameters:
            if parameter.default is not None and parameter not in arguments:
                arguments[parameter] = parameter.default, Environment()
        for remapping in instantiation.remappings if isinstance(instantiation, robosc.ImportedComponent) else ():
            remapped.setdefault(remapping.communicationType, (remapping, outside))
    name = component.name if number is None else f"{component.name}{number}"
    return Instance(name, text, arguments, remapped)
