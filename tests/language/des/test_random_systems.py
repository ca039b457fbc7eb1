"""Each format has the states of synthesis by its definition, and so has the CIF that is written for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.language.cif import read as read_cif
from robosc.language.des import cif_of, read
from robosc.language.text import Documents
from robosc.synthesis import synthesize
from tests.language.des.writing import Automaton, Edge, System

if TYPE_CHECKING:
    from robosc.model import sct

_EVENTS = {"c1": True, "c2": True, "u1": False, "u2": False}
_GUARDS = ("", "", "x > 0", "x < 2", "x == y", "y <= 1 and x > 0")
_VALUES = {"x": ("x + 1", "x - 1", "2", "y", "x - y"), "y": ("y + 1", "0", "x", "x + y")}


@st.composite
def systems(draw: Any, *, variables: bool) -> System:
    """Return a system whose automata are deterministic."""
    automata = []
    for number in range(draw(st.integers(2, 3))):
        requirement = number == 2 or (number == 1 and draw(st.booleans()))
        states = [f"q{index}" for index in range(draw(st.integers(1, 3)))]
        edges = []
        for state in states:
            for event in _EVENTS:
                if draw(st.booleans()):
                    updates = {}
                    if variables and draw(st.integers(0, 2)) == 0:
                        name = draw(st.sampled_from(["x", "y"]))
                        updates[name] = draw(st.sampled_from(_VALUES[name]))
                    guard = draw(st.sampled_from(_GUARDS)) if variables else ""
                    edges.append(Edge(state, event, draw(st.sampled_from(states)), guard, updates))
        marked = [state for state in states if draw(st.booleans())] or states[-1:]
        forbidden = [state for state in states[1:] if variables and draw(st.integers(0, 5)) == 0]
        automata.append(Automaton(f"A{number}", requirement, states, marked, edges, forbidden))
    return System(_EVENTS, automata, {"x": 3, "y": 2} if variables else {})


def counted(model: sct.SupervisoryControlModel) -> int:
    synthesis = synthesize(model)
    return 0 if synthesis.supervisor is None else synthesis.controlled_states


def check(path: str, files: dict[str, str], states: int) -> None:
    reading = read(path, Documents(files))
    assert [str(finding) for finding in reading.findings] == []
    assert reading.model is not None
    assert counted(reading.model) == states


@pytest.mark.parametrize("suffix", [".gen", ".xmd"])
@given(system=systems(variables=False))
def test_automata_have_their_states(suffix: str, system: System) -> None:
    files = {
        f"/models/{automaton.name}{suffix}": (system.gen if suffix == ".gen" else system.xmd)(automaton)
        for automaton in system.automata
    }
    files["/models/all.automata"] = system.roles(suffix)
    check("/models/all.automata", files, system.controlled_states())


@given(system=systems(variables=True))
def test_modules_have_their_states(system: System) -> None:
    check("/models/all.wmod", {"/models/all.wmod": system.wmod()}, system.controlled_states())


@given(system=systems(variables=True))
def test_the_cif_of_a_module_has_the_same_states(system: System, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.mktemp("module") / "all.wmod"
    path.write_text(system.wmod(), encoding="utf-8")
    model = read(path).model
    assert model is not None
    text = cif_of(model)
    assert text is not None
    written = read_cif(path.with_suffix(".cif"), Documents({str(path.with_suffix(".cif")): text})).model
    assert written is not None
    assert counted(written) == counted(model) == system.controlled_states()
