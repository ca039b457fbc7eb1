"""What all tests share: golden files, kept beside their inputs and accepted anew with `pytest --accept`."""

import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

# Time is measured in benchmarks; a busy machine fails no test.
settings.register_profile("robosc", deadline=None)
settings.load_profile("robosc")
# Whoever runs the tests in the background of a script ignores interrupts; the programs that they start don't.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--accept", action="store_true", help="write what the tests produce as the new golden files")


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Callable[[Path, str], None]:
    """`golden(path, text)` fails where the file at `path` has not exactly this text."""

    def compare(path: Path, text: str) -> None:
        if request.config.getoption("--accept"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text.encode())
        if not path.exists():
            pytest.fail(f"{path} is missing: pytest --accept writes it")
        assert text == path.read_bytes().decode(), f"{path} differs: pytest --accept where that is meant"

    return compare
