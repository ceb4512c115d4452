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
The reader of parameter files and of values on the command line: what is given, and where.

It knows the layout of such a file, not what the parameters mean. Of two values for one node the
later one counts, and sections stand in the order in which they appeared first, as in ROS.
"""

from pathlib import Path
import re
from typing import Any, Iterator, Mapping, NamedTuple

from swerve_kinematics.configuration.declarations import ParameterError
import yaml

PARAMETERS = 'ros__parameters'
SECTION_FOR_ALL = '/**'


class Given(NamedTuple):
    """
    A value as it was given.

    Attributes
    ----------
    value : Any
        As YAML reads it.
    origin : str
        Where it stands, for people.
    shared : bool
        Whether it was given to all nodes, so that it may be meant for another one.

    """

    value: Any
    origin: str
    shared: bool


# What PyYAML was reading where it finds the mistake only later, often on the next line.
OPENED = ('while scanning a simple key', 'while parsing a flow', 'while scanning a quoted')
# Mistakes that people make, by what PyYAML says of them.
PLAINLY = {
    r"'\t'": 'a tab; indent with spaces',
    "could not find expected ':'": "no ': ' (a colon and a space) after a name",
    'mapping values are not allowed': "a ':' too many, or one without a space in the line above",
    'expected the node content': 'a value is missing',
    'expected <block end>': 'indented differently from the lines above',
    "expected ',' or ']'": "a list without its ',' or ']'",
}
# Parameters by name, by the name of their section.
Sections = dict[str, dict[str, Given]]


class _Loader(yaml.SafeLoader):
    """Reads scalars as ROS does: 1e-3 is a number, 1:30 and 2026-01-01 are text."""

    yaml_implicit_resolvers: dict[str, list[Any]] = {}

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        """Return the value of a node; whatever does not fit its tag is a mistake in the YAML."""
        try:
            return super().construct_object(node, deep)
        except (AttributeError, KeyError, ValueError):
            kind = node.tag.rpartition(':')[2]
            raise yaml.constructor.ConstructorError(
                None, None, f"no value of type '{kind}'", node.start_mark) from None


for _tag, _pattern, _first in (
        ('null', r'~|null|Null|NULL|', ['~', 'n', 'N', '']),
        ('bool', r'(?i:yes|no|true|false|on|off)', list('yYnNtTfFoO')),
        ('int', r'[-+]?(0|[1-9][0-9]*|0[0-7]+|0x[0-9a-fA-F]+)', list('-+0123456789')),
        ('float', r'[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?|[-+]?\.(?i:inf)|\.(?i:nan)',
         list('-+0123456789.'))):
    _Loader.add_implicit_resolver(f'tag:yaml.org,2002:{_tag}', re.compile(f'(?:{_pattern})$'),
                                  _first)


def read_file(path: Path, sections: Sections) -> list[str]:
    """
    Add what a parameter file gives.

    Parameters
    ----------
    path : pathlib.Path
        YAML as for `--params-file`.
    sections : dict
        Gets the parameters.

    Returns
    -------
    list of str
        Names of the file's sections.

    Raises
    ------
    ParameterError
        If it is no such file, with the line.
    OSError
        If it cannot be read.

    """
    try:
        loader = _Loader(path.read_text(encoding='utf-8'))
        root = loader.get_single_node()
        if root is None:
            raise ParameterError(f'{path} is empty')
        names = []
        for section, block in _sections(root, path):
            names.append(section)
            there = sections.setdefault(section, {})
            for name, line, node in _flat(block, path):
                value = loader.construct_object(node, deep=True)
                there[name] = Given(value, f'{path}, line {line}', '*' in section)
    except UnicodeDecodeError:
        raise ParameterError(f'{path} is not a text file') from None
    except yaml.YAMLError as error:
        raise ParameterError(f'{path}{_explained(error)}') from None
    except RecursionError:
        raise ParameterError(f'{path} contains itself, or is nested too deeply') from None
    return names


def read_argument(argument: str, sections: Sections) -> None:
    """
    Add what `-p [node:]name:=value` gives.

    Parameters
    ----------
    argument : str
        What stands behind `-p`.
    sections : dict
        Gets the parameter.

    Raises
    ------
    ParameterError
        If it is of no such form.

    """
    name, found, text = argument.partition(':=')
    section, _, name = name.rpartition(':')
    if not found or not name:
        raise ParameterError(f'-p {argument}: must be name:=value')
    try:
        value = yaml.load(text, _Loader)
    except yaml.YAMLError as error:
        raise ParameterError(f'-p {argument}{_explained(error, line=False)}') from None
    section = qualified(section) if section else SECTION_FOR_ALL
    sections.setdefault(section, {})[name] = Given(value, f'-p {argument}', False)


def given_to(sections: Mapping[str, Mapping[str, Given]], node: str) -> dict[str, Given]:
    """
    Return the parameters of all sections that are meant for a node.

    Parameters
    ----------
    sections : mapping
        As `read_file` and `read_argument` leave them.
    node : str
        Full name.

    Returns
    -------
    dict
        Given by name.

    """
    return {name: given for section, block in sections.items() if is_for(section, node)
            for name, given in block.items()}


def is_for(section: str, node: str) -> bool:
    """Tell whether a section is meant for a node; * stands for one name, ** for any number."""
    parts = [{'/**': r'(/\w+)*', '/*': r'/\w+'}.get(part, re.escape(part))
             for part in re.split(r'(/\*\*?)', section)]
    return re.fullmatch(''.join(parts), node) is not None


def qualified(name: str) -> str:
    """Return the name of a node or section with its leading slash."""
    return name if name.startswith('/') else f'/{name}'


def _sections(node: yaml.Node, path: Path, name: str = '') -> Iterator[
        tuple[str, yaml.MappingNode]]:
    """Yield name and content of each section; namespaces may be nested."""
    if not isinstance(node, yaml.MappingNode):
        raise _wrong(path, node, f"{f'{name[1:]!r} is' if name else 'it is'} not inside "
                     f"'{PARAMETERS}:', which belongs between a node's name and its parameters")
    for key, content in node.value:
        if key.value != PARAMETERS:
            yield from _sections(content, path, name + qualified(_text(path, key)))
        elif not name:
            raise _wrong(path, key, f"'{PARAMETERS}:' belongs below the name of a node or "
                         f"'{SECTION_FOR_ALL}:'")
        elif not isinstance(content, yaml.MappingNode):
            raise _wrong(path, key, f"'{PARAMETERS}:' has no parameters below it")
        else:
            yield name, content


def _flat(block: yaml.MappingNode, path: Path, prefix: str = '') -> Iterator[
        tuple[str, int, yaml.Node]]:
    """Yield name, line and value of a section's parameters, nested names joined by dots."""
    names = set()
    for key, node in block.value:
        name = prefix + _text(path, key)
        if name in names:
            raise _wrong(path, key, f"parameter '{name}' appears twice")
        names.add(name)
        if isinstance(node, yaml.MappingNode):
            yield from _flat(node, path, f'{name}.')
        else:
            yield name, _line(key), node


def _text(path: Path, key: yaml.Node) -> str:
    """Return the text of a key."""
    if not isinstance(key, yaml.ScalarNode):
        raise _wrong(path, key, 'must be a name')
    return str(key.value)


def _line(node: yaml.Node) -> int:
    """Return the line, from 1, in which a node begins."""
    return int(node.start_mark.line) + 1


def _wrong(path: Path, node: yaml.Node, reason: str) -> ParameterError:
    """Return the error that says where a file is wrong."""
    return ParameterError(f'{path}, line {_line(node)}: {reason}')


def _explained(error: yaml.YAMLError, line: bool = True) -> str:
    """Return where YAML is wrong and how, to be appended to a name."""
    mark = getattr(error, 'problem_mark', None)
    problem = str(getattr(error, 'problem', None) or getattr(error, 'reason', 'unreadable'))
    context = str(getattr(error, 'context', None))
    if context.startswith(OPENED):
        mark = getattr(error, 'context_mark', mark)
    problem = next((plain for words, plain in PLAINLY.items() if words in problem), problem)
    where = f', line {mark.line + 1}' if line and mark is not None else ''
    return f'{where}: not YAML: {problem}'
