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

"""The picture of a check: each module's expected against measured motion."""

from pathlib import Path

from swerve_kinematics.configuration.node import NodeParameters
from swerve_kinematics.core.checking.drive_data import DriveData
from swerve_kinematics.core.checking.motion import motions
from swerve_kinematics.core.checking.verdict import Verdict

MEASURED, EXPECTED = '#f0a3a3', '#16a34a'


def save(path: Path, parameters: NodeParameters, data: DriveData, verdict: Verdict) -> None:
    """
    Draw the velocities of all modules into a file.

    Parameters
    ----------
    path : pathlib.Path
        Of a kind that matplotlib knows.
    parameters : NodeParameters
        The description that was checked.
    data : DriveData
        The drive.
    verdict : Verdict
        What was found in it.

    Raises
    ------
    ModuleNotFoundError
        If matplotlib is not installed.

    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    layout = parameters.layout
    seen = motions(layout.kinematics.module_positions, data, verdict)
    count = len(layout.module_names)
    figure = Figure(figsize=(10.0, 1.7 * count + 0.6), layout='constrained')
    FigureCanvasAgg(figure)
    axes = figure.subplots(count, 2, sharex=True, sharey=True, squeeze=False)
    for module, name in enumerate(layout.module_names):
        for plot, part, axis in zip(axes[module], ('real', 'imag'), 'xy'):
            plot.plot(seen.time, getattr(seen.measured[:, module], part), color=MEASURED,
                      linewidth=4.0, label='by its joints')
            plot.plot(seen.time, getattr(seen.expected[:, module], part), color=EXPECTED,
                      linewidth=1.3, label='by the motion of the base')
            plot.set_ylabel(f'{name}\nv{axis} [m/s]', fontsize=8)
            plot.grid(alpha=0.3)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc='outside upper center', ncols=2,
                  frameon=False)
    for plot in axes[-1]:
        plot.set_xlabel('time [s]')
    figure.savefig(path, dpi=110)
