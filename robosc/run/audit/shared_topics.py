"""Commands that share a topic: which of them has the data of a recorded message."""

from __future__ import annotations

import math
from copy import deepcopy
from functools import reduce
from typing import TYPE_CHECKING, Any

from robosc.model.semantics.messages import reads_state
from robosc.model.semantics.operators import UnreadableError
from robosc.run.runtime.core.node_data import UNSENDABLE, within_range

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.model import rosgraph
    from robosc.model.semantics.messages import Path
    from robosc.run.audit.port import RecordingPort
    from robosc.run.runtime.core.composer import Composer
    from robosc.run.runtime.core.port import Message

#: Type of a header, which a node fills itself.
_HEADER = "std_msgs/msg/Header"
#: Relative error of a float32.
_PRECISION = 1e-6
#: Stands for any value.
_ANY: Any = object()


class SharedTopics:
    """Data of commands that share a topic. Forwarded objects leave it open."""

    def __init__(self, port: RecordingPort, composer: Composer) -> None:
        self._port = port
        self._composer = composer
        self._data = composer.data
        self._constant: dict[rosgraph.Sending, bool] = {}

    def is_constant(self, sending: rosgraph.Sending) -> bool:
        """Return whether the data of a command depends on nothing but parameters and its `provide` statement."""
        if sending not in self._constant:
            fields = [field for provided in sending.alternatives for field in provided.fields]
            expressions = [part for field in fields for part in (field.value, field.condition) if part is not None]
            self._constant[sending] = not sending.limits and not any(map(reads_state, expressions))
        return self._constant[sending]

    def has_data(self, sending: rosgraph.Sending, message: Message) -> bool:
        """Return whether a message has the data that a command has in the present state."""
        expected = self._expected(sending)
        if sending.limits:
            expected |= self._limited(sending, message, expected)
        for path, value in self._leaves(message):
            known = _value_at(expected, path)
            if known is not _ANY and not _equal(value, known):
                return False
        return True

    def _expected(self, sending: rosgraph.Sending) -> dict[Path, Any]:
        """Return the fields that the command sets before its limits, by path."""
        chosen = next((data for data in sending.alternatives if self._data.is_in(data.location)), None)
        expected: dict[Path, Any] = {}
        for field in () if chosen is None else chosen.fields:
            try:
                if field.condition is None or self._data.value(field.condition):
                    expected[tuple(field.path)] = within_range(self._data.value(field.value), field.type)
            except UnreadableError:
                expected[tuple(field.path)] = _ANY
        return expected

    def _limited(self, sending: rosgraph.Sending, message: Message, expected: dict[Path, Any]) -> dict[Path, Any]:
        """Return the fields that the limits set in the expected data."""
        composed = deepcopy(message)
        for path, value in self._leaves(message):
            known = _value_at(expected, path)
            if known is not _ANY:
                owner = reduce(getattr, path[:-1], composed)
                setattr(owner, path[-1], _default(value) if known is None else known)
        try:
            return dict(self._composer.limited_fields(sending, composed))
        except UNSENDABLE:
            return {tuple(field.path): _ANY for limit in sending.limits for field in limit.fields}

    def _leaves(self, message: Message, path: Path = ()) -> Iterator[tuple[Path, Any]]:
        """Yield the fields of a message that are no objects, with their paths; headers have none."""
        for name, kind in self._port.wire_types(message).items():
            value, place = getattr(message, name), (*path, name)
            if kind == _HEADER or name == "structure_needs_at_least_one_member":
                continue
            if "/" in kind and not kind.endswith("]"):
                yield from self._leaves(value, place)
            else:
                yield place, value


def _default(value: Any) -> Any:
    """Return the default of ROS for a field with a value."""
    return value[:0] if hasattr(value, "tolist") or isinstance(value, list) else type(value)()


def _value_at(expected: dict[Path, Any], path: Path) -> Any:
    """Return the expected value at a path, or of an object around it; None for the default of ROS."""
    return next((expected[path[:end]] for end in range(len(path), -1, -1) if path[:end] in expected), None)


def _equal(value: Any, expected: Any) -> bool:
    """Return whether a recorded value is the expected one; None stands for the default of ROS."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, list):
        if expected is None:
            return not any(value)
        return isinstance(expected, list) and len(value) == len(expected) and all(map(_equal, value, expected))
    if expected is None:
        return not value
    if isinstance(value, float) and isinstance(expected, int | float):
        return math.isclose(value, expected, rel_tol=_PRECISION, abs_tol=1e-12)
    return bool(value == getattr(expected, "name", expected))
