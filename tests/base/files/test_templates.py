from pathlib import Path

import pytest
from jinja2 import UndefinedError

from robosc.base.files import templates


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "shipped"
    folder.mkdir()
    monkeypatch.setattr(templates, "locate", {"m2t/target/templates": folder}.__getitem__)
    (folder / "a.j2").write_text(
        "{% for name in names %}\n  {% if name %}\n<{{ name }}>\n  {% endif %}\n{% endfor %}\n"
    )
    (folder / "b.j2").write_text("ours\n")
    return folder


def test_blocks_leave_no_trace_and_nothing_is_escaped(shipped: Path) -> None:
    assert shipped.exists()
    text = templates.environment("robosc.m2t.target").get_template("a.j2").render(names=["x", "", "<&"])
    assert text == "<x>\n<<&>\n"


def test_unknown_names_are_errors(shipped: Path) -> None:
    assert shipped.exists()
    with pytest.raises(UndefinedError):
        templates.environment("robosc.m2t.target").get_template("a.j2").render()


def test_a_template_of_the_user_takes_the_place_of_ours(shipped: Path, tmp_path: Path) -> None:
    assert shipped.exists()
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "b.j2").write_text("mine\n")
    loaded = templates.environment("robosc.m2t.target", overrides=mine)
    assert loaded.get_template("b.j2").render() == "mine\n"
    assert loaded.get_template("a.j2").render(names=["x"]) == "<x>\n"
