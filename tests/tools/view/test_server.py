"""Clients that the server accepts, and actions that no request can perform."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING, Any

import pytest
from starlette.testclient import TestClient

from robosc.tools.view import page
from robosc.tools.view.http_server import reachable
from robosc.tools.view.page import FILES, POLICY
from robosc.tools.view.server import application

from .robots import GATE, record

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from robosc.tools.view import Moments


HOSTS = ("127.0.0.1:8000", "localhost:8000")
OPEN = {"action": "perform", "event": "message_open.c_trigger", "inputs": {}}


@pytest.fixture(autouse=True)
def built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Replace the real page, which npm builds, by test files."""
    for name in FILES:
        (tmp_path / name).write_text(name)
    monkeypatch.setattr(page, "_FOLDER", tmp_path)


def client(key: str | None = None, host: str = HOSTS[0]) -> TestClient:
    description, shown, _ = record()
    return client_of([(description, shown)], key, host)


def client_of(
    shown: list[tuple[Mapping[str, Any], Moments]], key: str | None = None, host: str = HOSTS[0]
) -> TestClient:
    return TestClient(application(shown, HOSTS, key), base_url=f"http://{host}", follow_redirects=False)


def test_the_page_and_nothing_else() -> None:
    asking = client()
    assert asking.get("/").text == "index.html"
    for name, kind in FILES.items():
        answer = asking.get(f"/{name}")
        assert (answer.status_code, answer.text, answer.headers["content-type"]) == (200, name, kind)
    for path in ("/nothing", "/..%2fpage.py", "/%2e%2e/page.py", "/robosc.view", "/do"):
        assert asking.get(path).status_code in (404, 405)
    assert asking.get("/description").json()["robot"] == "Gate"


def test_each_of_several_robots_is_asked_by_its_number() -> None:
    other = GATE.replace("robot Gate", "robot Other")
    (gate, first, _), (second_gate, second, _) = record(), record(other)
    asking = client_of([(gate, first), (second_gate, second)])
    for number, name in (("", "Gate"), ("?robot=0", "Gate"), ("?robot=1", "Other")):
        described = asking.get(f"/description{number}").json()
        assert (described["robot"], described["robots"]) == (name, ["Gate", "Other"])
    assert asking.post("/do?robot=1", json=OPEN).json() == {"moment": 1}
    assert (first.length, second.length) == (1, 2)
    asked = {"moment": 1, "event": OPEN["event"]}
    assert asking.get("/explain", params={**asked, "robot": 1}).status_code == 200
    assert asking.get("/explain", params={**asked, "robot": 0}).status_code == 400
    for number in ("2", "-1", "x", "", "1e0", "9" * 9999):
        assert asking.get("/description", params={"robot": number}).status_code == 404
        assert asking.get("/moments", params={"robot": number}).status_code == 404
        assert asking.get("/explain", params={**asked, "robot": number}).status_code == 400
        assert asking.post("/do", params={"robot": number}, json=OPEN).status_code == 404


def test_every_answer_forbids_the_page_to_ask_elsewhere() -> None:
    asking = client()
    answers = [
        *(asking.get("/"), asking.get("/description"), asking.get("/nothing"), asking.post("/do", json={})),
        client(key="secret").get("/"),
        client(host="evil.example").get("/"),
    ]
    assert {answer.headers["content-security-policy"] for answer in answers} == {POLICY}
    assert {answer.headers["x-content-type-options"] for answer in answers} == {"nosniff"}
    assert "'unsafe" not in POLICY
    assert "http" not in POLICY


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:81", "localhost.evil.example:8000"])
def test_other_names_of_this_computer_are_not_answered(host: str) -> None:
    assert client().get("/description", headers={"host": host}).status_code == 421


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1:8000", "http://127.0.0.1:8080"])
def test_pages_of_other_sites_can_do_nothing(origin: str) -> None:
    asking = client()
    assert asking.post("/do", json=OPEN, headers={"origin": origin}).status_code == 403
    assert asking.post("/do", json=OPEN, headers={"origin": f"http://{HOSTS[0]}"}).json() == {"moment": 1}


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""])
def test_forms_can_do_nothing(kind: str) -> None:
    answer = client().post("/do", content='{"action": "undo"}', headers={"content-type": kind})
    assert answer.status_code == 415


@pytest.mark.parametrize(
    "body",
    ["", "{", "null", "[" * 100_000, '{"action": "random", "number": 1e9}', '"\\ud800"', "\0", '{"action": NaN}'],
)
def test_actions_that_are_none(body: str) -> None:
    asking = client()
    answer = asking.post("/do", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 409
    assert asking.post("/do", json=OPEN).json() == {"moment": 1}


def test_a_long_action_is_not_read() -> None:
    answer = client().post("/do", content=b" " * (2 << 20), headers={"content-type": "application/json"})
    assert answer.status_code == 413


def test_who_has_the_token_and_who_has_not() -> None:
    asking = client(key="schlüssel", host="robot.local:8000")
    assert asking.get("/description").status_code == 403
    assert asking.get("/?token=wrong").status_code == 403
    assert asking.get("/description?token=schlüssel").status_code == 403
    answer = asking.get("/?token=schlüssel")
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    assert "HttpOnly" in answer.headers["set-cookie"]
    # A strict cookie would be missing in the redirect after a click on another site.
    assert "SameSite=lax" in answer.headers["set-cookie"]


def test_two_views_on_one_computer_keep_each_other_s_cookies() -> None:
    first, second = client(key="first"), client(key="second")
    first.get("/?token=first")
    second.cookies = first.cookies  # a browser has one cookie jar for all ports of a computer
    second.get("/?token=second")
    first.cookies = second.cookies
    for asking in (first, second):
        assert asking.get("/description").status_code == 200


@pytest.mark.parametrize("address", ["0.0.0.0", "::"])  # noqa: S104 - nothing listens
def test_any_address_is_printed_as_one_that_others_reach(address: str) -> None:
    seen = reachable(address)
    assert seen not in {address, ""}
    assert socket.getaddrinfo(seen, 80)
    assert reachable("127.0.0.2") == "127.0.0.2"


def test_the_token_opens_everything() -> None:
    asking = client(key="key")
    asking.get("/?token=key")
    assert asking.get("/description").json()["robot"] == "Gate"


@pytest.mark.slow
def test_explained() -> None:
    asking = client()
    answer = asking.get("/explain", params={"moment": 0, "event": "message_close.c_trigger"})
    assert answer.json()["allowed"] is False
    for wrong in ({"moment": 7, "event": "message_close.c_trigger"}, {"moment": "x", "event": ""}, {}):
        assert asking.get("/explain", params=wrong).status_code == 400
