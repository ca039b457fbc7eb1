"""A supervisor becomes the model's own, unless something of it is missing."""

from robosc.analysis.supervise import supervise
from robosc.diagnostics import has_errors
from tests.synthesis.classics import philosophers


def test_a_supervisor_without_all_its_guards_is_nobodys() -> None:
    """Whoever generated a controller of it would let a robot do what synthesis forbids."""
    whole, short = philosophers(5), philosophers(5)
    assert not has_errors(supervise(whole).findings)
    assert whole.supervisor is not None
    supervision = supervise(short, effort=0)
    assert supervision.synthesis.unwritten
    assert not has_errors(supervision.findings)
    assert short.supervisor is None
