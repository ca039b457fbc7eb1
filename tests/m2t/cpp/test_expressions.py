"""Expressions of the C++ node have the values or faults of the Python reference."""

from __future__ import annotations

import math
import random
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import robosc
from robosc.base.diagnostics import Severity
from robosc.engine import Engine
from robosc.m2t.ros.expressions import CppPrinter
from robosc.m2t.ros.names import CppNames
from robosc.model.semantics.operators import UnreadableError
from robosc.run.runtime.core.node_data import NodeData

pytestmark = pytest.mark.build

INCLUDE = Path(robosc.__file__).parent / "m2t" / "ros" / "include"
#: Expressions by the type of their value, grouped by the language's rules.
EXPRESSIONS = {
    # `if C then A else B`
    "integer": [
        "if value.x < 0.0 then 1 else value.i",
        "(if value.x < 0.0 then 2 else 3) + (if value.i > 2 then 1 else 2)",
        # `abs min max` (integers or doubles), `mod(a, b)`
        "abs(value.i)",
        "min(value.i, 3) - max(value.i, -2)",
        "mod(value.i, 3) + abs(-7)",
        # `floor ceil round` (double to integer, halves away from zero); NaN cannot be read; results saturate at 32 bits
        "floor(value.x)",
        "ceil(value.x)",
        "round(value.x)",
        "round(value.i / 2)",
        "floor(value.x * 10000000000.0)",
        # `size(a)` (arrays, strings)
        "size(value.a)",
        "size(value.text) + size(value.flags)",
        # slices `a[i..j]` (both ends included; empty where `j < i`), past the end
        "size(value.a[1..2])",
        "size(value.a[2..1])",
        "size(value.a[value.i..value.i + 1])",
        "size(value.a[0..3][1..2])",
        "value.n[0..2][1]",
        # An index below 0 or past the end
        "value.n[value.i]",
        "value.n[k + value.n[0]]",
        "count r in value.n: r > 1",
        "count p in value.poses: (all t in p.tags: t > 0) and p.x < 1.0",
        "min(value.n) + max(value.n[1..size(value.n) - 1])",
    ],
    "double": [
        "abs(value.x)",
        "min(value.x, value.i)",
        "max(1, value.x / 0)",
        "sqrt(value.x)",
        "sin(value.x) + 0.0",
        "cos(value.i) + 0.0",
        "atan2(value.x, value.i) + 0.0",
        "hypot(value.x, value.i) + 0.0",
        "double(value.i) / 3",
        # `min(a)` and `max(a)` skip NaN; `min` of an empty array cannot be read
        "min(value.a)",
        "max(value.a[0..1])",
        "value.poses[size(value.poses) - 1].x",
        "if value.i = 0 then 0.5 else value.a[value.i]",
    ],
    "boolean": [
        # `all` of an empty array is true
        "all r in value.a: r > 0.0",
        "any r in value.a[0..2]: r < 0.5 and r > -1.0 or value.i = 7",
        "any p in value.poses: p.x > 0.0 and (any t in p.tags: t = value.i)",
        "all f in value.flags: f",
        # evaluation from left to right with short circuits
        "value.i > 0 and value.n[2] > 0",
        "value.i > 0 => value.a[0] < 1.0",
        "size(value.n) > 0 and (all r in value.n: r = 0 or value.n[r] > 0)",
        "any q in value.n: any r in value.n: q < r",
        'value.text = "ab" or (any r in value.n: floor(value.x / r) = 1)',
    ],
}
COUNT = sum(map(len, EXPRESSIONS.values()))


def model() -> str:
    variables, assignments = [], []
    for kind, texts in EXPRESSIONS.items():
        for text in texts:
            name = f"v{len(variables)}"
            variables.append(f"variable {name}: {kind}")
            assignments.append(f"{name} := {text}")
    return f"""robot Values {{
  interface All use All from some_msgs
  datatype object Pose {{ x: double tags: array(integer) }}
  datatype object All {{
    a: array(double) n: array(integer) flags: array(boolean) poses: array(Pose) text: string x: double i: integer
  }}
  component C {{
    outgoing message all with identifier: "/all", type: All links All
    behaviour {{
      variable k: integer = 1
      {" ".join(variables)}
      initial marked state here {{ on response from all do {", ".join(assignments)} }}
    }}
  }}
}}"""


def message(chosen: random.Random) -> dict[str, Any]:
    def doubles() -> list[float]:
        return [
            chosen.choice([0.0, -0.0, 0.5, -2.5, 1.5, 3e9, math.nan, math.inf])
            for _ in range(chosen.choice((0, 1, 3, 5)))
        ]

    def integers() -> list[int]:
        return [chosen.randrange(-1, 4) for _ in range(chosen.choice((0, 1, 3, 5)))]

    return {
        "a": doubles(),
        "n": integers(),
        "flags": [chosen.random() < 0.7 for _ in range(chosen.randrange(3))],
        "poses": [{"x": chosen.choice((0.5, 2.0)), "tags": integers()} for _ in range(chosen.randrange(3))],
        "text": chosen.choice(["", "ab", "hé"]),
        "x": chosen.choice([0.0, 0.5, -0.5, 1.5, -2.5, 0.49999999999999994, 1e300, math.nan, -math.inf, 12.0]),
        "i": chosen.choice([0, 1, 2, 4, 7, -1, -3, 2**31 - 1]),
    }


