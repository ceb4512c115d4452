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

"""The pages that people read say what the code says."""

from pathlib import Path

import numpy as np

from swerve_kinematics.configuration.declarations import ListOf
from swerve_kinematics.configuration.layout import LAYOUT_DECLARATIONS
from swerve_kinematics.configuration.node import NODE_DECLARATIONS
from swerve_kinematics.configuration.simulator import SIMULATOR_DECLARATIONS

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
        # Never like 8e-05, which YAML takes for text: people copy from the table.
        default = np.format_float_positional(default, 6, fractional=False, trim='0')
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
