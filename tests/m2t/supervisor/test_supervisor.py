"""The generated C as its users get it: compilers, linker, CMake; and what it promises about itself."""

import re
import shutil
import subprocess
from collections.abc import Callable, Sequence
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import robosc
from robosc.engine import Settings
from robosc.language.configuration import Configuration
from robosc.language.configuration import ControlLoop as Chosen
from robosc.m2m.sct_to_engine import POLLED
from robosc.m2t import supervisor
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.places import Place
from tests.m2t.supervisor import corners
from tests.m2t.supervisor.driver import STRICT, build, run, write
from tests.m2t.supervisor.walk import Walk
from tests.sct_models import edge, model, plant

pytestmark = pytest.mark.build

HERE = Path(__file__).parent
EXAMPLE = HERE.parents[2] / "examples" / "line_follower" / "line_follower.rscd"
AS_CPP = ("-std=c++17", *STRICT[1:], "-x", "c++")
COMPILERS = {
    "gcc": ["gcc", *STRICT, "-O2"],
    "gcc -fanalyzer": ["gcc", *STRICT, "-O1", "-fanalyzer"],
    "clang": ["clang", *STRICT],
    "g++": ["g++", *AS_CPP],
    "clang++": ["clang++", *AS_CPP],
    "arm-none-eabi-gcc": ["arm-none-eabi-gcc", "-mcpu=cortex-m3", "-mthumb", *STRICT, "-Os"],
}


def supervised(path: Path) -> sct.SupervisoryControlModel:
    made = robosc.to_sct(robosc.load(path))
    robosc.synthesize(made)
    return made


def dock() -> sct.SupervisoryControlModel:
    return supervised(HERE / "dock.rscd")


