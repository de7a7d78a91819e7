"""A run below the command line: `vsgraphs.run(source, out=...)`.

    result = vsgraphs.run("path/to/sequence", out="results", mode="full")
    print(result.trajectory.positions[-1], [room.name for room in result.scene_graph.rooms.values()])

Does what `vsgraphs run` does, and neither prints nor ends the process. The module itself can be called, so
that `vsgraphs.run` is the same whether it was imported before or not. Its names load what they need at first
use.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vsgraphs.run.events import KeyframeEvent as KeyframeEvent
    from vsgraphs.run.events import LoopEvent as LoopEvent
    from vsgraphs.run.events import RoomEvent as RoomEvent
    from vsgraphs.run.listener import Message as Message
    from vsgraphs.run.listener import Progress as Progress
    from vsgraphs.run.request import RunRequest as RunRequest
    from vsgraphs.run.result import Result as Result
    from vsgraphs.run.start import run as run
    from vsgraphs.run.watching import Showing as Showing

_HOMES = {
    "KeyframeEvent": "events",
    "LoopEvent": "events",
    "Message": "listener",
    "Progress": "listener",
    "Result": "result",
    "RoomEvent": "events",
    "RunRequest": "request",
    "Showing": "watching",
    "run": "start",
}

__all__ = [
    "KeyframeEvent",
    "LoopEvent",
    "Message",
    "Progress",
    "Result",
    "RoomEvent",
    "RunRequest",
    "Showing",
    "run",
]


def __getattr__(name: str) -> Any:
    if name == "__signature__":  # of the module as a function
        import inspect

        from vsgraphs.run.start import run

        return inspect.signature(run)
    if name not in _HOMES:
        raise AttributeError(f"module 'vsgraphs.run' has no attribute {name!r}")
    return getattr(importlib.import_module(f"vsgraphs.run.{_HOMES[name]}"), name)


class _Callable(ModuleType):
    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        """See `vsgraphs.run.run`."""
        from vsgraphs.run.start import run

        return run(*arguments, **keywords)


sys.modules[__name__].__class__ = _Callable
