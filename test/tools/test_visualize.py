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

"""swerve_visualize: the picture is read back, as data and as pixels."""


from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.quiver import Quiver
import numpy as np
import pytest
from swerve_kinematics import SwerveKinematics
from swerve_kinematics.tools.visualize import main as visualize
from swerve_kinematics.tools.visualize.main import FOUR_MODULES, main
from swerve_kinematics.tools.visualize.marks import (
    CENTER, COMMANDED, INSTANT, key, plain, REVERSED, ROTATION, round_speed, TRANSLATION,
    UNLIMITED)
from swerve_kinematics.tools.visualize.motion import Command, motion_of
from swerve_kinematics.tools.visualize.picture import draw

POSITIONS = FOUR_MODULES.positions
SCALE = 0.2  # s
AHEAD = np.zeros(4)


def picture_of(twist, center=(0.0, 0.0), angles=AHEAD, **command):
    """Return axes with the picture of the four-module base."""
    axes = Figure(figsize=(8.0, 8.0)).subplots()
    motion = motion_of(FOUR_MODULES.kinematics, Command(twist, center, **command), angles)
    draw(axes, FOUR_MODULES, motion, SCALE)
    return axes


def line_named(axes, label):
    """Return the line with a label."""
    return next(line for line in axes.lines if line.get_label() == label)


def arrows(axes):
    """Return starts and vectors [m], each (k, 2), of all arrows by their label."""
    return {quiver.get_label(): (quiver.get_offsets(), np.stack((quiver.U, quiver.V), axis=-1))
            for quiver in axes.collections if isinstance(quiver, Quiver)}


def expected(twist, center):
    """Return translation and rotation part (n, 2) of the module velocities [m/s]."""
    x, y = (POSITIONS - center).T
    return np.tile(twist[:2], (4, 1)), twist[2] * np.stack((-y, x), axis=-1)


def ink(path, color):
    """Return the pixels (k, 2) of a colour, `(column, row from below)`."""
    pixels = imread(path)[::-1, :, :3]
    rows, columns = np.nonzero(np.abs(pixels - to_rgb(color)).max(axis=-1) < 0.02)
    return np.stack((columns, rows), axis=-1)


@pytest.mark.parametrize('twist, center', [
    ((1.0, 0.4, 0.8), (0.0, 0.0)), ((0.3, -0.2, 2.0), (0.5, 0.1))])
def test_every_arrow_is_that_of_its_module(twist, center):
    drawn = arrows(picture_of(twist, center))
    translation, rotation = expected(twist, center)
    for label, velocities in (('translation', translation), ('rotation', rotation)):
        np.testing.assert_allclose(drawn[label][0], POSITIONS)
        np.testing.assert_allclose(drawn[label][1], SCALE * velocities)
    shown = {tuple(start): vector for label in ('commanded', 'commanded, drive reversed')
             if label in drawn for start, vector in zip(*drawn[label])}
    np.testing.assert_allclose([shown[tuple(position)] for position in POSITIONS],
                               SCALE * (translation + rotation), atol=1e-12)


def test_modules_more_than_90_degrees_away_are_dashed_and_red():
    axes = picture_of((0.2, 0.0, 2.0))
    reversed_ = next(collection for collection in axes.collections
                     if collection.get_label() == 'commanded, drive reversed')
    # A turn to the left: the modules on the left go backwards.
    np.testing.assert_allclose(reversed_.get_offsets(), [(0.3, 0.25), (-0.3, 0.25)])
    np.testing.assert_allclose(reversed_.get_edgecolor()[0, :3], to_rgb(REVERSED))
    assert reversed_.get_linestyle()[0][1]
    assert (reversed_.U < 0.0).all()
    commanded = next(collection for collection in axes.collections
                     if collection.get_label() == 'commanded')
    assert not commanded.get_linestyle()[0][1]
    np.testing.assert_allclose(commanded.get_facecolor()[0, :3], to_rgb(COMMANDED))


def test_wheels_are_turned_to_their_steering_angle():
    axes = picture_of((1.0, 1.0, 0.0))
    outline, *wheels = (patch.get_xy()[:4] for patch in axes.patches)
    np.testing.assert_allclose(sorted(map(tuple, outline)), sorted(map(tuple, POSITIONS)))
    for wheel, position in zip(wheels, POSITIONS):
        np.testing.assert_allclose(wheel.mean(axis=0), position)
        longest = max(np.diff(wheel, axis=0), key=np.linalg.norm)
        assert longest[0] == pytest.approx(longest[1])


