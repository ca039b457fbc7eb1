"""What all parts of the generated engine are made from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.expressions import CPrinter
from robosc.m2t.c.guards import EventTable
from robosc.m2t.c.names import CNames
from robosc.m2t.c.nodes import All
from robosc.m2t.c.ranges import Ranges
from robosc.semantics.roles import Roles

if TYPE_CHECKING:
    from robosc.metamodel import sct


class Context:
    """A model with its names in C and with what is known about its events and expressions."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.sct = model
        self.names = CNames(model)
        self.ranges = Ranges()
        self.printer = CPrinter(self.names, self.ranges)
        self.table = EventTable(model)
        self.roles = Roles(model)
        self.queued = [*self.roles.cancels, *self.roles.triggers]
        self.data = [event for events in self.roles.data for event in events]
        #: The order of the enumerators: the control loop then knows an event's role by its number.
        self.events = [*self.queued, *self.roles.silent, *self.data, *self.roles.incoming]
        self._guards: dict[sct.Event, All] = {}
        self.located = [plant for plant in model.plants if len(plant.locations) > 1]

    def guard(self, event: sct.Event) -> All:
        """When the event can happen: the plants can do it, the requirements hold, and what synthesis added."""
        if event not in self._guards:
            parts = (self.table.possible(event, self.printer), self.table.required(event), self.table.added(event))
            self._guards[event] = All(parts)
        return self._guards[event]
