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

"""Figures of a benchmark: a quantity of ours, repeated, beside a reference of the same run."""

import operator
from typing import NamedTuple

import numpy as np

ROW = '{:50}{:>10} {:>10} {:11} {:10}{:>7} {:>14}  {:18}{}'
HEADER = ROW.format(
    'figure', 'ours', 'reference', '', 'against', 'ratio', 'spread', 'target', '')
SIGNS = {'<=': operator.le, '>=': operator.ge}


class Figure(NamedTuple):
    """
    One line of the table.

    Attributes
    ----------
    name, unit : str
        What is measured.
    ours : sequence of float
        One entry for each repetition.
    against : str
        What the reference is.
    reference : sequence of float
        Its entry of the same repetition; empty where the figure stands for itself.
    target : str
        `ratio`, `value` or `difference`, `<=` or `>=`, and a number; empty for none.

    """

    name: str
    unit: str
    ours: tuple
    against: str = ''
    reference: tuple = ()
    target: str = ''

    def values(self):
        """Return what the targets are about: for each kind, the value of each repetition."""
        values = {'value': np.array(self.ours)}
        if len(self.reference):
            values['ratio'] = values['value'] / self.reference
            values['difference'] = values['value'] - self.reference
        return values

    def is_met(self):
        """Tell whether the median meets the target; None without a target."""
        if not self.target:
            return None
        kind, sign, limit = self.target.split()
        return bool(SIGNS[sign](np.median(self.values()[kind]), float(limit)))

    def row(self):
        """Return the line of the table."""
        values = self.values()
        spread = values.get('ratio', values['value'])
        verdict = {None: '', True: 'met', False: 'MISSED'}[self.is_met()]
        return ROW.format(
            self.name, _number(self.ours), _number(self.reference), self.unit, self.against,
            _number(values.get('ratio', ())), f'{spread.min():.3g}..{spread.max():.3g}',
            self.target, verdict).rstrip()

    def record(self):
        """Return the figure as JSON can hold it."""
        medians = {kind: float(np.median(value)) for kind, value in self.values().items()}
        return {**self._asdict(), 'ours': list(self.ours), 'reference': list(self.reference),
                'median': medians, 'met': self.is_met()}


def _number(values):
    """Return the median as people read it, empty for no values."""
    return f'{np.median(values):.4g}' if len(values) else ''
