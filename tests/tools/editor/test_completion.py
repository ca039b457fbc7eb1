"""Completion proposals at each place, also in an unfinished text."""

import re

import pytest
from lsprotocol import types

from robosc.language.reading import read
from robosc.language.text import Documents, Text
from robosc.tools.editor.completion import completion, signature_help
from robosc.tools.editor.project import Project
from robosc.tools.editor.snippets import SNIPPETS
from tests.tools.editor.server import LIBRARY, edited

TEXT = """robot Cart {
  constant limit: double = 0.5
  function gain(d: double, factor: double): double = d * factor
  datatype enum View(near: double) from double to { value < near -> close default -> far }
  datatype object Speed { forward: double turn: double }
  interface laser use LaserScan from sensor_msgs
  component Base from Wheels import Motors
  component Lidar(ns: string) {
    outgoing message scan with identifier: ns + "/scan", type: sensor_msgs/LaserScan
    outgoing message distance with identifier: ns + "/distance", type: View(0.5)
    behaviour {
      variable seen: View = far
      initial marked state blocked { on response from distance do seen := value goto free }
      state free { }
    }
  }
  component Front is Lidar("/front")
  component Arm {
    service home with request: none, response: std_srvs/Trigger
    action reach with request: double, response: none, feedback: double
    behaviour { initial marked state idle { on response from home goto idle } state busy { } }
  }
  requirement Turns: automaton { initial state mine { on request to home goto yours } state yours { } }
  requirement home needs Front.free
  provide reach with 0.5
}
"""


@pytest.fixture(scope="module")
def project() -> Project:
    made = Project()
    made.put("file:///nowhere/wheels.rscd", 1, LIBRARY)
    return made


def complete(project: Project, text: str) -> dict[str, types.CompletionItem]:
    """Return the proposals at the `|` of a text."""
    offset, content = text.index("|"), text.replace("|", "")
    path = project.put("file:///nowhere/cart.rscd", 1, content)
    snapshot = project.snapshot()
    analysis = snapshot.analysis(path)
    position = types.Position(*analysis.text.to_utf16(offset))
    asked = types.CompletionParams(types.TextDocumentIdentifier("file:///nowhere/cart.rscd"), position)
    return {item.label: item for item in completion(snapshot, analysis, asked).items}


def behind(marker: str, typed: str = "|", *, nth: int = 0) -> str:
    """Return the text with input inserted after an occurrence of a marker."""
    offset = -1
    for _ in range(nth + 1):
        offset = TEXT.index(marker, offset + 1)
    return TEXT[: offset + len(marker)] + typed + TEXT[offset + len(marker) :]


CHOICE = """robot R {
  datatype object Speed { forward: double turn: double }
  component C { incoming message move with type: Speed behaviour { initial marked state home { } } }
  provide move with if C.home """
