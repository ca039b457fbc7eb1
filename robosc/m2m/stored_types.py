"""Types of objects that a node stores: their fields, from the model and the ROS definitions."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.base.ros_types import DefinitionError, Section
from robosc.base.ros_types.wire import PRIMITIVES, Basic, NestedType, Sequence
from robosc.model import expression as ex
from robosc.model import robosc, rosgraph

if TYPE_CHECKING:
    from collections.abc import Mapping
    from collections.abc import Sequence as Several

    from robosc.base.ros_types import Fields, RosDistribution, RosTypes, WireType
    from robosc.m2m.declarations import Declarations

#: Maximum number of objects and values in an object. Larger objects get no fields: their log would be unreadable.
MOST_VALUES = 1000

#: Package of `Time` and `Duration`.
_TIMES = "builtin_interfaces"

_TYPES: Mapping[str, type[ex.Type]] = {
    "boolean": ex.BooleanType,
    "integer": ex.IntegerType,
    "double": ex.DoubleType,
    "string": ex.StringType,
}

#: Kind of ROS type of each non-basic type.
_KINDS: Mapping[type[robosc.DataType], type[WireType]] = {
    robosc.Array: Sequence,
    robosc.ComplexDataTypeReference: NestedType,
    robosc.InterfaceTypeReference: NestedType,
}


class _Defined(NamedTuple):
    """A type in one ROS distribution. `section` is the section that an object stands for."""

    distribution: RosDistribution
    wire: WireType
    section: Section

    def fields(self) -> Fields | None:
        """Return the fields of an object. None if they are unknown."""
        if not isinstance(self.wire, NestedType):
            return None
        try:
            return self.distribution.fields(self.wire.package, self.wire.name, self.section)
        except DefinitionError:
            return None


class StoredTypes:
    """Creates the types of variables that hold objects.

    A graph serves both ROS versions. An object of a ROS type has the fields that all known definitions share, and those
    that the model names. If no definition is known, it has the properties of the data type.
    """

    def __init__(self, declarations: Declarations, interfaces: RosTypes) -> None:
        self._declarations = declarations
        self._distributions = interfaces.distributions
        self._left = 0

    def type_of(
        self, declared: robosc.DataType, interface: rosgraph.Interface, section: Section, path: Several[str]
    ) -> ex.Type:
        """Return the type of a variable of a data type that holds the value at `path` of a ROS message."""
        definitions = [
            _Defined(distribution, *reached)
            for distribution in self._distributions
            if (reached := distribution.type_at(interface.package, interface.type, section, path)) is not None
        ]
        self._left = MOST_VALUES
        result = self._type(declared, definitions)
        if self._left >= 0 and result is not None:
            return result
        return rosgraph.ArrayType() if isinstance(declared, robosc.Array) else rosgraph.ObjectType()

    def _type(self, declared: robosc.DataType | None, defined: Several[_Defined]) -> ex.Type | None:
        """Return the type for a declaration or for ROS definitions. None if the definitions disagree."""
        while isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.EnumDataType):
            declared = declared.type.type
        kinds = {type(known.wire) for known in defined} if declared is None else {_KINDS.get(type(declared), Basic)}
        if kinds == {NestedType}:
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
        result = rosgraph.ObjectType()
        named = {}
        if isinstance(declared, robosc.ComplexDataTypeReference) and isinstance(declared.type, robosc.ObjectDataType):
            named = {field.name: field.type for field in declared.type.properties}
        known_fields = [(definition, fields) for definition in defined if (fields := definition.fields()) is not None]
        # Only the seconds of times have the same meaning in ROS 1 and ROS 2, and rospy has another name for them.
        known = [
            (definition, fields)
            for definition, fields in known_fields
            if str(definition.wire).partition("/")[0] != _TIMES
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
                result.fields.append(rosgraph.ObjectField(name=name, type=kind))
        return result
