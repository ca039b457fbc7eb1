"""A model is data: no text of a model or of its configuration gets out of its place in anything that is generated.

Each hostile text carries a mark. After strings and comments are taken away, the mark must be gone, too; and what has a
parser must parse. A target may also refuse the text, with a located error.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree as ET

import pytest

import robosc
from robosc.configuration import Configuration
from robosc.m2t.models import Models
from robosc.metamodel import expression as ex
from robosc.metamodel.reflection import tree

pytestmark = pytest.mark.slow

MARK = "PWNED"
HOSTILE = [
    f'"; {MARK}(); "',
    f"'; {MARK}(); '",
    f'\\"; {MARK}(); //',
    f"*/ {MARK}(); /*",
    f"// \\\n{MARK}();",
    f"\n{MARK}();\n",
    f"\r{MARK}();\r",
    f'??/" {MARK}(); ??/',
    f')json"; {MARK}(); R"json(',
    f"</description><{MARK}/>",
    f"]]><{MARK}/>",
    f'${{{MARK}}} ") {MARK}() message("',
    f"]=] {MARK}() [=[",
    f"{{{{ {MARK} }}}} {{% {MARK} %}}",
    f"$(eval {MARK})",
    f"../../{MARK}",
    f"/{MARK}",
    f"\\u000a{MARK}();",
    f"\u2028{MARK}();\u202e",
]
MODEL = """
robot Robot {
  component Part {
    outgoing message heard with identifier: "/heard", type: string
    incoming message said with identifier: "/said", type: string
    service asked with identifier: "/asked", request: none, response: none
    behaviour {
      variable last: string = "initial"
      initial marked state here { on response from heard do last := value }
    }
  }
  requirement said needs Part.here
  provide said with "provided" if Part.here
}
"""
TARGETS = ("cif", "supervisor", "ros1", "ros2", "ros1-layer", "ros2-layer")

#: How the configuration starts a controller behind a supervisory layer.
RUN = {"packageName": "drive", "executable": "drive", "name": "drive", "namespace": "left"}
LAUNCH = {"packageName": "drive", "file": "drive.launch"}


def quoted(text: str) -> str:
    """A string literal of the language."""
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r"}
    return '"' + "".join(escapes.get(each, each) for each in text) + '"'


@pytest.fixture(scope="module")
def harmless(tmp_path_factory: pytest.TempPathFactory) -> Models:
    models = models_of(MODEL, tmp_path_factory.mktemp("harmless"))
    assert models is not None
    return models


def generated(
    models: Models, configuration: Configuration | None = None, targets: Sequence[str] = TARGETS
) -> Iterator[tuple[str, str]]:
    """Every file that a target makes of the models, unless it refuses them with located findings."""
    for target in targets:
        try:
            files = robosc.generate(target, models, configuration=configuration)
        except robosc.ModelError as error:
            findings, files = error.diagnostics, {}
        else:
            findings = []
        assert files or findings
        assert all(each.span.line >= 1 and each.message for each in findings)
        yield from files.items()


def models_of(text: str, folder: Path) -> Models | None:
    """The models of a text; None where reading or checking it finds errors."""
    path = folder / "robot.rscd"
    path.write_text(text, encoding="utf-8")
    try:
        robot = robosc.load(path)
    except robosc.ModelError:
        return None
    assert not any(each.severity == "error" for each in robosc.check(robot))
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)


def bare(path: str, text: str) -> str:
    """What is left of a file without its strings and comments."""
    kind = PurePosixPath(path).suffix
    if kind in {".c", ".h", ".hpp", ".cpp"}:
        literals = r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|/\*.*?\*/|//[^\n]*'
        assert "\\\n" not in re.sub(r"#define.*", "", text), "a line that goes on could take a comment with it"
        return re.sub(literals, "", text, flags=re.DOTALL)
    if kind == ".cif":
        return re.sub(r'"(?:\\.|[^"\\\n])*"|/\*.*?\*/|//[^\n]*', "", text, flags=re.DOTALL)
    if kind == ".txt":
        return re.sub(r'"(?:\\.|[^"\\])*"|#[^\n]*', "", text, flags=re.DOTALL)
    if kind == ".yaml":
        # A parameter of a topic has its name.
        return re.sub(r'"(?:\\.|[^"\\\n])*"|#[^\n]*|^ +\w+(?=: \d+$)', "", text, flags=re.MULTILINE)
    if kind == ".py":
        tree_of_it = ast.parse(text)
        return " ".join(each.id for each in ast.walk(tree_of_it) if isinstance(each, ast.Name))
    if kind in {".xml", ".launch"}:
        root = ET.fromstring(text)  # noqa: S314 - the text is ours
        return " ".join(each.tag for each in root.iter())
    return text


def assert_contained(files: Iterator[tuple[str, str]]) -> int:
    count = 0
    for path, text in files:
        parts = PurePosixPath(path).parts
        assert not PurePosixPath(path).is_absolute()
        assert ".." not in parts
        assert re.fullmatch(r"[\w./-]+", path)
        # A harmless topic like `/PWNED` may well be part of an identifier.
        assert not re.search(rf"\b{MARK}\b", bare(path, text)), path
        count += 1
    return count


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("place", ['"provided"', '"initial"', '"/heard"', '"/said"', '"/asked"'])
def test_texts_of_a_model(place: str, text: str, tmp_path: Path) -> None:
    models = models_of(MODEL.replace(place, quoted(text)), tmp_path)
    if models is not None:
        assert assert_contained(generated(models)) > 0


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("key", ["description", "maintainer", "license", "name", "version", "email"])
def test_texts_of_the_configuration(key: str, text: str, tmp_path: Path) -> None:
    models = models_of(MODEL, tmp_path)
    assert models is not None
    try:
        configuration = Configuration.model_validate({"package": {key: text}})
    except ValueError:
        return  # Refused where it is read.
    assert_contained(generated(models, configuration))


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize(("form", "key"), [*(("run", each) for each in RUN), *(("launch", each) for each in LAUNCH)])
def test_how_an_existing_controller_is_started(form: str, key: str, text: str, harmless: Models) -> None:
    started = {**(RUN if form == "run" else LAUNCH), key: text}
    settings = {"supervisor": {"controller": {form: started}}}
    assert_contained(generated(harmless, Configuration.model_validate(settings), TARGETS[-2:]))


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("part", ["model", "graph", "elements of the graph"])
def test_names_that_no_text_could_have(part: str, text: str, tmp_path: Path) -> None:
    """A saved model may come from anywhere, with any name on anything: on all at once that targets refuse alike."""
    models = models_of(MODEL, tmp_path)
    assert models is not None
    assert models.rosgraph is not None
    elements = {
        "model": [each for _, each in tree(models.sct)],
        "graph": [models.rosgraph],
        "elements of the graph": [each for _, each in tree(models.rosgraph)][1:],
    }[part]
    hostile = [element for element in elements if isinstance(element, ex.NamedElement)]
    for number, element in enumerate(hostile):
        element.name = f"{text}{number}"
    contained = assert_contained(generated(models))
    assert contained > 0
