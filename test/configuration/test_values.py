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

"""Values become what their parameters are, and implausible ones are refused with the mistake."""

from dataclasses import replace
import math
import re

from hypothesis import given, strategies as st
import pytest

from swerve_kinematics import SwerveController, SwerveKinematics
from swerve_kinematics.configuration.declarations import (
    Declaration, DOUBLES, ParameterError, STRINGS)
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
from swerve_kinematics.configuration.simulator import (
    SIMULATOR_DECLARATIONS, simulator_parameters_from)
from swerve_kinematics.configuration.values import converted, nearest, values_of

DEFAULTS = values_of(NODE_DECLARATIONS, {})
CORNERS = [(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)]
PERIOD = 0.1


def of(default):
    """Return a declaration of the type of a default."""
    return Declaration('name', default, 'description')


@pytest.mark.parametrize('default, given, value', [
    (1.0, 2, 2.0), (1.0, 2.5, 2.5), (1, 2, 2), (True, False, False), ('a', 'b', 'b'),
    (DOUBLES, [], []), (DOUBLES, 1, [1.0]), (DOUBLES, [1, 2.5], [1.0, 2.5]), ([1.0], 0, [0.0]),
    (STRINGS, 'a', ['a']), (STRINGS, ['a', 'b'], ['a', 'b'])])
def test_integers_serve_as_floats_and_single_values_as_lists(default, given, value):
    taken = converted(of(default), given)
    assert taken == value
    for entry, expected in zip(*((x if isinstance(x, list) else [x]) for x in (taken, value))):
        assert type(entry) is type(expected)


@pytest.mark.parametrize('default, given, reason', [
    (1.0, 'a', 'must be a number'), (1.0, True, 'must be a number'), (1.0, [1.0], 'a number'),
    (1.0, '1.0', "= '1.0': must be a number"),
    (1, 1.0, 'must be an integer'), (True, 1, 'true or false'),
    ('a', 1, 'must be text'), ('a', None, 'has no value'), (DOUBLES, None, 'has no value'),
    (DOUBLES, ['a'], 'must be a list of numbers'), (DOUBLES, [1.0, None], 'a list of numbers'),
    (DOUBLES, [[1.0]], 'a list of numbers'), (STRINGS, [1], 'must be a list of texts'),
    (1.0, {'a': 1}, 'must be a number'), (1, 1 << 63, 'no integer of this size'),
    (1.0, 10 ** 400, 'no integer of this size'), (DOUBLES, [-10 ** 400], 'no integer')])
def test_other_types_are_refused(default, given, reason):
    with pytest.raises(ParameterError, match=reason):
        converted(of(default), given)


@given(st.sampled_from([1.0, 1, True, 'a', DOUBLES, STRINGS, [0.5]]),
       st.recursive(st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
                    lambda inner: st.lists(inner, max_size=3), max_leaves=5))
def test_what_is_taken_is_taken_again_unchanged(default, value):
    declaration = of(default)
    try:
        taken = converted(declaration, value)
    except ParameterError:
        return
    again = converted(declaration, taken)
    assert repr(again) == repr(taken)


@pytest.mark.parametrize('declaration', [*NODE_DECLARATIONS, *SIMULATOR_DECLARATIONS],
                         ids=lambda declaration: declaration.name)
def test_every_default_is_of_its_own_type_and_range(declaration):
    assert converted(declaration, declaration.initial) == declaration.initial
    declaration.check(declaration.initial)


