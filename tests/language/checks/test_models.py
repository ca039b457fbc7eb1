"""A model in `rejected` draws exactly the findings that its first line names; one in `accepted` draws none."""

import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from robosc.base.diagnostics import Diagnostic, Severity, as_text
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.checks.rule import RULES
from robosc.language.reading import read

HERE = Path(__file__).parent
REJECTED = sorted((HERE / "rejected").glob("*/*.rscd"))
ACCEPTED = sorted((HERE / "accepted").glob("*/*.rscd"))
#: Fictional packages of the models are unknown; those in this folder are known.
UNKNOWN, INTERFACES = "interface-unknown", HERE / "interfaces"
_EXPECTED = re.compile(r"// expect: (\S+)((?: \d+)+)\n")


def name(model: Path) -> str:
    return f"{model.parent.name}/{model.stem}"


def findings(model: Path) -> tuple[list[Diagnostic], dict[str, str]]:
    known = RosTypes([INTERFACES])
    reading = read(model, [HERE / "libraries"], known)
    found = check(reading.base, reading.findings, known)
    expected = [finding for finding in found if finding.rule != UNKNOWN or model.parent.name == UNKNOWN]
    return [*reading.findings, *expected], reading.texts


@pytest.mark.parametrize("model", REJECTED, ids=name)
def test_rejected_model_draws_exactly_the_expected_findings(model: Path) -> None:
    expected = _EXPECTED.match(model.read_text())
    assert expected, "the first line says `// expect: <rule> <line>...`"
    rule, lines = expected[1], expected[2].split()
    assert rule == model.parent.name
    found = findings(model)[0]
    assert [(finding.file, finding.rule, finding.span.line) for finding in found] == [
        (str(model), rule, int(line)) for line in lines
    ]
    severity = RULES[rule].severity if rule in RULES else Severity.ERROR  # linking reports it
    assert {finding.severity for finding in found} == {severity}
    assert all(finding.hint for finding in found)


@pytest.mark.parametrize("model", ACCEPTED, ids=name)
def test_accepted_model_draws_nothing(model: Path) -> None:
    assert findings(model)[0] == []


@pytest.mark.parametrize("rule", sorted(RULES))
def test_every_rule_has_enough_models(rule: str) -> None:
    rejected, accepted = (Counter(model.parent.name for model in models) for models in (REJECTED, ACCEPTED))
    assert rejected[rule] >= 3
    assert accepted[rule] >= 2


@pytest.mark.parametrize("rule", sorted({*RULES, "unique-enum-value"}))
def test_wording(rule: str, golden: Callable[[Path, str], None]) -> None:
    folder = HERE / "rejected" / rule
    shown = []
    for model in sorted(folder.glob("*.rscd")):
        found, texts = findings(model)
        shown.append(as_text.render(found, texts).replace(f"{folder}/", "").replace(f"{INTERFACES}/", ""))
    golden(folder / "findings.txt", "\n".join(shown))
