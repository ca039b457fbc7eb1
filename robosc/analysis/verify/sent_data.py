"""Constant data of commands: whether the supervisor ever allows the data of a `provide` statement."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.system import GuardedSystem, format_count
from robosc.analysis.verify.model_reading.machine import EventName, choice_of
from robosc.analysis.verify.model_reading.names import NotReadError
from robosc.analysis.verify.model_reading.plants import read_plants
from robosc.analysis.verify.model_reading.text import UnlikeError, read_text
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.analysis.wording import forbid, join_with_and, name
from robosc.base.diagnostics import Diagnostic, Severity
from robosc.model.places import place
from robosc.model.semantics.roles import plant_of
from robosc.synthesis import use_encoding

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.analysis.verify.model_reading.machine import Event, Machine, ProvidedConstant, Value
    from robosc.m2t.models import Models
    from robosc.model import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Encoding

PROPERTY = "data can comply"
#: Events with provided data: requests, and answers to clients.
_SENT = ("c_trigger", "c_response", "c_feedback")
_UNLIKE = "the plants are not those of the text: see model-translation"


def has_commands_with_data(model: sct.SupervisoryControlModel) -> bool:
    """Return whether the supervisor decides with the data of some command."""
    return any(event.controllable and event.inputs for plant in model.plants for event in plant.events)


def data_can_comply(models: Models) -> Verdict:
    """Check that the supervisor can allow the constant data of each `provide` statement of a command with inputs.

    It must allow them in some reachable state in which the statement applies. A statement that fails draws the finding
    `never-sent`. Data that are not constant are not examined.
    """
    if models.robosc is None:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", "the model was not read from its text")
    try:
        plants = read_plants(models.sct)
        text = read_text(models.robosc, plants)
    except NotReadError as unknown:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", str(unknown))
    except UnlikeError:
        return Verdict(PROPERTY, Outcome.SKIPPED, "", _UNLIKE)
    if text.events.keys() != plants.events.keys():
        return Verdict(PROPERTY, Outcome.SKIPPED, "", _UNLIKE)
    examined = list(_constants(text, plants))
    findings = use_encoding(models.sct, lambda encoding: _findings(models.sct, encoding, examined))
    evidence = f"{format_count(len(examined), 'statement')} with constant data"
    if not findings:
        return Verdict(PROPERTY, Outcome.PROVED, evidence)
    lines = join_with_and([str(finding.span.line) for finding in findings])
    several = "s" if len(findings) > 1 else ""
    statements = f"the `provide` statement{several} in line{several} {lines}"
    explanation = f"the supervisor never allows the data of {statements}: see never-sent"
    return Verdict(PROPERTY, Outcome.WARNED, evidence, explanation, findings=tuple(findings))


class _Examined:
    """A statement with constant data, and the values that the inputs of its command then have."""

    def __init__(self, provided: ProvidedConstant, command: Event, choices: Sequence[sct.Event]) -> None:
        self.statement = provided.statement
        self.event: sct.Event = command.element
        self.choice, self.preferred = choices[-1], choices[:-1]
        self._domains = command.inputs
        self._inputs: Mapping[str, Value] = provided.inputs or {}

    def data(self, encoding: Encoding) -> Diagram:
        """Return the inputs with these data."""
        return encoding.diagrams.all_of(
            encoding.has_code(carried, list(self._domains[carried.name]).index(self._inputs[carried.name]))
            for carried in self.event.inputs
            if carried.name in self._inputs
        )

    def applies(self, system: GuardedSystem) -> Diagram:
        """Return the reachable states in which the statement has been chosen and still applies."""
        others = system.diagrams.any_of(system.allowed[event] for event in self.preferred)
        return self._chosen(system) & system.controlled & system.allowed[self.choice] & ~others

    def _chosen(self, system: GuardedSystem) -> Diagram:
        plant = plant_of(self.choice)
        location = self.choice.name.rstrip("_").removeprefix("c_")
        return system.encoding.location(next(place for place in plant.locations if place.name == location))


def _constants(text: Machine, plants: Machine) -> Iterator[_Examined]:
    for plant, statements in text.provided.items():
        sent = (event for name, event in plants.events.items() if name.name in _SENT and choice_of(name) == plant)
        command = next(sent)
        choices = [plants.events[EventName(plant, f"c_d{number}")].element for number in range(1, len(statements) + 1)]
        for number, provided in enumerate(statements, 1):
            if command.inputs and provided.inputs is not None:
                yield _Examined(provided, command, choices[:number])


def _findings(
    model: sct.SupervisoryControlModel, encoding: Encoding, examined: Sequence[_Examined]
) -> list[Diagnostic]:
    system = GuardedSystem(model, encoding)
    return [
        _never_sent(one, system)
        for one in examined
        if not (one.applies(system) & system.happens(one.event) & one.data(encoding)).satisfiable()
    ]


def _never_sent(examined: _Examined, system: GuardedSystem) -> Diagnostic:
    cause = _cause(examined, system)
    message = f"`{name(plant_of(examined.event))}` is never sent with these data: {cause}"
    hint = "change the data, or the condition that excludes them"
    return Diagnostic(*place(examined.statement), Severity.WARNING, "never-sent", message, hint)


def _cause(examined: _Examined, system: GuardedSystem) -> str:
    """Return the first of these that excludes the data: the choice, the components, requirements, the supervisor."""
    relation = system.relations[examined.event]
    states = examined.applies(system)
    if not states.satisfiable():
        return "the statement applies in no reachable state"
    states &= examined.data(system.encoding) & relation.happens
    if not states.satisfiable():
        return "no component accepts them where the statement applies"
    forbidding = [
        requirement
        for requirement in relation.requirements
        if not (states & relation.condition_of(requirement)).satisfiable()
    ]
    if not forbidding and not (states & relation.permitted).satisfiable():
        forbidding = [
            requirement
            for requirement in relation.requirements
            if (states & ~relation.condition_of(requirement)).satisfiable()
        ]
    if forbidding:
        return forbid(forbidding, "them in every such state")
    return "the supervisor forbids them, because the robot could reach a state that it must not reach"
