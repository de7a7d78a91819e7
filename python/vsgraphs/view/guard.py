"""Runs a program that ends when this one's input does: with whoever started it, however that ended.

A program, not a module: python guard.py PROGRAM ARGUMENTS..., as the leader of a process group of its own.
Nobody writes to its input; the kernel closes it when the other end's process is gone, also after kill -9.
"""

import os
import resource
import select
import signal
import subprocess
import sys

_LOOK_S = 0.2


def main() -> None:
    """Ends itself too, with all that the program has started."""
    try:
        most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        resource.setrlimit(
            resource.RLIMIT_NOFILE, (most, most)
        )  # Rerun's server aborts where it has none left
        program = subprocess.Popen(sys.argv[1:], stdin=subprocess.DEVNULL)
        while program.poll() is None and not select.select([sys.stdin], [], [], _LOOK_S)[0]:
            pass
    finally:
        os.killpg(0, signal.SIGKILL)


if __name__ == "__main__":
    main()
