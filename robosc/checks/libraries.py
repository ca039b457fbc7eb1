"""What a robot or library imports."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator


def imports(base: rsc.Base) -> Iterator[tuple[rsc.Component, rsc.Library]]:
    """Each imported component with its library, in the order of the text; unresolved libraries are left out."""
    for component in base.definitions:
        if (
            isinstance(component, rsc.Component)
            and isinstance(component.type, rsc.ImportedComponent)
            and component.type.library
        ):
            yield component, component.type.library


def reachable(base: rsc.Base) -> list[rsc.Library]:
    """Every library that the base's imports reach, each once, without the base itself."""
    found: dict[rsc.Base, None] = {base: None}
    queue = [base]
    while queue:
        for _, library in imports(queue.pop(0)):
            if library not in found:
                found[library] = None
                queue.append(library)
    return [each for each in found if isinstance(each, rsc.Library) and each is not base]
