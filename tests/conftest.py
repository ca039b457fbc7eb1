"""Fixtures and hooks of all tests: golden files beside their inputs, shared results, and the order of the tests.

`pytest --accept` writes new golden files. The tests of a file run in one process, unless
`pytest_collection_modifyitems` of its folder assigns other groups.
"""

import gc
import json
import pickle
import signal
from base64 import b64decode, b64encode
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from functools import cache, lru_cache
from importlib import import_module
from itertools import chain, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import settings

from robosc.analysis.verify import verify
from robosc.engine import cache_results
from robosc.language import grammar, recovery
from robosc.language.configuration import Configuration
from robosc.m2t.models import TraceTest
from robosc.model.rosgraph import RosGraph
from robosc.run.node_tests.trace_test import trace_test
from robosc.tools.cli import main
from tests.examples.conftest import SCENARIOS
from tests.searching import examples, less_effort
from tests.sharing import made_once

#: Characters of a text from which on its tree is not cached.
LONG_TEXT = 20_000
#: Maximum number of characters of a parameter in the name of a test.
LONGEST = 80
#: Fixtures of slow tests, which wait for a browser or a registry of packages.
WAITED_FOR = {"chromium", "wheel"}
ROS, GENERATORS = Path(__file__).parent / "ros", Path(__file__).parent / "m2t"

# Benchmarks measure time, so a busy machine fails no test. `benchmarks/search.py` tries more examples.
settings.register_profile("robosc", deadline=None, max_examples=examples(50))
settings.register_profile("ci", settings.get_profile("ci"), max_examples=examples(50))
settings.load_profile("robosc")
# In the background of a script, this process ignores interrupts; the programs that the tests start must not.
signal.signal(signal.SIGINT, signal.default_int_handler)
# The tests create many permanent objects. The default frequency of garbage collection takes a fifth of the time.
gc.set_threshold(300_000, 10, 10)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--accept", action="store_true", help="write what the tests produce as the new golden files")


