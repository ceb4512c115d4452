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

"""The documentation is true: its examples run, and it names what is there."""

import ast
import doctest
from pathlib import Path
import re

import numpy as np
import pytest
import swerve_kinematics
from swerve_kinematics.core.checking.wording import CHANGES, JOINTS

ROOT = Path(__file__).resolve().parent.parent
PAGES = [page for page in [ROOT / 'README.md', *sorted((ROOT / 'docs').glob('*.md'))]
         if page.exists() and '>>>' in page.read_text()]


def examples_of(page):
    """Return a page's examples as one doctest, so that later ones may use earlier names."""
    text = re.sub(r'^```.*$', '', page.read_text(), flags=re.MULTILINE)  # not an expected output
    return doctest.DocTestParser().get_doctest(text, {}, page.name, str(page), 0)


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_examples(page):
    runner = doctest.DocTestRunner(verbose=False)
    with np.printoptions():  # restores what the examples set
        results = runner.run(examples_of(page))
    assert results.failed == 0
    assert results.attempted > 0


def test_the_library_page_has_its_ten_examples():
    page = ROOT / 'docs' / 'library.md'
    assert page in PAGES
    assert len(re.findall(r'^## \d+\. ', page.read_text(), flags=re.MULTILINE)) == 10


def test_every_file_that_the_page_on_architecture_names_is_there():
    named = re.findall(r'`((?:core|configuration|ros|sim|tools)/\w[\w/.]*)`',
                       (ROOT / 'docs' / 'architecture.md').read_text())
    assert len(named) > 30
    assert [name for name in named if not (ROOT / 'swerve_kinematics' / name).exists()] == []


def test_the_page_on_architecture_has_every_subpackage():
    package = ROOT / 'swerve_kinematics'
    rooms = {path.relative_to(package).as_posix() for path in (*package.iterdir(),
             *(package / 'core').iterdir()) if not path.name.startswith('_')}
    described = re.findall(r'^\| `([\w/.]+)` \|', (ROOT / 'docs/architecture.md').read_text(),
                           flags=re.MULTILINE)
    assert set(described) == rooms - {'core', 'programs.py', 'py.typed'}


def test_the_api_reference_has_every_public_name_once():
    described = re.findall(r'^\.\. auto(?:class|function):: swerve_kinematics\.(\w+)$', '\n'.join(
        page.read_text() for page in (ROOT / 'docs' / 'api').glob('*.rst')), flags=re.MULTILINE)
    assert sorted(described) == swerve_kinematics.__all__


def test_the_page_on_diagnostics_has_every_finding_about_wiring():
    page = (ROOT / 'docs' / 'diagnostics.md').read_text()
    wrong = [words for words, _ in (*CHANGES.values(), *JOINTS.values())]
    assert [words for words in wrong if words not in page] == []


def words_of_findings(tree):
    """Yield the words by which code says what is wrong: it yields them, or gives them a level."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Yield) or isinstance(node, ast.Tuple) and ast.unparse(
                node).startswith(('(WARN, ', '(ERROR, ')):
            yield from (part.value.strip(' :,') for part in ast.walk(node)
                        if isinstance(part, ast.Constant) and isinstance(part.value, str))


def test_the_page_on_diagnostics_has_every_finding_of_the_node():
    page = (ROOT / 'docs' / 'diagnostics.md').read_text()
    found = {words for path in (ROOT / 'swerve_kinematics' / 'ros').glob('*.py')
             for words in words_of_findings(ast.parse(path.read_text()))
             if len(words.split()) > 2}
    assert len(found) > 10
    assert [words for words in found if words not in page] == []
