"""The report agrees with `verify`, the generated code and the tests, by independent measurements."""

import json
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import pytest
from click.testing import CliRunner
from jsonschema import Draft202012Validator

from robosc.engine import Engine
from robosc.language.configuration import Configuration, find, read
from robosc.m2t import supervisor
from robosc.m2t.c.names import CNames
from robosc.m2t.models import TraceTest
from robosc.run.report import as_html, as_needs, digests
from robosc.run.simulation import Simulation
from robosc.run.simulation.script import read_script
from robosc.tools.cli import main, safety_report
from tests.chromium import chromium  # noqa: F401  # a fixture
from tests.examples.conftest import MODELS, PAGES, models_of

pytestmark = pytest.mark.slow

Told: TypeAlias = Callable[[str], dict[str, Any]]
Planned: TypeAlias = Callable[[str, int], TraceTest]
ROOT = Path(__file__).parents[3]
QUICK = "supervised_line_follower"
#: The warehouse robot covers all features in the reports of these.
MORE = ("maze_solver", "object_finder", "person_follower", "push_ball", "sprayer")
#: A run of all tests adds other robots; the tests of one robot share its report.
EACH = [
    QUICK,
    *(
        pytest.param(
            name,
            marks=[
                pytest.mark.slow,
                pytest.mark.xdist_group(f"report {name}"),
                *([pytest.mark.matrix] if name in MORE else []),
            ],
        )
        for name in PAGES
        if name != QUICK
    ),
]


@pytest.fixture(scope="session")
def planned(planned_once: Callable[..., list[TraceTest]]) -> Planned:
    """Return the tests of a robot's package, shared by the report, `transform` and the tests here."""

    @cache
    def both(name: str) -> list[TraceTest]:
        graph, near = models_of(name).rosgraph, find(MODELS[name].parent)
        assert graph is not None
        return planned_once(MODELS[name], graph, read(near) if near else Configuration())

    return lambda name, version: both(name)[version - 1]


@contextmanager
def with_tours_of(planned: Planned, name: str) -> Iterator[pytest.MonkeyPatch]:
    """Replace the tours of a robot by those of `planned` within the context, except for the quick robot."""
    with pytest.MonkeyPatch.context() as patch:
        if name != QUICK:
            patch.setattr(
                "robosc.run.node_tests.trace_test.trace_test",
                lambda _graph, _settings, version, _paths=(): planned(name, version),
            )
        yield patch


@pytest.fixture(scope="session")
def told(verified_once: Callable[[Path], Callable[..., Any]], planned: Planned) -> Told:
    """Return the report of a robot. Only the quick robot is verified again; others share their verdicts."""

    @cache
    def report(name: str) -> dict[str, Any]:
        with with_tours_of(planned, name) as patch:
            if name != QUICK:
                patch.setattr(safety_report, "verify", verified_once(MODELS[name]))
            done = CliRunner().invoke(main, ["report", str(MODELS[name]), "--json"])
        assert done.exit_code == 0, done.output
        return json.loads(done.stdout)

    return report


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory, planned: Planned) -> Callable[[str], Path]:
    """Return the folder with all generated files of a robot."""

    @cache
    def folder(name: str) -> Path:
        made = tmp_path_factory.mktemp(name)
        call = ["transform", str(MODELS[name]), "--to", "supervisor,cif,ros1,ros2", "--with-tests", "-o", str(made)]
        call += ["--interface-path", str(ROOT / "tests" / "ros" / "interfaces" / "ros1" / "nav2_msgs")]
        with with_tours_of(planned, name):
            done = CliRunner().invoke(main, call)
        assert done.exit_code == 0, done.output
        return made

    return folder


@pytest.mark.parametrize("name", EACH)
def test_the_json_keeps_its_schema(name: str, told: Told) -> None:
    schema = json.loads((ROOT / "robosc/schemas/report.schema.json").read_text())
    Draft202012Validator.check_schema(schema)
    Draft202012Validator(schema).validate(told(name))


