"""All that a robot can do, without and with its supervisor, kept while questions about it are answered."""

from __future__ import annotations

from copy import copy
from functools import cached_property, reduce
from operator import and_
from typing import TYPE_CHECKING

from robosc.metamodel import sct
from robosc.semantics.roles import plant_of
from robosc.synthesis import MEMORY
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import Encoding, Layout
from robosc.synthesis.fixpoint import reachable, supervise
from robosc.synthesis.paths import Layers
from robosc.synthesis.relation import event_relations

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from collections.abc import Set as AbstractSet
    from typing import Self, TypeVar

    from robosc.metamodel import expression as ex
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import EventRelation

    T = TypeVar("T")

    Codes = Mapping[Element, int]


class Space:
    """The states and events of a model as decision diagrams; a single state is the code of each of its elements.

    `moves` are the events under the requirements, `plant_moves` without them; `found` is what the fixpoint found, and
    `supervised_layers` are the controlled states by their distance from the initial one.
    """

    def __init__(self, model: sct.SupervisoryControlModel, encoding: Encoding) -> None:
        self.model = model
        self.encoding = encoding
        self.relations = {each.event: each for each in event_relations(model, encoding)}
        self.plant_moves = [(each, each.plant_step) for each in self.relations.values() if each.plant_step is not None]
        self.required = {event: each.requirement for event, each in self.relations.items()}
        self.moves = [(each, each.step) for each in self.relations.values() if each.step is not None]
        self.explore()

    def without(self, requirements: AbstractSet[sct.Requirement]) -> Self:
        """The space that there would be without some requirements.

        An action that is cancelled where a requirement on it no longer holds is then cancelled for the others alone.
        """
        other = copy(self)
        for event, relation in self.relations.items():
            trigger = self.start_of(event)
            kept = self._asked(relation if trigger is None else self.relations[trigger], requirements)
            other.required = {**other.required, event: kept if trigger is None else ~kept}
        steps = ((each, each.step_where(other.required[each.event])) for each in self.relations.values())
        other.moves = [(each, step) for each, step in steps if step is not None]
        other.explore()
        return other

    def explore(self) -> None:
        """Finds the states under the supervisor."""
        uncontrollable = [step for relation, step in self.moves if not relation.event.controllable]
        self.found = supervise(self.encoding, [step for _, step in self.moves], uncontrollable)
        self.supervised_layers = self.layers(self.encoding.initial_codes)

    @property
    def controlled(self) -> Diagram:
        """The states that are reachable under the supervisor: none if it is empty."""
        return self.found.controlled

    @cached_property
    def uncontrolled(self) -> Diagram:
        """The states that the plants reach without requirements."""
        encoding = self.encoding
        steps = [step for _, step in self.plant_moves]
        return reachable(encoding.diagrams, steps, encoding.initial, encoding.diagrams.true)

    def layers(self, start: Codes) -> Layers:
        """The controlled states by their distance from one of them."""
        return Layers(self.encoding, self.moves, self.encoding.state(start), self.controlled)

    def allowed(self, event: sct.Event) -> Diagram:
        """The controlled states in which the event can happen."""
        enabled = self.controlled & self.relations[event].enabled & self.required[event]
        step = next((step for each, step in self.moves if each.event is event), None)
        return enabled & step.preimage(self.controlled) if event.controllable and step is not None else enabled

    def holds(self, condition: ex.Expression | None, codes: Codes) -> bool:
        """Whether a condition is true in a state."""
        return self.is_in(codes, self.encoding.holds(condition))

    def is_in(self, codes: Codes, states: Diagram) -> bool:
        """Whether a state is one of these."""
        return (self.encoding.state(codes) & states).satisfiable()

    def start_of(self, event: sct.Event) -> sct.Event | None:
        """The start of the action whose requirements say when `event` cancels it; None for any other event.

        The requirement that says so stands at the action itself.
        """
        plant, requirements = plant_of(event), self.relations[event].requirements
        if event.kind != sct.EventKind.cancel or [each.source for each in requirements] != [plant.source or ""]:
            return None
        return next((each for each in plant.events if each.kind == sct.EventKind.trigger), None)

    def _asked(self, relation: EventRelation, left_out: AbstractSet[sct.Requirement]) -> Diagram:
        """Where the requirements on an event hold but for those left out."""
        kept = [asked for each, asked in relation.asked.items() if each not in left_out]
        return reduce(and_, kept, self.encoding.diagrams.true)


def explored(model: sct.SupervisoryControlModel, look: Callable[[Space], T], memory: int = MEMORY) -> T:
    """What is seen in the space of a model; `look` may run several times, with more memory each time.

    Raises MemoryError where the decision diagrams would take more bytes than `memory`.
    """
    layout = Layout(model)
    return with_enough_memory(
        lambda capacity: look(Space(model, Encoding(layout, Diagrams(layout.levels, capacity)))), memory
    )
