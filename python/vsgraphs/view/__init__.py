"""Watching a run and its result in the Rerun viewer (rerun.io).

An optional extra: pip install 'vsgraphs[viz]'. Rerun itself is loaded when sinks are opened.
"""

from vsgraphs.view.finished import check_run, show_run
from vsgraphs.view.live import LiveView
from vsgraphs.view.ports import LOOPBACK as DEFAULT_ADDRESS
from vsgraphs.view.sinks import DEFAULT_PORT, SinkRequest, Sinks, open_sinks

__all__ = [
    "DEFAULT_ADDRESS",
    "DEFAULT_PORT",
    "LiveView",
    "SinkRequest",
    "Sinks",
    "check_run",
    "open_sinks",
    "show_run",
]
