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

"""The parts of the demo that need no ROS: the path, the error, the picture, the processes."""

from io import StringIO
import re
import signal
import subprocess
import sys

from matplotlib.figure import Figure
from matplotlib.image import imread
import numpy as np
import pytest

from swerve_kinematics import se2_compose, se2_exp
from swerve_kinematics.configuration.answers import in_words
from swerve_kinematics.ros.signals import ENDING_SIGNALS
from swerve_kinematics.tools.demo import picture
from swerve_kinematics.tools.demo.drive_record import (
    DriveRecord, error_ratio, matched, path_length, position_errors, summary)
from swerve_kinematics.tools.demo.figure_eight import FigureEight, follow, plan
from swerve_kinematics.tools.demo.imperfections import IMPERFECTIONS
from swerve_kinematics.tools.demo.main import parse
from swerve_kinematics.tools.demo.progress import Progress
from swerve_kinematics.tools.processes import ProcessDied, running

FIGURE = FigureEight(length=6.0, width=3.0, turns=2, duration=24.0, ramp=2.0)
MODULES = np.array([(0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25)])


def record_of(odometry_offset=(0.0, 0.0, 0.0)):
    """Return a drive of the figure whose odometry is off by a constant."""
    time = np.linspace(0.0, FIGURE.duration, 2401)
    truth, _ = plan(FIGURE, time)
    return DriveRecord(time, truth + odometry_offset, truth, np.zeros((len(time), 4)))


def test_the_figure_is_closed_and_has_its_size():
    time = np.linspace(0.0, FIGURE.duration, 24001)
    pose, _ = plan(FIGURE, time)
    np.testing.assert_allclose(pose[0], [0.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(pose[-1], [0.0, 0.0, 4.0 * np.pi], atol=1e-9)
    np.testing.assert_allclose(np.abs(pose[:, :2]).max(axis=0), [3.0, 1.5], atol=1e-4)


def test_the_figure_crosses_itself_in_the_middle_between_two_lobes():
    pose, _ = plan(FIGURE, 0.5 * FIGURE.duration)
    np.testing.assert_allclose(pose[:2], 0.0, atol=1e-9)
    quarter, _ = plan(FIGURE, np.array([0.25, 0.75]) * FIGURE.duration)
    assert quarter[0, 0] > 2.5 and quarter[1, 0] < -2.5


def test_the_velocity_is_the_slope_of_the_path_and_rests_at_both_ends():
    time = np.linspace(0.0, FIGURE.duration, 24001)
    pose, velocity = plan(FIGURE, time)
    slope = np.gradient(pose, time, axis=0)
    np.testing.assert_allclose(velocity[1:-1], slope[1:-1], atol=1e-5)
    np.testing.assert_allclose(velocity[[0, -1]], 0.0, atol=1e-9)
    np.testing.assert_array_equal(plan(FIGURE, np.array([-1.0, 30.0]))[1], 0.0)


def test_the_figure_stays_within_what_a_small_base_can_do():
    time = np.linspace(0.0, FIGURE.duration, 24001)
    _, velocity = plan(FIGURE, time)
    acceleration = np.gradient(velocity, time, axis=0)
    assert np.hypot(*velocity[:, :2].T).max() < 1.5
    assert np.hypot(*acceleration[:, :2].T).max() < 2.0
    assert np.abs(velocity[:, 2]).max() < 1.0


def test_follow_turns_the_plan_into_the_frame_of_the_base():
    twist = follow(np.array([1.0, 2.0, 0.5 * np.pi]), np.array([0.0, 1.0, 0.3]),
                   np.array([1.0, 2.0, 0.5 * np.pi]), gain=1.0)
    np.testing.assert_allclose(twist, [1.0, 0.0, 0.3], atol=1e-12)


def test_follow_brings_a_base_beside_the_path_back_to_it():
    pose, dt = np.array([0.2, -0.3, 0.4]), 0.02
    for k in range(1200):
        pose = se2_compose(pose, se2_exp(dt * follow(*plan(FIGURE, k * dt), pose, gain=1.0)))
    np.testing.assert_allclose(pose, [0.0, 0.0, 4.0 * np.pi], atol=0.02)


def test_only_samples_with_a_common_stamp_are_compared():
    record = matched({10: [1.0, 0.0, 0.0], 20: [2.0, 0.0, 0.0], 30: [3.0, 0.0, 0.0]},
                     {30: [3.5, 0.0, 0.0], 20: [2.5, 0.0, 0.0], 40: [9.0, 0.0, 0.0]},
                     {10: [0.1], 20: [0.2], 30: [0.3]})
    np.testing.assert_array_equal(record.odometry[:, 0], [2.0, 3.0])
    np.testing.assert_array_equal(record.truth[:, 0], [2.5, 3.5])
    np.testing.assert_array_equal(record.module_direction, [[0.2], [0.3]])
    np.testing.assert_allclose(record.time, [0.0, 1e-8])


def test_streams_without_a_common_stamp_are_refused():
    with pytest.raises(ValueError, match='no stamp in common'):
        matched({1: [0.0] * 3}, {2: [0.0] * 3}, {1: [0.0]})


def test_the_error_is_the_greatest_distance_over_the_length_of_the_true_path():
    truth = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 9.0, 0.0]])
    odometry = truth + [[0.0, 0.0, 0.1], [0.03, 0.04, 0.0], [0.01, 0.0, 0.0]]
    record = DriveRecord(np.arange(3.0), odometry, truth, np.zeros((3, 4)))
    np.testing.assert_allclose(position_errors(record), [0.0, 0.05, 0.01])
    assert path_length(record) == pytest.approx(10.0)
    assert error_ratio(record) == pytest.approx(0.005)
    assert summary(record) == (
        'largest odometry error: 50.0 mm over 10.0 m (0.50 %)')


