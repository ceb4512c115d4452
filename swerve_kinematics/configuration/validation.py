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

"""What several parameters must agree on, or choose from."""

from typing import Sequence

from swerve_kinematics.configuration.declarations import refuse, Values


def per_module(values: Values, name: str, count: int,
               default: float | None = None) -> list[float]:
    """
    Return a list with one entry for each module.

    Parameters
    ----------
    values : mapping
        Value by name.
    name : str
        Of a list with one entry for all modules or one for each.
    count : int
        Number of modules.
    default : float, optional
        Stands for an empty list; without it, a list must be given.

    Raises
    ------
    ParameterError
        If the length fits neither.

    """
    given = values[name]
    if not given and default is not None:
        given = [default]
    if len(given) == 1:
        return list(given) * count
    if len(given) != count:
        refuse(name, given, f'must have 1 or {count} entries, one for each of module_names')
    return list(given)


def refuse_unless_in(values: Values, name: str, choices: Sequence[str]) -> None:
    """Raise ParameterError if the parameter is none of its choices."""
    if values[name] not in choices:
        refuse(name, repr(values[name]), f"must be one of {', '.join(choices)}")


def refuse_unless_a_pair(values: Values, name: str) -> None:
    """Raise ParameterError if a list is not [x, y]."""
    if len(values[name]) != 2:
        refuse(name, values[name], 'must be [x, y]')


def refuse_unusable_names(name: str, entries: Sequence[str]) -> None:
    """Raise ParameterError if a name is empty, stands twice, or is a list without brackets."""
    for entry in entries:
        if ',' in entry:
            refuse(name, repr(entry), 'a comma in a name: write a list as [a, b]')
    if '' in entries:
        refuse(name, entries, 'a name is empty')
    if len(set(entries)) < len(entries):
        refuse(name, entries, 'a name appears twice')
