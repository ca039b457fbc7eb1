"""The models themselves, as XMI files that refer to each other by relative hrefs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.metamodel import robosc, xmi
from robosc.naming import Names

if TYPE_CHECKING:
    from robosc.config import Configuration
    from robosc.diagnostics import Diagnostic
    from robosc.models import Models


def preconditions(_models: Models, _configuration: Configuration) -> list[Diagnostic]:
    """None: every model can be saved."""
    return []


def generate(models: Models, _configuration: Configuration) -> dict[str, str]:
    """`<robot>.sct.xmi`, and where there are such models `.rosgraph.xmi`, `.robosc.xmi`, `<library>.robosc.xmi`.

    A library that is called like the robot gets an underscore. Raises ModelError for what XML can't hold.
    """
    name = models.sct.name
    roots: dict[str, Any] = {f"{name}.sct.xmi": models.sct}
    if models.rosgraph is not None:
        roots[f"{name}.rosgraph.xmi"] = models.rosgraph
    if models.robosc is not None:
        names = Names([name])
        roots[f"{name}.robosc.xmi"] = models.robosc
        roots |= {f"{names.fresh(library.name)}.robosc.xmi": library for library in _libraries(models.robosc)}
    return xmi.to_texts(roots)


def _libraries(base: robosc.Base) -> list[robosc.Library]:
    """All that the base imports from, directly or through others, in the order in which they are met."""
    found: list[robosc.Base] = [base]
    for each in found:
        for definition in each.definitions:
            if isinstance(definition, robosc.Component) and isinstance(definition.type, robosc.ImportedComponent):
                library = definition.type.library
                if library not in found:
                    found.append(library)
    return [each for each in found if isinstance(each, robosc.Library)]
