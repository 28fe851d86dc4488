"""Report a tree's structure: `python -m tests.architecture [walks | repeats] [--json] [COMMIT]`.

Without a word it measures how the files import each other (`tests.architecture.measure`); `walks`
follows four pieces of data through the running code (`tests.architecture.walks`), and `repeats`
lists duplicate code (`tests.architecture.repetition`). All of them read the working tree, or a
commit.
"""

# ruff: noqa: T201  # what it prints is what it is for

import argparse
import json
import subprocess
import sys
from dataclasses import asdict

from tests.architecture.measure import measure, table
from tests.architecture.repetition import repeats
from tests.architecture.trees import tree_of
from tests.architecture.walks import walks, written

USAGE_ERROR = 2


def main(arguments: list[str]) -> int:
    """Print a table or JSON; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.architecture", description=__doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("commit", nargs="?", help="a commit instead of the working tree")
    walking, repeating = arguments[:1] == ["walks"], arguments[:1] == ["repeats"]
    given = parser.parse_args(arguments[1:] if walking or repeating else arguments)
    try:
        with tree_of(given.commit) as root:
            if walking:
                walked = walks(root)
                figures = {name: walk.as_json() for name, walk in walked.items()}
                print(json.dumps(figures, indent=1) if given.json else written(walked))
            elif repeating:
                repeated = repeats(root)
                counts = {"repeats": len(repeated), "lines": sum(one.lines for one in repeated)}
                listed = [asdict(one) for one in repeated]
                print(
                    json.dumps({**counts, "list": listed}, indent=1)
                    if given.json
                    else "\n".join(
                        [
                            *(f"{one.lines:4} {one.first} ~ {one.again}" for one in repeated),
                            "{repeats} repeats, {lines} lines".format(**counts),
                        ]
                    )
                )
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
