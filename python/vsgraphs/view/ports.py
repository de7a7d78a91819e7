"""Is a TCP port free, and if not, does a viewer listen there?"""

from __future__ import annotations

import socket

from vsgraphs.errors import InputError

_HTTP2_HELLO = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes((0, 0, 0, 4, 0, 0, 0, 0, 0))  # and empty settings
_SETTINGS = 4  # type of the frame that every HTTP/2 server begins with (RFC 9113)


def is_free(port: int) -> bool:
    """Whether a server could listen on the port, on all interfaces."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            server.bind(("0.0.0.0", port))  # noqa: S104  (where Rerun listens)
        except OSError:
            return False
    return True


def require_free(port: int, purpose: str, option: str) -> None:
    """Raises InputError, naming the option that chooses another."""
    if not 1 <= port <= 65535:
        raise InputError(f"{option} {port}: a port is a number from 1 to 65535")
    if not is_free(port):
        raise InputError(
            f"port {port} ({purpose}) is taken by another program or may not be used; "
            f"choose another with {option}"
        )


def speaks_http2(port: int, timeout_s: float = 1.0) -> bool:
    """Whether what listens on this machine's port begins as a viewer does (gRPC runs over HTTP/2)."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=timeout_s) as link:
            link.settimeout(timeout_s)
            link.sendall(_HTTP2_HELLO)
            head = link.recv(9)
            return len(head) >= 4 and head[3] == _SETTINGS
    except OSError:
        return False


def listens(port: int, timeout_s: float = 0.5) -> bool:
    """Whether anything on this machine answers on the port."""
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=timeout_s):
            return True
    except OSError:
        return False