def test_a_base_that_did_not_move_has_no_good_error():
    still = np.zeros((3, 3))
    assert error_ratio(DriveRecord(np.arange(3.0), still, still, np.zeros((3, 4)))) == np.inf


def test_the_base_is_drawn_at_even_distances_however_fast_it_went():
    x = np.concatenate((np.zeros(50), np.linspace(0.0, 1.0, 11), np.linspace(1.0, 4.0, 301)))
    indices = picture.spaced_indices(np.column_stack((x, np.zeros_like(x))), 4)
    np.testing.assert_allclose(x[indices], [0.5, 1.5, 2.5, 3.5], atol=0.1)


def test_modules_are_placed_and_turned_with_the_base():
    pose = np.array([[1.0, 2.0, 0.5 * np.pi]])
    modules = picture.module_poses(pose, MODULES, np.array([[0.0, 0.1, 0.2, 0.3]]))
    np.testing.assert_allclose(modules[0, 0], [0.75, 2.3, 0.5 * np.pi])
    np.testing.assert_allclose(modules[0, :, 2], 0.5 * np.pi + np.array([0.0, 0.1, 0.2, 0.3]))


def test_the_picture_shows_both_paths_and_every_module():
    axes = Figure().subplots()
    record = record_of((0.05, -0.02, 0.0))
    picture.draw_paths(axes, record, MODULES)
    lines = {line.get_label(): line.get_xydata() for line in axes.lines}
    np.testing.assert_array_equal(lines['ground truth'], record.truth[:, :2])
    np.testing.assert_array_equal(lines['odometry'], record.odometry[:, :2])
    drawn = {artist.get_label(): artist for artist in axes.collections}
    arrows, fronts = drawn['direction of each module'], drawn['front of the base']
    assert len(arrows.get_offsets()) == 4 * picture.BASE_COUNT
    assert len(fronts.get_paths()) == picture.BASE_COUNT
    assert axes.get_aspect() == 1.0


def test_the_front_is_marked_where_the_base_looks():
    tip, *sides = picture.front(np.array([1.0, 2.0, 0.5 * np.pi]), MODULES)
    np.testing.assert_allclose(tip, [1.0, 2.42])
    np.testing.assert_allclose(sides, [[0.88, 2.3], [1.12, 2.3]])