def test_the_picture_is_to_scale_and_names_everything():
    axes = picture_of((1.0, 0.0, 1.0), (0.2, 0.1))
    assert axes.get_aspect() == 1.0
    words = '\n'.join(text.get_text() for text in axes.texts)
    for name in FOUR_MODULES.names:
        assert name in words
    # hypot(1 - 0.15, 0.1) and its direction.
    assert 'front_left\n0.86 m/s @ 7°' in words
    np.testing.assert_array_equal(
        line_named(axes, 'centre of rotation, commanded').get_xydata(), [(0.2, 0.1)])
    explained = {handle.get_label().split(':')[0] for handle in key()}
    drawn = {artist.get_label() for artist in (*axes.collections, *axes.lines)}
    assert {label for label in drawn if not label.startswith('_')} - {'scale'} <= explained


@pytest.mark.parametrize('twist, center, instant', [
    ((0.0, 0.0, 2.0), (0.2, 0.1), (0.2, 0.1)), ((1.0, 0.0, 2.0), (0.0, 0.0), (0.0, 0.5)),
    ((0.3, -0.2, -1.0), (0.1, 0.0), (0.1 - 0.2, -0.3))])
def test_the_instantaneous_centre_is_the_point_that_stands_still(twist, center, instant):
    axes = picture_of(twist, center)
    point = line_named(axes, 'instantaneous centre of rotation').get_xydata()[0]
    np.testing.assert_allclose(point, instant)
    # No module there would move.
    there = SwerveKinematics([point, point + 1.0]).inverse(twist, center)
    assert abs(there.speed[0]) < 1e-9


def test_a_straight_way_has_no_instantaneous_centre():
    with pytest.raises(StopIteration):
        line_named(picture_of((1.0, 0.5, 0.0)), 'instantaneous centre of rotation')


@pytest.mark.parametrize('twist, center', [((0.0, 0.0, 0.5), (-50.0, 20.0)),
                                           ((1.0, 0.0, 0.01), (0.0, 0.0))])
def test_a_far_centre_stands_at_the_rim_with_its_distance_and_the_base_keeps_its_size(
        twist, center):
    axes, near = picture_of(twist, center), picture_of((1.0, 0.0, 0.0))
    assert axes.get_xlim() == near.get_xlim() and axes.get_ylim() == near.get_ylim()
    far = np.add(center, np.multiply((-twist[1], twist[0]), 1.0 / twist[2]))
    x, y = line_named(axes, 'instantaneous centre of rotation').get_xydata()[0]
    assert max(abs(x), abs(y)) < axes.get_xlim()[1]
    assert np.arctan2(y, x) == pytest.approx(np.arctan2(far[1], far[0]))
    assert f'{np.hypot(*far):.1f} m' in {text.get_text() for text in axes.texts}


def test_the_scale_is_as_long_as_an_arrow_of_its_speed():
    axes = picture_of((1.0, 0.0, 0.0))
    (x0, y0), (x1, y1) = line_named(axes, 'scale').get_xydata()
    speed = next(float(text.get_text().split()[0]) for text in axes.texts
                 if text.get_text().endswith(' m/s') and '@' not in text.get_text())
    assert y0 == y1 and x1 - x0 == pytest.approx(SCALE * speed)
    assert axes.get_xlim()[0] < x0 and axes.get_ylim()[0] < y0


@pytest.mark.parametrize('most, expected', [
    (0.3, 0.2), (0.99, 0.5), (1.0, 1.0), (4.9, 2.0), (70.0, 50.0), (99.99999999999999, 50.0)])
def test_the_scale_is_a_round_number(most, expected):
    assert round_speed(most) == pytest.approx(expected)


def test_a_twist_in_the_field_is_turned_into_the_base():
    drawn = arrows(picture_of((1.0, 0.0, 0.0), heading=0.5 * np.pi))
    # The field's x is to the right of a base that looks to the field's left.
    np.testing.assert_allclose(drawn['translation'][1], np.tile((0.0, -SCALE), (4, 1)),
                               atol=1e-12)


