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

"""Overrides of a topic's quality of service, which rclpy takes as parameters."""

from typing import Any, Mapping

from swerve_kinematics.configuration.declarations import ParameterError
from swerve_kinematics.configuration.parameter_file import Given
from swerve_kinematics.configuration.values import nearest

QOS_PREFIX = 'qos_overrides.'
ENDS = ('publisher', 'subscription')
# The middleware counts messages in 31 bits.
DEPTHS = range(1 << 31)
# What each policy may be; None: one of DEPTHS.
POLICIES: dict[str, tuple[str, ...] | None] = {
    'history': ('keep_last', 'keep_all', 'system_default'), 'depth': None,
    'reliability': ('reliable', 'best_effort', 'best_available', 'system_default')}


def overrides_of_quality(given: Mapping[str, Given]) -> dict[str, Any]:
    """
    Return the overrides among what is given, as rclpy takes them.

    rclpy ignores a misspelt policy without a word, and ends in a traceback for a value that it
    does not know.

    Parameters
    ----------
    given : mapping
        Given by name.

    Returns
    -------
    dict
        Value by name.

    Raises
    ------
    ParameterError
        If a name is none, or a value is none of its policy.

    """
    found = {name: entry for name, entry in given.items() if name.startswith(QOS_PREFIX)}
    for name, (value, origin, shared) in found.items():
        topic, _, policy = name.removeprefix(QOS_PREFIX).rpartition('.')
        topic, _, end = topic.rpartition('.')
        if policy not in POLICIES or not topic or end not in ENDS:
            if shared:
                continue  # it may be meant for another node, which takes more
            raise ParameterError(
                f"{origin}: '{name}' must be {QOS_PREFIX}TOPIC.{'|'.join(ENDS)}.POLICY, "
                f"the nearest policy is '{nearest(policy, POLICIES)}'", name)
        allowed = POLICIES[policy]
        if allowed is None and not (type(value) is int and value in DEPTHS):
            raise ParameterError(
                f"{origin}: '{name}' = {value!r}: must be an integer, 0 or more", name)
        if allowed is not None and str(value).lower() not in allowed:
            raise ParameterError(
                f"{origin}: '{name}' = {value!r}: must be one of {', '.join(allowed)}", name)
    return {name: entry.value for name, entry in found.items()}
