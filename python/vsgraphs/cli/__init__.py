"""The program `vsgraphs`."""

from __future__ import annotations

import os
import sys


def main() -> None:
    """Entry point: runs the command line and ends the process with its exit code."""
    try:
        from vsgraphs.cli.interrupt import leave_at_once, let_die

        leave_at_once()
    except KeyboardInterrupt:
        os._exit(130)
    # numpy's linear algebra would start a thread per core, which nothing here uses. Before numpy is imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from vsgraphs.cli.failures import told
    from vsgraphs.cli.streams import flush_output, prepare_streams

    prepare_streams()
    try:
        try:
            with told():
                from vsgraphs.compiled import check_processor

                # Before numpy, which an old processor does not run either, and says so less kindly.
                check_processor()
                from vsgraphs.cli.app import app

                app()
        finally:
            flush_output()
        sys.exit(0)
    finally:
        let_die()
