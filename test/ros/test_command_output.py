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

"""Commands as they arrive, from a real node without a process."""

from std_msgs.msg import Float64MultiArray

from swerve_kinematics import SwerveKinematics
from swerve_kinematics.configuration.joints import ModuleJoints
from swerve_kinematics.configuration.layout import Layout
from swerve_kinematics.ros.command_output import ForwardCommands

LAYOUT = Layout(('a', 'b'), SwerveKinematics([(0.3, 0.2), (-0.3, -0.2)]),
                ModuleJoints([0.05, 0.05]), ('ad', 'bd'), ('as', 'bs'), 'gyro', 'odom',
                'base_link')


def test_commands_arrive_as_they_were_given(client):
    commands = ForwardCommands(client.node, LAYOUT)
    client.repeat_until(lambda: commands.publish(0, [1.0, -2.0], None), lambda: client.drive,
                        'a command to the drives')
    assert client.drive[0] == Float64MultiArray(data=[1.0, -2.0])
    assert not client.steering
    client.repeat_until(lambda: commands.publish(0, [3.0, 4.0], [0.5, -9.0]),
                        lambda: client.steering and client.drive[-1].data[0] == 3.0,
                        'a command to both')
    assert client.steering[0] == Float64MultiArray(data=[0.5, -9.0])
    assert client.drive[-1] == Float64MultiArray(data=[3.0, 4.0])
