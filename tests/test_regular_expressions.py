"""No text makes a regular expression of the product slow: each takes time proportional to the text."""

import re

import pytest

from robosc.language.grammar import pattern
from tests.regular_expressions import Expression, collect, slow


@pytest.mark.slow
@pytest.mark.parametrize("part", range(8))
def test_every_regular_expression_takes_linear_time(part: int) -> None:
    faults = [fault for expression in collect()[part::8] if (fault := slow(expression)) is not None]
    assert not faults, "\n".join(faults)


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["BuiltIn", "Quantifier", "LoneString", "LoneInteger", "Comment", "String"])
def test_the_words_of_the_grammar_take_linear_time(rule: str) -> None:
    assert slow(Expression(f"grammar/robosc.tx: {rule}", pattern(rule), re.MULTILINE, frozenset({"match"}))) is None


def test_all_of_them_are_collected() -> None:
    places = [expression.place for expression in collect()]
    for file in (
        *("grammar/robosc.tx", "grammar/cif.tx", "grammar/generated_cif.tx", "robosc/language/tokens.py"),
        *(
            "robosc/language/highlighting/rules.py",
            "robosc/schemas/state.schema.json",
            "editors/vscode/src/extension.ts",
        ),
        *("web/src/commands.ts", "robosc/m2t/ros/ros2/templates/play_trace.py.j2", "robosc/language/completion.py"),
    ):
        assert any(place.startswith(file) for place in places), file


@pytest.mark.slow
@pytest.mark.parametrize(
    ("expression", "is_slow"),
    [
        (r"(a|a)*b", True),
        (r"(//[^\n]*|\s)*x", True),
        (r"\A(?://[^\n]*|\s)*+x", False),
        (r"\s*x\Z", True),
        (r"(?<!\s)\s*x\Z", False),
        (r'"(\\.|[^"])*"', True),
        (r'"(\\.|[^"\\])*+"?', False),
    ],
)
def test_slow_ones_are_found(expression: str, is_slow: bool) -> None:
    found = slow(Expression("here", expression, 0, frozenset({"finditer"})))
    assert (found is not None) == is_slow
