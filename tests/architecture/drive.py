"""Run the four walks in this process and print, as JSON, which files of `app` they enter.

A script, not a module of the tests: `python -P drive.py ROUNDS`, run in the tree to examine and
with PYTHONPATH there, so that the same file can drive any commit. Of the product it imports only
`create_app`, `Settings` and `encode_batch`; everything else goes through HTTP and the headset's
socket.
"""

import concurrent.futures
import io
import json
import secrets
import sys
import tempfile
import threading
import time
import uuid
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any
from unittest.mock import patch

Json = dict[str, Any]
STUDY = "reembodiment-latency"
PASSWORD = "correct horse battery"
FORM = "block1.hand.karas2020"
ANSWERS: Json = {f"q{number}": 4 for number in range(1, 15)} | {"problems": "Nothing at all."}
IDLE_S = 6.0
"""How long the idle server is watched; its slowest timer fires every five seconds."""
CALLABLE = 0x1
"""CO_OPTIMIZED: the code of a function, lambda or comprehension, not of a module or class."""
AGAIN = 0x20 | 0x80 | 0x200
"""CO_GENERATOR, CO_COROUTINE, CO_ASYNC_GENERATOR: entered again whenever they resume."""


class Recorder:
    """A recorder of the file of every function of `app` that is called, in every thread.

    It records only while it is on. A thread that calls functions while the server gets no requests
    is driven by a timer: its calls are left out after `leave_out_timers` has found it.
    """

    def __init__(self) -> None:
        import app

        self.on = False
        self._root = str(Path(app.__file__).parents[1]) + "/"
        self._within = f"{self._root}app/"
        self._noted: list[tuple[int, str]] = []
        self._timers: set[int] = set()

    def profile(self, frame: FrameType, event: str, _: Any) -> None:
        """Record a call; pass this to `sys.setprofile`."""
        code = frame.f_code
        if not self.on or event != "call" or not code.co_flags & CALLABLE:
            return
        if not code.co_filename.startswith(self._within) or _goes_on(frame):
            return
        self._noted.append((threading.get_ident(), code.co_filename.removeprefix(self._root)))

    @contextmanager
    def recording(self) -> Iterator[None]:
        """Record while the block runs."""
        self.on = True
        try:
            yield
        finally:
            self.on = False

    def leave_out_timers(self) -> None:
        """Watch the idle server for a while to find its timer threads."""
        with self.recording():
            time.sleep(IDLE_S)
        self._timers = {thread for thread, _ in self._noted}

    def taken(self) -> list[str]:
        """Return, in order, the files entered since this method was called last.

        Calls within a file count once.
        """
        noted, self._noted = self._noted, []
        files = [file for thread, file in noted if thread not in self._timers]
        return [file for file, before in zip(files, [None, *files], strict=False) if file != before]


def _goes_on(frame: FrameType) -> bool:
    """Return whether this call resumes a generator or coroutine that was entered before."""
    if not frame.f_code.co_flags & AGAIN:
        return False
    resume = frame.f_code.co_code[frame.f_lasti + 1] if frame.f_lasti >= 0 else 0
    return bool(resume & 3)


class InThisProcess(concurrent.futures.ThreadPoolExecutor):
    """A thread in place of a process pool, so that its computations are recorded, too."""

    def __init__(self, max_workers: int = 1, **_: Any) -> None:
        super().__init__(max_workers)


class Lab:
    """A running application and its operator."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self.post("/api/login", json={"username": "admin", "password": PASSWORD})

    def post(self, path: str, **more: Any) -> Any:
        """Send a POST request and return the decoded response."""
        return _json(self.client.post(path, **more))

    def get(self, path: str, **more: Any) -> Any:
        """Send a GET request and return the decoded response."""
        return _json(self.client.get(path, **more))

    def join(self) -> Json:
        """Create a session."""
        view: Json = self.post(f"/api/studies/{STUDY}/sessions", json={})
        return view

    def command(self, view: Json, kind: str, **fields: Any) -> Json:
        """Send a command and return the session as it is afterwards."""
        body = {"command_id": str(uuid.uuid4()), "expected_version": view["version"], "type": kind}
        after: Json = self.post(f"/api/sessions/{view['id']}/commands", json={**body, **fields})
        return after

    def at_step(self, key: str) -> Json:
        """Create a session that is at this step."""
        view = self.command(self.join(), "start")
        while view["steps"][view["current"]["index"]]["key"] != key:
            view = self.command(view, "skip", reason="not in this walk")
        return view

    def stranger(self) -> Any:
        """Return a client with its own cookies, on the same event loop."""
        from fastapi.testclient import TestClient

        client = TestClient(self.client.app)
        client.portal = self.client.portal
        return client

    def paired(self, view: Json, device: str) -> tuple[Any, Json]:
        """Return a device's client and the response to its pairing."""
        code = self.post(f"/api/sessions/{view['id']}/pairings", json={"device": device})["code"]
        client = self.stranger()
        return client, _json(client.post("/api/devices/pair", json={"code": code}))


