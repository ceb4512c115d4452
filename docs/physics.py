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

"""Draw a base on tyres where the floor is slippery, beside one that only rolls."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
import numpy as np
from pictures import save

from swerve_kinematics import se2_compose, SwerveController
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.core.control.limits import ControllerLimits
from swerve_kinematics.core.drawing import outline
from swerve_kinematics.sim.actuators import Actuator
from swerve_kinematics.sim.base import BaseCommand, BaseConfig
from swerve_kinematics.sim.bodies import Body, RollingBody
from swerve_kinematics.sim.physics.base import PhysicsBase
from swerve_kinematics.sim.physics.model import Floor, Region
from swerve_kinematics.tools.visualize.main import FOUR_MODULES

PICTURE = Path(__file__).with_name('physics.png')
ROLLING, TYRES, WET = '#8a94a3', '#c8324a', '#d6e8f7'
PERIOD, RADIUS, DURATION = 0.02, 0.05, 5.0
SLIPPERY = Region(1.6, -0.7, 3.4, 1.0, 0.08)
CONFIG = BaseConfig(FOUR_MODULES.kinematics, ModuleJoints([RADIUS] * 4),
                    Actuator(0.05, 80.0, 400.0), Actuator(0.03, 8.0, 200.0))


def drive(body: Body) -> np.ndarray:
    """Return the poses (k, 3) of a body that is told to go ahead, and then round a bend."""
    controller = SwerveController(FOUR_MODULES.kinematics, ControllerLimits(
        max_linear_acceleration=2.0, max_angular_acceleration=6.0, max_steering_rate=8.0))
    poses = []
    for time in np.arange(0.0, DURATION, PERIOD):
        twist = (1.4, 0.0, 1.0 if 1.2 < time < 2.8 else 0.0) if time < 3.8 else (0.0, 0.0, 0.0)
        command = controller.update(twist, body.state.steering_angle, PERIOD)
        body.step(BaseCommand(command.speed / RADIUS, command.angle), PERIOD)
        poses.append(body.state.pose)
    return np.array(poses)


def draw(axes: Axes, label: str, poses: np.ndarray, color: str) -> None:
    """Draw a path, with the base along it."""
    axes.plot(*poses[:, :2].T, color=color, linewidth=2.0, label=label)
    corners = np.column_stack((outline(FOUR_MODULES.positions), np.zeros(4)))
    for pose in poses[25::35]:
        axes.fill(*se2_compose(pose, corners)[:, :2].T, facecolor='none', edgecolor=color,
                  linewidth=0.9)


def main(path: Path = PICTURE) -> None:
    """Draw both paths on one floor."""
    figure = Figure(figsize=(6.0, 5.8), layout='constrained')
    axes = figure.subplots()
    axes.add_patch(Rectangle(
        (SLIPPERY.x_min, SLIPPERY.y_min), SLIPPERY.x_max - SLIPPERY.x_min,
        SLIPPERY.y_max - SLIPPERY.y_min, color=WET, label=f'friction {SLIPPERY.friction}'))
    draw(axes, 'rolling', drive(RollingBody(CONFIG, (0.0, 0.0))), ROLLING)
    draw(axes, 'mujoco', drive(PhysicsBase(CONFIG, floor=Floor(regions=(SLIPPERY,)))), TYRES)
    axes.set(xlabel='x [m]', ylabel='y [m]')
    axes.set_aspect('equal')
    axes.grid(alpha=0.3)
    figure.legend(loc='outside upper center', ncols=3, frameon=False)
    save(figure, path)


if __name__ == '__main__':
    main()
