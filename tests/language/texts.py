"""Read the texts that tests contain."""

from pathlib import Path
from textwrap import dedent

from robosc.language.reading import Reading, read


def reading(folder: Path, text: str, **libraries: str) -> Reading:
    """Write a text to `model.rscd` and libraries beside it, and read the model."""
    for name, content in {"model": text, **libraries}.items():
        (folder / f"{name}.rscd").write_text(dedent(content).strip("\n"), encoding="utf-8")
    return read(folder / "model.rscd")


def places(found: Reading) -> list[tuple[str, int, str]]:
    """Return file, line and rule of each finding."""
    return [(Path(finding.file).name, finding.span.line, finding.rule) for finding in found.findings]


def underlined(found: Reading) -> list[tuple[str, str]]:
    """Return the rule of each finding and the text at its position."""
    texts = []
    for finding in found.findings:
        lines = found.texts[finding.file].split("\n")
        assert finding.span.line == finding.span.end_line
        texts.append(
            (finding.rule, lines[finding.span.line - 1][finding.span.column - 1 : finding.span.end_column - 1])
        )
    return texts
