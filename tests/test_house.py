"""docs/architecture.md is true: which package may import which, which library belongs to which, and what there is."""

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

#: What every room stands on, each only on those behind it: the packages of the page's second table.
GROUND = re.findall(r"^\| `robosc/(\w+)` \|", PAGE.partition("All of them stand on these")[2], re.MULTILINE)
ROOMS = {
    "language",
    "cif",
    "checks",
    "m2m",
    "synthesis",
    "analysis",
    "engine",
    "runtime",
    "simulation",
    "debugger",
    "view",
    "report",
    "diagrams",
    "editor",
    "m2t",
    "node_tests",
    "scenario_tests",
    "cli",
    "__main__",
    "",
}
#: Rooms that see more than the ground, and what: the root is the public API, the command line is on top.
ALLOWED = {
    "": ROOMS - {"cli", "debugger", "editor", "view", "report", "__main__"},
    "__main__": {"cli"},
    "analysis": {"synthesis", "engine", "m2t", "cif"},
    "checks": {"language"},
    "cif": {"language"},
    "editor": {"", "language", "checks", "analysis"},
    "runtime": {"engine"},
    "node_tests": {"engine", "runtime", "m2t", "analysis", "synthesis"},
    "scenario_tests": {"engine", "runtime", "analysis", "node_tests", "simulation"},
    "simulation": {"engine", "runtime", "analysis", "language"},
    "debugger": {"m2t", "analysis", "engine", "simulation"},
    "view": {"m2t", "analysis", "engine", "simulation", "diagrams", "language"},
    "report": {"m2t", "analysis", "engine", "node_tests", "simulation"},
    "cli": ROOMS - {"__main__"},
}
#: What of `m2m` comes after synthesis, and what begins with it.
AFTER_SYNTHESIS = {"sct_to_engine": {"engine", "m2t"}, "sct_to_cif": {"m2t"}, "remembering": {"engine", "m2t"}}
#: Pieces that generators share, each with what it may use of the others.
SHARED = {
    "models": set(),
    "c": {"models"},
}