@pytest.mark.parametrize("name", EACH)
def test_its_verdicts_are_those_of_verify(name: str, verified: Callable[[Path], Any], told: Told) -> None:
    keys = ("property", "outcome", "evidence")
    ours = [[verdict[key] for key in keys] for verdict in told(name)["verdicts"]]
    assert ours == [[verdict[key] for key in keys] for verdict in verified(MODELS[name])["properties"]]
    by_requirement = [verdict for requirement in told(name)["requirements"] for verdict in requirement["verdicts"]]
    assert len(by_requirement) == sum(verdict["requirement"] is not None for verdict in told(name)["verdicts"])


@pytest.mark.parametrize("name", EACH)
def test_the_lines_speak_of_the_requirement(name: str, written: Callable[[str], Path], told: Told) -> None:
    robot = models_of(name).sct
    for requirement in told(name)["requirements"]:
        files = [Path(place["path"]) for place in requirement["generated"]]
        assert {".c", ".cpp"} <= {file.suffix for file in files} or not any(
            event["event"].endswith("c_trigger") for event in requirement["events"]
        )
        assert files or not requirement["events"]
        for place in requirement["generated"]:
            lines = (written(name) / place["path"]).read_text().splitlines()
            for number in place["lines"]:
                around = " ".join(line.strip(" /*") for line in lines[number - 1 : number + 12])
                around = re.sub(r"\\([0-7]{3})", lambda octal: chr(int(octal[1], 8)), around)
                assert any(text in " ".join(around.split()) for text in requirement["texts"]), (
                    place,
                    requirement["texts"],
                )
    assert robot.name == told(name)["robot"]


def test_lines_of_a_node_are_those_where_it_sends_and_where_it_tells(
    written: Callable[[str], Path], told: Told
) -> None:
    commands = [
        place
        for requirement in told(QUICK)["requirements"]
        if any(event["event"].endswith("c_trigger") for event in requirement["events"])
        for place in requirement["generated"]
        if place["path"].endswith(".cpp")
    ]
    assert len(commands) >= 2
    for place in commands:
        lines = (written(QUICK) / place["path"]).read_text().splitlines()
        found = {lines[number - 1].split()[0].partition("(")[0] for number in place["lines"]}
        assert found == {"//", "reasons.add_requirement"}, place


@pytest.mark.parametrize("name", EACH)
def test_the_digests_are_those_of_what_is_written(name: str, written: Callable[[str], Path], told: Told) -> None:
    for file in told(name)["digests"]["outputs"]:
        assert digests.digest((written(name) / file["path"]).read_bytes()) == file["sha256"], file
    read = {file["path"]: file["sha256"] for file in told(name)["digests"]["model"]}
    assert read[MODELS[name].name] == digests.digest(MODELS[name].read_bytes())


def trace_of(planned: Planned, name: str, path: str) -> str:
    """Return a trace of a package's tests, by its path among the generated files."""
    return planned(name, int(path.removeprefix("ros")[0])).files[f"traces/{path.rpartition('/')[2]}"]


@pytest.mark.parametrize("name", EACH)
def test_the_page_on_tests_tells_what_its_tours_show(name: str, planned: Planned) -> None:
    page = (ROOT / "docs" / "tests-for-your-robot.md").read_text()
    row = re.search(rf"^\| `{name}` \| (.+) \|$", page, re.MULTILINE)
    assert row
    runs, steps, transitions, true, false = row[1].split(" | ")
    test = planned(name, 2)
    assert test.coverage == f"{transitions} transitions, {true} guards true, {false} false, in {steps} steps"
    assert sum(path.startswith("traces/") for path in test.files) == int(runs)


