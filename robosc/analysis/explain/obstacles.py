"""Obstacles of plants and requirements to an event in a state, and the events that would remove them."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from robosc.analysis.explain.answers import Note
from robosc.analysis.paths import Path, trace
from robosc.analysis.wording import in_words, join_with_and, name, what_is, words
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.communication import CANCELING, ERROR, EXECUTING, IDLE, OPEN, READY, WAITING
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.printing import RobotPrinter, disjunction
from robosc.model.semantics.walks import copy_tree
from robosc.synthesis.decoding import text, value
from robosc.synthesis.encoding import pick, referenced_elements

if TYPE_CHECKING:
    from robosc.analysis.paths import Move
    from robosc.analysis.system import Codes, SynthesizedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element

#: Maximum number of states that a sentence names.
_NAMED = 4
_CALLS = (sct.PlantKind.service, sct.PlantKind.action)
#: Description of a service or action in each of its locations.
_PHASES = {
    IDLE: "is not under way",
    WAITING: "still waits for its answer",
    EXECUTING: "is still under way",
    CANCELING: "is being canceled, and has not ended",
    READY: "has ended, and is reset before it can start again",
    OPEN: "still has to be answered",
    ERROR: "has failed, and is reset after a while before it can start again",
}
_WAITING = {
    sct.EventKind.trigger: "`on request to {}`",
    sct.EventKind.response: "`on response from {}`",
    sct.EventKind.error: "`on error from {}`",
    sct.EventKind.feedback: "`on feedback from {}`",
    sct.EventKind.cancel: "`on cancel from {}`",
    sct.EventKind.canceled: "`on canceled from {}`",
    sct.EventKind.request: "`on request from {}`",
    sct.EventKind.cancelRequest: "`on cancel from {}`",
    sct.EventKind.reply: "`on response to {}`",
    sct.EventKind.replyFeedback: "`on feedback to {}`",
    sct.EventKind.replyError: "`on error to {}`",
    sct.EventKind.replyCanceled: "`on canceled to {}`",
}


class Obstacles:
    """Obstacles to one event in one state."""

    def __init__(self, system: SynthesizedSystem, event: sct.Event, codes: Codes) -> None:
        self._system = system
        self._event = event
        self._codes = codes
        self._print = RobotPrinter()

    def plants(self) -> list[Note]:
        """Return a note on each plant that cannot take part.

        The note is at the plant's location, or at the transition with a false guard.
        """
        enabled = self._system.relations[self._event].enabled_by
        return [self._plant(plant) for plant, where in enabled.items() if not self._system.is_in(self._codes, where)]

    def requirements(self) -> list[Note]:
        """Return a note on each requirement that forbids the event, with the parts that fail."""
        relation = self._system.relations[self._event]
        return [
            Note(
                requirement,
                requirement.text or "a requirement forbids it",
                tuple(dict.fromkeys(map(self._describe, self._parts(requirement)))),
            )
            for requirement, where in relation.permissions.items()
            if not self._system.is_in(self._codes, where)
        ]

    def on_data(self) -> list[Note]:
        """Return a note on each requirement that permits only some data of the command here."""
        relation = self._system.relations[self._event]
        return [
            Note(requirement, requirement.text or "a requirement forbids some data")
            for requirement in relation.requirements
            if relation.has_data and self._system.is_in(self._codes, relation.forbidden_by(requirement))
        ]

    def changes(self, allowed: Diagram) -> list[Note]:
        """Return the events that can happen here and lead to one of the states `allowed`.

        The notes are at the transitions of these events that change an obstacle.
        """
        encoding = self._system.encoding
        here = encoding.state(self._codes)
        notes: list[Note] = []
        for move in self._system.supervised_moves:
            possible = move[1].image(here) & allowed
            if possible.satisfiable():
                after = pick(possible, encoding.layout.state)
                notes += self._changing(move, after)
        return notes

    # Plants

    def _here(self, plant: sct.Plant) -> sct.Location:
        return plant.locations[self._codes[plant]]

    def _edges(self, plant: sct.Plant) -> list[sct.Edge]:
        return edges_from(self._here(plant), self._event)

    def _guard(self, plant: sct.Plant) -> ex.Expression | None:
        """Return the guards of the plant's edges for the event here; None if one edge has no guard."""
        guards = [edge.guard for edge in self._edges(plant)]
        return None if None in guards else disjunction(copy_tree(guard) for guard in guards if guard is not None)

    def _plant(self, plant: sct.Plant) -> Note:
        here = self._here(plant)
        guard = self._guard(plant)
        if plant.kind == sct.PlantKind.assumption and guard is not None:
            failing = dict.fromkeys(map(self._describe, self._failing(guard, value=True)))
            return Note(plant, f"`{plant.text}` excludes it", tuple(failing))
        if guard is not None:
            parts = tuple(dict.fromkeys(map(self._describe, self._failing(guard, value=True))))
            condition_text = f"{self._transition(plant)} requires `{self._print(guard)}`"
            if plant.kind == sct.PlantKind.data:
                return Note(self._event, condition_text, parts)
            return Note(self._edges(plant)[0], f"`{name(plant)}` is in `{here.name}`, where {condition_text}", parts)
        if plant.kind in _CALLS and here.name in _PHASES:
            return Note(plant, f"`{name(plant)}` is in `{here.name}`: it {_PHASES[here.name]}")
        others = [
            f"`{location.name}`"
            for location in plant.locations
            if any(own.event is self._event for own in edges_from(location))
        ]
        elsewhere = (
            f"it has one in {join_with_and(others)}"
            if len(others) <= _NAMED
            else f"{len(others)} other states have one"
        )
        return Note(here, f"`{name(plant)}` is in `{here.name}`, without {self._transition(plant)}: {elsewhere}")

    def _transition(self, plant: sct.Plant) -> str:
        """Return the text with which a component takes part in the event."""
        owner: sct.Plant = self._event.eContainer()
        if plant.kind == sct.PlantKind.data:
            return "this `provide`"
        if self._event.kind not in _WAITING:
            return f"the {words(self._event)}"
        own, _, short = name(owner).rpartition(".")
        return _WAITING[self._event.kind].format(short if own == name(plant) else name(owner))

    # Conditions

    def _parts(self, requirement: sct.Requirement) -> list[tuple[ex.Expression, bool]]:
        return self._failing(requirement.condition, value=requirement.kind == sct.RequirementKind.needs)

    def _failing(self, condition: ex.Expression | None, *, value: bool) -> list[tuple[ex.Expression, bool]]:
        """Return the smallest parts of a condition that would all have to change, each with its required value."""
        failing = []
        pending = [] if condition is None else [(condition, value)]
        while pending:
            part, value_wanted = pending.pop()
            if self._system.holds(part, self._codes) == value_wanted:
                continue
            match part:
                case ex.Negation():
                    pending.append((part.operand, not value_wanted))
                case ex.Conjunction() | ex.Disjunction() if isinstance(part, ex.Conjunction) == value_wanted:
                    pending += [(part.right, value_wanted), (part.left, value_wanted)]
                case _:
                    failing.append((part, value_wanted))
        return failing

    def _describe(self, part: tuple[ex.Expression, bool]) -> str:
        condition, required = part
        sentence = f"`{self._print(condition)}` {'does not hold' if required else 'holds'}"
        has_values = not (isinstance(condition, sct.LocationReference) and not required)
        values = [
            what_is(element, value(element, self._codes[element]))
            for element in dict.fromkeys(referenced_elements(condition))
        ]
        return f"{sentence}: {join_with_and(values)}" if values and has_values else sentence

    # Changes

    def _changing(self, move: Move, after: Codes) -> list[Note]:
        """Return the transitions of an event from here to the state `after` that change an obstacle."""
        relation = move[0]
        steps = trace(self._system.encoding, Path([dict(self._codes), dict(after)], [move]))
        by = in_words(steps, self._system.model)
        changes = []
        for plant in relation.enabled_by:
            possible = edges_from(self._here(plant), relation.event)
            reached = plant.locations[after[plant]]
            edge = next((edge for edge in possible if edge.target is reached), possible[0])
            changed = [element for element in (plant, *plant.variables) if self._codes[element] != after[element]]
            changes += [(element, _change(element, edge, self._here(plant), after, by)) for element in changed]
        return [note for element, note in changes if element in self._in_the_way] or [note for _, note in changes]

    @cached_property
    def _in_the_way(self) -> set[Element]:
        """Plants that cannot take part, and the elements that the false guards and requirements read."""
        elements: set[Element] = set()
        relation = self._system.relations[self._event]
        for plant, where in relation.enabled_by.items():
            if not self._system.is_in(self._codes, where):
                elements.update(referenced_elements(self._guard(plant)) if self._edges(plant) else [plant])
        for requirement, where in relation.permissions.items():
            if not self._system.is_in(self._codes, where):
                elements.update(
                    element for part, _ in self._parts(requirement) for element in referenced_elements(part)
                )
        return elements


def _change(element: Element, edge: sct.Edge, here: sct.Location, after: Codes, by: str) -> Note:
    """Return a note on the value of a plant or a variable after an edge is taken from here."""
    if isinstance(element, sct.Plant):
        return Note(edge, f"`{name(element)}` goes from `{here.name}` to `{edge.target.name}` by {by}")
    whole = f"`{name(element.eContainer())}.{element.name}`"
    return Note(edge, f"{whole} becomes {text(value(element, after[element]))} by {by}")
