"""Models that are long in one respect: an element that is read, checked or written for each of `n` things.

    python benchmarks/walk_families.py provides 5 FOLDER

writes a robot with five `provide` statements for one message to FOLDER/model.rscd.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

#: Files by their names; the model is `model.rscd` or `model.xmi`.
Files = dict[str, str]

_GO = "component Base {{ incoming message go with type: {} }}"


def _robot(*parts: str) -> Files:
    return {"model.rscd": "\n".join(["robot Long {", *parts, "}", ""])}


def _behaviour(name: str, communications: Iterable[str], *lines: str) -> str:
    return "\n".join([f"component {name} {{", *communications, "behaviour {", *lines, "} }"])


def provides(number: int) -> Files:
    """Provide statements for one message."""
    level = f"integer(0..{number})"
    return _robot(
        _GO.format("integer"),
        _behaviour(
            "Gauge",
            [f"outgoing message level with type: {level}"],
            f"variable height: {level} = 0",
            "initial marked state measuring { on response from level do height := value }",
        ),
        *(f"provide go with {i} if Gauge.height = {i}" for i in range(number)),
    )


def imports(number: int) -> Files:
    """Libraries in a chain of imports."""
    last = _behaviour("Part", [], "initial marked state there { }").replace(
        "behaviour", "incoming message go with type: none behaviour"
    )
    return {
        "model.rscd": "robot Long { component Part from L1 import Part }",
        **{f"l{i}.rscd": f"library L{i} {{ component Part from L{i + 1} import Part }}" for i in range(1, number)},
        f"l{number}.rscd": f"library L{number} {{ {last} }}",
    }


def imports_beside(number: int) -> Files:
    """Libraries that the robot imports directly."""
    return {
        "model.rscd": "\n".join(
            ["robot Long {", *(f"component Part{i} from L{i} import Part" for i in range(number)), "}", ""]
        ),
        **{
            f"l{i}.rscd": f"library L{i} {{ component Part {{ outgoing message m{i} with type: none }} }}"
            for i in range(number)
        },
    }


def members(number: int) -> Files:
    """Nested steps into an object of its own type."""
    return _robot(
        "datatype object Part { inner: Part size: integer(0..9) }",
        "interface Part use Part from parts",
        _GO.format("none"),
        _behaviour(
            "Gauge",
            ["outgoing message part with type: Part links Part"],
            "variable size: double = 0.0",
            f"initial marked state here {{ on response from part do size := value{'.inner' * number}.size }}",
        ),
    )


def operators(number: int) -> Files:
    """Operators in the condition of a requirement."""
    level = f"integer(0..{number})"
    condition = " and ".join(f"Gauge.height != {2 * i}" for i in range(number // 2))
    return _robot(
        _GO.format("none"),
        _behaviour(
            "Gauge",
            [f"outgoing message level with type: {level}"],
            f"variable height: {level} = 1",
            "initial marked state measuring { on response from level do height := value }",
        ),
        f"requirement go needs {condition}",
    )


def namespaces(number: int) -> Files:
    """Namespace prefixes on one element of an XMI file."""
    declared = "".join(f' xmlns:a{i}="urn:a{i}"' for i in range(number))
    return {
        "model.xmi": '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<robosc:Robot xmlns:robosc="urn:robosc:robosc:1" xmlns:xmi="http://www.omg.org/XMI" xmi:version="2.0"'
        f'{declared} name="Long"/>\n'
    }


def states(number: int) -> Files:
    """States of one component, in a ring."""
    ring = (f"state s{i} {{ on response from tick goto s{(i + 1) % number} }}" for i in range(1, number))
    return _robot(
        _GO.format("none"),
        _behaviour(
            "Ring",
            ["outgoing message tick with type: none"],
            "initial marked state s0 { on response from tick goto s1 }",
            *ring,
        ),
        "requirement go needs Ring.s0",
    )


def components(number: int) -> Files:
    """Independent components of eight lines, up to 40,000 lines."""
    return _robot(
        *(
            _behaviour(
                f"Door{i}",
                [f"outgoing message moved{i} with type: none", f"incoming message move{i} with type: none"],
                f"initial marked state closed {{ on response from moved{i} goto open }}",
                f"state open {{ on response from moved{i} goto closed }}",
            )
            for i in range(number)
        ),
        *(f"requirement move{i} needs Door{i}.closed" for i in range(number)),
    )


def lines(number: int) -> Files:
    """Components of ten lines, up to 50,000 lines, and a requirement on an unknown name."""
    return _robot(
        *(
            f"""\
