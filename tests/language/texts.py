"""Reads texts that tests write down."""

from pathlib import Path
from textwrap import dedent

from robosc.language.reading import Reading, read


def reading(folder: Path, text: str, **libraries: str) -> Reading:
    """What comes of a text that stands in a file `model.rscd`, beside libraries in files of other names."""
    for name, content in {"model": text, **libraries}.items():
        (folder / f"{name}.rscd").write_text(dedent(content).strip("\n"), encoding="utf-8")
    return read(folder / "model.rscd")


def places(found: Reading) -> list[tuple[str, int, str]]:
    """File, line and rule of each finding."""
    return [(Path(finding.file).name, finding.span.line, finding.rule) for finding in found.findings]


def underlined(found: Reading) -> list[tuple[str, str]]:
    """The rule of each finding and the text that it stands at."""
    texts = []
    for finding in found.findings:
        lines = found.texts[finding.file].split("\n")
        assert finding.span.line == finding.span.end_line
        texts.append(
            (finding.rule, lines[finding.span.line - 1][finding.span.column - 1 : finding.span.end_column - 1])
        )
    return texts
