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

"""Wrong wirings and measures, each of a kind that happens, and what mends them."""

from checking_drives import both, POSITIONS, Truth
import numpy as np

FL, FR, RL, RR = range(4)
ALL = 0, 1, 2, 3
TURNS = 0.159155

# Name: how the base is, and the changes that may be named: kind and modules.
DESCRIBED_WRONGLY = {
    'front left drive reversed': (Truth(**both('drive', FL)), [('drive reversed', (FL,))]),
    'rear right drive reversed': (Truth(**both('drive', RR)), [('drive reversed', (RR,))]),
    'front left steering clockwise': (
        Truth(**both('steering', FL)), [('steering reversed', (FL,))]),
    'rear right steering clockwise': (
        Truth(**both('steering', RR)), [('steering reversed', (RR,))]),
    'all steering clockwise': (Truth(**both('steering', *ALL)), [
        ('steering reversed', ALL), ('x of wrong sign', ())]),
    'right drives reversed': (Truth(**both('drive', FR, RR)), [('drive reversed', (FR, RR))]),
    'front left and right swapped': (
        Truth(order=(FR, FL, RL, RR)), [('modules swapped', (FL, FR))]),
    'diagonal swapped': (Truth(order=(RR, FR, RL, FL)), [('modules swapped', (FL, RR))]),
    # Mirror images of each other: a side that is exchanged steers as if it counted clockwise.
    'right side swapped': (Truth(order=(FL, RR, RL, FR)), [
        ('modules swapped', (FR, RR)), ('steering reversed', (FR, RR))]),
    # Each drives as the motor on the other side is mounted.
    'mirrored front modules swapped': (Truth(order=(FR, FL, RL, RR), **both('drive', FL, FR)), [
        ('mirrored modules swapped', (FL, FR))]),
    'order rotated': (Truth(order=(FR, RR, FL, RL)), [('modules rotated', (RR, FR, FL, RL))]),
    'offset wrong by 180 degrees': (Truth(offset={FR: np.pi}), [('drive reversed', (FR,))]),
    'offset wrong by 90 degrees': (Truth(offset={RL: np.pi / 2}), [('steering offset', (RL,))]),
    'offset wrong by -90 degrees': (Truth(offset={RR: -np.pi / 2}), [('steering offset', (RR,))]),
    'offset wrong by 20 degrees': (Truth(offset={FL: 0.35}), [('steering offset', (FL,))]),
    'offset wrong by -8 degrees': (Truth(offset={FR: -0.14}), [('steering offset', (FR,))]),
    'gyro reversed': (Truth(gyro=-1.0), [('gyro reversed', ())]),
    'gyro in degrees': (Truth(gyro=57.29578), [('gyro in degrees', ())]),
    'front left radius': (Truth(radius={FL: 1.2}), [('wheel radius', (FL,))]),
    'rear right radius': (Truth(radius={RR: 0.85}), [('wheel radius', (RR,))]),
    'all radii': (Truth(radius=dict.fromkeys(ALL, 1.1)), [('wheel radius', ALL)]),
    'gears of 5 left out': (Truth(radius=dict.fromkeys(ALL, 0.2)), [('wheel radius', ALL)]),
    'gears of 12 left out': (Truth(radius=dict.fromkeys(ALL, 1 / 12)), [('wheel radius', ALL)]),
    'gears of 7 given the wrong way round': (
        Truth(radius=dict.fromkeys(ALL, 1 / 49)), [('wheel radius', ALL)]),
    'gears of 5 counted twice': (Truth(radius=dict.fromkeys(ALL, 5.0)), [('wheel radius', ALL)]),
    'x and y swapped': (Truth(positions=POSITIONS[:, ::-1]), [('x and y swapped', ())]),
    'y of wrong sign': (Truth(positions=POSITIONS * (1, -1)), [('y of wrong sign', ())]),
    # The motor goes as it is told, the reading does not.
    'front right drive encoder reversed': (
        Truth(drive_encoder={FR: -1.0}), [('drive reversed', (FR,))]),
}
# Name: how the base is, and the joint, fault and modules that must be named.
OUT_OF_ORDER = {
    'drive motor reversed': (
        Truth(drive={RL: -1.0}), ('drive', 'goes against its command', (RL,))),
    'steering motor reversed': (
        Truth(steering={FR: -1.0}), ('steering', 'goes against its command', (FR,))),
    'dead drive': (Truth(dead_drives=(FR,)), ('drive', 'stands still', (FR,))),
    'dead steering': (Truth(dead_steerings=(RL,)), ('steering', 'stands still', (RL,))),
    'module frozen': (Truth(frozen=(FL,)), ('module', 'stands still', (FL,))),
    'emergency stop': (Truth(emergency_stop=True), ('base', 'stands still', ALL)),
    **{f'{joint} in turns': (
        Truth(**{f'{joint}_encoder': dict.fromkeys(ALL, TURNS)}),
        (joint, 'does not follow its command', ALL)) for joint in ('drive', 'steering')},
    # Each angle that is read as farther off than it is takes the next command farther still.
    'steering in degrees': (Truth(steering_encoder=dict.fromkeys(ALL, 57.29578)),
                            ('steering', 'turns faster than it can', ALL)),
    'gear in the readings of a steering alone': (
        Truth(steering_encoder={RL: 12.0}), ('steering', 'turns faster than it can', (RL,))),
}
