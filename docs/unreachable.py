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

"""Draw what `unreachable_policy: project` does: the twist commanded and the one executed."""

from pathlib import Path

from matplotlib.figure import Figure
import numpy as np
from pictures import save

from swerve_kinematics import SwerveController, SwerveKinematics

PICTURE = Path(__file__).with_name('unreachable.png')
CORNERS = ((0.3, 0.25), (0.3, -0.25), (-0.3, 0.25), (-0.3, -0.25))
RANGE, PERIOD = np.radians(60.0), 0.02
TWISTS = {'within reach': (0.6, 0.5, 0.0), 'out of reach: projected': (0.3, 1.0, 0.0),
          'one module out of reach': (0.9, 0.9, 1.2)}


def executed(twist):
    """Return the command that a base at rest comes to, its modules following at once."""
    kin = SwerveKinematics(CORNERS)
    controller = SwerveController(
        kin, steering_lower_limits=[-RANGE] * 4, steering_upper_limits=[RANGE] * 4)
    angles = np.zeros(4)
    for _ in range(50):
        command = controller.update(twist, angles, PERIOD)
        angles = command.angle
    return kin, command


def draw(axes, title, twist):
    """Draw the range of each module, what the twist needs (thin) and what it does (thick)."""
    kin, command = executed(twist)
    needed = kin.inverse(twist)
    for index, (x, y) in enumerate(CORNERS):
        for side in (0.0, np.pi):
            arc = np.linspace(side - RANGE, side + RANGE, 30)
            axes.fill(x + 0.12 * np.r_[0.0, np.cos(arc)], y + 0.12 * np.r_[0.0, np.sin(arc)],
                      color='#cfe3f5', zorder=0)
        for speed, angle, style in (
                (needed.speed[index], needed.angle[index], {'color': '#888888', 'width': 0.004}),
                (command.speed[index], command.angle[index],
                 {'color': '#c23b22' if command.unreachable[index] else '#1f77b4',
                  'width': 0.012})):
            axes.arrow(x, y, 0.2 * speed * np.cos(angle), 0.2 * speed * np.sin(angle),
                       length_includes_head=True, head_width=4.0 * style['width'], **style)
    vx, vy, omega = command.twist
    axes.set_title(f'{title}\ncommanded {twist}\nexecuted ({vx:.2f}, {vy:.2f}, {omega:.2f})',
                   fontsize=9)
    axes.set_aspect('equal')
    axes.set(xlim=(-0.6, 0.7), ylim=(-0.6, 0.7), xlabel='x [m]', ylabel='y [m]')


def main(path: Path = PICTURE) -> None:
    """Draw one picture for each twist, side by side."""
    figure = Figure(figsize=(11.0, 4.4), layout='constrained')
    for axes, (title, twist) in zip(figure.subplots(1, len(TWISTS)), TWISTS.items()):
        draw(axes, title, twist)
    save(figure, path)


if __name__ == '__main__':
    main()