def frame_to_csv(lab: Lab, recorder: Recorder) -> None:
    """Follow a batch of nine frames from the socket to its acknowledgement and its CSV rows.

    Only the part of the export that writes the file with the frames is recorded.
    """
    view = lab.at_step("free_roam")
    _, device = lab.paired(view, "headset")
    offered = ["reembody.v1", f"bearer.{device['token']}"]
    with lab.client.websocket_connect("/api/vr/stream", subprotocols=offered) as socket:
        # The commit's shipped study may use a physics avatar or a delayed copy.
        avatars = ["delayed_copy", "physics"]
        hello = {"type": "hello", "protocol": 1, "client": "walk", "avatars": avatars}
        socket.send_text(json.dumps(hello))
        epoch = _heard(socket, "welcome")["epoch"]
        socket.send_bytes(_batch(epoch, 0))
        _acknowledged(socket, 9)
        # The second batch: objects created once per connection exist by now.
        with recorder.recording():
            socket.send_bytes(_batch(epoch, 9))
            _acknowledged(socket, 18)
        with _recorded_member(recorder, "samples/"):
            answer = lab.client.get(f"/api/studies/{STUDY}/export?kind=all")
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        table = archive.read(next(name for name in archive.namelist() if view["id"] in name))
    if table.count(b"\n") != 19:
        raise RuntimeError("the frames did not arrive in the CSV")


def answer_to_score(lab: Lab, recorder: Recorder) -> None:
    """Follow a completed questionnaire from the tablet's request to its stored scores."""
    view = lab.at_step(FORM)
    tablet, _ = lab.paired(view, "tablet")
    form = _json(tablet.get("/api/tablet/state"))["administration"]
    body = {
        "idempotency_key": secrets.token_hex(16),
        "administration": form["key"],
        "answers": ANSWERS,
        "shown_order": form["item_order"],
        "seed": form["seed"],
        "language": "en",
    }
    with recorder.recording():
        answer = tablet.post("/api/tablet/submissions", json=body)
    if not _json(answer) or not lab.get(f"/api/sessions/{view['id']}/answers")[0]["scores"]:
        raise RuntimeError("no score was stored")


def command_to_event(lab: Lab, recorder: Recorder) -> None:
    """Follow the operator's `start` from the request to the event log and back to the page."""
    view = lab.join()
    with recorder.recording():
        lab.command(view, "start")
    events = [event["type"] for event in lab.get(f"/api/sessions/{view['id']}/events")]
    if events != ["session_started"]:
        raise RuntimeError(f"the log holds {events}")


def capture_to_bvh(lab: Lab, recorder: Recorder) -> None:
    """Follow a BVH file from its upload to the same movement on an avatar of 165 cm, as BVH."""
    # A different file each time, so that no cached result is used.
    capture = _capture(frames=40 + secrets.randbelow(10_000) / 10_000)
    with recorder.recording():
        view = lab.post("/api/captures", params={"name": "walk.bvh"}, content=capture)
        path = f"/api/captures/{view['id']}/retargeted?avatar=165cm&format=bvh"
        kept = lab.client.get(path)
    if not kept.text.startswith("HIERARCHY"):
        raise RuntimeError(kept.text[:300])


WALKS: dict[str, Callable[[Lab, Recorder], None]] = {
    "frame to CSV": frame_to_csv,
    "answer to score": answer_to_score,
    "command to event": command_to_event,
    "capture to BVH": capture_to_bvh,
}


def _json(answer: Any) -> Any:
    if not answer.is_success:
        raise RuntimeError(f"{answer.request.method} {answer.request.url}: {answer.text}")
    return answer.json() if answer.content else None


def _heard(socket: Any, kind: str) -> Json:
    while True:
        message: Json = json.loads(socket.receive_text())
        if message["type"] == kind:
            return message


def _acknowledged(socket: Any, next_seq: int) -> None:
    while all(one["next_seq"] != next_seq for one in _heard(socket, "ack")["positions"]):
        pass


