"""The target `xmi`: its files, and that reading them gives the same files again."""

from pathlib import Path

from robosc.language.configuration import Configuration
from robosc.language.reading import read
from robosc.m2m import robosc_to_rosgraph, robosc_to_sct
from robosc.m2t import xmi
from robosc.m2t.models import Models
from robosc.model.validity import load

LIBRARY = """
library {name} {{
  {imported}
  component {name}Part {{
    outgoing message {name}_seen with type: none
    behaviour {{ initial marked state idle {{ on response from {name}_seen goto idle }} }}
  }}
}}
"""
ROBOT = """
robot Walker {
  component Leg from Walker import WalkerPart
  component Eye from Deep import DeepPart
  component Ear from Deep import DeepPart
}
"""


def models(folder: Path) -> Models:
    (folder / "library.rscd").write_text(
        LIBRARY.format(name="Walker", imported="component D from Deep import DeepPart")
    )
    (folder / "deep.rscd").write_text(LIBRARY.format(name="Deep", imported=""))
    (folder / "robot.rscd").write_text(ROBOT)
    reading = read(folder / "robot.rscd")
    assert reading.findings == []
    model, trace = robosc_to_sct.transform(reading.base)
    return Models(model, robosc_to_rosgraph.transform(trace), reading.base)


def test_every_model_has_its_file(tmp_path: Path) -> None:
    given = models(tmp_path)
    texts = xmi.generate(given, Configuration())
    assert xmi.preconditions(given, Configuration()) == []
    assert list(texts) == [
        "Walker.sct.xmi",
        "Walker.rosgraph.xmi",
        "Walker.robosc.xmi",
        "Walker_.robosc.xmi",  # the library with the robot's name
        "Deep.robosc.xmi",
    ]


def test_models_without_a_robot_or_a_graph_are_saved_without_them(tmp_path: Path) -> None:
    given = models(tmp_path)
    assert list(xmi.generate(Models(given.sct), Configuration())) == ["Walker.sct.xmi"]


def test_loaded_models_give_the_same_files(tmp_path: Path) -> None:
    texts = xmi.generate(models(tmp_path), Configuration())
    for name, text in texts.items():
        (tmp_path / name).write_bytes(text.encode())
    graph = load(tmp_path / "Walker.rosgraph.xmi")
    again = Models(graph.model, graph, load(tmp_path / "Walker.robosc.xmi"))
    assert xmi.generate(again, Configuration()) == texts


SERVED = """
robot Walker {
  interface ordering use AddTwoInts from example_interfaces
  interface inspection use Fibonacci from example_interfaces
  datatype object Order { a: integer(0..9) }
  datatype object Answer { sum: integer }
  component Desk {
    outgoing service start with request: Order, response: Answer links ordering
    outgoing action inspect with request: none, response: none, feedback: Progress links inspection
    behaviour {
      initial marked state idle {
        on request from start
        on response to start
        on request from inspect goto busy
      }
      marked state busy {
        on feedback to inspect
        on canceled to inspect goto idle
        on response to inspect goto idle
      }
    }
  }
  datatype object Progress { sequence: array(integer) }
  provide start with { sum: 3 }
  provide feedback to inspect with { sequence: [4] }
}
"""


def test_served_communications_are_saved(tmp_path: Path) -> None:
    (tmp_path / "robot.rscd").write_text(SERVED)
    reading = read(tmp_path / "robot.rscd")
    assert reading.findings == []
    model, trace = robosc_to_sct.transform(reading.base)
    texts = xmi.generate(Models(model, robosc_to_rosgraph.transform(trace), reading.base), Configuration())
    for name, text in texts.items():
        (tmp_path / name).write_bytes(text.encode())
    graph, base = load(tmp_path / "Walker.rosgraph.xmi"), load(tmp_path / "Walker.robosc.xmi")
    assert xmi.generate(Models(graph.model, graph, base), Configuration()) == texts
    (start,), (inspect,) = graph.serviceServers, graph.actionServers
    assert (start.response.name, inspect.error, inspect.cancel.name) == ("start", None, "u_cancel")
    assert [statement.feedback for statement in base.definitions[-2:]] == [False, True]
