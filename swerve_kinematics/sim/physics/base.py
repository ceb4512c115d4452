# Copyright 2026 swerve_kinematics maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A base that is pushed by its tyres: the MuJoCo model with servos, seen as the sensors see it."""

import math
import operator
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.core.geometry.angles import scalar_nearest_equivalent
from swerve_kinematics.sim.base import (
    at_rest, BaseCommand, BaseConfig, BaseState, hold, targets_of)
from swerve_kinematics.sim.imu import Inertial
from swerve_kinematics.sim.physics.model import Floor, model_xml, TIME_STEP, Vehicle

# The base settles on its springs for this long [s] before anything else happens.
SETTLING = 0.5
# Steps of the model between two looks at servos and sensors, which are this far apart [s]; a
# tenth more is no reason for another look.
STEPS_AT_ONCE = 4
TICK = STEPS_AT_ONCE * TIME_STEP


class Slip(NamedTuple):
    """
    What the tyres and the motors did, summed up since the start.

    Attributes
    ----------
    scrub : ndarray (n,)
        How far each tyre has slid over the ground [m].
    squared : ndarray (n,)
        Integral of the squared sliding speed [m^2/s].
    energy : float
        Mechanical work of all motors [J], what they take back in braking subtracted: from rest to
        rest on level ground, what tyres and bearings turned to heat.
    work : float
        The same where braking gives nothing back: of each motor while it drives [J].

    """

    scrub: NDArray[np.float64]
    squared: NDArray[np.float64]
    energy: float
    work: float


