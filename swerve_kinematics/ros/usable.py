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

"""Which numbers of a sensor are of use."""

from collections.abc import Sequence
import math

from swerve_kinematics.core.odometry.readings import LARGEST_READING


def is_usable(value: float) -> bool:
    """Tell whether a value [rad or rad/s] is finite and within reason."""
    return -LARGEST_READING <= value <= LARGEST_READING  # false for NaN too


def are_usable(values: Sequence[float]) -> bool:
    """Tell whether all values [rad or rad/s] are: finite, and within reason taken together."""
    return math.hypot(*values) <= LARGEST_READING  # false for NaN too
