"""When each stage worked: the Chrome trace format (open in chrome://tracing or ui.perfetto.dev)."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

# lane, name, begin and duration in microseconds on one clock, frame
Span = tuple[str, str, int, int, int]


def format_timeline(spans: Iterable[Span]) -> str:
    """Chrome trace JSON with one lane for each stage's thread, time counted from the earliest span."""
    ordered = sorted(spans, key=lambda span: (span[2], -span[3]))
    origin = ordered[0][2] if ordered else 0
    lanes: dict[str, int] = {}
    for lane, *_ in ordered:
        lanes.setdefault(lane, len(lanes) + 1)
    events: list[dict[str, Any]] = [
        {"ph": "M", "name": "process_name", "pid": 1, "tid": 0, "args": {"name": "vsgraphs"}}
    ]
    for lane, number in lanes.items():
        events.append({"ph": "M", "name": "thread_name", "pid": 1, "tid": number, "args": {"name": lane}})
        events.append(
            {"ph": "M", "name": "thread_sort_index", "pid": 1, "tid": number, "args": {"sort_index": number}}
        )
    lines = [json.dumps(event, separators=(",", ":")) for event in events]
    names = {name: json.dumps(name) for _, name, *_ in ordered}
    lines += [
        f'{{"ph":"X","name":{names[name]},"pid":1,"tid":{lanes[lane]},"ts":{begin - origin},"dur":{duration},'
        f'"args":{{"frame":{frame}}}}}'
        for lane, name, begin, duration, frame in ordered
    ]
    return '{"displayTimeUnit":"ms","traceEvents":[\n' + ",\n".join(lines) + "\n]}\n"
