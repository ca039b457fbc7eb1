"""The types of objects that a node keeps: of their fields what the model and the definitions of ROS say."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph
from robosc.ros_types import DefinitionError, Section
from robosc.ros_types.wire import PRIMITIVES, Basic, Nested, Sequence

if TYPE_CHECKING:
    from collections.abc import Mapping
    from collections.abc import Sequence as Several

    from robosc.m2m.declarations import Declarations
    from robosc.ros_types import Fields, RosDistribution, RosTypes, WireType

#: Of an object of more objects and values nothing is known: a log of them would be of no use.
MOST_VALUES = 1000

#: The package of `Time` and `Duration`.
_TIMES = "builtin_interfaces"

_TYPES: Mapping[str, type[ex.Type]] = {
    "boolean": ex.BooleanType,
    "integer": ex.IntegerType,
    "double": ex.DoubleType,
    "string": ex.StringType,
}

#: What ROS has for each type but the basic ones.
_KINDS: Mapping[type[robosc.DataType], type[WireType]] = {
    robosc.Array: Sequence,
    robosc.ComplexDataTypeReference: Nested,
    robosc.InterfaceTypeReference: Nested,
}


class _Defined(NamedTuple):
    """A type as one of the two ROS has it; of an object the section that it is."""

    distribution: RosDistribution
    wire: WireType
    section: Section

    def fields(self) -> Fields | None:
        """The fields of an object; None where nobody knows them."""
        if not isinstance(self.wire, Nested):
            return None
        try:
            return self.distribution.fields(self.wire.package, self.wire.name, self.section)
        except DefinitionError:
            return None


class KeptTypes:
    """Makes the types of variables that hold objects.

    A graph is one of both ROS: of a ROS type it has the fields that all agree on that define it, and those that the
    model names. Of a type that none defines it has the properties of the data type.
    """

    def __init__(self, declarations: Declarations, interfaces: RosTypes) -> None:
        self._declarations = declarations
        self._distributions = interfaces.distributions
        self._left = 0

    def type_of(
        self, declared: robosc.DataType, interface: rosgraph.Interface, section: Section, path: Several[str]
    ) -> ex.Type:
        """The type of a variable of a data type, which holds what stands at the end of a path in a ROS message."""
        found = [
            _Defined(distribution, *reached)
            for distribution in self._distributions
            if (reached := distribution.reached(interface.package, interface.type, section, path)) is not None
        ]
        self._left = MOST_VALUES
        made = self._type(declared, found)
        if self._left >= 0 and made is not None:
            return made
        return rosgraph.ArrayType() if isinstance(declared, robosc.Array) else rosgraph.ObjectType()

    def _type(self, declared: robosc.DataType | None, defined: Several[_Defined]) -> ex.Type | None:
        """A type that is declared, or that ROS defines; None where its definitions disagree."""
        while isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.EnumDataType):
            declared = declared.type.type
        kinds = {type(known.wire) for known in defined} if declared is None else {_KINDS.get(type(declared), Basic)}
        if kinds == {Nested}:
            return self._object(declared, defined)
        if kinds == {Sequence}:
            inner = [known._replace(wire=known.wire.element) for known in defined if isinstance(known.wire, Sequence)]
            element = self._type(declared.type if isinstance(declared, robosc.Array) else None, inner)
            return None if element is None else rosgraph.ArrayType(element=element)
        self._left -= 1
        if declared is not None:
            return self._declarations.type(declared)
        basic = {PRIMITIVES[str(known.wire)].name for known in defined if str(known.wire) in PRIMITIVES}
        return _TYPES[basic.pop()]() if len(basic) == 1 and kinds == {Basic} else None

    def _object(self, declared: robosc.DataType | None, defined: Several[_Defined]) -> rosgraph.ObjectType:
        self._left -= 1
        made = rosgraph.ObjectType()
        named = {}
        if isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.ObjectDataType):
            named = {given.name: given.type for given in declared.type.properties}
        found = [(definition, fields) for definition in defined if (fields := definition.fields()) is not None]
        # Of times the two agree on the seconds alone, and rospy not even on their name.
        known = [
            (definition, fields) for definition, fields in found if str(definition.wire).partition("/")[0] != _TIMES
        ]
        agreed = [name for name in (known[0][1] if known else ()) if all(name in fields for _, fields in known)]
        for name in dict.fromkeys([*agreed, *named]):
            if self._left < 0:
                break
            wires = [
                _Defined(definition.distribution, fields[name], Section.MESSAGE)
                for definition, fields in known
                if name in fields
            ]
            kind = self._type(named.get(name), wires)
            if kind is not None:
                made.fields.append(rosgraph.ObjectField(name=name, type=kind))
        return made