class Terminal(StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        """Say so."""
        return True


def shown(stream: StringIO) -> list[str]:
    """Return what a drive wrote after the legend, split where a line begins."""
    progress = Progress(stream)
    progress.show(24.0, np.array([-1.2, -0.5, -2.0]), np.array([-3.0, -2.0, 1.0]),
                  np.array([-3.1, -2.0, 1.0]))
    progress.finish()
    return re.split('[\r\n]+', stream.getvalue())[1:]


@pytest.mark.parametrize('columns', [40, 80])
def test_the_live_line_fits_the_terminal(monkeypatch, columns):
    monkeypatch.setenv('TERM', 'xterm')
    monkeypatch.setenv('COLUMNS', str(columns))
    text, end = shown(terminal := Terminal())
    assert len(text) == columns - 1 and end == ''
    assert '\r' in terminal.getvalue() and '\x1b' not in terminal.getvalue()


def test_what_is_imperfect_fits_the_terminal():
    assert all(len(line) < 80 for line in IMPERFECTIONS.splitlines())
    for fault in '4096 counts', 'bias of 0.5 deg/s', '2% of the samples lost':
        assert fault in IMPERFECTIONS


@pytest.mark.parametrize('stream, term', [(Terminal(), 'dumb'), (StringIO(), 'xterm')])
def test_where_no_line_can_be_written_over_there_are_lines(monkeypatch, stream, term):
    monkeypatch.setenv('TERM', term)
    assert shown(stream) == [
        '24.0 s: vx -1.20 vy -0.50 m/s omega -2.00 rad/s, x -3.00 y -2.00 m, off 100.0 mm', '']
    assert '\r' not in stream.getvalue()


@pytest.mark.parametrize('output', ['file', 'file/folder'])
def test_an_output_that_cannot_be_written_is_said_in_one_line(tmp_path, output):
    (tmp_path / 'file').touch()
    done = subprocess.run([sys.executable, '-m', 'swerve_kinematics.tools.demo.main', '--output',
                           tmp_path / output], capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith(f'swerve_demo: {tmp_path}/{output}: ')
    assert done.stderr.count('\n') == 1


def test_an_error_without_a_file_is_told_without_its_number():
    assert in_words(BrokenPipeError(32, 'Broken pipe')) == 'Broken pipe'


@pytest.mark.parametrize('domain', ['-1', '233'])
def test_a_domain_that_dds_does_not_have_is_refused(capsys, domain):
    with pytest.raises(SystemExit):
        parse(['--domain-id', domain])
    assert '--domain-id must be from 0 to 232' in capsys.readouterr().err


# What the demo does until a signal comes, in place of the drive.
SIGNALLED = """
import signal, sys
from swerve_kinematics.tools.demo import main, run
run.run_demo = lambda *_: signal.raise_signal(int(sys.argv[1]))
sys.exit(main.main(['--output', sys.argv[2]]))
"""


@pytest.mark.parametrize('number', ENDING_SIGNALS)
def test_a_signal_to_end_leaves_the_demo_the_time_to_end_its_nodes(tmp_path, number):
    done = subprocess.run([sys.executable, '-c', SIGNALLED, str(int(number)), tmp_path],
                          capture_output=True, text=True)
    assert done.returncode == 130
    assert done.stderr == 'swerve_demo: interrupted\n'


def test_a_process_ends_in_peace_where_its_shell_ignores_interrupts(tmp_path):
    heeded = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with running([('sleeper', 'timeit', ['import time; time.sleep(60)'])],
                     tmp_path) as (process,):
            process.check()
    finally:
        signal.signal(signal.SIGINT, heeded)
    with pytest.raises(ProcessDied, match=f'exit code -{int(signal.SIGTERM)}'):
        process.check()


def test_the_picture_is_written_as_a_png_with_ink_of_both_paths(tmp_path):
    path = tmp_path / 'drive.png'
    picture.draw(record_of((0.05, -0.02, 0.0)), MODULES, path)
    assert path.read_bytes().startswith(b'\x89PNG\r\n')
    pixels = imread(path)[..., :3]
    for color in (picture.TRUTH, picture.ODOMETRY, picture.ARROWS):
        rgb = np.array([int(color[i:i + 2], 16) for i in (1, 3, 5)]) / 255.0
        assert (np.abs(pixels - rgb).max(axis=-1) < 0.01).sum() > 500


def test_a_process_that_ends_early_is_named_with_its_last_words(tmp_path):
    with running([('base', 'json.tool', ['no-such-file.json'])], tmp_path) as (process,):
        with pytest.raises(ProcessDied, match='base ended with exit code [12]: .*no-such-file'):
            while True:
                process.check()


def test_processes_end_with_the_block_that_runs_them(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        with running([('sleeper', 'timeit', ['import time; time.sleep(60)'])],
                     tmp_path) as (process,):
            process.check()
            raise KeyboardInterrupt
    with pytest.raises(ProcessDied, match='sleeper ended'):
        process.check()
