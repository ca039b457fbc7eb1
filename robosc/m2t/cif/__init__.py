"""CIF 3: the plants and requirements of a robot, and the plants under their supervisor (thesis 5.2).

The text stays inside what the data-based synthesis of Eclipse ESCET accepts from version 5 on; `docs/cif.md` says what
is written.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.sct_to_cif import transform
from robosc.m2t.cif.extension import extended
from robosc.m2t.cif.specification import Writer
from robosc.metamodel import expression as ex
from robosc.metamodel.places import place
from robosc.metamodel.reflection import tree
from robosc.semantics.roles import is_from_cif

if TYPE_CHECKING:
    from typing import Any

    from robosc.configuration import Configuration
    from robosc.m2t.models import Models

_NAME = re.compile("[A-Za-z_][A-Za-z0-9_]*")


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
    named = (element for _, element in tree(models.sct) if isinstance(element, ex.NamedElement))
    found = [
        _finding(element, f"'{element.name}' is no identifier", "give it a name of letters, digits and `_`")
        for element in named
        if not _NAME.fullmatch(element.name)
    ]
    try:
        transform(models.sct)
    except ModelError as error:
        found += error.diagnostics
    return found


def generate(models: Models, _configuration: Configuration) -> dict[str, str]:
    """`<robot>.cif`, and where the model has a supervisor `<robot>.supervised.cif`; of the sct model alone.

    Of a model that was read from CIF the latter only: it imports the specification, from where that is.

    Raises ModelError where `preconditions` finds something.
    """
    name, supervisor = models.sct.name, models.sct.supervisor
    if is_from_cif(models.sct):
        return {} if supervisor is None else {f"{name}.supervised.cif": extended(models.sct, supervisor, models.folder)}
    lowered = transform(models.sct)
    writer = Writer(lowered)
    files = {f"{name}.cif": writer.unsupervised()}
    if lowered.model.supervisor is not None:
        files[f"{name}.supervised.cif"] = writer.supervised(lowered.model.supervisor)
    return files


def _finding(culprit: Any, reason: str, hint: str) -> Diagnostic:
    return Diagnostic(*place(culprit), Severity.ERROR, "cif", f"this can't be said in CIF: {reason}", hint)
