"""A partner as somebody would write it with nothing but docs/crossing.md and Python's own modules.

Run as a script: HOST:PORT NAME DELAYS_SEED FAULT. It walks 1 cm a step towards everybody's mean,
and tries to connect for half a minute.
"""

import json
import os
import random
import socket
import sys
import time


def main() -> None:
    """Take part until the scene ends, or until the fault that was asked for."""
    address, name, seed, fault = sys.argv[1:]
    host, port = address.split(":")
    delays = random.Random(seed)  # noqa: S311 - delays, no secrets
    connection = _connected(host, int(port))
    received, x_m, steps = connection.makefile("r", encoding="utf-8"), 20.0, 0

    def say(message: dict[str, object]) -> None:
        connection.sendall(json.dumps(message).encode() + b"\n")

    token = "wrong" if fault == "token" else os.environ.get("REEMBODY_PARTNER_TOKEN", "")
    say({"type": "hello", "protocol": 1, "partner": name, "token": token})
    for line in received:
        message = json.loads(line)
        if message["type"] == "end":
            return
        if message["type"] == "step":
            steps += 1
            others = [other["x_m"] for other in message["others"]]
            x_m += 0.01 if sum(others) > x_m * len(others) else -0.01
            if seed != "0" and delays.random() < 0.2:
                time.sleep(delays.random() * 0.01)
        if steps == 20 and fault == "dies":
            os._exit(3)
        if steps == 20 and fault == "hangs":
            time.sleep(60.0)
        actor = {"name": name, "kind": "person", "x_m": x_m, "y_m": 6.0, "heading_rad": 0.0,
                 "speed_m_s": 0.5, "length_m": 0.5, "width_m": 0.5}  # fmt: skip
        if steps == 20 and fault == "misspells":
            actor["speed"] = actor.pop("speed_m_s")
        say({"type": "state", "time_s": message.get("to_s", 0.0), "actors": [actor]})


def _connected(host: str, port: int) -> socket.socket:
    until_s = time.monotonic() + 30.0
    while True:
        try:
            return socket.create_connection((host, port))
        except ConnectionRefusedError:
            if time.monotonic() > until_s:
                raise
            time.sleep(0.1)


if __name__ == "__main__":
    main()
