"""The order of the packages, the places of libraries, and the paths that docs/architecture.md names."""

import ast
import builtins
import re
import sys
from collections.abc import Iterator
from functools import cache
from keyword import softkwlist
from pathlib import Path

import pytest

import robosc

PACKAGE = Path(robosc.__file__).parent
ROOT = PACKAGE.parent
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")

#: The packages in the order of the page. A package imports from itself and from packages to its left.
ORDER = re.findall(r"\w+", re.findall(r"```\n(.+ < .+)\n```", PAGE)[0])
#: Folders of tests that concern several packages.
COMMON_TESTS = {"benchmarks", "cmake", "docs", "every_view", "examples", "fuzz", "plugins", "ros", "scenarios"}
#: Modules that all generators of `m2t` share.
SHARED = {"models", "c"}

#: The packages that import a library.
LIBRARIES = {
    "action_msgs": {"run"},
    "arpeggio": {"language"},
    "click": {"tools"},
    "diagnostic_msgs": {"run"},
    "distributed": {"tools"},
    "joblib": {"tools"},
    "lsprotocol": {"tools"},
    "lz4": {"base"},
    "anyio": {"tools"},
    "jsonschema": {"tools"},
    "mcap": {"base"},
    "mcp": {"tools"},
    "mcp_types": {"tools"},
    "jinja2": {"base", "m2t"},
    "networkx": {"tools"},
    "oxidd": {"synthesis"},
    "pydantic": {"language"},
    "pyecore": {"model"},
    "pygments": {"language"},
    "pygls": {"tools"},
    "rcl_interfaces": {"run"},
    "ray": {"tools"},
    "rclpy": {"run"},
    "rich": {"base", "tools"},
    "rosbags": {"base"},
    "starlette": {"tools"},
    "std_msgs": {"run"},
    # Generators of modules in the wheels of ROS 2.
    **{f"rosidl_{name}": {"run"} for name in ("adapter", "cli", "generator_c", "generator_py")},
    **{f"rosidl_typesupport_{name}": {"run"} for name in ("c", "fastrtps_c", "introspection_c")},
    "rosidl_generator_type_description": {"run"},
    "numpy": {"run"},
    "textx": {"analysis", "language"},
    "uvicorn": {"tools"},
}


@cache
def modules() -> list[tuple[tuple[str, ...], list[ast.AST]]]:
    """Every module, as the parts of its name below `robosc`, and the nodes of its syntax tree."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        found.append((tuple(part for part in parts if part != "__init__"), nodes))
    return found


def imports(nodes: list[ast.AST]) -> Iterator[tuple[str, ...]]:
    """The parts of the name of every module that a module imports, anywhere, for type checkers or by a string too."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (tuple(alias.name.split(".")) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            yield from (tuple(f"{node.module}.{alias.name}".split(".")) for alias in node.names)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in {"import_module", "importlib.import_module"}:
            names = (name.value for name in node.args[:1] if isinstance(name, ast.Constant))
            yield from (tuple(name.split(".")) for name in names)


def index(parts: tuple[str, ...]) -> int:
    """The place of a module's package in the order; the public API and the entry point count as tools."""
    return ORDER.index(parts[0] if parts and parts[0] in ORDER else "tools")


def test_a_package_imports_only_from_its_left() -> None:
    wrong = [
        f"{'.'.join(importer)} imports {'.'.join(imported)}"
        for importer, nodes in modules()
        for root, *imported in imports(nodes)
        if root == "robosc" and index(importer) < index(tuple(imported))
    ]
    assert wrong == []


def test_every_package_is_in_the_order() -> None:
    packages = {path.name for path in PACKAGE.iterdir() if any(path.rglob("*.py"))}
    assert packages == set(ORDER)
    assert [name for name in ORDER if f"| `{name}` |" not in PAGE] == []


def test_tests_mirror_the_packages() -> None:
    folders = {path.name for path in (ROOT / "tests").iterdir() if any(path.rglob("test_*.py"))}
    assert folders - COMMON_TESTS == set(ORDER)


def test_a_target_imports_no_other() -> None:
    pairs = [
        (importer[1], imported[2])
        for importer, nodes in modules()
        for imported in imports(nodes)
        if importer[:1] == ("m2t",) and importer[1:] and imported[:2] == ("robosc", "m2t") and imported[2:]
    ]
    assert {("ros", "c"), ("cif", "models")} <= {*pairs}
    # The list of targets loads each of them when it is used.
    assert [pair for pair in pairs if pair[0] not in {pair[1], "targets"} and pair[1] not in SHARED] == []


def test_no_rule_imports_another() -> None:
    rules = ("language", "checks", "rules")
    found = [(importer, imported) for importer, nodes in modules() for imported in imports(nodes)]
    assert [pair for pair in found if (pair[0][:3], pair[1][1:4]) == (rules, rules)] == []


#: Modules that the second reading of a robot's text shares with the first: evaluation of expressions, and walks.
COMMON = {"evaluation", "operators", "walks"}


def test_the_second_reading_shares_nothing_with_the_first() -> None:
    used = {
        tuple(imported)
        for importer, nodes in modules()
        if importer[:3] == ("analysis", "verify", "model_reading")
        for root, *imported in imports(nodes)
        if root == "robosc"
    }
    assert {imported[0] for imported in used} == {"analysis", "model"}
    assert {imported[2] for imported in used if imported[:2] == ("model", "semantics")} == COMMON
    assert {imported[1] for imported in used if imported[0] == "analysis"} == {"verify", "wording", "paths"}


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_stays_in_its_packages(library: str) -> None:
    used = {importer[0] for importer, nodes in modules() for name, *_ in imports(nodes) if name == library}
    assert used == LIBRARIES[library]