DRIVER = """\
#include "{prefix}_supervisor.h"
#include <stdio.h>
#include <string.h>

int main(void)
{{
    {prefix}_supervisor robot;
    {prefix}_event event;
    int number;
    long value;
    {prefix}_init(&robot, NULL, NULL{now});
    do {{
{asked}
        if (scanf("%d", &number) != 1) {{
            return 0;
        }}
        event = ({prefix}_event)number;
{inputs}
    }} while ({prefix}_perform(&robot, event{now}));
    return 1;
}}
"""


@pytest.mark.build
@pytest.mark.parametrize("name", EACH)
def test_gcov_counts_as_often_that_a_guard_is_true(name: str, tmp_path: Path, told: Told, planned: Planned) -> None:
    """gcov counts how often the C engine evaluates each guard while it performs the trace.

    Each guard is evaluated in each of the states.
    """
    if shutil.which("gcc") is None or shutil.which("gcov") is None:
        pytest.skip("there is no gcc with gcov")
    models = models_of(name)
    files = supervisor.generate(models, Configuration())
    for path, text in files.items():
        (tmp_path / path).write_text(text)
    engine, names = Engine(models.sct), CNames(models.sct)
    numbers = {event.name: number for number, event in enumerate(engine.executed.events)}
    guards = told(name)["coverage"]["guards"]
    asked = "".join(
        f"        if ({names.prefix}_enabled(&robot, ({names.prefix}_event){numbers[guard['event']]})) {{\n"
        f"            (void)0, number = {place}; /* true {place} */\n"
        f"        }} else {{\n            (void)0, number = {place}; /* false {place} */\n        }}\n"
        for place, guard in enumerate(guards)
    )
    declared = list(engine.executed.inputs)
    inputs = "".join(
        f'        if (scanf("%ld", &value) != 1) {{ return 1; }}\n        robot.inputs.{names.of(carried)} = value;\n'
        for carried in declared
    )
    driver = DRIVER.format(
        prefix=names.prefix, asked=asked, inputs=inputs, now=", 0U" if engine.executed.timers else ""
    )
    (tmp_path / "driver.c").write_text(driver)
    source = f"{names.prefix}_supervisor.c"
    subprocess.run(["gcc", "--coverage", "-O0", "-w", source, "driver.c", "-o", "driver"], cwd=tmp_path, check=True)
    played = 0
    for path in told(name)["coverage"]["traces"]:
        simulation = Simulation(models.sct, models.rosgraph)
        steps, _ = read_script("trace", trace_of(planned, name, path), simulation.engine.events)
        script = [
            " ".join(str(int(number)) for number in (numbers[step.event], *simulation.engine.saved[1]))
            for step in steps
            if simulation.perform(step.event, step.data).accepted
        ]
        played += len(script)
        # gcov adds the counts of all runs.
        subprocess.run(["./driver"], cwd=tmp_path, input="\n".join(script), text=True, check=True)
    subprocess.run(["gcov", "driver-driver.gcda"], cwd=tmp_path, check=True, capture_output=True)
    counted = {}
    for line in (tmp_path / "driver.c.gcov").read_text().splitlines():
        found = re.match(r"\s*([\d#]+)\*?:.*/\* (true|false) (\d+) \*/", line)
        if found:
            counted[int(found[3]), found[2]] = int(found[1].replace("#####", "0"))
    assert [[guard["true"], guard["false"]] for guard in guards] == [
        [counted[place, "true"], counted[place, "false"]] for place in range(len(guards))
    ]
    assert told(name)["coverage"]["events"] == played


