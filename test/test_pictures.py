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

"""The pictures of the pages are there, small, and drawn by scripts that run."""

from pathlib import Path
import re
import runpy

import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / 'docs'
PAGES = [ROOT / 'README.md', *sorted(DOCS.glob('*.md'))]
NAMES = runpy.run_path(str(DOCS / 'pictures.py'))['NAMES']


def test_every_picture_is_shown_small_and_drawn_by_its_script():
    shown = {(page.parent / name).resolve() for page in PAGES
             for name in re.findall(r'!\[[^]]+\]\(([^)]+)\)', page.read_text())}
    assert shown == set(DOCS.rglob('*.png')) == {DOCS / f'{name}.png' for name in NAMES}
    assert [path.name for path in shown if path.stat().st_size > 120_000] == []


# The demos take half a minute, and have tests of their own.
@pytest.mark.parametrize('name', sorted(set(NAMES) - {'demo', 'demo_physics'}))
def test_its_script_draws_it(name, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(DOCS)
    runpy.run_path(str(DOCS / f'{name}.py'))['main'](tmp_path / 'picture.png')
    assert (tmp_path / 'picture.png').read_bytes().startswith(b'\x89PNG')


def test_the_picture_of_the_architecture_names_files_that_are_there(monkeypatch):
    monkeypatch.syspath_prepend(DOCS)
    drawn = runpy.run_path(str(DOCS / 'architecture.py'))
    for folder, files, _ in drawn['COMMAND'] + drawn['MEASUREMENT']:
        for file in files.replace('_\n', '_').replace('\n', ' ').split(', '):
            assert [*(ROOT / 'swerve_kinematics' / folder).rglob(f'{file}.py')], file
