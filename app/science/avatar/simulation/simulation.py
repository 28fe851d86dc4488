"""Simulate a physics avatar: one body in one scene, stepped on the study's clock.

Its motors pull each hinge towards a target angle and a target speed; limits, contacts and torque
limits decide how far they get. Time runs in steps of 2 ms. A frame gives the participant's pose at
its time, and `step_to` simulates the time before it: over the steps since the last frame, target
angles and hips move in a straight line from the previous ones to the new ones, and the target speed
is the slope of that line. Nothing is predicted, and at the frame's own time the target is the
frame's own.

Irregular input from a tracker is handled as follows:

- A target that jumps moves at most at `MAX_SPEED_RAD_S`, faster than people turn their joints; and
  no motor exceeds its torque limit. So a limb follows a jump immediately, but with limited speed.
- Hips that jump by more than `hips_path.TELEPORT_M` or `TELEPORT_RAD` are teleported: moved there
  immediately, at rest, with all joint angles unchanged.
- A value that is not finite is ignored; that hinge, or the hips, keep their target.
- A part that is then deep inside a wall, or inside another part, is pushed out gently
  (`soft_contacts`).
- If the simulation still fails (a state that is not finite, to which MuJoCo would respond by
  restarting at time zero, or speeds above `FAILURE_RAD_S`), the angles before the frame are
  restored, at rest and within their limits, and the clock continues.

`health` counts each of these. Added latency (`switches.set_delay`) delays the motors' targets by
whole steps, inside the simulation; the hips are never delayed, and zero bypasses the buffer.
"""

import logging
from dataclasses import dataclass
from math import isfinite

import numpy as np

from app.science.avatar.body import AXES
from app.science.avatar.mjcf import HingeTable, SimulationError, hinge_table
from app.science.avatar.simulation.contacts import Contact, read_contacts
from app.science.avatar.simulation.hips_path import HipsPath
from app.science.avatar.simulation.soft_contacts import SoftContacts
from app.science.avatar.simulation.switches import Boxes, Switches
from app.science.rotations import FloatArray


@dataclass(frozen=True, eq=False)
class AvatarState:
    """The avatar's pose at one moment.

    Attributes:
        time_s: steps taken times 2 ms.
        root_position_m: (3,) the hips' joint in the world.
        rotations: (22, 4) local rotations wxyz as in `skeleton`; row 0 is world_from_hips.
        angles_rad: (91,) angles in the order of `AXIS_NAMES`; NaN where the model has no hinge.
        command_rad: (91,) likewise, the current targets before any added latency.
    """

    time_s: float
    root_position_m: FloatArray
    rotations: FloatArray
    angles_rad: FloatArray
    command_rad: FloatArray


@dataclass(frozen=True)
class Health:
    """Counts of irregular inputs and failures since the simulation started.

    Attributes:
        restored: frames after which the simulation had failed and was restored.
        ignored_inputs: frames with a value that was not finite.
        limited_targets: frames in which a target moved faster than `simulation.MAX_SPEED_RAD_S`.
        teleports: times the hips were teleported.
    """

    restored: int
    ignored_inputs: int
    limited_targets: int
    teleports: int


MAX_SPEED_RAD_S = 40.0
FAILURE_RAD_S = 1000.0
"""Norm of all speeds above which the simulation counts as failed; random poses as targets cause up
to 500."""
_FAILURE_ANGLES = 1e5
_AT_LIMIT = 1.0 - 1e-9
_log = logging.getLogger(__name__)


