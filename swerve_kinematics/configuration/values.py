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

"""From what is given to the value of every parameter, by one set of rules wherever it is given."""

from typing import Any, Iterable, Mapping

from swerve_kinematics.configuration.declarations import Declaration, ParameterError, refuse
from swerve_kinematics.configuration.parameter_file import Given

WORDS = {float: ('a number', 'numbers'), int: ('an integer', 'integers'),
         str: ('text', 'texts'), bool: ('true or false', 'true or false')}
# What ROS has for an integer: 64 bits.
INTEGERS = range(-1 << 63, 1 << 63)


def converted(declaration: Declaration, value: Any) -> Any:
    """
    Return a value in the type of its parameter.

    An integer is taken for a float and a single value for a list of one entry.

    Parameters
    ----------
    declaration : Declaration
        Of the parameter.
    value : Any
        As YAML or rclpy has it, arrays as lists.

    Returns
    -------
    bool, int, float, str or list

    Raises
    ------
    ParameterError
        If it is of another type, or an integer that ROS does not have.

    """
    entries = value if isinstance(value, list) and declaration.is_list else [value]
    if any(type(entry) is int and entry not in INTEGERS for entry in entries):
        refuse(declaration.name, value, 'ROS has no integer of this size')
    # Python's booleans are integers too, ROS's are not.
    entries = [float(entry) if declaration.kind is float and type(entry) is int else entry
               for entry in entries]
    if any(type(entry) is not declaration.kind for entry in entries):
        one, several = WORDS[declaration.kind]
        refuse(declaration.name, repr(value),
               'has no value' if value is None else f'must be a list of {several}'
               if declaration.is_list else f'must be {one}')
    return entries if declaration.is_list else entries[0]


def nearest(name: str, known: Iterable[str]) -> str:
    """Return the known name that is most like a name, in whatever case that is written."""
    from difflib import SequenceMatcher  # only here: few starts have a mistake to explain
    return max(known, key=lambda other: SequenceMatcher(
        None, name.lower(), other.lower()).ratio())


def values_of(declarations: Iterable[Declaration], given: Mapping[str, Given]) -> dict[str, Any]:
    """
    Return the value of every parameter.

    Parameters
    ----------
    declarations : iterable of Declaration
        One for each parameter.
    given : mapping
        What is given, by name.

    Returns
    -------
    dict
        Value by name: the one given, or the default.

    Raises
    ------
    ParameterError
        If one of another type is given.

    """
    return {declaration.name: converted(declaration, given[declaration.name].value)
            if declaration.name in given else declaration.initial
            for declaration in declarations}


def refuse_unknown(given: Mapping[str, Given], own: frozenset[str],
                   others: frozenset[str]) -> None:
    """
    Raise ParameterError if a name is not known; it says which known one is nearest.

    Parameters
    ----------
    given : mapping
        What is given, by name.
    own, others : frozenset of str
        Names that are known, and those that are besides in a section for all nodes.

    """
    for name, (_, origin, shared) in given.items():
        known = own | others if shared else own
        if name not in known:
            raise ParameterError(f"{origin}: unknown parameter '{name}'; "
                                 f"the nearest known name is '{nearest(name, known)}'")
