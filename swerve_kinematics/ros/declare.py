"""Declaring parameters to rclpy, and reading them checked."""

from collections.abc import Iterable
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.exceptions import ParameterException
from rclpy.node import Node
from rclpy.parameter import Parameter

from swerve_kinematics.configuration.declarations import (
    Declaration, DOUBLES, ListOf, ParameterError, STRINGS)

LIST_TYPES = {STRINGS: Parameter.Type.STRING_ARRAY, DOUBLES: Parameter.Type.DOUBLE_ARRAY}


def descriptor(declaration: Declaration) -> ParameterDescriptor:
    """Return what ROS is told about a parameter."""
    unit = f' [{declaration.unit}]' if declaration.unit else ''
    told = ParameterDescriptor(
        description=declaration.description + unit, read_only=not declaration.changeable)
    if isinstance(declaration.default, float):
        told.floating_point_range = [FloatingPointRange(
            from_value=declaration.minimum, to_value=declaration.maximum)]
    return told


def plain_value(parameter: Parameter) -> Any:
    """Return a parameter's value with any array as a list."""
    if isinstance(parameter.value, (bool, float, int, str)):
        return parameter.value
    return list(parameter.value)


def declare(node: Node, declarations: Iterable[Declaration]) -> dict[str, Any]:
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
            values[declaration.name] = plain_value(_declared(node, declaration))
        except ParameterException as error:
            raise ParameterError(str(error)) from None
        declaration.check(values[declaration.name])
    return values


def _declared(node: Node, declaration: Declaration) -> Parameter:
    """Return a parameter that has just been declared, with a value whatever was given for it."""
    name, default = declaration.name, declaration.default
    told = descriptor(declaration)
    if not isinstance(default, (list, ListOf)):
        return node.declare_parameter(name, default, told)
    # An empty list has no type in YAML and a wrong one in rclpy: the parameter stays unset, and
    # one that is unset makes rclpy answer nothing to whoever reads all parameters.
    parameter = node.declare_parameter(
        name, LIST_TYPES[default] if isinstance(default, ListOf) else default)
    if parameter.value is None:
        kind = Parameter.Type(node.describe_parameter(name).type)
        node.set_parameters([Parameter(name, kind, [])])
    told.type = node.describe_parameter(name).type
    node.set_descriptor(name, told)
    return node.get_parameter(name)
