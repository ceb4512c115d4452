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

"""Parameter files are read as ROS reads them, and what is wrong with one is told with its line."""

from hypothesis import given, strategies as st
import pytest
from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.parameter_file import (
    given_to, is_for, read_argument, read_file)


def values(tmp_path, text, node='/swerve_node', arguments=()):
    """Return the values that a file, and arguments, give to a node."""
    path, sections = tmp_path / 'robot.yaml', {}
    path.write_text(text)
    read_file(path, sections)
    for argument in arguments:
        read_argument(argument, sections)
    return {name: given.value for name, given in given_to(sections, node).items()}


def refused(tmp_path, text):
    """Return the line with which a file is refused, without the folder."""
    with pytest.raises(ParameterError) as refusal:
        values(tmp_path, text)
    assert '\n' not in str(refusal.value)
    return str(refusal.value).removeprefix(f'{tmp_path}/')


@pytest.mark.parametrize('text, value', [
    ('1', 1), ('-2', -2), ('1.0', 1.0), ('1e-3', 1e-3), ('.5', 0.5), ('5.', 5.0), ('0x10', 16),
    ('true', True), ('off', False), ('text', 'text'), ('"5"', '5'), ('1:30', '1:30'),
    ('2026-01-01', '2026-01-01'), ('1_000', '1_000'), ('[1, 2.0]', [1, 2.0]), ('[]', []),
    ('[a, b]', ['a', 'b']), ('.inf', float('inf')), ('', None)])
def test_a_scalar_is_what_ros_takes_it_for(tmp_path, text, value):
    read = values(tmp_path, f'/**:\n  ros__parameters:\n    a: {text}\n')['a']
    assert read == value and type(read) is type(value)


def test_nested_names_are_joined_by_dots(tmp_path):
    assert values(tmp_path, '/**: {ros__parameters: {a: {b: 1, c: {d: 2}}, e: 3}}') == {
        'a.b': 1, 'a.c.d': 2, 'e': 3}


def test_namespaces_may_be_nested(tmp_path):
    text = 'r:\n  b:\n    swerve_node: {ros__parameters: {a: 1}}\n'
    assert values(tmp_path, text, '/r/b/swerve_node') == {'a': 1}
    assert values(tmp_path, text) == {}


def test_later_sections_and_arguments_count_more(tmp_path):
    general = '/**: {ros__parameters: {a: 1, b: 1}}\n'
    special = 'swerve_node: {ros__parameters: {a: 2}}\n'
    assert values(tmp_path, general + special) == {'a': 2, 'b': 1}
    assert values(tmp_path, special + general) == {'a': 1, 'b': 1}
    assert values(tmp_path, general, arguments=['a:=3', 'swerve_node:b:=[x]', 'other:b:=5']) == {
        'a': 3, 'b': ['x']}


@pytest.mark.parametrize('text, complaint', [
    ('', 'robot.yaml is empty'),
    ('# nothing\n', 'robot.yaml is empty'),
    ('/**:\n\tros__parameters: {}', 'line 2: not YAML: a tab; indent with spaces'),
    ('/**: [', 'line 1: not YAML'),
    ('/**:\n  ros__parameters:\n    a: [1\n    b: 2\n', 'line 3: not YAML: a list without its'),
    ('/**:\n  ros__parameters:\n    a:[1]\n    b: 2\n', 'one without a space in the line above'),
    ('/**:\n  ros__parameters:\n    b: 2\n    a:[1]\n', "line 4: not YAML: no ': ' (a colon"),
    ('/**:\n  ros__parameters:\n    a: "1\n    b: 2\n', 'line 3: not YAML'),
    ('/**:\n  ros__parameters:\n    a: 1\n   b: 2\n', 'line 4: not YAML: indented differently'),
    ('/**:\n  ros__parameters:\n    a: [1, , 2]\n', 'line 3: not YAML: a value is missing'),
    ('a: 1\n', "line 1: 'a' is not inside 'ros__parameters:'"),
    ('/**:\n  a: [1]\n', "line 2: '**/a' is not inside 'ros__parameters:'"),
    ('[1, 2]', "line 1: it is not inside 'ros__parameters:'"),
    ('ros__parameters: {a: 1}', "line 1: 'ros__parameters:' belongs below the name"),
    ('/**:\n  ros__parameters:\n', "line 2: 'ros__parameters:' has no parameters"),
    ('/**:\n  ros__parameters:\n    a: 1\n    b: 2\n    a: 3\n',
     "line 5: parameter 'a' appears twice"),
    ('/**:\n  ros__parameters:\n    [a]: 1\n', 'line 3: must be a name'),
    ('/**: &a\n  b: *a\n', 'contains itself'),
    ('/**:\n  ros__parameters: &a\n    b: *a\n', 'contains itself'),
    ('/**: {ros__parameters: {a: !!python/name:os.system x}}', 'line 1: not YAML')])
def test_what_is_no_parameter_file_is_told_with_its_line(tmp_path, text, complaint):
    assert complaint in refused(tmp_path, text)


@pytest.mark.parametrize('value, kind', [
    ('!!bool maybe', 'bool'), ('!!timestamp today', 'timestamp'), ('!!float small', 'float'),
    ('!!int one', 'int'), ('1' + 5000 * '0', 'int')], ids=str.__len__)
def test_a_value_that_does_not_fit_its_tag_is_told_with_its_line(tmp_path, value, kind):
    path = tmp_path / 'robot.yaml'
    path.write_text(f'node:\n  ros__parameters:\n    a: {value}\n')
    with pytest.raises(ParameterError, match=f"line 3: not YAML: no value of type '{kind}'$"):
        read_file(path, {})
    with pytest.raises(ParameterError, match=f"not YAML: no value of type '{kind}'$"):
        read_argument(f'a:={value}', {})


def test_what_is_no_text_is_refused(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_bytes(b'\xff\xfe\x00')
    with pytest.raises(ParameterError, match='is not a text file'):
        read_file(path, {})


@pytest.mark.parametrize('argument', ['a', 'a:1', ':=1', 'a:=[', ':a'])
def test_an_argument_of_another_form_is_refused(argument):
    with pytest.raises(ParameterError, match='^-p '):
        read_argument(argument, {})


@given(st.text(), st.binary(max_size=40))
def test_no_content_ends_in_anything_but_a_line(tmp_path_factory, text, raw):
    path = tmp_path_factory.mktemp('file') / 'robot.yaml'
    for content in (raw, f'/**:\n  ros__parameters:\n    a: {text}\n'.encode()):
        path.write_bytes(content)
        try:
            read_file(path, {})
        except ParameterError as error:
            assert '\n' not in str(error)


def test_a_star_stands_for_one_name_and_two_for_any_number():
    assert is_for('/*', '/a') and not is_for('/*', '/a/b')
    assert is_for('/**', '/a') and is_for('/**', '/a/b') and is_for('/**/b', '/b')
    assert not is_for('/a', '/ab') and not is_for('/**/a', '/b')
    assert not any(is_for(section, '/a_b') for section in ('/a.b', '/a_b[', '/a_b(', '/a_b*'))
