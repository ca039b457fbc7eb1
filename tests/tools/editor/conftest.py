"""The editor's answers, in the tests' process."""

from collections.abc import Iterator

import pytest

from robosc.tools.editor import project


@pytest.fixture(scope="session", autouse=True)
def garbage_is_left_to_python() -> Iterator[None]:
    """Turn off the server's garbage collection, which would traverse all objects that the tests have loaded."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(project, "_COLLECTED", 10_000)
        yield