class PhysicsBase:
    """
    A base in rigid-body physics, advanced by commands.

    Parameters
    ----------
    config : BaseConfig
        Layout, radii and what the servos can do.
    vehicle : Vehicle
        Masses, springs and motors.
    floor : Floor
        What it drives on.

    Attributes
    ----------
    config : BaseConfig
        As given.
    state : BaseState
        The truth, its pose projected on the floor.
    inertial : Inertial
        What the IMU measured in the last step.
    slip : Slip
        What tyres and motors did.

    Raises
    ------
    ValueError
        If the model cannot be built, as from masses that are not positive.

    """

    def __init__(self, config: BaseConfig, vehicle: Vehicle = Vehicle(),
                 floor: Floor = Floor()) -> None:
        """Build the model and let it settle at the origin."""
        self.config, self._floor = config, floor
        self._model = mujoco.MjModel.from_xml_string(model_xml(config, vehicle, floor))
        self._data = mujoco.MjData(self._model)
        count = config.kinematics.module_count
        self._steering_q, self._steering_v = self._addresses('steering', count)
        self._wheel_q, self._wheel_v = self._addresses('wheel', count)
        self._wheel_geoms = [self._model.geom(f'wheel_{i}').id for i in range(count)]
        self._geom_module = {geom: i for i, geom in enumerate(self._wheel_geoms)}
        self._turns = 0.0
        zeros = np.zeros(count)
        self.slip = Slip(zeros, zeros, 0.0, 0.0)
        self.state = at_rest(config)
        self.step(hold(config, self.state), SETTLING)
        self.slip = Slip(zeros, zeros, 0.0, 0.0)

    def _addresses(self, kind: str, count: int) -> tuple[list[int], list[int]]:
        """Return where the positions and velocities of one kind of joint are."""
        joints = [self._model.joint(f'{kind}_{i}') for i in range(count)]
        return [int(j.qposadr[0]) for j in joints], [int(j.dofadr[0]) for j in joints]

    def step(self, command: BaseCommand, dt: float) -> None:
        """
        Advance by `dt` [s], holding a command.

        By no less and no more: readings that are older than their stamps look like slip.

        Parameters
        ----------
        command : BaseCommand
            Setpoints of the joints.
        dt : float
            More than 0 [s].

        """
        count = max(1, math.ceil(dt / TICK - 0.1))
        tick = dt / count
        self._model.opt.timestep = tick / STEPS_AT_ONCE
        measured = np.zeros(6)
        for _ in range(count):
            self._set_friction()
            self._set_servos(command, tick)
            mujoco.mj_step(self._model, self._data, STEPS_AT_ONCE)
            self._add_slip(tick)
            measured += self._data.sensordata
        self.inertial = Inertial(measured[:3] / count, measured[3:] / count)
        self._read()

    def _set_friction(self) -> None:
        """Give each tyre the friction of the place where it is."""
        for geom in self._wheel_geoms if self._floor.regions else ():
            x, y, _ = self._data.geom_xpos[geom]
            self._model.geom_friction[geom, 0] = next(
                (region.friction for region in self._floor.regions if region.contains(x, y)),
                self._floor.friction)

    def _set_servos(self, command: BaseCommand, step: float) -> None:
        """Move the servos' targets towards the command as fast as the actuators allow."""
        control = self._data.ctrl
        count = len(self._wheel_q)
        drive, steering = self.config.drive, self.config.steering
        targets = targets_of(self.config, command)
        # A drive motor holds the speed of its joint: a coupled wheel gives way to the steering.
        speed = targets.wheel_speed - self.config.coupling * self._data.qvel[self._steering_v]
        speed = np.clip(speed, -drive.max_speed, drive.max_speed)
        reach = drive.max_acceleration * step
        control[:count] += np.clip(speed - control[:count], -reach, reach)
        angle = targets.steering_angle
        reach = steering.max_speed * step
        control[count:] += np.clip(angle - control[count:], -reach, reach)

    def _add_slip(self, step: float) -> None:
        """Sum up how the tyres slide and the motors work."""
        data = self._data
        speeds = np.zeros(len(self._wheel_geoms))
        for index in range(data.ncon):
            # By index: the end of MuJoCo's own iteration takes longer than a whole step.
            contact = data.contact[index]
            geom = next((g for g in contact.geom if g in self._geom_module), None)
            if geom is not None:
                speeds[self._geom_module[geom]] = self._sliding_speed(geom, contact)
        power = data.actuator_force * data.actuator_velocity * step
        self.slip = Slip(self.slip.scrub + speeds * step, self.slip.squared + speeds ** 2 * step,
                         self.slip.energy + float(power.sum()),
                         self.slip.work + float(np.maximum(power, 0.0).sum()))

    def _sliding_speed(self, geom: int, contact: mujoco.MjContact) -> float:
        """Return the speed [m/s] of a tyre's contact point along the ground."""
        velocity = np.zeros(6)
        body = self._model.geom_bodyid[geom]
        mujoco.mj_objectVelocity(
            self._model, self._data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
        rx, ry, rz = (contact.pos - self._data.xpos[body]).tolist()
        wx, wy, wz, vx, vy, vz = velocity.tolist()
        point = (vx + wy * rz - wz * ry, vy + wz * rx - wx * rz, vz + wx * ry - wy * rx)
        along = sum(map(operator.mul, point, contact.frame[:3].tolist()))
        return math.sqrt(max(sum(speed * speed for speed in point) - along * along, 0.0))

    def _read(self) -> None:
        """Take the state from the model."""
        data = self._data
        w, x, y, z = data.qpos[3:7]
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        self._turns = scalar_nearest_equivalent(yaw, self._turns)
        sine, cosine = math.sin(self._turns), math.cos(self._turns)
        vx, vy = data.qvel[:2]
        self.state = BaseState(
            pose=np.array([data.qpos[0], data.qpos[1], self._turns]),
            wheel_angle=data.qpos[self._wheel_q].copy(),
            wheel_speed=data.qvel[self._wheel_v].copy(),
            steering_angle=data.qpos[self._steering_q].copy(),
            steering_rate=data.qvel[self._steering_v].copy(),
            twist=np.array([cosine * vx + sine * vy, cosine * vy - sine * vx, data.qvel[5]]))