def literal(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return f'"{value}"'
        case float():
            return (
                "NAN"
                if math.isnan(value)
                else f"{'-' if value < 0 else ''}INFINITY"
                if math.isinf(value)
                else repr(value)
            )
        case list() | dict():
            return f"{{{', '.join(map(literal, value.values() if isinstance(value, dict) else value))}}}"
    return str(value)


def record(value: Any) -> Any:
    if isinstance(value, dict):
        return SimpleNamespace(**{name: record(inner) for name, inner in value.items()})
    return [record(inner) for inner in value] if isinstance(value, list) else value


PROGRAM = """#include <iostream>
#include "robosc/json.hpp"
#include "robosc/data.hpp"
using namespace robosc;
struct Pose { double x; std::vector<std::int32_t> tags; };
struct Message {
  std::vector<double> a; std::vector<std::int32_t> n; std::vector<bool> flags; std::vector<Pose> poses;
  std::string text; double x; std::int64_t i;
};
struct { struct { Integer k = 1; } C; } data_;
template <typename Value> void show(const Value& value) {
  if constexpr (std::is_same_v<Value, double>) std::printf("%.17g\\n", value);
  else std::cout << to_json(value) << std::endl;
}
int main() {
  std::cout.setf(std::ios::unitbuf);
  std::setvbuf(stdout, nullptr, _IONBF, 0);
  const Message messages[] = {@MESSAGES@};
  for (const Message& message : messages) {
@EXPRESSIONS@
  }
}
"""


def test_values_in_cpp_are_those_in_python(tmp_path: Path) -> None:
    robot = robosc.load(text=model())
    assert [finding for finding in robosc.check(robot) if finding.severity != Severity.WARNING] == []
    sct = robosc.to_sct(robot)
    graph = robosc.to_rosgraph(robot)
    robosc.synthesize(sct)
    (reaction,) = graph.reactions
    chosen = random.Random(12)  # noqa: S311  # the same each time
    messages = [message(chosen) for _ in range(300)]
    data = NodeData(graph, Engine(graph.model))
    wanted: list[Any] = []
    for given in messages:
        for assignment in reaction.assignments:
            try:
                wanted.append(data.value(assignment.value, record(given)))
            except UnreadableError as fault:
                wanted.append(str(fault))
    assert 100 < sum(isinstance(value, str) for value in wanted) < len(wanted) / 2
    printer = CppPrinter(CppNames(graph))
    lines = [
        f"    {{ [[maybe_unused]] ArrayReader read; const {kind} value = {printer(assignment.value)};\n"
        f"      if (read.complete()) show(value); else std::cout << read.fault() << std::endl; }}"
        for assignment, kind in zip(
            reaction.assignments,
            [
                {"integer": "Integer", "boolean": "bool"}.get(kind, kind)
                for kind in EXPRESSIONS
                for _ in EXPRESSIONS[kind]
            ],
            strict=True,
        )
    ]
    text = PROGRAM.replace("@MESSAGES@", ",\n".join(map(literal, messages))).replace("@EXPRESSIONS@", "\n".join(lines))
    (tmp_path / "values.cpp").write_text(
        text.replace("#include <iostream>", "#include <cstdio>\n#include <iostream>\n#include <vector>")
    )
    warnings = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]
    command = ["g++", "-std=c++17", *warnings, f"-I{INCLUDE}", "values.cpp", "-o", "values"]
    subprocess.run(command, cwd=tmp_path, check=True)
    found = subprocess.run([tmp_path / "values"], capture_output=True, text=True, check=True).stdout.splitlines()
    assert len(found) == len(wanted) == COUNT * len(messages)
    texts = [text for kind in EXPRESSIONS.values() for text in kind]
    for number, (is_, should_be) in enumerate(zip(found, wanted, strict=True)):
        assert same(is_, should_be, texts[number % COUNT]), (
            texts[number % COUNT],
            messages[number // COUNT],
            is_,
            should_be,
        )


def same(found: str, wanted: Any, text: str) -> bool:
    if isinstance(wanted, float) and "n" not in found.strip("-infa").lower():
        close = any(function in text for function in ("sin", "cos", "atan2", "hypot"))
        value = float(found)
        if math.isnan(wanted) or math.isnan(value):
            return math.isnan(wanted) and math.isnan(value)
        # These functions may differ by one unit in the last place; 0 and -0 must not be confused.
        return math.copysign(1, value) == math.copysign(1, wanted) and (
            value == wanted or (close and abs(value - wanted) <= math.ulp(wanted))
        )
    return found == (str(wanted).lower() if isinstance(wanted, bool) else str(wanted))
