"""What the process cost so far, as the operating system counts it."""

from __future__ import annotations

import os
import re
import resource
import time
from pathlib import Path


def cpu_s() -> float:
    """CPU time of all threads of this process, user and system, seconds."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def peak_memory_mb() -> float:
    """Largest resident memory of this program so far, MB (10^6 bytes)."""
    # The kernel's own count starts anew with a program; getrusage's goes on from the one that started it.
    status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
    found = re.search(r"^VmHWM:\s+(\d+) kB$", status, re.MULTILINE)
    if found:
        return int(found.group(1)) * 1024 / 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def process_start() -> float:
    """When this process started, on the clock of time.monotonic, to 10 ms."""
    # Field 22 of /proc/self/stat, in clock ticks since boot; the second field may hold blanks and brackets.
    fields = Path("/proc/self/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
    started_since_boot = int(fields[19]) / os.sysconf("SC_CLK_TCK")
    age = time.clock_gettime(time.CLOCK_BOOTTIME) - started_since_boot
    return time.monotonic() - age
