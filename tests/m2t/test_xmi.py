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
