"""Read XMI files: models round-trip, and each fault in a file is reported with its position."""

import os
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.base.diagnostics import Diagnostic, ModelError
from robosc.base.diagnostics.rules import page
from robosc.base.files.resources import locate
from robosc.model.validity import load
from robosc.model.xmi import to_texts
from tests.searching import examples

HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<sct:SupervisoryControlModel xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" '
    'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:expression="urn:robosc:expression:1" '
    'xmlns:sct="urn:robosc:sct:1" name="robot">\n'
)
PLANT = """\
<plants name="p" kind="message">
  <events name="u_response" controllable="false" kind="response" inputs="//@plants.0/@inputs.0"/>
  <inputs name="i"><type xsi:type="expression:BooleanType"/></inputs>
  <locations name="ready" initial="true" marked="true">
    <edges event="//@plants.0/@events.0" target="//@plants.0/@locations.0"/>
  </locations>
</plants>
"""
TAIL = "</sct:SupervisoryControlModel>\n"


def findings(path: Path) -> list[Diagnostic]:
    with pytest.raises(ModelError) as raised:
        load(path)
    return raised.value.diagnostics


def shown(path: Path) -> list[str]:
    """Return the findings as `line:column: message`."""
    return [f"{finding.span.line}:{finding.span.column}: {finding.message}" for finding in findings(path)]


@pytest.fixture
def write(tmp_path: Path) -> Any:
    """Write a file with a text and return its path."""

    def written(text: str | bytes, name: str = "robot.sct.xmi") -> Path:
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return written


def test_saved_loaded_and_saved_again_is_the_same(folder: Path, texts: dict[str, str]) -> None:
    sct = load(folder / "Warehouse.sct.xmi")
    assert to_texts({"Warehouse.sct.xmi": sct})["Warehouse.sct.xmi"] == texts["Warehouse.sct.xmi"]
    graph = load(folder / "Warehouse.rosgraph.xmi")
    again = to_texts({"Warehouse.rosgraph.xmi": graph, "Warehouse.sct.xmi": graph.model})
    assert again == {name: texts[name] for name in again}
    robot = load(folder / "Warehouse.robosc.xmi")
    library = next(
        definition.type.library for definition in robot.definitions if getattr(definition, "name", "") == "Rear"
    )
    again = to_texts({"Warehouse.robosc.xmi": robot, "EmergencyStopLibrary.robosc.xmi": library})
    assert again == {name: texts[name] for name in again}


