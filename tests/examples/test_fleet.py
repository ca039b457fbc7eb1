"""The fleet: its robots can wait for each other forever without two requirements, and never with them."""

import re

import pytest
from click.testing import CliRunner

import robosc
from robosc.analysis.verify import verify_system
from robosc.analysis.verify.verdict import Outcome
from robosc.model import sct
from robosc.tools.cli import main
from robosc.tools.diagrams import behaviour_graph, diagram

from .conftest import EXAMPLES

FLEET = EXAMPLES / "fleet"
NAMES = ["deadlock", "fleet"]
EIGHT = "Robot[1..8]"
#: A deadlock takes five robots: two on the lane, two in the bays, and one in the lift.
FIVE = "Robot[1..5]"


def text_of(name: str) -> str:
    return (FLEET / f"{name}.rscd").read_text()


def synthesized(text: str) -> sct.SupervisoryControlModel:
    model = robosc.to_sct(robosc.load(text=text))
    robosc.synthesize(model)
    return model


def outcomes(text: str) -> dict[str, Outcome]:
    """Return the outcome of each property, by the name of its text or analysis."""
    return {verdict.property: verdict.outcome for verdict in verify_system(synthesized(text))}


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_wrong(name: str) -> None:
    answer = CliRunner().invoke(main, ["check", str(FLEET / f"{name}.rscd")])
    assert (answer.exit_code, answer.output) == (0, "")


def test_the_two_models_differ_in_two_requirements() -> None:
    def parts(name: str) -> list[str]:
        text = re.sub(r"//.*", "", text_of(name)).partition("{")[2]
        return [" ".join(part.split()) for part in re.split(r"(?=\b(?:component|requirement|property)\b)", text)]

    more = [part for part in parts("fleet") if part not in parts("deadlock")]
    assert [part.partition(' "')[0] for part in more] == ["requirement R8", "requirement R9"]
    assert [part for part in parts("fleet") if part not in more] == parts("deadlock")


@pytest.mark.parametrize("fleet", [FIVE, pytest.param(EIGHT, marks=pytest.mark.slow)])
def test_robots_can_wait_for_each_other_forever(fleet: str) -> None:
    found = outcomes(text_of("deadlock").replace(EIGHT, fleet))
    refuted = {name for name, outcome in found.items() if outcome is not Outcome.PROVED}
    assert len(refuted) == int(fleet[-2])
    assert all(name.startswith("property P[Robot") for name in refuted)


@pytest.mark.parametrize("fleet", [FIVE, pytest.param(EIGHT, marks=pytest.mark.slow)])
def test_two_requirements_prevent_it(fleet: str) -> None:
    found = outcomes(text_of("fleet").replace(EIGHT, fleet))
    assert {*found.values()} == {Outcome.PROVED}
    assert sum(name.startswith("property P[Robot") for name in found) == int(fleet[-2])


def test_synthesis_can_prevent_it_too() -> None:
    """The supervisor of the page's last variant allows more than the two requirements."""
    enforced = text_of("deadlock").replace(EIGHT, FIVE).replace("property P", "requirement P")
    model, written = synthesized(enforced), synthesized(text_of("fleet").replace(EIGHT, FIVE))
    assert model.supervisor is not None
    assert written.supervisor is not None
    assert model.supervisor.controlledStates > written.supervisor.controlledStates


@pytest.mark.slow
def test_scenarios() -> None:
    answer = CliRunner().invoke(main, ["test", str(FLEET / "fleet.rscd"), str(FLEET / "fleet.scenarios")])
    assert answer.exit_code == 0, answer.output


def test_the_picture_is_up_to_date(golden) -> None:
    """It shows one robot: all have one text."""
    robot = robosc.load(text=text_of("fleet").replace(EIGHT, "Robot[1..1]"))
    golden(FLEET / "behaviour.svg", diagram(behaviour_graph(robot), "svg"))


def test_the_page_names_every_topic_and_quotes_the_requirements() -> None:
    page = (FLEET / "README.md").read_text()
    local = text_of("fleet").partition("behaviour")[0]
    for message in re.findall(r"message (\w+)", local):
        assert f"`{message}`" in page
    for requirement in re.findall(r"```robosc\n(.*?)```", page, re.DOTALL):
        assert " ".join(requirement.split()) in " ".join(text_of("fleet").split())