@pytest.mark.parametrize('name, value, mistake', [
    ('module_x', [300.0, 300.0, -300.0, -300.0], 'millimetres?'),
    ('module_y', [250.0, -250.0, 250.0, -250.0], 'millimetres?'),
    ('wheel_radii', [50.0], 'millimetres?'),
    ('steering_offsets', [90.0], 'degrees?'), ('steering_offsets', [-45.0], 'degrees?'),
    ('steering_lower_limits', [-110.0], 'degrees?'),
    ('steering_upper_limits', [110.0], 'degrees?'),
    ('max_linear_speed', 1500.0, 'millimetres per second?'),
    ('max_module_speed', 4000.0, 'millimetres per second?'),
    ('max_angular_speed', 180.0, 'degrees per second?'),
    ('max_steering_rate', 360.0, 'degrees per second?'),
    ('min_steering_speed', 12.0, 'millimetres per second?'),
    ('odometry.distance_resolution', 0.08, 'millimetres?'),
    ('imu_orientation', [180.0, 0.0, 0.0], 'degrees?'),
    ('center_of_rotation', [300.0, 0.0], 'millimetres?'),
    ('cmd_vel_timeout', 500.0, 'milliseconds?'), ('feedback_timeout', 250.0, 'milliseconds?'),
    ('gyro_timeout', 200.0, 'milliseconds?')])
def test_the_wrong_unit_is_refused_by_its_name(name, value, mistake):
    with pytest.raises(ParameterError) as refusal:
        parameters_from({**DEFAULTS, name: value})
    assert f"'{name}'" in str(refusal.value) and str(refusal.value).endswith(mistake)
    assert refusal.value.name == name


@pytest.mark.parametrize('value, allowed', [
    (math.inf, r'within \[0, 1e\+09\]'), (1e12, r'within \[0, 1e\+09\]'),
    (math.nan, r'within \[0, 1e\+09\]'), (-1.0, '0 or more')])
def test_a_refused_number_is_outside_of_what_the_refusal_allows(value, allowed):
    with pytest.raises(ParameterError, match=f'must be {allowed}$'):
        parameters_from({**DEFAULTS, 'max_linear_acceleration': value})


@pytest.mark.parametrize('name', [d.name for d in NODE_DECLARATIONS if 'max_' in d.name])
def test_0_turns_any_limit_off(name):
    parameters = parameters_from({**DEFAULTS, name: 0.0})
    part, _, field = name.rpartition('.')
    assert getattr(parameters.noise if part else parameters.limits, field) == math.inf


@pytest.mark.parametrize('name, changed', [
    ('steering_joint_names', {'drive_joint_names': ['a', 'b', 'c', 'd'],
                              'steering_joint_names': ['e', 'f', 'g', 'a']}),
    ('drive_joint_names', {'drive_joint_names': ['a', 'b', 'c', 'a']}),
    ('steering_joint_names', {'steering_joint_names': ['a', 'b', 'c', '']}),
    ('module_names', {'module_names': ['a', 'b', 'c', 'c']}),
    ('gyro_joint_name', {'gyro_joint_name': 'front_left_drive_joint'}),
    # What tf2 does not take.
    ('odom_frame_id', {'odom_frame_id': '/odom'}), ('base_frame_id', {'base_frame_id': '/base'}),
    ('frame_prefix', {'frame_prefix': '/robot1/'}), ('base_frame_id', {'base_frame_id': 'odom'}),
    ('steering_lower_limits', {'steering_lower_limits': [0.5], 'steering_upper_limits': [2.5]}),
    ('module_x', {'module_x': [0.0] * 4, 'module_y': [0.0] * 4}),
    ('module_x', {'module_x': [0.3, 0.3, -0.3, 0.3]}),
    ('max_linear_jerk', {'max_linear_jerk': 1e-320}),
    ('max_linear_deceleration', {'max_linear_deceleration': 1e-9}),
    ('module_y', {'module_y': [0.0]})])
def test_what_does_not_go_together_is_refused_by_its_name(name, changed):
    with pytest.raises(ParameterError, match=f"'{name}'") as refusal:
        parameters_from({**DEFAULTS, **changed})
    assert refusal.value.name == name


@pytest.mark.parametrize('name', ['module_names', 'drive_joint_names', 'steering_joint_names'])
def test_a_list_of_names_without_brackets_is_called_that(name):
    with pytest.raises(ParameterError, match=f"'{name}' = 'a, b, c, d': a comma in a name: write"):
        parameters_from({**DEFAULTS, name: ['a, b, c, d']})


