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

"""Rotations in space as quaternions (x, y, z, w), in Python's own numbers."""

import math
from typing import NamedTuple


class Rotation(NamedTuple):
    """
    A quaternion of any length but 0.

    As the orientation of a frame B in a frame A it turns a vector given in B into A, and
    `product(b_in_a, c_in_b)` is that of C in A.
    """

    x: float
    y: float
    z: float
    w: float


IDENTITY = Rotation(0.0, 0.0, 0.0, 1.0)
# Squared length of a quaternion: one outside is no rotation, and computing with it overflows.
SHORTEST, LONGEST = 1e-12, 1e12


def from_roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> Rotation:
    """Return the rotation about the fixed axes x, y, z in this order, by angles [rad]."""
    (sr, cr), (sp, cp), (sy, cy) = (
        (math.sin(0.5 * angle), math.cos(0.5 * angle)) for angle in (roll, pitch, yaw))
    return Rotation(sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                    cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def product(first: Rotation, second: Rotation) -> Rotation:
    """Return the rotation that turns by `second` and then by `first`."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return Rotation(aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
                    aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def inverse(rotation: Rotation) -> Rotation:
    """Return the rotation back; of the same length."""
    x, y, z, w = rotation
    return Rotation(-x, -y, -z, w)


def is_rotation(rotation: Rotation) -> bool:
    """Tell whether four numbers are a quaternion of a length that can be computed with."""
    x, y, z, w = rotation
    return SHORTEST <= x * x + y * y + z * z + w * w <= LONGEST  # false for NaN


def yaw_of(rotation: Rotation) -> float:
    """Return the yaw [rad], in (-pi, pi]; NaN if it is no rotation."""
    x, y, z, w = rotation
    if not is_rotation(rotation):
        return math.nan
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def up(rotation: Rotation) -> tuple[float, float, float]:
    """Return the z axis of A as seen from B, for the orientation of B in A: a unit vector."""
    x, y, z, w = rotation
    size = x * x + y * y + z * z + w * w
    return (2.0 * (x * z - w * y) / size, 2.0 * (y * z + w * x) / size,
            (w * w - x * x - y * y + z * z) / size)


def level_axes(rotation: Rotation) -> tuple[tuple[float, float, float], ...]:
    """Return the x and y axes of A as seen from B, for the orientation of B in A."""
    x, y, z, w = rotation
    size = x * x + y * y + z * z + w * w
    return (((w * w + x * x - y * y - z * z) / size, 2.0 * (x * y - w * z) / size,
             2.0 * (x * z + w * y) / size),
            (2.0 * (x * y + w * z) / size, (w * w - x * x + y * y - z * z) / size,
             2.0 * (y * z - w * x) / size))