CASES = [
    # The text is complete except at the cursor: (text, expected proposals, unexpected proposals).
    ("|", {"robot", "library"}, {"component"}),
    (behind("robot Cart {\n", "  |\n"), {"component", "requirement", "provide", "constant"}, {"state", "Base"}),
    (behind("state free { ", "|"), {"on", "transition", "after"}, {"component"}),
    (behind("state free { ", "on |"), {"response", "request", "feedback"}, {"state"}),
    (behind("state free { ", "on response from |"), {"scan", "distance", "home", "reach", "speed"}, {"drive", "free"}),
    (behind("state free { ", "on feedback from |"), {"reach"}, {"scan", "home"}),
    (behind("state free { ", "on response from distance |"), {"if", "do", "goto"}, {"needs"}),
    (behind("state free { ", "on response from distance goto |"), {"blocked", "free"}, {"idle"}),
    (behind("state free { ", "on response from distance goto bl|"), {"blocked", "free"}, {"idle"}),
    (behind("state free { ", "on response from scan if value.|"), {"ranges", "angle_min"}, {"scan"}),
    (
        behind("state free { ", "transition if |"),
        {"seen", "free", "limit", "gain", "close", "abs", "true", "all"},
        {"on"},
    ),
    (behind("state free { ", "transition if seen = View.|"), {"close", "far"}, {"seen", "free"}),
    (behind("state free { ", "on response from distance do |"), {"seen"}, {"if"}),
    (behind("state free { ", "after 3.0 |"), {"s", "ms", "min"}, {"goto"}),
    (behind("state free { ", "after 3.0 s without |"), {"scan", "distance"}, {"home", "drive"}),
    (behind("requirement home needs ", "|", nth=0), {"Front", "Arm", "limit", "Turns", "true"}, {"home"}),
    (behind("home needs Front.", "|"), {"free", "blocked", "seen"}, {"idle", "limit"}),
    (behind("home needs Front.free", " and Arm.|"), {"idle", "busy"}, {"free"}),
    (behind("home needs Front.free", " and Turns.|"), {"mine", "yours"}, {"idle"}),
    (behind("0.5\n", "  requirement |\n", nth=1), {"home", "reach", "drive", "Front", "never", "always"}, {"scan"}),
    (behind("0.5\n", "  requirement at most 3 |\n", nth=1), {"home", "reach"}, {"blocked"}),
    (behind("0.5\n", "  provide |\n", nth=1), {"drive", "reach", "home"}, {"scan"}),
    (behind("0.5\n", "  component Other from |\n", nth=1), {"Wheels", "TurtlebotLibrary"}, {"Base"}),
    (behind("0.5\n", "  component Other from Wheels import |\n", nth=1), {"Motors"}, {"Base"}),
    (behind("0.5\n", "  component Other from Wheels import Motors with { |\n", nth=1), {"drive", "speed"}, {"home"}),
    (behind("0.5\n", "  component Other is |\n", nth=1), {"Lidar"}, {"Base", "Arm"}),
    (behind("0.5\n", "  component Other is Lidar(|\n", nth=1), {"ns", "limit"}, {"seen"}),
    (behind("0.5\n", "  interface other use | from std_srvs\n", nth=1), {"Trigger", "Empty"}, {"LaserScan"}),
    (behind("0.5\n", "  interface other use Trigger from |\n", nth=1), {"std_srvs", "sensor_msgs"}, {"Wheels"}),
    (behind("0.5\n", "  constant c: |\n", nth=1), {"boolean", "double", "View", "Speed"}, {"limit"}),
    (behind("type: sensor_msgs/", "|"), {"LaserScan", "Range"}, {"Trigger"}),
    (behind("type: sensor_msgs/LaserScan", " links |"), {"laser"}, {"scan"}),
    (behind("{ value < ", "|"), {"near", "limit", "gain"}, {"seen", "Front"}),
    (behind("on request to home goto ", "|"), {"mine", "yours"}, {"idle"}),
    (behind("d * factor", " + |"), {"d", "factor", "limit"}, {"seen"}),
    (
        "robot R {\n  component C { outgoing message m with type: double behaviour { state s { on response from |",
        {"m"},
        {"s"},
    ),
    ("robot R {\n  component C { behaviour { initial state s { } state t { transition goto |", {"s", "t"}, set()),
    (behind("identifier: ns + ", '"|" + '), set(), {"limit"}),
    (
        behind('is Lidar("/front")\n', '  component X { outgoing message m with identifier: "/sp|"'),
        {"/drive", "/speed"},
        {"limit"},
    ),
    (behind("import Motors", ' with { drive: "|" }'), {"/drive", "/speed"}, {"limit"}),
    (behind("provide reach with ", '{ x: "|" } '), set(), {"/drive"}),
    (CHOICE + "then { |", {"forward", "turn"}, {"home"}),
    (CHOICE + "then { forward: 1.0 } else { |", {"forward", "turn"}, {"home"}),
    (behind("robot Cart {\n", "  // |\n"), set(), {"component"}),
    (behind("robot Cart {\n", "  provide |\n"), {"feedback"}, set()),
    (behind("robot Cart {\n", "  component X { outgoing | }\n"), {"message", "service", "action"}, set()),
    (
        behind(
            "robot Cart {\n",
            "  component X { outgoing service start with request: none, response: none }\n  requirement |\n",
        ),
        {"start"},
        set(),
    ),
]


