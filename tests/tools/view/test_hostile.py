"""Texts with markup in every place of a model stay texts on a served page."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

import pytest

from robosc.tools.view.page import POLICY
from tests.chromium import opened

from .robots import EVIL
from .test_page import at, click, served

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.build

#: Texts that are valid in a model's strings and comments and in its file's name.
IMAGE = "<img src=x onerror='globalThis.hacked = 1'>"
SCRIPT = "</script><script>globalThis.hacked = 1</script>"
NAMED, FILLED, OPEN, TEST = (
    *("message_named.u_response", "message_filled.u_response"),
    *("message_open.c_trigger", "message_test.c_trigger"),
)
MODEL = f"""\
// {IMAGE}{SCRIPT}
robot Gate {{
  interface filling use Filling from tank_msgs

  datatype object Filling {{
    name: string
  }}

  component Tank {{ // {SCRIPT}
    outgoing message filled with identifier: "/{IMAGE}", type: Filling links filling
    outgoing message named with identifier: "/{SCRIPT}", type: string
    incoming message open with identifier: "/open{IMAGE}", type: string
    incoming message test with identifier: "/test", type: none

    behaviour {{
      variable label: string = "{IMAGE}"

      initial marked state watched {{
        on response from filled if value.name != "{IMAGE}" goto opened
        on response from named do label := value
        on request to open
      }}

      state opened {{
        on request to test goto watched
      }}
    }}
  }}

  requirement Full "{IMAGE}{SCRIPT}": open needs Tank.opened
  property P1 "{IMAGE}": never Tank.opened

  provide open with "{IMAGE}"
}}
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / f"{IMAGE}.rscd"
    path.write_text(MODEL, encoding="utf-8")
    return path


def assert_harmless(page: Any) -> None:
    """Check that the page has only its own elements, and that only its own script has run."""
    assert page.evaluate("globalThis.hacked") is None
    assert page.locator("img, iframe, object, embed, form, style, base, meta[http-equiv]").count() == 0
    scripts = page.evaluate("[...document.scripts].map((script) => [script.getAttribute('src'), script.textContent])")
    assert scripts == [["page.js", ""]]
    told = "[...document.querySelectorAll('*')].flatMap((one) => [...one.attributes]).map((one) => one.name)"
    assert [name for name in page.evaluate(told) if name.startswith("on") or name == "srcdoc"] == []


def test_what_a_model_says_is_text(chromium: Any, model: Path) -> None:
    with served(model) as address, opened(chromium, address) as page:
        assert_harmless(page)
        communication = page.locator(".card.graph").text_content()
        for name in (f"/{IMAGE}", f"/{SCRIPT}", f"/open{IMAGE}"):
            assert name in communication
        assert page.locator("#lines .line").first.text_content() == f"// {IMAGE}{SCRIPT}"
        assert page.locator("#file option").first.text_content() == f"{IMAGE}.rscd"
        assert f"{IMAGE}{SCRIPT}" in page.locator("#requirements").text_content()
        assert f"{IMAGE}{SCRIPT}" in page.locator(f'#commands > li[data-event="{OPEN}"] .reason').text_content()
        assert IMAGE in page.locator(f'#events li:has(button[data-event="{FILLED}"])').text_content()
        assert page.locator('#numbers > li[data-key="Tank.label"] strong').text_content() == IMAGE
        for command in (OPEN, TEST):
            shown = page.locator(f'#commands > li[data-event="{command}"]')
            shown.get_by_role("button", name="What would help?").click()
            shown.locator(".why ul").first.wait_for()
        page.get_by_label("Find", exact=True).fill(EVIL)
        page.get_by_label("Find", exact=True).fill("")
        assert_harmless(page)


def test_what_is_typed_is_text(chromium: Any, model: Path) -> None:
    with served(model) as address, opened(chromium, address) as page:
        page.locator(f'.performer:has(button[data-event="{NAMED}"]) input').fill(EVIL)
        click(page, NAMED)
        at(page, 1)
        assert page.locator(".variables dd").text_content() == EVIL
        assert json.dumps(EVIL) in page.locator("#happened [aria-current]").text_content()
        assert EVIL.replace('"', '\\"') in page.locator("#moment").get_attribute("aria-valuetext")
        assert_harmless(page)


def test_what_a_log_says_is_text(chromium: Any, model: Path, tmp_path: Path) -> None:
    log = tmp_path / f"{IMAGE}.jsonl"
    entries = [{"event": OPEN, "data": {}}, {"event": NAMED, "data": {"value": EVIL}}]
    log.write_text("".join(json.dumps(entry) + "\n" for entry in entries), encoding="utf-8")
    with served(model, "--log", log) as address, opened(chromium, address) as page:
        at(page, 2)
        assert f"{IMAGE}{SCRIPT}" in page.locator("#happened .refused").text_content()
        assert page.locator(".variables dd").text_content() == EVIL
        assert_harmless(page)


def test_markup_could_do_nothing(chromium: Any, model: Path) -> None:
    """Even if a text became markup, no script in it would run, and no other address would be requested."""
    with served(model) as address:
        with urlopen(address, timeout=60) as answer:  # noqa: S310
            assert answer.headers["Content-Security-Policy"] == POLICY
        page = chromium.new_page()
        answered: list[str] = []
        page.on("requestfinished", lambda request: answered.append(request.url))
        page.goto(address)
        page.wait_for_selector("body[data-drawn][data-moment]")
        blocked = page.evaluate(
            """async () => {
              const told = [];
              const done = new Promise((resolve) => document.addEventListener("securitypolicyviolation", (event) => {
                told.push(event.effectiveDirective);
                if (told.length === 4) resolve();
              }));
              document.body.insertAdjacentHTML("beforeend", '<b onclick="globalThis.hacked = 1"></b>');
              document.querySelector("b[onclick]").click();
              const script = document.createElement("script");
              script.textContent = "globalThis.hacked = 1";
              document.body.append(script);
              document.body.insertAdjacentHTML("beforeend", '<img src="http://evil.example/x.png">');
              await fetch("http://evil.example/").catch(() => {});
              await done;
              return told.sort();
            }"""
        )
        assert blocked == ["connect-src", "img-src", "script-src-attr", "script-src-elem"]
        assert page.evaluate("globalThis.hacked") is None
        assert all(url.startswith(address) for url in answered)
        page.close()
