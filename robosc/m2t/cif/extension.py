"""The supervisor of a specification that was read from CIF: it imports the specification and adds an automaton."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.cif.expressions import CifPrinter
from robosc.m2t.cif.names import AbsoluteNames, escaped
from robosc.m2t.cif.specification import document, edge_text, folded, listed
from robosc.semantics.naming import Names
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import sct


def extended(model: sct.SupervisoryControlModel, supervisor: sct.Supervisor) -> str:
    """A specification that imports the one that the model was read from, with an automaton of what synthesis added.

    Its requirements stay what they are: all of CIF's tools but synthesis take them as automata like others.
    """
    return folded(list(_lines(model, supervisor)))


def _lines(model: sct.SupervisoryControlModel, supervisor: sct.Supervisor) -> Iterator[str]:
    printer = CifPrinter(AbsoluteNames(), None)
    assert model.source is not None
    assert model.source.file is not None
    # What stands first in each name, of all that the specification has.
    taken = {plant.origin.partition(".")[0] for plant in model.plants if plant.origin}
    taken |= {event_name(event).partition(".")[0] for plant in model.plants for event in plant.events}
    taken |= {member.name for plant in model.plants if not plant.origin for member in plant.variables}
    for enumeration in model.enumerations:
        taken |= {enumeration.name, *(literal.name for literal in enumeration.literals)}
    yield from document([f"{model.name} under its supervisor: {supervisor.controlledStates} states."], sign="@@")
    yield f'import "{model.source.file.name}";'
    yield ""
    added = any(guard.synthesis for guard in supervisor.guards)
    yield from document(["What synthesis added." if added else "Synthesis added nothing to the requirements."])
    yield f"supervisor automaton {Names(taken).fresh('sup')}:"
    events = [(guard, escaped(event_name(guard.event))) for guard in supervisor.guards]
    yield f"  alphabet {listed(event for _, event in events)};" if events else "  alphabet;"
    if supervisor.initial is not None:
        yield f"  initial {printer(supervisor.initial)};"
    yield ""
    yield "  location:"
    yield "    initial; marked;"
    for guard, event in events:
        yield edge_text(event, "" if guard.synthesis is None else printer(guard.synthesis))
    yield "end"