@pytest.mark.slow
@pytest.mark.parametrize("name", EACH)
def test_the_page_opens_and_shows_the_numbers(name: str, chromium: Any, tmp_path: Path, told: Told) -> None:  # noqa: F811
    found, page = told(name), tmp_path / "report.html"
    page.write_text(as_html(found), encoding="utf-8")
    opened = chromium.new_page()
    faults: list[str] = []
    opened.on("console", lambda said: faults.append(said.text))
    opened.on("pageerror", lambda error: faults.append(str(error)))
    opened.goto(page.as_uri())
    assert opened.inner_text("body").startswith(found["notice"])
    shown = opened.eval_on_selector_all("tr[data-property]", "rows => rows.map(row => row.dataset.outcome)")
    assert shown == [verdict["outcome"] for verdict in found["verdicts"]]
    guards = opened.eval_on_selector_all("tr[data-guard]", "rows => rows.map(row => row.innerText)")
    assert [list(map(int, row.split()[-2:])) for row in guards] == [
        [guard["true"], guard["false"]] for guard in found["coverage"]["guards"]
    ]
    assert opened.locator("article").count() == len(found["requirements"])
    assert opened.evaluate("getComputedStyle(document.querySelector('.notice')).borderLeftWidth") == "6px"
    opened.close()
    assert faults == []


@pytest.mark.slow
def test_the_same_on_every_run(told: Told) -> None:
    again = CliRunner().invoke(main, ["report", str(MODELS[QUICK]), "--json"])
    assert json.loads(again.stdout) == told(QUICK)


def test_what_a_model_says_is_escaped(told: Told) -> None:
    found = json.loads(json.dumps(told(QUICK)))
    hostile = "</style><script>alert(1)</script>\u202e"
    found["robot"] = found["requirements"][0]["name"] = found["requirements"][0]["texts"][0] = hostile
    page = as_html(found)
    assert "<script>" not in page
    assert page.count("</style>") == 1
    assert "\u202e" not in page
    assert "default-src 'none'" in page


def test_the_needs_are_linked(told: Told) -> None:
    found = told(QUICK)
    needs = json.loads(as_needs(found))
    [version] = needs["versions"].values()
    made = version["needs"]
    assert needs["current_version"] in needs["versions"]
    assert all(re.fullmatch(r"[A-Z0-9_]{5,}", identifier) for identifier in made)
    requirements = [need for need in made.values() if need["type"] == "req"]
    assert [need["title"] for need in requirements] == [need["name"] for need in found["requirements"]]
    linked = {link for need in made.values() for link in need["links"]}
    assert linked == {need["id"] for need in requirements}


def test_the_texts_of_needs_are_no_markup(told: Told) -> None:
    """A parser of reStructuredText returns the original texts."""
    found = told(QUICK)
    text = "requirement move needs 2 *level_ < |a_b| and `Gauge.on`"
    odd = {**found, "requirements": [{**found["requirements"][0], "texts": [text]}]}
    [version] = json.loads(as_needs(odd))["versions"].values()
    content = next(need["content"] for need in version["needs"].values() if need["type"] == "req")
    settings = {"report_level": 1, "halt_level": 2}
    core = pytest.importorskip("docutils.core", reason="the packages of [docs] are not installed")
    assert core.publish_doctree(content, settings_overrides=settings).astext() == text.replace("`", "")


@pytest.mark.slow
def test_a_refuted_property_is_an_error(tmp_path: Path) -> None:
    text = MODELS[QUICK].read_text()
    file = tmp_path / "wrong.rscd"
    file.write_text(text.rstrip().removesuffix("}") + "\n  property never true\n}\n")
    done = CliRunner().invoke(main, ["report", str(file), "--json"])
    assert done.exit_code == 1
    assert [verdict["outcome"] for verdict in json.loads(done.stdout)["verdicts"]].count("refuted") == 1


@pytest.mark.slow
def test_files_are_written(tmp_path: Path, told: Told) -> None:
    page, needs = tmp_path / "report.html", tmp_path / "needs.json"
    done = CliRunner().invoke(main, ["report", str(MODELS[QUICK]), "-o", str(page), "--needs", str(needs)])
    assert done.exit_code == 0, done.output
    assert page.read_text().startswith("<!DOCTYPE html>")
    assert json.loads(needs.read_text())["project"] == told(QUICK)["robot"]
