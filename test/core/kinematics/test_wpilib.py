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
A cross-check against WPILib (robotpy-wpimath 2026), over thousands of seeded cases.

Agreed to 1e-9: wrapping, inverse with and without a centre of rotation, forward, held angles,
optimize, cosine scaling, desaturation, discretize, field and robot frames, SE(2) exp and
log, mecanum inverse, forward and desaturation.

Different on purpose, each pinned below by a test that shows both results:

- `desaturate_chassis`: WPILib's overload makes the fastest module run at the larger chassis
  ratio times the module limit: it slows commands that saturate nothing and lets others
  exceed the module limit; ours takes the tightest of the three limits.
- `desaturate` with a negative limit: WPILib reverses the wheels; ours refuses.
- `optimize` at exactly 90 degrees: WPILib flips or not by the noise of the last bit; ours
  never flips there.
- A module with no velocity: WPILib answers with the angle of the previous call, a state in
  the kinematics object; ours with `held_angles`, an argument.
- Straight back, with vy a hair below 0: WPILib answers -pi; ours lies in (-pi, pi].
- NaN: WPILib gives the modules the angles of the previous call; ours NaN.
- A layout with all modules at one point, or with NaN: WPILib accepts it; ours refuses.
- `discretize`: WPILib wraps a turn beyond pi, so that the base turns the other way, and
  gives NaN at dt = 0; ours keeps omega, and returns the twist itself at dt = 0.
- `se2_exp` keeps count of the turns; WPILib's heading is wrapped by `Rotation2d`.
- `se2_log` and `discretize` are exact to the last digits for small turns; WPILib's are off
  by 1e-8 of the length at 1e-4 rad, so the agreement is checked beyond 0.01 rad.
- `interpolate` works on states and clamps t to [0, 1]; WPILib's on positions, and it runs on
  beyond the ends.

Not in WPILib at all: residuals, pairwise twists, accelerations and steering rates (absent
from the Python API of 2026), a centre of rotation for each item, 5, 7, 8 or more modules.
"""

import numpy as np
from numpy.testing import assert_allclose
import pytest
import swerve_kinematics as sk
from wpimath import angleModulus, geometry, kinematics as wpi

EXACT = {'rtol': 1e-9, 'atol': 1e-9}
RECTANGLE = np.array([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
WPI_BY_COUNT = {2: wpi.SwerveDrive2Kinematics, 3: wpi.SwerveDrive3Kinematics,
                4: wpi.SwerveDrive4Kinematics, 6: wpi.SwerveDrive6Kinematics}
each_count = pytest.mark.parametrize('count', WPI_BY_COUNT)


def rng_of(seed):
    """Return the generator of a test."""
    return np.random.default_rng(20260000 + seed)


def wpi_kinematics(positions):
    """Return WPILib's object for a layout."""
    return WPI_BY_COUNT[len(positions)](*(geometry.Translation2d(*r) for r in positions))


def wpi_states(speeds, angles):
    """Return one set of WPILib's module states."""
    return tuple(wpi.SwerveModuleState(speed, geometry.Rotation2d(angle))
                 for speed, angle in zip(speeds, angles))


def values(states):
    """Return speeds and angles of one set of WPILib's module states."""
    return ([state.speed for state in states], [state.angle.radians() for state in states])


def twist_of(speeds):
    """Return WPILib's ChassisSpeeds as an array."""
    return np.array([speeds.vx, speeds.vy, speeds.omega])


def assert_same_velocities(ours, theirs):
    """Compare states by velocity vector, for an angle of -pi is one of +pi."""
    speed, angle = np.array(theirs)
    assert_allclose(ours.speed, speed, **EXACT)
    assert_allclose(ours.speed * np.exp(1j * ours.angle), speed * np.exp(1j * angle), **EXACT)


def optimized(speed, angle, measured):
    """Return what WPILib's optimize makes of one module."""
    state = wpi.SwerveModuleState(speed, geometry.Rotation2d(angle))
    state.optimize(geometry.Rotation2d(measured))
    return state.speed, state.angle.radians()