def stopping_time(limits, twist):
    """Return how long [s] a base takes to stop from a twist, once it has it."""
    controller = SwerveController(SwerveKinematics(CORNERS), limits)
    angles = [math.atan2(x, -y) if twist[2] else 0.0 for x, y in CORNERS]
    for _ in range(round(200.0 / PERIOD)):
        controller.update(twist, angles, PERIOD)
    steps = range(round(200.0 / PERIOD))
    return next(PERIOD * k for k in steps
                if not any(controller.update((0.0, 0.0, 0.0), angles, PERIOD).speed))


@pytest.mark.parametrize('speed, limit', [
    ('max_linear_speed', 'max_linear_deceleration'), ('max_linear_speed', 'max_linear_jerk'),
    ('max_linear_speed', 'max_grip_acceleration'),
    ('max_angular_speed', 'max_angular_acceleration'), ('max_angular_speed', 'max_angular_jerk'),
    ('max_module_speed', 'max_module_acceleration')])
def test_a_limit_with_which_the_base_would_hardly_ever_stop_is_refused(speed, limit):
    with pytest.raises(ParameterError, match=f"'{limit}' = .* from '{speed}' = ") as refusal:
        parameters_from({**DEFAULTS, limit: 0.001})
    least = float(re.search('must be ([0-9.]+) or more', str(refusal.value))[1])
    top = DEFAULTS[speed]
    twist = (0.0, 0.0, top) if speed == 'max_angular_speed' else (top, 0.0, 0.0)
    allowed = parameters_from({**DEFAULTS, limit: 1.1 * least}).limits
    assert 0.0 < stopping_time(allowed, twist) < 60.0
    refused = replace(allowed, max_linear_speed=math.inf, **{limit: 0.9 * least})
    assert stopping_time(refused, twist) > 60.0


@pytest.mark.parametrize('name, value', [
    ('seed', -1), ('slipping_wheel', 4), ('steering_offsets', [45.0]), ('publish_rate', 0.0),
    ('imu_orientation', [0.0, 90.0, 0.0]), ('imu_position', [100.0, 0.0]), ('module_y', [0.0]),
    ('encoder_resolution', -5), ('gyro_noise_density', -1.0),
    ('dropped_sample_probability', 2.0), ('miswired.swapped', ['front_left']),
    ('miswired.dead_drives', ['nobody']),
    ('miswired.swapped', ['front_left', 'front_right', 'front_left']),
    ('miswired.frozen', ['rear_left', 'rear_left']), ('physics', 'unreal'), ('mujoco.mass', 0.0)])
def test_what_the_simulated_base_cannot_be_is_refused(name, value):
    with pytest.raises(ParameterError, match=f"'{name}'"):
        simulator_parameters_from({**values_of(SIMULATOR_DECLARATIONS, {}), name: value})


@pytest.mark.parametrize('region', [
    [0.0, 0.0, 1.0, 1.0], [1.0, 2.0], [1.0, 0.0, 0.0, 1.0, 0.3], [0.0, 1.0, 1.0, 0.0, 0.3],
    [0.0, 0.0, 1.0, 1.0, -0.3], [0.0, 0.0, 1.0, 1.0, 30.0]])
def test_a_region_that_no_floor_has_is_refused(region):
    values = {**values_of(SIMULATOR_DECLARATIONS, {}), 'physics': 'mujoco'}
    allowed = [0.0, 0.0, 1.0, 1.0, 0.3]
    simulator_parameters_from({**values, 'mujoco.friction_regions': allowed})
    with pytest.raises(ParameterError, match="'mujoco.friction_regions'"):
        simulator_parameters_from({**values, 'mujoco.friction_regions': allowed + region})


@pytest.mark.parametrize('name, meant', [
    ('wheel_radius', 'wheel_radii'), ('max_linear_sped', 'max_linear_speed'),
    ('odometry.slip_rato', 'odometry.slip_ratio'), ('drive_joints', 'drive_joint_names'),
    ('module_Y', 'module_y'), ('WHEEL_RADIUS', 'wheel_radii')])
def test_the_nearest_name_is_the_one_that_was_meant(name, meant):
    assert nearest(name, DEFAULTS) == meant
