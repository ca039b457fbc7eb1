"""What keeps a node from starting."""

from __future__ import annotations

import signal
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph

_MODULES = {"message": "msg", "service": "srv", "action": "action"}


class StartError(Exception):
    """A node can't start, for a reason that its user can do something about: what to do is the second argument."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.hint = hint


def ending_signals() -> list[signal.Signals]:
    """The signals that ask a node to end: Ctrl-C, SIGTERM and, unless it is ignored (nohup), a hangup."""
    hangup = [signal.SIGHUP] if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else []
    return [signal.SIGINT, signal.SIGTERM, *hangup]


def interface_class(interface: rosgraph.Interface, suffix: str, hint: str) -> Any:
    """The Python class of a ROS type, its name with a suffix. Raises StartError where there is none."""
    kind = _MODULES[interface.kind.name]
    folder = "msg" if suffix else kind
    try:
        module = import_module(f"{interface.package}.{folder}")
        return getattr(module, interface.type + suffix)
    except ImportError as error:
        missing = (
            f"{interface.package}.{folder}"
            if error.name in {interface.package, f"{interface.package}.{folder}"}
            else error
        )
        raise StartError(
            f"{interface.package}/{interface.type}: the ROS package {interface.package} is not built for Python here"
            f" ({missing})",
            hint,
        ) from None
    except AttributeError:
        raise StartError(
            f"the ROS package {interface.package} has no {interface.kind.name} {interface.type}", hint
        ) from None
