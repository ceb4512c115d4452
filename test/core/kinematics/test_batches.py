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
What every function of the core promises about batches, and the million twists.

CASES lists each public function with the shapes of its arguments for a single item; the
tests put leading axes before them.
"""

import tracemalloc

import numpy as np
from numpy.testing import assert_allclose
import pytest
import swerve_kinematics as sk

N = 5
BEARING = 2.0 * np.pi / N * np.arange(N)
KIN = sk.SwerveKinematics(np.stack((np.cos(BEARING) + 0.3, 0.8 * np.sin(BEARING)), axis=-1))
MECANUM = sk.MecanumKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])

TWIST, POINT, MODULES, ONE = (3,), (2,), (N,), ()
CASES = {
    'wrap_angle': (sk.wrap_angle, [ONE]),
    'angle_difference': (sk.angle_difference, [ONE, ONE]),
    'se2_exp': (sk.se2_exp, [TWIST]),
    'se2_log': (sk.se2_log, [TWIST]),
    'se2_compose': (sk.se2_compose, [TWIST, TWIST]),
    'to_robot_frame': (sk.to_robot_frame, [TWIST, ONE]),
    'to_field_frame': (sk.to_field_frame, [TWIST, ONE]),
    'discretize': (sk.discretize, [TWIST, ONE]),
    'joystick_twist': (lambda *axes: sk.joystick_twist(*axes, 2.0, 0.5, 0.1), [ONE, ONE, ONE]),
    'optimize': (lambda s, a, m: sk.optimize((s, a), m, 0.1), [MODULES, MODULES, MODULES]),
    'cosine_scale': (lambda s, a, m: sk.cosine_scale((s, a), m), [MODULES, MODULES, MODULES]),
    'desaturate': (lambda s, a: sk.desaturate((s, a), 1.0), [MODULES, MODULES]),
    'desaturate_chassis': (lambda s, a, t: sk.desaturate_chassis((s, a), t, 1.0, 1.0, 1.0),
                           [MODULES, MODULES, TWIST]),
    'interpolate': (lambda s, a, s2, a2, t: sk.interpolate((s, a), (s2, a2), t),
                    [MODULES, MODULES, MODULES, MODULES, ONE]),
    'inverse': (KIN.inverse, [TWIST, POINT]),
    'forward': (lambda s, a: KIN.forward((s, a)), [MODULES, MODULES]),
    'residuals': (lambda s, a: KIN.residuals((s, a)), [MODULES, MODULES]),
    'pairwise': (lambda s, a: KIN.pairwise((s, a)), [MODULES, MODULES]),
    'module_accelerations': (KIN.module_accelerations, [TWIST, ONE, POINT]),
    'chassis_acceleration': (KIN.chassis_acceleration, [(N, 2)]),
    'steering_rates': (KIN.steering_rates, [TWIST, TWIST, POINT]),
    'mecanum inverse': (MECANUM.inverse, [TWIST, POINT]),
    'mecanum forward': (MECANUM.forward, [(4,)]),
    'mecanum desaturate': (lambda s: MECANUM.desaturate(s, 1.0), [(4,)]),
}
each_function = pytest.mark.parametrize('function, shapes', CASES.values(), ids=CASES)


def test_the_cases_cover_every_public_function_of_batches():
    names = {name for name in sk.__all__ if name[0].islower()}
    assert names <= set(CASES)


def arguments(shapes, *leading):
    """Return seeded arguments, with one leading shape for all or one for each."""
    rng = np.random.default_rng(len(shapes))
    leading = leading if len(leading) == len(shapes) else leading * len(shapes)
    return [rng.uniform(-2.0, 2.0, lead + shape) for lead, shape in zip(leading, shapes)]


def outputs(function, args):
    """Return the results as a tuple of arrays."""
    result = function(*args)
    return result if isinstance(result, tuple) else (result,)


@each_function
def test_a_batch_is_its_items_one_at_a_time(function, shapes):
    args = arguments(shapes, (2, 3))
    together = outputs(function, args)
    for index in np.ndindex(2, 3):
        alone = outputs(function, [arg[index] for arg in args])
        for batch, item in zip(together, alone):
            assert_allclose(batch[index], item, rtol=1e-12, atol=1e-12)


@each_function
def test_leading_axes_broadcast(function, shapes):
    for wide in range(len(shapes)):
        leading = [(4, 3) if i == wide else (3,) for i in range(len(shapes))]
        args = arguments(shapes, *leading)
        full = [np.broadcast_to(arg, (4, 3) + shape) for arg, shape in zip(args, shapes)]
        for result, expected in zip(outputs(function, args), outputs(function, full)):
            assert_allclose(result, expected, rtol=1e-12, atol=1e-12)


@each_function
def test_an_empty_batch_gives_an_empty_result(function, shapes):
    some = outputs(function, arguments(shapes, (1,)))
    none = outputs(function, arguments(shapes, (0,)))
    for result, expected in zip(none, some):
        assert result.shape == (0,) + expected.shape[1:]


@each_function
def test_nan_stays_with_its_item(function, shapes):
    for poisoned in range(len(shapes)):
        args = arguments(shapes, (4,))
        clean = outputs(function, args)
        args[poisoned][1] = np.nan
        results = outputs(function, args)
        assert any(np.isnan(result[1]).any() for result in results)
        for result, expected in zip(results, clean):
            assert_allclose(np.delete(result, 1, axis=0), np.delete(expected, 1, axis=0),
                            rtol=1e-12, atol=1e-12)


@each_function
def test_arguments_are_not_changed(function, shapes):
    args = arguments(shapes, (3,))
    copies = [arg.copy() for arg in args]
    for arg in args:
        arg.flags.writeable = False
    function(*args)
    for arg, copy in zip(args, copies):
        np.testing.assert_array_equal(arg, copy)


@each_function
@pytest.mark.parametrize('kind', ['?', 'i1', 'u1', 'u8', 'f2', 'f4', '>f8', 'g', 'O'])
def test_numbers_of_any_kind_count_as_float64(function, shapes, kind):
    args = [np.abs(arg).astype(kind) for arg in arguments(shapes, (3,))]
    expected = outputs(function, [arg.astype(float) for arg in args])
    for given in (args, [arg.tolist() for arg in args]):
        for result, exact in zip(outputs(function, given), expected):
            assert result.dtype == np.float64
            assert_allclose(result, exact, rtol=1e-15, atol=1e-15)


@each_function
def test_a_result_shares_no_memory(function, shapes):
    args = arguments(shapes, (3,))
    results = outputs(function, args)
    for place, result in enumerate(results):
        assert result.flags.writeable
        for other in (*args, *results[:place]):
            assert not np.shares_memory(result, other)


@pytest.mark.parametrize('limited', [
    lambda states, limit: sk.desaturate(states, limit),
    lambda states, limit: sk.desaturate_chassis(states, [1.0, 0.0, 0.0], limit, 1.0, 1.0),
    lambda states, limit: sk.desaturate_chassis(states, [1.0, 0.0, 0.0], 1.0, limit, 1.0)])
def test_one_set_of_states_and_many_limits_make_many_sets(limited):
    states = KIN.inverse([1.0, 0.5, 2.0])
    speed, angle = limited(states, [0.2, 0.4])
    assert speed.shape == angle.shape == (2, N)
    for item, limit in enumerate((0.2, 0.4)):
        assert_allclose((speed[item], angle[item]), limited(states, limit))


def test_held_angles_broadcast_against_the_twist():
    held = np.arange(2.0 * N).reshape(2, N)
    speed, angle = KIN.inverse([0.0, 0.0, 0.0], held_angles=held)
    np.testing.assert_array_equal(angle, held)
    assert speed.shape == angle.shape
    assert speed.flags.writeable
    moving = KIN.inverse(np.eye(3)[:2], held_angles=held[0])
    np.testing.assert_array_equal(moving.angle, [[0.0] * N, [np.pi / 2] * N])


def test_a_million_twists_there_and_back_in_memory_proportional_to_the_result():
    kinematics = sk.SwerveKinematics([(0.3, 0.2), (0.3, -0.2), (-0.3, 0.2), (-0.3, -0.2)])
    twist = np.random.default_rng(1).normal(size=(1_000_000, 3))

    def peak_of(call):
        tracemalloc.start()
        result = call()
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return result, peak

    states, inverse_peak = peak_of(lambda: kinematics.inverse(twist))
    result, forward_peak = peak_of(lambda: kinematics.forward(states))
    assert inverse_peak < 2.5 * (states.speed.nbytes + states.angle.nbytes)
    assert forward_peak < 6.0 * result.nbytes
    assert_allclose(result, twist, rtol=0.0, atol=1e-13)