@each_count
def test_inverse(count):
    rng = rng_of(count)
    positions = rng.uniform(-2.0, 2.0, (count, 2))
    twists, centers = rng.normal(scale=3.0, size=(1000, 3)), rng.uniform(-2, 2, (1000, 2))
    theirs, ours = wpi_kinematics(positions), sk.SwerveKinematics(positions)
    about_base_link = [values(theirs.toSwerveModuleStates(wpi.ChassisSpeeds(*twist)))
                       for twist in twists]
    about_centers = [values(theirs.toSwerveModuleStates(wpi.ChassisSpeeds(*twist),
                                                        geometry.Translation2d(*center)))
                     for twist, center in zip(twists, centers)]
    assert_same_velocities(ours.inverse(twists), np.swapaxes(about_base_link, 0, 1))
    assert_same_velocities(ours.inverse(twists, centers), np.swapaxes(about_centers, 0, 1))


@each_count
def test_forward(count):
    rng = rng_of(10 + count)
    positions = rng.uniform(-2.0, 2.0, (count, 2))
    speeds, angles = rng.normal(size=(1000, count)), rng.uniform(-7, 7, (1000, count))
    theirs = wpi_kinematics(positions)
    expected = [twist_of(theirs.toChassisSpeeds(wpi_states(*state)))
                for state in zip(speeds, angles)]
    assert_allclose(sk.SwerveKinematics(positions).forward((speeds, angles)), expected, **EXACT)


def test_wrap_angle():
    angles = np.concatenate((rng_of(70).uniform(-50, 50, 1000), np.pi * np.arange(-3, 4)))
    assert_allclose(sk.wrap_angle(angles), [angleModulus(angle) for angle in angles], **EXACT)


def test_optimize_and_cosine_scale():
    rng = rng_of(20)
    speed, angle, measured = rng.normal(size=4000), *rng.uniform(-7, 7, (2, 4000))
    expected = np.array([optimized(*item) for item in zip(speed, angle, measured)])
    assert_same_velocities(sk.optimize((speed, angle), measured), expected.T)
    states = wpi_states(speed, angle)
    for state, current in zip(states, measured):
        state.cosineScale(geometry.Rotation2d(current))
    assert_same_velocities(sk.cosine_scale((speed, angle), measured), values(states))


def test_desaturate():
    rng = rng_of(30)
    speeds, limits = rng.normal(scale=3.0, size=(1000, 4)), rng.uniform(0.5, 9.0, 1000)
    expected = [values(wpi.SwerveDrive4Kinematics.desaturateWheelSpeeds(
        wpi_states(speed, np.zeros(4)), limit))[0] for speed, limit in zip(speeds, limits)]
    assert_allclose(sk.desaturate((speeds, np.zeros(4)), limits).speed, expected, **EXACT)


def test_mecanum():
    rng = rng_of(40)
    for _ in range(20):
        wheels = RECTANGLE + rng.uniform(-0.15, 0.15, (4, 2))
        theirs = wpi.MecanumDriveKinematics(*(geometry.Translation2d(*r) for r in wheels))
        ours = sk.MecanumKinematics(wheels)
        for twist, center in zip(rng.normal(size=(50, 3)), rng.uniform(-1, 1, (50, 2))):
            wheel_speeds = theirs.toWheelSpeeds(wpi.ChassisSpeeds(*twist),
                                                geometry.Translation2d(*center))
            assert_allclose(ours.inverse(twist, center), mecanum_values(wheel_speeds), **EXACT)
        for speeds in rng.normal(scale=2.0, size=(50, 4)):
            wheel_speeds = wpi.MecanumDriveWheelSpeeds(*speeds)
            assert_allclose(ours.forward(speeds), twist_of(theirs.toChassisSpeeds(wheel_speeds)),
                            **EXACT)
            wheel_speeds.desaturate(1.5)
            assert_allclose(ours.desaturate(speeds, 1.5), mecanum_values(wheel_speeds), **EXACT)


def mecanum_values(speeds):
    """Return WPILib's wheel speeds as a list."""
    return [speeds.frontLeft, speeds.frontRight, speeds.rearLeft, speeds.rearRight]


def test_exp_and_log():
    twists = rng_of(50).uniform([-5, -5, -3.1], [5, 5, 3.1], (2000, 3))
    twists = twists[np.abs(twists[:, 2]) > 0.01]
    for twist, pose in zip(twists, sk.se2_exp(twists)):
        theirs = geometry.Pose2d().exp(geometry.Twist2d(*twist))
        assert_allclose(pose, [theirs.x, theirs.y, theirs.rotation().radians()], **EXACT)
        back = geometry.Pose2d().log(geometry.Pose2d(*pose[:2], geometry.Rotation2d(pose[2])))
        assert_allclose(sk.se2_log(pose), [back.dx, back.dy, back.dtheta], **EXACT)