def test_a_speed_limit_shows_what_it_takes_away():
    free, limited = picture_of((1.0, 0.0, 2.0)), picture_of((1.0, 0.0, 2.0), max_speed=0.8)
    assert 'slowed' not in free.get_title() and 'without the speed limit' not in arrows(free)
    share = 0.8 / 1.615549  # hypot(1 + 2 * 0.25, 2 * 0.3) of the modules on the right
    assert f'slowed to {100.0 * share:.0f} %' in limited.get_title()
    drawn = arrows(limited)
    commanded = np.concatenate([drawn[label][1] for label in drawn if 'commanded' in label])
    assert np.hypot(*commanded.T).max() == pytest.approx(0.8 * SCALE)
    for label in ('translation', 'rotation'):
        np.testing.assert_allclose(drawn[label][1], share * arrows(free)[label][1], rtol=1e-5)
    assert np.hypot(*drawn['without the speed limit'][1].T).max() == pytest.approx(
        1.615549 * SCALE, rel=1e-5)


@pytest.mark.parametrize('value, digits, text', [
    (-0.0, 2, '0.00'), (-0.004, 2, '0.00'), (-0.006, 2, '-0.01'), (-0.3, 0, '0'),
    (-180.0, 0, '-180')])
def test_no_number_is_minus_zero(value, digits, text):
    assert plain(value, digits) == text


def test_a_base_at_rest_has_no_arrows():
    assert not any(isinstance(artist, PolyCollection)
                   for artist in picture_of((0.0, 0.0, 0.0)).collections)


@pytest.mark.parametrize('arguments, color, direction', [
    (['--vx', '1'], COMMANDED, (1.0, 0.0)), (['--vy', '-1'], COMMANDED, (0.0, -1.0)),
    (['--vx', '1', '--vy', '1'], COMMANDED, (1.0, 1.0))])
def test_the_saved_picture_has_the_ink_in_the_right_places(
        tmp_path, arguments, color, direction):
    path = tmp_path / 'picture.png'
    assert main([*arguments, '--save', str(path)]) == 0
    pixels = ink(path, color)
    # Four arrows and the legend's patch below: each is one heap of pixels.
    legend = pixels[:, 1] < 0.1 * imread(path).shape[0]
    pixels = pixels[~legend]
    middle = pixels.mean(axis=0)
    for side_x in (1, -1):
        for side_y in (1, -1):
            heap = pixels[(np.sign(pixels - middle) == (side_x, side_y)).all(axis=-1)]
            offsets = heap - heap.mean(axis=0)
            along = np.linalg.svd(offsets, full_matrices=False)[2][0]
            assert abs(along @ direction) / np.hypot(*direction) > 0.995
            # The head is broader than the shaft: it has more ink, at the end it points to.
            ahead = offsets @ direction
            middle_of_arrow = 0.5 * (ahead.min() + ahead.max())
            assert np.median(ahead) > middle_of_arrow
            assert np.ptp(ahead) > 0.1 * imread(path).shape[1]


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('arguments', [
    ['--vx', '1e6', '--omega', '-1e6'], ['--vx', '1e-320'], ['--vx', '1', '--max-speed', '1e-6'],
    ['--omega', '1e6', '--center', '1e6', '-1e6']])
def test_numbers_of_any_size_that_is_taken_are_drawn(tmp_path, arguments):
    path = tmp_path / 'picture.png'
    assert main([*arguments, '--save', str(path)]) == 0
    assert len(ink(path, CENTER)) > 100


@pytest.mark.parametrize('modules', [
    ['0.4,0.3', '0.4,-0.3', '-0.3,0.3', '-0.3,-0.3'], ['0.2,0', '-0.1,0.2', '-0.1,-0.2'],
    ['0.9,0.3', '0.9,-0.3', '0,0.3', '0,-0.3', '-0.9,0.3', '-0.9,-0.3']], ids=len)
def test_nothing_is_cut_off_at_the_edges_of_the_saved_picture(tmp_path, modules):
    path = tmp_path / 'picture.png'
    assert main(['--vx', '1', '--modules', *modules, '--save', str(path)]) == 0
    pixels = imread(path)[:, :, :3]
    for edge in (pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]):
        assert (edge == 1.0).all()


