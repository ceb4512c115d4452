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
Print how far our odometry and the common end-angle method stray, in two tables.

    PYTHONPATH=test python -m benchmarks.accuracy [FOLDER]

Every log (.npz) in FOLDER, by default test/data, at its own rate, at 20 Hz and with faulty
sensors, then motions without any slip at 200, 50 and 20 Hz. The second table is about the
logs with an accelerometer in FOLDER/imu, with ordinary sensors: slip and clean floors apart,
without and with the accelerometer, and how the covariance fits the error. What depends on the
chance of noise is a mean over several draws of it.
"""

from pathlib import Path
import sys

from benchmarks import drives, inertial_drives
import numpy as np

from swerve_kinematics.core.kinematics.swerve import SwerveKinematics
from swerve_kinematics.core.odometry.odometry import SwerveOdometry

DATA = Path(__file__).parents[1] / 'data'
DRAWS = 8  # of the noise
CORNERS = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])
ROW = '{:30}{:10.1f}{:14.1f}{:8.3f}{:11.3f}{:11.3f}'
HEADER = f"{'drive':30}{'ATE [mm]':>10}{'end angle [mm]':>15}{'ratio':>7}" \
         f"{'drift [%]':>11}{'yaw [deg]':>11}"


INERTIAL_ROW = '{:30}{:>14}{:>12}{:>10}{:>14}{:>12}'
INERTIAL_HEADER = INERTIAL_ROW.format('drive, ATE in mm', 'end angle', 'without IMU', 'with IMU',
                                      'NEES without', 'NEES with')


def conditions(logs):
    """Yield (condition, lists of drives by name) for the logs as they are, slower and faulty."""
    yield 'logs, 50 Hz', {name: [drive] for name, drive in logs.items()}
    yield 'logs, 20 Hz', {name: [drives.slower(drive, 20)] for name, drive in logs.items()}
    yield 'logs, faulty sensors', {name: [drives.faulty(drive, np.random.default_rng(seed))
                                          for seed in range(DRAWS)]
                                   for name, drive in logs.items()}
    yield 'no slip', {f'{rate} Hz': [drives.smooth_motion(CORNERS, rate)]
                      for rate in (200, 50, 20)}


def compared(drive):
    """Return [ours, reference, ratio, drift, yaw error]: [mm], [mm], 1, [%], [deg]."""
    odometry = SwerveOdometry(SwerveKinematics(drive.modules), drive.truth[0])
    poses = drives.replay(odometry, drive)
    ours = 1e3 * drives.position_error(poses, drive)
    reference = 1e3 * drives.position_error(drives.end_angle_poses(drive), drive)
    error = poses[-1] - drive.truth[-1]
    length = np.hypot(*np.diff(drive.truth[:, :2], axis=0).T).sum()
    drift = 100.0 * np.hypot(error[0], error[1]) / max(length, 1e-3)
    return [ours, reference, ours / reference, drift, np.degrees(abs(error[2]))]


def compared_inertial(log):
    """Return [end angle, without, with the IMU] [mm] and the mean NEES of the last two."""
    without, nees_without = inertial_drives.replay(log, imu=False)
    with_imu, nees_with = inertial_drives.replay(log)
    errors = [1e3 * drives.position_error(poses, log.drive)
              for poses in (drives.end_angle_poses(log.drive), without, with_imu)]
    return [*errors, nees_without.mean(), nees_with.mean()]


def drawn(ideal):
    """Return the mean of `compared_inertial` over draws of the sensors' faults."""
    return np.mean([compared_inertial(inertial_drives.faulty(ideal, np.random.default_rng(seed)))
                    for seed in range(DRAWS)], axis=0)


def print_inertial(folder):
    """Print the table of the logs with an accelerometer."""
    rows = {path.stem: drawn(inertial_drives.load(path)) for path in sorted(folder.glob('*.npz'))}
    print(INERTIAL_HEADER)
    for name, row in rows.items():
        print(INERTIAL_ROW.format(name, *(f'{value:.1f}' for value in row)))
    for kind in ('slip', 'clean'):
        of_kind = np.array([row for name, row in rows.items()
                            if inertial_drives.slips(name) == (kind == 'slip')])
        if len(of_kind):
            for title, summary in SUMMARIES.items():
                print(INERTIAL_ROW.format(f'= {title}, {kind}',
                                          *(f'{value:.1f}' for value in summary(of_kind))))


SUMMARIES = {'mean': lambda rows: rows.mean(axis=0),
             'geometric mean': lambda rows: np.exp(np.log(rows).mean(axis=0)),
             'worst': lambda rows: rows.max(axis=0)}


def main(folder=DATA):
    """Print the table, with the mean of each condition."""
    logs = {path.stem: drives.load(path) for path in sorted(Path(folder).glob('*.npz'))}
    print(HEADER)
    for condition, named_drives in conditions(logs):
        rows = {name: np.mean([compared(drive) for drive in alike], axis=0)
                for name, alike in named_drives.items()}
        for name, row in rows.items():
            print(ROW.format(name, *row))
        if rows:
            mean = np.mean(list(rows.values()), axis=0)
            mean[2] = mean[0] / mean[1]
            print(ROW.format(f'= mean of {condition}', *mean))
    print()
    print_inertial(Path(folder) / 'imu')


if __name__ == '__main__':
    main(*sys.argv[1:2])
