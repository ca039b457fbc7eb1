"""All regular expressions of the product with their places, and texts that make a backtracking engine slow."""

import ast
import builtins
import importlib
import json
import re
import signal
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import arpeggio
import textx

from robosc.language.highlighting.rules import rules

ROOT = Path(__file__).parents[1]
SCANNING = frozenset({"search", "finditer", "findall", "sub", "subn", "split"})
METHODS = SCANNING | {"match", "fullmatch"}
#: Length of a repetition in characters, and limit of CPU time for one text in seconds. A linear search takes a
#: hundredth of the limit, a quadratic one several times as much as the limit.
LENGTH, SECONDS = 50_000, 0.5
PUMPS = (
    *("/", "*", " ", "\n", "\t", '"', "'", "\\", "[", "]", "(", ")", "{", "}", "<", ">", "_", ".", ":", ";", ",", "^"),
    *(
        "-",
        "0",
        "a",
        "A",
        "//\n",
        "/*",
        "*/",
        "/**/",
        "/* */ ",
        "// \n",
        '\\"',
        '"\\',
        "''",
        '""',
        "()",
        "[]",
        "a ",
        "a.",
    ),
    *("a\n", " \n", "a_", "Aa", "aA", "0.", "<a>", "if ", "end ", "a=''", "é"),
)


@dataclass(frozen=True)
class Expression:
    """A regular expression: its place in the product, and the methods that apply it."""

    place: str
    pattern: str | bytes
    flags: int
    methods: frozenset[str]


class _Anything(str):
    """Placeholder for the value of a local variable in a pattern."""

    __slots__ = ()

    def __getattr__(self, name: str) -> "_Anything":
        return self

    def __call__(self, *_: Any) -> "_Anything":
        return self

    def __getitem__(self, _: Any) -> "_Anything":
        return self


class _Names(dict[str, Any]):
    """The names of a module; each other name is a local variable."""

    def __missing__(self, name: str) -> Any:
        return getattr(builtins, name, _Anything("word"))


def collect() -> list[Expression]:
    """Return all regular expressions of Python code, grammars, colors, schemas, templates and pages."""
    everywhere = (*_python(), *_templates(), *_grammars(), *_colors(), *_schemas(), *_pages())
    return list({(found.pattern, found.flags, found.methods): found for found in everywhere}.values())


def _python() -> Iterator[Expression]:
    trees = {path: ast.parse(path.read_text("utf-8")) for path in sorted((ROOT / "robosc").rglob("*.py"))}
    for path, tree in trees.items():
        calls = [node for node in ast.walk(tree) if _is_call_of_re(node)]
        if not calls:
            continue
        names = _names(path)
        compiled = {
            id(node.value): node.targets[0].id
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
        }
        for call in calls:
            place = f"{path.relative_to(ROOT)}:{call.lineno}"
            pattern = _value(call.args[0], names)
            given = [*call.args[1:2]] if call.func.attr == "compile" else []
            given += [word.value for word in call.keywords if word.arg == "flags"]
            given += [part for part in call.args[2:] if isinstance(part, ast.Attribute) and "re." in ast.unparse(part)]
            flags = sum(int(_value(flag, names)) for flag in given)
            methods = frozenset({call.func.attr} & METHODS)
            if not methods:
                methods = _methods(tree, compiled.get(id(call))) or METHODS
            patterns = _constants(tree) if isinstance(pattern, _Anything) else [pattern]
            yield from (Expression(place, pattern, flags, methods) for pattern in patterns)


def _constants(tree: ast.AST) -> list[str]:
    """Return the constants of a module that are patterns, as possible values of variables."""
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    nodes = (node for node in ast.walk(tree) if isinstance(node, ast.Constant) and id(node) not in parts)
    texts = (node.value for node in nodes if isinstance(node.value, str))
    return [text for text in texts if re.search(r"\\[AZbBdDsSwW]", text) and _is_pattern(text)]


def _is_pattern(text: str) -> bool:
    try:
        re.compile(text)
    except re.error:
        return False
    return True


def _names(path: Path) -> _Names:
    parts = path.relative_to(ROOT).with_suffix("").parts
    try:
        return _Names(vars(importlib.import_module(".".join(parts[:-1] if parts[-1] == "__init__" else parts))))
    except ImportError:  # The module needs a ROS that is not installed.
        return _Names(re=re)


def _value(node: ast.expr, names: _Names) -> Any:
    return eval(compile(ast.Expression(node), "pattern", "eval"), {}, names)  # noqa: S307 - our own source


def _is_call_of_re(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == "re"
        and node.func.attr in {"compile", *METHODS}
    )


def _methods(tree: ast.AST, name: str | None) -> frozenset[str]:
    """Return the methods that a module calls on an expression, or an empty set if there are other uses."""
    uses = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id == name]
    called = [node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and node.value in uses]
    return frozenset(called) if len(called) == len(uses) - 1 and set(called) <= METHODS else frozenset()


def _templates() -> Iterator[Expression]:
    for path in sorted((ROOT / "robosc").rglob("*.py.j2")):
        for found in re.finditer(r"re\.(?:compile|\w*match|search|sub)\((r?\"[^\"\n]*\")", path.read_text("utf-8")):
            yield Expression(str(path.relative_to(ROOT)), ast.literal_eval(found[1]), 0, METHODS)


def _grammars() -> Iterator[Expression]:
    for path in sorted((ROOT / "grammar").glob("*.tx")):
        metamodel = textx.metamodel_from_file(str(path), autokwd=True)
        parser = metamodel._parser_blueprint
        pending, known = [parser.parser_model, parser.comments_model], set()
        while pending:
            node = pending.pop()
            if node is None or id(node) in known:
                continue
            known.add(id(node))
            pending += node.nodes
            if isinstance(node, arpeggio.RegExMatch):
                node.compile()
                place = f"{path.relative_to(ROOT)}: {node.rule_name or node.to_match}"
                yield Expression(place, node.regex.pattern, node.regex.flags & ~re.UNICODE, frozenset({"match"}))


