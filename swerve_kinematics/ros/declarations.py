"""Declaring parameters with type, unit and range, and reading them checked."""

from typing import Any, NamedTuple

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.parameter import Parameter

STRINGS = Parameter.Type.STRING_ARRAY
DOUBLES = Parameter.Type.DOUBLE_ARRAY
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
        A value; or the type of a list that may stay empty, for ROS has no typed empty list:
        it leaves the parameter unset, which reads as an empty list here.
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

    def descriptor(self):
        """Return what ROS is told about the parameter."""
        unit = f' [{self.unit}]' if self.unit else ''
        descriptor = ParameterDescriptor(
            description=self.description + unit, read_only=not self.changeable)
        if isinstance(self.default, float):
            descriptor.floating_point_range = [
                FloatingPointRange(from_value=self.minimum, to_value=self.maximum)]
        return descriptor

    def check(self, value):
        """Raise ParameterError if a number in `value` is out of range or not finite."""
        for entry in value if isinstance(value, list) else [value]:
            # The comparison is false for NaN too.
            if isinstance(entry, float) and not self.minimum <= entry <= self.maximum:
                refuse(self.name, value, f'must be within [{self.minimum:g}, {self.maximum:g}]')


def plain_value(parameter):
    """Return a parameter's value with any array as a list, and unset as an empty list."""
    if parameter.value is None:
        return []
    if isinstance(parameter.value, (bool, float, int, str)):
        return parameter.value
    return list(parameter.value)


def declare(node, declarations):
    """
    Declare parameters on a node and return their values, each checked for type and range.

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the parameters; values given to it from outside replace the defaults.
    declarations : iterable of Declaration
        One for each parameter.

    Returns
    -------
    dict
        Value by name.

    Raises
    ------
    ParameterError
        If a value given from outside has the wrong type or is out of range.

    """
    values = {}
    for declaration in declarations:
        try:
            parameter = node.declare_parameter(
                declaration.name, declaration.default, declaration.descriptor())
        except ParameterException as error:
            raise ParameterError(str(error)) from None
        values[declaration.name] = plain_value(parameter)
        declaration.check(values[declaration.name])
    return values


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
