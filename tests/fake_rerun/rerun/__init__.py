"""A stand-in for Rerun where that is not installed: what is logged goes to its `rerun_cli` over TCP.

Like the real one, calls wait without end for a server that does not read, also when the program ends.
"""

from __future__ import annotations

import atexit
import contextlib
import socket
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

PIECE = 1 << 18  # of a thing logged: a few fill what the kernel holds
_streams: list[RecordingStream] = []


class _Family(type):
    def __getattr__(cls, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return cls


class Anything(metaclass=_Family):
    """Every archetype, component, enumeration and part of a blueprint."""

    def __init__(self, *_: Any, **__: Any) -> None:
        pass

    def __getattr__(self, name: str) -> Any:
        return getattr(type(self), name)


def __getattr__(name: str) -> Any:
    return getattr(Anything, name)


class RecordingStream:
    def __init__(self, application: str, **_: Any) -> None:
        self.connection: socket.socket | None = None
        self.file: Path | None = None
        self.severed = False
        _streams.append(self)

    def connect_grpc(self, url: str) -> None:
        parts = urlsplit(url)
        self.connection = socket.create_connection((parts.hostname, parts.port))

    def save(self, path: Path) -> None:
        self.file = path
        path.write_text("")

    def log(self, path: str, shown: Any, **_: Any) -> None:
        if self.file is not None:
            with self.file.open("a") as file:
                file.write(f"/{path}\n")
        self._send(b"L" + bytes(PIECE))

    def set_time(self, *_: Any, **__: Any) -> None: ...

    def send_blueprint(self, *_: Any, **__: Any) -> None: ...

    def flush(self, timeout_sec: float = 1e38) -> None:
        self._send(b"F")
        if self.connection is not None and not self.severed:
            self.severed = self.connection.recv(1) != b"A"
        if self.severed:
            raise ValueError("gRPC connection severed")

    def disconnect(self) -> None: ...

    def _send(self, data: bytes) -> None:
        if self.connection is None or self.severed:
            return
        try:
            self.connection.sendall(data)
        except OSError:
            self.severed = True


def shutdown() -> None:
    for stream in _streams:
        with contextlib.suppress(ValueError):
            stream.flush()


def unregister_shutdown() -> None:
    atexit.unregister(shutdown)


atexit.register(shutdown)