def test_files_are_named_as_the_user_names_them(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (folder / "Warehouse.sct.xmi").read_text()
    (folder / "Warehouse.sct.xmi").write_text(text.replace('kind="action"', 'kind="acton"'))
    monkeypatch.chdir(folder.parent)
    [finding] = findings(Path(folder.name) / "Warehouse.rosgraph.xmi")
    assert finding.file == f"{folder.name}/Warehouse.sct.xmi"
    assert (
        finding.hint
        == "one of message, service, action, behaviour, data, requirement, assumption, serviceServer, actionServer"
    )


def test_what_emf_leaves_out_has_its_default(write: Any) -> None:
    plant = load(write(HEAD + PLANT.replace(' kind="message"', "").replace(' controllable="false"', "") + TAIL)).plants[
        0
    ]
    assert (str(plant.kind), plant.events[0].controllable) == ("message", False)


def test_an_attribute_may_be_an_element(write: Any) -> None:
    text = PLANT.replace('name="p" kind="message">', 'kind="message"><name>p</name>')
    assert load(write(HEAD + text + TAIL)).plants[0].name == "p"


DAMAGES = [
    ('kind="message"', 'kind="massage"', ["3:18: 'kind' cannot be 'massage'"]),
    ('initial="true"', 'initial="yes"', ["6:27: 'initial' cannot be 'yes'"]),
    ('name="p"', 'nam="p"', ["3:1: a Plant needs 'name'", "3:9: a Plant has no attribute 'nam'"]),
    ('name="p"', 'name="p q"', ["3:1: 'name' must be an identifier, found 'p q'"]),
    ('name="p"', 'name="p"\n  locations="x"', ["4:3: a Plant has no attribute 'locations'"]),
    (
        '<inputs name="i"><type xsi:type="expression:BooleanType"/></inputs>',
        "",
        ["4:66: 'inputs' refers to '//@plants.0/@inputs.0', which does not exist"],
    ),
    (
        "expression:BooleanType",
        "expression:Bool",
        ["5:26: unknown class 'expression:Bool'"],
    ),
    ("expression:BooleanType", "expression:Type", ["5:20: Type is abstract"]),
    ("expression:BooleanType", "sct:Plant", ["5:20: 'type' expects a Type, found a Plant"]),
    ("expression:BooleanType", "sct:PlantKind", ["5:26: unknown class 'sct:PlantKind'"]),
    ("expression:BooleanType", "other:Type", ["5:26: unknown class 'other:Type'"]),
    ("expression:BooleanType", "expression:DoubleType", ["5:3: DoubleType is not allowed in an sct model"]),
    (
        "expression:BooleanType",
        'expression:IntegerType" minimum="9223372036854775808" maximum="x',
        ["5:60: 'minimum' cannot be '9223372036854775808'", "5:90: 'maximum' cannot be 'x'"],
    ),
    (
        'target="//@plants.0/@locations.0"',
        'target="//@plants.0/@events.0"',
        ["7:42: 'target' refers to an Event, expected a Location"],
    ),
    ('target="//@plants.0/@locations.0"', 'target="_abc"', ["7:42: 'target' refers to '_abc', which does not exist"]),
    (
        'target="//@plants.0/@locations.0"',
        'target="//@plants.0/@locations.99999999999999999999999"',
        ["7:42: 'target' refers to '//@plants.0/@locations.99999999999999999999999', which does not exist"],
    ),
    ('target="//@plants.0/@locations.0"', 'target="/ /"', ["7:42: 'target' refers to one element"]),
    ('target="//@plants.0/@locations.0"', "", ["7:5: an Edge needs 'target'"]),
    ('.0/@inputs.0"', '.0/@inputs.0 //@plants.0/@inputs.0"', ["4:66: 'inputs' names '//@plants.0/@inputs.0' twice"]),
    ("</locations>", "stray</locations>", ["6:3: a Location cannot have text"]),
    (
        "</plants>",
        "<name>q</name><name>r</name></plants>",
        ["9:1: a Plant has only one 'name'", "9:15: a Plant has only one 'name'"],
    ),
    ("</plants>", "<foo/></plants>", ["9:1: a Plant has no 'foo'"]),
    (
        "<locations",
        '<locations name="other" initial="true" marked="true"/><locations',
        ["3:1: plant 'p' has 2 initial locations, expected exactly one"],
    ),
]


@pytest.mark.parametrize(("old", "new", "wanted"), DAMAGES)
def test_damage_is_located(write: Any, old: str, new: str, wanted: list[str]) -> None:
    assert old in PLANT
    path = write(HEAD + PLANT.replace(old, new, 1) + TAIL)
    assert shown(path) == wanted
    assert {finding.rule for finding in findings(path)} == {"xmi"}


def test_all_findings_come_at_once(write: Any) -> None:
    text = (
        PLANT.replace('kind="message"', 'kind="m"')
        .replace('initial="true"', 'initial="1"')
        .replace("events.0", "events.1")
    )
    assert [finding.span.line for finding in findings(write(HEAD + text + text + TAIL))] == [3, 6, 7, 10, 13, 14]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "1:1: this is not well-formed XML: no element found"),
        ("robot R {}", "1:1: this is not well-formed XML: syntax error"),
        (HEAD + PLANT, "10:1: this is not well-formed XML: no element found"),
        (HEAD + "<plants name=p/>" + TAIL, "3:14: this is not well-formed XML: not well-formed (invalid token)"),
        (HEAD + "<plants></plant>" + TAIL, "3:11: this is not well-formed XML: mismatched tag"),
        (HEAD + "<x:plants/>" + TAIL, "3:1: this is not well-formed XML: unbound prefix"),
        (HEAD.encode() + b"<!-- \xff -->", "3:6: this is not text in UTF-8"),
        ("ü".encode("utf-16"), "1:1: this is not text in UTF-8"),
        (bytes(range(128)), "1:1: this is not well-formed XML: not well-formed (invalid token)"),
        (HEAD + "<!-- ü --> \0", "3:12: this is not well-formed XML: not well-formed (invalid token)"),
    ],
)
def test_no_xml(write: Any, text: str | bytes, message: str) -> None:
    path = write(text)
    assert shown(path) == [message]
    assert findings(path)[0].rule == "syntax"