def test_every_other_library_is_the_standard_one() -> None:
    known = {*LIBRARIES, "robosc", *sys.stdlib_module_names}
    assert {name for _, nodes in modules() for name, *_ in imports(nodes) if name not in known} == set()


#: Functions that open, create or move files.
OPENING = {
    "open",
    "fdopen",
    "open_file",
    "read_text",
    "read_bytes",
    "write_text",
    "write_bytes",
    "touch",
    "rename",
    "replace",
}
#: Modules that call them; files that users name go through `base.files`.
OPENERS = {
    "base.files.reading",
    "base.files.writing",
    "tools.cli",  # the null device, for streams that are closed
    "tools.cli.format",  # the standard output
    "tools.workers",  # the null device, for the errors of a process
    "tools.sweep.jobs",  # its own temporary folder
    "tools.sweep.results",  # what `files.writing` has opened
    "base.diagnostics.rules",  # what ships with the tool, here and in those below without a word of their own
    "model.semantics.naming",
    "synthesis.memory",  # what the kernel tells of the process
    "m2t.ros.packages",
    "model._ecore",
    "tools.cli.view",  # the browser
    "tools.view.page",
    "tools.mcp.pages",
    "tools.mcp.process",  # the null device, in place of the pipe to the server
    "run.node_tests.trace_test",
    "run.runtime.ros2.interfaces",  # a tool of its own, whose files are made for the generators
    "run.runtime.core.event_log",  # what `files.writing` has opened
    "run.node_tests.trace_player",  # ships with generated packages, and sees nothing of ours
    "analysis.verify.c_program",  # a temporary folder, here and in the next two
    "analysis.verify.c_exploration",
    "run.scenario_tests.live",
    "run.report.digests",  # what ships with the tool
    "run.report.rendering",
    "base.extensions",  # what an installed package declares
}


def opens(node: ast.AST) -> bool:
    """Whether this calls what opens, makes or moves files; texts and dataclasses have a `replace` of two or more."""
    if not isinstance(node, ast.Call):
        return False
    if isinstance(node.func, ast.Attribute):
        return node.func.attr in OPENING and (node.func.attr != "replace" or len(node.args) + len(node.keywords) == 1)
    return isinstance(node.func, ast.Name) and node.func.id == "open"


def test_files_that_others_name_go_through_one_place() -> None:
    opening = {".".join(parts) for parts, nodes in modules() if any(map(opens, nodes))}
    assert opening == OPENERS


def test_paths_on_the_page_exist() -> None:
    named = set(re.findall(r"`((?:robosc|grammar|metamodel|docs|tests)/[\w./]+)`", PAGE))
    assert len(named) > 30
    assert sorted(path for path in named if not (ROOT / path).exists() and not (ROOT / f"{path}.py").exists()) == []


def test_what_docstrings_of_packages_name_is_there() -> None:
    """Each name in the docstring of a package is a module, a folder, a definition in it, or a word of Python."""
    missing = []
    for path in sorted(PACKAGE.rglob("__init__.py")):
        docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        texts = [module.read_text(encoding="utf-8") for module in path.parent.rglob("*.py")]
        stems = {path.parent.name, *(inner.stem for inner in path.parent.rglob("*")), *dir(builtins), *softkwlist}
        for name in re.findall(r"`(\w+(?:\.\w+)*)`", docstring):
            wholes = [folder.joinpath(*name.split(".")) for folder in (ROOT, path.parents[1])]
            defined = re.compile(rf"^ *(?:def|class) {re.escape(name)}\b", re.MULTILINE)
            there = any(whole.exists() or whole.with_suffix(".py").exists() for whole in wholes)
            if name not in stems and not there:
                missing += [] if any(map(defined.search, texts)) else [f"{path.relative_to(ROOT)}: {name}"]
    assert missing == []


#: Participles that tell how a thing came about. A name tells what the thing is.
PARTICIPLES = {"asked", "found", "given", "held", "kept", "made", "read", "said", "stated", "told", "wanted"}
#: Names of functions and classes: `read` is a verb there.
PASSIVES = {*PARTICIPLES, "extended", "meant", "opened", "written"} - {"read"}
#: Generated packages contain `trace_player`, so that a new name would change them.
PARTICIPLES_STAY = {"run.node_tests.trace_player"}


def participles(node: ast.AST) -> Iterator[str]:
    """The forbidden names that a node of the syntax tree binds."""
    match node:
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            forbidden = PASSIVES
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()) | ast.arg(arg=name):
            forbidden = PARTICIPLES
        case ast.alias(asname=str(name)) | ast.ExceptHandler(name=str(name)):
            forbidden = PARTICIPLES
        case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)) | ast.MatchMapping(rest=str(name)):
            forbidden = PARTICIPLES
        case _:
            return
    if name.strip("_").lower() in forbidden:
        yield name


def test_names_say_what_a_thing_is() -> None:
    bound = {(".".join(parts), name) for parts, nodes in modules() for node in nodes for name in participles(node)}
    assert sorted((module, name) for module, name in bound if module not in PARTICIPLES_STAY) == []
    assert {module for module, _ in bound} == PARTICIPLES_STAY
