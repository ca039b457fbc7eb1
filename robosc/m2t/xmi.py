"""Target `xmi`: the models as XMI files that refer to each other by relative hrefs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.model import robosc, xmi
from robosc.model.reflection import tree
from robosc.model.semantics.failures import is_failure
from robosc.model.semantics.instances import libraries
from robosc.model.semantics.naming import Names
from robosc.model.semantics.roles import is_from_cif

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models


def preconditions(_models: Models, _configuration: Configuration) -> list[Diagnostic]:
    """Return no findings: every model can be saved."""
    return []


def generate(models: Models, _configuration: Configuration) -> dict[str, str]:
    """Return the available models as files, such as `<robot>.sct.xmi`.

    With a supervisor, this includes `.engine.xmi`. The others are `.rosgraph.xmi`, `.robosc.xmi` and
    `<library>.robosc.xmi`, also of the predefined library if the model uses it. A library with the robot's name gets an
    underscore. Raises ModelError for characters that XML cannot hold.
    """
    name = models.sct.name
    roots: dict[str, Any] = {f"{name}.sct.xmi": models.sct}
    if models.sct.supervisor is not None and not is_from_cif(models.sct):
        roots[f"{name}.engine.xmi"] = models.engine
    if models.rosgraph is not None:
        roots[f"{name}.rosgraph.xmi"] = models.rosgraph
    if models.robosc is not None:
        names = Names([name])
        roots[f"{name}.robosc.xmi"] = models.robosc
        known = libraries(models.robosc)
        known += dict.fromkeys(library for base in (models.robosc, *known) for library in _predefined(base))
        roots |= {f"{names.fresh(library.name)}.robosc.xmi": library for library in known}
    return xmi.to_texts(roots)


def _predefined(base: robosc.Base) -> Iterator[robosc.Library]:
    """Return the predefined library, once for each use in a text."""
    for _, element in tree(base):
        enum: robosc.ComplexDataType | None = None
        match element:
            case robosc.ErrorReason():
                enum = element.enumeration
            case robosc.ComplexDataTypeReference():
                enum = element.type
        if enum is not None and is_failure(enum):
            yield enum.eContainer()
