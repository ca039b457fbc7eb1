import subprocess

from hypothesis import given, settings
from hypothesis import strategies as st

from robosc.m2t.c.comments import comment, comment_text, string_literal

_risky = st.text(st.one_of(st.sampled_from("*/\\?\n\r\"'% a"), st.characters(exclude_categories=("Cs",))), max_size=200)


@given(st.lists(_risky, max_size=3), st.integers(0, 8))
def test_a_comment_ends_where_it_should(paragraphs: list[str], indent: int) -> None:
    text = comment(paragraphs, indent)
    if not text:
        assert not any(map(comment_text, paragraphs))
        return
    inner = text.strip()[2:-2]
    assert text.strip().startswith("/* ")
    assert text.endswith(" */")
    assert not {"*/", "/*", "??"} & {inner[at : at + 2] for at in range(len(inner))}
    assert all(line.startswith(" " * indent) for line in text.split("\n"))
    assert len(text.splitlines()) == text.count("\n") + 1, "no other line ends"


def test_paragraphs_stand_on_lines_of_their_own() -> None:
    assert comment(["one", "two"], 4) == "    /* one\n     * two */"


@settings(max_examples=1, derandomize=True)
@given(st.lists(_risky.filter(lambda text: "\0" not in text), min_size=80, max_size=80))
def test_a_string_is_what_it_was(tmp_path_factory, texts: list[str]) -> None:
    folder = tmp_path_factory.mktemp("strings")
    lines = "".join(f"    fwrite({literal}, 1, sizeof {literal}, stdout);\n" for literal in map(string_literal, texts))
    (folder / "main.c").write_text(f"#include <stdio.h>\nint main(void)\n{{\n{lines}    return 0;\n}}\n")
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["gcc", *strict, folder / "main.c", "-o", folder / "main"], check=True)
    said = subprocess.run([folder / "main"], capture_output=True, check=True).stdout
    assert said == b"".join(text.encode() + b"\0" for text in texts)
