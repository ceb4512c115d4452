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

"""
The base and its floor as a MuJoCo model, for any number of modules.

A free chassis; below it, for each module, a spring and damper, a steering hinge and a wheel.
Wheels are ellipsoids, which touch the ground in one point: a wheel that steers on the spot
does not crawl, and one that rolls over an edge does not jitter, as a cylinder would.
"""

from collections.abc import Iterator
from dataclasses import dataclass
import math
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.sim.base import BaseConfig

GRAVITY = 9.81  # m/s^2
TIME_STEP = 0.0005  # s

# Of a payload's centre of mass, and of the IMU, above the wheel axles [m], where nothing else is
# said: the parameters give x and y only.
PAYLOAD_HEIGHT, IMU_HEIGHT = 0.3, 0.1

# A tyre 40 mm wide. Torsional friction is that of a contact patch of a few millimetres [m].
TYRE_HALF_WIDTH = 0.02
TORSIONAL_FRICTION = 0.003
# A ridge of the floor is the top of a cylinder with this radius [m].
RIDGE_RADIUS = 0.15
# Floors with ridges have them up to this distance from the origin [m].
RIDGE_EXTENT = 20.0


@dataclass(frozen=True)
class Vehicle:
    """
    Masses, springs and motors of a base.

    Attributes
    ----------
    mass : float
        Of the chassis without modules and payload [kg].
    height : float
        Of the chassis' centre of mass above the wheel axles [m].
    module_mass : float
        Of what steers, wheel included [kg].
    sag : float
        How far the springs give under the weight of the base [m].
    drive_torque, steering_torque : float
        Largest torque of each motor, at its joint [N m].
    payload_mass : float
        [kg].
    payload_position : tuple of float (3,)
        Of its centre of mass from base_link, z from the wheel axles [m].
    imu_position : tuple of float (3,)
        Likewise [m].

    """

    mass: float = 42.0
    height: float = 0.10
    module_mass: float = 2.0
    sag: float = 0.005
    drive_torque: float = 6.0
    steering_torque: float = 4.0
    payload_mass: float = 0.0
    payload_position: tuple[float, float, float] = (0.0, 0.0, PAYLOAD_HEIGHT)
    imu_position: tuple[float, float, float] = (0.0, 0.0, IMU_HEIGHT)


