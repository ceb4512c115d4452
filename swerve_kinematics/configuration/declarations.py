"""What a parameter is: name, default, unit and range; and the error where a value does not fit."""

from enum import Enum
from typing import Any, NamedTuple


class ListOf(Enum):
    """What the entries are of a list that is empty by default."""

    STRINGS = 'strings'
    DOUBLES = 'doubles'


STRINGS, DOUBLES = ListOf.STRINGS, ListOf.DOUBLES
# ROS describes ranges by two finite ends; this one stands for "no upper end".
UNBOUNDED = 1e9


class ParameterError(ValueError):
    """A parameter that cannot be used; one line that names it, its value and the reason."""


def refuse(name, value, reason):
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

    def check(self, value):
        """Raise ParameterError if a number in `value` is out of range or not finite."""
        for entry in value if isinstance(value, list) else [value]:
            # The comparison is false for NaN too.
            if isinstance(entry, float) and not self.minimum <= entry <= self.maximum:
                refuse(self.name, value, f'must be within [{self.minimum:g}, {self.maximum:g}]')


def per_module(values, name, count, default=None):
    """
    Return a list with one entry for each module.

    Parameters
    ----------
    values : dict
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
