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
