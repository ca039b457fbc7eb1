"""Templates of whole definitions, for completion and for the snippets of VS Code."""

from __future__ import annotations

import json
from typing import NamedTuple


class Snippet(NamedTuple):
    """A snippet: its name, its text, and the prefix by which VS Code offers it without a server, if any."""

    label: str
    body: str
    prefix: str = ""


#: Snippets by their first word.
SNIPPETS = {
    "robot": [
        Snippet("robot …", "robot ${1:Name} {\n  $0\n}"),
        Snippet(
            "robot that moves while a sensor lets it",
            """\
robot ${1:Gate} {
  component ${2:Lidar} {
    outgoing message ${3:scan} with identifier: "/${3:scan}", type: boolean

    behaviour {
      initial marked state ${4:blocked} {
        on response from ${3:scan} if value goto ${5:free}
      }

      state ${5:free} {
        on response from ${3:scan} if !value goto ${4:blocked}
      }
    }
  }

  component ${6:Base} {
    incoming message ${7:move} with identifier: "/${7:move}", type: none
  }

  requirement ${7:move} needs ${2:Lidar}.${5:free}
}
$0""",
            "robot",
        ),
    ],
    "library": [Snippet("library …", "library ${1:Name} {\n  $0\n}")],
    "component": [
        Snippet(
            "component with states",
            """\
component ${1:Name} {
  outgoing message ${2:told} with identifier: "/${2:told}", type: ${3:boolean}

  behaviour {
    initial marked state ${4:off} {
      on response from ${2:told} goto ${5:on}
    }

    state ${5:on} {
      on response from ${2:told} goto ${4:off}
    }
  }
}$0""",
            "component",
        ),
        Snippet(
            "component that takes commands",
            """\
component ${1:Arm} {
  incoming message ${2:raise} with identifier: "/${2:raise}", type: none
}$0""",
            "command",
        ),
        Snippet(
            "component with a service",
            """\
component ${1:Door} {
  service ${2:open} with identifier: "/${2:open}", request: none, response: boolean

  behaviour {
    initial marked state ${3:closed} {
      on request to ${2:open} goto ${4:opening}
    }

    state ${4:opening} {
      on response from ${2:open} if value goto ${5:opened}
      on response from ${2:open} goto ${3:closed}
      on error from ${2:open} goto ${3:closed}
    }

    marked state ${5:opened} { }
  }
}$0""",
            "service",
        ),
        Snippet("component from a library", "component ${1:Name} from ${2:Library} import ${3:Component}$0"),
    ],
    "requirement": [
        Snippet("requirement … needs", "requirement ${1:communication} needs ${2:condition}$0", "needs"),
        Snippet("requirement … disables", "requirement ${1:condition} disables ${2:communication}$0"),
        Snippet("requirement never", "requirement never ${1:condition}$0", "never"),
        Snippet("requirement reachable", "requirement reachable ${1:condition}$0", "reachable"),
        Snippet(
            "requirement: automaton",
            """\
requirement ${1:Name}: automaton {
  initial state ${2:first} {
    on request to ${3:left} goto ${4:second}
  }

  state ${4:second} {
    on request to ${5:right} goto ${2:first}
  }
}$0""",
            "automaton",
        ),
    ],
    "behaviour": [Snippet("behaviour with a state", "behaviour {\n  initial marked state ${1:name} {\n    $0\n  }\n}")],
    "state": [Snippet("state …", "state ${1:name} {\n  $0\n}")],
    "datatype": [
        Snippet(
            "datatype enum",
            "datatype enum ${1:Name} from ${2:double} to {\n  ${3:value > 0.0} -> ${4:a}\n  default -> ${5:b}\n}$0",
        ),
        Snippet("datatype object", "datatype object ${1:Name} {\n  ${2:field}: ${3:double}\n}$0"),
    ],
    "assume": [Snippet("assume …", "assume ${1:A1}: ${2:event} needs ${3:condition}$0")],
    "limit": [Snippet("limit …", "limit ${1:command} with ${2:data} if ${3:condition}$0")],
    "provide": [Snippet("provide …", "provide ${1:communication} with ${2:data}$0")],
    "on": [Snippet("on response from …", "on response from ${1:communication} goto ${2:state}$0")],
}


def for_vscode() -> str:
    """Return the text of `robosc.json`."""
    known = (snippet for snippets in SNIPPETS.values() for snippet in snippets if snippet.prefix)
    document = {label: {"prefix": prefix, "body": body.split("\n")} for label, body, prefix in known}
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"
