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
    """A parameter that cannot be used; one line that names it, its value and the reason."""


def refuse(name: str, value: object, reason: str) -> NoReturn:
    """Raise the ParameterError that says why `value` cannot be used."""
    raise ParameterError(f"parameter '{name}' = {value}: {reason}")


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

    def check(self, value: object) -> None:
        """Raise ParameterError if a number in `value` is out of range or not finite."""
        for entry in value if isinstance(value, list) else [value]:
            # The comparison is false for NaN too.
            if isinstance(entry, float) and not self.minimum <= entry <= self.maximum:
                refuse(self.name, value, f'must be within [{self.minimum:g}, {self.maximum:g}]')
