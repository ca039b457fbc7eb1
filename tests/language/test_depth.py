"""Reading and layout need no more than Python's default recursion limit, also on a small stack."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = """
import sys
import threading
from robosc.language.reading import read
from robosc.language.text import Documents
from robosc.language.formatting import format_text
from robosc.language.text import decode
from robosc.language.tokens import DEEPEST, LONGEST

def nested(opening, closing, count, core):
    return opening * count + core + closing * count

def needing(condition):
    return f"robot R {{ component A {{ outgoing message m with type: none }} requirement A.m needs {condition} }}"

def declaring(kind):
    return f"robot R {{ component A {{ outgoing message m with type: {kind} }} }}"

def providing(value):
    return f"robot R {{ component A {{ outgoing message m with type: none }} provide A.m with {value} }}"

deep = DEEPEST - 2  # braces of the robot and of the object around
CHOICES = [
    nested("if true then true else ", "", deep, "true"),
    nested("if true then ", " else true", deep, "true"),
    nested("if ", " then true else true", deep, "true"),
    nested("if true then (true) else (", ")", deep // 2, "true"),
]
FINE = [
    needing(" and ".join(["true"] * LONGEST)),
    needing(" => ".join(["true"] * LONGEST)),
    needing(" = true and ".join(["true"] * (LONGEST // 2))),
    needing(nested("(", ")", deep, "true")),
    needing(nested("!(", ")", deep // 2, "true")),
    needing(nested("(true and ", ")", deep, "true")),
    needing(nested("!", "", deep, "true")),
    declaring(nested("array(", ")", deep - 1, "double")),
    providing(nested("{ a: ", "}", deep, "1")),
    *map(needing, CHOICES),
    needing(" and ".join(["(if true then true else true)"] * 200)),
    "robot R { datatype object O { %s } }" % " ".join(f"any{n}: double count{n}: boolean" for n in range(100)),
]
TOO_DEEP = [
    needing(nested("(", ")", 5000, "true")),
    needing(nested("!", "", 5000, "true")),
    needing(nested("(", "", 5000, "")),
    declaring(nested("array(", ")", 5000, "double")),
    providing(nested("{ a: ", "}", 5000, "1")),
    "robot R " + "{" * 5000,
    *(needing(nested(*choice, 5000, "true")) for choice in (
        ("if true then true else ", ""),
        ("if true then ", " else true"),
        ("if ", " then true else true"),
        ("all x in value: ", ""),
        ("any A: ", ""),
    )),
    *(needing(nested(*choice, DEEPEST + 1, "true")) for choice in (
        ("if true then true else ", ""), ("if true then ", " else true"), ("any A: ", "")
    )),
]
done = []

def run():
    for text in FINE:
        assert not read("r.rscd", documents=Documents({"r.rscd": text})).findings, text[:300]
        assert format_text(decode("r.rscd", text.encode())[0])[0] is not None
    for text in TOO_DEEP:
        findings = read("r.rscd", documents=Documents({"r.rscd": text})).findings
        assert findings and all(finding.span.line == 1 for finding in findings), text[:300]
        assert format_text(decode("r.rscd", text.encode())[0])[0] is None
    done.append(sys.getrecursionlimit())

before = sys.getrecursionlimit()
threading.stack_size(512 * 1024)
thread = threading.Thread(target=run)
thread.start()
thread.join()
assert done == [before], done
"""


@pytest.mark.slow
def test_depth_is_bounded_by_the_parser() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
