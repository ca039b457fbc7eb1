"""A model is data: its texts and those of its configuration stay in their places in all generated files.

Each hostile text has a mark. The mark must disappear with the strings and comments, and each file with a parser must
parse. A target may also reject the text, with a located error.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree as ET

import pytest

import robosc
from robosc.language.configuration import Configuration
from robosc.m2t.models import Models
from robosc.model import expression as ex
from robosc.model.reflection import tree

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
#: All texts together: each that leaves its place exposes its own mark.
TOGETHER = " ".join(HOSTILE)
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
PLACES = ('"/heard"', '"/said"', '"/asked"')
TARGETS = ("cif", "supervisor", "ros1", "ros2", "ros2-layer")

#: The configuration's ways to start a controller behind a supervisory layer.
RUN = {"packageName": "drive", "executable": "drive", "name": "drive", "namespace": "left"}
LAUNCH = {"packageName": "drive", "file": "drive.launch"}


def quoted(text: str) -> str:
    """Return a string literal of the language."""
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r"}
    return '"' + "".join(escapes.get(character, character) for character in text) + '"'


@pytest.fixture(scope="module")
def harmless(tmp_path_factory: pytest.TempPathFactory) -> Models:
    models = models_of(MODEL, tmp_path_factory.mktemp("harmless"))
    assert models is not None
    return models


def generated(
    models: Models, configuration: Configuration | None = None, targets: Sequence[str] = TARGETS
) -> Iterator[tuple[str, str]]:
    """Yield every file that a target generates, unless it rejects the models with located findings."""
    for target in targets:
        try:
            files = robosc.generate(target, models, configuration=configuration)
        except robosc.ModelError as error:
            findings, files = error.diagnostics, {}
        else:
            findings = []
        assert files or findings
        assert all(finding.span.line >= 1 and finding.message for finding in findings)
        yield from files.items()


def models_of(text: str, folder: Path) -> Models | None:
    """Return the models of a text; None if reading or checking it reports errors."""
    path = folder / "robot.rscd"
    path.write_text(text, encoding="utf-8")
    try:
        robot = robosc.load(path)
    except robosc.ModelError:
        return None
    assert not any(finding.severity == "error" for finding in robosc.check(robot))
    plants = robosc.to_sct(robot)
    robosc.synthesize(plants)
    return Models(plants, robosc.to_rosgraph(robot), robot)


def bare(path: str, text: str) -> str:
    """Return a file's text without its strings and comments."""
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
        # A topic's parameter has the topic's name.
        return re.sub(r'"(?:\\.|[^"\\\n])*"|#[^\n]*|^ +\w+(?=: \d+(?:  #|$))', "", text, flags=re.MULTILINE)
    if kind == ".md":
        # Markdown is prose: only a tag or a link would be more than text.
        return " ".join(re.findall(r"<[^>]*>|\]\([^)]*\)", text))
    if kind == ".py":
        tree_of_it = ast.parse(text)
        return " ".join(node.id for node in ast.walk(tree_of_it) if isinstance(node, ast.Name))
    if kind in {".xml", ".launch"}:
        root = ET.fromstring(text)  # noqa: S314 - the text is ours
        return " ".join(element.tag for element in root.iter())
    return text


def assert_contained(files: Iterator[tuple[str, str]]) -> int:
    count = 0
    for path, text in files:
        parts = PurePosixPath(path).parts
        assert not PurePosixPath(path).is_absolute()
        assert ".." not in parts
        assert re.fullmatch(r"[\w./-]+", path)
        # A harmless topic such as `/PWNED` may be part of an identifier.
        assert not re.search(rf"\b{MARK}\b", bare(path, text)), path
        count += 1
    return count


def test_values_of_a_model(tmp_path: Path) -> None:
    variables = "\n".join(f"      variable kept{n}: string = {quoted(text)}" for n, text in enumerate(HOSTILE))
    messages = "\n".join(
        f'    incoming message said{n} with identifier: "/said{n}", type: string' for n in range(len(HOSTILE))
    )
    provided = "\n".join(
        f"  requirement said{n} needs Part.here\n  provide said{n} with {quoted(text)} if Part.here"
        for n, text in enumerate(HOSTILE)
    )
    model = MODEL.replace("    behaviour {\n", f"{messages}\n    behaviour {{\n{variables}\n")
    models = models_of(model.replace("  provide", f"{provided}\n  provide"), tmp_path)
    assert models is not None
    for target in TARGETS:
        assert assert_contained(generated(models, targets=[target])) > 0, f"{target} refuses them"


