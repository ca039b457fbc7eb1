"""Synthesis of random CIF specifications agrees with the definition, state by state."""

import pytest

from robosc.analysis.supervise import EmptySupervisorError, supervise
from robosc.analysis.verify import Outcome, validate_c, verify_system
from robosc.engine import Engine
from robosc.language.configuration import Configuration
from robosc.m2t import supervisor
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.semantics.start import first_state
from robosc.synthesis import use_encoding
from robosc.synthesis.encoding import Encoding, smallest
from tests.language.cif.comparing import agrees, reading_of
from tests.language.cif.random_specifications import Specification


@pytest.mark.parametrize("start", [0, *(pytest.param(start, marks=pytest.mark.slow) for start in range(20, 60, 20))])
def test_as_many_states_as_by_the_definition(start: int) -> None:
    counts = [agrees(Specification(seed, narrow=seed % 2 == 1)) for seed in range(start, start + 20)]
    assert counts.count(None) < 10
    assert any(counts)


def supervised(seed: int) -> sct.SupervisoryControlModel | None:
    """Return a random specification with its supervisor; None if it is rejected or has none."""
    model = reading_of(Specification(seed)).model
    if model is None:
        return None
    try:
        supervise(model)
    except EmptySupervisorError:
        return None
    return model


@pytest.mark.slow
def test_what_verify_says_of_them_and_where_they_start() -> None:
    models = [model for seed in range(80) if (model := supervised(seed)) is not None]
    assert len(models) >= 20
    for model in models:
        refuted = [verdict.property for verdict in verify_system(model) if verdict.outcome is Outcome.REFUTED]
        assert set(refuted) <= {"given supervisor"}
        start = first_state(model)
        codes = {element: value - smallest(element) for element, value in start.items()}

        def is_initial(encoding: Encoding) -> bool:
            good = encoding.initial & encoding.holds(model.supervisor.initial) & encoding.state(codes)  # noqa: B023
            return bool(good.satisfiable())

        assert use_encoding(model, is_initial)
        engine = Engine(model)
        for plant in model.plants:
            assert engine.location(plant) == start[plant]


@pytest.mark.slow
def test_given_supervisors_suffice_as_by_the_definition() -> None:
    sufficient = []
    for seed in range(0, 800, 4):
        specification = Specification(seed)
        model = reading_of(specification).model
        if model is None or not model.supervised:
            continue
        try:
            supervision = supervise(model)
        except EmptySupervisorError:
            assert not specification.suffices()
            continue
        flaws = [finding for finding in supervision.findings if finding.rule == "given-supervisor"]
        outcomes = {verdict.property: verdict.outcome for verdict in verify_system(model)}
        is_sufficient = specification.suffices()
        assert not flaws if is_sufficient else flaws, specification.text
        assert outcomes["given supervisor"] is (Outcome.PROVED if is_sufficient else Outcome.REFUTED)
        sufficient.append(is_sufficient)
    assert sufficient.count(True) > 3
    assert sufficient.count(False) > 3


@pytest.mark.build
@pytest.mark.slow
def test_their_supervisors_in_c_do_what_they_say() -> None:
    models = [model for seed in range(24) if (model := supervised(seed)) is not None]
    outcomes = {validate_c(model, supervisor.generate(Models(model), Configuration())).outcome for model in models}
    assert Outcome.PROVED in outcomes
    assert outcomes <= {Outcome.PROVED, Outcome.SKIPPED}
