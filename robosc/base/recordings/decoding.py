"""Decoding of recorded messages: by the definitions in the recording, else by known ones.

Import this module only on demand: loading it takes a quarter of a second.
"""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Any

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

from robosc.base.ros_types.wire import Basic, NestedType, Section, Sequence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rosbags.typesys.store import Typestore

    from robosc.base.ros_types import RosDistribution
    from robosc.base.ros_types.wire import WireType

#: Data of ROS: an object with fields as attributes.
Message = Any
#: Maximum number of fields and elements of a type, without those of arrays of varying length.
_MOST_PARTS = 100_000
#: Name of a type of a service or action, such as `std_srvs/srv/Trigger_Event`.
_NAME = re.compile(r"\b([A-Za-z]\w*)/(?:msg|srv|action)/(\w+)")
#: Suffixes of the types that services and actions are recorded with, with their fields in order of the type.
_UUID = NestedType("unique_identifier_msgs", "UUID")
_TIME = NestedType("builtin_interfaces", "Time")
_GENERATED: Mapping[str, Callable[[str, str], dict[str, WireType]]] = {
    "_FeedbackMessage": lambda package, name: {"goal_id": _UUID, "feedback": NestedType(package, f"{name}_Feedback")},
    "_SendGoal_Request": lambda package, name: {"goal_id": _UUID, "goal": NestedType(package, f"{name}_Goal")},
    "_SendGoal_Response": lambda *_: {"accepted": Basic("bool"), "stamp": _TIME},
    "_GetResult_Request": lambda *_: {"goal_id": _UUID},
    "_GetResult_Response": lambda package, name: {
        "status": Basic("int8"),
        "result": NestedType(package, f"{name}_Result"),
    },
    "_Event": lambda package, name: {
        "info": NestedType("service_msgs", "ServiceEventInfo"),
        "request": Sequence(NestedType(package, f"{name}_Request")),
        "response": Sequence(NestedType(package, f"{name}_Response")),
    },
}
_SECTIONS = {
    "_Request": Section.REQUEST,
    "_Response": Section.RESPONSE,
    "_Goal": Section.GOAL,
    "_Result": Section.RESULT,
    "_Feedback": Section.FEEDBACK,
}
#: Fields without a name of their own in ROS 1: both names read them.
_ROS_1_NAMES = {"secs": "sec", "nsec": "nanosec", "nsecs": "nanosec"}


class DecodingError(Exception):
    """A message that cannot be decoded; the message gives the reason."""


class Decoder:
    """Decoder of the messages of one type. It reads the definition at the first message.

    `definition` is that of the recording, empty if it has none; `form` is its format (`msg`, `idl`). `encoding` is that
    of the messages: `cdr` or `ros1`. `known` has the other definitions.
    """

    def __init__(self, kind: str, definition: str, form: str, encoding: str, known: RosDistribution) -> None:
        self._package, _, self._name = flat(kind).split("/")
        self._definition = definition
        self._form = form
        self._encoding = encoding
        self._known = known
        self._fault: str | None = None
        self._store: Typestore | None = None
        self._decode: Callable[[bytes], Message] | None = None
        self._fields: dict[type, Mapping[str, str]] = {}

    def __call__(self, data: bytes) -> Message:
        """Return the message of some bytes. Raises DecodingError."""
        if self._decode is None:
            self._prepare()
        assert self._decode is not None
        try:
            return self._decode(data)
        except Exception as error:  # Readers raise many kinds of exceptions for damaged bytes.
            raise DecodingError(str(error) or type(error).__name__) from None

    def wire_types(self, message: Message) -> Mapping[str, str]:
        """Return the types of the fields of a message, or of a part of it, as ROS writes them."""
        kind = type(message)
        if kind not in self._fields:
            assert self._store is not None
            _, fields = self._store.fielddefs[kind.__msgtype__]
            self._fields[kind] = {name: _type_text(description) for name, description in fields}
        return self._fields[kind]

    def _prepare(self) -> None:
        if self._fault is None:
            try:
                self._store = self._types()
            except Exception as error:  # as above
                self._fault = f"its type is unreadable: {str(error) or type(error).__name__}"
        if self._store is None:
            raise DecodingError(self._fault)
        name = f"{self._package}/msg/{self._name}"
        deserialize = self._store.deserialize_cdr if self._encoding == "cdr" else self._store.deserialize_ros1
        self._decode = lambda data: deserialize(data, name)

    def _types(self) -> Typestore:
        store = get_typestore(Stores.EMPTY)
        if self._definition:
            store.register(_parsed(self._definition, self._form, f"{self._package}/msg/{self._name}"))
        else:
            described: dict[str, Any] = {}
            _describe(self._package, self._name, self._known, described)
            store.register({name: fields for name, fields in described.items() if name not in store.fielddefs})
        _require_bounded(store.fielddefs)
        if self._encoding == "ros1":
            for name in ("Time", "Duration"):
                kind: Any = store.types[f"builtin_interfaces/msg/{name}"]
                for other, field in _ROS_1_NAMES.items():
                    setattr(kind, other, property(partial(_attribute, field)))
        return store