def _batch(epoch: int, seq: int) -> bytes:
    import numpy as np

    from app.wire import VALUES_PER_FRAME, StreamName, encode_batch

    values = np.zeros((9, VALUES_PER_FRAME), np.float32)
    values[:, 1] = 1.0  # a metre above the floor
    values[:, 3::4] = 1.0  # no rotation
    times_s = (seq + np.arange(9)) / 90.0
    return encode_batch(
        StreamName.TARGET,
        epoch=epoch,
        phase_id=0,
        seq_first=seq,
        times_s=times_s,
        flags=np.zeros(9, np.uint8),
        values=values,
        active_s=0.0,
        closed_at_s=float(times_s[-1]),
    )


@contextmanager
def _recorded_member(recorder: Recorder, folder: str) -> Iterator[None]:
    """Record calls while a file of this folder is written into a ZIP archive."""
    opened = zipfile.ZipFile.open

    def noting(self: Any, name: Any, mode: Any = "r", *args: Any, **kwargs: Any) -> Any:
        file = opened(self, name, mode, *args, **kwargs)
        recorder.on = getattr(name, "filename", "").startswith(folder)
        return file

    try:
        with patch.object(zipfile.ZipFile, "open", noting):
            yield
    finally:
        recorder.on = False


def _capture(*, frames: float) -> bytes:
    """Return a capture of a standing body, 40 frames at 30 a second, shifted by the fraction."""
    joints = {
        "Hips": (None, (0, 0, 0)),
        "Spine": ("Hips", (0, 10, 0)),
        "Neck": ("Spine", (0, 40, 0)),
        "Head": ("Neck", (0, 12, 0)),
    }
    for side, sign in (("Left", 1), ("Right", -1)):
        joints |= {
            f"{side}Shoulder": ("Spine", (5 * sign, 35, 0)),
            f"{side}Arm": (f"{side}Shoulder", (12 * sign, 0, 0)),
            f"{side}ForeArm": (f"{side}Arm", (28 * sign, 0, 0)),
            f"{side}Hand": (f"{side}ForeArm", (25 * sign, 0, 0)),
            f"{side}UpLeg": ("Hips", (10 * sign, -5, 0)),
            f"{side}Leg": (f"{side}UpLeg", (0, -42, 0)),
            f"{side}Foot": (f"{side}Leg", (0, -41, 0)),
            f"{side}ToeBase": (f"{side}Foot", (0, -6, 14)),
        }

    def lines(name: str) -> list[str]:
        parent, offset = joints[name]
        inner = [line for one, (above, _) in joints.items() if above == name for line in lines(one)]
        turns = "Zrotation Xrotation Yrotation"
        places = "" if parent else "Xposition Yposition Zposition "
        return [
            f"{'JOINT' if parent else 'ROOT'} {name}",
            "{",
            "OFFSET " + " ".join(map(str, offset)),
            f"CHANNELS {3 if parent else 6} {places}{turns}",
            *(inner or ["End Site", "{", "OFFSET 0 0 10", "}"]),
            "}",
        ]

    order = [line.split()[1] for line in lines("Hips") if line.startswith(("ROOT", "JOINT"))]
    count = int(frames)
    motion = [
        " ".join(map(str, [frames - count, 94, at, *([0] * 3 * len(order))])) for at in range(count)
    ]
    head = ["HIERARCHY", *lines("Hips"), "MOTION", f"Frames: {count}", f"Frame Time: {1 / 30}"]
    return ("\n".join([*head, *motion]) + "\n").encode()


def main(rounds: int) -> None:
    """Run each walk once to load everything, then `rounds` times; print the files of each."""
    from fastapi.testclient import TestClient
    from pydantic import SecretStr

    import app
    from app.main import create_app
    from app.settings import Settings

    if not Path(app.__file__).is_relative_to(Path.cwd()):
        raise RuntimeError(f"{app.__file__} is not of the tree in {Path.cwd()}")
    recorder = Recorder()
    walked: dict[str, list[list[str]]] = {name: [] for name in WALKS}
    with tempfile.TemporaryDirectory() as folder:
        threading.setprofile(recorder.profile)
        sys.setprofile(recorder.profile)
        settings = Settings(
            data_dir=Path(folder),
            database_url=f"sqlite:///{folder}/walks.sqlite",
            admin_password=SecretStr(PASSWORD),
        )
        with TestClient(create_app(settings)) as client:
            lab = Lab(client)
            recorder.leave_out_timers()
            for name, walk in WALKS.items():
                for at in range(rounds + 1):
                    recorder.taken()
                    walk(lab, recorder)
                    if at > 0:
                        walked[name].append(recorder.taken())
        sys.setprofile(None)
        threading.setprofile(None)
    sys.stdout.write(json.dumps(walked))


if __name__ == "__main__":
    with patch("concurrent.futures.ProcessPoolExecutor", InThisProcess):
        main(int(sys.argv[1]))
