"""Rules for models beyond the classes and multiplicities of their metamodels."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics.visible import visible
from robosc.model import expression as ex
from robosc.model import robosc, rosgraph, sct, xmi
from robosc.model.semantics.operators import FUNCTIONS, operator_of
from robosc.model.validity import robosc_models, rosgraph_models, sct_models
from robosc.model.validity.model_checks import Model, demand, faults_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.model.validity.model_checks import Check, Checks, Fault

_LARGEST = 2**63 - 1
_IDENTIFIER = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_PACKAGE = re.compile("[A-Za-z][A-Za-z0-9_-]*")
#: Features whose text people read unchanged, also in logs.
_SHOWN = ("text", "origin", "reference", "explanation")


def faults(root: Any) -> Iterator[Fault]:
    """Report the faults of a model whose required features are set: elements and reasons.

    In every model, names are identifiers and literals have no sign. An sct model has one initial location per plant,
    one edge per location and event, updates of own variables, and expressions of the right type. The references and
    types of a rosgraph model are consistent, also if several places read one message. Names in a robosc model refer to
    elements that they could refer to in a text. The rules of the language check the rest.
    """
    model = Model(root)
    yield from faults_of(model, _CHECKS)
    for tables in (tables for kind, tables in _OWN_CHECKS.items() if isinstance(root, kind)):
        for checks in tables:
            structural = list(faults_of(model, checks))
            yield from structural
            if structural:
                return


#: Loads a saved model and checks these rules.
load = partial(xmi.load, faults=faults)


def _identifier(feature: str) -> Check:
    """Return the check that a feature with one or several texts holds identifiers."""

    def check(element: Any, _model: Model) -> Iterator[Fault]:
        value = getattr(element, feature)
        for text in [value] if isinstance(value, str) else value:
            if not _IDENTIFIER.fullmatch(text):
                yield element, f"'{feature}' must be an identifier, found '{text}'"

    return check


def _shown(element: Any, _model: Model) -> Iterator[Fault]:
    for feature in _SHOWN:
        text = getattr(element, feature, None)
        if text is not None and visible(text) != text:
            yield element, f"'{feature}' must be one line without hidden characters"


def _literal(literal: ex.IntegerLiteral | ex.DoubleLiteral, _model: Model) -> Iterator[Fault]:
    most = _LARGEST + isinstance(literal.eContainer(), ex.UnaryMinus)
    if literal.value < 0:
        yield literal, "a literal has no sign; the sign is a UnaryMinus around it"
    elif isinstance(literal, ex.IntegerLiteral) and literal.value > most:
        yield literal, f"{literal.value} is not an integer of 64 bits"


_INTERFACE = [
    demand(
        lambda interface: bool(_PACKAGE.fullmatch(interface.package)), "'{0.package}' is not a name of a ROS package"
    ),
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
#: Precondition of the type checks. The number of arguments in a robosc model is checked by a rule of the language.
_CALLED: Checks = {
    ex.FunctionCall: [demand(lambda call: call.function in FUNCTIONS, "there is no function '{0.function}'")]
}
_ARGUMENTS: Checks = {
    ex.FunctionCall: [
        demand(
            lambda call: len(call.arguments) == getattr(operator_of(call), "parameters", None),
            "'{0.function}' has a wrong number of arguments",
        )
    ]
}
#: Tables of checks for each kind of model. A table is used only if the tables before it report no faults.
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
