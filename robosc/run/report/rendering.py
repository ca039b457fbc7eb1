"""The report as one page of HTML, as JSON, and as needs of sphinx-needs."""

from __future__ import annotations

import json
import re
from base64 import b64encode
from hashlib import sha256
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics.visible import visible
from robosc.base.files.resources import locate
from robosc.base.files.templates import environment

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Characters that reStructuredText would read as markup; backquotes stay, because they mark literals.
_MARKUP = re.compile(r"[\\*|]|(?<=\w)_(?!\w)")


def as_json(contents: Mapping[str, Any]) -> str:
    """Return the report as JSON for programs; its schema is `report.schema.json`."""
    return json.dumps(contents, indent=2, ensure_ascii=False) + "\n"


def as_html(contents: Mapping[str, Any]) -> str:
    """Return the report as a self-contained page: no script, font or picture from elsewhere.

    Texts of the model are escaped. The content security policy blocks everything except the page's style sheet, which
    it allows by its hash.
    """
    templates = environment("robosc.run.report", escapes=True)
    templates.filters["visible"] = visible
    style = locate("run/report/templates/report.css").read_text(encoding="utf-8")
    allowed = b64encode(sha256(style.encode()).digest()).decode("ascii")
    page = templates.get_template("report.html.j2")
    return page.render(**contents, style=style, style_hash=allowed, outcomes=_outcomes(contents))


def _outcomes(contents: Mapping[str, Any]) -> dict[str, int]:
    """Return the number of verdicts of each outcome."""
    outcomes = [verdict["outcome"] for verdict in contents["verdicts"]]
    return {outcome: outcomes.count(outcome) for outcome in ("proved", "warned", "sampled", "skipped", "refuted")}


def as_needs(contents: Mapping[str, Any]) -> str:
    """Return the requirements, and a test case for each verdict, in the format of sphinx-needs (`needimport`)."""
    needs: dict[str, dict[str, Any]] = {}
    names = {
        requirement["name"]: _identifier("REQ", contents["robot"], requirement["name"])
        for requirement in contents["requirements"]
    }
    for requirement in contents["requirements"]:
        outcomes = [verdict["outcome"] for verdict in requirement["verdicts"]]
        needs[names[requirement["name"]]] = {
            "id": names[requirement["name"]],
            "type": "req",
            "title": requirement["name"],
            "content": "\n\n".join(map(_plain, requirement["texts"])),
            "status": _status(outcomes),
            "tags": [requirement["kind"].replace(" ", "_"), contents["robot"]],
            "links": [],
        }
    for number, verdict in enumerate(contents["verdicts"], 1):
        identifier = _identifier("TEST", contents["robot"], str(number))
        needs[identifier] = {
            "id": identifier,
            "type": "test",
            "title": visible(verdict["property"]),
            "content": _plain(verdict["explanation"] or verdict["evidence"]),
            "status": verdict["outcome"],
            "tags": ["robosc_verify", contents["robot"]],
            "links": [names[verdict["requirement"]]] if verdict["requirement"] in names else [],
        }
    version = contents["digests"]["tool"]["version"]
    version_entry = {"needs": needs, "needs_amount": len(needs)}
    answer = {"project": contents["robot"], "current_version": version, "versions": {version: version_entry}}
    return json.dumps(answer, indent=2, ensure_ascii=False) + "\n"


def _plain(text: str) -> str:
    """Escape a text for reStructuredText, where stars begin emphasis and underscores end references."""
    return _MARKUP.sub(r"\\\g<0>", visible(text))


def _identifier(prefix: str, robot: str, name: str) -> str:
    """Return an identifier of capital letters, digits and underscores, the default format of sphinx-needs."""
    plain = re.sub(r"[^A-Z0-9]+", "_", f"{prefix}_{robot}_{name}".upper()).strip("_")
    return f"{plain}_{sha256(name.encode()).hexdigest()[:6].upper()}" if prefix == "REQ" else plain


def _status(outcomes: list[str]) -> str:
    """Return the worst of the outcomes."""
    return next(
        (outcome for outcome in ("refuted", "skipped", "sampled", "warned", "proved") if outcome in outcomes), "open"
    )