def _colors() -> Iterator[Expression]:
    for rule in rules():
        yield Expression("robosc/language/highlighting/rules.py", rule.pattern, 0, frozenset({"search"}))


def _schemas() -> Iterator[Expression]:
    for path in sorted((ROOT / "robosc" / "schemas").glob("*.json")):
        for found in re.finditer(r'"pattern": ("(?:[^"\\]|\\.)*")', path.read_text("utf-8")):
            yield Expression(str(path.relative_to(ROOT)), json.loads(found[1]), 0, frozenset({"search"}))


def _pages() -> Iterator[Expression]:
    literal = re.compile(
        r"(?:[(,=:!&|?]\s*|\breturn )/(?![*/ ])((?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+)/[dgimsuvy]*(?=\s*[.,;)])"
    )
    for folder in ("web/src", "editors/vscode/src"):
        for path in sorted((ROOT / folder).glob("*.ts")):
            for found in literal.finditer(path.read_text("utf-8")):
                yield Expression(str(path.relative_to(ROOT)), found[1], 0, SCANNING)


# Texts


def slow(expression: Expression) -> str | None:
    """Return a description of the text and method that make an expression slow, or None."""
    compiled = re.compile(expression.pattern, expression.flags)
    methods = sorted(expression.methods - SCANNING) + ["finditer"] * bool(
        expression.methods - {"search", "match", "fullmatch"}
    )
    methods += ["search"] * ("search" in expression.methods and "finditer" not in methods)
    for text in _texts(expression):
        for method in methods:
            if not _is_fast(compiled, method, text):
                return f"{expression.place}: {method} of {expression.pattern!r} in {_short(text)}"
    return None


class _SlowError(Exception):
    pass


def _is_fast(compiled: "re.Pattern[Any]", method: str, text: str | bytes) -> bool:
    def stop(*_: object) -> None:
        raise _SlowError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        found = getattr(compiled, method)(text)
        if method == "finditer":
            deque(found, maxlen=0)
    except _SlowError:
        return False
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    return True


def _texts(expression: Expression) -> Iterator[Any]:
    """Yield repetitions after each beginning of a match, with and without a mismatch at the end."""
    texts = dict.fromkeys(
        before + pump * (LENGTH // len(pump)) + after
        for before in ("", *_beginnings(expression))
        for pump in dict.fromkeys((*PUMPS, *_bodies(expression)))
        for after in ("", "\0")
    )
    for text in texts:
        yield text.encode() if isinstance(expression.pattern, bytes) else text


def _short(text: str | bytes) -> str:
    return f"{text[:40]!r}… {text[-10:]!r}"


@cache
def _parsed(expression: Expression) -> Any:
    return re._parser.parse(expression.pattern, expression.flags)


def _beginnings(expression: Expression) -> list[str]:
    """Return a matching text before each repetition of an expression."""
    found: dict[str, None] = {}
    _walk(_parsed(expression), "", found, {})
    return list(found)


def _bodies(expression: Expression) -> list[str]:
    """Return a matching text for the body of each repetition."""
    bodies: dict[str, None] = {}
    _walk(_parsed(expression), "", {}, bodies)
    return [body for body in bodies if body]


def _walk(nodes: Any, before: str, found: dict[str, None], bodies: dict[str, None]) -> str:  # noqa: C901
    """Return `before` with one text that the nodes match, and record the beginnings and bodies of repetitions."""
    for operation, argument in nodes:
        name = str(operation)
        if name == "LITERAL":
            before += chr(argument)
        elif name == "NOT_LITERAL":
            before += "b" if argument == ord("a") else "a"
        elif name == "ANY":
            before += "a"
        elif name == "IN":
            before += _one(argument)
        elif name in {"MAX_REPEAT", "MIN_REPEAT", "POSSESSIVE_REPEAT"}:
            least, _, body = argument
            found[before] = None
            once = _walk(body, before, found, bodies)
            bodies[once[len(before) :]] = None
            before += once[len(before) :] * max(least, 1)
            found[before] = None
        elif name == "SUBPATTERN":
            before = _walk(argument[3], before, found, bodies)
        elif name == "ATOMIC_GROUP":
            before = _walk(argument, before, found, bodies)
        elif name == "BRANCH":
            ends = [_walk(branch, before, found, bodies) for branch in argument[1]]
            before = ends[0]
        elif name == "ASSERT" and argument[0] > 0:
            before = _walk(argument[1], before, found, bodies)
    return before


def _one(members: Any) -> str:
    """Return a character of a set."""
    options = re.compile(_set(members))
    characters = (*"a0 _A", *map(chr, range(33, 127)), "\n", "é", "\N{ZERO WIDTH SPACE}")
    return next((character for character in characters if options.fullmatch(character)), "a")


def _set(members: Any) -> str:
    text = ""
    for operation, argument in members:
        match str(operation):
            case "NEGATE":
                text += "^"
            case "LITERAL":
                text += re.escape(chr(argument))
            case "RANGE":
                text += f"{re.escape(chr(argument[0]))}-{re.escape(chr(argument[1]))}"
            case "CATEGORY":
                text += {
                    "CATEGORY_SPACE": r"\s",
                    "CATEGORY_NOT_SPACE": r"\S",
                    "CATEGORY_DIGIT": r"\d",
                    "CATEGORY_NOT_DIGIT": r"\D",
                    "CATEGORY_WORD": r"\w",
                    "CATEGORY_NOT_WORD": r"\W",
                }[str(argument)]
    return f"[{text}]"
