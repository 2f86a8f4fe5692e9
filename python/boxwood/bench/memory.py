"""memory.py: how much memory does a call need?

Linux keeps the most that a process has held at once, and begins anew when it is told to. Elsewhere nobody knows: then a
call needs nothing, and there is room without end.
"""

import math


def _bytes_of(path, field):
    try:
        with open(path, encoding="ascii") as file:
            return next(int(line.split()[1]) * 1024 for line in file if line.startswith(field + ":"))
    except (OSError, StopIteration):
        return None


def room():
    """What a process may take before the machine has none left."""
    free = _bytes_of("/proc/meminfo", "MemAvailable")
    return math.inf if free is None else free


def need_of(call):
    """call(), and the bytes that it held on top of what was held before."""
    try:
        with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
            file.write("5")  # the peak is what is held now
    except OSError:
        return call(), 0
    before = _bytes_of("/proc/self/status", "VmRSS")
    answer = call()
    peak = _bytes_of("/proc/self/status", "VmHWM")
    return answer, 0 if before is None or peak is None else max(0, peak - before)
