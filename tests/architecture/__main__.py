"""`python -m tests.architecture [walks] [--json] [COMMIT]`: the structure of the house.

Without a word it measures how the files import each other (`tests.architecture.measure`); `walks`
follows four pieces of data through the running code (`tests.architecture.walks`). Both look at the
working tree, or at a commit.
"""

# ruff: noqa: T201  # what it prints is what it is for

import argparse
import json
import subprocess
import sys

from tests.architecture.measure import measure, table
from tests.architecture.trees import tree_of
from tests.architecture.walks import walks, written

USAGE_ERROR = 2


def main(arguments: list[str]) -> int:
    """Print a table, or JSON; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.architecture", description=__doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("commit", nargs="?", help="a commit instead of the working tree")
    walking = arguments[:1] == ["walks"]
    given = parser.parse_args(arguments[1:] if walking else arguments)
    try:
        with tree_of(given.commit) as root:
            if walking:
                walked = walks(root)
                figures = {name: walk.as_json() for name, walk in walked.items()}
                print(json.dumps(figures, indent=1) if given.json else written(walked))
            else:
                result = measure(root)
                print(json.dumps(result.as_json(), indent=1) if given.json else table(result))
    except subprocess.CalledProcessError:
        if given.commit is None or walking:
            raise
        print(
            f"there is no commit {given.commit!r} here; give a hash, a branch or a tag",
            file=sys.stderr,
        )
        return USAGE_ERROR
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
