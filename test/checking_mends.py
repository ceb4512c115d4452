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

"""Random faults, what mends them, and whether the mended base then goes where it is told."""

from dataclasses import fields, replace

from checking_drives import Base, both, driven, POSITIONS, RADIUS, Truth
import numpy as np

from swerve_kinematics.core.checking.check import check
from swerve_kinematics.core.checking.eye import as_seen
from swerve_kinematics.core.checking.joints import AGAINST
from swerve_kinematics.core.checking.mends import mended
from swerve_kinematics.core.geometry.angles import wrap_angle
from swerve_kinematics.core.kinematics.modules import ModuleStates
from swerve_kinematics.core.kinematics.swerve import SwerveKinematics

COUNT = len(POSITIONS)
JOINTS = list('abcd')
PARAMETERS = {
    'module_x': POSITIONS[:, 0].tolist(), 'module_y': POSITIONS[:, 1].tolist(),
    'drive_joint_names': JOINTS, 'steering_joint_names': JOINTS, 'wheel_radii': [RADIUS] * COUNT,
    **{f'{joint}_{measure}': [1.0] * COUNT for joint in ('drive', 'steering')
       for measure in ('directions', 'ratios')},
    'steering_offsets': [0.0] * COUNT}
# Motions are compared over so many samples.
SPAN = 5


def swapped(first, second):
    """Return the order of the modules when the joints of two are swapped."""
    order = list(range(COUNT))
    order[first], order[second] = second, first
    return tuple(order)


def random_pair(rng):
    """Return two bases of different faults."""
    first, second = rng.choice(len(FAULTS), 2, replace=False)
    if {first, second} in ALIKE:
        second = LAST
    return FAULTS[first](rng, int(rng.integers(COUNT))), FAULTS[second](
        rng, int(rng.integers(COUNT)))


def _angle(rng):
    """Return by how much an offset is wrong: quarters of a turn, or anything."""
    return float(rng.choice([np.pi, np.pi / 2, -np.pi / 2, rng.uniform(0.1, 6.1)]))


def _factor(rng):
    """Return by how much a radius is wrong."""
    return float(rng.choice([rng.uniform(0.7, 0.92), rng.uniform(1.08, 1.4)]))


FAULTS = (
    lambda rng, module: Truth(**both('drive', module)),
    lambda rng, module: Truth(**both('steering', module)),
    lambda rng, module: Truth(order=swapped(*rng.choice(COUNT, 2, replace=False).tolist())),
    lambda rng, module: Truth(offset={module: _angle(rng)}),
    lambda rng, module: Truth(radius={module: _factor(rng)}),
    lambda rng, module: Truth(radius=dict.fromkeys(range(COUNT), _factor(rng))),
    lambda rng, module: Truth(gyro=-1.0),
    lambda rng, module: Truth(positions=POSITIONS[:, ::-1]),
    lambda rng, module: Truth(drive_encoder={module: -1.0}),
    lambda rng, module: Truth(gyro=57.29578),
    lambda rng, module: Truth(**both('drive', 1, 3)),
)
# Pairs of these are one fault, or none; another one stands for the second.
ALIKE, LAST = ({2, 7}, {4, 5}, {0, 8}), len(FAULTS) - 2


def merged(first, second):
    """Return a base with what is wrong with either."""
    values = {}
    for field in fields(Truth):
        one, other = getattr(first, field.name), getattr(second, field.name)
        if field.name == 'offset':
            values[field.name] = {at: one.get(at, 0.0) + other.get(at, 0.0)
                                  for at in {**one, **other}}
        elif isinstance(one, dict):
            values[field.name] = {at: one.get(at, 1.0) * other.get(at, 1.0)
                                  for at in {**one, **other}}
        elif field.name == 'gyro':
            values[field.name] = one * other
        elif field.name == 'positions':
            values[field.name] = other if one is POSITIONS else one
        else:
            values[field.name] = one or other
    return replace(first, **values)