def line_follower() -> sct.SupervisoryControlModel:
    return supervised(EXAMPLE)


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The sources of all corner models and of two real ones, each as it is and as if it were large."""
    models = [make() for make in corners.ALL] + [dock(), line_follower()]
    return [
        write(path, folder, small=small)
        for folder, small in ((tmp_path_factory.mktemp("sources"), POLLED), (tmp_path_factory.mktemp("large"), 0))
        for path in models
    ]


def call(*command: object, cwd: Path | None = None) -> str:
    words = [str(word) for word in command]
    if shutil.which(words[0]) is None:
        pytest.skip(f"{words[0]} is not installed")
    done = subprocess.run(words, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.mark.parametrize("compiler", COMPILERS)
def test_no_compiler_has_anything_to_say(compiler: str, sources: Sequence[Path], tmp_path: Path) -> None:
    call(*COMPILERS[compiler], "-c", *sources, cwd=tmp_path)


def test_names_can_be_left_out(sources: Sequence[Path], tmp_path: Path) -> None:
    macros = [f"-D{source.stem.removesuffix('_supervisor').upper()}_NO_NAMES" for source in sources]
    call("gcc", *STRICT, *macros, "-c", *sources, cwd=tmp_path)
    for source in sources:
        assert b"event_name" not in (tmp_path / f"{source.stem}.o").read_bytes()


def test_cppcheck_has_nothing_to_say(sources: Sequence[Path]) -> None:
    checks = "--enable=warning,style,performance,portability"
    assert call("cppcheck", "--quiet", "--std=c99", checks, *sources) == ""


@pytest.mark.parametrize(
    ("make", "small"),
    [(make, small) for make in (*corners.ALL, dock, line_follower) for small in (POLLED, 0)]
    + [(corners.large, POLLED)],
)
def test_it_runs_as_in_python(make: Callable[[], sct.SupervisoryControlModel], small: int, tmp_path: Path) -> None:
    made = make()
    walk = Walk(made, Settings(events_per_tick=1, reactions_per_tick=3), seed=7)
    walk.tick()
    if walk.loop.engine.events:
        walk.steps(150)
    built = build(made, tmp_path, Chosen(events_per_tick=1, reactions_per_tick=3), small=small)
    assert run(built, walk.script) == walk.said


def test_the_golden_files(golden: Callable[[Path, str], None]) -> None:
    generated = robosc.generate("supervisor", Models(dock()))
    assert list(generated) == ["dock_supervisor.h", "dock_supervisor.c", "CMakeLists.txt"]
    for name, text in generated.items():
        golden(HERE / "golden" / name, text)


def test_two_controllers_fit_in_one_program(tmp_path: Path) -> None:
    models = [corners.swap(), dock()]
    written = [write(path, tmp_path) for path in models]
    (tmp_path / "main.c").write_text(
        """
        #include "swap_supervisor.h"
        #include "dock_supervisor.h"
        int main(void)
        {
            swap_supervisor one, other;
            dock_supervisor dock;
            swap_init(&one, 0, 0);
            swap_init(&other, 0, 0);
            dock_init(&dock, 0, 0);
            swap_perform(&one, swap_a_u_response);
            dock_tick(&dock);
            return one.state.a != swap_a_y || other.state.a != swap_a_x || dock.state.data_light != dock_data_light_d2;
        }
        """
    )
    call("gcc", *STRICT, tmp_path / "main.c", *written, "-o", tmp_path / "main")
    call(tmp_path / "main")


def test_the_engine_needs_nothing_and_keeps_nothing(sources: Sequence[Path], tmp_path: Path) -> None:
    for source in sources:
        compiled = tmp_path / f"{source.stem}.o"
        call("gcc", "-std=c99", "-O2", "-fno-builtin", "-fno-pie", "-c", source, "-o", compiled)
        symbols = [line.split()[-2:] for line in call("nm", compiled).splitlines()]
        assert {name for kind, name in symbols if kind == "U"} <= {"memcpy"}
        assert not [name for kind, name in symbols if kind in "bBdDcC"], "data that can change"
        text = source.read_text()
        assert re.findall(r"#include <(.*)>", text + source.with_suffix(".h").read_text()) == [
            "stddef.h",
            "stdbool.h",
            "stdint.h",
        ]
        code = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
        assert not re.search(r"\b(double|float|goto|malloc)\b", code)


def test_no_function_calls_itself(sources: Sequence[Path]) -> None:
    """A call graph without a circle, of static functions also without a declaration ahead."""
    for source in sources:
        code = re.sub(r"/\*.*?\*/|\".*?\"", "", source.read_text(), flags=re.DOTALL)
        starts = list(re.finditer(r"^(\w[\w *]*?)\b(\w+)\([^;{]*\)\n\{", code, flags=re.MULTILINE))
        assert len(starts) >= 8
        names = [start[2] for start in starts]
        calls = dict[str, set[str]]()
        for position, start in enumerate(starts):
            end = starts[position + 1].start() if position + 1 < len(starts) else len(code)
            calls[start[2]] = set(re.findall(r"(?<![>.])\b(\w+)\(", code[start.end() : end])) & set(names)
            static = {other[2] for other in starts if other[1].startswith("static")}
            assert calls[start[2]] & static <= set(names[:position])
        assert {*TopologicalSorter(calls).static_order()} == {*names}


def test_the_line_follower_is_small(tmp_path: Path) -> None:
    source = write(line_follower(), tmp_path)
    compiled = tmp_path / "engine.o"
    call("gcc", "-std=c99", "-Os", "-DLINE_FOLLOWER_NO_NAMES", "-c", source, "-o", compiled)
    sizes = dict(re.findall(r"^(\.\w+) +(\d+)", call("size", "-A", compiled), flags=re.MULTILINE))
    assert int(sizes[".text"]) <= 2150
    assert int(sizes[".data"]) == int(sizes[".bss"]) == 0


def test_requirements_stand_at_the_guard_in_the_words_of_the_model() -> None:
    header, source, _ = robosc.generate("supervisor", Models(dock())).values()
    words = "requirement Station.docked disables approach (dock.rscd)"
    at = source.index("case dock_action_approach_c_trigger:")
    assert words in source[:at].rsplit("return", 1)[1]
    assert words in header.split("dock_action_approach_c_trigger,")[0].rsplit("/*", 1)[1]


def test_what_guards_have_in_common_is_one_function(tmp_path: Path) -> None:
    source = write(corners.shared(), tmp_path).read_text()
    assert len(re.findall(r"state->store_n > 3", source)) == 1
    assert len(re.findall(r"state->store_n < 7", source)) == 1
    shared = re.findall(r"static bool (condition_\d+)\(", source)
    assert shared
    assert all(len(re.findall(rf"\b{condition}\(state\)", source)) > 1 for condition in shared)
    assert re.search(r"condition_\d\(state\) /\* partly added by synthesis \*/", source)


def test_what_a_model_says_stays_in_its_comment(tmp_path: Path) -> None:
    source = write(corners.texts(), tmp_path).read_text()
    code = re.sub(r"/\*.*?\*/", "", source, flags=re.DOTALL)
    assert "main" not in code
    assert "main" in source
    assert "??" not in source
    assert "\u202e" not in source


def test_settings_are_the_configurations() -> None:
    models = Models(corners.triggers())
    chosen = Configuration(control_loop=Chosen(events_per_tick=3, reactions_per_tick=0, react_immediately=False))
    source = supervisor.generate(models, chosen)["triggers_supervisor.c"]
    assert "triggers_default_settings = {\n    3U, 0U, false\n};" in source


def test_the_same_model_gives_the_same_files() -> None:
    first, second = (robosc.generate("supervisor", Models(dock())) for _ in range(2))
    assert first == second


@pytest.mark.parametrize(
    ("update", "fits"),
    [("a + b", True), ("a * 2", True), ("a * 2 + 2 - 2", False), ("a * a", False), ("c - 1 > 0", False), ("-c", False)],
)
def test_what_could_overflow_is_refused_where_it_stands(update: str, fits: bool) -> None:
    variable = "t" if ">" in update else "a"
    variables = {"a": f"0..{2**62 - 1}", "b": "0..10", "c": f"{-(2**63)}..0", "t": "bool"}
    p = plant(
        "p", {"x": [edge("u_response", do={variable: update})]}, uncontrollable=["u_response"], variables=variables
    )
    made = model([p], guards={})
    made.plants[0].locations[0].edges[0].updates[0].source = Place.parse("big.rscd:3:5-3:17")
    found = supervisor.preconditions(Models(made), Configuration())
    assert bool(found) is not fits
    for finding in found:
        assert (finding.file, finding.span.line, finding.span.column, finding.rule) == ("big.rscd", 3, 5, "c-overflow")
        assert "64 bits" in finding.message
    if fits:
        supervisor.generate(Models(made), Configuration())


def test_cmake_builds_installs_and_includes_it(tmp_path: Path) -> None:
    package = tmp_path / "package"
    package.mkdir()
    for name, text in robosc.generate("supervisor", Models(dock())).items():
        (package / name).write_text(text)
    call(
        "cmake",
        "-S",
        package,
        "-B",
        tmp_path / "alone",
        f"-DCMAKE_INSTALL_PREFIX={tmp_path / 'installed'}",
        "-DCMAKE_C_FLAGS=-Werror",
    )
    call("cmake", "--build", tmp_path / "alone", "--target", "install")
    main = tmp_path / "main.c"
    main.write_text(
        '#include "dock_supervisor.h"\n'
        "int main(void) { dock_supervisor robot; dock_init(&robot, 0, 0); dock_tick(&robot); return 0; }\n"
    )
    for name, finding in (
        ("added", f"add_subdirectory({package} dock)"),
        ("found", "find_package(dock_supervisor REQUIRED)"),
    ):
        project = tmp_path / name
        project.mkdir()
        (project / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.10)\nproject(robot C)\n"
            f"{finding}\nadd_executable(robot {main})\ntarget_link_libraries(robot PRIVATE dock_supervisor)\n"
        )
        call("cmake", "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={tmp_path / 'installed'}")
        call("cmake", "--build", project / "build")
        call(project / "build" / "robot")
