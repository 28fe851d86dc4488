"""Use jsPsych as a peer: a page with its survey of rated statements."""

import functools
import html
import json
import shutil
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from tests.benchmarks.peers.environment import npm_peer

VERSION, PLUGIN_VERSION = "8.3.0", "2.2.0"
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Questionnaire</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<script src="jspsych.js"></script><script src="likert.js"></script>
<link rel="stylesheet" href="jspsych.css"></head><body></body>
<script>
const jsPsych = initJsPsych();
jsPsych.run([{{ type: jsPsychSurveyLikert, questions: {questions} }}]);
</script></html>
"""


@contextmanager
def served_survey(folder: Path, statements: Sequence[str], steps: Sequence[str]) -> Iterator[str]:
    """Yield the URL of a page that shows all statements, each with these answer steps.

    Raises:
        NoPeer: jsPsych could not be installed.
    """
    folder.mkdir()
    _write(folder, statements, steps)
    handler = functools.partial(_Quiet, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        try:
            yield f"http://localhost:{server.server_port}/index.html"
        finally:
            server.shutdown()
            thread.join()


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - its own name
        """Suppress log messages."""


def _write(folder: Path, statements: Sequence[str], steps: Sequence[str]) -> None:
    modules = npm_peer(
        "jspsych", f"jspsych@{VERSION}", f"@jspsych/plugin-survey-likert@{PLUGIN_VERSION}"
    )
    likert = modules / "@jspsych" / "plugin-survey-likert" / "dist" / "index.browser.min.js"
    for source, name in (
        (modules / "jspsych" / "dist" / "index.browser.min.js", "jspsych.js"),
        (modules / "jspsych" / "css" / "jspsych.css", "jspsych.css"),
        (likert, "likert.js"),
    ):
        shutil.copyfile(source, folder / name)
    labels = [html.escape(step) for step in steps]
    questions = [{"prompt": html.escape(one), "labels": labels} for one in statements]
    (folder / "index.html").write_text(PAGE.format(questions=json.dumps(questions)))