@dataclass(frozen=True)
class Region:
    """A rectangle of the floor, edges along the axes [m], and its friction."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float
    friction: float

    def contains(self, x: float, y: float) -> bool:
        """Tell whether a point [m] lies in it."""
        return self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max


@dataclass(frozen=True)
class Floor:
    """
    What the base drives on.

    Attributes
    ----------
    friction : float
        Of a tyre on the floor (Coulomb).
    regions : tuple of Region
        Where it is another; the first one that contains a wheel counts.
    slope : float
        How much the floor rises [rad], everywhere.
    slope_direction : float
        The way up, from the x axis [rad].
    ridge_height : float
        Of ridges across the x axis [m]; 0: none.
    ridge_spacing : float
        From one to the next [m].

    """

    friction: float = 0.9
    regions: tuple[Region, ...] = ()
    slope: float = 0.0
    slope_direction: float = 0.0
    ridge_height: float = 0.0
    ridge_spacing: float = 1.0


def model_xml(config: BaseConfig, vehicle: Vehicle, floor: Floor) -> str:
    """
    Return the model in MuJoCo's XML.

    Joints, actuators and bodies of module i are named `spring_i`, `steering_i` and `wheel_i`.

    Parameters
    ----------
    config : BaseConfig
        Gives the module positions, the wheel radii and the actuators.
    vehicle : Vehicle
        What moves.
    floor : Floor
        What it moves on.

    Returns
    -------
    str

    """
    down = math.sin(floor.slope)
    gravity = (-GRAVITY * down * math.cos(floor.slope_direction),
               -GRAVITY * down * math.sin(floor.slope_direction),
               -GRAVITY * math.cos(floor.slope))
    return '\n'.join([
        '<mujoco model="swerve base">',
        '<compiler angle="radian"/>',
        _tag('option', timestep=TIME_STEP, gravity=gravity, integrator='implicitfast',
             cone='elliptic', impratio=10),
        '<worldbody>',
        _tag('geom', name='floor', type='plane', size=(0, 0, 1)),
        *_ridges(floor),
        *_chassis(config, vehicle, floor),
        '</worldbody>',
        '<actuator>', *_motors(config, vehicle), '</actuator>',
        '<sensor>', _tag('accelerometer', site='imu'),
        _tag('gyro', site='imu'), '</sensor>',
        '</mujoco>'])


def _ridges(floor: Floor) -> Iterator[str]:
    """Yield the ridges of a floor, none at the origin, where the base stands first."""
    if floor.ridge_height <= 0.0:
        return
    count = int(RIDGE_EXTENT / floor.ridge_spacing)
    for index in (i for i in range(-count, count + 1) if i):
        yield _tag('geom', type='cylinder', size=(RIDGE_RADIUS, RIDGE_EXTENT),
                   pos=((index - 0.5 * math.copysign(1, index)) * floor.ridge_spacing, 0,
                        floor.ridge_height - RIDGE_RADIUS),
                   zaxis=(0, 1, 0))


def _chassis(config: BaseConfig, vehicle: Vehicle, floor: Floor) -> Iterator[str]:
    """Yield the chassis, its payload and its modules; its origin is base_link at axle height."""
    positions = config.kinematics.module_positions
    # As a block that just spans the modules; slightly more where they are in a line.
    half = [max(0.5 * float(extent), 0.1) for extent in positions.max(0) - positions.min(0)]
    middle = 0.5 * (positions.max(0) + positions.min(0))
    yield _opening('body', name='base', pos=(0, 0, float(config.wheel_radii.max())))
    yield '<freejoint name="base"/>'
    yield _tag('inertial', pos=(*middle.tolist(), vehicle.height), mass=vehicle.mass,
               diaginertia=_block_inertia(vehicle.mass, (*half, 0.1)))
    yield _tag('site', name='imu', pos=vehicle.imu_position)
    if vehicle.payload_mass > 0.0:
        yield _opening('body', name='payload', pos=vehicle.payload_position)
        yield _tag('inertial', pos=(0, 0, 0), mass=vehicle.payload_mass,
                   diaginertia=_block_inertia(vehicle.payload_mass, (0.15, 0.15, 0.15)))
        yield '</body>'
    yield from _casters(positions, float(config.wheel_radii.max()))
    for index, ((x, y), radius) in enumerate(zip(
            positions.tolist(), config.wheel_radii.tolist())):
        yield from _module(index, x, y, radius, len(positions), vehicle, floor)
    yield '</body>'


def _casters(positions: NDArray[np.float64], radius: float) -> Iterator[str]:
    """Yield casters without friction on both sides of modules in a line: else it tips over."""
    arms = positions - positions.mean(0)
    _, extents, axes = np.linalg.svd(arms)
    if len(positions) > 2 and extents[1] > 0.05 * extents[0]:
        return
    aside = max(0.5 * float(extents[0]), 0.15) * axes[1]
    for side in (-1.0, 1.0):
        x, y = (positions.mean(0) + side * aside).tolist()
        yield _tag('geom', type='sphere', size=(radius,), pos=(x, y, 0), mass=0.1, condim=1,
                   priority=2, friction=(0, 0, 0))


def _module(index: int, x: float, y: float, radius: float, count: int, vehicle: Vehicle,
            floor: Floor) -> Iterator[str]:
    """Yield one module: spring, steering and wheel."""
    load = (vehicle.mass + vehicle.payload_mass) * GRAVITY / count
    stiffness = load / vehicle.sag
    # 0.7 of critical for the chassis' share of the mass.
    damping = 1.4 * math.sqrt(stiffness * load / GRAVITY)
    wheel_mass = 0.5 * vehicle.module_mass
    yield _opening('body', name=f'module_{index}', pos=(x, y, 0))
    yield _tag('joint', name=f'spring_{index}', type='slide', axis=(0, 0, 1),
               stiffness=stiffness, springref=-vehicle.sag, damping=damping)
    yield _tag('joint', name=f'steering_{index}', type='hinge', axis=(0, 0, 1), armature=0.01,
               damping=0.02)
    yield _tag('inertial', pos=(0, 0, 0.05), mass=vehicle.module_mass - wheel_mass,
               diaginertia=(0.002, 0.002, 0.002))
    yield _opening('body', name=f'wheel_{index}', pos=(0, 0, 0))
    yield _tag('joint', name=f'wheel_{index}', type='hinge', axis=(0, 1, 0), armature=0.002,
               damping=0.002)
    yield _tag('geom', name=f'wheel_{index}', type='ellipsoid',
               size=(radius, max(TYRE_HALF_WIDTH, 0.4 * radius), radius), mass=wheel_mass,
               condim=4, priority=1, friction=(floor.friction, TORSIONAL_FRICTION, 0.0001),
               solref=(0.004, 1))
    yield '</body></body>'


def _motors(config: BaseConfig, vehicle: Vehicle) -> Iterator[str]:
    """Yield the servos: first all drives, by speed, then all steerings, by angle."""
    count = config.kinematics.module_count
    total = vehicle.mass + vehicle.payload_mass + count * vehicle.module_mass
    for index, radius in enumerate(config.wheel_radii.tolist()):
        gain = total * radius ** 2 / count / config.drive.time_constant
        yield _tag('velocity', joint=f'wheel_{index}', kv=gain,
                   forcerange=(-vehicle.drive_torque, vehicle.drive_torque))
    # Critically damped; twice the time constant's angular frequency, for the two poles.
    frequency = 2.0 / config.steering.time_constant
    inertia = 0.015
    for index in range(count):
        yield _tag('position', joint=f'steering_{index}', kp=inertia * frequency ** 2,
                   kv=2.0 * inertia * frequency,
                   forcerange=(-vehicle.steering_torque, vehicle.steering_torque))


def _block_inertia(mass: float, half: tuple[float, ...]) -> tuple[float, float, float]:
    """Return the moments of inertia [kg m^2] of a block with these half extents [m]."""
    x, y, z = (extent ** 2 for extent in half)
    return mass * (y + z) / 3.0, mass * (x + z) / 3.0, mass * (x + y) / 3.0


def _opening(kind: str, /, **attributes: object) -> str:
    """Return the XML tag that opens an element."""
    return f'<{kind} {_written(attributes)}>'


def _tag(kind: str, /, **attributes: object) -> str:
    """Return the XML tag of an element without content."""
    return f'<{kind} {_written(attributes)}/>'


def _written(attributes: dict[str, object]) -> str:
    """Return the attributes of an element."""
    return ' '.join(f'{key}={quoteattr(_text(value))}' for key, value in attributes.items())


def _text(value: object) -> str:
    """Return a value as MuJoCo reads it."""
    return ' '.join(map(str, value)) if isinstance(value, tuple) else str(value)