def test_discretize_and_frames():
    rng = rng_of(60)
    twists, dts = rng.uniform(1.0, 6.0, (1000, 3)), rng.uniform(0.01, 0.25, 1000)
    headings = rng.uniform(-7, 7, 1000)
    for twist, dt, heading in zip(twists, dts, headings):
        speeds, rotation = wpi.ChassisSpeeds(*twist), geometry.Rotation2d(heading)
        assert_allclose(sk.discretize(twist, dt),
                        twist_of(wpi.ChassisSpeeds.discretize(speeds, dt)), **EXACT)
        assert_allclose(sk.to_robot_frame(twist, heading), twist_of(
            wpi.ChassisSpeeds.fromFieldRelativeSpeeds(speeds, rotation)), **EXACT)
        assert_allclose(sk.to_field_frame(twist, heading), twist_of(
            wpi.ChassisSpeeds.fromRobotRelativeSpeeds(speeds, rotation)), **EXACT)


# From here on: the differences, both results side by side.

@pytest.mark.parametrize('twist, limits, theirs_fastest, ours_fastest', [
    ((3.0, 0.0, 0.0), (4.0, 6.0, 12.0), 2.0, 3.0),  # nothing is saturated
    ((6.0, 0.0, 0.0), (4.0, 2.0, 12.0), 6.0, 2.0)])  # everything is
def test_desaturate_chassis_differs(twist, limits, theirs_fastest, ours_fastest):
    kinematics, speeds = wpi_kinematics(RECTANGLE), wpi.ChassisSpeeds(*twist)
    theirs = kinematics.desaturateWheelSpeeds(
        kinematics.toSwerveModuleStates(speeds), speeds, *limits)
    assert_allclose(max(values(theirs)[0]), theirs_fastest)
    ours = sk.desaturate_chassis(sk.SwerveKinematics(RECTANGLE).inverse(twist), twist, *limits)
    assert_allclose(ours.speed.max(), ours_fastest)


def test_desaturate_with_a_negative_limit_differs():
    theirs = wpi.SwerveDrive4Kinematics.desaturateWheelSpeeds(
        wpi_states([2.0, 1.0, 1.0, 1.0], np.zeros(4)), -1.0)
    assert_allclose(values(theirs)[0], [-1.0, -0.5, -0.5, -0.5])
    with pytest.raises(ValueError, match='max_speed'):
        sk.desaturate(([2.0, 1.0, 1.0, 1.0], np.zeros(4)), -1.0)


def test_optimize_at_exactly_90_degrees_differs():
    measured = np.radians(np.arange(-180, 180))
    theirs = [optimized(1.0, angle + np.pi / 2, angle)[0] for angle in measured]
    ours = sk.optimize((np.ones(360), measured + np.pi / 2), measured).speed
    assert 10 < np.sum(np.less(theirs, 0.0)) < 350
    assert (ours == 1.0).all()


def test_a_module_without_velocity_differs_by_where_its_angle_is_kept():
    kinematics = wpi_kinematics(RECTANGLE)
    kinematics.toSwerveModuleStates(wpi.ChassisSpeeds(1.0, 1.0, 0.0))
    speed, angle = values(kinematics.toSwerveModuleStates(wpi.ChassisSpeeds(0.0, 0.0, 0.0)))
    assert_allclose((speed, angle), ([0.0] * 4, [np.pi / 4] * 4))
    ours = sk.SwerveKinematics(RECTANGLE)
    assert_allclose(ours.inverse([0.0, 0.0, 0.0]).angle, 0.0)
    assert_allclose(ours.inverse([0.0, 0.0, 0.0], held_angles=angle), (speed, angle))


def test_held_angles_agree_once_theirs_are_reset():
    held, kinematics = [0.1, 0.2, 0.3, 0.4], wpi_kinematics(RECTANGLE)
    for twist, center in (((0, 0, 0), (0, 0)), ((0, 0, 1), (0.3, 0.2)), ((9e-7, 0, 0), (0, 0))):
        kinematics.resetHeadings(tuple(geometry.Rotation2d(angle) for angle in held))
        theirs = kinematics.toSwerveModuleStates(
            wpi.ChassisSpeeds(*twist), geometry.Translation2d(*center))
        assert_same_velocities(
            sk.SwerveKinematics(RECTANGLE).inverse(twist, center, held), values(theirs))


