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

"""The reports of the node on /diagnostics."""

from collections import Counter
from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from swerve_kinematics.ros.qos import publisher

# Level and message.
Finding = tuple[bytes, str]
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


class Diagnostics:
    """
    Publishes one DiagnosticArray for each report.

    Parameters
    ----------
    node : rclpy.node.Node
        Creates the publisher; its full name is the hardware_id.

    """

    def __init__(self, node: Node) -> None:
        """Create the publisher."""
        self._publisher = publisher(node, DiagnosticArray, '/diagnostics')
        self._name = node.get_fully_qualified_name()
        self._clock, self._logger = node.get_clock(), node.get_logger()
        self._ignored: Counter[str] = Counter()
        self._level = OK

    def publish(self, findings: list[Finding], values: Mapping[str, float | str],
                ignored: Counter[str]) -> None:
        """
        Publish a report, if anyone listens; log it where the level has changed.

        Parameters
        ----------
        findings : list of (bytes, str)
            Level and message of what is wrong, in any order; the gravest one leads.
        values : dict of str to float or str
            What is measured.
        ignored : collections.Counter
            Ignored input since the start, by reason; any since the last report is a warning.

        """
        new = ignored - self._ignored
        self._ignored = Counter(ignored)
        if new:
            findings = findings + [(WARN, 'ignored input: ' + ', '.join(sorted(new)))]
        findings = sorted(findings, key=lambda finding: finding[0], reverse=True)
        level = findings[0][0] if findings else OK
        message = '; '.join(message for _, message in findings) or 'ok'
        self._log_change(level, message)
        if self._publisher.get_subscription_count() > 0:
            self._send(level, message, {
                **values, **{f'ignored: {reason}': n for reason, n in sorted(ignored.items())}})

    def _send(self, level: bytes, message: str, values: Mapping[str, float | str]) -> None:
        """Publish a report in its final form."""
        status = DiagnosticStatus(
            name=f'{self._name}: swerve drive', hardware_id=self._name, level=level,
            message=message,
            values=[KeyValue(key=key, value=_text(value)) for key, value in values.items()])
        report = DiagnosticArray(status=[status])
        report.header.stamp = self._clock.now().to_msg()
        self._publisher.publish(report)

    def _log_change(self, level: bytes, message: str) -> None:
        """Log once that something is wrong, or graver, or no more."""
        if level != self._level:
            self._level = level
            # Apart, for rclpy ties each place in the code to one severity.
            if level == OK:
                self._logger.info(f'diagnostics: {message}')
            elif level == ERROR:
                self._logger.error(f'diagnostics: {message}')
            else:
                self._logger.warning(f'diagnostics: {message}')


def _text(value: float | str) -> str:
    """Return a value as people read it."""
    return f'{value:.4g}' if isinstance(value, float) else str(value)
