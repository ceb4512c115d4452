"""The pages that people read say what the code says."""

from pathlib import Path
import re
from typing import Any

from swerve_kinematics.configuration.declarations import ListOf
from swerve_kinematics.configuration.layout import LAYOUT_DECLARATIONS
from swerve_kinematics.configuration.node import NODE_DECLARATIONS
from swerve_kinematics.configuration.simulator import SIMULATOR_DECLARATIONS
import yaml

PARAMETERS = (Path(__file__).parents[1] / 'docs' / 'parameters.md').read_text()


def row(declaration):
    """Return the row of a parameter in a table of the page."""
    default = declaration.default
    if isinstance(default, ListOf):
        default = '[]'
    elif isinstance(default, list):
        default = '[' + ', '.join(str(entry) for entry in default) + ']'
    elif isinstance(default, bool):
        default = str(default).lower()
    elif isinstance(default, float):
        default = f'{default:g}' if default % 1 else f'{default:.1f}'
    name = f'`{declaration.name}`' + (' *' if declaration.changeable else '')
    return f'| {name} | {default} | {declaration.unit} | {declaration.description} |'


def table_after(heading):
    """Return the rows of the first table after a heading."""
    lines = PARAMETERS.split(heading, 1)[1].splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith('|---')) + 1
    return [line for line in lines[start:] if line.startswith('|')][:_length(lines[start:])]


def _length(lines):
    """Return how many lines a table at the start of `lines` has."""
    return next((i for i, line in enumerate(lines) if not line.startswith('|')), len(lines))


def test_the_table_of_swerve_nodes_parameters_is_that_of_the_code():
    assert table_after('## swerve_node') == [row(d) for d in NODE_DECLARATIONS]


def test_the_table_of_swerve_sims_parameters_is_that_of_the_code():
    own = SIMULATOR_DECLARATIONS[len(LAYOUT_DECLARATIONS):]
    assert table_after('## swerve_sim') == [row(d) for d in own]


def nav2_parameters() -> dict[str, dict[str, Any]]:
    """Return the parameters of Nav2's nodes in the page about real robots."""
    page = (Path(__file__).parents[1] / 'docs' / 'your_robot.md').read_text()
    snippet, = (block for block in re.findall(r'```yaml\n(.*?)```', page, re.DOTALL)
                if 'velocity_smoother' in block)
    return {node: block['ros__parameters'] for node, block in yaml.safe_load(snippet).items()}


def test_nav2_as_shown_lets_the_base_move_along_every_axis():
    smoother = nav2_parameters()['velocity_smoother']
    # Nav2 refuses limits that are not three, or of the wrong sign, and an entry of 0 keeps
    # that axis at rest.
    assert all(len(limit) == 3 for limit in smoother.values())
    assert min(smoother['max_velocity'] + smoother['max_accel']) > 0.0
    assert max(smoother['min_velocity'] + smoother['max_decel']) < 0.0
    controller = nav2_parameters()['controller_server']
    assert all(controller[f'min_{axis}_velocity_threshold'] <= 0.01
               for axis in ('x', 'y', 'theta'))
    assert controller['FollowPath']['vy_max'] > 0.0
