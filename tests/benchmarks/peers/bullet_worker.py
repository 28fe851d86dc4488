"""Run PyBullet in an interpreter that has it: read a plan from standard input, print figures.

Only the standard library and PyBullet are used here. `avatar` simulates the body of `bullet_body`;
`humanoid` simulates PyBullet's own humanoid, limp. Times are seconds of processor time.
"""

import importlib
import json
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

Plan = dict[str, Any]
_UP = [0.0, 1.0, 0.0]
_TAKES_UP = 6
"""Errors count after the first 1/n of the movement."""


class Avatar:
    """The avatar's body in its scene, simulated by PyBullet."""

    def __init__(self, bullet: Any, plan: Plan) -> None:
        self._bullet, self._plan = bullet, plan
        _empty_world(bullet, plan["timestep_s"])
        bullet.setPhysicsEngineParameter(numSolverIterations=plan["iterations"])
        self.body = bullet.loadURDF(
            plan["urdf"],
            plan["hips_m"],
            useFixedBase=True,
            flags=bullet.URDF_USE_SELF_COLLISION | bullet.URDF_USE_INERTIA_FROM_FILE,
        )
        _add_scene(bullet, plan)
        self.joints, self.links = self._names()
        self._choose_partners()
        for link in range(-1, bullet.getNumJoints(self.body)):
            # By default, Bullet damps every body a little.
            bullet.changeDynamics(self.body, link, linearDamping=0.0, angularDamping=0.0)
        for joint, angle in zip(self.joints, plan["targets_rad"][0], strict=True):
            bullet.resetJointState(self.body, joint, angle)

    def aim(self, step: int) -> None:
        """Set all motors' targets."""
        plan, bullet = self._plan, self._bullet
        bullet.setJointMotorControlArray(
            self.body,
            self.joints,
            bullet.POSITION_CONTROL,
            targetPositions=plan["targets_rad"][step],
            targetVelocities=plan["speeds_rad_s"][step],
            forces=plan["max_torques_nm"],
            positionGains=plan["position_gains"],
            velocityGains=plan["speed_gains"],
        )

    def run(self, every: int) -> None:
        """Simulate all targets, setting new ones every given number of steps."""
        step_on, count = self._bullet.stepSimulation, len(self._plan["targets_rad"])
        for first in range(0, count, every):
            last = min(first + every, count) - 1
            self.aim(last)
            for _ in range(first, last + 1):
                step_on()

    def errors_rad(self) -> list[float]:
        """Simulate all targets; return the mean error of all axes after each step."""
        found = []
        for step, targets in enumerate(self._plan["targets_rad"]):
            self.aim(step)
            self._bullet.stepSimulation()
            states = self._bullet.getJointStates(self.body, self.joints)
            gaps = [abs(state[0] - target) for state, target in zip(states, targets, strict=True)]
            found.append(sum(gaps) / len(gaps))
        return found

    def mass_kg(self) -> float:
        """Return the mass of all links."""
        links = range(-1, self._bullet.getNumJoints(self.body))
        return sum(float(self._bullet.getDynamicsInfo(self.body, link)[0]) for link in links)

    def _names(self) -> tuple[list[int], dict[str, int]]:
        joints: dict[str, int] = {}
        links = {self._bullet.getBodyInfo(self.body)[0].decode(): -1}
        for row in range(self._bullet.getNumJoints(self.body)):
            told = self._bullet.getJointInfo(self.body, row)
            joints[told[1].decode()] = row
            links[told[12].decode()] = row
        return [joints[name] for name in self._plan["axes"]], links

    def _choose_partners(self) -> None:
        parts = sorted(self.links.values())
        for first in parts:
            for second in parts:
                if first < second:
                    self._bullet.setCollisionFilterPair(self.body, self.body, first, second, 0)
        for one, other in self._plan["pairs"]:
            first, second = self.links[one], self.links[other]
            self._bullet.setCollisionFilterPair(self.body, self.body, first, second, 1)


def avatar(bullet: Any, plan: Plan) -> Plan:
    """Run rounds of each variant; return the body's properties and its tracking error."""
    found: Plan = {"ways": []}
    for way in plan["ways"]:
        made = Avatar(bullet, {**plan, **way})
        errors = made.errors_rad()[len(plan["targets_rad"]) // _TAKES_UP :]
        rounds = [
            _run_s(Avatar(bullet, {**plan, **way}), way["every"]) for _ in range(plan["rounds"])
        ]
        error_deg = math.degrees(sum(errors) / len(errors))
        found["ways"].append({"rounds_s": rounds, "mean_error_deg": error_deg})
        found |= {"axes": len(made.joints), "mass_kg": made.mass_kg()}
    return found


def humanoid(bullet: Any, plan: Plan) -> Plan:
    """Run rounds of steps of PyBullet's own humanoid, falling onto a floor."""
    folder = Path(importlib.import_module("pybullet_data").getDataPath())
    rounds = []
    for _ in range(plan["rounds"]):
        _empty_world(bullet, plan["timestep_s"])
        # Its file is in quarters of a metre, as PyBullet's own examples load it.
        bullet.loadURDF(
            str(folder / "humanoid" / "humanoid.urdf"), [0.0, 0.9, 0.0], globalScaling=0.25
        )
        _add_floor(bullet)
        rounds.append(_timed_s(lambda: _steps(bullet, plan["steps"])))
    return {"steps_s": rounds}


def _run_s(made: Avatar, every: int) -> float:
    return _timed_s(lambda: made.run(every))


def _empty_world(bullet: Any, timestep_s: float) -> None:
    bullet.resetSimulation()
    bullet.setTimeStep(timestep_s)
    bullet.setGravity(0.0, -9.81, 0.0)


def _add_floor(bullet: Any) -> None:
    bullet.createMultiBody(0, bullet.createCollisionShape(bullet.GEOM_PLANE, planeNormal=_UP))


def _add_scene(bullet: Any, plan: Plan) -> None:
    if plan["floor"]:
        _add_floor(bullet)
    for box in plan["boxes"]:
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=box["half_size_m"])
        bullet.createMultiBody(0, shape, basePosition=box["center_m"])


def _steps(bullet: Any, count: int) -> None:
    for _ in range(count):
        bullet.stepSimulation()


def _timed_s(work: Callable[[], None]) -> float:
    start_s = time.process_time()
    work()
    return time.process_time() - start_s


def main() -> None:
    """Read the plan from standard input and run it."""
    bullet = importlib.import_module("pybullet")
    plan: Plan = json.load(sys.stdin)
    bullet.connect(bullet.DIRECT)
    print("\n" + json.dumps({"avatar": avatar, "humanoid": humanoid}[plan["kind"]](bullet, plan)))


if __name__ == "__main__":
    main()
