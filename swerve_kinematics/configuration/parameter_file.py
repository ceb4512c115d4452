"""The parameters of swerve_node from its YAML file, without a node."""

from swerve_kinematics.configuration.declarations import refuse
from swerve_kinematics.configuration.node import NODE_DECLARATIONS, parameters_from
import yaml

NODE = 'swerve_node'


def read_parameters(path):
    """
    Return the parameters that swerve_node would have with a file.

    Parameters
    ----------
    path : pathlib.Path
        YAML as for `--params-file`; blocks for other nodes are left out.

    Returns
    -------
    swerve_kinematics.configuration.node.NodeParameters

    Raises
    ------
    ValueError
        If the file is no such YAML, or a parameter cannot be used.

    """
    try:
        content = yaml.safe_load(path.read_text())
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ValueError(f'{path} is not YAML: {" ".join(str(error).split())}') from None
    given = dict(_given(content))
    if not given:
        raise ValueError(f"{path} has no 'ros__parameters' for '/**' or {NODE}")
    return parameters_from({declaration.name: _value(declaration, given)
                            for declaration in NODE_DECLARATIONS})


def _given(content, node=''):
    """Yield name and value of all parameters for swerve_node; namespaces may be nested."""
    for key, block in content.items() if isinstance(content, dict) else ():
        if key != 'ros__parameters':
            yield from _given(block, str(key))
        elif node.endswith('**') or node.rpartition('/')[2] == NODE:
            yield from _flat(block)


def _flat(block, prefix=''):
    """Yield the parameters of a block, nested names joined by dots."""
    for name, value in block.items() if isinstance(block, dict) else ():
        if isinstance(value, dict):
            yield from _flat(value, f'{prefix}{name}.')
        else:
            yield f'{prefix}{name}', value


def _value(declaration, given):
    """Return the value given for a parameter, or its default, as ROS would have it."""
    # A default that is no value stands for a list that may stay empty.
    default = declaration.default
    if not isinstance(default, (bool, int, float, str, list)):
        default = []
    value = given.get(declaration.name, default)
    if isinstance(value, list) != isinstance(default, list):
        refuse(declaration.name, value, f'must {"" if isinstance(default, list) else "not "}'
                                        'be a list')
    if isinstance(value, list):
        texts = declaration.name.endswith('names')
        return [_entry(declaration.name, entry, '' if texts else 0.0) for entry in value]
    return _entry(declaration.name, value, default)


def _entry(name, value, example):
    """Return a value of the type of an example, for YAML reads 1 and 1e-3 as no doubles."""
    try:
        return type(example)(value)
    except (TypeError, ValueError):
        refuse(name, value, f'must be {type(example).__name__}')