@pytest.mark.parametrize(
    "doctype",
    [
        "<!DOCTYPE r>",
        '<!DOCTYPE r SYSTEM "http://localhost:1/x.dtd">',
        '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;">]>',
        '<!DOCTYPE r [<!ENTITY % p SYSTEM "http://localhost:1/p"> %p;]>',
    ],
)
def test_document_types_and_entities_are_refused(write: Any, doctype: str) -> None:
    head, rest = HEAD.split("\n", 1)
    [found] = shown(write(f"{head}\n{doctype}\n{rest}<plants name='&c;'/>{TAIL}"))
    assert found.endswith("a document type declaration is not allowed in a model")
    assert found.startswith("2:")


def test_nesting_is_bounded(write: Any) -> None:
    [finding] = findings(write(HEAD + "<plants>" * 200_000))
    assert (finding.rule, finding.message) == ("syntax", "more than 6000 elements are inside each other")


FOREIGN = [
    ("<sct:Plant xmlns:sct='urn:robosc:sct:1'/>", "a Plant cannot be the root of a file"),
    ("<sct:Nothing xmlns:sct='urn:robosc:sct:1'/>", "a Nothing cannot be the root of a file"),
    ("<e:BooleanLiteral xmlns:e='urn:robosc:expression:1'/>", "a BooleanLiteral cannot be the root of a file"),
    (
        "<x:Robot xmlns:x='http://example.org/robot'/>",
        "no model of RoboSC has the namespace 'http://example.org/robot'",
    ),
    (
        "<sct:SupervisoryControlModel xmlns:sct='urn:robosc:sct:2'/>",
        "no model of RoboSC has the namespace 'urn:robosc:sct:2'",
    ),
    ("<html/>", "no model of RoboSC has the namespace ''"),
    ("<xmi:XMI xmlns:xmi='http://www.omg.org/XMI'/>", "this file has several models, expected one"),
]


@pytest.mark.parametrize(("text", "message"), FOREIGN)
def test_foreign_files(write: Any, text: str, message: str) -> None:
    assert shown(write(text)) == [f"1:1: {message}"]


@pytest.mark.parametrize("name", ["expression", "robosc", "sct", "rosgraph", "engine"])
def test_a_metamodel_is_no_model(name: str) -> None:
    assert shown(locate(f"metamodel/{name}.ecore")) == ["2:1: this is a metamodel (Ecore), not a model"]


def test_what_cannot_be_read(tmp_path: Path) -> None:
    assert shown(tmp_path / "none.xmi") == ["1:1: the file cannot be read: No such file or directory"]
    assert shown(tmp_path) == ["1:1: the file cannot be read: Is a directory"]


OUTSIDE = [
    "../outside.sct.xmi",
    "%2e%2e/outside.sct.xmi",
    "http://localhost:1/outside.sct.xmi",
    "HTTP://localhost:1/outside.sct.xmi",
    "file:../outside.sct.xmi",
    "//localhost/outside.sct.xmi",
    "/etc/passwd",
    "..\\outside.sct.xmi",
    "link.sct.xmi",
    "a%00b",
]