def test_all_colours_are_in_the_saved_picture(tmp_path):
    path = tmp_path / 'picture.png'
    assert main(['--vx', '0.2', '--omega', '2', '--max-speed', '0.5', '--save', str(path)]) == 0
    for color in (COMMANDED, REVERSED, UNLIMITED, TRANSLATION, ROTATION, CENTER, INSTANT):
        assert len(ink(path, color)) > 100, color


@pytest.mark.parametrize('arguments, part', [(['--vx', '1'], TRANSLATION),
                                             (['--omega', '-2'], ROTATION)])
def test_a_part_that_is_the_whole_is_seen_and_so_is_the_whole(tmp_path, arguments, part):
    path = tmp_path / 'picture.png'
    assert main([*arguments, '--save', str(path)]) == 0
    legend = 0.1 * imread(path).shape[0]
    for color in (COMMANDED, part):
        assert (ink(path, color)[:, 1] > legend).sum() > 200, color


def test_modules_may_be_anywhere(tmp_path):
    path = tmp_path / 'picture.png'
    base = visualize.parse(['--modules', '0.4,0', '-0.2,0.3', '-.2,-0.3', '--save', 'x']).modules
    assert base == [(0.4, 0.0), (-0.2, 0.3), (-0.2, -0.3)]
    assert main(['--modules', '0.4,0', '-0.2,0.3', '-.2,-0.3', '--vx', '-1', '--center', '-0.5',
                 '-1', '--save', str(path)]) == 0
    assert path.read_bytes().startswith(b'\x89PNG\r\n')


def test_the_base_may_come_from_a_parameter_file(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text('/**:\n  ros__parameters:\n    module_names: [bow, port, starboard]\n'
                    '    module_x: [0.5, 0.0, 0.0]\n    module_y: [0.0, 0.4, -0.4]\n'
                    '    idle_mode: lock\n')
    base = visualize.base_from_parameters(path)
    assert base.names == ('bow', 'port', 'starboard')
    np.testing.assert_array_equal(base.positions, [(0.5, 0.0), (0.0, 0.4), (0.0, -0.4)])


@pytest.mark.parametrize('arguments, complaint', [
    (['--params', 'no-such-file.yaml'], 'no-such-file.yaml'),
    (['--modules', '0.4,0', '0.4,0', '--save', 'x.png'], 'all at one point'),
    (['--modules', '400,0', '-400,0', '--save', 'x.png'], 'more than 20 m: millimetres?'),
    (['--save', 'no-such-folder/x.png'], 'cannot be written'),
    ([], 'no display')])
def test_what_cannot_be_drawn_is_said_in_one_line(capsys, monkeypatch, arguments, complaint):
    monkeypatch.setenv('MPLBACKEND', 'agg')
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert error.startswith('swerve_visualize: ') and error.count('\n') == 1
    assert complaint in error


@pytest.mark.parametrize('text, complaint', [
    ('/**:\n  ros__parameters:\n    module_x: [0.5]\n',
     "parameter 'module_x' = [0.5]: must have 4 entries"),
    ('/**: [', 'robot.yaml, line 1: not YAML')])
def test_what_is_wrong_with_a_parameter_file_is_said_in_one_line(
        tmp_path, capsys, text, complaint):
    path = tmp_path / 'robot.yaml'
    path.write_text(text)
    assert main(['--params', str(path), '--save', str(tmp_path / 'x.png')]) == 1
    error = capsys.readouterr().err
    assert complaint in error and error.count('\n') == 1


@pytest.mark.parametrize('arguments', [
    ['--vx', 'nan'], ['--vx', 'fast'], ['--modules', '0.4'], ['--modules', '0,0,0'],
    ['--center', '0', 'inf'], ['--max-speed', '0'], ['--vx', '1e308'], ['--max-speed', '1e-320'],
    ['--modules', '1,0', '0,0', '--params', 'x.yaml']])
def test_the_command_line_refuses_what_is_no_number(capsys, arguments):
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    assert 'usage: swerve_visualize' in capsys.readouterr().err


def test_what_stands_holds_its_angle():
    motion = motion_of(SwerveKinematics([(1.0, 0.0), (-1.0, 0.0)]), Command((0.0, 1.0, 1.0)),
                       np.array([0.1, 0.2]))
    np.testing.assert_allclose(motion.states.speed, [2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(motion.states.angle, [0.5 * np.pi, 0.2])
