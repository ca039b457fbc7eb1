"""Serves the page, the robot's description and what happens; takes actions for a simulation."""

from __future__ import annotations

import json
from hashlib import sha256
from hmac import compare_digest
from typing import TYPE_CHECKING, Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response, StreamingResponse
from starlette.routing import Route

from robosc.simulation import DataError
from robosc.view.moments import ActionError
from robosc.view.page import FILES, POLICY, page_files

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Collection, Mapping, Sequence

    from starlette.types import ASGIApp, Receive, Scope, Send

    from robosc.view.moments import Moments

_COOKIE = "robosc-view"
#: An action says little.
_LONGEST_ACTION = 1 << 20
#: So many moments go out at once.
_PORTION = 500
_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


def application(
    shown: Sequence[tuple[Mapping[str, Any], Moments]], hosts: Collection[str], token: str | None = None
) -> ASGIApp:
    """An ASGI application that serves the page with each robot's description and run.

    `?robot=1` selects the second robot; without it the first. Without a `token`, requests whose Host header is not in
    `hosts` get status 421. With one, any host may ask, but only who opened `/?token=…`; others get 403. Raises
    PageError where the page is not built.
    """
    answers = _Answers(shown)
    routes = [
        Route("/", answers.file),
        Route("/description", answers.description),
        Route("/moments", answers.moments),
        Route("/explain", answers.explain),
        Route("/do", answers.do, methods=["POST"]),
        Route("/{name}", answers.file),
    ]
    return _Guarded(Starlette(routes=routes), hosts, token)


class _Answers:
    """To each kind of request."""

    def __init__(self, shown: Sequence[tuple[Mapping[str, Any], Moments]]) -> None:
        self._files = page_files()
        robots = [description["robot"] for description, _ in shown]
        self._descriptions = [
            json.dumps({**description, "acts": record.acts, "robots": robots}).encode() for description, record in shown
        ]
        self._records = [record for _, record in shown]

    def _robot(self, request: Request) -> int:
        """The number of the robot that is asked for. Raises ActionError where there is none."""
        asked = request.query_params.get("robot", "0")
        if asked not in map(str, range(len(self._records))):
            raise ActionError("there is no such robot")
        return int(asked)

    async def file(self, request: Request) -> Response:
        """A file of the page."""
        name = request.path_params.get("name", "index.html")
        if name not in FILES:
            return PlainTextResponse("there is no such file", 404)
        return Response(self._files[name], media_type=FILES[name])

    async def description(self, request: Request) -> Response:
        """What never changes."""
        try:
            return Response(self._descriptions[self._robot(request)], media_type="application/json")
        except ActionError as error:
            return _refused(error, 404)

    async def moments(self, request: Request) -> Response:
        """All that has happened, and what happens from now on."""
        try:
            return StreamingResponse(told(self._records[self._robot(request)]), media_type="text/event-stream")
        except ActionError as error:
            return _refused(error, 404)

    async def explain(self, request: Request) -> Response:
        """Why an event can't happen at a moment."""
        try:
            moment, event = int(request.query_params["moment"]), request.query_params["event"]
            record = self._records[self._robot(request)]
            return JSONResponse(await run_in_threadpool(record.explained, moment, event))
        except (ValueError, KeyError, ActionError) as error:
            return _refused(error, 400)

    async def do(self, request: Request) -> Response:
        """An action; it is JSON, which no form of another site can send."""
        if request.headers.get("content-type") != "application/json":
            return PlainTextResponse("an action is application/json", 415)
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > _LONGEST_ACTION:
                return PlainTextResponse("an action is short", 413)
        try:
            record = self._records[self._robot(request)]
        except ActionError as error:
            return _refused(error, 404)
        try:
            record.do(json.loads(body))
        except (ValueError, RecursionError, ActionError, DataError) as error:
            return _refused(error, 409)
        finally:
            await record.tell()
        return JSONResponse({"moment": record.length - 1})


async def told(record: Moments) -> AsyncIterator[str]:
    """Moments as server-sent events: `{from, moments, status}`; those from there on replace what was told before.

    Where `from` is beyond what was told before, that is no longer kept.
    """
    cuts, told, status = len(record.cuts), 0, ""
    while True:
        await record.changed(cuts, told, status)
        told = max(record.first, min(told, *record.cuts[cuts:], record.length))
        cuts, status = len(record.cuts), record.status
        portion = record.moments[told - record.first :][:_PORTION]
        yield f"data: {json.dumps({'from': told, 'moments': portion, 'status': status})}\n\n"
        told += len(portion)


class _Guarded:
    """Answers only who asks for the right host, and knows the token: no other site's page can ask in a user's name."""

    def __init__(self, inner: ASGIApp, hosts: Collection[str], token: str | None) -> None:
        self._inner = inner
        self._hosts = hosts
        self._token = token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._inner(scope, receive, send)
            return
        request = Request(scope)
        response = self._refusal(request)
        if response is not None:
            response.headers.update(_HEADERS)
            await response(scope, receive, send)
            return

        async def with_headers(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] += [(name.lower().encode(), value.encode()) for name, value in _HEADERS.items()]
            await send(message)

        await self._inner(scope, receive, with_headers)

    def _refusal(self, request: Request) -> Response | None:
        host = request.headers.get("host")
        if self._token is None and host not in self._hosts:
            return PlainTextResponse("this address is not served here", 421)
        if request.headers.get("origin", f"http://{host}") != f"http://{host}":
            return PlainTextResponse("another site's page may not ask", 403)
        if self._token is None:
            return None
        # Cookies know no ports: each view on a computer has its own name.
        cookie = f"{_COOKIE}-{sha256(self._token.encode()).hexdigest()[:12]}"
        if request.url.path == "/" and _same(request.query_params.get("token", ""), self._token):
            # Lax: a strict one does not come with the redirect after a click on another site. An action needs more.
            response = RedirectResponse("/", 303)
            response.set_cookie(cookie, self._token, httponly=True, samesite="lax")
            return response
        if _same(request.cookies.get(cookie, ""), self._token):
            return None
        return PlainTextResponse("the token is missing: open the address that `robosc view` printed", 403)


def _refused(error: Exception, status: int) -> Response:
    return PlainTextResponse(str(error).encode(errors="replace"), status)


def _same(given: str, token: str) -> bool:
    return compare_digest(given.encode(), token.encode())
