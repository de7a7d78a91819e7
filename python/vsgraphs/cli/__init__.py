"""The program `vsgraphs`."""

from __future__ import annotations

import sys


def main() -> None:
    """Entry point: runs the command line and ends the process with its exit code."""
    import os

    # numpy's linear algebra would start a thread per core, which nothing here uses. Before numpy is imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from vsgraphs.cli.failures import told
    from vsgraphs.cli.streams import flush_output, prepare_streams

    prepare_streams()
    try:
        with told():
            from vsgraphs.compiled import check_processor

            check_processor()  # before numpy, which an old processor does not run, and says so less kindly
            from vsgraphs.cli.app import app

            app()
    finally:
        flush_output()
    sys.exit(0)
