"""Serves the page, the robot's description and its moments, and accepts actions for a simulation."""

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

from robosc.run.simulation import DataError
from robosc.tools.view.moments import ActionError
from robosc.tools.view.page import FILES, POLICY, page_files

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Collection, Mapping, Sequence

    from starlette.types import ASGIApp, Receive, Scope, Send

    from robosc.tools.view.moments import Moments

_COOKIE = "robosc-view"
#: Maximum size of an action in bytes.
_LONGEST_ACTION = 1 << 20
#: Maximum number of moments per message.
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
    """Return an ASGI application that serves the page with each robot's description and run.

    `?robot=1` selects the second robot; the default is the first. Without a `token`, requests whose Host header is not
    in `hosts` get status 421. With a token, any host is accepted, but only browsers that have opened `/?token=…`;
    others get 403. Raises PageError if the page has not been built.
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
    """Answers to each kind of request."""

    def __init__(self, shown: Sequence[tuple[Mapping[str, Any], Moments]]) -> None:
        self._files = page_files()
        robots = [description["robot"] for description, _ in shown]
        self._descriptions = [
            json.dumps({**description, "acts": record.acts, "robots": robots}).encode() for description, record in shown
        ]
        self._records = [record for _, record in shown]

    def _robot(self, request: Request) -> int:
        """Return the number of the requested robot. Raises ActionError if there is none."""
        number = request.query_params.get("robot", "0")
        if number not in map(str, range(len(self._records))):
            raise ActionError("unknown robot")
        return int(number)

    async def file(self, request: Request) -> Response:
        """Return a file of the page."""
        name = request.path_params.get("name", "index.html")
        if name not in FILES:
            return PlainTextResponse("unknown file", 404)
        return Response(self._files[name], media_type=FILES[name])

    async def description(self, request: Request) -> Response:
        """Return the description of the robot."""
        try:
            return Response(self._descriptions[self._robot(request)], media_type="application/json")
        except ActionError as error:
            return _refused(error, 404)

    async def moments(self, request: Request) -> Response:
        """Stream all moments so far, and then each new one."""
        try:
            return StreamingResponse(
                stream_moments(self._records[self._robot(request)]), media_type="text/event-stream"
            )
        except ActionError as error:
            return _refused(error, 404)

    async def explain(self, request: Request) -> Response:
        """Explain why an event cannot happen at a moment."""
        try:
            moment, event = int(request.query_params["moment"]), request.query_params["event"]
            record = self._records[self._robot(request)]
            return JSONResponse(await run_in_threadpool(record.explain, moment, event))
        except (ValueError, KeyError, ActionError) as error:
            return _refused(error, 400)

    async def do(self, request: Request) -> Response:
        """Perform an action, which must be JSON, because no form of another site can send that."""
        if request.headers.get("content-type") != "application/json":
            return PlainTextResponse("an action must be application/json", 415)
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > _LONGEST_ACTION:
                return PlainTextResponse("the action is too long", 413)
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


async def stream_moments(record: Moments) -> AsyncIterator[str]:
    """Yield moments as server-sent events `{from, moments, status}`.

    They replace earlier moments from the number `from` on. If `from` skips numbers, the moments in between are no
    longer stored.
    """
    cuts, position, status = len(record.cuts), 0, ""
    while True:
        await record.wait_for_change(cuts, position, status)
        position = max(record.first, min(position, *record.cuts[cuts:], record.length))
        cuts, status = len(record.cuts), record.status
        portion = record.moments[position - record.first :][:_PORTION]
        yield f"data: {json.dumps({'from': position, 'moments': portion, 'status': status})}\n\n"
        position += len(portion)


class _Guarded:
    """Rejects requests to other hosts or without the token.

    Otherwise pages of other sites could use the server in a user's name.
    """

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
            return PlainTextResponse("a page of another site has no access", 403)
        if self._token is None:
            return None
        # Cookies do not distinguish ports, so each view on a computer has its own cookie name.
        cookie = f"{_COOKIE}-{sha256(self._token.encode()).hexdigest()[:12]}"
        if request.url.path == "/" and _same(request.query_params.get("token", ""), self._token):
            # Lax, because a strict cookie is not sent after a click on another site. Actions have further checks.
            response = RedirectResponse("/", 303)
            response.set_cookie(cookie, self._token, httponly=True, samesite="lax")
            return response
        if _same(request.cookies.get(cookie, ""), self._token):
            return None
        return PlainTextResponse("the token is missing: open the address that `robosc view` printed", 403)


def _refused(error: Exception, status: int) -> Response:
    return PlainTextResponse(str(error).encode(errors="replace"), status)


def _same(candidate: str, token: str) -> bool:
    return compare_digest(candidate.encode(), token.encode())
