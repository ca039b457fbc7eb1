"""Listens for browsers until it is interrupted."""

from __future__ import annotations

import socket
from typing import TYPE_CHECKING

import uvicorn

if TYPE_CHECKING:
    from collections.abc import Callable

    from starlette.types import ASGIApp

#: Host names by which a browser on this computer reaches the server.
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


def reachable(address: str) -> str:
    """Return the address by which others reach a listener.

    A listener on all addresses is reached by an address of this computer.
    """
    family = {"0.0.0.0": socket.AF_INET, "::": socket.AF_INET6}.get(address)  # noqa: S104 - compared only
    if family is None:
        return address
    # The route to a documentation address identifies the network interface; no packet is sent.
    elsewhere = "192.0.2.1" if family == socket.AF_INET else "2001:db8::1"
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((elsewhere, 9))
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


def listen(address: str, port: int) -> socket.socket:
    """Return a listening socket; port 0 selects a free port. Raises OSError."""
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    server_socket = socket.socket(family, socket.SOCK_STREAM)
    try:
        server_socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        server_socket.bind((address, port))
        server_socket.listen()
    except OSError:
        server_socket.close()
        raise
    return server_socket


def serve(served: ASGIApp, listening: socket.socket, ready: Callable[[], None]) -> None:
    """Serve an application until SIGINT or SIGTERM; `ready` is called once it accepts connections."""

    class _Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            ready()

    configuration = uvicorn.Config(
        served, log_level="critical", access_log=False, lifespan="off", timeout_graceful_shutdown=1, server_header=False
    )
    _Server(configuration).run([listening])
