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

"""What a parameter is: name, default, unit and range; and the error where a value does not fit."""

from enum import Enum
from typing import Any, Mapping, NamedTuple, NoReturn


class ListOf(Enum):
    """What the entries are of a list that is empty by default."""

    STRINGS = 'strings'
    DOUBLES = 'doubles'


STRINGS, DOUBLES = ListOf.STRINGS, ListOf.DOUBLES
# ROS describes ranges by two finite ends; this one stands for "no upper end".
UNBOUNDED = 1e9
# Value of each parameter by its name; of what type, its declaration says.
Values = Mapping[str, Any]


class ParameterError(ValueError):
    """
    A parameter that cannot be used; one line that names it, its value and the reason.

    Parameters
    ----------
    text : str
        The line.
    name : str
        Of the parameter, where there is one.

    """

    def __init__(self, text: str, name: str = '') -> None:
        """Keep the name: whoever knows the file tells where it stands there."""
        super().__init__(text)
        self.name = name


def refuse(name: str, value: object, reason: str) -> NoReturn:
    """Raise the ParameterError that says why `value` cannot be used."""
    raise ParameterError(f"parameter '{name}' = {value}: {reason}", name)


class Declaration(NamedTuple):
    """
    One parameter, as `ros2 param describe` shows it.

    Attributes
    ----------
    name : str
        As users write it in their YAML.
    default : Any
        A value; or, for a list that is empty, what its entries would be.
    description : str
        What it does.
    unit : str
        Empty for what has none.
    minimum, maximum : float
        Range of a number, or of each entry of a list.
    plausible : float
        Size of a number beyond which it is taken for a mistake.
    mistake : str
        What the mistake would be.
    changeable : bool
        Whether it may change while the node runs.

    """

    name: str
    default: Any
    description: str
    unit: str = ''
    minimum: float = -UNBOUNDED
    maximum: float = UNBOUNDED
    changeable: bool = False
    plausible: float = UNBOUNDED
    mistake: str = ''

    @property
    def is_list(self) -> bool:
        """Whether the parameter is a list."""
        return isinstance(self.default, (list, ListOf))

    @property
    def kind(self) -> type:
        """Return what the value is, or each entry of a list: bool, int, float or str."""
        if isinstance(self.default, ListOf):
            return str if self.default is STRINGS else float
        return type(self.default[0] if self.is_list else self.default)

    @property
    def initial(self) -> Any:
        """Return the value where none is given."""
        return [] if isinstance(self.default, ListOf) else self.default

    def check(self, value: object) -> None:
        """Raise ParameterError if a number in `value` is not finite, out of range or absurd."""
        for entry in value if isinstance(value, list) else [value]:
            if not isinstance(entry, float):
                continue
            # The comparison is false for NaN too.
            if not self.minimum <= entry <= self.maximum:
                refuse(self.name, value, f'must be {self._range(entry)}')
            if abs(entry) > self.plausible:
                refuse(self.name, value,
                       f'more than {self.plausible:g} {self.unit}: {self.mistake}?')

    def _range(self, entry: float) -> str:
        """Return the range that a number is outside of, for people."""
        if entry < self.minimum and self.maximum >= UNBOUNDED:
            return f'{self.minimum:g} or more'
        return f'within [{self.minimum:g}, {self.maximum:g}]'
