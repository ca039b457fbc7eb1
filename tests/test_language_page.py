"""The snippets of the language pages form a model without findings and with a supervisor."""

import re
from pathlib import Path

import robosc
from robosc.base.files.resources import locate

DOCS = Path(__file__).parent.parent / "docs"


def snippet(page: str, heading: str, number: int = 0) -> str:
    text = (DOCS / page).read_text(encoding="utf-8")
    section = text.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    return re.findall(r"^```robosc\n(.*?)^```$", section, flags=re.MULTILINE | re.DOTALL)[number]


def test_the_snippets_make_a_model(tmp_path: Path) -> None:
    components = snippet("language.md", "Components and their communication").rstrip()
    assert components.endswith("}")
    parts = [
        snippet("language.md", "Robot and library", 1),
        components[:-1] + snippet("language.md", "Behaviour") + "}",
        snippet("language-data.md", "Data types"),
        snippet("language-requirements.md", "Requirements"),
        snippet("language-requirements.md", "Provided data"),
    ]
    path = tmp_path / "porter.rscd"
    path.write_text("robot Porter {\n" + "\n".join(parts) + "}\n")
    robot = robosc.load(path)
    findings = [(finding.rule, finding.message) for finding in robosc.check(robot)]
    assert findings == [("interface-unknown", "the package `porter_msgs` is unknown")]
    assert robosc.synthesize(robosc.to_sct(robot)).controlledStates > 1


def test_the_snippet_on_time_is_a_behaviour(tmp_path: Path) -> None:
    behaviour = snippet("language-actions.md", "Time")
    heard = "\n".join(f"outgoing message {name} with type: none" for name in ("scan", "bumper"))
    behaviour = behaviour.replace("behaviour {", "behaviour {\n variable turned: boolean", 1)
    path = tmp_path / "turner.rscd"
    path.write_text(f"robot Turner {{ constant turn: integer = 800 component Base {{ {heard} {behaviour} }} }}")
    robot = robosc.load(path)
    assert robosc.check(robot) == []
    assert robosc.synthesize(robosc.to_sct(robot)).controlledStates == 3


def test_the_standard_library_is_what_the_page_says() -> None:
    page = (DOCS / "language-libraries.md").read_text(encoding="utf-8")
    files = list(locate("robosc/stdlib").glob("*.rscd"))
    assert len(files) == 4
    for file in files:
        text = file.read_text(encoding="utf-8")
        for kind in ("library", "component", "message", "action"):
            for name in re.findall(rf"^ *{kind} (\w+)", text, re.MULTILINE):
                assert f"`{name}`" in page


def test_the_snippets_on_serving_make_a_model(tmp_path: Path) -> None:
    page = (DOCS / "language-serving.md").read_text(encoding="utf-8")
    parts = re.findall(r"^```robosc\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
    path = tmp_path / "desk.rscd"
    path.write_text("robot Desk {\n" + "\n".join(parts) + "}\n")
    robot = robosc.load(path)
    assert robosc.check(robot) == []
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    commands = [
        f"{plant.name}.{event.name}"
        for plant in model.plants
        for event in plant.events
        if event.controllable and not plant.name.startswith("data_")
    ]
    assert commands == [
        "service_start.c_response",
        "action_inspect.c_feedback",
        "action_inspect.c_response",
        "action_inspect.c_canceled",
    ]
