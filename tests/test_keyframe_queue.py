"""Work on keyframes beside tracking: what is done, in which order, what is dropped, how it ends."""

from __future__ import annotations

import threading

import pytest

from vsgraphs.keyframe_queue import KeyframeQueue


class Worker:
    """Notes what it is given; holds still while `gate` is closed."""

    def __init__(self) -> None:
        self.done: list[int] = []
        self.started = threading.Event()
        self.gate = threading.Event()
        self.gate.set()

    def __call__(self, item: int) -> None:
        self.started.set()
        assert self.gate.wait(30)
        if item < 0:
            raise RuntimeError(f"item {item}")
        self.done.append(item)


def busy_queue(worker: Worker, waiting: int, newest_first: bool = False) -> KeyframeQueue[int]:
    """A queue whose worker is held at item 0."""
    worker.gate.clear()
    queue = KeyframeQueue[int](worker, "work", beside=True, waiting=waiting, newest_first=newest_first)
    queue.put(0)
    assert worker.started.wait(30)
    return queue


def test_without_a_thread_work_is_done_within_put() -> None:
    worker = Worker()
    queue = KeyframeQueue[int](worker, "work", beside=False, waiting=1)
    for item in range(3):
        queue.put(item)
        assert worker.done[-1] == item
    with pytest.raises(RuntimeError, match="item -1"):
        queue.put(-1)
    queue.finish(1.0)
    assert (queue.dropped, queue.waiting, queue.left_behind) == (0, 0, False)


@pytest.mark.parametrize(("newest_first", "order"), [(False, [0, 2, 3]), (True, [0, 3, 2])])
def test_the_oldest_is_dropped_where_more_come_than_may_wait(newest_first: bool, order: list[int]) -> None:
    worker = Worker()
    queue = busy_queue(worker, waiting=2, newest_first=newest_first)
    for item in (1, 2, 3):
        queue.put(item)
    assert (queue.waiting, queue.dropped) == (3, 1)
    worker.gate.set()
    queue.finish(30)
    assert worker.done == order
    assert (queue.waiting, queue.dropped, queue.left_behind) == (0, 1, False)


def test_what_is_discarded_does_not_count_as_dropped() -> None:
    worker = Worker()
    queue = busy_queue(worker, waiting=5)
    queue.put(1)
    queue.put(2)
    assert queue.discard() == 2
    worker.gate.set()
    queue.finish(30)
    assert (worker.done, queue.dropped) == ([0], 0)


def test_a_failure_ends_the_work_and_is_told_once() -> None:
    worker = Worker()
    queue = busy_queue(worker, waiting=5)
    queue.put(-7)
    queue.put(1)
    worker.gate.set()
    queue.finish(30)
    failure = queue.take_failure()
    assert isinstance(failure, RuntimeError)
    assert str(failure) == "item -7"
    assert queue.take_failure() is None
    assert worker.done == [0], "nothing after the failure"
    queue.put(2)
    assert worker.done == [0]
    assert queue.dropped == 2


def test_the_end_waits_no_longer_than_it_may() -> None:
    worker = Worker()
    queue = busy_queue(worker, waiting=5)
    queue.put(1)
    queue.finish(limit_s=0.01, patience_s=0.01)
    assert queue.left_behind
    assert queue.dropped == 2, "the one that waited, and the one under way"
    worker.gate.set()


def test_a_queue_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        KeyframeQueue[int](Worker(), "work", beside=True, waiting=0)
