"""The rules that every model keeps beyond its metamodel's classes and multiplicities."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from robosc.diagnostics.visible import visible
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph, sct
from robosc.metamodel.reflection import tree
from robosc.metamodel.robosc_validity import robosc_faults
from robosc.metamodel.rosgraph_validity import rosgraph_faults
from robosc.metamodel.sct_validity import sct_faults

if TYPE_CHECKING:
    from collections.abc import Iterator

_LARGEST = 2**63 - 1
_IDENTIFIER = re.compile("[A-Za-z_][A-Za-z0-9_]*")
#: What is told to people, in logs too, as it stands.
_TOLD = ("text", "origin", "explanation")
_PACKAGE = re.compile("[A-Za-z][A-Za-z0-9_-]*")


def faults(root: Any) -> Iterator[tuple[Any, str]]:
    """What is wrong with a model whose required features are all set: the element, and the reason.

    Names are identifiers and literals have no sign in every model. An sct model has one initial location per plant,
    one edge per location and event, updates of own variables, and expressions of the right type; a rosgraph model's
    references and types agree with each other, also where one message is read at several places. Names in a robosc
    model mean what they can mean in a text; what else the language asks of it, its rules say.
    """
    elements = [element for _, element in tree(root)]
    for element in elements:
        yield from _own_faults(element)
    if isinstance(root, robosc.Base):
        yield from robosc_faults(elements)
    elif isinstance(root, sct.SupervisoryControlModel):
        yield from sct_faults(root, elements)
    elif isinstance(root, rosgraph.RosGraph):
        yield from rosgraph_faults(root, elements)


def _own_faults(element: Any) -> Iterator[tuple[Any, str]]:
    texts = [("name", element.name)] if isinstance(element, ex.NamedElement) else []
    match element:
        case robosc.Interface() | rosgraph.Interface():
            if not _PACKAGE.fullmatch(element.package):
                yield element, f"'{element.package}' is no name of a ROS package"
            texts.append(("type", element.type))
        case rosgraph.FieldStep():
            texts.append(("name", element.name))
        case rosgraph.FieldAssignment():
            texts += [("path", part) for part in element.path]
        case ex.IntegerLiteral() | ex.DoubleLiteral():
            yield from _literal_faults(element)
        case robosc.IndexSegment() | rosgraph.IndexStep() if element.index < 0:
            yield element, "an index counts from 0"
        case robosc.Access() if element.value == (element.item is not None):
            yield element, "an access reads either an item or the value of the event"
    yield from _told_faults(element)
    for feature, text in texts:
        if not _IDENTIFIER.fullmatch(text):
            yield element, f"'{feature}' is to be an identifier, which '{text}' is not"


def _told_faults(element: Any) -> Iterator[tuple[Any, str]]:
    for feature in _TOLD:
        told = getattr(element, feature, None)
        if told is not None and visible(told) != told:
            yield element, f"'{feature}' is to be one line without hidden characters"


def _literal_faults(element: ex.IntegerLiteral | ex.DoubleLiteral) -> Iterator[tuple[Any, str]]:
    most = _LARGEST + isinstance(element.eContainer(), ex.UnaryMinus)
    if element.value < 0:
        yield element, "a literal has no sign; the sign is a UnaryMinus around it"
    elif isinstance(element, ex.IntegerLiteral) and element.value > most:
        yield element, f"{element.value} is no integer of 64 bits"
