"""Types, enumerations and initial values of a robot model in the target models."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.evaluation import Value, literal, saturate
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.failures import reasons
from robosc.model.semantics.naming import Names
from robosc.model.semantics.typing import EnumType

if TYPE_CHECKING:
    from robosc.model import rosgraph, sct
    from robosc.model.semantics.inputs import ComputedValue, FailureReason
    from robosc.model.semantics.instances import InstanceVariable

#: Target type of each basic type without bounds, and the value of a variable without an initial value.
_BASIC: dict[type[robosc.DataType], tuple[type[ex.Type], Value]] = {
    robosc.BooleanDataType: (ex.BooleanType, False),
    robosc.IntegerDataType: (ex.IntegerType, 0),
    robosc.DoubleDataType: (ex.DoubleType, 0.0),
    robosc.StringDataType: (ex.StringType, ""),
}


class Declarations:
    """Types of one target model.

    The model owns their enumerations (thesis listing 5.6), which are created on first use.

    Reuses the enumerations of `others`, the declarations of a model that the target model refers to.
    """

    def __init__(
        self, owner: sct.SupervisoryControlModel | rosgraph.RosGraph, others: Declarations | None = None
    ) -> None:
        self._owner = owner
        self.enumerations: dict[robosc.EnumDataType, ex.Enumeration] = {}
        self.literals: dict[robosc.EnumValue, ex.EnumerationLiteral] = {}
        if others is not None:
            self.enumerations |= others.enumerations
            self.literals |= others.literals
        self._names = Names(enumeration.name for enumeration in self.enumerations.values())

    def type(self, declared: robosc.DataType) -> ex.Type:
        """Return the type of a variable or of data, which is basic or an enum (rule `variable-type`)."""
        if isinstance(declared, robosc.IntegerDataType):
            return ex.IntegerType(minimum=declared.minimum, maximum=declared.maximum)
        if type(declared) in _BASIC:
            return _BASIC[type(declared)][0]()
        return ex.EnumerationType(enumeration=self.enumeration(_enum(declared)))

    def computed(self, value: ComputedValue) -> ex.Type:
        """Return the type of a value computed from data. An integer has bounds (rule `integer-range`)."""
        if isinstance(value.type, EnumType):
            return ex.EnumerationType(enumeration=self.enumeration(value.type.definition))
        if value.bounds is None:
            return ex.BooleanType()
        return ex.IntegerType(minimum=value.bounds[0], maximum=value.bounds[1])

    def reason(self, source: FailureReason) -> ex.Type:
        """Return the type of the reasons for which a service or action can fail.

        They are consecutive literals of the enum.
        """
        literals = {literal.name: literal for literal in self.enumeration(source.enum).literals}
        possible = [literal for name, literal in literals.items() if name in reasons(source.port.communication)]
        return ex.EnumerationType(enumeration=self.enumerations[source.enum], first=possible[0], last=possible[-1])

    def enumeration(self, enum: robosc.EnumDataType) -> ex.Enumeration:
        """Return the enumeration of an enum."""
        if enum not in self.enumerations:
            enumeration = ex.Enumeration(name=self._names.fresh(enum.name), source=enum.source)
            # Several rules may have the same value.
            literals: dict[str, ex.EnumerationLiteral] = {}
            for rule in enum.rules:
                name = rule.value.name
                if name not in literals:
                    literals[name] = ex.EnumerationLiteral(name=name, source=rule.value.source)
                    enumeration.literals.append(literals[name])
                self.literals[rule.value] = literals[name]
            self._owner.enumerations.append(enumeration)
            self.enumerations[enum] = enumeration
        return self.enumerations[enum]

    def literal(self, value: robosc.EnumValue) -> ex.EnumerationLiteral:
        """Return the literal of an enum value."""
        self.enumeration(value.eContainer().eContainer())
        return self.literals[value]

    def initial(self, owned: InstanceVariable) -> ex.Expression:
        """Return the initial value of a variable as one literal. Its initial expression is constant (rule `type`)."""
        kind, value = owned.type, constant_value(owned.variable.initial, owned.instance)
        if value is None:
            value = _BASIC[type(kind)][1] if type(kind) in _BASIC else default_value(_enum(kind))
        if isinstance(kind, robosc.IntegerDataType) and isinstance(value, int):
            value = saturate(value, kind.minimum, kind.maximum)
        return literal(self.literal(value) if isinstance(value, robosc.EnumValue) else value)


def first_value(kind: ex.Type) -> ex.Expression:
    """Return the first value of a finite type: false, the lower bound, or the first value of the enumeration."""
    match kind:
        case ex.IntegerType(minimum=int() as minimum):
            return literal(minimum)
        case ex.EnumerationType():
            return literal(kind.first or kind.enumeration.literals[0])
    return literal(False)


def default_value(enum: robosc.EnumDataType) -> robosc.EnumValue:
    """Return the value of an enum's default rule."""
    return next(rule.value for rule in enum.rules if isinstance(rule, robosc.EnumDefaultRule))


def _enum(declared: robosc.DataType) -> robosc.EnumDataType:
    assert isinstance(declared, robosc.ComplexDataTypeReference)
    assert isinstance(declared.type, robosc.EnumDataType)
    return declared.type
