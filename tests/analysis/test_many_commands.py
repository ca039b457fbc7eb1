"""Hundreds of commands to one topic cost time in proportion to their number and draw one finding each at most."""

from typing import Any

import pytest

import robosc
from robosc.analysis import findings as findings_module
from robosc.analysis.observations import Observer
from robosc.analysis.supervise import supervise
from robosc.base.diagnostics import Diagnostic
from robosc.language.checks import check
from robosc.language.checks.rules import shared_names
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.m2m import robosc_to_sct

COMMANDS = 60


class Counter:
    """Count the calls of a function and pass them on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, owner: Any, name: str) -> None:
        self.calls = 0
        function = getattr(owner, name)

        def counted(*arguments: Any) -> Any:
            self.calls += 1
            return function(*arguments)

        monkeypatch.setattr(owner, name, counted)


class States(frozenset[int]):
    """A set of states that counts its operations."""

    operations = 0

    def satisfiable(self) -> bool:
        return bool(self)

    def __and__(self, other: Any) -> "States":
        States.operations += 1
        return States(frozenset.__and__(self, other))

    def __or__(self, other: Any) -> "States":
        States.operations += 1
        return States(frozenset.__or__(self, other))


class Empty:
    """An observer of a system with these states."""

    def __init__(self) -> None:
        self._system = self.diagrams = self
        self.false = States()


def meetings(where: dict[Any, States]) -> list[tuple[list[Any], Any, States]]:
    return list(Observer._meetings(Empty(), where))  # type: ignore[arg-type, type-var]


def robot(member: str, *, state: str = "") -> str:
    commands = "\n".join(f'incoming message m{n} with identifier: "/cmd", type: double' for n in range(COMMANDS))
    outside = "\n".join(member.format(n) for n in range(COMMANDS))
    return f"robot Many {{ component C {{ {commands}\n {state} }}\n{outside} }}"


def conflicts(text: str) -> list[Diagnostic]:
    model = robosc_to_sct.transform(robosc.load(text=text))[0]
    return [finding for finding in supervise(model).findings if finding.rule == "shared-topic-conflict"]


def test_commands_that_meet_none_cost_one_operation_each() -> None:
    States.operations = 0
    assert meetings({n: States([n]) for n in range(COMMANDS)}) == []
    assert States.operations == 2 * COMMANDS  # one intersection and one union


def test_each_command_is_named_with_those_before_it_that_it_meets() -> None:
    where = {"a": States([1, 2]), "b": States([3]), "c": States([2, 3]), "d": States([4]), "e": States([1])}
    assert meetings(where) == [(["a", "b"], "c", {2}), (["a"], "e", {1})]


def test_each_command_has_one_finding_and_one_example(monkeypatch: pytest.MonkeyPatch) -> None:
    examples = Counter(monkeypatch, Observer, "_example")
    edges = Counter(monkeypatch, findings_module, "edges_of")
    found = conflicts(robot("provide m{0} with {0}.5"))
    assert len(found) == examples.calls == COMMANDS - 1
    assert edges.calls <= 2 * COMMANDS
    assert found[0].message == (
        "`C.m0` and `C.m1` go to one topic, and both can be sent at the same time, so that they take turns"
    )
    assert found[9].message.endswith("; the same holds for `C.m10` and `C.m1`, `C.m2`, `C.m3` and 6 more")


def test_commands_that_exclude_each_other_have_none() -> None:
    selects = (
        f'outgoing message sel with identifier: "/sel", type: integer(0..{COMMANDS - 1}) behaviour {{ variable v:'
        f" integer(0..{COMMANDS - 1}) initial marked state a {{ on response from sel do v := value }} }}"
    )
    assert conflicts(robot("provide m{0} with {0}.5 requirement m{0} needs C.v = {0}", state=selects)) == []


def test_data_of_each_command_is_written_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    written = Counter(monkeypatch, shared_names, "_statements")
    reading = read("r.rscd", documents=Documents({"r.rscd": robot("provide m{0} with 0.5")}))
    found = [finding for finding in check(reading.base, reading.findings) if finding.rule == "indistinct-commands"]
    assert len(found) == COMMANDS - 1
    assert written.calls == COMMANDS
