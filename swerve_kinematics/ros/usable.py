"""Which numbers of a sensor are of use."""

from collections.abc import Sequence
import math

# No joint and no gyro gets this far [rad, rad/s]; beyond it, sums and products of numbers that
# are still finite overflow.
LARGEST = 1e12


def is_usable(value: float) -> bool:
    """Tell whether a value [rad or rad/s] is finite and within reason."""
    return -LARGEST <= value <= LARGEST  # false for NaN too


def are_usable(values: Sequence[float]) -> bool:
    """Tell whether all values [rad or rad/s] are: finite, and within reason taken together."""
    return math.hypot(*values) <= LARGEST  # false for NaN too