def test_topics_of_a_model(tmp_path: Path) -> None:
    """The ROS targets reject all of them, each at its position; other targets keep them as texts."""
    declarations = [line for line in MODEL.splitlines() if any(place in line for place in PLACES)]
    more = [
        re.sub(r'(heard|said|asked)( with identifier: )".*?"', rf"\g<1>{n}\g<2>@", line).replace("@", quoted(text))
        for n, text in enumerate(HOSTILE)
        for line in declarations
    ]
    assert len(more) == len(HOSTILE) * len(PLACES)
    model = MODEL.replace("    behaviour {", "\n".join([*more, "    behaviour {"]))
    models = models_of(model, tmp_path)
    assert models is not None
    for target in TARGETS[:2]:
        assert assert_contained(generated(models, targets=[target])) > 0, f"{target} refuses them"
    lines = {n for n, line in enumerate(model.splitlines(), 1) if line in more and f'"/{MARK}"' not in line}
    for target in TARGETS[2:]:
        with pytest.raises(robosc.ModelError) as refused:
            robosc.generate(target, models)
        assert lines <= {finding.span.line for finding in refused.value.diagnostics}


@pytest.mark.parametrize("place", PLACES)
def test_a_topic_that_ros_takes(place: str, tmp_path: Path) -> None:
    models = models_of(MODEL.replace(place, f'"/{MARK}"'), tmp_path)
    assert models is not None
    for target in TARGETS:
        assert assert_contained(generated(models, targets=[target])) > 0, f"{target} refuses it"


@pytest.mark.parametrize("key", ["description", "maintainer", "license", "name", "version", "email"])
def test_texts_of_the_configuration(key: str, harmless: Models) -> None:
    def taken(*texts: str) -> bool:
        """Return whether both the configuration and the target accept the texts."""
        try:
            configuration = Configuration.model_validate({"package": {key: " ".join(texts)}})
            robosc.generate("ros2-layer", harmless, configuration=configuration)
        except (ValueError, robosc.ModelError):
            return False
        return True

    texts = HOSTILE if taken(*HOSTILE) else [text for text in HOSTILE if taken(text)]
    assert bool(texts) == (key in ("description", "maintainer", "license"))
    if texts:
        configuration = Configuration.model_validate({"package": {key: " ".join(texts)}})
        for target in TARGETS[2:]:
            assert assert_contained(generated(harmless, configuration, [target])) > 0


@pytest.mark.parametrize(("form", "key"), [*(("run", key) for key in RUN), *(("launch", key) for key in LAUNCH)])
def test_how_an_existing_controller_is_started(form: str, key: str, harmless: Models) -> None:
    for text in HOSTILE:
        started = {**(RUN if form == "run" else LAUNCH), key: text}
        configuration = Configuration.model_validate({"supervisor": {"controller": {form: started}}})
        contained = assert_contained(generated(harmless, configuration, ["ros2-layer"]))
        assert (contained > 0) == (key == "namespace" and text == f"/{MARK}")


@pytest.mark.parametrize("part", ["model", "graph", "elements of the graph"])
def test_names_that_no_text_could_have(part: str, tmp_path: Path) -> None:
    """A saved model from any source may have any name on any element.

    Elements that targets reject alike are changed at once.
    """
    models = models_of(MODEL, tmp_path)
    assert models is not None
    assert models.rosgraph is not None
    elements = {
        "model": [element for _, element in tree(models.sct)],
        "graph": [models.rosgraph],
        "elements of the graph": [element for _, element in tree(models.rosgraph)][1:],
    }[part]
    hostile = [element for element in elements if isinstance(element, ex.NamedElement)]
    for number, element in enumerate(hostile):
        element.name = f"{TOGETHER}{number}"
    assert assert_contained(generated(models)) > 0
