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

"""Parameters as rclpy has them: declared with their values, and changes in their types."""

from typing import Any, Callable, Iterable, Mapping

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from swerve_kinematics.configuration.declarations import Declaration, ParameterError, Values
from swerve_kinematics.configuration.values import converted

SINGLE = {bool: Parameter.Type.BOOL, int: Parameter.Type.INTEGER, float: Parameter.Type.DOUBLE,
          str: Parameter.Type.STRING}
LISTS = {float: Parameter.Type.DOUBLE_ARRAY, str: Parameter.Type.STRING_ARRAY}


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
    if isinstance(parameter.value, (bool, float, int, str, type(None))):
        return parameter.value
    return list(parameter.value)


def overrides(of_rclpy: Mapping[str, Any]) -> list[Parameter]:
    """Return what is given for rclpy itself, as a node takes it when it is created."""
    return [Parameter(name, value=value) for name, value in of_rclpy.items()]


def without_effect(node: Node, of_rclpy: Mapping[str, Any]) -> list[str]:
    """Return the names of what is given for rclpy itself and fits nothing that the node has."""
    return [name for name in of_rclpy if not node.has_parameter(name)]


def declare(node: Node, declarations: Iterable[Declaration], values: Values) -> None:
    """
    Declare parameters on a node, and take changes of them in whatever type fits.

    Parameters
    ----------
    node : rclpy.node.Node
        Gets the parameters.
    declarations : iterable of Declaration
        One for each parameter.
    values : mapping
        Value by name.

    """
    by_name = {declaration.name: declaration for declaration in declarations}
    for name, declaration in by_name.items():
        _declare(node, declaration, values[name])
    node.add_pre_set_parameters_callback(_accepted(by_name))


def _declare(node: Node, declaration: Declaration, value: Any) -> None:
    """Declare a parameter with its value."""
    told = descriptor(declaration)
    if value != []:
        node.declare_parameter(declaration.name, value, told)
        return
    # An empty list has a wrong type in rclpy: the parameter would stay unset, and one that is
    # unset makes rclpy answer nothing to whoever reads all parameters.
    kind = LISTS[declaration.kind]
    node.declare_parameter(declaration.name, kind)
    node.set_parameters([Parameter(declaration.name, kind, [])])
    told.type = kind.value
    node.set_descriptor(declaration.name, told)


def _accepted(declarations: Mapping[str, Declaration]) -> Callable[
        [list[Parameter]], list[Parameter]]:
    """Return a callback that gives changes the types that the parameters have."""
    def accepted(changes: list[Parameter]) -> list[Parameter]:
        return [_typed(declarations[change.name], change) if change.name in declarations
                else change for change in changes]
    return accepted


def _typed(declaration: Declaration, change: Parameter) -> Parameter:
    """Return a change in its parameter's type, or as it is: rclpy then says what is wrong."""
    kinds = LISTS if declaration.is_list else SINGLE
    try:
        value = converted(declaration, plain_value(change))
    except ParameterError:
        return change
    return Parameter(declaration.name, kinds[declaration.kind], value)
