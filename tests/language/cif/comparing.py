"""Compare random specifications with synthesis by the definition."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from robosc.language.cif import CifReading, read
from robosc.language.text import Documents
from robosc.synthesis import count, synthesize

if TYPE_CHECKING:
    from tests.language.cif.random_specifications import Specification


def reading_of(specification: Specification) -> CifReading:
    """Read a specification from all of its files."""
    files = {str(Path(name).resolve()): text for name, text in specification.files.items()}
    return read(Path("random.cif").resolve(), Documents(files))


def agrees(specification: Specification) -> int | None:
    """Compare the number of controlled states with the definition.

    Return this number, or None if synthesis rejects the specification.
    """
    reading = reading_of(specification)
    text = "\n".join(specification.files.values())
    if specification.foreign:
        assert specification.foreign in " ".join(finding.message for finding in reading.findings), text
        return None
    # A random value may be one that its variable never has. CIF's type checker rejects this.
    assert {finding.rule for finding in reading.findings} <= {"type", "cif-construct"}, text
    if reading.model is None:
        return None
    found = synthesize(reading.model).controlled_states
    assert found == specification.controlled_states(), text
    # A different algorithm computes this number if only the number is requested.
    assert found == count(reading.model).controlled_states, text
    return found
