"""The words of the language's later editions are not reserved."""

from __future__ import annotations

import pytest

from tests.language.second_edition import running

FUNCTIONS = "abs min max mod floor ceil round sqrt sin cos atan2 hypot size"
WORDS = f"""{FUNCTIONS} all any count in after without ms s each at most since automaton never always reachable property
    constant parameter condition function is then else send change canceled running Failure unavailable rejected timeout
    lost aborted failed unreadable because refuse not msg srv
    assume violated number text limit""".split()
NAMED = """robot {word} {{
  datatype object Data {{ {word}: boolean }}
  interface link use Data from my_msgs
  datatype enum Kind from boolean to {{ value -> {word}_ default -> other }}
  component {word}s {{
    outgoing message told with type: Data links link
    incoming message {word} with type: none
    behaviour {{
      variable kept: boolean
      initial marked state here {{ on response from told do kept := value.{word} goto {word} }}
      marked state {word} {{ on request to {word} if kept goto here }}
    }}
  }}
  requirement {word} needs {word}s.{word} and {word}s.kept
}}"""


@pytest.mark.slow
@pytest.mark.parametrize("word", WORDS)
def test_a_new_word_is_a_name_elsewhere(word: str) -> None:
    """A new word is a keyword only if the next tokens form its construct."""
    engine = running(NAMED.format(word=word))
    assert not engine.enabled(f"message_{word}.c_trigger")
    engine.perform("message_told.u_response", {f"i_response_{word}": True})
    assert engine.state[f"component_{word}s"] == word
    assert engine.enabled(f"message_{word}.c_trigger")


@pytest.mark.parametrize("word", WORDS)
def test_a_new_word_is_the_value_of_an_enum(word: str) -> None:
    """A value after `->` in an enum is a plain name."""
    text = f"""robot R {{
      datatype enum Kind from integer(0..9) to {{ value > 5 -> {word} default -> other }}
      component C {{
        outgoing message told with type: Kind
        incoming message go with type: none
        behaviour {{
          variable {word}_: Kind = other
          initial marked state here {{ on response from told do {word}_ := value }}
        }}
      }}
      requirement go needs C.{word}_ = {word}
    }}"""
    engine = running(text)
    engine.perform("message_told.u_response", {"i_response": word})
    assert engine.enabled("message_go.c_trigger")


def test_an_own_function_hypot_is_called() -> None:
    text = """robot R {
      function hypot(x: integer, y: integer): boolean = x = y
      component C {
        incoming message go with type: none
        behaviour { variable n: integer(0..3) = 2 initial marked state here { on request to go } }
      }
      requirement go needs hypot(C.n, 2)
    }"""
    assert running(text).enabled("message_go.c_trigger")