class PhysicsAvatar:
    """A running simulation of one avatar, which starts in the T-pose as far as its limits allow.

    Attributes:
        model, data: MuJoCo's own objects, for inspection.
        switches: the settings that can be changed while the simulation runs.
        hips, boxes: the hips' path; the scene's boxes, which can be shown and hidden.

    Raises:
        SimulationError: the text is not a MuJoCo model, or not one of `build_mjcf`.
    """

    def __init__(self, mjcf: str) -> None:
        import mujoco  # a server that never simulates loads neither MuJoCo nor the compiler

        from app.science.avatar.simulation import frame_kernels

        try:
            self.model: mujoco.MjModel = mujoco.MjModel.from_xml_string(mjcf)
        except ValueError as error:
            raise SimulationError(f"MuJoCo cannot load the model: {error}") from error
        self._mujoco, self._kernels = mujoco, frame_kernels
        # Without this MuJoCo writes warnings to a file in the current folder.
        mujoco.set_mju_user_warning(_log.warning)
        # Failures are handled here, not by MuJoCo's reset to time zero.
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self.data: mujoco.MjData = mujoco.MjData(self.model)
        self._table: HingeTable = hinge_table(self.model)
        # MuJoCo's own arrays; looking them up at every step costs as much as filling them.
        self._qpos, self._qvel, self._ctrl = self.data.qpos, self.data.qvel, self.data.ctrl
        self._step_s = float(self.model.opt.timestep)
        mujoco.mj_kinematics(self.model, self.data)
        self.hips = HipsPath(self.data, self._table)
        self.switches = Switches(self.model, self.data, self._table)
        self._soft_contacts = SoftContacts(self.model, self.data, self._table)
        self.boxes = Boxes(self.model, self._soft_contacts.soften_all)
        self._steps = self._restored = self._ignored_inputs = self._limited = 0
        self._speeds: FloatArray | None = None
        self._goal: FloatArray
        self._command: FloatArray
        self._reset_to(self._clamped(np.zeros(len(self._table.names))))

    @property
    def time_s(self) -> float:
        """Return the simulated time: steps taken times the time step."""
        return self._steps * self._step_s

    @property
    def parts(self) -> tuple[str, ...]:
        """Return the body parts that the model has."""
        return tuple(self._table.bodies)

    @property
    def axis_names(self) -> tuple[str, ...]:
        """Return the axes that have a hinge, in the model's order."""
        return self._table.names

    @property
    def health(self) -> Health:
        """Return the counts of irregular inputs and failures since the simulation started."""
        return Health(self._restored, self._ignored_inputs, self._limited, self.hips.teleports)

    def start_at(
        self, position_m: FloatArray, rotation: FloatArray, angles_rad: FloatArray
    ) -> None:
        """Put the avatar into a pose immediately and at rest, and fill the latency buffer with it.

        Args:
            position_m: (3,) the hips in the world.
            rotation: (4,) world_from_hips.
            angles_rad: (91,) finite, in the order of `AXIS_NAMES`; clamped to the limits.

        Raises:
            SimulationError: a value is not finite.
        """
        angles = angles_rad[self._table.columns]
        if not np.isfinite(angles).all():
            raise SimulationError("Every angle of a starting pose must be finite.")
        self.hips.teleport(position_m, rotation)
        self._soft_contacts.soften_all()
        self._reset_to(self._clamped(angles))

    def rewind(self) -> None:
        """Set the clock to zero and forget the latency buffer; call `start_at` next."""
        self._mujoco.mj_resetData(self.model, self.data)
        self._steps = 0

    def set_hips(self, position_m: FloatArray, rotation: FloatArray) -> None:
        """Set the pose of the hips at the time of the next `step_to`: (3,) and (4,) wxyz."""
        teleports = self.hips.teleports
        self._ignored_inputs += not self.hips.go_to(position_m, rotation)
        if self.hips.teleports > teleports:
            self._soft_contacts.soften_all()

    def set_targets(self, angles_rad: FloatArray, speeds_rad_s: FloatArray | None = None) -> None:
        """Set the target angles at the time of the next `step_to`.

        Args:
            angles_rad: (91,) angles in the order of `AXIS_NAMES`; clamped to the limits.
            speeds_rad_s: (91,) target speeds; None for the slope of the target angles.
        """
        angles = angles_rad[self._table.columns]
        # A sum of squares is finite only if every term is, and quicker than checking each.
        if not isfinite(np.dot(angles, angles)) and not (finite := np.isfinite(angles)).all():
            self._ignored_inputs += 1
            angles = np.where(finite, angles, self._goal)
        self._goal = angles
        self._speeds = None
        if speeds_rad_s is not None:
            speeds = np.nan_to_num(speeds_rad_s[self._table.columns])
            self._speeds = np.clip(speeds, -MAX_SPEED_RAD_S, MAX_SPEED_RAD_S)

    def step_to(self, time_s: float) -> None:
        """Simulate up to the step nearest to this time.

        Raises:
            SimulationError: the time is not finite, or lies before the avatar's.
        """
        step_s = self._step_s
        if not isfinite(time_s) or time_s < self.time_s - step_s:
            raise SimulationError(f"Time {time_s} s lies before the avatar's, {self.time_s:g} s.")
        count = round(time_s / step_s) - self._steps
        if count < 1:
            return
        previous_qpos = self._qpos.copy()
        self._simulate(count, step_s)
        self._steps += count
        self.hips.arrive()
        if self._failed():
            self._restore(previous_qpos)
        else:
            self._soft_contacts.watch()
        self._mujoco.mj_kinematics(self.model, self.data)

    def state(self) -> AvatarState:
        """Return the current pose, as joint rotations and as angles."""
        table, data = self._table, self.data
        rotations, angles, command = self._kernels.pose(
            data.xquat, table.parent_bodies, table.joint_bodies,
            self._qpos, table.angles, self._command, table.columns, len(AXES),
        )  # fmt: skip
        root = data.xpos[table.joint_bodies[0]].copy()
        return AvatarState(self.time_s, root, rotations, angles, command)

    def finger_rotations(self) -> FloatArray:
        """Return the current local rotations (30, 4) of the fingers, wxyz.

        A part that the model lacks, or that has no hinge, does not turn.
        """
        return np.asarray(
            self._kernels.local_rotations(
                self.data.xquat, self._table.above_fingers, self._table.finger_bodies
            )
        )

    def contacts(self) -> tuple[Contact, ...]:
        """Return the body's contacts in the last step."""
        return read_contacts(self.model, self.data)

    def torques_nm(self) -> FloatArray:
        """Return the motors' torques in the last step, in the order of `axis_names`."""
        torques: FloatArray = self.data.actuator_force[self._table.motors]
        return torques

    def saturated(self) -> tuple[str, ...]:
        """Return the axes whose motors were at their torque limits in the last step."""
        limit = self.model.actuator_forcerange[self._table.motors, 1]
        at_limit = np.abs(self.torques_nm()) >= limit * _AT_LIMIT
        return tuple(name for name, one in zip(self._table.names, at_limit, strict=True) if one)

    def stretched_rad(self) -> FloatArray:
        """Return the angle by which each motor's spring is stretched, in the order of `axis_names`.

        This is the command without any added latency minus the angle.
        """
        stretched: FloatArray = self._command - self._qpos[self._table.angles]
        return stretched

    def _clamped(self, angles: FloatArray) -> FloatArray:
        ranges = self.switches.ranges_rad
        return np.clip(angles, ranges[:, 0], ranges[:, 1])

    def _simulate(self, count: int, step_s: float) -> None:
        """Simulate the steps of one frame while targets and hips move to their new values."""
        self.switches.move_casts(count * step_s)
        slots = self._table.position_targets
        controls = np.empty((count, self._ctrl.shape[0]))
        last_command, limited = self._kernels.ramp(
            self._goal, self.switches.ranges_rad, self._command, slots,
            count * step_s, MAX_SPEED_RAD_S, controls,
        )  # fmt: skip
        self._limited += limited
        if self._speeds is not None:
            controls[:, slots + 1] = self._speeds
        step, model, data, ctrl = self._mujoco.mj_step, self.model, self.data, self._ctrl
        way = self.hips.way(count)
        for row in range(count):
            ctrl[:] = controls[row]
            if way is not None:
                self.hips.put(way[row])
            step(model, data)
        self._command = last_command

    def _failed(self) -> bool:
        qpos, qvel = self._qpos, self._qvel
        # Comparisons with NaN are false.
        return not (
            np.dot(qvel, qvel) < FAILURE_RAD_S**2 and np.dot(qpos, qpos) < _FAILURE_ANGLES**2
        )

    def _restore(self, previous_qpos: FloatArray) -> None:
        self._restored += 1
        data = self.data
        data.qpos[:] = previous_qpos
        data.qpos[self._table.angles] = self._clamped(previous_qpos[self._table.angles])
        data.qvel[:] = 0.0
        data.qacc_warmstart[:] = 0.0
        data.time = self.time_s
        self.hips.put_root()
        self._soft_contacts.soften_all()

    def _reset_to(self, angles: FloatArray) -> None:
        self._goal = self._command = angles
        self._speeds = None
        data, table = self.data, self._table
        data.qpos[table.angles] = angles
        data.qvel[:] = 0.0
        data.qacc_warmstart[:] = 0.0
        data.ctrl[table.position_targets] = angles
        data.ctrl[table.position_targets + 1] = 0.0
        for actuator in range(self.model.actuator_history.shape[0]):
            samples = int(self.model.actuator_history[actuator, 0])
            if samples:
                at = int(self.model.actuator_ctrladr[actuator])
                values = np.tile(data.ctrl[at : at + 2], (samples, 1))
                self._mujoco.mj_initCtrlHistory(self.model, data, actuator, None, values)
        self._mujoco.mj_kinematics(self.model, data)