@pytest.mark.parametrize("href", OUTSIDE)
def test_nothing_outside_the_folder_is_read(folder: Path, texts: dict[str, str], href: str) -> None:
    home = folder / "home"
    home.mkdir()
    (folder / "outside.sct.xmi").write_text(texts["Warehouse.sct.xmi"])
    (home / "link.sct.xmi").symlink_to(folder / "outside.sct.xmi")
    path = home / "graph.xmi"
    path.write_text(texts["Warehouse.rosgraph.xmi"].replace("Warehouse.sct.xmi", href))
    [finding] = findings(path)
    assert finding.message.endswith("is not in the folder of this model or below; other files are not read")


def test_what_is_referred_to_must_be_a_file(folder: Path) -> None:
    (folder / "Warehouse.sct.xmi").unlink()
    assert [finding.message for finding in findings(folder / "Warehouse.rosgraph.xmi")] == [
        "the file 'Warehouse.sct.xmi' does not exist"
    ]
    os.mkfifo(folder / "Warehouse.sct.xmi")
    assert len(findings(folder / "Warehouse.rosgraph.xmi")) == 1


def test_a_file_of_another_model_is_found_out(folder: Path, texts: dict[str, str]) -> None:
    (folder / "Warehouse.sct.xmi").write_text(texts["EmergencyStopLibrary.robosc.xmi"])
    messages = {finding.message for finding in findings(folder / "Warehouse.rosgraph.xmi")}
    assert "'model' refers to a Library, expected a SupervisoryControlModel" in messages


def test_files_may_refer_to_each_other_in_a_circle(folder: Path, texts: dict[str, str]) -> None:
    text = texts["EmergencyStopLibrary.robosc.xmi"]
    imported = (
        '  <definitions xsi:type="robosc:Component" name="C"><type xsi:type="robosc:ImportedComponent">'
        '<library href="EmergencyStopLibrary.robosc.xmi#/"/><definition href="#//@definitions.0"/></type></definitions>'
    )
    (folder / "EmergencyStopLibrary.robosc.xmi").write_text(
        text.replace("</robosc:Library>", f"{imported}</robosc:Library>")
    )
    library = load(folder / "EmergencyStopLibrary.robosc.xmi")
    assert library.definitions[-1].type.library is library
    assert library.definitions[-1].type.definition is library.definitions[0]


@pytest.mark.parametrize("name", ["Warehouse.sct.xmi", "Warehouse.rosgraph.xmi", "EmergencyStopLibrary.robosc.xmi"])
def test_a_truncated_file_is_a_finding(folder: Path, texts: dict[str, str], name: str) -> None:
    data = texts[name].encode().rstrip()
    for end in range(0, len(data), max(1, len(data) // 60)):
        (folder / name).write_bytes(data[:end])
        assert [finding.rule for finding in findings(folder / name)] == ["syntax"]


@pytest.mark.slow
@settings(max_examples=examples(75), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_damage_makes_anything_but_findings(folder: Path, texts: dict[str, str], data: st.DataObject) -> None:
    """Swap words of the file: the result is a model or findings inside the files."""
    name = data.draw(st.sampled_from(["Warehouse.sct.xmi", "Warehouse.rosgraph.xmi", "Warehouse.robosc.xmi"]))
    words = texts[name].split('"')
    for _ in range(data.draw(st.integers(1, 4))):
        first, second = (data.draw(st.integers(0, len(words) - 1)) for _ in range(2))
        words[first] = words[second]
    (folder / name).write_text('"'.join(words))
    try:
        load(folder / name)
    except ModelError as error:
        for diagnostic in error.diagnostics:
            lines = Path(diagnostic.file).read_text().split("\n")
            assert 1 <= diagnostic.span.column <= len(lines[diagnostic.span.line - 1]) + 1
    (folder / name).write_text(texts[name])


@pytest.mark.parametrize(("heading", "rules"), [("Wrong", ["xmi", "xmi"]), ("Right", [])])
def test_the_page_of_the_rule(write: Any, heading: str, rules: list[str]) -> None:
    text = page("xmi")
    assert text is not None
    example = re.search(rf"^## {heading}\n\n```xml\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)
    assert example
    path = write(example.group(1))
    if rules:
        assert [finding.rule for finding in findings(path)] == rules
    else:
        assert load(path).name == "Lamp"
