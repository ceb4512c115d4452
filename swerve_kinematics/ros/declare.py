"""Declaring parameters to rclpy, and reading them checked."""

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.parameter import Parameter

from swerve_kinematics.configuration.declarations import DOUBLES, ParameterError, STRINGS

EMPTY_LISTS = {STRINGS: Parameter.Type.STRING_ARRAY, DOUBLES: Parameter.Type.DOUBLE_ARRAY}


def descriptor(declaration):
    """Return what ROS is told about a parameter."""
    unit = f' [{declaration.unit}]' if declaration.unit else ''
    told = ParameterDescriptor(
        description=declaration.description + unit, read_only=not declaration.changeable)
    if isinstance(declaration.default, float):
        told.floating_point_range = [FloatingPointRange(
            from_value=declaration.minimum, to_value=declaration.maximum)]
    return told


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
                declaration.name, _default(declaration), descriptor(declaration))
        except ParameterException as error:
            raise ParameterError(str(error)) from None
        values[declaration.name] = plain_value(parameter)
        declaration.check(values[declaration.name])
    return values


def _default(declaration):
    """Return the default of a parameter, or the type of one that is an empty list."""
    return EMPTY_LISTS.get(declaration.default, declaration.default) if isinstance(
        declaration.default, type(STRINGS)) else declaration.default
