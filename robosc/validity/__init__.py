"""The rules that every model keeps beyond its metamodel's classes and multiplicities."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.diagnostics.visible import visible
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph, sct, xmi
from robosc.semantics.operators import FUNCTIONS, operator_of
from robosc.validity import robosc_models, rosgraph_models, sct_models
from robosc.validity.model_checks import Model, demand, faults_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.validity.model_checks import Check, Checks, Fault

_LARGEST = 2**63 - 1
_IDENTIFIER = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_PACKAGE = re.compile("[A-Za-z][A-Za-z0-9_-]*")
#: The features whose texts people read as they stand, in logs too.
_SHOWN = ("text", "origin", "explanation")


def faults(root: Any) -> Iterator[Fault]:
    """What is wrong with a model whose required features are all set: the element, and the reason.

    Names are identifiers and literals have no sign in every model. An sct model has one initial location per plant,
    one edge per location and event, updates of own variables, and expressions of the right type; a rosgraph model's
    references and types agree with each other, also where one message is read at several places. Names in a robosc
    model mean what they can mean in a text; what else the language asks of it, its rules say.
    """
    model = Model(root)
    yield from faults_of(model, _CHECKS)
    for tables in (tables for kind, tables in _OWN_CHECKS.items() if isinstance(root, kind)):
        for checks in tables:
            found = list(faults_of(model, checks))
            yield from found
            if found:
                return


#: The loading of a saved model that keeps these rules.
load = partial(xmi.load, faults=faults)


def _identifier(feature: str) -> Check:
    """The check that a feature with one text or several holds identifiers."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        value = getattr(element, feature)
        for text in [value] if isinstance(value, str) else value:
            if not _IDENTIFIER.fullmatch(text):
                yield element, f"'{feature}' is to be an identifier, which '{text}' is not"

    return check


def _shown(element: Any, _model: Model) -> Iterator[Fault]:
    for feature in _SHOWN:
        text = getattr(element, feature, None)
        if text is not None and visible(text) != text:
            yield element, f"'{feature}' is to be one line without hidden characters"


def _literal(literal: ex.IntegerLiteral | ex.DoubleLiteral, _model: Model) -> Iterator[Fault]:
    most = _LARGEST + isinstance(literal.eContainer(), ex.UnaryMinus)
    if literal.value < 0:
        yield literal, "a literal has no sign; the sign is a UnaryMinus around it"
    elif isinstance(literal, ex.IntegerLiteral) and literal.value > most:
        yield literal, f"{literal.value} is no integer of 64 bits"


_INTERFACE = [
    demand(lambda interface: bool(_PACKAGE.fullmatch(interface.package)), "'{0.package}' is no name of a ROS package"),
    _identifier("type"),
]
_INDEX = demand(lambda step: step.index is None or step.index >= 0, "an index counts from 0")
_INDEX_GIVEN = demand(
    lambda step: (
        (step.index is None) != ((step.position if isinstance(step, rosgraph.IndexStep) else step.first) is None)
    ),
    "an index is a number or computed",
)

_CHECKS: Checks = {
    ex.NamedElement: [_identifier("name")],
    object: [_shown],
    ex.IntegerLiteral: [_literal],
    ex.DoubleLiteral: [_literal],
    robosc.Interface: _INTERFACE,
    rosgraph.Interface: _INTERFACE,
    robosc.IndexSegment: [_INDEX, _INDEX_GIVEN],
    rosgraph.IndexStep: [_INDEX, _INDEX_GIVEN],
    rosgraph.FieldStep: [_identifier("name")],
    rosgraph.FieldAssignment: [_identifier("path")],
    robosc.Access: [
        demand(
            lambda access: access.value == (access.item is None),
            "an access reads either an item or the value of the event",
        )
    ],
}
#: What the checks of types rely on. How many arguments a call has in a robosc model, a rule of the language says.
_CALLED: Checks = {
    ex.FunctionCall: [demand(lambda call: call.function in FUNCTIONS, "there is no function '{0.function}'")]
}
_ARGUMENTS: Checks = {
    ex.FunctionCall: [
        demand(
            lambda call: len(call.arguments) == getattr(operator_of(call), "parameters", None),
            "'{0.function}' has another number of arguments",
        )
    ]
}
#: The tables for each kind of model; where one finds something, the next are not asked.
_OWN_CHECKS: Mapping[type, Sequence[Checks]] = {
    robosc.Base: (_CALLED, robosc_models.IMPORT_CHECKS, robosc_models.CHECKS),
    sct.SupervisoryControlModel: (
        _CALLED,
        _ARGUMENTS,
        sct_models.CHECKS,
    ),
    rosgraph.RosGraph: (
        _CALLED,
        _ARGUMENTS,
        rosgraph_models.CHECKS,
    ),
}
