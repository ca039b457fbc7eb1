"""Names that are usable at an element: those of its component, function, quantifiers and enum, and of its file."""

from __future__ import annotations

from collections import ChainMap
from functools import cached_property
from typing import Any, TypeVar

from robosc.language.failures import expects_failure
from robosc.language.scopes import File, Names, Scope, by_name
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import NUMBER

_Element = TypeVar("_Element")


class Surroundings:
    """Names that are usable at the elements of one file, whose libraries are linked.

    `scope` has the names of the file's base.
    """

    def __init__(self, file: File) -> None:
        self.file = file
        self.scope: Scope
        self._is_library = isinstance(file.base, rsc.Library)
        self._present: set[type] = {type(element) for element in (*file.references, *file.declared_names)}
        if any(isinstance(element, rsc.StatedDefinition) for element in file.references):
            self._present.add(rsc.StatedDefinition)
        self._definitions: dict[ex.Located, ex.Located] = {}
        self._nearests: dict[type, dict[ex.Located, Any]] = {}
        self._quantifiers: dict[ex.Located, rsc.ArrayQuantifier | None] = {}

    def open_scope(self) -> None:
        """Set the scope of a file that is already linked."""
        assert self.file.base is not None
        self.scope = Scope(self.file, self.file.base)

    def around(self, element: ex.Located, kind: type[_Element]) -> _Element | None:
        """Return the component or enum that contains the element if it is of that kind, or None.

        The arguments of an instantiated or imported component are outside of it.
        """
        definition = self._outermost(element)
        is_instance = isinstance(definition, rsc.Component) and not isinstance(definition.type, rsc.LocalComponent)
        is_argument = is_instance and isinstance(element, ex.Expression)
        return definition if isinstance(definition, kind) and not is_argument else None

    def _outermost(self, element: ex.Located) -> ex.Located | None:
        """Return the definition of the robot or library that contains an element."""
        path: list[ex.Located] = []
        around = element
        # Cached per element: each part of the path between two names of a long expression is climbed only once.
        while around not in self._definitions and not isinstance(around.eContainer(), rsc.Base):
            path.append(around)
            around = around.eContainer()
            if around is None:
                return None
        definition = self._definitions.get(around, around)
        self._definitions.update(dict.fromkeys(path, definition))
        return definition

    def _nearest(self, element: ex.Located, kind: type[_Element]) -> _Element | None:
        """Return the innermost element of a kind that contains an expression, within its definition."""
        if kind not in self._present:
            return None
        known = self._nearests.setdefault(kind, {})
        path: list[ex.Located] = []
        around: ex.Located | None = element
        while around is not None and around not in known and not isinstance(around, kind | rsc.Definition):
            path.append(around)
            around = around.eContainer()
        nearest = known.get(around, around if isinstance(around, kind) else None) if around is not None else None
        known.update(dict.fromkeys(path, nearest))
        return nearest

    def components(self, element: ex.Located) -> Names:
        """Return the components that an element can mention.

        In a library a component can only mention itself; assumptions outside of components can mention all. A template
        can also mention itself; other components can only mention its instances.
        """
        own = self.around(element, rsc.Component)
        if self._is_library:
            if own is None and self.around(element, rsc.Assumption) is not None:
                return self._parts
            return {} if own is None else {own.name: own}
        return ChainMap({own.name: own}, self._parts) if own is not None and own.parameters else self._parts

    @cached_property
    def _parts(self) -> dict[str, rsc.Component]:
        """Components of the robot that are not templates."""
        return {name: component for name, component in self.scope.components.items() if not component.parameters}

    def templates(self, element: ex.Located) -> Names:
        """Return the templates whose instances a name can mean: those of the quantifiers and of `each` around it."""
        by_template_name: dict[str, rsc.Component] = {}
        quantifier = self._nearest(element, rsc.InstanceQuantifier)
        while quantifier is not None:
            if quantifier.template is not None:
                by_template_name.setdefault(quantifier.template.name, quantifier.template)
            quantifier = self._nearest(quantifier.eContainer(), rsc.InstanceQuantifier)
        around = self._nearest(element, rsc.StatedDefinition)
        if around is not None and around.template is not None:
            by_template_name.setdefault(around.template.name, around.template)
        return by_template_name

    def parameters(self, element: ex.Located) -> Names:
        """Return the parameters that an expression can read: of its function, and of its enum or template."""
        function = self._nearest(element, rsc.Function)
        around = self._outermost(element)
        by_parameter_name: dict[str, Any] = {}
        if isinstance(around, rsc.Component | rsc.EnumDataType):
            by_parameter_name |= by_name(around.parameters)
        if isinstance(around, rsc.Component) and around.number is not None and not _is_bound(element, around):
            by_parameter_name[NUMBER] = around.number
        return by_parameter_name | by_name(function.parameters) if function is not None else by_parameter_name

    def elements(self, element: ex.Located) -> Names:
        """Return the array elements that an expression can read: those of the quantifiers around it."""
        by_element_name: dict[str, rsc.ArrayElement] = {}
        around: ex.Located | None = element if rsc.ArrayElement in self._present else None
        while around is not None:
            around = self._quantifier(around)
            if around is not None:
                by_element_name.setdefault(around.element.name, around.element)
        return by_element_name

    def _quantifier(self, element: ex.Located) -> rsc.ArrayQuantifier | None:
        """Return the innermost quantifier over an array whose condition contains an element."""
        path: list[ex.Located] = []
        quantifier: rsc.ArrayQuantifier | None = None
        around: ex.Located | None = element
        while around is not None and quantifier is None:
            if around in self._quantifiers:
                quantifier = self._quantifiers[around]
                break
            path.append(around)
            outer = around.eContainer()
            if isinstance(outer, rsc.ArrayQuantifier) and outer.body is around:
                quantifier = outer
            around = None if isinstance(outer, rsc.Definition) else outer
        self._quantifiers.update(dict.fromkeys(path, quantifier))
        return quantifier

    def automata(self, element: ex.Located) -> Names:
        """Return the requirement automata that an expression can read: of its component, then of the robot."""
        own = self.around(element, rsc.Component)
        local = own.type.definitions if own is not None and isinstance(own.type, rsc.LocalComponent) else ()
        outer = self.file.base.definitions if self.file.base is not None else ()
        return by_name(
            requirement for requirement in (*local, *outer) if isinstance(requirement, rsc.AutomatonRequirement)
        )

    def expects_failure(self, element: ex.Expression) -> bool:
        """Return whether the text expects a reason of an error at the position of an expression."""
        return self.file.predefined is not None and expects_failure(element, self._is_bare)

    def _is_bare(self, element: ex.Located) -> bool:
        if not isinstance(element, rsc.Access) or element.value or element.segments:
            return False
        return "component" not in self.file.references.get(element, {})


def _is_bound(element: ex.Located, fleet: rsc.Component) -> bool:
    """Return whether an element is in the bounds of a fleet."""
    around = element
    while around.eContainer() is not None and around.eContainer() is not fleet:
        around = around.eContainer()
    return around is fleet.first or around is fleet.last
