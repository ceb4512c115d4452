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
Measure the node against a node that does nothing, and the core against WPILib and numpy.

    python test/benchmarks/bench.py [nodes | core]

Prints one table and writes it, with every repetition, to bench-output/bench.json. Needs the
package with its `ros` and `test` extras, or the repository's root in PYTHONPATH. It takes about
three minutes on a machine that does nothing else: another busy process shows in every figure.
"""

import json
import os
from pathlib import Path
import sys

OUTPUT = Path('bench-output/bench.json')
# A graph of its own, on this machine only; rclpy reads it when it starts.
os.environ.update(ROS_DOMAIN_ID='83', ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST')


def main(which=('nodes', 'core')):
    """Run the benchmarks named, print the table, and write the file."""
    import core_cost
    import figures
    import node_cost
    programs = {'nodes': node_cost.figures, 'core': core_cost.figures}
    print(figures.HEADER)
    records = []
    for name in which:
        for figure in programs[name]():
            print(figure.row(), flush=True)
            records.append(figure.record())
    OUTPUT.parent.mkdir(exist_ok=True)
    OUTPUT.write_text(json.dumps(records, indent=1))
    print(f'written to {OUTPUT}')


if __name__ == '__main__':
    main(*[sys.argv[1:]] if sys.argv[1:] else [])
