"""Under which names a controller and its robot meet the layer between them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.layer.node import LayerNode


def remapped(layer: LayerNode, parts_of_actions: Sequence[str]) -> list[str]:
    """The robot's names that a controller is started with others for; an action is re-mapped part by part."""
    names = [each.topic for each in layer.inward] + [each.topic for each in layer.outward]
    names += [each.name for each in layer.services]
    return names + [f"{each.name}/{part}" for each in layer.actions for part in parts_of_actions]
