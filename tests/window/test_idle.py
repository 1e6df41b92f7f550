"""An unchanged view uses almost no processor time."""

import os
import pathlib
import time
import unittest

from real_window import WindowTest

WATCHED_S = 5.0
MOST_SHARE = 0.01  # share of a core
CALM_S = 60.0


def processor_s(pid):
    """Processor seconds of all threads of a process, since it began."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Idle(WindowTest):
    def test_a_settled_view_costs_nothing(self):
        viewer = self.start("--camera", "46,7,3000000,30,-50", bare=False)
        shares = []
        end = time.monotonic() + CALM_S
        # The first frames compile and load: the share is that of the calmest watch.
        while not shares or (shares[-1] > MOST_SHARE and time.monotonic() < end):
            before, start = processor_s(viewer.program.pid), time.monotonic()
            time.sleep(WATCHED_S)
            shares.append((processor_s(viewer.program.pid) - before) / (time.monotonic() - start))
        print(f"{100.0 * shares[-1]:.2f} % of a core")
        self.assertLessEqual(shares[-1], MOST_SHARE, shares)


if __name__ == "__main__":
    unittest.main()