@pytest.mark.parametrize(("text", "there", "absent"), CASES, ids=range(len(CASES)))
def test_what_is_proposed(project: Project, text: str, there: set[str], absent: set[str]) -> None:
    found = set(complete(project, text))
    assert there - found == set()
    assert absent & found == set()


def test_the_word_is_replaced(project: Project) -> None:
    text = behind("state free { ", "on response from distance goto blo|x")
    item = complete(project, text)["blocked"]
    assert (item.kind, item.detail) == (types.CompletionItemKind.EnumMember, "state")
    assert edited(text.replace("|", ""), [item.text_edit]) == behind(
        "state free { ", "on response from distance goto blocked"
    )


@pytest.mark.parametrize("word", SNIPPETS)
def test_snippets_are_models(word: str) -> None:
    """With their default placeholders they parse in each place for their word."""
    around = {
        "robot": "{}",
        "library": "{}",
        "behaviour": "robot R {{ component C {{ {} }} }}",
        "state": "robot R {{ component C {{ behaviour {{ {} }} }} }}",
        "on": "robot R {{ component C {{ behaviour {{ state s {{ {} }} }} }} }}",
    }
    for _, body, _ in SNIPPETS[word]:
        filled = re.sub(r"\$\{\d+:([^}]*)\}", r"\1", body).replace("$0", "")
        text = around.get(word, "robot R {{ {} }}").format(filled)
        reading = read("/nowhere/snippet.rscd", documents=Documents({"/nowhere/snippet.rscd": text}))
        assert [finding for finding in reading.findings if finding.rule == "syntax"] == [], text


@pytest.mark.parametrize(
    ("text", "label", "active"),
    [
        (behind("provide reach with ", "gain(|"), "gain(d: double, factor: double): double", 0),
        (behind("provide reach with ", "gain(abs(1.0), |"), "gain(d: double, factor: double): double", 1),
        (behind("provide reach with ", "gain(1.0, max(1.0, |"), "max(a, b)", 1),
        (behind('Lidar("/front"', "|"), "Lidar(ns: string)", 0),
        (behind("type: View(", "near: |"), "View(near: double)", 0),
        (behind("type: View(0.5)", "|"), None, None),
    ],
)
def test_signatures(project: Project, text: str, label: str | None, active: int | None) -> None:
    offset, content = text.index("|"), text.replace("|", "")
    path = project.put("file:///nowhere/cart.rscd", 1, content)
    position = types.Position(*Text("", content).to_utf16(offset))
    asked = types.SignatureHelpParams(types.TextDocumentIdentifier("file:///nowhere/cart.rscd"), position)
    snapshot = project.snapshot()
    found = signature_help(snapshot, snapshot.analysis(path), asked)
    assert (found and found.signatures[0].label, found and found.active_parameter) == (label, active)


FAILING = """robot C {{
  component A {{
    service home with request: none, response: none
    behaviour {{
      variable why: {type}
      initial marked state s {{ on request to home on error from home if {guard} }}
    }}
  }}
  requirement home needs {condition}
}}"""


def failing(type: str = "Failure", guard: str = "true", condition: str = "true") -> str:  # noqa: A002
    return FAILING.format(type=type, guard=guard, condition=condition)


def test_reasons_are_proposed_where_the_text_expects_one(project: Project) -> None:
    """Completion offers the service's reasons, and none in other places."""
    assert "Failure" in complete(project, failing(type="|"))
    for guard in ("error = |", "why != |", "lost = error and error = |"):
        found = complete(project, failing(guard=guard))
        assert {"unavailable", "timeout", "unreadable", "failed"} <= set(found)
        assert not {"lost", "rejected"} & set(found)
    assert {"lost", "failed"} <= set(complete(project, failing(guard="error = Failure.|")))
    assert "error" in complete(project, failing(guard="|"))
    assert not {"timeout", "lost"} & set(complete(project, failing(condition="|")))
