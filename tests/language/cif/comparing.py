"""Random specifications beside synthesis by the definition."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from robosc.language.cif import CifReading, read
from robosc.language.text import Documents
from robosc.synthesis import count, synthesize

if TYPE_CHECKING:
    from tests.language.cif.random_specifications import Specification


def reading_of(specification: Specification) -> CifReading:
    """A specification, read from all of its files."""
    files = {str(Path(name).resolve()): text for name, text in specification.files.items()}
    return read(Path("random.cif").resolve(), Documents(files))


def agrees(specification: Specification) -> int | None:
    """The number of states under the supervisor, as it is by the definition; None where synthesis does not take it."""
    reading = reading_of(specification)
    text = "\n".join(specification.files.values())
    if specification.foreign:
        assert specification.foreign in " ".join(finding.message for finding in reading.findings), text
        return None
    # What is drawn may be a value that its variable never has, and CIF's type checker refuses that.
    assert {finding.rule for finding in reading.findings} <= {"type", "cif-construct"}, text
    if reading.model is None:
        return None
    found = synthesize(reading.model).controlled_states
    assert found == specification.controlled_states(), text
    # Which is found in another way, where only the number is asked for.
    assert found == count(reading.model).controlled_states, text
    return found
