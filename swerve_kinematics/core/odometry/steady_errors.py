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

"""How far modules that are not calibrated mislead the pose, by what they say of each other."""

# A wrong radius or steering offset makes an error that stays the same part of a wheel's way. It is
# looked at whenever the wheel has rolled so far [m], beyond the last bit of coarse encoders; if it
# is greater than the second value (20 degrees), the wheel has slipped.
SPAN, LARGEST_PART = 0.05, 0.35
# A mean over so much of the way [m], which begins with so much of it without an error.
MEMORY, BEGINNING = 10.0, 0.5
# Tyres that creep alike in every lap make so much of it without anything being wrong.
USUAL = 0.004


class SteadyErrors:
    """
    The errors of the modules that stay with them, as parts of their ways.

    Attributes
    ----------
    variance : float
        Of the part by which the base moves further than its modules say, and aside, each.

    """

    def __init__(self, module_count: int) -> None:
        """Start with modules that agree."""
        self._errors, self._ways = [0j] * module_count, [0.0] * module_count
        self._parts, self._lengths = [0j] * module_count, [BEGINNING] * module_count
        self._squares = [0.0] * module_count  # of the parts, less what is usual
        # What their mean is off by does not show; independent errors leave so much of it.
        self._share = 1.0 / (module_count * (module_count - 1))
        self.variance = 0.0

    def update(self, used: tuple[int, ...], errors: list[complex], rolled: list[float]) -> None:
        """
        Take in one step.

        Parameters
        ----------
        used : tuple of int (k,)
            Indices of the modules that took part.
        errors : list of complex (k,)
            Error of each used module in the step [m], seen along its wheel: forwards and
            backwards, it is the same part of the way.
        rolled : list of float (n,)
            Ways of all modules [m].

        """
        totals, ways = self._errors, self._ways
        for module, error in zip(used, errors):
            totals[module] = total = totals[module] + error
            ways[module] = way = ways[module] + rolled[module]
            if way >= SPAN or way <= -SPAN:
                self._look_at(module, total / way, abs(way))
                totals[module], ways[module] = 0j, 0.0

    def _look_at(self, module: int, part: complex, length: float) -> None:
        """Take in the error of a module as a part of its way, which had this length [m]."""
        if abs(part) > LARGEST_PART:
            return
        total = self._lengths[module] + length
        self._lengths[module] = min(total, MEMORY)
        self._parts[module] += length / total * (part - self._parts[module])
        self._squares[module] = max(abs(self._parts[module]) ** 2 - USUAL * USUAL, 0.0)
        self.variance = self._share * sum(self._squares)