def flat(kind: str) -> str:
    """Return the name of a type as that of a message: services and actions are recorded as messages."""
    package, *_, name = kind.split("/")
    return f"{package}/msg/{name}"


def _attribute(name: str, owner: Message) -> Any:
    return getattr(owner, name)


def _parsed(definition: str, form: str, name: str) -> dict[str, Any]:
    """Return the types of a definition and of those behind it."""
    if form == "msg":
        return dict(get_types_from_msg(_NAME.sub(r"\1/msg/\2", definition), name))
    separator = f"{'=' * 80}\nIDL: "
    parts = definition.split(separator)[1:] if definition.startswith(separator) else [f"\n{definition}"]
    types: dict[str, Any] = {}
    for part in parts:
        types |= get_types_from_idl(part.partition("\n")[2])
    return {
        flat(name): (constants, [(field, _flat(kind)) for field, kind in fields])
        for name, (constants, fields) in types.items()
    }


def _flat(description: Any) -> Any:
    kind, details = description
    if kind == Nodetype.NAME:
        return kind, flat(details)
    return description if kind == Nodetype.BASE else (kind, (_flat(details[0]), details[1]))


def _describe(package: str, name: str, known: RosDistribution, described: dict[str, Any]) -> None:
    """Add the description of a type, and of those inside it, as rosbags has them. Raises DecodingError."""
    key = f"{package}/msg/{name}"
    if key in described:
        return
    fields = _fields(package, name, known)
    if fields is None:
        raise DecodingError(f"{package}/{name} is not known")
    described[key] = [], [(field, _description(kind)) for field, kind in fields.items()]
    if not fields and known.name == "ROS 2":
        described[key][1].append(("structure_needs_at_least_one_member", _description(Basic("uint8"))))
    for kind in fields.values():
        inner = kind.element if isinstance(kind, Sequence) else kind
        if isinstance(inner, NestedType):
            _describe(inner.package, inner.name, known, described)


def _fields(package: str, name: str, known: RosDistribution) -> Mapping[str, WireType] | None:
    for suffix, section in _SECTIONS.items():
        if name.endswith(suffix):
            fields = known.fields(package, name.removesuffix(suffix), section)
            if fields is not None:
                return fields
    for suffix, generated in _GENERATED.items():
        if name.endswith(suffix):
            return generated(package, name.removesuffix(suffix))
    return known.fields(package, name, Section.MESSAGE)


def _description(kind: WireType) -> Any:
    match kind:
        case Basic(name="wstring"):
            raise DecodingError("wide strings are not read")
        case Basic():
            return Nodetype.BASE, (kind.name, 0)
        case NestedType():
            return Nodetype.NAME, f"{kind.package}/msg/{kind.name}"
    if kind.length is None:
        return Nodetype.SEQUENCE, (_description(kind.element), 0)
    return Nodetype.ARRAY, (_description(kind.element), kind.length)


def _type_text(description: Any) -> str:
    """Return a type as ROS writes it, such as `float64`, `string` or `uint8[9]`."""
    kind, details = description
    match kind:
        case Nodetype.BASE:
            return str(details[0])
        case Nodetype.NAME:
            return str(details)
        case Nodetype.ARRAY:
            return f"{_type_text(details[0])}[{details[1]}]"
    return f"{_type_text(details[0])}[]"


def _require_bounded(types: Mapping[str, Any]) -> None:
    """Check that reading the types ends soon: none contains itself, and none has very many parts.

    A part without bytes makes an array of any length possible. Raises DecodingError.
    """
    sizes: dict[str, tuple[int, bool]] = {}

    def size(name: str, above: Iterable[str]) -> tuple[int, bool]:
        """Return the number of parts of a type, and whether it has any bytes."""
        if name in above:
            raise DecodingError(f"{name} contains itself")
        if name not in sizes:
            parts = [size_of(kind, (*above, name)) for _, kind in types[name][1]] if name in types else [(1, True)]
            sizes[name] = 1 + sum(count for count, _ in parts), any(has_bytes for _, has_bytes in parts)
            if sizes[name][0] > _MOST_PARTS:
                raise DecodingError(f"{name} has more than {_MOST_PARTS:,} parts")
        return sizes[name]

    def size_of(description: Any, above: Iterable[str]) -> tuple[int, bool]:
        kind, details = description
        if kind == Nodetype.BASE:
            return 1, True
        if kind == Nodetype.NAME:
            return size(details, above)
        count, has_bytes = size_of(details[0], above)
        if not has_bytes:
            raise DecodingError("an array has elements without content")
        is_basic = details[0][0] == Nodetype.BASE and details[0][1][0] != "string"
        return (count if kind == Nodetype.SEQUENCE or is_basic else count * details[1]), True

    for name in types:
        size(name, ())