def test_straight_back_differs_by_a_turn():
    theirs = wpi_kinematics(RECTANGLE).toSwerveModuleStates(wpi.ChassisSpeeds(-1.0, -1e-20, 0))
    assert values(theirs)[1] == [-np.pi] * 4
    ours = sk.SwerveKinematics(RECTANGLE).inverse([-1.0, -1e-20, 0.0])
    assert ours.angle.tolist() == [np.pi] * 4


def test_nan_differs():
    kinematics = wpi_kinematics(RECTANGLE)
    kinematics.toSwerveModuleStates(wpi.ChassisSpeeds(1.0, 1.0, 0.0))
    speed, angle = values(kinematics.toSwerveModuleStates(wpi.ChassisSpeeds(np.nan, 0.0, 0.0)))
    assert_allclose((speed, angle), ([np.nan] * 4, [np.pi / 4] * 4))
    ours = sk.SwerveKinematics(RECTANGLE).inverse([np.nan, 0.0, 0.0])
    assert np.isnan(ours).all()


@pytest.mark.parametrize('positions', [[(1.0, 1.0), (1.0, 1.0)], [(np.nan, 1.0), (1.0, 1.0)]])
def test_an_unsolvable_layout_differs(positions):
    theirs = wpi_kinematics(positions)
    assert theirs.toSwerveModuleStates(wpi.ChassisSpeeds(1.0, 0.0, 0.0))
    with pytest.raises(ValueError, match='module_positions'):
        sk.SwerveKinematics(positions)


def test_discretize_beyond_half_a_turn_differs():
    theirs = twist_of(wpi.ChassisSpeeds.discretize(wpi.ChassisSpeeds(1.0, 0.0, 4.0), 1.0))
    assert_allclose(theirs[2], 4.0 - 2.0 * np.pi)
    ours = sk.discretize([1.0, 0.0, 4.0], 1.0)
    assert ours[2] == 4.0
    assert_allclose(sk.se2_exp(ours), [1.0, 0.0, 4.0], atol=1e-12)


def test_discretize_over_no_time_differs():
    theirs = wpi.ChassisSpeeds.discretize(wpi.ChassisSpeeds(1.0, 0.0, 0.5), 0.0)
    assert np.isnan(twist_of(theirs)).all()
    assert sk.discretize([1.0, 0.0, 0.5], 0.0).tolist() == [1.0, 0.0, 0.5]


def test_exp_beyond_half_a_turn_differs_by_a_turn():
    theirs = geometry.Pose2d().exp(geometry.Twist2d(1.0, 2.0, 3.5)).rotation().radians()
    assert_allclose(theirs, 3.5 - 2.0 * np.pi)
    assert sk.se2_exp([1.0, 2.0, 3.5])[2] == 3.5


def test_log_and_discretize_of_a_small_turn_differ():
    twist = np.array([1.0, 2.0, 1e-4])
    pose = sk.se2_exp(twist)
    theirs = geometry.Pose2d().log(geometry.Pose2d(*pose[:2], geometry.Rotation2d(pose[2])))
    assert 1e-9 < abs(theirs.dx - 1.0) < 1e-7
    assert_allclose(sk.se2_log(pose), twist, rtol=1e-15)
    theirs = wpi.ChassisSpeeds.discretize(wpi.ChassisSpeeds(*twist), 1.0)
    ours = sk.discretize(twist, 1.0)
    assert 1e-9 < abs(theirs.vx - ours[0]) < 1e-7
    assert_allclose(sk.se2_exp(ours), twist, rtol=1e-15)


def test_interpolate_beyond_the_end_differs():
    def positions(distance, angle):
        return (wpi.SwerveModulePosition(distance, geometry.Rotation2d(angle)),) * 4

    theirs = wpi_kinematics(RECTANGLE).interpolate(positions(1, 0), positions(5, 1), 1.5)[0]
    assert_allclose((theirs.distance, theirs.angle.radians()), (7.0, 1.5))
    ours = sk.interpolate(([1.0], [0.0]), ([5.0], [1.0]), 1.5)
    assert_allclose(ours, ([5.0], [1.0]))


def test_what_wpilib_lacks():
    names = dir(wpi) + dir(wpi.SwerveDrive4Kinematics) + dir(wpi.MecanumDriveKinematics)
    assert not [name for name in names if 'accel' in name.lower() or 'residual' in name.lower()]
    assert [name for name in dir(wpi) if name.startswith('SwerveDrive')
            and name.endswith('Kinematics')] == [f'SwerveDrive{n}Kinematics' for n in WPI_BY_COUNT]
