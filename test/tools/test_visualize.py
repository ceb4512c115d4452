"""swerve_visualize: the picture is read back, as data and as pixels."""

import builtins

from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.quiver import Quiver
import numpy as np
import pytest
from swerve_kinematics import SwerveKinematics
from swerve_kinematics.configuration.layout import LAYOUT_DECLARATIONS
from swerve_kinematics.tools.visualize import main as visualize
from swerve_kinematics.tools.visualize import picture as module_picture
from swerve_kinematics.tools.visualize.main import FOUR_MODULES, main
from swerve_kinematics.tools.visualize.picture import (
    ASKED, asked_states, draw, REVERSED, ROTATION, TRANSLATION)
from swerve_kinematics.tools.visualize.window import MAX_SPEED, Window

POSITIONS = FOUR_MODULES.positions
SCALE = 0.2  # s
AHEAD = np.zeros(4)


def picture_of(twist, center=(0.0, 0.0), angles=AHEAD):
    """Return axes with the picture of the four-module base."""
    axes = Figure(figsize=(8.0, 8.0)).subplots()
    states = asked_states(FOUR_MODULES.kinematics, twist, center, angles)
    draw(axes, FOUR_MODULES, twist, center, states, SCALE)
    return axes


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
    shown = {tuple(start): vector for label in ('asked', 'asked, drive reversed')
             if label in drawn for start, vector in zip(*drawn[label])}
    np.testing.assert_allclose([shown[tuple(position)] for position in POSITIONS],
                               SCALE * (translation + rotation), atol=1e-12)


def test_modules_more_than_90_degrees_away_are_dashed_and_red():
    axes = picture_of((0.2, 0.0, 2.0))
    reversed_ = next(collection for collection in axes.collections
                     if collection.get_label() == 'asked, drive reversed')
    # A turn to the left: the modules on the left go backwards.
    np.testing.assert_allclose(reversed_.get_offsets(), [(0.3, 0.25), (-0.3, 0.25)])
    np.testing.assert_allclose(reversed_.get_edgecolor()[0, :3], to_rgb(REVERSED))
    assert reversed_.get_linestyle()[0][1]
    assert (reversed_.U < 0.0).all()
    asked = next(collection for collection in axes.collections
                 if collection.get_label() == 'asked')
    assert not asked.get_linestyle()[0][1]
    np.testing.assert_allclose(asked.get_facecolor()[0, :3], to_rgb(ASKED))


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
    legend = {text.get_text() for text in axes.get_legend().get_texts()}
    assert legend == {'translation', 'rotation', 'asked', 'centre of rotation'}
    dot = next(line for line in axes.lines if line.get_label() == 'centre of rotation')
    np.testing.assert_array_equal(dot.get_xydata(), [(0.2, 0.1)])


def test_a_base_at_rest_has_no_arrows():
    assert not any(isinstance(artist, PolyCollection)
                   for artist in picture_of((0.0, 0.0, 0.0)).collections)


@pytest.mark.parametrize('arguments, color, direction', [
    (['--vx', '1'], ASKED, (1.0, 0.0)), (['--vy', '-1'], ASKED, (0.0, -1.0)),
    (['--vx', '1', '--vy', '1'], ASKED, (1.0, 1.0))])
def test_the_saved_picture_has_the_ink_in_the_right_places(
        tmp_path, arguments, color, direction):
    path = tmp_path / 'picture.png'
    assert main([*arguments, '--save', str(path)]) == 0
    pixels = ink(path, color)
    # Four arrows and the legend's patch below: each is one heap of pixels.
    legend = pixels[:, 1] < 0.08 * imread(path).shape[0]
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


def test_all_colours_are_in_the_saved_picture(tmp_path):
    path = tmp_path / 'picture.png'
    assert main(['--vx', '0.2', '--omega', '2', '--save', str(path)]) == 0
    for color in (ASKED, REVERSED, TRANSLATION, ROTATION, module_picture.CENTER):
        assert len(ink(path, color)) > 100, color


def test_sliders_move_the_arrows_and_modules_stay_where_they_were_turned_to():
    window = Window(Figure(figsize=(8.0, 9.5)), FOUR_MODULES, (0.0, 0.0, 0.0), (0.0, 0.0))
    assert not arrows(window.axes)
    window.sliders['vx'].set_val(1.0)
    window.sliders['vy'].set_val(1.0)
    scale = module_picture.ARROW * FOUR_MODULES.radius / MAX_SPEED
    np.testing.assert_allclose(arrows(window.axes)['asked'][1], np.full((4, 2), scale))
    # By way of the diagonal the wheels have turned to +90 degrees: right is reversed then.
    window.sliders['vx'].set_val(0.0)
    window.sliders['vy'].set_val(-1.0)
    assert list(arrows(window.axes)) == ['translation', 'asked, drive reversed']
    window.sliders['omega'].set_val(1.0)
    window.sliders['centre x'].set_val(0.3)
    window.sliders['centre y'].set_val(0.25)
    starts, vectors = arrows(window.axes)['rotation']
    assert len(starts) == 3  # the front left module stands at the centre
    np.testing.assert_allclose(
        vectors, scale * np.stack((0.25 - starts[:, 1], starts[:, 0] - 0.3), axis=-1))


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
    (['--save', 'no-such-folder/x.png'], 'cannot be written'),
    ([], 'no display')])
def test_what_cannot_be_drawn_is_said_in_one_line(capsys, monkeypatch, arguments, complaint):
    monkeypatch.setenv('MPLBACKEND', 'agg')
    assert main(arguments) == 1
    error = capsys.readouterr().err
    assert error.startswith('swerve_visualize: ') and error.count('\n') == 1
    assert complaint in error


def test_without_a_file_the_base_is_that_of_the_nodes_defaults():
    defaults = {declaration.name: declaration.default for declaration in LAYOUT_DECLARATIONS}
    assert list(FOUR_MODULES.names) == defaults['module_names']
    np.testing.assert_array_equal(
        POSITIONS, np.column_stack((defaults['module_x'], defaults['module_y'])))


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
    ['--center', '0', 'inf'], ['--modules', '1,0', '0,0', '--params', 'x.yaml']])
def test_the_command_line_refuses_what_is_no_number(capsys, arguments):
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    assert 'usage: swerve_visualize' in capsys.readouterr().err


def test_without_matplotlib_there_is_one_clear_line(capsys, monkeypatch):
    real = builtins.__import__

    def without_matplotlib(name, *arguments):
        if name.partition('.')[0] == 'matplotlib':
            raise ImportError(name)
        return real(name, *arguments)
    monkeypatch.setattr(builtins, '__import__', without_matplotlib)
    assert main(['--save', 'x.png']) == 1
    assert capsys.readouterr().err == (
        'swerve_visualize: matplotlib is not installed (python3-matplotlib)\n')


def test_asked_states_hold_the_angle_of_what_stands():
    states = asked_states(SwerveKinematics([(1.0, 0.0), (-1.0, 0.0)]), (0.0, 1.0, 1.0),
                          (0.0, 0.0), np.array([0.1, 0.2]))
    np.testing.assert_allclose(states.speed, [2.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(states.angle, [0.5 * np.pi, 0.2])
