"""Events with generated names are described by their statement and its line."""

from pathlib import Path

from click.testing import CliRunner

import robosc
from robosc.analysis.paths import TraceStep
from robosc.analysis.supervise import supervise
from robosc.analysis.wording import describe_event, in_words
from robosc.language.configuration import Configuration
from robosc.m2t import cif, supervisor
from robosc.m2t.models import Models
from robosc.model import sct
from robosc.model.semantics.roles import Roles, event_name
from robosc.tools.cli import main

MODEL = """robot Courier {
  component Base {
    outgoing message seen with identifier: "/seen", type: none
    incoming message speed with identifier: "/speed", type: integer(0..9)

    behaviour {
      initial marked state far { on response from seen goto near }
      marked state near { transition goto far }
    }
  }

  provide speed with 1 if Base.near
  provide speed with 9
}
"""
SERVED = """robot Office {
  interface switch use SetBool from std_srvs
  datatype object Answer { success: boolean }

  component Desk {
    outgoing service order with identifier: "/order", request: none, response: Answer links switch

    behaviour { initial marked state idle { on response to order } }
  }

  requirement order needs value.success
}
"""
TOLD = {
    "message_seen.u_response": "",
    "message_speed.c_trigger": "",
    "component_Base.c_tau1": " (transition of `Base` in line 8)",
    "data_speed.c_d1": " (choice of `provide` 1 for `Base.speed` in line 12)",
    "data_speed.c_d2": " (choice of `provide` 2 for `Base.speed` in line 13)",
    "data_speed.c_none": " (choice of no data for `Base.speed`)",
}


def models(folder: Path, text: str = MODEL) -> Models:
    file = folder / "courier.rscd"
    file.write_text(text)
    graph = robosc.to_rosgraph(robosc.load(str(file)))
    supervise(graph.model)
    return Models(graph.model, graph)


def test_what_a_person_reads_for_an_event(tmp_path: Path) -> None:
    events = Roles(models(tmp_path).sct).events
    assert {event_name(event): describe_event(event) for event in events} == {
        name: name + words for name, words in TOLD.items()
    }


def test_simulate_tells_it(tmp_path: Path) -> None:
    models(tmp_path)
    answer = CliRunner().invoke(main, ["simulate", str(tmp_path / "courier.rscd")], input="e\nd\nq\n")
    for name in ("data_speed.c_d1", "data_speed.c_d2", "component_Base.c_tau1"):
        assert name + TOLD[name] in answer.stdout


def test_generated_texts_tell_the_statement_and_no_line(tmp_path: Path) -> None:
    """A comment in the model therefore changes nothing in them."""
    generators = (cif.generate, supervisor.generate)
    texts = [generate(models(tmp_path), Configuration()) for generate in generators]
    told = "\n".join(text for told_texts in texts for text in told_texts.values())
    assert '@doc("The choice of provide 2 for Base.speed.")\n  controllable c_d2;\n' in told
    assert "Base.speed is to be sent with the data of `provide` 1, if Base.near." in told
    assert "Base.speed is to be sent with the data of `provide` 2." in told
    assert "Base.speed is to be sent without data." in told
    commented = models(tmp_path, f"// a comment\n\n{MODEL}")
    assert [generate(commented, Configuration()) for generate in generators] == texts


def test_the_data_of_an_answer_has_the_name_of_its_field(tmp_path: Path) -> None:
    events = models(tmp_path, SERVED).sct
    answer = next(event for event in Roles(events).events if event.kind == sct.EventKind.reply)
    step = TraceStep(event_name(answer), {answer.inputs[0].name: True})
    assert in_words([step], events) == "response to `Desk.order` (success = true)"
