"""A name that is a keyword draws one finding; its edits write `^` before the name and mend the text."""

import re

import pytest

from robosc.language.grammar import first_words, pattern
from tests.language.checks.test_automatic_edits import checked

WORDS = re.search(r"\(\?:([a-z|]+)\)", pattern("UnreservedName"))[1].split("|")
BEGINNING = first_words("Definition", "ComponentDefinition", "AutomatonDefinition", "EnumRule")
#: One text for each use of each kind of name, with `KK` for the name.
TEXTS = {
    "outgoing message": """robot R {
  component C {
    outgoing message KK with type: boolean
    incoming message go with type: none
    behaviour {
      variable v: boolean
      initial marked state a {
        on response from KK if value goto b
        on response from KK do v := value goto b
      }
      state b {
        on response from KK
        after 500 ms without KK goto a
      }
    }
  }
  component D {
    outgoing message other with type: none
    behaviour {
      initial marked state x { on response from C.KK goto y }
      marked state y { on response from C.KK
        goto x }
    }
  }
  requirement go needs C.a
}
""",
    "incoming message": """robot R {
  component C {
    incoming message KK with type: boolean
    service other with request: none, response: none
    behaviour { initial marked state a { on request to KK goto b } marked state b { on request to KK goto a } }
  }
  requirement KK needs C.a
  requirement { KK, other } needs C.a
  requirement { other, KK } needs C.a
  requirement KK after other
  requirement other after KK
  requirement at most 3 KK since other
  requirement at most 3 other since KK
  requirement C.a disables KK
  requirement R1: C.KK needs C.a
  requirement R2: KK needs C.a
  provide KK with true
}
""",
    "variable": """robot R {
  component C {
    outgoing message m with type: boolean
    incoming message go with type: none
    behaviour {
      variable KK: boolean
      variable w: boolean
      initial marked state a {
        on response from m if KK do KK := value goto b
        on response from m do w := value, KK := w goto b
      }
      marked state b {
        transition if w and KK goto a
        transition if (KK and w) or !KK do KK := KK
        transition if w = KK goto a
      }
    }
  }
  requirement go needs C.KK
  requirement go needs C.a and C.KK
  requirement C.KK disables go
}
""",
    "state": """robot R {
  component C {
    outgoing message m with type: boolean
    incoming message go with type: none
    behaviour {
      initial marked state KK { on response from m goto b }
      marked state b { on response from m goto KK }
    }
  }
  requirement go needs C.KK
  requirement never C.KK and C.b
  property reachable C.KK
}
""",
    "enum value": """robot R {
  datatype enum E from boolean to { value -> KK default -> other }
  component C {
    outgoing message m with type: E
    incoming message go with type: none
    behaviour {
      variable e: E = KK
      initial marked state a { on response from m do e := value goto b }
      marked state b { on response from m if value = KK goto a transition if e = KK goto a }
    }
  }
  requirement go needs C.e = KK
}
""",
}
#: Words with a meaning of their own in that place: the text is then another one, with other findings.
MEANING = {
    "incoming message": {"and", "or", "if", "error"},
    "variable": {"if", "value", "error"},
    "enum value": {"true", "false", "value", "if", "error"},
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", TEXTS)
def test_one_finding_and_its_edit(kind: str) -> None:
    assert not checked(TEXTS[kind].replace("KK", "kk")).findings
    for word in WORDS if "message" in kind else set(WORDS) & BEGINNING | MEANING.get(kind, set()):
        text = TEXTS[kind].replace("KK", word)
        found = checked(text)
        if kind == "state" and not found.findings:
            continue
        if word in MEANING.get(kind, ()):
            assert found.findings
            continue
        (finding,) = found.findings
        assert finding.hint == f"write `^{word}` to use a keyword as a name", (word, finding)
        assert len(finding.edits) == len(finding.related) + 1
        for _ in range(5):  # The first of several in one item is reported.
            text = found.reading.file.text.after(edit for finding in found.findings for edit in finding.edits)
            found = checked(text)
            if not found.findings:
                break
        assert not found.findings, (word, text)
        assert text.replace("^", "") == TEXTS[kind].replace("KK", word)


def test_a_name_that_is_missing_is_no_keyword() -> None:
    """The next line begins with a keyword, which is not the missing name."""
    text = """robot R {
  component C {
    outgoing message m with type: none
    behaviour {
      initial marked state a { on response from
      }
      state b { }
    }
  }
}
"""
    assert [(finding.span.line, finding.edits) for finding in checked(text).findings] == [(5, ())]
