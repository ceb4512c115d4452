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

"""A calibration as a report for people, and as parameters to paste."""

import numpy as np
from numpy.typing import NDArray

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.calibration.calibration import Calibration
from swerve_kinematics.core.calibration.delay import Delay, LARGEST_DELAY
from swerve_kinematics.core.geometry.angles import within_a_turn

# From here on [share of the ways] the modules contradict each other by more than noise.
NOTEWORTHY = 0.003
NOT_TOLD = 'unknown from this drive'


def report(parameters: NodeParameters, calibration: Calibration) -> str:
    """
    Return what was found, for people and as parameters.

    Parameters
    ----------
    parameters : NodeParameters
        With the values so far.
    calibration : Calibration
        Their corrections.

    Returns
    -------
    str
        Of several lines; the last ones are YAML.

    """
    layout, c = parameters.layout, calibration
    radii = np.multiply(layout.joints.wheel_radii, c.radius_scale)
    offsets = np.array(layout.joints.steering_positions(c.steering_offset.tolist()))
    # As the joint reads it, whichever way and however far it turns with the module.
    changes = _rounded(np.degrees(offsets - layout.joints.steering_offsets), 3)
    # No further from 0 than the node takes them.
    offsets = np.array(list(map(within_a_turn, offsets, layout.joints.steering_ratios)))
    offsets, percent = _rounded(offsets, 6), _rounded(100.0 * (c.radius_scale - 1.0), 3)
    stds = np.degrees(c.steering_offset_std) * np.abs(layout.joints.steering_ratios)
    imu_delay = parameters.imu_delay if parameters.gyro_source == 'imu' else 0.0
    delay = c.gyro_delay._replace(value=round(imu_delay + c.gyro_delay.value, 4) + 0.0)
    lines = ['Each value, its change, and +- one standard deviation:', '']
    for i, name in enumerate(layout.module_names):
        lines += [
            f'{name}',
            '  wheel radius     ' + _told(
                c.radius_scale_std[i], f'{radii[i]:.6f} m   {percent[i]:+7.3f}'
                f' % +- {100 * c.radius_scale_std[i]:.3f} %'),
            '  steering offset ' + _told(
                c.steering_offset_std[i],
                f'{offsets[i]:+.6f} rad {changes[i]:+7.3f} deg +- {stds[i]:.3f} deg')]
    lines += [*_of_the_gyro(c, delay), '', *_notes(c, layout.module_names)]
    lines += ['# for the parameter file:', _yaml('wheel_radii', radii),
              _yaml('steering_offsets', offsets)]
    if parameters.gyro_source == 'imu' and np.isfinite(delay.std) and (
            abs(delay.value) <= LARGEST_DELAY):
        lines.append(f'imu_delay: {delay.value:.4f}')
    return '\n'.join(lines)


def _told(std: float, text: str) -> str:
    """Return the text, or that the drive does not tell."""
    return text if np.isfinite(std) else f' {NOT_TOLD}'


def _of_the_gyro(calibration: Calibration, delay: Delay) -> list[str]:
    """Return what was found of the gyro, as lines."""
    scale, scale_std = calibration.gyro_scale, calibration.gyro_scale_std
    return [
        'gyro',
        '  scale            ' + _told(
            scale_std, f'{scale:.6f} +- {scale_std:.6f}: multiply yaw and yaw '
            "rate by it in the gyro's driver"),
        '  delay            ' + _told(
            delay.std, f'{delay.value:+.4f} s +- {delay.std:.4f} s: how much later than the '
            'wheels it is stamped' + (
                '' if abs(delay.value) <= LARGEST_DELAY else
                ', more than imu_delay takes: its driver must stamp better'))]


def _notes(calibration: Calibration, names: tuple[str, ...]) -> list[str]:
    """Return what people should know of the result, as lines."""
    notes = []
    if not calibration.common_offset_known:
        notes += [
            'A line does not show the offset that all modules share, so their mean is kept.',
            'Differences between modules show only if the wheels rolled freely (--pushed). With',
            'driven wheels, trust only the mean radius, and use poses as ground truth for the',
            'rest.', '']
    if calibration.contradiction > NOTEWORTHY:
        notes += [
            f'The modules contradict each other by {100 * calibration.contradiction:.1f} %: '
            'wheels slipped or',
            'fought each other. Paste the result, then drive and calibrate again.', '']
    if calibration.driven:
        notes += [
            'Nothing shows that the wheels rolled freely. With driven wheels, errors that cancel',
            'in every motion of the base stay hidden and may remain: hence the uncertainty of',
            'each wheel. To determine each separately, push the base with its motors off',
            '(--pushed).', '']
    if calibration.left_out:
        notes += ['Left out because wheels slipped:', *[
            f'  {span.start:.1f} s to {span.end:.1f} s: '
            + ', '.join(names[module] for module in span.modules)
            for span in calibration.left_out], '']
    return notes


def _rounded(values: NDArray[np.float64], digits: int) -> NDArray[np.float64]:
    """Return values rounded, without the sign that a negative one keeps as it becomes 0."""
    return np.round(values, digits) + 0.0


def _yaml(name: str, values: NDArray[np.float64]) -> str:
    """Return a parameter as a line of YAML."""
    return f"{name}: [{', '.join(f'{value:.6f}' for value in values)}]"