LIBRARIES = {
    "action_msgs": {"runtime"},
    "arpeggio": {"language", "cif"},
    "click": {"cli"},
    "diagnostic_msgs": {"runtime"},
    "lsprotocol": {"editor"},
    "lz4": {"recordings"},
    "mcap": {"recordings"},
    "jinja2": {"files", "m2t"},
    "networkx": {"diagrams"},
    "oxidd": {"synthesis"},
    "pydantic": {"configuration"},
    "pyecore": {"metamodel"},
    "pygments": {"highlighting"},
    "pygls": {"editor"},
    "rcl_interfaces": {"runtime"},
    "rclpy": {"runtime"},
    "rich": {"cli", "diagnostics"},
    "rosbags": {"ros_types", "recordings"},
    "starlette": {"view"},
    "std_msgs": {"runtime"},
    # What the wheels of ROS 2 generate modules with.
    **{f"rosidl_{name}": {"runtime"} for name in ("adapter", "cli", "generator_c", "generator_py")},
    **{f"rosidl_typesupport_{name}": {"runtime"} for name in ("c", "fastrtps_c", "introspection_c")},
    "rosidl_generator_type_description": {"runtime"},
    "numpy": {"runtime"},
    "textx": {"language", "analysis", "cif"},
    "uvicorn": {"view"},
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


def room(parts: tuple[str, ...]) -> str:
    """The room of a module; an attribute of the package itself belongs to the root."""
    first = parts[0] if parts else ""
    exists = (PACKAGE / first).is_dir() or (PACKAGE / f"{first}.py").exists()
    return first if exists else ""


def may(importer: tuple[str, ...], imported: tuple[str, ...]) -> bool:
    """Whether one module of the house may import another."""
    here, there = room(importer), room(imported)
    if there == "m2m" and imported[1:2] and imported[1] in AFTER_SYNTHESIS:
        return here in AFTER_SYNTHESIS[imported[1]] | {"m2m", "", "cli"}
    if here == there == "m2t":
        ours, theirs = ("".join(parts[1:2]) for parts in (importer, imported))
        # The list of targets loads each of them when it is asked for.
        return ours in {theirs, "targets"} or (theirs in SHARED and theirs in SHARED.get(ours, SHARED))
    if here in GROUND:
        return there in GROUND[GROUND.index(here) :]
    return here == there or there in GROUND or there in ALLOWED.get(here, set())


def test_no_import_breaks_the_rule() -> None:
    broken = [
        f"{'.'.join(importer)} imports {'.'.join(imported)}"
        for importer, nodes in modules()
        for root, *imported in imports(nodes)
        if root == "robosc" and not may(importer, tuple(imported))
    ]
    assert broken == []


def test_no_rule_imports_another() -> None:
    rules = ("checks", "rules")
    found = [(importer, imported) for importer, nodes in modules() for imported in imports(nodes)]
    assert [pair for pair in found if (pair[0][:2], pair[1][1:3]) == (rules, rules)] == []


#: What the second reading of a robot's text shares with the first: how expressions are computed, and walks over them.
COMMON = {"evaluation", "operators", "walks"}


def test_the_second_reading_shares_nothing_with_the_first() -> None:
    used = {
        tuple(imported)
        for importer, nodes in modules()
        if importer[:3] == ("analysis", "verify", "model_reading")
        for root, *imported in imports(nodes)
        if root == "robosc"
    }
    assert {imported[0] for imported in used} == {"analysis", "metamodel", "semantics"}
    assert {imported[1] for imported in used if imported[0] == "semantics"} == COMMON
    assert {imported[1] for imported in used if imported[0] == "analysis"} == {"verify", "wording", "paths"}


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_stays_in_its_room(library: str) -> None:
    used = {room(importer) for importer, nodes in modules() for name, *_ in imports(nodes) if name == library}
    assert used == LIBRARIES[library]


def test_every_other_library_is_the_standard_one() -> None:
    known = {*LIBRARIES, "robosc", *sys.stdlib_module_names}
    assert {name for _, nodes in modules() for name, *_ in imports(nodes) if name not in known} == set()


#: What opens, makes or moves files, and who may: what others name goes through `files`.
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
OPENERS = {
    "files.reading",
    "files.writing",
    "cli",  # the null device, for streams that are closed
    "cli.format",  # the standard output
    "diagnostics.rules",  # what ships with the tool, here and in those below without a word of their own
    "semantics.naming",
    "synthesis.memory",  # what the kernel tells of the process
    "m2t.ros.packages",
    "metamodel._ecore",
    "cli.view",  # the browser
    "view.page",
    "node_tests.trace_test",
    "runtime.ros2.interfaces",  # a tool of its own, whose files are made for the generators
    "runtime.core.event_log",  # what `files.writing` has opened
    "node_tests.trace_player",  # ships with generated packages, and sees nothing of ours
    "analysis.verify.c_program",  # a temporary folder, here and in the next two
    "analysis.verify.c_exploration",
    "scenario_tests.live",
    "report.digests",  # what ships with the tool
    "report.rendering",
    "extensions",  # what an installed package declares
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


@pytest.mark.parametrize(
    ("importer", "imported"),
    [
        ("language.reading", "checks"),
        ("checks.rule", "m2m"),
        ("synthesis.bdd", "engine"),
        ("m2m.trace", "synthesis"),
        ("m2t.cif", "m2t.ros"),
        ("m2t.targets", "node_tests"),
        ("m2t.ros", "m2t.supervisor"),
        ("m2t.c", "m2t.ros"),
        ("m2t.cif", "m2m"),
        ("m2t.cif", "m2m.robosc_to_sct"),
        ("engine", "m2m.sct_to_cif"),
        ("semantics.typing", "checks"),
        ("semantics.typing", "configuration"),
        ("metamodel.xmi", "validity"),
        ("metamodel.sct", "cli"),
        ("m2t.cif", "cli"),
        ("engine", "runtime"),
        ("runtime", "m2t.ros"),
        ("m2t.ros", "node_tests"),
        ("runtime", "node_tests"),
        ("checks.rule", "__version__"),
    ],
)
def test_the_rule_forbids(importer: str, imported: str) -> None:
    assert not may(tuple(importer.split(".")), tuple(imported.split(".")))


def test_the_rule_allows() -> None:
    for importer, imported in [
        ("m2t.ros", "m2t.c"),
        ("m2t.ros.ros1", "m2t.ros.node"),
        ("m2t.cif", "m2t.models"),
        ("m2t.cif", "configuration"),
        ("m2t.cif", "m2m.sct_to_cif"),
        ("m2t.targets", "m2t.ros"),
        ("m2t.cif.edges", "m2t.cif.names"),
        ("checks.rule", "metamodel"),
        ("validity", "metamodel"),
        ("cli.transform", "language"),
        ("cli", "__version__"),
    ]:
        assert may(tuple(importer.split(".")), tuple(imported.split("."))), f"{importer} -> {imported}"


def arrows() -> list[tuple[tuple[str, ...], tuple[str, ...]]]:
    """The arrows of the page's picture between modules, each module as the parts of its name."""
    picture = PAGE.partition("```mermaid\n")[2].partition("```")[0]
    labels = dict(re.findall(r'(\w+) ?\["(\.?\w+)', picture))
    modules = {node: (name,) if room((name,)) else ("m2m", name) for node, name in labels.items() if name[0] != "."}
    ends = re.findall(r'(\w+)(?:\[".*?"\])? --(?: ".+?" --)?> (\w+)', picture)
    assert len(ends) == picture.count("-->")
    return [
        tuple(modules.get(node, (node,)) for node in pair) for pair in ends if {*pair}.isdisjoint({"rscd", "ciftext"})
    ]


def test_the_picture_has_every_package() -> None:
    assert {module[0] for pair in arrows() for module in pair} == ROOMS - {"cli", "__main__", ""}
    assert [module for pair in arrows() for module in pair if not any(PACKAGE.glob("/".join(module) + "*"))] == []


def test_no_import_goes_along_an_arrow_of_the_picture() -> None:
    assert [(start, end) for start, end in arrows() if start[0] != end[0] and may(start, end)] == []


def test_the_page_names_every_package() -> None:
    packages = {path.name for path in PACKAGE.iterdir() if any(path.glob("*.py"))}
    assert [name for name in packages if f"`robosc/{name}`" not in PAGE] == []
    assert {room(parts) for parts, _ in modules()} == {*ROOMS, *GROUND}


def test_what_the_page_names_is_there() -> None:
    named = set(re.findall(r"`((?:robosc|grammar|metamodel|docs|tests)/[\w./]+)`", PAGE))
    assert len(named) > 40
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


@pytest.mark.parametrize("folder", ["robosc", "tests", "benchmarks", "examples", "scripts"])
def test_variables_are_named_for_what_they_hold(folder: str) -> None:
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted((ROOT / folder).rglob("*.py"))}
    nodes = [(path, node) for path, tree in trees.items() for node in ast.walk(tree)]
    bound = [
        (path, node.lineno, node.arg if isinstance(node, ast.arg) else node.id)
        for path, node in nodes
        if isinstance(node, ast.arg) or (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store))
    ]
    looped = [
        (path, name.lineno, name.id)
        for path, node in nodes
        if isinstance(node, ast.For | ast.AsyncFor | ast.comprehension)
        for name in ast.walk(node.target)
        if isinstance(name, ast.Name)
    ]
    wrong = [(bound, ("each", "one")), (looped, ("told", "said", "what", "some"))]
    assert [
        f"{path.relative_to(ROOT)}:{line}: a variable says what it holds: `edge`, not `{name}`"
        for variables, forbidden in wrong
        for path, line, name in variables
        if name in forbidden
    ] == []
