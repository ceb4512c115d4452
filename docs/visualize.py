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

"""Draw what `swerve_visualize --save` draws of a base that translates while it turns."""

from pathlib import Path

from pictures import shrink

from swerve_kinematics.tools.visualize.main import main as visualize

PICTURE = Path(__file__).with_name('visualize.png')


def main(path: Path = PICTURE) -> None:
    """Draw the picture of the example on the page."""
    visualize(['--vx', '1', '--vy', '0.4', '--omega', '2', '--max-speed', '1.5',
               '--save', str(path)])
    shrink(path)


if __name__ == '__main__':
    main()
