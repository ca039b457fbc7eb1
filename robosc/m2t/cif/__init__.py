"""CIF 3: the plants and requirements of a robot, and the plants under their supervisor (thesis 5.2).

The text stays inside what the data-based synthesis of Eclipse ESCET accepts from version 5 on; `docs/cif.md` says what
is written.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, Severity
from robosc.m2t.cif.arithmetic import assigned, condition
from robosc.m2t.cif.extension import extended
from robosc.m2t.cif.linear import LARGEST, Unsupported, bounds, shift
from robosc.m2t.cif.specification import Writer
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree
from robosc.semantics.roles import is_from_cif

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models

_NAME = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_SMALLER = "give the integers smaller ranges"


def preconditions(models: Models, _configuration: Configuration) -> list[Diagnostic]:
    """What keeps CIF from the sct model, as errors of the rule `cif`, each at the text that it comes from.

    No plant at all, numbers beyond 32 bits, names that are none, and expressions that would have to be split into too
    many cases, since CIF's synthesis can't multiply.
    """
    if is_from_cif(models.sct):
        return []
    if not models.sct.plants:
        reason = "the robot has neither communications nor behaviours, and CIF takes no specification without a plant"
        hint = "give it a component with a message, a service, an action or a behaviour"
        return [_finding(models.sct, reason, hint)]
    elements = [element for _, element in tree(models.sct)]
    declared = [fault for element in elements for fault in _declaration_faults(element)]
    # What is computed from numbers that are too large is too large, too.
    computed = [] if declared else [fault for element in elements for fault in _expression_faults(element)]
    return [_finding(*fault) for fault in [*declared, *computed]]


def generate(models: Models, _configuration: Configuration) -> dict[str, str]:
    """`<robot>.cif`, and where the model has a supervisor `<robot>.supervised.cif`; of the sct model alone.

    Of a model that was read from CIF the latter only: it imports the specification.

    Raises Unsupported where `preconditions` finds something.
    """
    name, supervisor = models.sct.name, models.sct.supervisor
    if is_from_cif(models.sct):
        return {} if supervisor is None else {f"{name}.supervised.cif": extended(models.sct, supervisor)}
    writer = Writer(models.sct)
    files = {f"{name}.cif": writer.unsupervised()}
    if supervisor is not None:
        files[f"{name}.supervised.cif"] = writer.supervised(supervisor)
    return files


def _finding(culprit: Any, reason: str, hint: str) -> Diagnostic:
    return Diagnostic(*place(culprit), Severity.ERROR, "cif", f"this can't be said in CIF: {reason}", hint)


def _declaration_faults(element: Any) -> Iterator[tuple[Any, str, str]]:
    if isinstance(element, ex.NamedElement) and not _NAME.fullmatch(element.name):
        yield element, f"'{element.name}' is no identifier", "give it a name of letters, digits and `_`"
    numeric = isinstance(element, (sct.DiscreteVariable, sct.Input)) and isinstance(element.type, ex.IntegerType)
    if numeric and bounds(element)[1] + shift(element) > LARGEST:
        yield element, "its range does not fit 32 bits", _SMALLER


def _expression_faults(element: Any) -> Iterator[tuple[Any, str, str]]:
    try:
        _translate(element)
    except Unsupported as error:
        # A supervisor's guard is no text of the user's.
        culprit = element.event if isinstance(element, sct.EventGuard) else error.expression
        yield culprit, error.reason, _SMALLER


def _translate(element: Any) -> None:
    """Makes CIF of the expressions directly inside an element."""
    match element:
        case sct.Update():
            assigned(element.variable, element.value)
        case sct.Edge() if element.guard is not None:
            condition(element.guard)
        case sct.Requirement() | sct.StateInvariant():
            condition(element.condition)
        case sct.EventGuard():
            for part in (element.requirement, element.synthesis):
                if part is not None:
                    condition(part)
