"""The editor's answers, in the process of the tests."""

from collections.abc import Iterator

import pytest

from robosc.tools.editor import project


@pytest.fixture(scope="session", autouse=True)
def garbage_is_left_to_python() -> Iterator[None]:
    """The server looks for garbage now and then; here it would look through all that the tests have loaded."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(project, "_COLLECTED", 10_000)
        yield
