"""`robosc rule`: the meaning of rules."""

from robosc.base.diagnostics.rules import rules
from robosc.base.files.resources import locate

from .conftest import Run


def test_a_page(run: Run) -> None:
    answer = run("rule", "marked-state")
    assert (answer.exit_code, answer.stdout) == (0, locate("docs/rules/marked-state.md").read_text())


def test_all_rules(run: Run) -> None:
    assert run("rule").stdout.split() == list(rules())


def test_no_such_rule(run: Run) -> None:
    answer = run("rule", "marked-stat")
    assert answer.exit_code == 2
    assert "did you mean 'marked-state'?" in answer.stderr
    assert "`robosc rule` lists all rules" in run("rule", "xyz").stderr
