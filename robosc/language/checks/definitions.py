"""Own definitions of a robot or library, in the order of its text; `libraries` has its imports."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from robosc.model import robosc as rsc
from robosc.model.semantics.communication import carrying_events, event_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from robosc.model import expression as ex


class Text(Protocol):
    """A robot, a library, or a part of one."""

    @property
    def definitions(self) -> Iterable[Any]:
        """Definitions in the text."""


_Element = TypeVar("_Element", bound="ex.Located")
_Use = TypeVar("_Use")


def of_kind(kind: type[_Element] | tuple[type[_Element], ...], elements: Iterable[Any]) -> list[_Element]:
    """Return the elements of a kind."""
    return [element for element in elements if isinstance(element, kind)]


def components(base: Text) -> Iterator[tuple[rsc.Component, rsc.LocalComponent]]:
    """Yield the components that are not imported."""
    for component in of_kind(rsc.Component, base.definitions):
        if isinstance(component.type, rsc.LocalComponent):
            yield component, component.type


def statements(kind: type[_Element], base: Text) -> Iterator[_Element]:
    """Yield the definitions of a kind outside of components, then those inside local components."""
    yield from of_kind(kind, base.definitions)
    for _, local in components(base):
        yield from of_kind(kind, local.definitions)


def behaviours(base: Text) -> Iterator[tuple[rsc.Component, rsc.ComponentBehaviour]]:
    """Yield all behaviors of local components; a component may have several."""
    for component, local in components(base):
        for behaviour in of_kind(rsc.ComponentBehaviour, local.definitions):
            if behaviour.automaton:
                yield component, behaviour


def transitions(base: Text) -> Iterator[tuple[rsc.Component, rsc.Transition]]:
    """Yield the transitions of these behaviors, each with its component."""
    for component, behaviour in behaviours(base):
        for definition in behaviour.automaton.definitions:
            if isinstance(definition, rsc.State):
                yield from ((component, transition) for transition in definition.transitions)
            elif isinstance(definition, rsc.Transition):
                yield component, definition


def variables(base: Text) -> Iterator[rsc.Variable]:
    """Yield the variables of these behaviors."""
    for _, behaviour in behaviours(base):
        yield from of_kind(rsc.Variable, behaviour.automaton.definitions)


def communications(base: Text) -> Iterator[rsc.CommunicationType]:
    """Yield the messages, services and actions of local components."""
    for _, local in components(base):
        yield from of_kind(rsc.CommunicationType, local.definitions)


def identified_elements(base: rsc.Base) -> Iterator[rsc.CommunicationType | rsc.TopicRemapping]:
    """Yield the declarations and remappings that name a topic, a service or an action."""
    yield from communications(base)
    for component in of_kind(rsc.Component, base.definitions):
        if isinstance(component.type, rsc.ImportedComponent):
            yield from component.type.remappings


def states(automaton: rsc.Automaton) -> list[rsc.State]:
    """Return the states of an automaton."""
    return of_kind(rsc.State, automaton.definitions)


def common_transitions(automaton: rsc.Automaton) -> list[rsc.Transition]:
    """Return the transitions that every state of an automaton has."""
    return of_kind(rsc.Transition, automaton.definitions)


def circles(
    elements: Iterable[_Element], uses: Callable[[_Element], Iterable[tuple[_Use, _Element]]]
) -> Iterator[tuple[_Use, list[_Element]]]:
    """Yield each use that closes a cycle, with the elements of the cycle; it leads back to the first of them.

    `uses` yields the uses of an element, each with the element that it leads to. The search does not recurse, because a
    cycle may have thousands of uses.
    """
    done: set[_Element] = set()
    for start in elements:
        opened: dict[_Element, Iterator[tuple[_Use, _Element]]] = {} if start in done else {start: iter(uses(start))}
        while opened:
            last = next(reversed(opened))
            use = next(opened[last], None)
            if use is None:
                del opened[last]
                done.add(last)
            elif use[1] in opened:
                path = list(opened)
                yield use[0], path[path.index(use[1]) :]
            elif use[1] not in done:
                opened[use[1]] = iter(uses(use[1]))


def sends_message(transition: rsc.Transition) -> bool:
    """Return whether a transition happens when the controller sends its component a message."""
    if not isinstance(transition, rsc.ResultTransition) or transition.communicationType is None:
        return False
    event = event_of(transition.communicationType, transition.resultType)
    is_message = isinstance(transition.communicationType.communicationType, rsc.Message)
    return is_message and event is not None and event.is_sent


def assigned_variable(assignment: rsc.Assignment) -> rsc.Variable | None:
    """Return the variable of the own component that an assignment sets; None for any other item."""
    item = assignment.item.item if assignment.item else None
    return item if isinstance(item, rsc.Variable) and component_of(item) is component_of(assignment) else None


def component_of(element: ex.Located) -> rsc.Component | None:
    """Return the component that contains an element."""
    around = element
    while around is not None and not isinstance(around, rsc.Component):
        around = around.eContainer()
    return around


def unit_of(element: ex.Located) -> Any:
    """Return the robot or library whose text contains an element."""
    around = element
    while around.eContainer() is not None:
        around = around.eContainer()
    return around


def restricted_events(base: rsc.Base) -> Iterator[rsc.EventSet]:
    """Yield the events that orders and counts restrict."""
    for order in statements(rsc.OrderRequirement, base):
        yield order.target
    for count in statements(rsc.CountRequirement, base):
        yield count.target


def communication_of(reference: rsc.CommunicationReference | None) -> rsc.CommunicationType | None:
    """Return the communication of a reference; None if there is no reference or it is not resolved."""
    return reference.communicationType if reference else None


def data_types(base: Text) -> Iterator[rsc.DataType]:
    """Yield every type in the text of a base, including the element types of arrays."""
    for outermost in _outermost(base):
        around: rsc.DataType | None = outermost
        while around is not None:
            yield around
            around = around.type if isinstance(around, rsc.Array) else None


def _outermost(base: Text) -> Iterator[rsc.DataType | None]:
    for definition in base.definitions:
        if isinstance(definition, rsc.EnumDataType):
            yield definition.type
            yield from (parameter.type for parameter in definition.parameters)
        elif isinstance(definition, rsc.ObjectDataType):
            yield from (owner.type for owner in definition.properties)
    for communication in communications(base):
        yield from (declared for _, declared in carrying_events(communication))
    yield from (variable.type for variable in variables(base))
    yield from (constant.type for constant in statements(rsc.Constant, base))
    yield from (parameter.type for parameter in statements(rsc.Parameter, base))
    yield from (function.type for function in statements(rsc.Function, base))
    for function in statements(rsc.Function, base):
        yield from (parameter.type for parameter in function.parameters)
    for component in of_kind(rsc.Component, base.definitions):
        yield from (parameter.type for parameter in component.parameters)
