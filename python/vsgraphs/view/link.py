"""A stream to a viewer in another process that holds nobody up when the viewer is gone or asleep.

Rerun's calls queue some 300 MB for a viewer that does not read, then wait without end, and the time limit of
its `flush` does not hold. So a thread looks on, and cuts the connection where a call takes too long.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from vsgraphs.view import ports

_PATIENCE_S = 10.0
_HURRY_S = 2.0  # once all that is left is to end
_LOOK_S = 0.5


class Link:
    """What a viewer at address and port is sent.

    lost: why the viewer was given up, None before; afterwards all calls do nothing.
    gone: what to say when it is no longer there, None while it is. tell: from another thread too.
    """

    def __init__(
        self,
        stream: Any,
        address: str,
        port: int,
        gone: Callable[[], str | None],
        tell: Callable[[str], None],
    ) -> None:
        self._stream = stream
        self._where = (port, address)
        self._gone = gone
        self._tell = tell
        self._patience_s = _PATIENCE_S
        self._since: float | None = None  # when the call under way began
        self._call_s = 0.0  # what it may take, if more than others
        self._giving_up = threading.Lock()
        self._closed = threading.Event()
        self.lost: str | None = None
        self._onlooker = threading.Thread(target=self._look_on, name="view-link", daemon=True)
        self._onlooker.start()

    def log(self, path: str, shown: Any, *, static: bool = False) -> None:
        """As the stream's."""
        self._do(lambda: self._stream.log(path, shown, static=static))

    def set_time(self, timeline: str, *, duration: float) -> None:
        """As the stream's."""
        self._do(lambda: self._stream.set_time(timeline, duration=duration))

    def send_blueprint(self, blueprint: Any, *, make_active: bool, make_default: bool) -> None:
        """As the stream's."""
        self._do(
            lambda: self._stream.send_blueprint(blueprint, make_active=make_active, make_default=make_default)
        )

    def log_file_from_path(self, path: Path) -> None:
        """As the stream's."""
        self._do(lambda: self._stream.log_file_from_path(path))

    def flush(self, limit_s: float) -> None:
        """Waits until what was logged has arrived; gives the viewer up where it does not in that time."""
        self._do(
            lambda: self._stream.flush(timeout_sec=limit_s), "the viewer did not take everything", limit_s + 1
        )

    def hurry(self) -> None:
        """From now on a call may take two seconds."""
        self._patience_s = _HURRY_S

    def cut(self) -> None:
        """Ends the connection without a word. What has not arrived does not."""
        self._give_up("")
        self.leave()

    def leave(self) -> None:
        """No longer looks on; the connection stays."""
        self._closed.set()
        self._onlooker.join(_HURRY_S)

    def _do(
        self, step: Callable[[], object], trouble: str = "the viewer failed", patience_s: float = 0.0
    ) -> None:
        if self.lost is not None:
            return
        self._call_s = patience_s
        self._since = time.monotonic()
        try:
            step()
        except Exception as error:
            self._give_up(self._gone() or f"{trouble} ({short(error)})")
        finally:
            self._since = None

    def _look_on(self) -> None:
        while self.lost is None and not self._closed.wait(_LOOK_S):
            began = self._since
            if began is not None and time.monotonic() - began > max(self._patience_s, self._call_s):
                self._give_up("the viewer does not read")
            elif reason := self._gone():
                self._give_up(reason)

    def _give_up(self, reason: str) -> None:
        with self._giving_up:
            if self.lost is not None:
                return
            self.lost = reason
        self._closed.set()
        with contextlib.suppress(OSError):  # no /dev/fd on this system
            ports.cut_connections(*self._where)
        if reason:
            self._tell(f"{reason}; going on without it")


def short(error: Exception) -> str:
    """One line of it."""
    return " ".join(str(error).split())[:160]
