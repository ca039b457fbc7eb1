"""Issue 13: random CIF specifications agree with synthesis by the definition, state by state."""

from pathlib import Path

import pytest

from robosc.cif import read
from robosc.diagnostics import Diagnostic
from robosc.language.text import Documents
from robosc.synthesis import synthesize
from tests.cif.random_specifications import Specification


def controlled_states(text: str) -> tuple[int | None, list[Diagnostic]]:
    """The number of states under the supervisor, None where the specification is refused, and what is wrong then."""
    path = Path("random.cif").resolve()
    reading = read(path, Documents({str(path): text}))
    return None if reading.model is None else synthesize(reading.model).controlled_states, reading.findings


@pytest.mark.parametrize("start", range(0, 120, 20))
def test_as_many_states_as_by_the_definition(start: int) -> None:
    counts = []
    for seed in range(start, start + 20):
        specification = Specification(seed)
        found, refused = controlled_states(specification.text)
        # What is drawn may be a value that its variable never has, and CIF's type checker refuses that.
        assert {finding.rule for finding in refused} <= {"type", "cif-construct"}, specification.text
        if found is not None:
            assert found == specification.controlled_states(), specification.text
            counts.append(found)
    assert len(counts) > 10
    assert any(counts)
