"""The lexer for Pygments, which colors texts in Sphinx, MkDocs, LaTeX and terminals: `pygmentize -l robosc`."""

from __future__ import annotations

import re
from typing import Any, ClassVar

from pygments.lexer import RegexLexer, bygroups
from pygments.token import Comment, Keyword, Name, Number, Operator, Punctuation, String, Whitespace

from robosc.language.highlighting.rules import BLOCK_COMMENT, Kind, rules

_TOKENS = {
    Kind.COMMENT: Comment.Single,
    Kind.STRING: String,
    Kind.FLOAT: Number.Float,
    Kind.INTEGER: Number.Integer,
    Kind.DECLARATION: Keyword.Declaration,
    Kind.MODIFIER: Keyword.Pseudo,
    Kind.CONTROL: Keyword,
    Kind.TYPE: Keyword.Type,
    Kind.CONSTANT: Keyword.Constant,
    Kind.DATA: Name.Builtin.Pseudo,
    Kind.WORD_OPERATOR: Operator.Word,
    Kind.FUNCTION: Name.Builtin,
    Kind.UNIT: Keyword.Reserved,
    Kind.DECLARED: Name.Class,
    Kind.NAME: Name,
    Kind.OPERATOR: Operator,
    Kind.PUNCTUATION: Punctuation,
    Kind.BLANK: Whitespace,
}


def _rules() -> list[tuple[str, Any]]:
    begin, end = BLOCK_COMMENT
    patterns: list[tuple[str, Any]] = [(rf"{begin}[\s\S]*?(?:{end}|\Z)", Comment.Multiline)]
    for rule in rules():
        tokens = [_TOKENS[kind] for kind in rule.kinds]
        patterns.append((rule.pattern, tokens[0] if len(tokens) == 1 else bygroups(*tokens)))
    return patterns


class RoboscLexer(RegexLexer):
    """Lexer of `.rscd` files."""

    name = "RoboSC"
    aliases: ClassVar = ["robosc", "rscd"]
    filenames: ClassVar = ["*.rscd"]
    mimetypes: ClassVar = ["text/x-robosc"]
    flags = re.MULTILINE
    tokens: ClassVar = {"root": _rules()}
