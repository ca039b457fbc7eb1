"""Effects of events as functions of the state and of input values, for a model and for its CIF."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.model.semantics.edges import edges_by_event
from robosc.model.semantics.roles import event_name
from robosc.synthesis import arithmetic
from robosc.synthesis.encoding import domain_size, smallest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.analysis.system import GuardedSystem
    from robosc.model import sct
    from robosc.synthesis.arithmetic import Vector
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding


class AmbiguityError(ValueError):
    """An automaton has two ways to take part in an event."""


@dataclass(frozen=True)
class Transition:
    """Effect of one event: the states that enable it, and the code of each element after it.

    `enabled` also depends on the inputs if the event is a command with inputs. An element that `after` does not contain
    keeps its value.
    """

    enabled: Diagram
    after: Mapping[Element, Vector]

    def bits(self, element: Element, encoding: Encoding) -> tuple[Diagram, ...]:
        """Return the bits of the element's code after the event, least significant first."""
        now = encoding.bits(element)
        code = self.after.get(element, now)
        return tuple(code[min(place, len(code) - 1)] for place in range(len(now)))


def of_system(system: GuardedSystem) -> dict[sct.Event, Transition]:
    """Return the events of a model under its supervisor, in the order of the plants."""
    edges = edges_by_event(system.model.plants)
    transitions = {
        event: together(edges.get(event, {}).values(), system.encoding, saturates=True) for event in system.relations
    }
    return {event: Transition(system.happens(event), transition.after) for event, transition in transitions.items()}


def together(automata: Iterable[Sequence[sct.Edge]], encoding: Encoding, *, saturates: bool) -> Transition:
    """Return the effect of an event that automata with these edges share.

    If a value is outside of its variable's range, the variable gets the nearest value (`saturates`), or the event
    cannot happen. Raises AmbiguityError if two edges of an automaton are enabled at the same time.
    """
    diagrams = encoding.diagrams
    enabled = diagrams.true
    after: dict[Element, Vector] = {}
    for edges in automata:
        possible = diagrams.false
        for edge in edges:
            taken = encoding.source(edge) & encoding.holds(edge.guard)
            codes: dict[Element, Vector] = {
                edge.target.eContainer(): arithmetic.constant(diagrams, encoding.location_code(edge.target))
            }
            for update in edge.updates:
                codes[update.variable] = encoding.code(update.value, update.variable)
                if not saturates:
                    taken &= in_range(update, encoding)
            if (taken & possible).satisfiable():
                raise AmbiguityError(f"two edges for {event_name(edge.event)} are enabled at once")
            possible |= taken
            for element, code in codes.items():
                before = after.get(element, (*encoding.bits(element), diagrams.false))
                after[element] = arithmetic.choose(taken, code, before)
        enabled &= possible
    return Transition(enabled, after)


def in_range(update: sct.Update, encoding: Encoding) -> Diagram:
    """Return the states in which the updated value is in the variable's range."""
    least = arithmetic.constant(encoding.diagrams, smallest(update.variable))
    value = arithmetic.subtract(encoding.vector(update.value), least)
    size = arithmetic.constant(encoding.diagrams, domain_size(update.variable))
    return arithmetic.less(value, size) & ~value[-1]
