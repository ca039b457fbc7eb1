"""Target `cif`: the plants and requirements of a robot, and the supervised plants, in CIF 3 (thesis 5.2).

The text uses only constructs that the data-based synthesis of Eclipse ESCET accepts from version 5 on, except
requirements about reachable states; see `docs/cif.md`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.base.files.suffixes import AUTOMATA
from robosc.language.des import cif_of
from robosc.m2m.sct_to_cif import transform
from robosc.m2t.cif.extension import write_extension
from robosc.m2t.cif.specification import Writer
from robosc.model import expression as ex
from robosc.model.places import place
from robosc.model.reflection import tree
from robosc.model.semantics.roles import is_from_cif, is_written_as

if TYPE_CHECKING:
    from typing import Any

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import sct

#: First versions of CIF's tools that know a requirement about reachable states, without and with named arguments.
_REACHABLE, _REACHABLE_NAMED = 10, 13
_NAME = re.compile("[A-Za-z_][A-Za-z0-9_]*")


def preconditions(models: Models, _configuration: Configuration) -> list[Diagnostic]:
    """Return errors of the rule `cif` for everything that CIF cannot express, at its place in the text.

    The causes are: no plant, numbers beyond 32 bits, invalid names, and expressions that need too many cases because
    CIF's synthesis cannot multiply. A requirement that older tools ignore leads to a warning.
    """
    if is_from_cif(models.sct):
        return []
    if not models.sct.plants:
        reason = "the robot has neither communications nor behaviours, and CIF takes no specification without a plant"
        hint = "add a component with a message, a service, an action or a behaviour"
        return [_finding(models.sct, reason, hint)]
    named = (element for _, element in tree(models.sct) if isinstance(element, ex.NamedElement))
    findings = [
        _finding(element, f"'{element.name}' is not an identifier", "use a name of letters, digits and `_`")
        for element in named
        if not _NAME.fullmatch(element.name)
    ]
    try:
        transform(models.sct)
    except ModelError as error:
        findings += error.diagnostics
    return [*findings, *map(_version_warning, models.sct.reachabilityRequirements)]


def _version_warning(required: sct.ReachabilityRequirement) -> Diagnostic:
    """Return the warning that older tools ignore a requirement or reject its named arguments."""
    parts = {"from": required.premise, "stay": required.pathCondition, "bound": required.bound}
    named = [f"`{name}`" for name, part in parts.items() if part is not None]
    version = _REACHABLE_NAMED if named else _REACHABLE
    message = "tools of CIF before version 10 ignore this requirement in the file without a supervisor"
    if named:
        message += f", and those before version 13 reject its {' and '.join(named)}"
    hint = f"synthesize that file with CIF {version} or later; the supervised file is right for every version"
    return Diagnostic(*place(required), Severity.WARNING, "cif", message, hint)


def generate(models: Models, _configuration: Configuration) -> dict[str, str]:
    """Return `<robot>.cif` and, if the model has a supervisor, `<robot>.supervised.cif`, from the sct model alone.

    A model from CIF only gets the latter. It imports the specification from its place. A model from automata of another
    tool gets both, unless it is a saved model without its file. Raises ModelError if
    `preconditions` reports an error.
    """
    name, supervisor = models.sct.name, models.sct.supervisor
    if is_from_cif(models.sct):
        own = cif_of(models.sct) if is_written_as(models.sct, *AUTOMATA) else None
        files = {} if own is None else {f"{name}.cif": own}
        if supervisor is not None:
            files[f"{name}.supervised.cif"] = write_extension(models.sct, supervisor, models.folder)
        return files
    lowered = transform(models.sct)
    writer = Writer(lowered)
    files = {f"{name}.cif": writer.write_plants()}
    if lowered.model.supervisor is not None:
        files[f"{name}.supervised.cif"] = writer.write_supervisor(lowered.model.supervisor)
    return files


def _finding(culprit: Any, reason: str, hint: str) -> Diagnostic:
    return Diagnostic(*place(culprit), Severity.ERROR, "cif", f"CIF cannot express this: {reason}", hint)
