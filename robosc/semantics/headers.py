"""Which headers of data that goes out the model leaves to the node."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph


def parts_with_headers(sending: rosgraph.Sending) -> list[tuple[str, ...]]:
    """The data as a whole, `()`, and its parts on the way to fields that the model sets, by their path, sorted.

    A goal of `pose.pose.position.x` has `pose`, `pose.pose` and `pose.pose.position`: each gets the time and the frame,
    where it has a field `header`. A part of which the model sets some field of `header` is not among them: that header
    is the model's.
    """
    paths = [tuple(field.path) for data in sending.alternatives for field in data.fields]
    parts = {()} | {path[:length] for path in paths for length in range(1, len(path))}
    given = {path[: path.index("header")] for path in paths if "header" in path}
    return sorted(part for part in parts - given if "header" not in part)
