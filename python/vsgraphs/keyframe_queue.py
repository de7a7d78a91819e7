"""Work on keyframes beside tracking: one thread, a bounded queue, and an end that does not wait for ever."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

Item = TypeVar("Item")


class KeyframeQueue(Generic[Item]):
    """Calls `work` with each item put in, on a thread called `name`; beside=False: within `put`.

    When more than `waiting` items wait, the oldest is dropped. newest_first: which of them is next. What
    `work` raises on the thread ends the work and is kept for `take_failure`; what waits or still comes
    counts as dropped. Within `put` it is raised there, and the next `put` works on.
    All methods belong to the caller's thread, except `discard`, `waiting` and `left_behind`, which `work`
    may use too. Raises ValueError where `waiting` is less than 1.
    """

    def __init__(
        self,
        work: Callable[[Item], None],
        name: str,
        *,
        beside: bool,
        waiting: int,
        newest_first: bool = False,
    ) -> None:
        if waiting < 1:
            raise ValueError("waiting must be at least 1")
        self._work, self._most, self._newest_first = work, waiting, newest_first
        self._changed = threading.Condition()  # guards all below
        self._items: deque[Item] = deque()  # oldest first
        self._dropped = 0
        self._busy = self._stopping = self._left_behind = False
        self._failure: Exception | None = None
        self._beside = beside
        self._thread = threading.Thread(target=self._run, name=name, daemon=True) if beside else None
        if self._thread is not None:
            self._thread.start()

    def put(self, item: Item) -> None:
        """Hands over an item, which must not change any more; no more after a failure or the end."""
        if not self._beside:
            self._work(item)
            return
        with self._changed:
            if self._stopping:
                self._dropped += 1
                return
            self._items.append(item)
            if len(self._items) > self._most:
                self._items.popleft()
                self._dropped += 1
            self._changed.notify_all()

    @property
    def waiting(self) -> int:
        """Items that wait or are being worked on."""
        with self._changed:
            return len(self._items) + self._busy

    @property
    def dropped(self) -> int:
        """Items nobody worked on: others were newer, work had failed or ended; and one left behind."""
        with self._changed:
            return self._dropped

    @property
    def left_behind(self) -> bool:
        """Whether the end has come while `work` was still at an item."""
        with self._changed:
            return self._left_behind

    def discard(self) -> int:
        """Takes out what waits; how many that were. They do not count as dropped."""
        with self._changed:
            count = len(self._items)
            self._items.clear()
            self._changed.notify_all()
            return count

    def take_failure(self) -> Exception | None:
        """What `work` raised on the thread, once."""
        with self._changed:
            failure, self._failure = self._failure, None
            return failure

    def finish(self, limit_s: float, patience_s: float | None = None) -> None:
        """Works off what waits, for at most `limit_s`, and drops the rest.

        An item under way is waited for `patience_s` longer (None: however long it takes), then left behind.
        """
        thread, self._thread = self._thread, None
        if thread is None:
            return
        with self._changed:
            self._changed.wait_for(lambda: not (self._items or self._busy), limit_s)
            self._dropped += len(self._items)
            self._items.clear()
            self._stopping = True
            self._changed.notify_all()
        thread.join(patience_s)
        with self._changed:
            self._left_behind = self._busy
            self._dropped += self._left_behind

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._items or self._stopping)
                if not self._items:
                    return
                item = self._items.pop() if self._newest_first else self._items.popleft()
                self._busy = True
            failure: Exception | None = None
            try:
                self._work(item)
            except Exception as error:  # told on the caller's thread
                failure = error
            with self._changed:
                self._busy = False
                if failure is not None:
                    self._failure, self._stopping = failure, True
                    self._dropped += len(self._items)
                    self._items.clear()
                self._changed.notify_all()
