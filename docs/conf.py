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

"""How Sphinx builds the pages and the API reference: `make docs`."""

from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from swerve_kinematics import __version__  # noqa: E402, I100

project = 'swerve_kinematics'
copyright = 'the swerve_kinematics authors'  # noqa: A001
release = __version__

extensions = ['myst_parser', 'numpydoc', 'sphinx.ext.autodoc', 'sphinx.ext.autosummary']
source_suffix = {'.md': 'markdown', '.rst': 'restructuredtext'}
html_theme = 'alabaster'
html_theme_options = {'description': 'Swerve drive for ROS 2', 'page_width': '1080px'}

# Links within a page and to a heading of another page, as GitHub makes them.
myst_heading_anchors = 3

# Docstrings: a word in single backticks is code. Types, shapes and units stand in the sections of
# numpydoc; the annotations in the signatures would only repeat them.
default_role = 'code'
autodoc_typehints = 'none'
autodoc_member_order = 'bysource'
autodoc_preserve_defaults = True
autosummary_generate = False
numpydoc_show_class_members = False


def is_field(app, what, name, member, skip, options):
    """Leave out the fields of named tuples: the class describes them under Attributes."""
    return skip or type(member).__name__ == '_tuplegetter'


def setup(app):
    """Connect the above."""
    app.connect('autodoc-skip-member', is_field)
