"""Rounds constants that are compared with a float of 32 bits, as the node rounds them when it sends them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.ros_types.wire import Basic
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.reflection import tree
from robosc.model.semantics.evaluation import single_precision
from robosc.model.semantics.messages import EACH, path_of, source_of
from robosc.model.semantics.operators import COMPARISONS

if TYPE_CHECKING:
    from robosc.base.ros_types import RosTypes, Section


def round_constants(root: ex.Located, interface: rosgraph.Interface, section: Section, known: RosTypes) -> None:
    """Round the literals and parameters below `root` that are compared with a `float32` of a section of a type."""

    def is_single(operand: ex.Expression) -> bool:
        if not isinstance(operand, rosgraph.WireAccess) or source_of(operand) is not None:
            return False
        path = ["0" if step == EACH else step for step in path_of(operand)]
        types = (of_ros.type_at(interface.package, interface.type, section, path) for of_ros in known.distributions)
        wire = next((at_end[0] for at_end in types if at_end is not None), None)
        return isinstance(wire, Basic) and wire.name == "float32"

    for _, part in tree(root):
        if isinstance(part, COMPARISONS) and (is_single(part.left) or is_single(part.right)):
            _round(part.left)
            _round(part.right)


def _round(operand: ex.Expression) -> None:
    match operand:
        case ex.UnaryMinus():
            _round(operand.operand)
        case ex.DoubleLiteral():
            operand.value = single_precision(operand.value)
        case rosgraph.NodeVariableReference():
            operand.single = isinstance(operand.variable, rosgraph.Parameter)
