"""Addresses and TCP ports: may a viewer listen there, who listens already, and who could look?"""

from __future__ import annotations

import ipaddress
import os
import socket
import stat
from pathlib import Path

from vsgraphs.errors import InputError

LOOPBACK = "127.0.0.1"
_HTTP2_HELLO = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + bytes((0, 0, 0, 4, 0, 0, 0, 0, 0))  # and empty settings
_SETTINGS = 4  # type of the frame that every HTTP/2 server begins with (RFC 9113)
_OWN_FILES = Path("/dev/fd")


def require_address(address: str) -> None:
    """Raises InputError unless it is an IP address of this machine, or all of them (0.0.0.0, ::)."""
    try:
        known = "%" not in address and ipaddress.ip_address(address)
    except ValueError:
        known = False
    if not known:
        raise InputError(
            f"--view-address {address}: must be an IP address of this machine, as {LOOPBACK} (only this "
            "machine can look) or 0.0.0.0 (whoever reaches it)"
        )
    try:
        _bind(0, address)
    except OSError:
        raise InputError(
            f"--view-address {address}: this machine has no such address; `ip address` lists those it has"
        ) from None


def is_private(address: str) -> bool:
    """Whether only programs on this machine reach what listens there."""
    return ipaddress.ip_address(address).is_loopback


def reached_at(address: str) -> str:
    """Where this machine itself reaches what listens on the address: all of them include loopback."""
    parsed = ipaddress.ip_address(address)
    if not parsed.is_unspecified:
        return address
    return LOOPBACK if parsed.version == 4 else "::1"


def in_url(address: str) -> str:
    """As it stands before the port in a URL."""
    return f"[{address}]" if ":" in address else address


def is_free(port: int, address: str) -> bool:
    """Whether a server could listen on the port at this address."""
    try:
        _bind(port, address)
    except OSError:
        return False
    return True


def require_free(port: int, address: str, purpose: str, option: str) -> None:
    """Raises InputError, naming the option that chooses another."""
    if not 1 <= port <= 65535:
        raise InputError(f"{option} {port}: a port is a number from 1 to 65535")
    if not is_free(port, address):
        raise InputError(
            f"port {port} ({purpose}) is taken by another program or may not be used; "
            f"choose another with {option}"
        )


def speaks_http2(port: int, address: str, timeout_s: float = 1.0) -> bool:
    """Whether what listens there begins as a viewer does (gRPC runs over HTTP/2)."""
    try:
        with socket.create_connection((reached_at(address), port), timeout=timeout_s) as link:
            link.settimeout(timeout_s)
            link.sendall(_HTTP2_HELLO)
            head = link.recv(9)
            return len(head) >= 4 and head[3] == _SETTINGS
    except OSError:
        return False


def listens(port: int, address: str, timeout_s: float = 0.5) -> bool:
    """Whether anything answers there."""
    try:
        with socket.create_connection((reached_at(address), port), timeout=timeout_s):
            return True
    except OSError:
        return False


def cut_connections(port: int, address: str) -> int:
    """Shuts this process's own connections to a server, whoever opened them; how many there were.

    The only way out of a call into Rerun that waits for a viewer which no longer reads: it then fails.
    """
    peer = (reached_at(address), port)
    return sum(_cut(int(name), peer) for name in os.listdir(_OWN_FILES))  # noqa: PTH208  (numbers are wanted)


def _cut(descriptor: int, peer: tuple[str, int]) -> bool:
    try:
        if not stat.S_ISSOCK(os.fstat(descriptor).st_mode):
            return False
        borrowed = socket.socket(fileno=descriptor)
    except OSError:  # closed meanwhile
        return False
    try:
        if borrowed.family not in {socket.AF_INET, socket.AF_INET6} or borrowed.getpeername()[:2] != peer:
            return False
        borrowed.shutdown(socket.SHUT_RDWR)
    except OSError:  # it listens, or is closed already
        return False
    finally:
        borrowed.detach()  # its owner closes it
    return True


def _bind(port: int, address: str) -> None:
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        server.bind((address, port))