component C{i} {{
  outgoing message m{i} with type: boolean
  incoming message k{i} with type: none
  behaviour {{
    variable v: boolean = false
    initial marked state A {{ on response from m{i} do v := value goto B }}
    state B {{ on response from m{i} do v := value goto A }}
  }}
}}
requirement k{i} needs C{i}.A or C{max(i - 1, 0)}.v"""
            for i in range(number)
        ),
        "requirement Nobody.nowhere needs C0.A",
    )


def topics(number: int) -> Files:
    """Components whose messages share one topic."""
    return _robot(
        *(
            _behaviour(
                f"Part{i}",
                [f'outgoing message seen{i} with identifier: "/seen", type: none'],
                f"initial marked state off {{ on response from seen{i} goto on_{i} }}",
                f"marked state on_{i} {{ on response from seen{i} goto off }}",
            )
            for i in range(number)
        ),
    )


def reactions(number: int) -> Files:
    """Components with two reactions to data, a service, and a parameter that is a time."""
    return _robot(
        *(
            f"""\
parameter pause{i}: integer(1..9) = 3
component Arm{i} {{
  outgoing message length{i} with type: double
  outgoing message busy{i} with type: boolean
  service rest{i} with request: none, response: none
  behaviour {{
    variable length: double = 0.0
    variable busy: boolean = false
    initial marked state idle {{
      on response from length{i} do length := value
      on response from busy{i} do busy := value goto moving
    }}
    state moving {{
      after pause{i} s goto idle
    }}
  }}
}}
requirement rest{i} needs !Arm{i}.busy"""
            for i in range(number)
        ),
    )


def enum_rules(number: int) -> Files:
    """Rules of an enum, each with its own value."""
    return _robot(
        "datatype enum Level from integer to {",
        *(f"value = {i} -> l{i}" for i in range(number)),
        "default -> beyond }",
        _GO.format("none"),
        _behaviour(
            "Gauge",
            ["outgoing message level with type: Level"],
            "variable height: Level",
            "initial marked state measuring { on response from level do height := value }",
        ),
        "requirement go needs Gauge.height = l3",
    )


def requirements(number: int) -> Files:
    """Many requirements on one message, each on few states."""
    return _robot(
        _GO.format("none"),
        _behaviour(
            "Gauge",
            ["outgoing message level with type: integer(0..99)"],
            "variable height: integer(0..99) = 0",
            "initial marked state measuring { on response from level do height := value }",
        ),
        *(f"requirement go needs Gauge.height != {i % 98}" for i in range(number)),
    )


def faults(number: int) -> Files:
    """Unknown names."""
    return _robot(_GO.format("none"), *(f"requirement go needs Nobody.nowhere{i}" for i in range(number)))


FAMILIES: Mapping[str, Callable[[int], Files]] = {
    family.__name__: family
    for family in (
        *(provides, imports, imports_beside, members, operators, namespaces, states, components, lines, topics),
        *(reactions, enum_rules, requirements, faults),
    )
}


def write(family: str, number: int, folder: Path) -> Path:
    """Write the model to a folder; return the path of its main file."""
    files = FAMILIES[family](number)
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder / next(iter(files))


if __name__ == "__main__":
    write(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]))
