"""Enums of a robot model as enumerations (thesis listing 5.6), made when first asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.semantics.naming import Names

if TYPE_CHECKING:
    from robosc.metamodel import robosc, rosgraph, sct


class Enumerations:
    """The enumerations that a model owns, beside those of the model that it refers to."""

    def __init__(
        self, owner: sct.SupervisoryControlModel | rosgraph.RosGraph, others: Enumerations | None = None
    ) -> None:
        self._owner = owner
        self.known: dict[robosc.EnumDataType, ex.Enumeration] = {}
        self.literals: dict[robosc.EnumValue, ex.EnumerationLiteral] = {}
        if others is not None:
            self.known.update(others.known)
            self.literals.update(others.literals)
        self._names = Names(enumeration.name for enumeration in self.known.values())

    def enumeration(self, enum: robosc.EnumDataType) -> ex.Enumeration:
        """The enumeration of an enum."""
        if enum not in self.known:
            enumeration = ex.Enumeration(name=self._names.fresh(enum.name), source=enum.source)
            for rule in enum.rules:
                literal = ex.EnumerationLiteral(name=rule.value.name, source=rule.value.source)
                enumeration.literals.append(literal)
                self.literals[rule.value] = literal
            self._owner.enumerations.append(enumeration)
            self.known[enum] = enumeration
        return self.known[enum]

    def literal(self, value: robosc.EnumValue) -> ex.EnumerationLiteral:
        """The literal of an enum value."""
        self.enumeration(value.eContainer().eContainer())
        return self.literals[value]
