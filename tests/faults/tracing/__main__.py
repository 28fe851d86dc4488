"""Run `python -m tests.faults.tracing RECORD FOLDER -- COMMAND ...`.

The exit code is 77 if the kernel does not allow tracing.
"""

import sys
from pathlib import Path

from tests.faults.tracing.tracer import trace

if __name__ == "__main__":
    record, folder, _, *command = sys.argv[1:]
    sys.exit(trace(Path(record), Path(folder), command))