def pytest_make_parametrize_id(val: object) -> str | None:
    """Return the beginning of a long parameter as its name; pytest numbers equal names."""
    if not isinstance(val, str | bytes) or len(val) <= LONGEST:
        return None
    text = val if isinstance(val, str) else val.decode("latin-1")
    return text[:LONGEST].encode("unicode_escape").decode("ascii") + "..."


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Pass the shared folder to a process of pytest-xdist."""
    node.workerinput["shared_folder"] = str(node.config.stash[_SHARED])


_SHARED = pytest.StashKey[Path]()


def pytest_configure(config: pytest.Config) -> None:
    remember_trees(config)
    given = getattr(config, "workerinput", {}).get("shared_folder")
    if given is None:
        temporary = TemporaryDirectory(prefix="robosc-tests-", ignore_cleanup_errors=True)
        config.add_cleanup(temporary.cleanup)
        given = temporary.name
    config.stash[_SHARED] = Path(given)


def remember_trees(config: pytest.Config) -> None:
    """Cache the parse trees of the last texts in each process, because many tests read the same few robots.

    Building a model does not change a tree. Long texts have large trees, which are not cached.
    """
    known = lru_cache(64)(grammar.parse)
    patch = pytest.MonkeyPatch()
    patch.setattr(recovery, "parse", lambda text, rule: (known if len(text) < LONG_TEXT else grammar.parse)(text, rule))
    config.add_cleanup(patch.undo)


@pytest.fixture(scope="session")
def shared_folder(pytestconfig: pytest.Config) -> Path:
    """Return the folder that all processes of a test run share: see `tests.sharing`."""
    return pytestconfig.stash[_SHARED]


@pytest.fixture(scope="session")
def verified_once(shared_folder: Path) -> Callable[[Path], Callable[..., Any]]:
    """Return a replacement of `verify` for a model, which verifies the model once in a run of the tests.

    It verifies the robots of the thesis scenarios with the full effort.
    """

    def once(path: Path) -> Callable[..., Any]:
        def asked(*arguments: Any) -> Any:
            def made() -> str:
                with nullcontext() if path.stem in SCENARIOS else less_effort():
                    return b64encode(pickle.dumps(verify(*arguments))).decode("ascii")

            known = made_once(shared_folder, f"verdicts-{path.parent.name}-{path.stem}", made)
            return pickle.loads(b64decode(known))  # noqa: S301 - our own

        return asked

    return once


@pytest.fixture(scope="session")
def verified(shared_folder: Path, verified_once: Callable[[Path], Callable[..., Any]]) -> Callable[[Path], Any]:
    """Return the output of `verify --json` for a model without refuted properties, computed once in a test run."""

    def asked(path: Path) -> str:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(import_module("robosc.tools.cli.verify"), "verify", verified_once(path))
            done = CliRunner().invoke(main, ["verify", "--json", str(path)])
        assert done.exit_code == 0, done.output
        return done.stdout

    @cache
    def answer(path: Path) -> Any:
        return json.loads(made_once(shared_folder, f"verified-{path.parent.name}-{path.stem}", lambda: asked(path)))

    return answer


@pytest.fixture(scope="session")
def planned_once(shared_folder: Path) -> Callable[[Path, RosGraph, Configuration], list[TraceTest]]:
    """Return the results of `trace_test` for a model and its settings, for ROS 1 and 2, computed once in a run."""

    def once(path: Path, graph: RosGraph, settings: Configuration) -> list[TraceTest]:
        def made() -> str:
            with cache_results():
                return b64encode(pickle.dumps([trace_test(graph, settings, version) for version in (1, 2)])).decode()

        known = made_once(shared_folder, f"tours-{path.parent.name}-{path.stem}", made)
        tests: list[TraceTest] = pickle.loads(b64decode(known))  # noqa: S301 - our own
        return tests

    return once


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Alternate tests over ROS, which mostly wait, with other long tests, so that no core is idle.

    Tests with the workspace of ROS 1 come in the middle, because its build runs meanwhile. Short tests at the end keep
    all processes busy. The hook runs before xdist reads the groups, and after the hook of `tests/ros`.
    """
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.name))
    long = {item.path for item in items if item.get_closest_marker("slow") or item.get_closest_marker("build")}
    turns: list[list[pytest.Item]] = [[], [], [], [], []]
    for item in items:
        turns[_turn(item, item.path in long)].append(item)
    over_ros, generated, over_what_is_built, long_ones, last = turns
    waiting, working = _groups(over_ros), _groups([*generated, *long_ones])
    middle = len(waiting) // 2
    waiting[middle:middle] = _groups(over_what_is_built)
    pairs = zip_longest(waiting, working, fillvalue=())
    items[:] = chain.from_iterable([*chain.from_iterable(pairs), last])


def pytest_collection_finish() -> None:
    """Exclude the objects of the collection phase from garbage collection."""
    gc.freeze()


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish() -> None:
    """Collect garbage once: pytest would collect it five times at its end to report unraisable exceptions."""
    gc.collect()
    gc.freeze()


def _turn(item: pytest.Item, is_long: bool) -> int:
    room = _room(item.path)
    if room == ROS:
        return 2 if item.get_closest_marker("build") else 0
    if room == GENERATORS or not WAITED_FOR.isdisjoint(getattr(item, "fixturenames", ())):
        return 1
    return 3 if is_long else 4


def _groups(items: list[pytest.Item]) -> list[Sequence[pytest.Item]]:
    """Return the items in the groups that xdist assigns to processes."""
    groups: dict[str, list[pytest.Item]] = {}
    for item in items:
        (mark, *_) = item.iter_markers("xdist_group")
        groups.setdefault(mark.args[0], []).append(item)
    return list(groups.values())


@cache
def _room(path: Path) -> Path | None:
    return next((room for room in (ROS, GENERATORS) if room in path.parents), None)


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[Path, str], None]:
    """Return `golden(path, text)`, which fails unless the file at `path` has exactly this text."""

    def compare(path: Path, text: str) -> None:
        if request.config.getoption("--accept"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text.encode())
        if not path.exists():
            pytest.fail(f"{path} is missing: pytest --accept writes it")
        assert text == path.read_bytes().decode(), f"{path} differs: pytest --accept where that is meant"

    return compare
