"""The grammar and the metamodel have the same content."""

import re
from typing import Any

import pytest

from robosc.base.files.resources import locate
from robosc.language.builder import element_class
from robosc.language.grammar import first, first_words, following, is_reserved, language
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import ROBOSC_KEYWORDS

TEXT = locate("grammar/robosc.tx").read_text(encoding="utf-8")
RULES = re.findall(r"^(\w+):", TEXT, re.MULTILINE)
WORDS = {
    "BuiltIn",
    "Name",
    "UnreservedName",
    "Integer",
    "SignedInteger",
    "LoneInteger",
    "Double",
    "String",
    "LoneString",
}
WORDS |= {"Boolean", "Comment", "Each", "FeedbackTo"}
ENUMERATIONS = ["MessageDirection", "ResultType", "Quantifier", "InvariantKind", "TimeUnit"]
#: Words that are keywords in one place only, and names elsewhere.
UNRESERVED = {
    "after",
    "assume",
    "always",
    "at",
    "automaton",
    "canceled",
    "condition",
    "constant",
    "each",
    "else",
    "function",
    "change",
    "in",
    "send",
    "is",
    "limit",
    "min",
    "most",
    "ms",
    "never",
    "parameter",
    "s",
    "property",
    "reachable",
    "since",
    "then",
    "without",
}
#: Classes without a rule: only transformations, or linking, create them.
MADE_BY_TRANSFORMATIONS = {
    *("Type", "BooleanType", "IntegerType", "DoubleType", "StringType", "EnumerationType", "Enumeration"),
    *("EnumerationLiteral", "EnumerationLiteralReference", "DoubleConversion", "IntegerText"),
}
#: Features that no rule sets: reading sets them from the file, and left operands from operator precedence.
SET_OTHERWISE = {"source", "file", "left"}
#: Features that linking, or the comment above, sets in elements of one class.
MADE_BY_LINKING = {
    "InterfaceTypeReference": {"arguments", "definition", "interface", "type"},
    "Access": {"enumeration", "index"},
    "Component": {"number"},
    "ErrorReason": {"enumeration"},
    "Parameter": {"description"},
}


def classifier(name: str) -> Any:
    """Return the EClass or EEnum of a name, or None."""
    found = getattr(rsc, name, None) or getattr(ex, name, None)
    return getattr(found, "eClass", None) if isinstance(found, type) else found


CLASSES = [
    name
    for module in (rsc, ex)
    for name, var in vars(module).items()
    if isinstance(var, type) and hasattr(var, "eClass") and name not in MADE_BY_TRANSFORMATIONS
]


def body(rule: str) -> str:
    found = re.search(rf"^{rule}:(.*?);$", TEXT, re.MULTILINE | re.DOTALL)
    assert found is not None
    return found[1]


def is_abstract(name: str) -> bool:
    return bool(classifier(name).abstract)


def features(name: str) -> dict[str, Any]:
    others = SET_OTHERWISE | MADE_BY_LINKING.get(name, set())
    return {
        feature.name: feature for feature in classifier(name).eAllStructuralFeatures() if feature.name not in others
    }


def is_a(name: str, ancestor: str) -> bool:
    return name == ancestor or any(supertype.name == ancestor for supertype in classifier(name).eAllSuperTypes())


def test_there_is_a_class_for_each_rule() -> None:
    assert set(RULES) == {rule for rule in RULES if rule in CLASSES} | {*ENUMERATIONS} | WORDS | {"Operand"}


def test_there_is_a_rule_for_each_class_that_has_elements() -> None:
    assert [cls for cls in CLASSES if not is_abstract(cls) and cls not in RULES] == []


@pytest.mark.parametrize(
    "rule", [rule_name for rule_name in RULES if rule_name in CLASSES and not is_abstract(rule_name)]
)
def test_a_rule_assigns_exactly_the_features_of_its_class(rule: str) -> None:
    assigned = language()[rule]._tx_attrs
    wanted = features(rule)
    assert set(assigned) == set(wanted)
    for name, attribute in assigned.items():
        assert attribute.mult.endswith("*") == wanted[name].many


@pytest.mark.parametrize(
    "rule", [rule_name for rule_name in RULES if rule_name in CLASSES and not is_abstract(rule_name)]
)
def test_a_rule_assigns_what_its_class_wants(rule: str) -> None:
    assignments = re.findall(r"(\w+)[*+?]?=(\[?)(\w+|'\w+')", body(rule))
    assert {feature for feature, _, _ in assignments} == set(features(rule))
    for name, bracket, target in assignments:
        feature = features(rule)[name]
        if feature.is_attribute:
            assert not bracket
            assert target.startswith("'") or target in WORDS or target == feature.eType.name
        else:
            assert bool(bracket) != feature.containment
            # An operand is any expression: `Operand` is the rule between operators.
            assert is_a("Expression" if target == "Operand" else target, feature.eType.name)


@pytest.mark.parametrize("rule", [rule_name for rule_name in RULES if rule_name in CLASSES and is_abstract(rule_name)])
def test_the_alternatives_of_an_abstract_rule_are_kinds_of_its_class(rule: str) -> None:
    alternatives = re.findall(r"\w+", body(rule))
    assert alternatives
    for alternative in alternatives:
        assert alternative == "Operand" or is_a(alternative, rule)
        assert element_class(rule) is None


@pytest.mark.parametrize("rule", ENUMERATIONS)
def test_an_enumeration_has_the_words_of_its_rule(rule: str) -> None:
    words = re.findall(r"'(\w+)'", body(rule)) or re.search(r"/\(([\w|]+)\)", body(rule))[1].split("|")
    assert [literal.name for literal in classifier(rule).eLiterals] == words


def test_every_word_of_the_grammar_is_reserved_and_no_other() -> None:
    words = set(re.findall(r"'([a-z]+)'", TEXT))
    assert words == ROBOSC_KEYWORDS | UNRESERVED
    assert {word for word in words if not is_reserved(word)} == UNRESERVED
    assert not any(is_reserved(word) for word in ("continue", "states", "valued", "^state", "Robot"))


def test_what_a_rule_begins_with() -> None:
    assert first_words("State", "Variable") == {"initial", "marked", "state", "variable"}
    assert first_words("Requirement") == {"requirement"}  # without the words of its expression
    assert first("TopicRemapping") == {"Name"}
    assert {"array", "UnreservedName"} <= first("DataType")
    assert "true" in first("Expression")


def test_what_follows_a_word() -> None:
    assert following()["datatype"] == {"enum", "object"}
    assert following()["initial"] == {"marked", "state"}
    assert following()["incoming"] == {"message"}
    assert following()["goto"] == {"Name"}
    assert "on" not in following()["transition"]  # `on` would belong to the next transition