class MendedBase(Base):
    """A base as it is described by mended parameters; remembers how it moved."""

    def __init__(self, truth, parameters):
        """Stand with the modules straight."""
        super().__init__(truth)
        self._names = [[JOINTS.index(name) for name in parameters[f'{joint}_joint_names']]
                       for joint in ('drive', 'steering')]
        self._way = (np.array(parameters['wheel_radii']) * parameters['drive_directions']
                     / parameters['drive_ratios'] / RADIUS)
        self._sense = np.array(parameters['steering_directions'])
        self._zero = np.array(parameters['steering_offsets'])
        self._ways, self._halfway = [], []

    def read(self):
        """Return what the joints read, as described."""
        wheels, angles = super().read()
        drives, steerings = self._names
        return wheels[drives] * self._way, (angles[steerings] - self._zero) * self._sense

    def move(self, speeds, angles, dt, time):
        """Take commands as described."""
        wheels, steered = np.zeros(COUNT), np.zeros(COUNT)
        wheels[self._names[0]] = speeds / self._way
        steered[self._names[1]] = angles * self._sense + self._zero
        before, angle = self.turned, self.angle
        super().move(wheels, steered, dt, time)
        self._ways.append((self.turned - before) * self._radius)
        self._halfway.append(0.5 * (angle + self.angle))

    def motions(self):
        """Return how it moved (k, 3) [m, m, rad]."""
        return SwerveKinematics(self._truth.positions).forward(
            ModuleStates(self._ways, self._halfway))


def mend(truth, parameters, verdict):
    """Return the base and the parameters after all that a verdict names was mended."""
    changes = {field: dict(getattr(truth, field)) for field in (
        'drive', 'drive_encoder', 'steering', 'steering_encoder')}
    against = {(fault.joint, module) for fault in verdict.joints if fault.fault == AGAINST
               for module in fault.modules}
    for joint, module in against:
        # As the report says it.
        is_encoder = (f'{joint} reversed', (module,)) in [
            (change.kind, change.modules) for change in verdict.changes]
        signs = changes[f'{joint}_encoder' if is_encoder else joint]
        place = (truth.order or range(COUNT))[module]
        signs[place] = -signs.get(place, 1.0)
    kinds = [change.kind for change in verdict.changes]
    gyro = truth.gyro * (-1.0) ** kinds.count('gyro reversed') / (
        57.29578 ** kinds.count('gyro in degrees'))
    by_parameters = [change for change in verdict.changes if not (
        change.kind.endswith(' reversed')
        and against.issuperset((change.kind.split()[0], module) for module in change.modules)
        and change.modules)]
    return replace(truth, gyro=gyro, **changes), {
        **parameters, **mended(parameters, by_parameters)}


def driven_again(truth, parameters, seed):
    """
    Return the data of a drive after a mend, and how the base went.

    That is, whether it went forward, to the left and turned left when told to, and the share of
    its motion by which it erred.
    """
    positions = positions_of(parameters)
    base = MendedBase(truth, parameters)
    data = driven(truth, seed=seed, described=positions, dropped=0.0, base=base)
    steered = wrap_angle(np.diff(data.angles, axis=0))
    told = SwerveKinematics(positions).forward(ModuleStates(
        np.diff(data.distances, axis=0), data.angles[:-1] + 0.5 * steered))
    size = 1.0, 1.0, np.hypot(*positions[0])
    told, true = (_sums(np.asarray(motions) * size) for motions in (told, base.motions()[:-1]))
    # What hardly turns, say, is not seen to turn to the left.
    sizes = np.linalg.norm(told, axis=0) * np.linalg.norm(true, axis=0)
    seen = (told * true).sum(axis=0) > 0.3 * sizes
    return data, seen, float(np.linalg.norm(told - true) / np.linalg.norm(true))


def _sums(motions):
    """Return the motions over spans."""
    whole = len(motions) // SPAN * SPAN
    return motions[:whole].reshape(-1, SPAN, 3).sum(axis=1)


def positions_of(parameters):
    """Return the positions of the modules by parameters (n, 2)."""
    return np.column_stack((parameters['module_x'], parameters['module_y']))


def watched(truth, seed, parameters=PARAMETERS):
    """Return the verdict on a drive that someone watches."""
    positions = positions_of(parameters)
    data, seen, _ = driven_again(truth, parameters, seed)
    return as_seen(check(positions, data), positions, data, seen)


def is_mended(truth, verdict, seed, parameters=PARAMETERS):
    """Tell whether the base goes where it is told once all is mended that a check names."""
    truth, parameters = mend(truth, parameters, verdict)
    data, seen, error = driven_again(truth, parameters, seed)
    if not all(seen):
        # Nothing but the eye tells; who sees it says so, and that is a part of the check.
        positions = positions_of(parameters)
        truth, parameters = mend(truth, parameters, as_seen(
            check(positions, data, pairs=False), positions, data, seen))
        data, seen, error = driven_again(truth, parameters, seed)
    again = check(positions_of(parameters), data, pairs=False)
    return all(seen) and error < 0.04 and not (again.changes or again.unexplained)
