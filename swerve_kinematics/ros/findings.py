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

"""What is wrong with a base that drives, and what is measured, as the diagnostics say it."""

from collections.abc import Iterable, Iterator
from typing import Any

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.odometry.odometry import SwerveOdometry
from swerve_kinematics.ros.diagnostics import ERROR, Finding, WARN
from swerve_kinematics.ros.drive import Drive
from swerve_kinematics.ros.estimation import Estimation
from swerve_kinematics.ros.feedback import JointFeedback
from swerve_kinematics.ros.gyro_feedback import GyroFeedback
from swerve_kinematics.ros.inertial_report import accelerometer_fault, inertial_values
from swerve_kinematics.ros.sample import Sample
from swerve_kinematics.ros.stamps import NANOSECONDS, NEVER
from swerve_kinematics.ros.timeline import Moment


def findings_and_values(
        config: NodeParameters, drive: Drive, estimation: Estimation, now: Moment,
        rate: float) -> tuple[list[Finding], dict[str, float | str]]:
    """
    Return what is wrong and what is measured, as `Diagnostics.publish` takes them.

    Parameters
    ----------
    config : NodeParameters
        Names the modules and the source of the gyro.
    drive : Drive
        Tells its mode, the ages of its inputs and how far it can follow the command.
    estimation : Estimation
        Tells what was measured, what of that is not used and why, and which modules slip.
    now : Moment
        The present.
    rate : float
        Complete sets of feedback per second [Hz].

    Returns
    -------
    findings : list of (bytes, str)
    values : dict

    """
    feedback, odometry = estimation.feedback, estimation.odometry
    accelerometer, slipping = estimation.imu.accelerometer, _names(config, odometry.slipping)
    findings = [*_findings(config, drive, feedback, slipping, estimation.sample, now),
                *_gyro_findings(feedback.gyro, odometry), *_speed_findings(config, feedback)]
    if fault := accelerometer_fault(accelerometer, odometry):
        findings.append((WARN, fault))
    return findings, {
        'mode': drive.mode,
        'command age [s]': _age(drive.input.age(now)),
        'feedback age [s]': _age(drive.feedback_age(now)),
        'feedback rate [Hz]': rate,
        'feedback merged from several messages': feedback.merged,
        'joint_states of other joints only': feedback.foreign,
        'feedback without gyro': feedback.without_gyro,
        'speed scale (1: full command)': drive.scale,
        'slipping modules': slipping or 'none',
        'gyro bias [rad/s]': float(odometry.gyro_bias),
        'wheel residual [m/s]': float(odometry.residual),
        **inertial_values(config.layout.module_names, odometry, accelerometer),
    }


def _findings(config: NodeParameters, drive: Drive, feedback: JointFeedback, slipping: str,
              sample: Sample | None, now: Moment) -> Iterator[Finding]:
    """Yield level and message of all that is wrong."""
    if drive.lacks_feedback(now):
        yield ERROR, 'no feedback: wheels stopped'
        if feedback.missing:
            yield ERROR, feedback.missing
    if any(lost := drive.lost):
        yield ERROR, (
            f'{_names(config, lost)}: steering reads another angle, but did not turn: wheels '
            'stopped until it is right, or ~/trust_steering is called')
    if drive.is_held:
        yield WARN, 'the base does not follow its commands: the ramp waits for it'
    if slipping:
        yield WARN, f'slipping: {slipping}'
    if any(drive.unreachable):
        yield WARN, f'out of steering range: {_names(config, drive.unreachable)}'
    if feedback.unwrapper.is_found:
        yield WARN, wrapping_found(feedback)
    if config.gyro_source != 'none' and sample and sample.yaw is None and sample.yaw_rate is None:
        yield WARN, 'no gyro: yaw comes from the wheels' + (
            f' - joint_states tell nothing of {config.layout.gyro_joint}, see gyro_source'
            if config.gyro_source == 'joint' else '')


def _gyro_findings(gyro: GyroFeedback, odometry: SwerveOdometry) -> Iterator[Finding]:
    """Yield what is wrong with what the gyro says."""
    if gyro.yaw_stands_still:
        yield WARN, 'the yaw of the gyro stands still although its rate shows a turn: not used'
    for name, is_trusted in zip(('yaw', 'rate'), odometry.gyro_trusted):
        if not is_trusted:
            yield WARN, f'the {name} of the gyro contradicts the wheels: not used'


def _speed_findings(config: NodeParameters, feedback: JointFeedback) -> Iterator[Finding]:
    """Yield which velocities are not the change of their positions."""
    for module, explanation in feedback.speeds.contradictions():
        yield WARN, (f'velocity of {config.layout.drive_joints[module]} contradicts its '
                     f'position: {explanation}')


def wrapping_found(feedback: JointFeedback) -> str:
    """Return that drive joints were found to wrap, and what to do about it."""
    return (f'drive joints wrap: set drive_joint_period to {feedback.unwrapper.period:.5f}, '
            'or make them count on continuously')


def _names(config: NodeParameters, chosen: Iterable[Any]) -> str:
    """Return the names of the chosen modules, as people read them."""
    return ', '.join(name for name, is_chosen in zip(config.layout.module_names, chosen)
                     if is_chosen)


def _age(nanoseconds: int) -> float | str:
    """Return an age [ns] in seconds, or that nothing has come yet: then it is huge."""
    return 'never' if nanoseconds > -NEVER // 2 else nanoseconds / NANOSECONDS
